//! What the models have in common: a sum of lobes, each with its own way to sample it.
//!
//! A sample comes from one lobe, chosen by its share; its density is that of the mixture,
//! `pdf = sum of share_k pdf_k`, and its weight `f |cos| / pdf` with the sum of all wanted lobes (one-sample multiple
//! importance sampling with the balance heuristic; Veach 1997, section 9.2.4). The lobe that a sample *names* is
//! drawn anew, by what each lobe contributes to f in that direction, so that light is split among path expressions by
//! f and not by the choice of densities. Where lobes differ in colour, the split is right for the sum over the
//! wavelengths.

use std::f32::consts::FRAC_1_PI;

use etendue_math::{ONE_MINUS_EPSILON, Point2, Vector3, warp};
use etendue_spectrum::Sampled;

use crate::bsdf::local::mirror;
use crate::bsdf::{BsdfSample, Lobes, TransportMode};

/// How much each lobe matters, without unit: about its albedo.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::bsdf) struct Shares {
    pub(in crate::bsdf) diffuse: f32,
    pub(in crate::bsdf) glossy: f32,
    pub(in crate::bsdf) mirror: f32,
}

impl Shares {
    /// Probabilities of the wanted lobes; all 0 if there is none.
    #[inline]
    fn among(self, lobes: Lobes) -> Self {
        let wanted = |lobe, share: f32| if lobes.contains(lobe) { share } else { 0.0 };
        let diffuse = wanted(Lobes::DIFFUSE_REFLECT, self.diffuse);
        let glossy = wanted(Lobes::GLOSSY_REFLECT, self.glossy);
        let mirror = wanted(Lobes::SPECULAR_REFLECT, self.mirror);
        let sum = diffuse + glossy + mirror;
        if sum > 0.0 {
            Self { diffuse: diffuse / sum, glossy: glossy / sum, mirror: mirror / sum }
        } else {
            Self::default()
        }
    }
}

/// A model as a sum of lobes. All directions are above the surface; those of `glossy_pdf` and `sample_glossy` are
/// `wo` and `wi` of the path, those of `diffuse` and `glossy` where light goes `to` and comes `from`.
pub(in crate::bsdf) trait Lobed {
    /// f of the diffuse-like lobe in 1/sr.
    fn diffuse(&self, _to: Vector3, _from: Vector3) -> Sampled {
        Sampled::ZERO
    }

    /// f of the glossy lobe in 1/sr.
    fn glossy(&self, _to: Vector3, _from: Vector3) -> Sampled {
        Sampled::ZERO
    }

    /// Reflectance of the mirror lobe.
    fn mirror(&self, _wo: Vector3) -> Sampled {
        Sampled::ZERO
    }

    /// How to share samples among the lobes; which are 0 does not depend on `wo`.
    fn shares(&self, wo: Vector3) -> Shares;

    /// A direction of the glossy lobe, perhaps below the surface; `u_choice` is for those with several parts.
    fn sample_glossy(&self, _wo: Vector3, _u_choice: f32, _u: Point2) -> Option<Vector3> {
        None
    }

    /// Density of [`Self::sample_glossy`] in 1/sr.
    fn glossy_pdf(&self, _wo: Vector3, _wi: Vector3) -> f32 {
        0.0
    }

    /// GGX alpha of about the width of the glossy lobe.
    fn alpha(&self) -> f32 {
        0.0
    }
}

/// The lobes present.
pub(in crate::bsdf) fn lobes(model: &impl Lobed) -> Lobes {
    let shares = model.shares(Vector3::new(0.0, 0.0, 1.0));
    let present = |share: f32, lobe| if share > 0.0 { lobe } else { Lobes::NONE };
    present(shares.diffuse, Lobes::DIFFUSE_REFLECT)
        | present(shares.glossy, Lobes::GLOSSY_REFLECT)
        | present(shares.mirror, Lobes::SPECULAR_REFLECT)
}

/// The pair seen from the side of `wo`; `None` unless both are on it.
#[inline]
fn above(wo: Vector3, wi: Vector3) -> Option<(Vector3, Vector3)> {
    let (wo, wi) = if wo.z < 0.0 { (flip(wo), flip(wi)) } else { (wo, wi) };
    (wo.z > 0.0 && wi.z > 0.0).then_some((wo, wi))
}

/// The image on the other side of the surface.
#[inline]
pub(in crate::bsdf) fn flip(w: Vector3) -> Vector3 {
    Vector3::new(w.x, w.y, -w.z)
}

