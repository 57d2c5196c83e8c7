//! Scattering at surfaces: bidirectional scattering distribution functions.
//!
//! `L_o(wo) = ∫ f(wo, wi) L_i(wi) |cos_i| dwi` over the whole sphere (SPEC BRDF-2 to BRDF-4). A [`Bsdf`] is a small
//! value, made by a material for one point and one set of wavelengths. Directions are unit vectors that point away
//! from the surface. `eval` is f in 1/sr without the cosine; `sample` returns the weight `f |cos| / pdf`; `pdf` is in
//! 1/sr. Dirac lobes are zero in `eval` and `pdf`, and carry a probability in their samples.
//!
//! Scattering is computed in the shading frame, where the interpolated or perturbed normal is +z. In importance mode
//! such a normal makes the surface asymmetric, and [`Bsdf`] corrects that in one place (Veach 1997, "Robust Monte
//! Carlo Methods for Light Transport Simulation", section 5.3). Reflection and transmission are told apart by the
//! shading normal alone; light may thus leak where it disagrees with the geometric one, as in pbrt-v4.

pub mod fresnel;
pub mod microfacet;

mod lobes;
mod local;

pub mod classic;
mod conductor;
mod dielectric;
mod diffuse;
mod diffuse_transmission;
pub mod facetted;
pub mod hair;
mod kept;
mod layered;
pub mod measured;
pub mod tabulated;
mod thin_dielectric;

pub mod catalogue;
pub mod laws;

#[cfg(test)]
mod tests;

use etendue_math::{Frame, Normal3, Point2, Vector3};
use etendue_spectrum::Sampled;

use self::classic::lobed::{self, Lobed};

pub use classic::Classic;
pub use conductor::Conductor;
pub use dielectric::Dielectric;
pub use diffuse::Diffuse;
pub use diffuse_transmission::DiffuseTransmission;
pub use facetted::Facetted;
pub use hair::Hair;
pub use layered::{Base, Layered};
pub use lobes::{BsdfSample, Lobes, TransportMode};
pub use measured::Measured;
pub use tabulated::Tabulated;
pub use thin_dielectric::ThinDielectric;

/// The scattering models, in the shading frame.
///
/// To add one: write a file with a plain struct and `lobes`, `eval`, `sample`, `pdf` as in `diffuse.rs`, add a
/// variant here, follow the compiler through the matches below, and add lines to [`catalogue`], whose every line
/// is held against the [`laws`] that a BSDF must keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BsdfKind {
    /// Lambert's reflection.
    Diffuse(Diffuse),
    /// Lambert's reflection and transmission.
    DiffuseTransmission(DiffuseTransmission),
    /// Metal.
    Conductor(Conductor),
    /// A boundary between transparent media.
    Dielectric(Dielectric),
    /// A thin pane.
    ThinDielectric(ThinDielectric),
    /// A coated diffuse or metal surface.
    Layered(Layered),
    /// Rough metal or glass of other facets, or with all bounces.
    Facetted(Facetted),
    /// A model of the literature: Phong, Ward, Schlick and others.
    Classic(Classic),
    /// Any isotropic reflection, by a table.
    Tabulated(Tabulated),
    /// A fibre.
    Hair(Hair),
    /// What an instrument saw.
    Measured(Measured),
}

impl BsdfKind {
    /// The lobes present.
    #[inline]
    #[must_use]
    pub fn lobes(&self) -> Lobes {
        match self {
            Self::Diffuse(bsdf) => bsdf.lobes(),
            Self::DiffuseTransmission(bsdf) => bsdf.lobes(),
            Self::Conductor(bsdf) => bsdf.lobes(),
            Self::Dielectric(bsdf) => bsdf.lobes(),
            Self::ThinDielectric(bsdf) => bsdf.lobes(),
            Self::Layered(bsdf) => bsdf.lobes(),
            Self::Facetted(bsdf) => bsdf.lobes(),
            Self::Classic(bsdf) => bsdf.lobes(),
            Self::Tabulated(bsdf) => lobed::lobes(bsdf),
            Self::Hair(bsdf) => bsdf.lobes(),
            Self::Measured(bsdf) => lobed::lobes(bsdf),
        }
    }

