//! A dielectric coat over an opaque base: varnished wood, plastic, lacquered metal.
//!
//! Light enters through the coat, bounces between base and coat at the same point, perhaps scatters in a medium between
//! them, and leaves through the coat. The series of bounces has no closed form; a random walk in depth alone,
//! `z` in [0, thickness], estimates it (Guo, Hasan and Zhao 2018, "Position-Free Monte Carlo Simulation for Arbitrary
//! Layered BSDFs"; Pharr, Jakob and Humphreys 2023, "Physically Based Rendering", section 14.3).
//! The surface looks the same from both sides. The medium has unit extinction, so light that crosses without
//! scattering is attenuated by `exp(-thickness / |cos|)`, also where the albedo is 0.
//!
//! Thus `eval` is a random value whose mean over `wo` and `wi` is right, a fixed function of its arguments since
//! the walk is seeded with them. A sample's weight is that of its own walk. `pdf` is a closed-form likeness
//! of the walks' density, positive wherever they lead: it serves to weigh techniques, and any function does that without
//! bias if all techniques use the same.
//!
//! The lobes are the reflection on the coat (specular or glossy), and everything that has been below it: diffuse if base
//! or medium are, else glossy, or specular if nothing on the way was rough.

use std::f32::consts::{FRAC_1_PI, PI};

use etendue_math::warp::{sample_cosine_hemisphere, sample_uniform_hemisphere, uniform_hemisphere_pdf};
use etendue_math::{Frame, Point2, Rng, Vector3, hash64, sqr};
use etendue_spectrum::Sampled;

use super::conductor::Conductor;
use super::dielectric::Dielectric;
use super::diffuse::Diffuse;
use super::fresnel::{fresnel_conductor, fresnel_dielectric, refract};
use super::local::{abs_cos, same_hemisphere};
use super::microfacet::Microfacets;
use super::{BsdfSample, Lobes, TransportMode};

/// The share of the density of light from below the coat that is uniform, so that it is nowhere near 0.
const UNIFORM_SHARE: f32 = 0.1;

/// What lies under the coat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Base {
    /// Lambert's reflection.
    Diffuse(Diffuse),
    /// Metal, whose indices are relative to the coat.
    Conductor(Conductor),
}

impl Base {
    #[inline]
    fn lobes(&self) -> Lobes {
        match self {
            Self::Diffuse(base) => base.lobes(),
            Self::Conductor(base) => base.lobes(),
        }
    }

    #[inline]
    fn eval(&self, wo: Vector3, wi: Vector3) -> Sampled {
        match self {
            Self::Diffuse(base) => base.eval(wo, wi, Lobes::ALL),
            Self::Conductor(base) => base.eval(wo, wi, Lobes::ALL),
        }
    }

    #[inline]
    fn sample(&self, wo: Vector3, u: Point2) -> Option<BsdfSample> {
        match self {
            Self::Diffuse(base) => base.sample(wo, u, Lobes::ALL),
            Self::Conductor(base) => base.sample(wo, u, Lobes::ALL),
        }
    }

    #[inline]
    fn pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        match self {
            Self::Diffuse(base) => base.pdf(wo, wi, Lobes::ALL),
            Self::Conductor(base) => base.pdf(wo, wi, Lobes::ALL),
        }
    }
}

/// A coated surface in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layered {
    /// The coat.
    pub coat: Dielectric,
    /// What it covers.
    pub base: Base,
    /// Distance between both, as optical depth of the medium: its extinction is 1.
    pub thickness: f32,
    /// Mean cosine of scattering in the medium, in (-1, 1).
    pub g: f32,
    /// Albedo of the medium; black for a coat that does not scatter.
    pub albedo: Sampled,
    /// Largest number of events on a walk.
    pub max_depth: u16,
    /// Walks per evaluation.
    pub n_samples: u16,
}

/// Where a walk is, which way it goes and what it carries.
struct Walk {
    w: Vector3,
    z: f32,
    beta: Sampled,
}

/// What stopped a step through the medium.
enum Step {
    Scattered,
    AtBase,
    AtCoat,
}

