//! The laws of scattering, as numbers that tell how well a BSDF keeps them.
//!
//! Light may take every way backwards (Helmholtz: SPEC BRDF-5; refracted radiance is symmetric after division by the
//! squared index, Veach 1997, section 5.2), no surface sends out more than arrives (SPEC BRDF-7), a lossless one all of
//! it (the white furnace), directions come as often as their density says, weights are `f |cos| / pdf`, and no input
//! makes a number that is none (SPEC EXP-44). Everything is measured with fixed seeds: asking twice gives the same.
//!
//! Where `eval` is an estimate ([`BsdfKind::is_stochastic`]), laws hold for means alone: reciprocity of averages over
//! pairs of directions, and samples that carry what f integrates to, in place of the density.

use std::f32::consts::{PI, TAU};

use etendue_math::statistics::{Moments, combined_p_value, integrate_sphere, means_agree, sphere_p_value};
use etendue_math::{ONE_MINUS_EPSILON, Point2, Rng, Vector3, hash64, unit_f32, warp};

use super::{BsdfKind, BsdfSample, Lobes, TransportMode};

/// A law of scattering.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Law {
    /// Light may take every way backwards.
    Reciprocity,
    /// No more flux leaves than arrives, in either mode.
    Energy,
    /// A surface that absorbs nothing loses nothing.
    Furnace,
    /// Samples have the density that `pdf` states, which integrates to at most 1.
    Density,
    /// A sample's weight is `f |cos| / pdf`.
    Weight,
    /// Values are numbers, none is negative, and samples are what they say.
    Soundness,
}

impl Law {
    /// One word.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Reciprocity => "reciprocity",
            Self::Energy => "energy",
            Self::Furnace => "furnace",
            Self::Density => "density",
            Self::Weight => "weight",
            Self::Soundness => "soundness",
        }
    }
}

/// A measured number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// What was measured.
    pub value: f64,
    /// Its standard error; 0 if nothing is random in it.
    pub standard_error: f64,
}

impl Estimate {
    /// What chance may add to a measurement: more than that many standard errors come up about once in 10⁶ times.
    const SIGMAS: f64 = 5.0;

    fn of(moments: &Moments) -> Self {
        Self { value: moments.mean(), standard_error: moments.standard_error() }
    }

    /// True unless the number is further from `expected` than by `tolerance` and chance.
    #[must_use]
    pub fn is_near(self, expected: f64, tolerance: f64) -> bool {
        (self.value - expected).abs() <= tolerance + Self::SIGMAS * self.standard_error
    }

    /// True unless the number is above `bound`, also after chance.
    #[must_use]
    pub fn is_at_most(self, bound: f64) -> bool {
        self.value <= bound + Self::SIGMAS * self.standard_error
    }
}

/// All laws of one BSDF in numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Measures {
    /// See [`reciprocity_error`].
    pub reciprocity_error: Estimate,
    /// See [`AlbedoRange::max`].
    pub albedo_max: Estimate,
    /// See [`AlbedoRange::furnace`].
    pub furnace: Estimate,
    /// See [`chi2_p`].
    pub chi2_p: f64,
    /// See [`pdf_integral_max`].
    pub pdf_integral_max: f64,
    /// See [`jacobian_error`].
    pub jacobian_error: f64,
    /// See [`sample_errors`].
    pub sample_errors: SampleErrors,
    /// See [`fault`].
    pub fault: Option<String>,
}

impl Measures {
    /// Measures everything: 10 ms to a second.
    #[must_use]
    pub fn of(kind: &BsdfKind) -> Self {
        let albedo = albedo_range(kind);
        Self {
            reciprocity_error: reciprocity_error(kind),
            albedo_max: albedo.max,
            furnace: albedo.furnace,
            chi2_p: chi2_p(kind),
            pdf_integral_max: pdf_integral_max(kind),
            jacobian_error: jacobian_error(kind),
            sample_errors: sample_errors(kind),
            fault: fault(kind),
        }
    }

