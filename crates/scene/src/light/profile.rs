//! Emission that depends on direction (SPEC EMI-8). A surface may send less the further from its normal:
//!
//! ```text
//!   L(theta) = L_0 cos^n(theta) for theta <= theta_max, else 0;   Phi = A L_0 2 pi (1 - cos^(n + 2)(theta_max)) / (n + 2).
//! ```
//!
//! Directions leave in proportion to `L cos`, so that all photons carry the same power. Where a profile cannot be inverted,
//! [`sample_by_rejection`] does the same for any that has a bound.

use std::f32::consts::PI;

use etendue_math::{Point2, Rng, Vector3, warp};

use crate::parameters::Parameters;

/// The most tries of [`sample_by_rejection`]: with one direction in a thousand taken, one photon in e^1000 is lost.
const MAX_TRIES: u32 = 1_000_000;
const MAX_EXPONENT: f32 = 10_000.0;

/// Radiance by the angle to the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    exponent: f32,
    cos_max: f32,
}

impl Profile {
    /// Radiance that falls with a power of the cosine, from 0 to 10000, up to an angle in radians, above 0 and at most
    /// a right one.
    #[must_use]
    pub fn new(exponent: f32, max_angle_rad: f32) -> Self {
        let cos_max = if max_angle_rad < PI / 2.0 { max_angle_rad.max(1e-3).cos() } else { 0.0 };
        Self { exponent: exponent.clamp(0.0, MAX_EXPONENT), cos_max }
    }

    /// From `exponent` and `spreadangle`; `None` if radiance is the same in all directions.
    pub(super) fn read(p: &mut Parameters) -> Option<Self> {
        let mut within = |name: &'static str, default: f32, least: f32, most: f32| {
            let value = p.float(name, default);
            if (least..=most).contains(&value) {
                return value;
            }
            let span = p.span_of(name);
            let text =
                format!("\"{name}\" must be between {least} and {most}, but is {value}; {default} is taken");
            p.diagnostics().warning(span, text);
            default
        };
        let exponent = within("exponent", 0.0, 0.0, MAX_EXPONENT);
        let angle = within("spreadangle", 90.0, 0.1, 90.0);
        (exponent > 0.0 || angle < 90.0).then(|| Self::new(exponent, angle.to_radians()))
    }

    /// Radiance over that along the normal.
    #[inline]
    #[must_use]
    pub fn relative(&self, cosine: f32) -> f32 {
        if cosine < self.cos_max { 0.0 } else { cosine.powf(self.exponent) }
    }

    /// Cosine of the largest angle to the normal.
    #[must_use]
    pub const fn cos_max(&self) -> f32 {
        self.cos_max
    }

    /// Flux per square metre where the radiance along the normal is 1.
    #[must_use]
    pub fn projected_solid_angle(&self) -> f32 {
        2.0 * PI / (self.exponent + 2.0) * self.share()
    }

    /// What the cone leaves of the hemisphere's flux.
    fn share(&self) -> f32 {
        1.0 - self.cos_max.powf(self.exponent + 2.0)
    }

    /// A direction around +z with density [`pdf_w`](Self::pdf_w).
    #[must_use]
    pub fn sample(&self, u: Point2) -> Vector3 {
        warp::sample_cosine_power(Point2::new(u.x * self.share(), u.y), self.exponent + 1.0)
    }

    /// Density per steradian of [`sample`](Self::sample), in proportion to radiance times cosine.
    #[must_use]
    pub fn pdf_w(&self, cosine: f32) -> f32 {
        if cosine < self.cos_max {
            0.0
        } else {
            warp::cosine_power_pdf(cosine, self.exponent + 1.0) / self.share()
        }
    }
}

/// A direction with density in proportion to that of `candidate` times `relative`, which lies in [0, 1]: a candidate is
/// taken if a random number is below it. The notebook divides by the total power in place of the maximum, which takes
/// fewer (F5). `None` if all tries fail; the number of tries comes with the direction.
pub fn sample_by_rejection(
    rng: &mut Rng,
    mut candidate: impl FnMut(&mut Rng) -> Vector3,
    relative: impl Fn(Vector3) -> f32,
) -> Option<(Vector3, u32)> {
    (1..=MAX_TRIES).find_map(|n_tries| {
        let w = candidate(rng);
        (rng.next_f32() < relative(w)).then_some((w, n_tries))
    })
}