impl Layered {
    /// The lobes present.
    #[inline]
    #[must_use]
    pub fn lobes(&self) -> Lobes {
        self.coat_lobe() | self.walk_lobes()
    }

    /// The lobe of reflection on the coat.
    #[inline]
    fn coat_lobe(&self) -> Lobes {
        self.coat.lobes() & Lobes::REFLECT
    }

    /// The lobes of light that has been below the coat.
    #[inline]
    fn walk_lobes(&self) -> Lobes {
        let specular = if !self.coat.lobes().has_non_specular() && self.base.lobes().is_specular() {
            Lobes::SPECULAR_REFLECT
        } else {
            Lobes::NONE
        };
        specular | self.rough_walk_lobe()
    }

    /// The lobe of such light unless all its events were specular; empty if they always are.
    #[inline]
    fn rough_walk_lobe(&self) -> Lobes {
        if self.base.lobes().is_diffuse() || !self.albedo.is_black() {
            Lobes::DIFFUSE_REFLECT
        } else if self.coat.lobes().has_non_specular() || self.base.lobes().is_glossy() {
            Lobes::GLOSSY_REFLECT
        } else {
            Lobes::NONE
        }
    }

    /// What may happen on the coat when light enters, if `lobes` are wanted.
    #[inline]
    fn entry_lobes(&self, lobes: Lobes) -> Lobes {
        let reflect = if lobes.intersects(self.coat_lobe()) { Lobes::REFLECT } else { Lobes::NONE };
        let transmit = if lobes.intersects(self.walk_lobes()) { Lobes::TRANSMIT } else { Lobes::NONE };
        reflect | transmit
    }

    /// An estimate of f in 1/sr, without the cosine.
    #[must_use]
    pub fn eval(&self, wo: Vector3, wi: Vector3, mode: TransportMode, lobes: Lobes) -> Sampled {
        if !same_hemisphere(wo, wi) {
            return Sampled::ZERO;
        }
        let (wo, wi) = if wo.z < 0.0 { (-wo, -wi) } else { (wo, wi) };
        let mut f = self.coat.eval(wo, wi, mode, lobes & Lobes::REFLECT);
        if lobes.intersects(self.rough_walk_lobe()) {
            let mut rng = walk_rng(wo, [wi.x, wi.y, wi.z]);
            let mut sum = Sampled::ZERO;
            for _ in 0..self.n_samples {
                sum += self.eval_walk(wo, wi, mode, &mut rng);
            }
            f += sum / f32::from(self.n_samples);
        }
        f
    }

    /// One walk from `wo`, connected to `wi` at every vertex.
    fn eval_walk(&self, wo: Vector3, wi: Vector3, mode: TransportMode, rng: &mut Rng) -> Sampled {
        let Some(entry) = self.coat.sample(wo, rng.next_f32(), random_2d(rng), mode, Lobes::TRANSMIT) else {
            return Sampled::ZERO;
        };
        // A direction inside that leaves towards `wi`: a light seen through the coat.
        let Some(exit) =
            self.coat.sample(wi, rng.next_f32(), random_2d(rng), mode.flipped(), Lobes::TRANSMIT)
        else {
            return Sampled::ZERO;
        };
        let mut walk = Walk { w: entry.wi, z: self.thickness, beta: entry.weight };
        let mut f = Sampled::ZERO;
        for depth in 0..self.max_depth {
            if !survives_roulette(&mut walk.beta, depth, rng) {
                break;
            }
            let arrival = walk.w;
            match self.step(&mut walk, rng) {
                None => break,
                Some(Step::Scattered) => f += self.connect_medium(&walk, arrival, wi, &exit, mode),
                Some(Step::AtCoat) => {
                    let coat =
                        self.coat.sample(-walk.w, rng.next_f32(), random_2d(rng), mode, Lobes::REFLECT);
                    let Some(bounce) = coat else { break };
                    walk.beta *= bounce.weight;
                    walk.w = bounce.wi;
                }
                Some(Step::AtBase) => {
                    f += self.connect_base(&walk, &exit);
                    let Some(bounce) = self.base.sample(-walk.w, random_2d(rng)) else { break };
                    walk.beta *= bounce.weight;
                    walk.w = bounce.wi;
                    f += self.connect_coat(&walk, self.thickness, wi, density_of(&bounce), mode);
                }
            }
        }
        f
    }

