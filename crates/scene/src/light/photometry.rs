//! Measured luminous intensity of a luminaire over the directions of one of the three photometric webs (IES LM-63-2002,
//! "Standard File Format for the Electronic Transfer of Photometric Data"; LM-75-01 for the webs).
//!
//! In the space of the light z is up. Type C, the usual one: the vertical angle is counted from the nadir -z, the
//! horizontal one from +x over +y. Types A and B look along +x, with +z above and -y to the right:
//!
//! ```text
//!   C:  ( sin v cos h,  sin v sin h, -cos v)
//!   A:  ( cos v cos h, -cos v sin h,  sin v)   automotive: a vertical axis
//!   B:  ( cos h cos v, -sin h,        cos h sin v)   floodlights: a horizontal axis
//! ```
//!
//! Between the angles of the table intensity is interpolated linearly, beyond them it is 0. A table of a half or a quarter
//! of the web is mirrored.

use std::f64::consts::PI;

use etendue_math::{Frame, Vector3};

/// A photometric web.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhotometricWeb {
    /// Automotive lights.
    A,
    /// Floodlights.
    B,
    /// Luminaires of rooms and streets.
    C,
}

/// A table of luminous intensity.
#[derive(Clone, Debug, PartialEq)]
pub struct Photometry {
    web: PhotometricWeb,
    /// Degrees, ascending.
    vertical: Vec<f32>,
    /// Degrees, ascending.
    horizontal: Vec<f32>,
    /// Candela: for each horizontal angle those of all vertical ones.
    candela: Vec<f32>,
}