    /// The laws that `kind`, of which these are the measures, does not keep. `is_lossless` says that nothing in it
    /// absorbs, so that a white furnace should stay white.
    #[must_use]
    pub fn broken(&self, kind: &BsdfKind, is_lossless: bool) -> Vec<Law> {
        // Likenesses of densities, which serve as weights alone, may exceed 1 by little.
        let largest_integral = if kind.is_stochastic() { 1.05 } else { 1.005 };
        let furnace_tolerance = if kind.lobes().is_glossy() { 1e-2 } else { 1e-3 };
        let laws = [
            (Law::Reciprocity, self.reciprocity_error.is_at_most(2e-3)),
            (Law::Energy, self.albedo_max.is_at_most(1.0 + 1e-4)),
            (Law::Furnace, !is_lossless || self.furnace.is_near(1.0, furnace_tolerance)),
            (
                Law::Density,
                self.chi2_p >= 1e-6
                    && self.pdf_integral_max < largest_integral
                    && self.jacobian_error <= 2e-2
                    && self.sample_errors.density <= 2e-2,
            ),
            (Law::Weight, self.sample_errors.weight <= 5e-3),
            (Law::Soundness, self.fault.is_none()),
        ];
        laws.into_iter().filter(|(_, is_kept)| !is_kept).map(|(law, _)| law).collect()
    }
}

impl BsdfKind {
    /// True if `eval` is an estimate, and `pdf` a likeness of the density of samples.
    #[must_use]
    pub const fn is_stochastic(&self) -> bool {
        matches!(self, Self::Layered(_))
    }
}

const BOTH_MODES: [TransportMode; 2] = [TransportMode::Radiance, TransportMode::Importance];

/// A unit vector from polar angle in degrees and azimuth in radians.
#[must_use]
pub fn direction(theta_deg: f32, phi: f32) -> Vector3 {
    let (sin, cos) = theta_deg.to_radians().sin_cos();
    Vector3::new(sin * phi.cos(), sin * phi.sin(), cos)
}

/// Where the laws look from: steep to grazing above the surface, and below it where light passes.
#[must_use]
pub fn directions(kind: &BsdfKind) -> Vec<Vector3> {
    let above = [5.0_f32, 45.0, 75.0, 89.0].map(|angle| direction(angle, 0.7));
    let below = [direction(160.0, 2.0), direction(130.0, 4.0), direction(95.0, 0.1)];
    let n_below = if kind.lobes().is_transmissive() { below.len() } else { 0 };
    above.into_iter().chain(below.into_iter().take(n_below)).collect()
}

/// A sample by the next numbers of a generator.
pub(super) fn draw(
    kind: &BsdfKind,
    wo: Vector3,
    mode: TransportMode,
    lobes: Lobes,
    rng: &mut Rng,
) -> Option<BsdfSample> {
    let (u_component, u) = (rng.next_f32(), rng.next_point2());
    kind.sample(wo, u_component, u, mode, lobes)
}

/// `|a - b|` relative to the larger, where what is smaller than `floor` counts little.
fn relative_error(a: f32, b: f32, floor: f32) -> f64 {
    f64::from((a - b).abs() / (a.abs().max(b.abs()) + floor))
}

/// The largest relative difference of a way of light and its reverse, in radiance and against importance, over a fixed
/// set of pairs of directions, half of them samples. What is below 0.005/sr counts little.
///
/// Where `eval` is an estimate: the relative difference of averages over steep and flat directions.
#[must_use]
pub fn reciprocity_error(kind: &BsdfKind) -> Estimate {
    if kind.is_stochastic() {
        return mean_reciprocity_error(kind);
    }
    let mut rng = Rng::new(hash64(&[2]), 0);
    let mut worst = specular_reciprocity_error(kind);
    let eta = index_below(kind);
    for i in 0..4000 {
        let a = warp::sample_uniform_sphere(rng.next_point2());
        let b = warp::sample_uniform_sphere(rng.next_point2());
        let sample = draw(kind, a, TransportMode::Radiance, Lobes::NON_SPECULAR, &mut rng);
        let b = sample.filter(|_| i % 2 == 0).map_or(b, |sample| sample.wi);
        worst = worst.max(pair_error(kind, a, b, eta));
    }
    Estimate { value: worst, standard_error: 0.0 }
}

