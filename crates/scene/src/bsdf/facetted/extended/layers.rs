//! Coat over sheen over base, as one sum of lobes.
//!
//! A layer lets `T(w) = 1 - albedo(w)` pass. The glossy lobe below is dimmed by the lesser T of both directions, as glTF
//! suggests for its sheen: that is reciprocal, keeps energy whatever the lobe, and is right where light leaves as steeply as
//! it came. The diffuse lobe is dimmed by the product of T of both directions over its mean, base included, which loses
//! nothing. A direction is chosen by one lobe, its density is that of all on its side.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_2};

use etendue_math::{ONE_MINUS_EPSILON, Point2, Vector3, sqr, warp};
use etendue_spectrum::Sampled;

use super::base::Base;
use super::coat::Coat;
use super::sheen::Sheen;
use crate::bsdf::classic::lobed::{flip, names_diffuse};
use crate::bsdf::dielectric::radiance_scale;
use crate::bsdf::fresnel::refract;
use crate::bsdf::local::mirror;
use crate::bsdf::{BsdfSample, Lobes, TransportMode};

/// All that a surface consists of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layers {
    pub(super) coat: Coat,
    pub(super) sheen: Sheen,
    pub(super) base: Base,
    /// Mean over the cosine of what the diffuse base gets: see [`Self::mean_passed`].
    pub(super) mean: Sampled,
}

/// The side that a surface is seen from. Directions are turned so that it is above.
#[derive(Clone, Copy)]
struct View {
    /// Index of the other side relative to this one.
    below: f32,
    /// True within a solid, where there is neither coat nor sheen.
    is_inside: bool,
}

/// Probabilities of the ways to sample.
#[derive(Clone, Copy, Default)]
struct Shares {
    mirror: f32,
    pass: f32,
    spread: [f32; 5],
}

/// Ways to sample that have densities, in the order of [`Shares::spread`].
#[derive(Clone, Copy, PartialEq)]
enum Way {
    Diffuse,
    Glossy,
    Coat,
    Sheen,
    Transmitted,
}

const WAYS: [Way; 5] = [Way::Diffuse, Way::Glossy, Way::Coat, Way::Sheen, Way::Transmitted];

impl Layers {
    /// The lobes present.
    pub(super) fn lobes(&self) -> Lobes {
        let present = |is_there, lobe| if is_there { lobe } else { Lobes::NONE };
        let base = &self.base;
        // From inside, rough glass reflects even where the outside has no highlight.
        let is_rough_glass = base.passes_rough() && base.eta != 1.0;
        let is_glossy =
            base.has_gloss() || is_rough_glass || self.coat.share > 0.0 || self.sheen.is_present();
        let is_diffuse = base.plastic() * base.color.max_value() > 0.0;
        present(is_diffuse, Lobes::DIFFUSE_REFLECT)
            | present(is_glossy, Lobes::GLOSSY_REFLECT)
            | present(base.has_mirror(), Lobes::SPECULAR_REFLECT)
            | present(base.passes_sharply(), Lobes::SPECULAR_TRANSMIT)
            | present(base.passes_rough(), Lobes::GLOSSY_TRANSMIT)
    }

    fn view(&self, wo: Vector3) -> View {
        let is_inside = wo.z < 0.0 && self.base.eta != 1.0;
        View { below: if is_inside { 1.0 / self.base.eta } else { self.base.eta }, is_inside }
    }

    /// What coat and sheen let pass.
    fn passed(&self, w: Vector3) -> Sampled {
        self.sheen.passed(w.z) * self.coat.passed(w)
    }

    /// What coat and sheen leave of a lobe from one direction above to another.
    fn dimmed(&self, to: Vector3, from: Vector3, view: View) -> Sampled {
        if view.is_inside { Sampled::ONE } else { self.passed(to).min(self.passed(from)) }
    }

    /// The same for a lobe from a direction above to one below: thin glass is coated on both sides.
    fn dimmed_through(&self, wo: Vector3, wi: Vector3, view: View) -> Sampled {
        if view.is_inside {
            self.passed(flip(wi))
        } else if view.below != 1.0 {
            self.passed(wo)
        } else {
            self.dimmed(wo, flip(wi), view)
        }
    }

