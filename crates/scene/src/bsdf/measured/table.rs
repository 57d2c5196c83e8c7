//! A measurement with what is needed to look it up and to sample it.

use std::f32::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

use etendue_math::approx::{atan2, sin_cos_turns};
use etendue_math::{Point2, Vector3, sqr};
use etendue_spectrum::{Bands, Sampled, Wavelengths};

use super::data::{MeasuredBrdf, Symmetry};
use super::maps::{Densities, Maps, Mixture};
use crate::bsdf::fresnel::reflect;
use crate::bsdf::kept::Kept;
use crate::bsdf::tabulated::alpha_of_half_width;

/// A measured BRDF, ready to sample. All directions are above the surface.
#[derive(Debug)]
pub struct MeasuredTable {
    brdf: Arc<MeasuredBrdf>,
    vndf: Densities,
    luminance: Densities,
    /// `spectra` by band in place of wavelength.
    bands: Maps,
    alpha: f32,
}

/// What the directions of light depend on: where it goes.
pub(super) struct View {
    mixture: Mixture,
    /// `wo`, turned or mirrored to where the surface was measured.
    wo: Vector3,
    /// What to multiply x and y of other directions by.
    flip: [f32; 2],
    /// From where azimuths of facets count.
    azimuth: f32,
}

impl MeasuredTable {
    /// The table of a measurement: one in a process for equal measurements, never freed.
    #[must_use]
    pub fn of(brdf: &Arc<MeasuredBrdf>) -> &'static Self {
        static TABLES: Kept<MeasuredTable> = Kept::new();
        TABLES.find_or_keep(
            |known| Arc::ptr_eq(&known.brdf, brdf) || known.brdf == *brdf,
            || Self::new(brdf.clone()),
        )
    }

    fn new(brdf: Arc<MeasuredBrdf>) -> Self {
        let parts = brdf.parts();
        Self {
            vndf: Densities::new(parts.vndf.clone()),
            luminance: Densities::new(parts.luminance.clone()),
            bands: by_band(&parts.spectra, &parts.wavelengths),
            alpha: alpha_of_half_width(half_width(&parts.ndf)),
            brdf,
        }
    }

    /// GGX alpha of about the width of the density of facets.
    pub(in crate::bsdf) const fn alpha(&self) -> f32 {
        self.alpha
    }

    /// True if it looks the same however it is turned.
    #[must_use]
    pub fn is_isotropic(&self) -> bool {
        self.brdf.is_isotropic()
    }

    /// f in 1/sr.
    pub(super) fn eval(&self, wo: Vector3, wi: Vector3, lambda: &Wavelengths) -> Sampled {
        let view = self.view(wo);
        let Some((m, _)) = view.facet(wi) else { return Sampled::ZERO };
        let u = self.vndf.invert(&view.mixture, m);
        self.reflected(&view, m, u, lambda) / wi.z
    }

    /// A direction, perhaps below the surface.
    pub(super) fn sample(&self, wo: Vector3, u: Point2) -> Option<Vector3> {
        let view = self.view(wo);
        let m = self.vndf.sample(&view.mixture, self.luminance.sample(&view.mixture, u));
        let facet = of_square(m, view.azimuth);
        let wi = reflect(view.wo, facet);
        (view.wo.dot(facet) > 0.0).then(|| view.flipped(wi).normalized())
    }

    /// Density of [`Self::sample`] in 1/sr.
    pub(super) fn pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        let view = self.view(wo);
        let Some((m, wo_dot_m)) = view.facet(wi) else { return 0.0 };
        let u = self.vndf.invert(&view.mixture, m);
        let in_square = self.vndf.pdf(&view.mixture, m) * self.luminance.pdf(&view.mixture, u);
        in_square / (4.0 * wo_dot_m * solid_angle(m.x))
    }

    /// `f cos_i` where facets are at `m` and the spectra at `u`.
    fn reflected(&self, view: &View, m: Point2, u: Point2, lambda: &Wavelengths) -> Sampled {
        let parts = self.brdf.parts();
        let scale = if parts.jacobian {
            parts.ndf.at(0, m) / (4.0 * parts.sigma.at(0, in_square(view.wo, 0.0)))
        } else {
            1.0
        };
        if !scale.is_finite() {
            return Sampled::ZERO;
        }
        if lambda.is_bands() {
            let band = |c| (self.bands.of_mixture(&view.mixture, 3, c, u) * scale).max(0.0);
            return lambda.of_bands(Bands::from_rgb([0, 1, 2].map(band)));
        }
        let n = parts.wavelengths.len();
        let value = |nm: f32| {
            let [(first, share), (second, other_share)] = neighbours(&parts.wavelengths, nm);
            let at = |index, share| {
                if share > 0.0 { share * parts.spectra.of_mixture(&view.mixture, n, index, u) } else { 0.0 }
            };
            ((at(first, share) + at(second, other_share)) * scale).max(0.0)
        };
        Sampled::from_array(lambda.lambda_nm().map(value))
    }

    fn view(&self, wo: Vector3) -> View {
        let parts = self.brdf.parts();
        // Azimuths begin at -180°: where y is -0, not 0.
        let to_negative = |c: f32| if c.is_sign_positive() { -1.0 } else { 1.0 };
        let flip = match self.brdf.symmetry() {
            Symmetry::Isotropic | Symmetry::None => [1.0; 2],
            Symmetry::Turned => [to_negative(wo.y); 2],
            Symmetry::Mirrored => [to_negative(wo.x), to_negative(wo.y)],
        };
        let wo = Vector3::new(wo.x * flip[0], wo.y * flip[1], wo.z);
        let (theta, phi) = (atan2(wo.x.hypot(wo.y), wo.z), atan2(wo.y, wo.x));
        let n_theta = parts.theta_i.len();
        let [a, b] = neighbours(&parts.phi_i, phi);
        let [c, d] = neighbours(&parts.theta_i, theta);
        let mixture =
            [(a, c), (a, d), (b, c), (b, d)].map(|(phi, theta)| (phi.0 * n_theta + theta.0, phi.1 * theta.1));
        View { mixture, wo, flip, azimuth: if self.is_isotropic() { phi } else { 0.0 } }
    }
}