/// Index of refraction below relative to that above, as samples tell.
fn index_below(kind: &BsdfKind) -> f32 {
    let up = Vector3::new(0.0, 0.0, 1.0);
    let sample = kind.sample(up, 0.5, Point2::new(0.5, 0.5), TransportMode::Radiance, Lobes::TRANSMIT);
    sample.map_or(1.0, |sample| sample.eta)
}

fn pair_error(kind: &BsdfKind, a: Vector3, b: Vector3, eta: f32) -> f64 {
    const FLOOR: f32 = 5e-3;
    let index2 = |w: Vector3| if w.z > 0.0 { 1.0 } else { eta * eta };
    let forward = kind.eval(a, b, TransportMode::Radiance, Lobes::ALL);
    let backward = kind.eval(b, a, TransportMode::Radiance, Lobes::ALL);
    let adjoint = kind.eval(b, a, TransportMode::Importance, Lobes::ALL);
    let error = |i: usize| {
        // The radiance arriving along b is L / index², and so is what leaves along a.
        let reverse = relative_error(forward[i] * index2(b), backward[i] * index2(a), FLOOR);
        reverse.max(relative_error(forward[i], adjoint[i], FLOOR))
    };
    (0..4).map(error).fold(0.0, f64::max)
}

/// The same for Dirac lobes: the sample from where a sample goes comes back with the same share of flux.
fn specular_reciprocity_error(kind: &BsdfKind) -> f64 {
    let mut worst = 0.0_f64;
    for wo in directions(kind) {
        for lobe in [Lobes::SPECULAR_REFLECT, Lobes::SPECULAR_TRANSMIT] {
            let flux = |w| {
                let sample = kind.sample(w, 0.5, Point2::new(0.5, 0.5), TransportMode::Radiance, lobe)?;
                Some((sample.wi, sample.weight * (sample.pmf * sample.eta * sample.eta)))
            };
            let Some((wi, forward)) = flux(wo) else { continue };
            let Some((back, backward)) = flux(wi) else { return 1.0 };
            let errors = (0..4).map(|i| relative_error(forward[i], backward[i], 5e-3));
            worst = errors.fold(worst, f64::max).max(f64::from((back - wo).length()));
        }
    }
    worst
}

fn mean_reciprocity_error(kind: &BsdfKind) -> Estimate {
    let mut rng = Rng::new(hash64(&[50]), 0);
    let (mut forward, mut backward) = (Moments::default(), Moments::default());
    for _ in 0..100_000 {
        // One direction is steep, the other flat: an asymmetric average.
        let steep = direction(30.0 * rng.next_f32(), TAU * rng.next_f32());
        let flat = direction(50.0 + 30.0 * rng.next_f32(), TAU * rng.next_f32());
        let f = |a, b| f64::from(kind.eval(a, b, TransportMode::Radiance, Lobes::ALL)[2]);
        forward.push(f(steep, flat));
        backward.push(f(flat, steep));
    }
    let scale = forward.mean().max(backward.mean()).max(1e-6);
    Estimate {
        value: (forward.mean() - backward.mean()).abs() / scale,
        standard_error: forward.standard_error().hypot(backward.standard_error()) / scale,
    }
}

