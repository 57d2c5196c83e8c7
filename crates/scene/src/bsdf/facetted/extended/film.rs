//! What a clear film over a surface makes of its reflectance: the colours of soap, oil and tempered steel.
//!
//! Amplitudes that bounce in the film sum to `r = (r12 + r23 e^(i d)) / (1 + r12 r23 e^(i d))` with the phase
//! `d = 4 pi n2 t cos_2 / lambda` (Airy 1833; Born and Wolf, *Principles of Optics*, section 7.6), for either
//! polarisation. Belcour and Barla 2017, "A Practical Extension to Microfacet Theory for the Modeling of Varying
//! Iridescence", integrate that over the sensitivities of three sensors; a path knows its wavelengths, so nothing is
//! left to integrate. As in glTF the index of what is below follows from its reflectance along the normal, without
//! absorption, also for metal. Outside is air, also under a coat.

use etendue_math::{approx::sin_cos_turns, sqr};
use etendue_spectrum::Sampled;

/// A film on facets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinFilm {
    /// Share of the facets that have it, in [0, 1].
    pub share: f32,
    /// Its index of refraction, at least 1.
    pub ior: f32,
    /// Its thickness in nm.
    pub thickness_nm: f32,
}

impl ThinFilm {
    /// glTF's defaults: no film; where there is one, of index 1.3 and 400 nm.
    pub const NONE: Self = Self { share: 0.0, ior: 1.3, thickness_nm: 400.0 };

    /// Reflectance at the angle of that cosine, where `f0` is that without film along the normal.
    #[must_use]
    pub fn reflectance(&self, cos: f32, f0: Sampled, lambda_nm: [f32; 4]) -> Sampled {
        let f0 = f0.to_array();
        // At the horizon itself equal indices have no limit.
        let cos = cos.clamp(1e-4, 1.0);
        let cos_film = refracted(cos, self.ior);
        let upper = amplitudes([1.0, self.ior], [cos, cos_film]);
        let path = 2.0 * self.ior * self.thickness_nm * cos_film;
        Sampled::from_array(std::array::from_fn(|i| {
            // The index that reflects f0; white things have a very large one.
            let root = f0[i].max(0.0).sqrt().min(0.9999);
            let below = (1.0 + root) / (1.0 - root);
            let lower = amplitudes([self.ior, below], [cos_film, refracted(cos, below)]);
            let cos_phase = sin_cos_turns(path / lambda_nm[i]).1;
            0.5 * (airy(upper[0], lower[0], cos_phase) + airy(upper[1], lower[1], cos_phase))
        }))
    }
}

/// Cosine in a medium of light that comes from air.
fn refracted(cos: f32, index: f32) -> f32 {
    (sqr(index) - 1.0 + sqr(cos)).sqrt() / index
}

/// Amplitudes that an interface reflects of light polarised perpendicular and parallel to the plane of incidence.
fn amplitudes([n1, n2]: [f32; 2], [cos1, cos2]: [f32; 2]) -> [f32; 2] {
    let ratio = |a: f32, b: f32| (a - b) / (a + b);
    [ratio(n1 * cos1, n2 * cos2), ratio(n2 * cos1, n1 * cos2)]
}

/// The squared modulus of `r` of the module's text.
fn airy(r12: f32, r23: f32, cos_phase: f32) -> f32 {
    let mixed = 2.0 * r12 * r23 * cos_phase;
    let all = 1.0 + sqr(r12 * r23) + mixed;
    // Two perfect mirrors out of phase: everything is reflected whatever is a little nearer the truth.
    if all > 1e-12 { ((sqr(r12) + sqr(r23) + mixed) / all).clamp(0.0, 1.0) } else { 1.0 }
}