impl View {
    fn flipped(&self, w: Vector3) -> Vector3 {
        Vector3::new(w.x * self.flip[0], w.y * self.flip[1], w.z)
    }

    /// The facet that reflects to `wi`, in the unit square, and its cosine with `wo`; `None` for opposite directions.
    fn facet(&self, wi: Vector3) -> Option<(Point2, f32)> {
        let m = (self.wo + self.flipped(wi)).try_normalized()?;
        Some((in_square(m, self.azimuth), self.wo.dot(m)))
    }
}

/// The place of a direction in the unit square.
pub(super) fn in_square(w: Vector3, azimuth: f32) -> Point2 {
    let theta = atan2(w.x.hypot(w.y), w.z);
    let turns = (atan2(w.y, w.x) - azimuth) / TAU + 0.5;
    Point2::new((theta / FRAC_PI_2).sqrt(), turns - turns.floor())
}

/// The direction at a place of the unit square.
pub(super) fn of_square(p: Point2, azimuth: f32) -> Vector3 {
    let (sin_theta, cos_theta) = sin_cos_turns(0.25 * sqr(p.x));
    let (sin_phi, cos_phi) = sin_cos_turns(p.y - 0.5 + azimuth / TAU);
    Vector3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta)
}

/// Solid angle per area of the unit square. At the pole, where it vanishes, a little more.
pub(super) fn solid_angle(x: f32) -> f32 {
    let (sin, _) = sin_cos_turns(0.25 * sqr(x));
    (2.0 * sqr(PI) * x * sin).max(1e-6)
}

/// Two indices of ascending values with weights, between which a value lies; the first or the last beyond them.
fn neighbours(values: &[f32], value: f32) -> [(usize, f32); 2] {
    let upper = values.partition_point(|known| *known <= value).min(values.len() - 1);
    let lower = upper.saturating_sub(1);
    let (below, above) = (values[lower], values[upper]);
    let share = if above > below { ((value - below) / (above - below)).clamp(0.0, 1.0) } else { 0.0 };
    [(lower, 1.0 - share), (upper, share)]
}

/// Spectra as three bands: at each node that of the spectrum there.
fn by_band(spectra: &Maps, wavelengths: &[f32]) -> Maps {
    let stride = spectra.size[0] * spectra.size[1];
    let mut values = Vec::with_capacity(3 * spectra.values.len() / wavelengths.len());
    for condition in spectra.values.chunks(stride * wavelengths.len()) {
        let colors: Vec<[f32; 3]> = (0..stride)
            .map(|node| {
                let at = |nm: f32| {
                    let parts = neighbours(wavelengths, nm)
                        .map(|(index, share)| share * condition[index * stride + node]);
                    (parts[0] + parts[1]).max(0.0)
                };
                Bands::of_reflectance(at).rgb()
            })
            .collect();
        values.extend((0..3).flat_map(|c| colors.iter().map(move |color| color[c])));
    }
    Maps { size: spectra.size, values }
}

/// Angle with the normal in radians where the density of facets falls to half; `None` if it does not.
fn half_width(ndf: &Maps) -> Option<f32> {
    const N_STEPS: usize = 512;
    let at = |i: usize| ndf.at(0, Point2::new(i as f32 / N_STEPS as f32, 0.5));
    let i = (1..=N_STEPS).find(|i| at(*i) < 0.5 * at(0))?;
    Some(FRAC_PI_2 * sqr(i as f32 / N_STEPS as f32))
}