/// Share of the flux from `wo` that leaves by these lobes, for each wavelength: the mean weight of samples. In radiance
/// mode it counts radiance by the squared index, as in equilibrium.
///
/// The points are a lattice, shifted at random several times, whose means give the standard error.
#[must_use]
pub fn albedo(kind: &BsdfKind, wo: Vector3, mode: TransportMode, lobes: Lobes) -> [Estimate; 4] {
    const N_SHIFTS: u64 = 32;
    const N_POINTS: u32 = 512;
    // Multiples of the powers of 1/g with g⁴ = g + 1 (Roberts 2018), as shares of 2³².
    const STEPS: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_2];
    let steps = STEPS.map(|step| (step * 4_294_967_296.0) as u32);
    let mut means = [Moments::default(); 4];
    for shift in 0..N_SHIFTS {
        let mut rng = Rng::new(hash64(&[3, shift]), 0);
        let start = [rng.next_u32(), rng.next_u32(), rng.next_u32()];
        let mut sums = [0.0_f64; 4];
        for i in 0..N_POINTS {
            let u: [f32; 3] =
                std::array::from_fn(|d| unit_f32(start[d].wrapping_add(steps[d].wrapping_mul(i))));
            let Some(sample) = kind.sample(wo, u[0], Point2::new(u[1], u[2]), mode, lobes) else { continue };
            let scale = if mode == TransportMode::Radiance { sample.eta * sample.eta } else { 1.0 };
            for (i, sum) in sums.iter_mut().enumerate() {
                *sum += f64::from(sample.weight[i] * scale);
            }
        }
        means.iter_mut().zip(sums).for_each(|(mean, sum)| mean.push(sum / f64::from(N_POINTS)));
    }
    means.map(|mean| Estimate::of(&mean))
}

/// [`albedo`] of all lobes at the wavelength where it is greatest.
fn brightest(kind: &BsdfKind, wo: Vector3, mode: TransportMode) -> Estimate {
    albedo(kind, wo, mode, Lobes::ALL).into_iter().fold(Estimate::default(), greater)
}

fn greater(a: Estimate, b: Estimate) -> Estimate {
    if b.value > a.value { b } else { a }
}

/// The greatest and the least share of flux that leaves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AlbedoRange {
    /// The greatest, over directions, wavelengths and both modes: at most 1 if no energy is made.
    pub max: Estimate,
    /// What a surface shows in a room of radiance 1: the least over directions, at the wavelength where it is
    /// brightest. 1 if nothing is lost.
    pub furnace: Estimate,
}

/// [`albedo`] over the directions of [`directions`].
#[must_use]
pub fn albedo_range(kind: &BsdfKind) -> AlbedoRange {
    let of = |mode| directions(kind).into_iter().map(move |wo| brightest(kind, wo, mode));
    let seen: Vec<Estimate> = of(TransportMode::Radiance).collect();
    let carried = of(TransportMode::Importance);
    AlbedoRange {
        max: carried.chain(seen.iter().copied()).fold(Estimate::default(), greater),
        furnace: seen.into_iter().min_by(|a, b| a.value.total_cmp(&b.value)).unwrap_or_default(),
    }
}

/// Directions of a test of the density.
const N_SAMPLES: usize = 50_000;

/// Probability that chance makes samples disagree with their density as much as they do, over several directions from
/// steep to grazing, for all lobes and for transmission apart. 1 if there are Dirac lobes alone.
///
/// Where `eval` is an estimate: that what samples carry into parts of the sphere is the integral of f over them.
#[must_use]
pub fn chi2_p(kind: &BsdfKind) -> f64 {
    if kind.is_stochastic() {
        return carried_p(kind);
    }
    let tests = directions(kind).into_iter().enumerate().flat_map(|(i, wo)| {
        [Lobes::ALL, Lobes::TRANSMIT]
            .into_iter()
            .filter(|lobes| (kind.lobes() & *lobes).has_non_specular())
            .map(move |lobes| density_p(kind, wo, lobes, N_SAMPLES, i as u64, |_| 1.0))
    });
    combined_p_value(tests.collect::<Vec<_>>())
}

