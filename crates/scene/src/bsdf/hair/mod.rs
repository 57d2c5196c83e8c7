//! Hair and fur: a rough dielectric cylinder with tilted scales and absorption inside.
//!
//! For light that leaves at the angles theta_o to the normal plane of the fibre and phi_o about it, and comes from theta_i
//! and phi_i, paths p = 0 (reflected), 1 (through), 2 (reflected once inside) and all longer ones together carry
//! `S(wo, wi) = sum over p of M_p(theta_o, theta_i) A_p(theta_o, h) N_p(phi_i - phi_o, h)`, and
//! `f = S / |cos_i|`, so that the cosine of the surface cancels: a fibre is as wide from all sides (Chiang, Bitterli,
//! Tappan and Burley 2016, "A Practical and Controllable Hair and Fur Model for Production Path Tracing",
//! doi:10.1111/cgf.12830, after Marschner et al. 2003 and d'Eon et al. 2011). M_p and N_p are densities
//! ([`longitudinal`], [`azimuthal`]), and the attenuations of [`Hair::attenuations`] sum to 1 if nothing is absorbed, so
//! that white hair stays white in a furnace. h, where across the fibre it is seen, is a parameter.
//!
//! The fibre runs along x of the shading frame. All directions are sampled: first p by its share of A, then M_p, then
//! N_p.
//!
//! Light cannot take the way back: A_p and h belong to wo, and averages over h are only nearer to symmetric. In importance
//! mode f is the same, not the adjoint, as in pbrt-v4, so that light that is followed from its source is neither made nor
//! lost.

mod azimuthal;
mod longitudinal;

use std::f32::consts::PI;

use etendue_math::approx::{asin, atan2, sin_cos_turns};
use etendue_math::{ONE_MINUS_EPSILON, Point2, Vector3, safe_sqrt, sqr};
use etendue_spectrum::Sampled;

use self::azimuthal::TrimmedLogistic;
use self::longitudinal::Inclination;
use super::fresnel::fresnel_dielectric;
use super::local::{abs_cos, same_hemisphere};
use super::{BsdfSample, Lobes};

/// Kinds of paths: three by themselves, and the rest.
const N_PATHS: usize = 4;

/// How rough a fibre is, by the numbers of artists.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HairRoughness {
    /// Along the fibre, in (0, 1]; called beta_M in the paper.
    pub beta_m: f32,
    /// About the fibre, in (0, 1]; called beta_N in the paper.
    pub beta_n: f32,
    /// Tilt of the scales towards the root.
    pub alpha_rad: f32,
}

/// A fibre in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hair {
    /// Where across the fibre, from -1 to 1, on the side of y.
    h: f32,
    eta: f32,
    sigma_a: Sampled,
    /// Variance of M_0.
    v: f32,
    /// Width of the logistic.
    s: f32,
    sin_alpha: f32,
    cos_alpha: f32,
}

/// What the directions of light depend on: where it leaves.
struct View {
    inclination: Inclination,
    phi: f32,
    /// Angles of the ray with the normal of the cylinder about the fibre, outside and inside.
    gamma_o: f32,
    gamma_t: f32,
    attenuations: [Sampled; N_PATHS],
}

impl Hair {
    /// A fibre seen at the offset `h`, with the relative index `eta` of at least 1 and the absorption coefficient `sigma_a`
    /// per radius of the fibre.
    ///
    /// Widths are fits to what looks evenly spaced [Chiang et al. 2016 (7) and (8)].
    #[must_use]
    pub fn new(h: f32, roughness: HairRoughness, eta: f32, sigma_a: Sampled) -> Self {
        let HairRoughness { beta_m, beta_n, alpha_rad } = roughness;
        let v = sqr(0.726 * beta_m + 0.812 * sqr(beta_m) + 3.7 * beta_m.powi(20));
        let s = (PI / 8.0).sqrt() * (0.265 * beta_n + 1.194 * sqr(beta_n) + 5.372 * beta_n.powi(22));
        let (sin_alpha, cos_alpha) = alpha_rad.sin_cos();
        Self { h: h.clamp(-1.0, 1.0), eta, sigma_a, v, s, sin_alpha, cos_alpha }
    }

