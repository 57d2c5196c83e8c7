//! Rough metal with the light that bounces several times among its facets.
//!
//! Of what facets without loss do not reflect at once, `1 - E`, everything leaves later, about evenly. With E of both
//! directions and its mean, `f_ms = F_ms (1 - E(wo)) (1 - E(wi)) / (pi (1 - E_avg))` is reciprocal and makes up for
//! the loss, and what metal absorbs at each further bounce gives `F_ms = F_avg² E_avg / (1 - F_avg (1 - E_avg))`
//! (Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks"). For anisotropic facets E is that of
//! the alpha along each direction, which is right to about a hundredth.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_2};

use etendue_math::{Point2, Vector3, sqr, warp};
use etendue_spectrum::Sampled;

use super::energy::EnergyTable;
use super::{AnyFacets, Facets};
use crate::bsdf::classic::lobed::{Lobed, Shares};
use crate::bsdf::{Conductor, Lobes};

/// Rough metal in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompensatedConductor {
    conductor: Conductor<AnyFacets>,
    /// `F_ms / (pi (1 - E_avg))`, 0 for smooth metal.
    scale: Sampled,
}

impl CompensatedConductor {
    /// Of a metal with one bounce.
    #[must_use]
    pub fn new(conductor: Conductor<AnyFacets>) -> Self {
        Self { conductor, scale: later_bounces(&conductor) }
    }

    /// The facets.
    #[must_use]
    pub const fn facets(&self) -> AnyFacets {
        self.conductor.microfacets
    }

    /// Real and imaginary part of the index.
    #[must_use]
    pub const fn index(&self) -> [Sampled; 2] {
        [self.conductor.eta, self.conductor.k]
    }

    /// With rougher facets where they are nearly smooth.
    #[must_use]
    pub(super) fn regularized(self) -> Self {
        let microfacets = self.conductor.microfacets.regularized();
        Self::new(Conductor { microfacets, ..self.conductor })
    }

    /// `1 - E` of a direction.
    fn later(&self, w: Vector3) -> f32 {
        let facets = self.facets();
        1.0 - EnergyTable::of(facets.shape).albedo(w.z, alpha_along(facets, w))
    }
}

/// The alpha of isotropic facets that lose about as much light in a direction: the root mean square of both towards
/// the normal, that of the azimuth towards the horizon.
pub(super) fn alpha_along(facets: AnyFacets, w: Vector3) -> f32 {
    let (x, y) = facets.alphas.alpha();
    (0.5 * (sqr(x) + sqr(y)) * sqr(w.z) + sqr(x * w.x) + sqr(y * w.y)).sqrt()
}

/// `E_avg`: the mean over azimuths and cosines, of facets of which that of an alpha and the albedo for cosine and alpha
/// are known.
pub(super) fn mean_energy(
    facets: AnyFacets,
    mean: impl Fn(f32) -> f32,
    albedo: impl Fn(f32, f32) -> f32,
) -> f32 {
    const N: usize = 8;
    let (x, y) = facets.alphas.alpha();
    if x == y {
        return mean(x);
    }
    let energy = |k: usize| {
        // Even in the squared cosine, by which E is weighted; a quarter of the turn stands for all.
        let cos = ((k / N) as f32 + 0.5).sqrt() / (N as f32).sqrt();
        let (sin_phi, cos_phi) = (FRAC_PI_2 * ((k % N) as f32 + 0.5) / N as f32).sin_cos();
        let sin = (1.0 - sqr(cos)).sqrt();
        albedo(cos, alpha_along(facets, Vector3::new(sin * cos_phi, sin * sin_phi, cos)))
    };
    (0..N * N).map(energy).sum::<f32>() / (N * N) as f32
}

/// `F_ms / (pi (1 - E_avg))`.
fn later_bounces(conductor: &Conductor<AnyFacets>) -> Sampled {
    let facets = conductor.microfacets;
    if facets.is_smooth() {
        return Sampled::ZERO;
    }
    let table = EnergyTable::of(facets.shape);
    let mean = mean_energy(facets, |alpha| table.mean(alpha), |cos, alpha| table.albedo(cos, alpha));
    if mean > 1.0 - 1e-5 {
        return Sampled::ZERO;
    }
    let f = mean_over_cosines(|cos| facets.metal_reflectance(cos * cos, conductor.eta, conductor.k));
    f * f * mean / (Sampled::ONE - f * (1.0 - mean)) * (FRAC_1_PI / (1.0 - mean)) // [Kulla and Conty 2017]
}

/// `2 ∫ F cos d cos` by Gauss's rule of four points.
pub(super) fn mean_over_cosines(f: impl Fn(f32) -> Sampled) -> Sampled {
    const GAUSS_4: [(f32, f32); 4] = [
        (0.069_431_84, 0.173_927_42),
        (0.330_009_48, 0.326_072_57),
        (0.669_990_5, 0.326_072_57),
        (0.930_568_2, 0.173_927_42),
    ];
    GAUSS_4.into_iter().fold(Sampled::ZERO, |sum, (cos, weight)| sum + f(cos) * (2.0 * cos * weight))
}

impl Lobed for CompensatedConductor {
    fn glossy(&self, to: Vector3, from: Vector3) -> Sampled {
        let once = self.conductor.eval(to, from, Lobes::ALL);
        once + self.scale * (self.later(to) * self.later(from))
    }

    fn mirror(&self, wo: Vector3) -> Sampled {
        self.conductor.microfacets.metal_reflectance(sqr(wo.z), self.conductor.eta, self.conductor.k)
    }

    fn shares(&self, _wo: Vector3) -> Shares {
        let mirror = f32::from(u8::from(self.facets().is_smooth()));
        Shares { diffuse: 0.0, glossy: 1.0 - mirror, mirror }
    }

    /// One bounce with the probability E, else evenly.
    fn sample_glossy(&self, wo: Vector3, u_choice: f32, u: Point2) -> Option<Vector3> {
        if u_choice < self.later(wo) {
            return Some(warp::sample_cosine_hemisphere(u));
        }
        self.conductor.sample(wo, u, Lobes::ALL).map(|sample| sample.wi)
    }

    fn glossy_pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        let later = self.later(wo);
        later * FRAC_1_PI * wi.z + (1.0 - later) * self.conductor.pdf(wo, wi, Lobes::ALL)
    }

    fn alpha(&self) -> f32 {
        self.facets().mean_alpha()
    }
}