/// The p-value of `n` samples from `wo` against `pdf` times `factor`, which is 1 but in tests of this test.
pub(super) fn density_p(
    kind: &BsdfKind,
    wo: Vector3,
    lobes: Lobes,
    n: usize,
    seed: u64,
    factor: impl Fn(Vector3) -> f32,
) -> f64 {
    sphere_p_value(
        n,
        hash64(&[4, seed]),
        |rng| {
            let sample = draw(kind, wo, TransportMode::Radiance, lobes, rng);
            sample.filter(|sample| !sample.is_specular()).map(|sample| sample.wi)
        },
        |wi| kind.pdf(wo, wi, lobes) * factor(wi),
    )
}

/// All of the sphere, what is near the horizon, and what goes to one side.
const PARTS: [fn(Vector3) -> f64; 3] =
    [|_| 1.0, |w| f64::from(u8::from(w.z < 0.5)), |w| f64::from(u8::from(w.x > 0.2))];

fn carried_p(kind: &BsdfKind) -> f64 {
    if !kind.lobes().has_non_specular() {
        return 1.0;
    }
    let views = [direction(15.0, 0.2), direction(70.0, 1.0)];
    let tests = views.into_iter().flat_map(|wo| BOTH_MODES.map(|mode| (wo, mode)));
    combined_p_value(tests.flat_map(|(wo, mode)| carried_p_from(kind, wo, mode)).collect::<Vec<_>>())
}

fn carried_p_from(kind: &BsdfKind, wo: Vector3, mode: TransportMode) -> [f64; 3] {
    let mut rng = Rng::new(hash64(&[40]), 0);
    let mut sampled = [Moments::default(); 3];
    let mut evaluated = [Moments::default(); 3];
    for _ in 0..60_000 {
        let sample = draw(kind, wo, mode, Lobes::NON_SPECULAR, &mut rng);
        let wi = warp::sample_cosine_hemisphere(rng.next_point2());
        let f = kind.eval(wo, wi, mode, Lobes::NON_SPECULAR)[1] * PI;
        for (part, (s, e)) in PARTS.iter().zip(sampled.iter_mut().zip(&mut evaluated)) {
            s.push(sample.map_or(0.0, |s| f64::from(s.weight[1]) * part(s.wi)));
            e.push(f64::from(f) * part(wi));
        }
    }
    // At significance 0 nothing is an error.
    std::array::from_fn(|i| means_agree(&sampled[i], &evaluated[i], 0.0).unwrap_or(0.0))
}

/// The greatest integral of the density over the sphere, over some of [`directions`]: at most 1, and less where some
/// random numbers give no sample. 0 if there are Dirac lobes alone. ([`chi2_p`] integrates too, for each direction.)
#[must_use]
pub fn pdf_integral_max(kind: &BsdfKind) -> f64 {
    if !kind.lobes().has_non_specular() {
        return 0.0;
    }
    let integral = |wo| integrate_sphere(|wi| f64::from(kind.pdf(wo, wi, Lobes::ALL)), 1e-2);
    directions(kind).into_iter().skip(1).step_by(2).map(integral).fold(0.0, f64::max)
}

/// How far the density of each lobe is from the inverse of the Jacobian of its sampling: the relative difference that a
/// twentieth of random points exceed. There is no chance in it. Lobes that mix several ways of sampling are left out, as
/// are Dirac lobes and likenesses of densities; 0 if nothing is left.
#[must_use]
pub fn jacobian_error(kind: &BsdfKind) -> f64 {
    if kind.is_stochastic() {
        return 0.0;
    }
    let mut rng = Rng::new(hash64(&[7]), 0);
    let mut errors = Vec::new();
    for wo in directions(kind) {
        for lobe in Lobes::EACH.into_iter().filter(|lobe| kind.lobes().contains(*lobe) && !lobe.is_specular())
        {
            // At the borders of the square maps may jump.
            let mut points = (0..60).map(|_| [(); 2].map(|()| 0.05 + 0.9 * rng.next_f32()));
            errors.extend(points.by_ref().filter_map(|point| jacobian_error_at(kind, wo, lobe, point)));
        }
    }
    errors.sort_by(f64::total_cmp);
    errors.get(errors.len() * 19 / 20).copied().unwrap_or(0.0)
}