    /// f in 1/sr of the wanted lobes, without the cosine, for directions in the shading frame.
    #[inline]
    #[must_use]
    pub fn eval(&self, wo: Vector3, wi: Vector3, mode: TransportMode, lobes: Lobes) -> Sampled {
        match self {
            Self::Diffuse(bsdf) => bsdf.eval(wo, wi, lobes),
            Self::DiffuseTransmission(bsdf) => bsdf.eval(wo, wi, lobes),
            Self::Conductor(bsdf) => bsdf.eval(wo, wi, lobes),
            Self::Dielectric(bsdf) => bsdf.eval(wo, wi, mode, lobes),
            Self::ThinDielectric(_) => Sampled::ZERO,
            Self::Layered(bsdf) => bsdf.eval(wo, wi, mode, lobes),
            Self::Facetted(bsdf) => bsdf.eval(wo, wi, mode, lobes),
            Self::Classic(bsdf) => bsdf.eval(wo, wi, mode, lobes),
            Self::Tabulated(bsdf) => lobed::eval(bsdf, wo, wi, mode, lobes),
            Self::Hair(bsdf) => bsdf.eval(wo, wi, lobes),
            Self::Measured(bsdf) => lobed::eval(bsdf, wo, wi, mode, lobes),
        }
    }

    /// A direction in the shading frame, among the wanted lobes.
    #[inline]
    #[must_use]
    pub fn sample(
        &self,
        wo: Vector3,
        u_component: f32,
        u: Point2,
        mode: TransportMode,
        lobes: Lobes,
    ) -> Option<BsdfSample> {
        match self {
            Self::Diffuse(bsdf) => bsdf.sample(wo, u, lobes),
            Self::DiffuseTransmission(bsdf) => bsdf.sample(wo, u_component, u, lobes),
            Self::Conductor(bsdf) => bsdf.sample(wo, u, lobes),
            Self::Dielectric(bsdf) => bsdf.sample(wo, u_component, u, mode, lobes),
            Self::ThinDielectric(bsdf) => bsdf.sample(wo, u_component, lobes),
            Self::Layered(bsdf) => bsdf.sample(wo, u_component, u, mode, lobes),
            Self::Facetted(bsdf) => bsdf.sample(wo, u_component, u, mode, lobes),
            Self::Classic(bsdf) => bsdf.sample(wo, u_component, u, mode, lobes),
            Self::Tabulated(bsdf) => lobed::sample(bsdf, wo, u_component, u, mode, lobes),
            Self::Hair(bsdf) => bsdf.sample(wo, u_component, u, lobes),
            Self::Measured(bsdf) => lobed::sample(bsdf, wo, u_component, u, mode, lobes),
        }
    }

    /// True if [`Self::sample_by_density`] samples with just the density that [`Self::pdf`] claims.
    #[inline]
    #[must_use]
    pub fn has_density(&self) -> bool {
        match self {
            Self::Layered(bsdf) => bsdf.has_density(),
            _ => true,
        }
    }

    /// As [`Self::sample`] among all lobes, but with just the density that [`Self::pdf`] claims, for methods that divide by the
    /// density of what another path has found.
    #[inline]
    #[must_use]
    pub fn sample_by_density(
        &self,
        wo: Vector3,
        u_component: f32,
        u: Point2,
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        match self {
            Self::Layered(bsdf) => bsdf.sample_by_density(wo, u_component, u, mode),
            _ => self.sample(wo, u_component, u, mode, Lobes::ALL),
        }
    }