    /// What reaches the diffuse base from a direction. A tilted coat is left to [`Self::diffuse`].
    fn passed_to_diffuse(&self, w: Vector3) -> Sampled {
        let coat = if self.coat.is_tilted() { 1.0 } else { self.coat.passed(w) };
        self.base.passed(w) * self.sheen.passed(w.z) * coat
    }

    /// `2 ∫` of that `cos d cos`, and the mean over azimuths, by Gauss's rule of eight points in the root of the cosine.
    pub(super) fn mean_passed(&self) -> Sampled {
        const GAUSS_8: [(f32, f32); 8] = [
            (0.019_855_072, 0.050_614_268),
            (0.101_666_76, 0.111_190_52),
            (0.237_233_8, 0.156_853_32),
            (0.408_282_68, 0.181_341_89),
            (0.591_717_3, 0.181_341_89),
            (0.762_766_2, 0.156_853_32),
            (0.898_333_25, 0.111_190_52),
            (0.980_144_9, 0.050_614_268),
        ];
        let (x, y) = self.base.facets.alpha();
        let n_azimuths = if x == y { 1 } else { 4 };
        let mut sum = Sampled::ZERO;
        for (t, weight) in GAUSS_8 {
            let (cos, weight) = (sqr(t), 4.0 * weight * t * sqr(t));
            let sin = (1.0 - sqr(cos)).max(0.0).sqrt();
            for k in 0..n_azimuths {
                let (sin_phi, cos_phi) = (FRAC_PI_2 * (k as f32 + 0.5) / n_azimuths as f32).sin_cos();
                let w = Vector3::new(sin * cos_phi, sin * sin_phi, cos);
                sum += self.passed_to_diffuse(w) * (weight / n_azimuths as f32);
            }
        }
        sum
    }

    fn diffuse(&self, to: Vector3, from: Vector3) -> Sampled {
        let scale = self.base.color * (self.base.plastic() * FRAC_1_PI);
        let both = self.passed_to_diffuse(to) * self.passed_to_diffuse(from);
        let tilted =
            if self.coat.is_tilted() { self.coat.passed(to).min(self.coat.passed(from)) } else { 1.0 };
        scale * both / self.mean.max(Sampled::splat(1e-6)) * tilted
    }

    fn glossy(&self, to: Vector3, from: Vector3, view: View) -> Sampled {
        let mut f = Sampled::ZERO;
        if self.base.has_gloss() || (view.is_inside && self.base.passes_rough()) {
            f = self.base.glossy(to, from, view.below) * self.dimmed(to, from, view);
        }
        if view.is_inside {
            return f;
        }
        if self.sheen.is_present() {
            f += self.sheen.eval(to, from) * self.coat.passed(to).min(self.coat.passed(from));
        }
        if self.coat.share > 0.0 { f + Sampled::splat(self.coat.eval(to, from)) } else { f }
    }

    /// f of the diffuse and the glossy lobe on the side of `wo`, or of the glossy one on the other side, as wanted.
    fn parts(&self, wo: Vector3, wi: Vector3, view: View, mode: TransportMode, lobes: Lobes) -> [Sampled; 2] {
        let wanted = |lobe, f: &dyn Fn() -> Sampled| if lobes.contains(lobe) { f() } else { Sampled::ZERO };
        if wi.z > 0.0 {
            let is_diffuse = self.base.plastic() > 0.0;
            let diffuse = || if is_diffuse { self.diffuse(wo, wi) } else { Sampled::ZERO };
            let glossy = || self.glossy(wo, wi, view);
            return [wanted(Lobes::DIFFUSE_REFLECT, &diffuse), wanted(Lobes::GLOSSY_REFLECT, &glossy)];
        }
        if !self.base.passes_rough() {
            return [Sampled::ZERO; 2];
        }
        let through = || self.base.transmitted(wo, wi, view.below, mode) * self.dimmed_through(wo, wi, view);
        [Sampled::ZERO, wanted(Lobes::GLOSSY_TRANSMIT, &through)]
    }

    /// f in 1/sr, without the cosine.
    pub(super) fn eval(&self, wo: Vector3, wi: Vector3, mode: TransportMode, lobes: Lobes) -> Sampled {
        let view = self.view(wo);
        let (wo, wi) = if wo.z < 0.0 { (flip(wo), flip(wi)) } else { (wo, wi) };
        if wo.z == 0.0 || wi.z == 0.0 {
            return Sampled::ZERO;
        }
        let [diffuse, glossy] = self.parts(wo, wi, view, mode, lobes);
        diffuse + glossy
    }

