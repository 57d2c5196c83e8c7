//! A lens near its axis, where heights and slopes change linearly (Gaussian optics).
//!
//! A ray has height y and reduced slope `v = n dy/dz`, where z runs from the scene to the film. A surface of radius R between
//! indices n and n' adds `-(n' - n) / R y` to v, a distance t in index n adds `t / n v` to y. The product of all,
//!
//! ```text
//! y' = A y + B v        f = -1 / C
//! v' = C y + D v        A D - B C = 1
//! ```
//!
//! takes what enters the front vertex to what leaves the rear one; an object at the distance s before the front has its image
//! `x = -(A s + B) / (C s + D)` behind the rear.

use super::prescription::{LensPrescription, LensSurface};

/// A linear map of heights and reduced slopes, `[A, B, C, D]`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Map([f64; 4]);

impl Map {
    const IDENTITY: Self = Self([1.0, 0.0, 0.0, 1.0]);

    /// This map, then `next`.
    fn then(self, next: Self) -> Self {
        let (Self([a, b, c, d]), Self([e, f, g, h])) = (self, next);
        Self([e * a + f * c, e * b + f * d, g * a + h * c, g * b + h * d])
    }

    fn surface(surface: &LensSurface, eta_before: f32) -> Self {
        let bend = if surface.is_stop() {
            0.0
        } else {
            f64::from(surface.eta - eta_before) / f64::from(surface.radius_m)
        };
        Self([1.0, 0.0, -bend, 1.0])
    }

    fn distance(surface: &LensSurface) -> Self {
        Self([1.0, f64::from(surface.thickness_m) / f64::from(surface.eta), 0.0, 1.0])
    }
}

/// A lens near its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paraxial {
    whole: Map,
    /// From the front vertex to the stop.
    to_stop: Option<Map>,
    length: f64,
}

impl Paraxial {
    /// The constants of a lens.
    #[must_use]
    pub fn new(lens: &LensPrescription) -> Self {
        let (mut whole, mut to_stop) = (Map::IDENTITY, None);
        let (mut eta, mut length) = (1.0, 0.0);
        let surfaces = lens.surfaces();
        for (i, surface) in surfaces.iter().enumerate() {
            let mut step = Map::surface(surface, eta);
            if i + 1 < surfaces.len() {
                step = step.then(Map::distance(surface));
                length += f64::from(surface.thickness_m);
            }
            if surface.is_stop() {
                to_stop = Some(whole);
            }
            whole = whole.then(step);
            eta = surface.eta;
        }
        Self { whole, to_stop, length }
    }

    /// Focal length in metres; negative if the lens spreads light.
    #[must_use]
    pub fn focal_length_m(&self) -> f32 {
        (-1.0 / self.whole.0[2]) as f32
    }

    /// Distance from the rear vertex to the image of what is far away, in metres.
    #[must_use]
    pub fn back_focal_distance_m(&self) -> f32 {
        (-self.whole.0[0] / self.whole.0[2]) as f32
    }

    /// Distance from the rear vertex to the film, in metres, so that what is at `focus_distance` from the film is sharp.
    /// `None` if that is too close, or if the film would have to be in the lens.
    ///
    /// An object at s before the front has the distance `s + length + x(s)` from its image: a quadratic equation in s, of
    /// which the larger solution is the one with the smaller image.
    #[must_use]
    pub fn film_distance(&self, focus_distance: f32) -> Option<f32> {
        let Map([a, b, c, d]) = self.whole;
        let rest = self.length - f64::from(focus_distance);
        let (q, r) = (d + c * rest - a, d * rest - b);
        let discriminant = q * q - 4.0 * c * r;
        if !(discriminant >= 0.0 && c < 0.0) {
            return None;
        }
        let s = (q + discriminant.sqrt()) / (-2.0 * c);
        let film_distance = -(a * s + b) / (c * s + d);
        (s > 0.0 && film_distance > 0.0 && film_distance.is_finite()).then_some(film_distance as f32)
    }

    /// Diameter of the stop, in metres, that has this f-number: focal length over the diameter of the beam that enters.
    #[must_use]
    pub fn stop_diameter_m(&self, f_number: f32) -> Option<f32> {
        let Map([a, ..]) = self.to_stop?;
        Some((f64::from(self.focal_length_m()) * a.abs() / f64::from(f_number)) as f32)
    }
}