    /// Density of [`Self::sample`] in 1/sr.
    #[inline]
    #[must_use]
    pub fn pdf(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> f32 {
        match self {
            Self::Diffuse(bsdf) => bsdf.pdf(wo, wi, lobes),
            Self::DiffuseTransmission(bsdf) => bsdf.pdf(wo, wi, lobes),
            Self::Conductor(bsdf) => bsdf.pdf(wo, wi, lobes),
            Self::Dielectric(bsdf) => bsdf.pdf(wo, wi, lobes),
            Self::ThinDielectric(_) => 0.0,
            Self::Layered(bsdf) => bsdf.pdf(wo, wi, lobes),
            Self::Facetted(bsdf) => bsdf.pdf(wo, wi, lobes),
            Self::Classic(bsdf) => bsdf.pdf(wo, wi, lobes),
            Self::Tabulated(bsdf) => lobed::pdf(bsdf, wo, wi, lobes),
            Self::Hair(bsdf) => bsdf.pdf(wo, wi, lobes),
            Self::Measured(bsdf) => lobed::pdf(bsdf, wo, wi, lobes),
        }
    }

    /// [`Self::eval`] in radiance mode and [`Self::pdf`], of all lobes.
    #[inline]
    fn eval_and_pdf(&self, wo: Vector3, wi: Vector3) -> (Sampled, f32) {
        match self {
            Self::Diffuse(bsdf) => (bsdf.eval(wo, wi, Lobes::ALL), bsdf.pdf(wo, wi, Lobes::ALL)),
            Self::Conductor(bsdf) => bsdf.eval_and_pdf(wo, wi, Lobes::ALL),
            Self::Hair(bsdf) => bsdf.eval_and_pdf(wo, wi, Lobes::ALL),
            _ => (self.eval(wo, wi, TransportMode::Radiance, Lobes::ALL), self.pdf(wo, wi, Lobes::ALL)),
        }
    }

    /// The same with rougher facets where they are nearly smooth.
    #[must_use]
    pub fn regularized(self) -> Self {
        match self {
            Self::Conductor(bsdf) => {
                Self::Conductor(Conductor { microfacets: bsdf.microfacets.regularized(), ..bsdf })
            }
            Self::Dielectric(bsdf) => {
                Self::Dielectric(Dielectric { microfacets: bsdf.microfacets.regularized(), ..bsdf })
            }
            Self::Layered(bsdf) => Self::Layered(bsdf.regularized()),
            Self::Facetted(bsdf) => Self::Facetted(bsdf.regularized()),
            Self::Classic(bsdf) => Self::Classic(bsdf.regularized()),
            Self::Diffuse(_)
            | Self::DiffuseTransmission(_)
            | Self::ThinDielectric(_)
            | Self::Tabulated(_)
            | Self::Hair(_)
            | Self::Measured(_) => self,
        }
    }

    /// Fraction of light from a uniform surrounding that leaves towards `wo`: exact for diffuse surfaces, panes and hair, else
    /// the mean of a few fixed samples.
    #[must_use]
    pub fn albedo(&self, wo: Vector3) -> Sampled {
        match self {
            Self::Diffuse(bsdf) => bsdf.reflectance,
            Self::DiffuseTransmission(bsdf) => bsdf.reflectance + bsdf.transmittance,
            Self::ThinDielectric(_) => Sampled::ONE,
            Self::Hair(bsdf) => bsdf.albedo(wo),
            Self::Conductor(_)
            | Self::Dielectric(_)
            | Self::Layered(_)
            | Self::Facetted(_)
            | Self::Classic(_)
            | Self::Tabulated(_)
            | Self::Measured(_) => self.sampled_albedo(wo),
        }
    }

    /// [`Self::albedo`] from points of a rank-1 lattice.
    fn sampled_albedo(&self, wo: Vector3) -> Sampled {
        const N: u32 = 16;
        // Fractional parts of multiples of the powers of 1/g with g⁴ = g + 1 (Roberts 2018).
        const STEP: [f32; 3] = [0.819_172_5, 0.671_043_6, 0.549_700_5];
        let mut sum = Sampled::ZERO;
        for i in 0..N {
            let u = STEP.map(|step| (0.5 + step * i as f32).fract());
            let point = Point2::new(u[1], u[2]);
            if let Some(sample) = self.sample(wo, u[0], point, TransportMode::Importance, Lobes::ALL) {
                sum += sample.weight;
            }
        }
        sum / N as f32
    }
}

/// Scattering at a point of a surface, for directions in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bsdf {
    frame: Frame,
    ng: Normal3,
    kind: BsdfKind,
}

