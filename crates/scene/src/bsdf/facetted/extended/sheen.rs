//! Fibres that stand on a surface: velvet, dust, the skin of a peach.
//!
//! `f = color D(h) / (4 cos_o cos_i (1 + Lambda(wo) + Lambda(wi)))` with `D = (2 + 1/a) sin(delta)^(1/a) / (2 pi)`, a =
//! roughness², and a fit for Lambda (Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF"; glTF's
//! `KHR_materials_sheen`). What is below gets what remains of the albedo E of white fibres, in a table of our own
//! integrals.
//!
//! As printed, f makes light at grazing angles where the roughness is below 0.25: up to 2.8 times what arrives at 0.07. Here f
//! is divided by the greater of both directions' E where that is above 1, which is reciprocal and keeps energy.

use std::f32::consts::{FRAC_1_PI, PI};
use std::sync::OnceLock;

use etendue_math::{Vector3, approx, lerp, sqr};
use etendue_spectrum::Sampled;

use super::super::energy::{Table, square};

/// Roughness below this counts as this: narrower fibres are seen at the very rim alone.
const LEAST_ROUGHNESS: f32 = 0.1;

/// A layer of fibres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sheen {
    pub(super) color: Sampled,
    /// Alpha of the fibres, at least [`LEAST_ROUGHNESS`]².
    pub(super) alpha: f32,
}

impl Sheen {
    pub(super) fn alpha_of(roughness: f32) -> f32 {
        sqr(roughness.clamp(LEAST_ROUGHNESS, 1.0))
    }

    pub(super) fn is_present(&self) -> bool {
        self.color.max_value() > 0.0
    }

    /// f in 1/sr.
    pub(super) fn eval(&self, to: Vector3, from: Vector3) -> Sampled {
        let greater = self.printed_albedo(to.z).max(self.printed_albedo(from.z)).max(1.0);
        self.color * (charlie(to, from, self.alpha) / greater)
    }

    /// What the layer lets pass at most, for whatever is below.
    pub(super) fn passed(&self, cos: f32) -> Sampled {
        if self.is_present() { Sampled::ONE - self.color * self.albedo(cos) } else { Sampled::ONE }
    }

    /// Bound of the albedo of white fibres.
    pub(super) fn albedo(&self, cos: f32) -> f32 {
        self.printed_albedo(cos).min(1.0)
    }

    /// The albedo of the printed formula, and a little more than interpolation may lack.
    fn printed_albedo(&self, cos: f32) -> f32 {
        1.01 * table().at(cos, self.alpha)
    }
}

/// The printed formula for white fibres.
fn charlie(to: Vector3, from: Vector3, alpha: f32) -> f32 {
    let Some(h) = (to + from).try_normalized() else { return 0.0 };
    let sin2 = (sqr(h.x) + sqr(h.y)).clamp(f32::MIN_POSITIVE, 1.0);
    let d = (2.0 + 1.0 / alpha) * approx::exp(0.5 / alpha * approx::ln(sin2)) * (0.5 * FRAC_1_PI);
    let shadowed = 1.0 + lambda(to.z, alpha) + lambda(from.z, alpha);
    // Along the horizon it would be infinite.
    (d / (4.0 * to.z * from.z * shadowed)).min(f32::MAX)
}

/// Fit of Smith's Lambda.
fn lambda(cos: f32, alpha: f32) -> f32 {
    if cos < 0.5 {
        approx::exp(lambda_exponent(cos, alpha))
    } else {
        approx::exp(2.0 * lambda_exponent(0.5, alpha) - lambda_exponent(1.0 - cos, alpha))
    }
}

fn lambda_exponent(x: f32, alpha: f32) -> f32 {
    let t = sqr(1.0 - alpha);
    let [a, b, c] = [lerp(t, 21.5473, 25.3245), lerp(t, 3.82987, 3.32435), lerp(t, 0.19823, 0.16801)];
    let [d, e] = [lerp(t, -1.97760, -1.27393), lerp(t, -4.32054, -4.85967)];
    a / (1.0 + b * approx::exp(c * approx::ln(x.max(f32::MIN_POSITIVE)))) + d * x + e
}

/// Albedos of the printed formula, computed at the first call.
fn table() -> &'static Table {
    static TABLE: OnceLock<Table> = OnceLock::new();
    TABLE.get_or_init(|| {
        Table::new(std::array::from_fn(|i| {
            std::array::from_fn(|j| integrate(square(j).max(1e-5), square(i).max(sqr(LEAST_ROUGHNESS))))
        }))
    })
}

/// `∫ f cos_i dwi` by the midpoint rule, even in the square root of the cosine and in the azimuth.
fn integrate(cos: f32, alpha: f32) -> f32 {
    const STEPS: usize = 48;
    let share = |k: usize| (k as f32 + 0.5) / STEPS as f32;
    let to = direction(cos, 0.0);
    let ring = |k: usize| {
        let t = share(k);
        let at = |m: usize| f64::from(charlie(to, direction(sqr(t), PI * share(m)), alpha));
        (0..STEPS).map(at).sum::<f64>() * f64::from(t).powi(3)
    };
    // dcos = 2 t dt, and twice half a turn.
    let sum: f64 = (0..STEPS).map(ring).sum();
    (sum * 4.0 * std::f64::consts::PI / (STEPS * STEPS) as f64) as f32
}

fn direction(cos: f32, phi: f32) -> Vector3 {
    let (sin, (sin_phi, cos_phi)) = ((1.0 - sqr(cos)).max(0.0).sqrt(), phi.sin_cos());
    Vector3::new(sin * cos_phi, sin * sin_phi, cos)
}
