//! Reflection and refraction at a plane interface between two media.
//!
//! With relative index `eta = eta_t / eta_i` and Snell's law `sin_i = eta sin_t`, the amplitudes for light polarised
//! parallel and perpendicular to the plane of incidence are
//! `r_par = (eta cos_i - cos_t) / (eta cos_i + cos_t)` and `r_perp = (cos_i - eta cos_t) / (cos_i + eta cos_t)`;
//! unpolarised light is reflected by `F = (r_par² + r_perp²) / 2` (Fresnel 1823; SPEC FRES-1 to FRES-8).
//! Polarisation is not followed along paths.

use etendue_math::{Vector3, safe_sqrt, sqr};
use etendue_spectrum::Sampled;

/// Mirror image of `w` about the unit normal `n`; both point away from the surface (SPEC FRES-1).
#[inline]
#[must_use]
pub fn reflect(w: Vector3, n: Vector3) -> Vector3 {
    n * (2.0 * w.dot(n)) - w
}

/// A refracted direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refraction {
    /// Direction away from the surface, on the other side.
    pub wt: Vector3,
    /// Index of the medium of `wt` relative to the medium that the light came from.
    pub eta: f32,
}

/// Refraction of `wi` (away from the surface) about the unit normal `n`, where `eta` is the index behind the surface,
/// on the side of `-n`, relative to that in front. Either side may hold `wi`. `None` for total internal reflection
/// (SPEC FRES-5 to FRES-7).
#[inline]
#[must_use]
pub fn refract(wi: Vector3, n: Vector3, eta: f32) -> Option<Refraction> {
    let cos = n.dot(wi);
    let (cos_i, n, eta) = if cos < 0.0 { (-cos, -n, 1.0 / eta) } else { (cos, n, eta) };
    let sin2_t = (1.0 - sqr(cos_i)).max(0.0) / sqr(eta);
    if sin2_t >= 1.0 {
        return None;
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    let wt = wi * (-1.0 / eta) + n * (cos_i / eta - cos_t); // [SPEC FRES-7]
    Some(Refraction { wt, eta })
}

/// Fraction of unpolarised light reflected between transparent media, where `cos_i` is the cosine between the
/// direction and the normal. If it is negative, the light comes from behind and `eta` is inverted (SPEC FRES-3).
#[inline]
#[must_use]
pub fn fresnel_dielectric(cos_i: f32, eta: f32) -> f32 {
    let cos_i = cos_i.clamp(-1.0, 1.0);
    let (cos_i, eta) = if cos_i < 0.0 { (-cos_i, 1.0 / eta) } else { (cos_i, eta) };
    let sin2_t = (1.0 - sqr(cos_i)) / sqr(eta);
    if sin2_t >= 1.0 {
        return 1.0;
    }
    let cos_t = safe_sqrt(1.0 - sin2_t);
    let parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    0.5 * (sqr(parallel) + sqr(perpendicular))
}

/// Fraction of unpolarised light reflected by an absorbing medium of relative index `eta + i k`, per wavelength.
///
/// The complex form of the equations, written with real numbers: with `a + i b = sqrt((eta + i k)² - sin²)`,
/// `R_perp = (a² + b² - 2 a cos + cos²) / (a² + b² + 2 a cos + cos²)` and
/// `R_par = R_perp (cos² (a² + b²) - 2 a cos sin² + sin⁴) / (cos² (a² + b²) + 2 a cos sin² + sin⁴)`.
#[inline]
#[must_use]
pub fn fresnel_conductor(cos_i: f32, eta: Sampled, k: Sampled) -> Sampled {
    fresnel_conductor_of_cos2(sqr(cos_i), eta, k)
}

/// [`fresnel_conductor`] by the squared cosine, which is all it depends on.
#[inline]
#[must_use]
pub fn fresnel_conductor_of_cos2(cos2: f32, eta: Sampled, k: Sampled) -> Sampled {
    let cos2 = cos2.min(1.0);
    let (eta, k) = (eta.to_array(), k.to_array());
    let mut reflected = [0.0; etendue_spectrum::N_LAMBDA];
    for (i, r) in reflected.iter_mut().enumerate() {
        *r = fresnel_complex(cos2, eta[i], k[i]);
    }
    Sampled::from_array(reflected)
}

/// One wavelength of [`fresnel_conductor`], `cos2` in [0, 1].
#[inline]
fn fresnel_complex(cos2: f32, eta: f32, k: f32) -> f32 {
    let sin2 = 1.0 - cos2;
    let real = sqr(eta) - sqr(k) - sin2;
    let a2_b2 = (sqr(real) + 4.0 * sqr(eta) * sqr(k)).sqrt();
    let two_a_cos = (2.0 * cos2 * (a2_b2 + real)).max(0.0).sqrt();
    let sum = a2_b2 + cos2;
    if sum + two_a_cos <= 0.0 {
        return 1.0; // Grazing incidence where both indices are equal: the limit of any other index.
    }
    let perpendicular = (sum - two_a_cos) / (sum + two_a_cos);
    let product = cos2 * a2_b2 + sqr(sin2);
    let parallel_ratio = (product - two_a_cos * sin2) / (product + two_a_cos * sin2).max(f32::MIN_POSITIVE);
    (0.5 * perpendicular * (1.0 + parallel_ratio)).clamp(0.0, 1.0)
}

/// Schlick's fit `F0 + (1 - F0) (1 - cos)⁵` (Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering";
/// SPEC FRES-4). Materials use the exact equations; this serves comparison.
///
/// As [`fresnel_dielectric`] for negative cosines. From the denser side the fit takes the cosine of the transmitted
/// light. Equal indices reflect nothing, which the bare formula gets wrong.
#[must_use]
pub fn fresnel_schlick(cos_i: f32, eta: f32) -> f32 {
    let cos_i = cos_i.clamp(-1.0, 1.0);
    let (cos_i, eta) = if cos_i < 0.0 { (-cos_i, 1.0 / eta) } else { (cos_i, eta) };
    if eta == 1.0 {
        return 0.0;
    }
    let sin2_t = (1.0 - sqr(cos_i)) / sqr(eta);
    if sin2_t >= 1.0 {
        return 1.0;
    }
    let cos = if eta < 1.0 { safe_sqrt(1.0 - sin2_t) } else { cos_i };
    let f0 = sqr((eta - 1.0) / (eta + 1.0));
    f0 + (1.0 - f0) * schlick_weight(cos)
}

/// `(1 - cos)⁵`: how far Schlick's fit is from the reflectance along the normal to 1.
#[inline]
#[must_use]
pub fn schlick_weight(cos: f32) -> f32 {
    (1.0 - cos).clamp(0.0, 1.0).powi(5)
}