    /// From a point in the medium, where light came along `arrival` and has been scattered to `walk.w`.
    fn connect_medium(
        &self,
        walk: &Walk,
        arrival: Vector3,
        wi: Vector3,
        exit: &BsdfSample,
        mode: TransportMode,
    ) -> Sampled {
        let phase = henyey_greenstein(arrival.dot(-exit.wi), self.g);
        let weight = if exit.is_specular() { 1.0 } else { power_heuristic(exit.pdf_w, phase) };
        let distance = self.thickness - walk.z;
        let mut by_exit = Sampled::splat(phase * weight * transmittance(distance, exit.wi));
        if exit.is_specular()
            && let Base::Conductor(mirror) = self.base
        {
            by_exit = self.add_mirrored(by_exit, &mirror, walk.z, arrival, exit.wi);
        }
        // `walk.beta` already holds the albedo: both ways of leaving share it.
        let by_exit = by_exit * exit.weight / abs_cos(exit.wi);
        let by_phase = if walk.w.z > 0.0 {
            let sampled = henyey_greenstein(arrival.dot(walk.w), self.g);
            self.connect_coat(walk, distance, wi, Some(sampled), mode)
        } else {
            Sampled::ZERO
        };
        walk.beta * by_exit + by_phase
    }

    /// Between a smooth coat and a mirror, the walk cannot find what leaves after further mirror reflections. They all leave
    /// at the same angle: what starts `up` or down from height `z` is multiplied by a geometric series.
    fn add_mirrored(
        &self,
        up: Sampled,
        base: &Conductor,
        z: f32,
        arrival: Vector3,
        exit: Vector3,
    ) -> Sampled {
        if !base.microfacets.is_smooth() {
            return up;
        }
        let mirror = fresnel_conductor(abs_cos(exit), base.eta, base.k);
        let phase = henyey_greenstein(arrival.dot(Vector3::new(-exit.x, -exit.y, exit.z)), self.g);
        let down = mirror * (phase * transmittance(z + self.thickness, exit));
        let coat = fresnel_dielectric(-abs_cos(exit), self.coat.eta);
        let round_trip = mirror * (coat * transmittance(2.0 * self.thickness, exit));
        (up + down) / (Sampled::ONE - round_trip)
    }

    /// From the base towards the direction inside that leaves to `wi`.
    fn connect_base(&self, walk: &Walk, exit: &BsdfSample) -> Sampled {
        if self.base.lobes().is_specular() {
            return Sampled::ZERO;
        }
        let pdf_base = self.base.pdf(-walk.w, -exit.wi);
        let weight = if exit.is_specular() { 1.0 } else { power_heuristic(exit.pdf_w, pdf_base) };
        let through = transmittance(self.thickness, exit.wi) * weight;
        // The sample's cosine belongs to the vertex on the base.
        walk.beta * self.base.eval(-walk.w, -exit.wi) * exit.weight * through
    }

    /// Through a rough coat along `walk.w`, chosen with `density` (`None` for a Dirac), to `wi`.
    fn connect_coat(
        &self,
        walk: &Walk,
        distance: f32,
        wi: Vector3,
        density: Option<f32>,
        mode: TransportMode,
    ) -> Sampled {
        if !self.coat.lobes().has_non_specular() {
            return Sampled::ZERO;
        }
        let f = self.coat.eval(-walk.w, wi, mode, Lobes::TRANSMIT);
        if f.is_black() {
            return Sampled::ZERO;
        }
        let weight = density.map_or(1.0, |pdf| power_heuristic(pdf, self.exit_pdf(walk.w, wi)));
        walk.beta * f * (weight * transmittance(distance, walk.w))
    }

    /// Density with which sampling the coat from `wi` finds the direction inside that arrives along `w`.
    #[inline]
    fn exit_pdf(&self, w: Vector3, wi: Vector3) -> f32 {
        self.coat.pdf(wi, -w, Lobes::TRANSMIT)
    }