/// f of the diffuse-like and the glossy lobe, as far as they are wanted.
#[inline]
fn parts(
    model: &impl Lobed,
    wo: Vector3,
    wi: Vector3,
    mode: TransportMode,
    lobes: Lobes,
) -> (Sampled, Sampled) {
    let (to, from) = match mode {
        TransportMode::Radiance => (wo, wi),
        TransportMode::Importance => (wi, wo),
    };
    let wanted = |lobe| lobes.contains(lobe);
    let diffuse = if wanted(Lobes::DIFFUSE_REFLECT) { model.diffuse(to, from) } else { Sampled::ZERO };
    let glossy = if wanted(Lobes::GLOSSY_REFLECT) { model.glossy(to, from) } else { Sampled::ZERO };
    (diffuse, glossy)
}

/// f in 1/sr.
pub(in crate::bsdf) fn eval(
    model: &impl Lobed,
    wo: Vector3,
    wi: Vector3,
    mode: TransportMode,
    lobes: Lobes,
) -> Sampled {
    let Some((wo, wi)) = above(wo, wi) else { return Sampled::ZERO };
    let (diffuse, glossy) = parts(model, wo, wi, mode, lobes);
    diffuse + glossy
}

/// Density of [`sample`] in 1/sr.
pub(in crate::bsdf) fn pdf(model: &impl Lobed, wo: Vector3, wi: Vector3, lobes: Lobes) -> f32 {
    let Some((wo, wi)) = above(wo, wi) else { return 0.0 };
    mixture_pdf(model, wo, wi, model.shares(wo).among(lobes))
}

#[inline]
fn mixture_pdf(model: &impl Lobed, wo: Vector3, wi: Vector3, shares: Shares) -> f32 {
    let glossy = if shares.glossy > 0.0 { shares.glossy * model.glossy_pdf(wo, wi) } else { 0.0 };
    glossy + shares.diffuse * FRAC_1_PI * wi.z
}

/// A direction of one of the wanted lobes.
pub(in crate::bsdf) fn sample(
    model: &impl Lobed,
    wo: Vector3,
    u_component: f32,
    u: Point2,
    mode: TransportMode,
    lobes: Lobes,
) -> Option<BsdfSample> {
    let is_below = wo.z < 0.0;
    let wo = if is_below { flip(wo) } else { wo };
    let to_side = |wi: Vector3| if is_below { flip(wi) } else { wi };
    let shares = model.shares(wo).among(lobes);
    if u_component < shares.mirror {
        let weight = model.mirror(wo) / shares.mirror;
        let wi = to_side(mirror(wo));
        return (wo.z > 0.0)
            .then(|| BsdfSample::specular(wi, weight, shares.mirror, Lobes::SPECULAR_REFLECT, 1.0));
    }
    let (u_component, is_diffuse) =
        (u_component - shares.mirror, u_component < shares.mirror + shares.diffuse);
    let (wi, u_rest) = if is_diffuse {
        (warp::sample_cosine_hemisphere(u), u_component / shares.diffuse)
    } else if shares.glossy > 0.0 {
        let u_rest = ((u_component - shares.diffuse) / shares.glossy).clamp(0.0, ONE_MINUS_EPSILON);
        (model.sample_glossy(wo, u_rest, u)?, u_rest)
    } else {
        return None;
    };
    let (wo, wi) = above(wo, wi)?;
    let pdf_w = mixture_pdf(model, wo, wi, shares);
    let (diffuse, glossy) = parts(model, wo, wi, mode, lobes);
    let weight = (diffuse + glossy) * (wi.z / pdf_w);
    if !(pdf_w > 0.0 && pdf_w.is_finite() && weight.is_finite()) {
        return None;
    }
    let (lobe, roughness) = if names_diffuse(diffuse.sum(), glossy.sum(), u_rest, is_diffuse) {
        (Lobes::DIFFUSE_REFLECT, 1.0)
    } else {
        (Lobes::GLOSSY_REFLECT, model.alpha())
    };
    Some(BsdfSample { wi: to_side(wi), weight, pdf_w, pmf: 0.0, lobe, eta: 1.0, roughness })
}

/// Whether a sample counts as diffuse: by the parts of f there, with the low digits of a number whose high digits may
/// be used already. Where f is 0 it is what was chosen.
#[inline]
pub(in crate::bsdf) fn names_diffuse(diffuse: f32, glossy: f32, u: f32, chosen: bool) -> bool {
    if diffuse + glossy > 0.0 { (u * 4096.0).fract() * (diffuse + glossy) < diffuse } else { chosen }
}