impl Photometry {
    /// A table of candela: for each horizontal angle those of all vertical ones.
    ///
    /// # Errors
    /// What is wrong with the angles, if they are not ascending or do not suit the web, or if there are more or fewer
    /// candela than pairs of angles, or negative or infinite ones.
    pub fn new(
        web: PhotometricWeb,
        vertical: Vec<f32>,
        mut horizontal: Vec<f32>,
        mut candela: Vec<f32>,
    ) -> Result<Self, &'static str> {
        let is_ascending = |angles: &[f32]| angles.windows(2).all(|pair| pair[0] < pair[1]);
        if vertical.len() < 2 || !is_ascending(&vertical) {
            return Err("vertical angles must be two at least, and ascend");
        }
        let (Some(&first), Some(&last)) = (horizontal.first(), horizontal.last()) else {
            return Err("there must be a horizontal angle");
        };
        if !is_ascending(&horizontal) {
            return Err("horizontal angles must ascend");
        }
        if candela.len() != vertical.len() * horizontal.len() {
            return Err("there must be a candela value for each pair of angles");
        }
        if candela.iter().any(|cd| !(*cd >= 0.0 && cd.is_finite())) {
            return Err("candela values must be at least 0 and finite");
        }
        check_ranges(web, &vertical, first, last)?;
        if web == PhotometricWeb::C && first == 0.0 && last > 180.0 && last < 360.0 {
            // The last plane is the first.
            horizontal.push(360.0);
            candela.extend_from_within(..vertical.len());
        }
        Ok(Self { web, vertical, horizontal, candela })
    }

    /// Where the luminaire looks, in the light's space: down for type C, ahead for types A and B.
    #[must_use]
    pub const fn axis(&self) -> Vector3 {
        match self.web {
            PhotometricWeb::C => Vector3::new(0.0, 0.0, -1.0),
            PhotometricWeb::A | PhotometricWeb::B => Vector3::new(1.0, 0.0, 0.0),
        }
    }

    /// True if intensity depends on the angle around the axis by more than this share of the largest intensity.
    #[must_use]
    pub fn varies_around_axis(&self, share: f32) -> bool {
        let frame = Frame::from_z(self.axis());
        let around = |theta: f32| {
            let range = (0..72).map(|i| {
                let (y, x) = (i as f32 * 5.0).to_radians().sin_cos();
                self.intensity(frame.to_world(Vector3::new(theta.sin() * x, theta.sin() * y, theta.cos())))
            });
            range.fold([f32::INFINITY, 0.0], |[low, high]: [f32; 2], i| [low.min(i), high.max(i)])
        };
        let ranges = (0..18).map(|i| around((5.0 * i as f32 + 2.5).to_radians()));
        ranges.into_iter().any(|[low, high]| high - low > share * self.peak())
    }

    /// Luminous intensity in candela in a unit direction of the light's space.
    #[must_use]
    pub fn intensity(&self, w: Vector3) -> f32 {
        let (v, h) = match self.web {
            PhotometricWeb::C => {
                (angle_from(-w.z, w.x.hypot(w.y)), w.y.atan2(w.x).to_degrees().rem_euclid(360.0))
            }
            PhotometricWeb::A => (w.z.atan2(w.x.hypot(w.y)).to_degrees(), (-w.y).atan2(w.x).to_degrees()),
            PhotometricWeb::B => (w.z.atan2(w.x).to_degrees(), (-w.y).atan2(w.x.hypot(w.z)).to_degrees()),
        };
        let (v, h) = self.fold(v, h);
        let (Some((i, s)), Some((j, t))) = (bracket(&self.vertical, v), bracket(&self.horizontal, h)) else {
            return 0.0;
        };
        let n = self.vertical.len();
        let column = |j: usize| {
            let values = &self.candela[j * n..][..n];
            values[i] + (values[(i + 1).min(n - 1)] - values[i]) * s
        };
        let next = (j + 1).min(self.horizontal.len() - 1);
        column(j) + (column(next) - column(j)) * t
    }

    /// Luminous flux in lumen: the integral over the table's own intervals, however narrow they are.
    #[must_use]
    pub fn lumens(&self) -> f64 {
        let (vertical, horizontal) = (&self.vertical, &self.horizontal);
        let even = |_: f64| 1.0;
        let whole = |angles: &[f32]| if angles[0] == 0.0 { 2.0 } else { 1.0 };
        let sine = |v: f64| v.to_radians().sin();
        // The cosine of B's horizontal angle is that of a latitude: none is beyond a right angle.
        let cosine = |angle: f64| angle.to_radians().cos().max(0.0);
        let (by_vertical, by_horizontal, copies) = match self.web {
            PhotometricWeb::C => {
                let (first, last) = (horizontal[0], horizontal[horizontal.len() - 1]);
                let copies = match last - first {
                    90.0 => 4.0,
                    180.0 => 2.0,
                    _ => 1.0,
                };
                (weights(vertical, sine), weights_or(horizontal, 2.0 * PI, even), copies)
            }
            PhotometricWeb::A | PhotometricWeb::B if horizontal.len() == 1 => {
                let is_a = self.web == PhotometricWeb::A;
                let by_vertical = if is_a { weights(vertical, cosine) } else { weights(vertical, even) };
                (by_vertical, vec![if is_a { 2.0 * PI } else { 2.0 }], whole(vertical))
            }
            PhotometricWeb::A => {
                (weights(vertical, cosine), weights(horizontal, even), whole(vertical) * whole(horizontal))
            }
            PhotometricWeb::B => {
                (weights(vertical, even), weights(horizontal, cosine), whole(vertical) * whole(horizontal))
            }
        };
        let column = |values: &[f32]| -> f64 {
            values.iter().zip(&by_vertical).map(|(cd, weight)| f64::from(*cd) * weight).sum()
        };
        let columns = self.candela.chunks(vertical.len()).zip(&by_horizontal);
        copies * columns.map(|(values, weight)| column(values) * weight).sum::<f64>()
    }

    /// Largest luminous intensity in candela.
    #[must_use]
    pub fn peak(&self) -> f32 {
        self.candela.iter().copied().fold(0.0, f32::max)
    }

    /// Angles of the web C between which intensity has no bends; empty for other webs, whose angles are not those of a sphere
    /// around z.
    pub(super) fn bends(&self) -> (&[f32], &[f32]) {
        if self.web == PhotometricWeb::C { (&self.vertical, &self.horizontal) } else { (&[], &[]) }
    }

    /// Angles by the symmetry of the table.
    fn fold(&self, v: f32, h: f32) -> (f32, f32) {
        let (first, last) = (self.horizontal[0], self.horizontal[self.horizontal.len() - 1]);
        match self.web {
            PhotometricWeb::C if self.horizontal.len() == 1 => (v, first),
            PhotometricWeb::C if last == 90.0 => {
                let half = if h > 180.0 { 360.0 - h } else { h };
                (v, if half > 90.0 { 180.0 - half } else { half })
            }
            PhotometricWeb::C if first == 90.0 => (
                v,
                if h < 90.0 {
                    180.0 - h
                } else if h > 270.0 {
                    540.0 - h
                } else {
                    h
                },
            ),
            PhotometricWeb::C if last == 180.0 => (v, if h > 180.0 { 360.0 - h } else { h }),
            PhotometricWeb::C => (v, h),
            PhotometricWeb::A | PhotometricWeb::B => {
                let fold = |angle: f32, first: f32| if first == 0.0 { angle.abs() } else { angle };
                let h = if self.horizontal.len() == 1 { first } else { fold(h, first) };
                (fold(v, self.vertical[0]), h)
            }
        }
    }
}