    /// Moves the walk to where it scatters or to the next interface; `None` if it goes nowhere.
    #[inline]
    fn step(&self, walk: &mut Walk, rng: &mut Rng) -> Option<Step> {
        if walk.w.z == 0.0 {
            return None;
        }
        if self.albedo.is_black() {
            walk.beta *= transmittance(self.thickness, walk.w);
        } else {
            let depth = -(1.0 - rng.next_f32()).ln() * walk.w.z;
            let z = walk.z + depth;
            if z > 0.0 && z < self.thickness && depth != 0.0 {
                walk.z = z;
                walk.w = sample_henyey_greenstein(walk.w, self.g, random_2d(rng));
                walk.beta *= self.albedo;
                return Some(Step::Scattered);
            }
        }
        if walk.w.z > 0.0 {
            walk.z = self.thickness;
            Some(Step::AtCoat)
        } else {
            walk.z = 0.0;
            Some(Step::AtBase)
        }
    }

    /// A direction by reflection on the coat or by one walk below it.
    #[must_use]
    pub fn sample(
        &self,
        wo: Vector3,
        u_component: f32,
        u: Point2,
        mode: TransportMode,
        lobes: Lobes,
    ) -> Option<BsdfSample> {
        let side = 1.0_f32.copysign(wo.z);
        let wo = wo * side;
        let entry = self.coat.sample(wo, u_component, u, mode, self.entry_lobes(lobes))?;
        let mut sample = if entry.is_transmission() {
            let mut rng = walk_rng(wo, [u_component, u.x, u.y]);
            self.sample_walk(entry, mode, &mut rng).filter(|sample| lobes.contains(sample.lobe))?
        } else {
            entry
        };
        if !sample.is_specular() {
            sample.pdf_w = self.pdf(wo, sample.wi, lobes);
        }
        sample.wi *= side;
        (sample.wi.z != 0.0).then_some(sample)
    }

    /// Follows light that has entered until it leaves.
    fn sample_walk(&self, entry: BsdfSample, mode: TransportMode, rng: &mut Rng) -> Option<BsdfSample> {
        let mut walk = Walk { w: entry.wi, z: self.thickness, beta: entry.weight };
        let mut pmf = entry.pmf;
        let mut is_specular = entry.is_specular();
        for depth in 0..self.max_depth {
            if !survives_roulette(&mut walk.beta, depth, rng) {
                return None;
            }
            let bounce = match self.step(&mut walk, rng)? {
                Step::Scattered => {
                    is_specular = false;
                    continue;
                }
                Step::AtBase => self.base.sample(-walk.w, random_2d(rng))?,
                Step::AtCoat => {
                    self.coat.sample(-walk.w, rng.next_f32(), random_2d(rng), mode, Lobes::ALL)?
                }
            };
            walk.beta *= bounce.weight;
            walk.w = bounce.wi;
            pmf *= bounce.pmf;
            is_specular &= bounce.is_specular();
            if bounce.is_transmission() {
                return Some(self.leave(&walk, is_specular, pmf));
            }
        }
        None
    }

    /// The sample that a finished walk makes; its density is filled in later.
    fn leave(&self, walk: &Walk, is_specular: bool, pmf: f32) -> BsdfSample {
        if is_specular {
            return BsdfSample::specular(walk.w, walk.beta, pmf, Lobes::SPECULAR_REFLECT, 1.0);
        }
        let lobe = self.rough_walk_lobe();
        let roughness = if lobe.is_diffuse() { 1.0 } else { self.walk_alpha().mean_alpha() };
        BsdfSample { wi: walk.w, weight: walk.beta, pdf_w: 0.0, pmf: 0.0, lobe, eta: 1.0, roughness }
    }

    /// True if [`Self::sample_by_density`] samples: if the coat is smooth, and all light from below it is spread widely.
    /// Under a rough coat estimates of f have no bound that would keep the weights small.
    #[must_use]
    pub(super) fn has_density(&self) -> bool {
        !self.coat.lobes().has_non_specular() && matches!(self.base, Base::Diffuse(_))
    }