    /// The lobes present: light leaves to all sides.
    #[must_use]
    pub const fn lobes(&self) -> Lobes {
        Lobes::GLOSSY
    }

    /// GGX alpha of about the width along the fibre, the standard deviation of M_0.
    #[must_use]
    pub fn alpha(&self) -> f32 {
        self.v.sqrt().min(1.0)
    }

    /// Fraction of light from a uniform surrounding that leaves towards `wo`.
    #[must_use]
    pub fn albedo(&self, wo: Vector3) -> Sampled {
        self.view(wo).attenuations.into_iter().fold(Sampled::ZERO, |sum, a| sum + a)
    }

    /// f in 1/sr of the wanted lobes, the same in both modes.
    #[must_use]
    pub fn eval(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> Sampled {
        self.eval_and_pdf(wo, wi, lobes).0
    }

    /// Density of [`Self::sample`] in 1/sr.
    #[must_use]
    pub fn pdf(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> f32 {
        self.eval_and_pdf(wo, wi, lobes).1
    }

    /// [`Self::eval`] and [`Self::pdf`].
    #[inline(never)]
    #[must_use]
    pub fn eval_and_pdf(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> (Sampled, f32) {
        if !lobes.contains(lobe(wo, wi)) {
            return (Sampled::ZERO, 0.0);
        }
        let view = self.view(wo);
        let densities = self.densities(&view, wi);
        // Along the surface itself the cosine is 0, but f is to be a number.
        (view.scattered(densities) / abs_cos(wi).max(1e-12), view.pdf(densities))
    }

    /// A direction of one of the wanted lobes. Those of others are drawn too, and dropped.
    #[inline(never)]
    #[must_use]
    pub fn sample(&self, wo: Vector3, u_component: f32, u: Point2, lobes: Lobes) -> Option<BsdfSample> {
        let view = self.view(wo);
        let (path, u_azimuth) = choose(view.shares(), u_component)?;
        let (sin, cos) = self.tilted(&view, path).sample(self.variance(path), u);
        let spread =
            self.logistic(path).map_or_else(|| PI * (2.0 * u_azimuth - 1.0), |n| n.sample(u_azimuth));
        let (sin_phi, cos_phi) = sin_cos_turns((view.phi + self.turn(&view, path) + spread) / (2.0 * PI));
        let wi = Vector3::new(sin, cos * cos_phi, cos * sin_phi);
        let densities = self.densities(&view, wi);
        let pdf_w = view.pdf(densities);
        let lobe = lobe(wo, wi);
        let is_sound = lobes.contains(lobe) && pdf_w > 0.0 && pdf_w.is_finite();
        is_sound.then(|| BsdfSample {
            wi,
            weight: view.scattered(densities) / pdf_w,
            pdf_w,
            pmf: 0.0,
            lobe,
            eta: 1.0,
            roughness: self.alpha(),
        })
    }

    fn view(&self, wo: Vector3) -> View {
        let inclination = Inclination::of(wo);
        // Seen from behind, y is on the other hand.
        let h = if wo.z < 0.0 { -self.h } else { self.h };
        // In the normal plane the fibre refracts like a disk of this index (Marschner et al. 2003, appendix B).
        let eta_disk =
            safe_sqrt(sqr(self.eta) - sqr(inclination.sin)) / inclination.cos.max(f32::MIN_POSITIVE);
        let sin_gamma_t = (h / eta_disk).clamp(-1.0, 1.0);
        let sin_theta_t = inclination.sin / self.eta;
        // How far a path goes inside, in radii.
        let length = 2.0 * safe_sqrt(1.0 - sqr(sin_gamma_t)) / safe_sqrt(1.0 - sqr(sin_theta_t)).max(1e-6);
        View {
            phi: atan2(wo.z, wo.y),
            gamma_o: asin(h),
            gamma_t: asin(sin_gamma_t),
            attenuations: self.attenuations(inclination.cos * safe_sqrt(1.0 - sqr(h)), length),
            inclination,
        }
    }

    /// A_p: what Fresnel's equations and absorption leave, for light at the cosine `cos` to the surface of the cylinder
    /// that goes as many radii inside from wall to wall. Without absorption they sum to 1.
    fn attenuations(&self, cos: f32, length: f32) -> [Sampled; N_PATHS] {
        let reflected = fresnel_dielectric(cos, self.eta);
        let through = (self.sigma_a * -length).exp();
        let first = Sampled::splat(reflected);
        let second = through * sqr(1.0 - reflected);
        let third = second * through * reflected;
        let others = (third * through * reflected).safe_div(Sampled::ONE - through * reflected);
        [first, second, third, others]
    }

    /// M_p N_p for each p: densities of `wi` in 1/sr.
    fn densities(&self, view: &View, wi: Vector3) -> [f32; N_PATHS] {
        let inclination = Inclination::of(wi);
        let phi = atan2(wi.z, wi.y) - view.phi;
        std::array::from_fn(|path| {
            let m = self.tilted(view, path).density(&inclination, self.variance(path));
            m * self.logistic(path).map_or(0.5 / PI, |n| n.density(phi - self.turn(view, path)))
        })
    }

    /// What M_p is about: theta_o turned by the tilt of the scales, -2 alpha, alpha and 4 alpha.
    fn tilted(&self, view: &View, path: usize) -> Inclination {
        let (sin, cos) = (self.sin_alpha, self.cos_alpha);
        let doubled = |(sin, cos): (f32, f32)| (2.0 * sin * cos, sqr(cos) - sqr(sin));
        match path {
            0 => view.inclination.turned(doubled((-sin, cos))),
            1 => view.inclination.turned((sin, cos)),
            2 => view.inclination.turned(doubled(doubled((sin, cos)))),
            _ => view.inclination,
        }
    }

    /// The variance of M_p: light that is refracted is turned by half, that which is reflected inside by twice as much.
    fn variance(&self, path: usize) -> f32 {
        match path {
            0 => self.v,
            1 => 0.25 * self.v,
            _ => 4.0 * self.v,
        }
    }

    /// The rough part of N_p; `None` for long paths, which go everywhere.
    fn logistic(&self, path: usize) -> Option<TrimmedLogistic> {
        (path + 1 < N_PATHS).then(|| TrimmedLogistic::new(self.s))
    }

    /// By how much a smooth fibre turns light about itself. [Marschner et al. 2003 (8)]
    fn turn(&self, view: &View, path: usize) -> f32 {
        let p = path as f32;
        if path + 1 < N_PATHS { 2.0 * p * view.gamma_t - 2.0 * view.gamma_o + p * PI } else { 0.0 }
    }
}

impl View {
    /// Probabilities of the paths: by their light, the mean over wavelengths. All 0 if there is none.
    fn shares(&self) -> [f32; N_PATHS] {
        let light = self.attenuations.map(Sampled::average);
        let sum: f32 = light.iter().sum();
        light.map(|light| if sum > 0.0 { light / sum } else { 0.0 })
    }

    /// Density of directions, from those of the paths.
    fn pdf(&self, densities: [f32; N_PATHS]) -> f32 {
        self.shares().into_iter().zip(densities).map(|(share, density)| share * density).sum()
    }

    /// S, from the densities of the paths.
    fn scattered(&self, densities: [f32; N_PATHS]) -> Sampled {
        let terms = self.attenuations.into_iter().zip(densities);
        terms.fold(Sampled::ZERO, |sum, (a, density)| sum + a * density)
    }
}

/// The lobe of a pair of directions.
fn lobe(wo: Vector3, wi: Vector3) -> Lobes {
    if same_hemisphere(wo, wi) { Lobes::GLOSSY_REFLECT } else { Lobes::GLOSSY_TRANSMIT }
}

/// One of the paths by their probabilities, and a number from 0 to 1 that is left of the one used.
fn choose(shares: [f32; N_PATHS], mut u: f32) -> Option<(usize, f32)> {
    // Rounding may leave a little after the last: it belongs to the last that has a share.
    let last = shares.iter().rposition(|share| *share > 0.0)?;
    for (path, share) in shares.into_iter().enumerate() {
        if u < share || path == last {
            return Some((path, (u / share).clamp(0.0, ONE_MINUS_EPSILON)));
        }
        u -= share;
    }
    None
}