/// One point; `None` where nothing is sampled, or not by one map. Of two steps the better one counts: small ones lose the
/// digits of narrow lobes, large ones see the map bend.
fn jacobian_error_at(kind: &BsdfKind, wo: Vector3, lobe: Lobes, point: [f32; 2]) -> Option<f64> {
    let error = finite_difference_error(kind, wo, lobe, point, 4e-3)?;
    if error < 5e-3 {
        return Some(error);
    }
    Some(finite_difference_error(kind, wo, lobe, point, 1.6e-2).map_or(error, |other| error.min(other)))
}

fn finite_difference_error(
    kind: &BsdfKind,
    wo: Vector3,
    lobe: Lobes,
    [x, y]: [f32; 2],
    step: f32,
) -> Option<f64> {
    let sample_by = |u_component, x, y| {
        let sample = kind.sample(wo, u_component, Point2::new(x, y), TransportMode::Radiance, lobe)?;
        (!sample.is_specular()).then_some(sample.wi)
    };
    let at = |x, y| sample_by(0.5, x, y);
    let wi = at(x, y)?;
    if sample_by(0.01, x, y)? != wi || sample_by(0.99, x, y)? != wi {
        return None;
    }
    let dx = at(x + step, y)? - at(x - step, y)?;
    let dy = at(x, y + step)? - at(x, y - step)?;
    let area = dx.cross(dy).length() / (4.0 * step * step);
    Some(f64::from((area * kind.pdf(wo, wi, lobe) - 1.0).abs()))
}

/// How far samples are from what `eval` and `pdf` say of their directions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SampleErrors {
    /// Greatest relative difference of weight and `f |cos| / pdf`; 0 where `eval` is an estimate.
    pub weight: f64,
    /// Greatest relative difference of the sample's density and `pdf`.
    pub density: f64,
}

/// Compares samples in both modes with `eval` and `pdf`.
#[must_use]
pub fn sample_errors(kind: &BsdfKind) -> SampleErrors {
    let mut rng = Rng::new(hash64(&[1]), 0);
    let mut errors = SampleErrors::default();
    for (wo, mode) in directions(kind).into_iter().flat_map(|wo| BOTH_MODES.map(|mode| (wo, mode))) {
        for _ in 0..200 {
            let sample = draw(kind, wo, mode, Lobes::ALL, &mut rng).filter(|sample| !sample.is_specular());
            let Some(sample) = sample else { continue };
            let pdf = kind.pdf(wo, sample.wi, Lobes::ALL);
            errors.density = errors.density.max(relative_error(sample.pdf_w, pdf, 5e-5));
            if kind.is_stochastic() {
                continue;
            }
            let expected = kind.eval(wo, sample.wi, mode, Lobes::ALL) * (sample.wi.z.abs() / pdf);
            let error = |i: usize| relative_error(sample.weight[i], expected[i], 2e-4);
            errors.weight = (0..4).map(error).fold(errors.weight, f64::max);
        }
    }
    errors
}

/// The first thing found that no BSDF may do: a value that is no number or negative, for any direction and any random
/// numbers, however extreme; a sample that is not what it says. `None` if nothing is found.
#[must_use]
pub fn fault(kind: &BsdfKind) -> Option<String> {
    let mut rng = Rng::new(hash64(&[20]), 0);
    let mut any = || warp::sample_uniform_sphere(rng.next_point2());
    let extremes = extreme_directions();
    let mut pairs: Vec<_> = (0..1000).map(|_| (any(), any())).collect();
    pairs.extend(extremes.iter().flat_map(|wo| extremes.iter().map(|wi| (*wo, *wi))));
    BOTH_MODES.into_iter().find_map(|mode| {
        let of_values = pairs.iter().find_map(|(wo, wi)| value_fault(kind, *wo, *wi, mode));
        let mut views = directions(kind).into_iter().chain(extremes.iter().copied());
        of_values.or_else(|| views.find_map(|wo| sample_fault(kind, wo, mode)))
    })
}