    /// A direction with just the density that [`Self::pdf`] claims for all lobes, of a surface that [has
    /// one](Self::has_density). Its weight is an estimate, and varies more than that of [`Self::sample`].
    #[must_use]
    pub(super) fn sample_by_density(
        &self,
        wo: Vector3,
        u_component: f32,
        u: Point2,
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        let side = 1.0_f32.copysign(wo.z);
        let wo = wo * side;
        let p_coat = fresnel_dielectric(wo.z, self.coat.eta);
        if u_component < p_coat {
            let sample = self.coat.sample(wo, u_component / p_coat, u, mode, Lobes::REFLECT)?;
            let (weight, pmf) = (sample.weight / p_coat, sample.pmf * p_coat);
            return Some(BsdfSample { wi: sample.wi * side, weight, pmf, ..sample });
        }
        let is_uniform = (u_component - p_coat) < UNIFORM_SHARE * (1.0 - p_coat);
        let wi = if is_uniform { sample_uniform_hemisphere(u) } else { sample_cosine_hemisphere(u) };
        let pdf_w = self.pdf(wo, wi, Lobes::ALL);
        if wi.z <= 0.0 || pdf_w <= 0.0 {
            return None;
        }
        let weight = self.eval(wo, wi, mode, Lobes::ALL) * (wi.z / pdf_w);
        let lobe = Lobes::DIFFUSE_REFLECT;
        Some(BsdfSample { wi: wi * side, weight, pdf_w, pmf: 0.0, lobe, eta: 1.0, roughness: 1.0 })
    }

    /// A likeness of the density of [`Self::sample`] in 1/sr: see the module's text.
    #[must_use]
    pub fn pdf(&self, wo: Vector3, wi: Vector3, lobes: Lobes) -> f32 {
        if !same_hemisphere(wo, wi) {
            return 0.0;
        }
        let (wo, wi) = if wo.z < 0.0 { (-wo, -wi) } else { (wo, wi) };
        let entry = self.entry_lobes(lobes);
        let pdf_coat = self.coat.pdf(wo, wi, entry);
        if !entry.is_transmissive() || self.rough_walk_lobe().is_empty() {
            return pdf_coat;
        }
        let p_walk = if entry.is_reflective() { 1.0 - fresnel_dielectric(wo.z, self.coat.eta) } else { 1.0 };
        pdf_coat + p_walk * self.walk_pdf(wo, wi)
    }

    /// Density of directions of light that has been below the coat.
    fn walk_pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        let likeness = match (self.base, self.rough_walk_lobe().is_diffuse()) {
            (Base::Conductor(base), false) => self.coated_conductor_pdf(&base, wo, wi),
            _ => wi.z * FRAC_1_PI,
        };
        (1.0 - UNIFORM_SHARE) * likeness + UNIFORM_SHARE * uniform_hemisphere_pdf()
    }

    /// Density of entering through a smooth coat, one reflection on a base as rough as both together, and leaving.
    fn coated_conductor_pdf(&self, base: &Conductor, wo: Vector3, wi: Vector3) -> f32 {
        let up = Vector3::new(0.0, 0.0, 1.0);
        let (Some(inside_o), Some(inside_i)) =
            (refract(wo, up, self.coat.eta), refract(wi, up, self.coat.eta))
        else {
            return wi.z * FRAC_1_PI;
        };
        let widened = Conductor { microfacets: self.walk_alpha(), ..*base };
        let pdf_inside = widened.pdf(-inside_o.wt, -inside_i.wt, Lobes::ALL);
        // Solid angle inside per solid angle outside.
        pdf_inside * wi.z / (sqr(inside_i.eta) * abs_cos(inside_i.wt))
    }

    /// Roughness of a base that reflects about as widely as the real one under its coat does.
    fn walk_alpha(&self) -> Microfacets {
        let Base::Conductor(base) = self.base else { return Microfacets::new(1.0, 1.0) };
        let (coat_x, coat_y) = self.coat.microfacets.alpha();
        let (base_x, base_y) = base.microfacets.alpha();
        // Refraction turns rays by about half of what reflection does, twice.
        let join = |coat: f32, base: f32| (sqr(base) + 0.5 * sqr(coat)).sqrt().max(Microfacets::SMOOTH_BELOW);
        Microfacets::new(join(coat_x, base_x), join(coat_y, base_y))
    }

    /// Alpha of the coat if it is rough, else of the base.
    #[must_use]
    pub(super) fn glossy_roughness(&self) -> f32 {
        match (self.coat.lobes().is_glossy(), self.base) {
            (false, Base::Conductor(base)) => base.microfacets.mean_alpha(),
            _ => self.coat.microfacets.mean_alpha(),
        }
    }

    /// The same with rougher coat and base.
    #[must_use]
    pub fn regularized(self) -> Self {
        let coat = Dielectric { microfacets: self.coat.microfacets.regularized(), ..self.coat };
        let base = match self.base {
            Base::Diffuse(base) => Base::Diffuse(base),
            Base::Conductor(base) => {
                Base::Conductor(Conductor { microfacets: base.microfacets.regularized(), ..base })
            }
        };
        Self { coat, base, ..self }
    }
}