    /// Density of [`Self::sample`] in 1/sr.
    pub(super) fn pdf(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> f32 {
        let view = self.view(wo);
        let (wo, wi) = if wo.z < 0.0 { (flip(wo), flip(wi)) } else { (wo, wi) };
        if wo.z == 0.0 || wi.z == 0.0 {
            return 0.0;
        }
        self.mixture_pdf(wo, wi, view, &self.shares(wo, view, lobes))
    }

    /// About the albedo of each lobe.
    fn shares(&self, wo: Vector3, view: View, lobes: Lobes) -> Shares {
        let base = &self.base;
        let layers = if view.is_inside { 1.0 } else { self.passed(wo).max_value() };
        let wanted =
            |is_there: bool, lobe, share: f32| if is_there && lobes.contains(lobe) { share } else { 0.0 };
        let surface = |share: f32| layers * share.max(0.05);
        let mirrored = base.glass_reflectance_about(wo.z, view.below);
        let tint = base.glass() * base.color.max_value();
        let through =
            if base.has_mirror() || view.is_inside { 1.0 - mirrored } else { base.passed_about(wo) };
        let diffuse = base.plastic() * base.color.max_value();
        let has_gloss = base.has_gloss() || (view.is_inside && base.passes_rough());
        let glossy = base.reflectance_about(wo.z, view.below);
        let is_coated = !view.is_inside && self.coat.share > 0.0;
        let is_fibrous = !view.is_inside && self.sheen.is_present();
        let shares = Shares {
            mirror: wanted(base.has_mirror(), Lobes::SPECULAR_REFLECT, layers * base.glass() * mirrored),
            pass: wanted(base.passes_sharply(), Lobes::SPECULAR_TRANSMIT, layers * tint * through),
            spread: [
                wanted(diffuse > 0.0, Lobes::DIFFUSE_REFLECT, surface(diffuse * through)),
                wanted(has_gloss, Lobes::GLOSSY_REFLECT, surface(glossy)),
                wanted(is_coated, Lobes::GLOSSY_REFLECT, self.coat.albedo(wo).max(0.02)),
                wanted(
                    is_fibrous,
                    Lobes::GLOSSY_REFLECT,
                    (self.sheen.color.max_value() * self.sheen.albedo(wo.z)).max(0.02),
                ),
                wanted(base.passes_rough(), Lobes::GLOSSY_TRANSMIT, surface(tint * through)),
            ],
        };
        shares.normalized()
    }

    fn mixture_pdf(&self, wo: Vector3, wi: Vector3, view: View, shares: &Shares) -> f32 {
        let [diffuse, glossy, coat, sheen, transmitted] = shares.spread;
        let part = |share: f32, pdf: &dyn Fn() -> f32| if share > 0.0 { share * pdf() } else { 0.0 };
        if wi.z < 0.0 {
            return part(transmitted, &|| self.base.transmitted_pdf(wo, wi, view.below));
        }
        let even = diffuse * FRAC_1_PI * wi.z + sheen * 0.5 * FRAC_1_PI;
        even + part(glossy, &|| self.base.glossy_pdf(wo, wi)) + part(coat, &|| self.coat.pdf(wo, wi))
    }

    fn sample_way(&self, way: Way, wo: Vector3, view: View, u_choice: f32, u: Point2) -> Option<Vector3> {
        match way {
            Way::Diffuse => Some(warp::sample_cosine_hemisphere(u)),
            Way::Glossy => Some(self.base.sample_glossy(wo, u_choice, u)),
            Way::Coat => self.coat.sample(wo, u),
            Way::Sheen => Some(warp::sample_uniform_hemisphere(u)),
            Way::Transmitted => self.base.sample_transmitted(wo, view.below, u_choice, u),
        }
        .filter(|wi| if way == Way::Transmitted { wi.z < 0.0 } else { wi.z > 0.0 })
    }

    /// A direction of one of the lobes.
    pub(super) fn sample(
        &self,
        wo: Vector3,
        u_component: f32,
        u: Point2,
        mode: TransportMode,
        lobes: Lobes,
    ) -> Option<BsdfSample> {
        let view = self.view(wo);
        let is_below = wo.z < 0.0;
        let wo = if is_below { flip(wo) } else { wo };
        if wo.z == 0.0 {
            return None;
        }
        let shares = self.shares(wo, view, lobes);
        let sharp = shares.mirror + shares.pass;
        let mut sample = if u_component < shares.mirror {
            self.sample_mirror(wo, view, shares.mirror)
        } else if u_component < sharp {
            self.sample_pass(wo, view, mode, shares.pass)?
        } else {
            let (way, u_rest) = shares.choose(u_component - sharp)?;
            let wi = self.sample_way(way, wo, view, u_rest, u)?;
            let pdf_w = self.mixture_pdf(wo, wi, view, &shares);
            let [diffuse, glossy] = self.parts(wo, wi, view, mode, lobes);
            let weight = (diffuse + glossy) * (wi.z.abs() / pdf_w);
            if !(pdf_w > 0.0 && pdf_w.is_finite() && weight.is_finite()) {
                return None;
            }
            let is_diffuse = names_diffuse(diffuse.sum(), glossy.sum(), u_rest, way == Way::Diffuse);
            let (lobe, roughness) = self.name(way, is_diffuse);
            let eta = if way == Way::Transmitted { view.below } else { 1.0 };
            BsdfSample { wi, weight, pdf_w, pmf: 0.0, lobe, eta, roughness }
        };
        if is_below {
            sample.wi = flip(sample.wi);
        }
        Some(sample)
    }

    fn name(&self, way: Way, is_diffuse: bool) -> (Lobes, f32) {
        match way {
            Way::Transmitted => (Lobes::GLOSSY_TRANSMIT, self.base.facets.mean_alpha()),
            _ if is_diffuse => (Lobes::DIFFUSE_REFLECT, 1.0),
            Way::Coat => (Lobes::GLOSSY_REFLECT, self.coat.facets.mean_alpha()),
            Way::Sheen => (Lobes::GLOSSY_REFLECT, 1.0),
            Way::Diffuse | Way::Glossy => (Lobes::GLOSSY_REFLECT, self.base.facets.mean_alpha()),
        }
    }

    fn sample_mirror(&self, wo: Vector3, view: View, pmf: f32) -> BsdfSample {
        let wi = mirror(wo);
        let reflected = self.base.glass_reflectance(wo.z, view.below) * self.base.glass();
        let weight = reflected * self.dimmed(wo, wi, view) / pmf;
        BsdfSample::specular(wi, weight, pmf, Lobes::SPECULAR_REFLECT, 1.0)
    }

    /// Light that glass sends into a single direction: what its mirror does not reflect, or, of rough facets that do not
    /// bend light, what all their bounces leave.
    fn sample_pass(&self, wo: Vector3, view: View, mode: TransportMode, pmf: f32) -> Option<BsdfSample> {
        let passed = if self.base.has_mirror() {
            Sampled::ONE - self.base.glass_reflectance(wo.z, view.below)
        } else {
            self.base.passed(wo)
        };
        let wi =
            if view.below == 1.0 { -wo } else { refract(wo, Vector3::new(0.0, 0.0, 1.0), view.below)?.wt };
        let tint = self.base.color * (self.base.glass() * radiance_scale(view.below, mode) / pmf);
        let weight = passed * tint * self.dimmed_through(wo, wi, view);
        (wi.z < 0.0).then(|| BsdfSample::specular(wi, weight, pmf, Lobes::SPECULAR_TRANSMIT, view.below))
    }
}

impl Shares {
    fn normalized(self) -> Self {
        let sum = self.mirror + self.pass + self.spread.iter().sum::<f32>();
        if sum <= 0.0 {
            return Self::default();
        }
        Self {
            mirror: self.mirror / sum,
            pass: self.pass / sum,
            spread: self.spread.map(|share| share / sum),
        }
    }

    /// A way by a number below the sum of [`Self::spread`], and what remains of the number, in [0, 1).
    fn choose(&self, mut u: f32) -> Option<(Way, f32)> {
        let mut last = None;
        for (way, share) in WAYS.into_iter().zip(self.spread).filter(|(_, share)| *share > 0.0) {
            if u < share {
                return Some((way, (u / share).clamp(0.0, ONE_MINUS_EPSILON)));
            }
            u -= share;
            last = Some((way, ONE_MINUS_EPSILON));
        }
        last
    }
}
