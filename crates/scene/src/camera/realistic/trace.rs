//! Rays through the surfaces of a lens, from the film outwards.

use etendue_math::{Point2, Point3, Ray, Vector3};

use super::LensSettings;
use super::prescription::{LensPrescription, LensSurface};
use super::stop::StopShape;

/// A surface in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Placed {
    /// Of the vertex: distance from the film in metres.
    z: f32,
    /// Of the sphere, positive if its centre is on the film's side; 0 for the stop.
    radius: f32,
    /// Radius of what is clear.
    clear: f32,
    /// Index on the film's side over that on the scene's.
    eta: f32,
}

/// The surfaces from rear to front, as rays from the film meet them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Barrel {
    surfaces: Vec<Placed>,
    stop_shape: StopShape,
    rear_z: f32,
}

impl Barrel {
    /// Places the surfaces before a film.
    pub(super) fn new(lens: &LensPrescription, settings: &LensSettings, film_distance: f32) -> Self {
        let surfaces = lens.surfaces();
        let mut z = film_distance;
        let mut placed = Vec::with_capacity(surfaces.len());
        for (i, surface) in surfaces.iter().enumerate().rev() {
            if i + 1 < surfaces.len() {
                z += surface.thickness_m;
            }
            let eta_before = if i > 0 { surfaces[i - 1].eta } else { 1.0 };
            let LensSurface { radius_m, eta, diameter_m, .. } = *surface;
            let diameter = if surface.is_stop() { settings.stop_diameter_m } else { diameter_m };
            placed.push(Placed { z, radius: radius_m, clear: diameter / 2.0, eta: eta / eta_before });
        }
        Self { surfaces: placed, stop_shape: settings.stop_shape.clone(), rear_z: film_distance }
    }

    /// Distance of the rear vertex from the film in metres.
    pub(super) const fn rear_z(&self) -> f32 {
        self.rear_z
    }

    /// Radius of what is clear at the rear, in metres.
    pub(super) fn rear_radius(&self) -> f32 {
        self.surfaces[0].clear
    }

    /// A ray from the film as it leaves the front, and the share of it that passes the stop; `None` if a rim stops it, or total
    /// reflection.
    pub(super) fn trace(&self, ray: Ray) -> Option<(Ray, f32)> {
        self.follow(ray, 1.0, &self.stop_shape)
    }

    /// True if a ray passes where the stop is a full disc, as many times as wide.
    pub(super) fn passes_disc(&self, ray: Ray, widened: f32) -> bool {
        self.follow(ray, widened, &StopShape::Disc).is_some()
    }

    /// False if the form of the stop lets nothing pass anywhere.
    pub(super) fn has_opening(&self) -> bool {
        self.stop_shape.has_opening()
    }

    /// As [`trace`](Self::trace), with a stop of that form and as many times as wide.
    fn follow(&self, mut ray: Ray, widened: f32, stop_shape: &StopShape) -> Option<(Ray, f32)> {
        let mut open = 1.0;
        for surface in &self.surfaces {
            let p = if surface.radius == 0.0 {
                let p = ray.at((surface.z - ray.origin.z) / ray.direction.z);
                if ray.direction.z <= 0.0 {
                    return None;
                }
                let clear = surface.clear * widened;
                open *= stop_shape.open_at(Point2::new(p.x / clear, p.y / clear));
                if open <= 0.0 {
                    return None;
                }
                ray.origin = p;
                continue;
            } else {
                surface.meet(&ray)?
            };
            if p.x * p.x + p.y * p.y > surface.clear * surface.clear {
                return None;
            }
            let centre = Point3::new(0.0, 0.0, surface.z - surface.radius);
            let n = (p - centre) / surface.radius;
            ray = Ray::new(p, refract(ray.direction, n, surface.eta)?);
        }
        Some((ray, open))
    }
}

impl Placed {
    /// Where a ray from the film meets the sphere on the side of its vertex.
    fn meet(&self, ray: &Ray) -> Option<Point3> {
        let to_centre = Point3::new(0.0, 0.0, self.z - self.radius) - ray.origin;
        let along = to_centre.dot(ray.direction);
        let miss = to_centre - ray.direction * along;
        let half_chord = (self.radius * self.radius - miss.length_squared()).max(-1.0);
        if half_chord < 0.0 {
            return None;
        }
        // The vertex of a sphere that bulges towards the scene is where the ray leaves it.
        let t = along + half_chord.sqrt().copysign(self.radius);
        let p = ray.at(t);
        // A strongly curved surface is not met beyond its equator, nor by rays that have passed it.
        ((p.z - (self.z - self.radius)) * self.radius > 0.0 && t >= -1e-6).then_some(p)
    }
}

/// The unit direction behind a surface of unit normal `n` along +z, for light of unit direction `d` that comes from the film.
fn refract(d: Vector3, n: Vector3, eta: f32) -> Option<Vector3> {
    // The normal on the side that the ray goes to; a concave sphere's points back to its centre.
    let n = if n.dot(d) < 0.0 { -n } else { n };
    let cos_i = n.dot(d);
    let sin2_t = eta * eta * (1.0 - cos_i * cos_i).max(0.0);
    if sin2_t >= 1.0 {
        return None;
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    (d * eta + n * (cos_t - eta * cos_i)).try_normalized()
}