/// Random numbers that depend on what the walk estimates and on nothing else.
#[inline]
fn walk_rng(wo: Vector3, rest: [f32; 3]) -> Rng {
    let pair = |a: f32, b: f32| u64::from(a.to_bits()) << 32 | u64::from(b.to_bits());
    let seed = hash64(&[pair(wo.x, wo.y), pair(wo.z, rest[0]), pair(rest[1], rest[2])]);
    Rng::new(seed, 0)
}

#[inline]
fn random_2d(rng: &mut Rng) -> Point2 {
    Point2::new(rng.next_f32(), rng.next_f32())
}

/// Russian roulette for dim walks after the fourth event.
#[inline]
fn survives_roulette(beta: &mut Sampled, depth: u16, rng: &mut Rng) -> bool {
    let survival = beta.max_value();
    if depth <= 3 || survival >= 0.25 {
        return survival > 0.0;
    }
    if rng.next_f32() >= survival {
        return false;
    }
    *beta /= survival;
    true
}

/// Fraction of light that crosses `distance` in depth along `w` unscattered.
#[inline]
fn transmittance(distance: f32, w: Vector3) -> f32 {
    if distance.abs() <= f32::MIN_POSITIVE { 1.0 } else { (-(distance / w.z).abs()).exp() }
}

/// Weight of the first of two techniques (Veach 1997, power heuristic with exponent 2).
#[inline]
fn power_heuristic(pdf: f32, other: f32) -> f32 {
    if pdf.is_infinite() {
        return 1.0;
    }
    let (a, b) = (sqr(pdf), sqr(other));
    if a > 0.0 { a / (a + b) } else { 0.0 }
}

/// Density of a sample, or `None` if it is a Dirac.
#[inline]
fn density_of(sample: &BsdfSample) -> Option<f32> {
    (!sample.is_specular()).then_some(sample.pdf_w)
}

/// Phase function of Henyey and Greenstein (1941) in 1/sr, of the cosine between light's directions before and after.
#[inline]
fn henyey_greenstein(cos: f32, g: f32) -> f32 {
    let denominator = (1.0 + sqr(g) - 2.0 * g * cos).max(1e-7);
    (1.0 - sqr(g)) / (4.0 * PI * denominator * denominator.sqrt())
}

/// A direction around `w`, light's direction before, with density [`henyey_greenstein`].
#[inline]
fn sample_henyey_greenstein(w: Vector3, g: f32, u: Point2) -> Vector3 {
    let cos = if g.abs() < 1e-3 {
        1.0 - 2.0 * u.x
    } else {
        (1.0 + sqr(g) - sqr((1.0 - sqr(g)) / (1.0 - g + 2.0 * g * u.x))) / (2.0 * g)
    };
    let sin = (1.0 - sqr(cos)).max(0.0).sqrt();
    let (sin_phi, cos_phi) = (2.0 * PI * u.y).sin_cos();
    Frame::from_z(w).to_world(Vector3::new(sin * cos_phi, sin * sin_phi, cos)).normalized()
}