const TINY: f32 = f32::MIN_POSITIVE;

/// Directions at the poles and towards the horizon, above and below.
fn extreme_directions() -> Vec<Vector3> {
    let mut directions = vec![Vector3::new(0.0, 0.0, 1.0), Vector3::new(0.0, 0.0, -1.0)];
    for z in [0.0, TINY, 1e-20, 1e-7, 1e-3, 0.999_999_9] {
        let r = (1.0_f32 - z * z).max(0.0).sqrt();
        for sign in [1.0, -1.0] {
            directions.push(Vector3::new(r, 0.0, sign * z));
            directions.push(Vector3::new(-r * 0.6, r * 0.8, sign * z));
        }
    }
    directions
}

fn value_fault(kind: &BsdfKind, wo: Vector3, wi: Vector3, mode: TransportMode) -> Option<String> {
    let f = kind.eval(wo, wi, mode, Lobes::ALL);
    let pdf = kind.pdf(wo, wi, Lobes::ALL);
    // Along the horizon itself 1/cos may be infinite.
    let is_along = wo.z.abs().min(wi.z.abs()) < 1e-18;
    let is_sound = f.to_array().iter().all(|f| *f >= 0.0 && (f.is_finite() || is_along)) && pdf >= 0.0;
    (!is_sound).then(|| format!("f = {f:?}, pdf = {pdf} for wo {wo:?}, wi {wi:?}, {mode:?}"))
}

/// What is wrong with the samples of extreme and of ordinary random numbers.
fn sample_fault(kind: &BsdfKind, wo: Vector3, mode: TransportMode) -> Option<String> {
    const NUMBERS: [f32; 6] = [0.0, TINY, 0.25, 0.5, 1.0 - 1e-4, ONE_MINUS_EPSILON];
    let mut rng = Rng::new(hash64(&[21]), 0);
    let extreme = (0..216).map(|i| [NUMBERS[i % 6], NUMBERS[i / 6 % 6], NUMBERS[i / 36]]);
    let ordinary = (0..200).map(|_| [(); 3].map(|()| rng.next_f32()));
    extreme.chain(ordinary).find_map(|u| {
        let sample = kind.sample(wo, u[0], Point2::new(u[1], u[2]), mode, Lobes::ALL)?;
        let fault = describe_fault(kind, wo, &sample)?;
        Some(format!("{fault}: wo {wo:?}, u {u:?}, {mode:?}: {sample:?}"))
    })
}

fn describe_fault(kind: &BsdfKind, wo: Vector3, sample: &BsdfSample) -> Option<&'static str> {
    let numbers = [sample.pdf_w, sample.pmf, sample.eta, sample.roughness];
    let is_grazing = wo.z.abs() < 1e-6 || sample.wi.z.abs() < 1e-6;
    if !sample.wi.is_finite() || !sample.weight.is_finite() || numbers.iter().any(|x| !x.is_finite()) {
        Some("a sample is no number")
    } else if sample.weight.min_value() < 0.0 || numbers.iter().any(|x| *x < 0.0) {
        Some("a sample is negative")
    } else if (sample.wi.length() - 1.0).abs() >= 1e-4 {
        Some("a sampled direction has not length 1")
    } else if !kind.lobes().contains(sample.lobe) || !Lobes::EACH.contains(&sample.lobe) {
        Some("a sample is of no lobe of the BSDF, or of several")
    } else if !is_grazing && sample.is_transmission() != (wo.z * sample.wi.z < 0.0) {
        Some("a sample goes to the side that is not its lobe's")
    } else if sample.is_specular() != (sample.pdf_w == 0.0)
        || sample.is_specular() != (sample.pmf > 0.0)
        || sample.pmf > 1.0 + 1e-6
    {
        Some("a sample is neither a Dirac with a probability nor one with a density")
    } else {
        None
    }
}