/// The integrals over the hats of interpolation between ascending angles, in radians, with a density over degrees.
fn weights(angles: &[f32], density: impl Fn(f64) -> f64) -> Vec<f64> {
    /// Degrees over which Simpson's rule is exact to 1e-9 for a sine.
    const STEP: f64 = 2.0;
    let mut weights = vec![0.0; angles.len()];
    for (i, pair) in angles.windows(2).enumerate() {
        let (start, width) = (f64::from(pair[0]), f64::from(pair[1]) - f64::from(pair[0]));
        let n = (width / STEP).ceil().max(1.0) as usize;
        for k in 0..=2 * n {
            let simpson = if k == 0 || k == 2 * n { 1.0 } else { 2.0 + 2.0 * (k % 2) as f64 };
            let t = k as f64 / (2 * n) as f64;
            let weight = simpson * density(start + width * t) * width.to_radians() / (6 * n) as f64;
            weights[i] += (1.0 - t) * weight;
            weights[i + 1] += t * weight;
        }
    }
    weights
}

/// As [`weights`], where a single angle stands for all.
fn weights_or(angles: &[f32], of_all: f64, density: impl Fn(f64) -> f64) -> Vec<f64> {
    if angles.len() == 1 { vec![of_all] } else { weights(angles, density) }
}

/// The angle in degrees whose cosine and sine are in that proportion.
fn angle_from(cosine: f32, sine: f32) -> f32 {
    sine.atan2(cosine).to_degrees()
}

/// The interval that holds `x`, and where in it; `None` outside. A single value holds itself.
fn bracket(angles: &[f32], x: f32) -> Option<(usize, f32)> {
    let last = angles.len() - 1;
    if !(angles[0]..=angles[last]).contains(&x) {
        return None;
    }
    let i = angles.partition_point(|angle| *angle <= x).clamp(1, last.max(1)) - 1;
    if i >= last {
        return Some((last, 0.0));
    }
    Some((i, (x - angles[i]) / (angles[i + 1] - angles[i])))
}

fn check_ranges(web: PhotometricWeb, vertical: &[f32], first: f32, last: f32) -> Result<(), &'static str> {
    let within = |least: f32, most: f32| vertical[0] >= least && vertical[vertical.len() - 1] <= most;
    if web == PhotometricWeb::C {
        if !within(0.0, 180.0) {
            return Err("vertical angles of type C lie between 0 and 180");
        }
        let is_known = first == 0.0 && (last == 0.0 || last == 90.0 || (180.0..=360.0).contains(&last))
            || first == 90.0 && last == 270.0;
        return if is_known {
            Ok(())
        } else {
            Err("horizontal angles of type C go from 0 to 0, 90, 180 or 360, or from 90 to 270")
        };
    }
    if !within(-90.0, 90.0) {
        return Err("vertical angles of types A and B lie between -90 and 90");
    }
    if first < -180.0 || last > 180.0 {
        return Err("horizontal angles of types A and B lie between -180 and 180");
    }
    Ok(())
}