impl Bsdf {
    /// From the shading normal `ns`, the geometric normal `ng`, both unit vectors, and a tangent that anisotropy
    /// follows, of any length.
    #[inline]
    #[must_use]
    pub fn new(ns: Normal3, ng: Normal3, dpdu: Vector3, kind: BsdfKind) -> Self {
        Self { frame: Frame::from_zx(ns.as_vector(), dpdu), ng, kind }
    }

    /// From the shading normal `ns` and the geometric normal `ng`, both unit vectors, for a model without a preferred
    /// tangent.
    #[inline]
    #[must_use]
    pub fn isotropic(ns: Normal3, ng: Normal3, kind: BsdfKind) -> Self {
        Self { frame: Frame::from_z(ns.as_vector()), ng, kind }
    }

    /// The shading frame.
    #[inline]
    #[must_use]
    pub const fn frame(&self) -> Frame {
        self.frame
    }

    /// The shading normal.
    #[inline]
    #[must_use]
    pub const fn ns(&self) -> Normal3 {
        self.frame.z.as_normal()
    }

    /// The geometric normal.
    #[inline]
    #[must_use]
    pub const fn ng(&self) -> Normal3 {
        self.ng
    }

    /// The model in the shading frame.
    #[inline]
    #[must_use]
    pub const fn kind(&self) -> &BsdfKind {
        &self.kind
    }

    /// The lobes present.
    #[inline]
    #[must_use]
    pub fn lobes(&self) -> Lobes {
        self.kind.lobes()
    }

    /// The cosine that belongs to `eval`: with the shading normal, absolute.
    #[inline]
    #[must_use]
    pub fn abs_cos(&self, w: Vector3) -> f32 {
        w.dot(self.frame.z).abs()
    }

    /// f in 1/sr of the wanted lobes, without the cosine; multiply by [`Self::abs_cos`] of `wi`. 0 for Dirac lobes.
    #[inline]
    #[must_use]
    pub fn eval(&self, wo: Vector3, wi: Vector3, mode: TransportMode, lobes: Lobes) -> Sampled {
        let (local_o, local_i) = (self.frame.to_local(wo), self.frame.to_local(wi));
        if local_o.z == 0.0 || local_i.z == 0.0 {
            return Sampled::ZERO;
        }
        let f = self.kind.eval(local_o, local_i, mode, lobes);
        match mode {
            TransportMode::Radiance => f,
            TransportMode::Importance => f * self.shading_normal_correction(wo, wi),
        }
    }

    /// [`Self::eval`] times [`Self::abs_cos`] of `wi`, and [`Self::pdf`] of all lobes, in radiance mode.
    #[inline]
    #[must_use]
    pub fn eval_cos_and_pdf(&self, wo: Vector3, wi: Vector3) -> (Sampled, f32) {
        let (local_o, local_i) = (self.frame.to_local(wo), self.frame.to_local(wi));
        if local_o.z == 0.0 || local_i.z == 0.0 {
            return (Sampled::ZERO, 0.0);
        }
        let (f, pdf_w) = self.kind.eval_and_pdf(local_o, local_i);
        (f * local_i.z.abs(), pdf_w)
    }

    /// A direction among the wanted lobes, from a number that chooses the lobe and a point that chooses within it.
    /// `None` if the path ends here.
    #[inline]
    #[must_use]
    pub fn sample(
        &self,
        wo: Vector3,
        u_component: f32,
        u: Point2,
        mode: TransportMode,
        lobes: Lobes,
    ) -> Option<BsdfSample> {
        debug_assert!((0.0..1.0).contains(&u_component));
        let local_o = self.frame.to_local(wo);
        if local_o.z == 0.0 {
            return None;
        }
        let mut sample = self.kind.sample(local_o, u_component, u, mode, lobes)?;
        sample.wi = self.frame.to_world(sample.wi);
        if mode == TransportMode::Importance {
            sample.weight *= self.shading_normal_correction(wo, sample.wi);
        }
        (!sample.weight.is_black()).then_some(sample)
    }

    /// As [`Self::sample`] in radiance mode among all lobes, with just the density that [`Self::pdf`] claims, where the model
    /// [has one](BsdfKind::has_density). The weight may be black.
    #[inline]
    #[must_use]
    pub fn sample_by_density(&self, wo: Vector3, u_component: f32, u: Point2) -> Option<BsdfSample> {
        let local_o = self.frame.to_local(wo);
        if local_o.z == 0.0 {
            return None;
        }
        let sample = self.kind.sample_by_density(local_o, u_component, u, TransportMode::Radiance)?;
        Some(BsdfSample { wi: self.frame.to_world(sample.wi), ..sample })
    }

    /// Density of [`Self::sample`] in 1/sr, the same in both modes. 0 for Dirac lobes.
    #[inline]
    #[must_use]
    pub fn pdf(&self, wo: Vector3, wi: Vector3, mode: TransportMode, lobes: Lobes) -> f32 {
        let _ = mode; // No model's density depends on it; the parameter keeps calls to all three alike.
        let (local_o, local_i) = (self.frame.to_local(wo), self.frame.to_local(wi));
        if local_o.z == 0.0 || local_i.z == 0.0 {
            return 0.0;
        }
        self.kind.pdf(local_o, local_i, lobes)
    }

    /// GGX alpha of the glossy lobes, the mean of both tangents; 0 if there are none. Of a coated surface, that of the
    /// coat if it is rough, else that of the base.
    #[must_use]
    pub fn glossy_roughness(&self) -> f32 {
        match &self.kind {
            BsdfKind::Conductor(bsdf) => bsdf.microfacets.mean_alpha(),
            BsdfKind::Dielectric(bsdf) if bsdf.lobes().is_glossy() => bsdf.microfacets.mean_alpha(),
            BsdfKind::Layered(bsdf) if bsdf.lobes().is_glossy() => bsdf.glossy_roughness(),
            BsdfKind::Facetted(bsdf) => bsdf.glossy_roughness(),
            BsdfKind::Classic(bsdf) => bsdf.glossy_roughness(),
            BsdfKind::Tabulated(bsdf) if self.lobes().is_glossy() => bsdf.alpha(),
            BsdfKind::Hair(bsdf) => bsdf.alpha(),
            BsdfKind::Measured(bsdf) => bsdf.table.alpha(),
            _ => 0.0,
        }
    }

    /// Widens narrow lobes, for paths that have already scattered widely: less noise, a little bias. Dirac lobes
    /// become glossy.
    pub fn regularize(&mut self) {
        self.kind = self.kind.regularized();
    }

    /// Fraction of light from a uniform surrounding that leaves towards `wo`, for auxiliary images.
    #[must_use]
    pub fn albedo(&self, wo: Vector3) -> Sampled {
        let wo = self.frame.to_local(wo);
        if wo.z == 0.0 { Sampled::ZERO } else { self.kind.albedo(wo) }
    }

    /// What flux must be multiplied by where the shading normal differs from the geometric one [Veach 1997 (5.19)].
    #[inline]
    fn shading_normal_correction(&self, wo: Vector3, wi: Vector3) -> f32 {
        let numerator = wo.dot(self.frame.z).abs() * wi.dot_normal(self.ng).abs();
        let denominator = wo.dot_normal(self.ng).abs() * wi.dot(self.frame.z).abs();
        if denominator > 0.0 { numerator / denominator } else { 0.0 }
    }
}

/// Paths pass BSDFs by value: a large model keeps its tables elsewhere rather than grow the others.
const _: () = assert!(std::mem::size_of::<BsdfKind>() <= 112);
