//! From photons to the radiance of a surface.
//!
//! The powers of photons are XYZ. Lambert's surfaces need their sum alone, which is lifted to the wavelengths of the camera's path
//! once. For other lobes `f` differs from photon to photon: their sum weighs each power by the mean of `f` over wavelengths, is
//! lifted once, and takes the colour of the sum of `f`. That is exact where the photons have one colour, or where the lobe has one,
//! which holds for each lobe of nearly all materials; lifting each photon would cost more than all the rest.
//!
//! Photons arrive in proportion to the cosine with the geometric normal, `f` wants that with the shading normal: where they
//! differ a photon counts `|wi·ns| / |wi·ng|` (Veach 1997, section 5.3).

use std::f32::consts::FRAC_1_PI;

use etendue_math::{Point3, Vector3, hash64};
use etendue_scene::bsdf::{Bsdf, BsdfKind, Lobes, TransportMode};
use etendue_spectrum::{Sampled, Wavelengths, Xyz, lift};

use super::{Density, DensityEstimate, EstimateScratch, Photons};

/// Cosines with the geometric normal count as no less: stored directions are as coarse as this, a degree.
const SMALLEST_COSINE: f32 = 0.02;

/// Photons of an estimate whose scattering is evaluated where that is itself a random walk.
const N_CHOSEN: usize = 8;

/// What photons say of a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadianceEstimate {
    /// Radiance towards `wo`.
    pub radiance: Sampled,
    /// What it rests on.
    pub density: Density,
}

/// A place that is looked at.
#[derive(Clone, Copy, Debug)]
pub struct LitPlace<'a> {
    /// Where.
    pub p: Point3,
    /// Unit direction towards the observer.
    pub wo: Vector3,
    /// How it scatters.
    pub bsdf: &'a Bsdf,
    /// The lobes that are asked about; diffuse and glossy ones among them count.
    pub lobes: Lobes,
    /// Wavelengths of the observer.
    pub lambda: &'a Wavelengths,
}

/// Sums of powers.
#[derive(Clone, Copy, Debug, Default)]
struct FluxSum([f32; 3]);

impl FluxSum {
    #[inline(always)]
    fn add(&mut self, power: Xyz, weight: f32) {
        self.0[0] += power.x * weight;
        self.0[1] += power.y * weight;
        self.0[2] += power.z * weight;
    }

    fn lifted(self, scale: f32, lambda: &Wavelengths) -> Sampled {
        let [x, y, z] = self.0.map(|value| value * scale);
        if x + y + z > 0.0 { lift(Xyz::new(x, y, z), lambda) } else { Sampled::ZERO }
    }
}

/// A sum of powers times scattering.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LobeSum {
    flux: FluxSum,
    colour: Sampled,
}

impl LobeSum {
    #[inline(always)]
    pub(super) fn add(&mut self, power: Xyz, weight: f32, f: Sampled) {
        self.flux.add(power, weight * f.average());
        self.colour += f * (weight * (power.x + power.y + power.z));
    }

    /// The sum times `scale` at the wavelengths of a path.
    pub(super) fn radiance(self, scale: f32, lambda: &Wavelengths) -> Sampled {
        let average = self.colour.average();
        if average > 0.0 { self.flux.lifted(scale, lambda) * (self.colour / average) } else { Sampled::ZERO }
    }
}

/// Radiance of a place by the photons in `scratch.found`, which a search for `wanted` of them around it has found.
pub fn radiance(
    estimate: &DensityEstimate,
    place: &LitPlace<'_>,
    wanted: usize,
    photons: &impl Photons,
    scratch: &mut EstimateScratch,
) -> RadianceEstimate {
    let diffuse = |reflectance: Option<Sampled>, transmittance: Option<Sampled>, scratch: &mut _| {
        let (density, sums) = two_sides(
            estimate,
            place,
            [reflectance.is_some(), transmittance.is_some()],
            wanted,
            photons,
            scratch,
        );
        let scale = density.per_area * FRAC_1_PI;
        let mut radiance = Sampled::ZERO;
        for (sum, albedo) in sums.into_iter().zip([reflectance, transmittance]) {
            if let Some(albedo) = albedo {
                radiance += sum.lifted(scale, place.lambda) * albedo;
            }
        }
        RadianceEstimate { radiance, density }
    };
    match place.bsdf.kind() {
        BsdfKind::Diffuse(bsdf) => diffuse(Some(bsdf.reflectance), None, scratch),
        BsdfKind::DiffuseTransmission(bsdf) => {
            diffuse(Some(bsdf.reflectance), Some(bsdf.transmittance), scratch)
        }
        _ => by_lobes(estimate, place, wanted, photons, scratch),
    }
}

/// Irradiance in XYZ on the side that the unit normal points to (SPEC KD-11).
pub fn irradiance(
    estimate: &DensityEstimate,
    (p, n): (Point3, Vector3),
    wanted: usize,
    photons: &impl Photons,
    scratch: &mut EstimateScratch,
) -> (Xyz, Density) {
    let mut sum = FluxSum::default();
    let accept = |index| (photons.wi(index).dot(n) > 0.0).then_some(index);
    let density = estimate
        .sum((p, n), wanted, photons, scratch, accept, |weight, index| sum.add(photons.power(index), weight));
    let [x, y, z] = sum.0.map(|value| value * density.per_area);
    (Xyz::new(x, y, z), density)
}

/// What corrects for a shading normal, a function of `wi`.
#[inline(always)]
fn correction(bsdf: &Bsdf) -> impl Fn(Vector3) -> f32 + use<> {
    let (ns, ng) = (bsdf.ns().as_vector(), bsdf.ng().as_vector());
    let is_needed = ns.dot(ng).abs() < 1.0 - 1e-6;
    move |wi: Vector3| if is_needed { wi.dot(ns).abs() / wi.dot(ng).abs().max(SMALLEST_COSINE) } else { 1.0 }
}

/// Sums of the photons on the side of `wo` and on the other, as far as they are wanted.
fn two_sides(
    estimate: &DensityEstimate,
    place: &LitPlace<'_>,
    wants: [bool; 2],
    wanted: usize,
    photons: &impl Photons,
    scratch: &mut EstimateScratch,
) -> (Density, [FluxSum; 2]) {
    let mut sums = [FluxSum::default(); 2];
    let towards = place.bsdf.ns().as_vector() * place.bsdf.ns().as_vector().dot(place.wo).signum();
    let correct = correction(place.bsdf);
    let accept = |index: u32| {
        let wi = photons.wi(index);
        let cosine = wi.dot(towards);
        let side = usize::from(cosine < 0.0);
        (wants[side] && cosine != 0.0).then_some((index, side, wi))
    };
    let tangent = (place.p, place.bsdf.ng().as_vector());
    let density = estimate.sum(tangent, wanted, photons, scratch, accept, |weight, (index, side, wi)| {
        sums[side].add(photons.power(index), weight * correct(wi));
    });
    (density, sums)
}

/// A sum for each of the diffuse and the glossy lobes.
fn by_lobes(
    estimate: &DensityEstimate,
    place: &LitPlace<'_>,
    wanted: usize,
    photons: &impl Photons,
    scratch: &mut EstimateScratch,
) -> RadianceEstimate {
    let bsdf = place.bsdf;
    let lobes = [Lobes::DIFFUSE, Lobes::GLOSSY].map(|lobes| bsdf.lobes() & place.lobes & lobes);
    let mut sums = [LobeSum::default(); 2];
    let wants_side = [(lobes[0] | lobes[1]).is_reflective(), (lobes[0] | lobes[1]).is_transmissive()];
    let ns = bsdf.ns().as_vector();
    let towards = ns * ns.dot(place.wo).signum();
    let correct = correction(bsdf);
    let accept = |index: u32| {
        let wi = photons.wi(index);
        wants_side[usize::from(wi.dot(towards) < 0.0)].then_some((index, wi))
    };
    let mut add = |power: Xyz, weight: f32, wi: Vector3| {
        for (lobes, sum) in lobes.iter().zip(&mut sums).filter(|(lobes, _)| !lobes.is_empty()) {
            sum.add(power, weight, bsdf.eval(place.wo, wi, TransportMode::Radiance, *lobes));
        }
    };
    let tangent = (place.p, bsdf.ng().as_vector());
    let density = if matches!(bsdf.kind(), BsdfKind::Layered(_)) {
        let mut all = std::mem::take(&mut scratch.weighted);
        all.clear();
        let density = estimate.sum(tangent, wanted, photons, scratch, accept, |weight, (index, wi)| {
            all.push((weight * correct(wi), index));
        });
        choose(place.p, &all, photons, |index, weight| add(photons.power(index), weight, photons.wi(index)));
        scratch.weighted = all;
        density
    } else {
        estimate.sum(tangent, wanted, photons, scratch, accept, |weight, (index, wi)| {
            add(photons.power(index), weight * correct(wi), wi);
        })
    };
    let [diffuse, glossy] = sums.map(|sum| sum.radiance(density.per_area, place.lambda));
    let radiance = diffuse + glossy;
    RadianceEstimate { radiance, density }
}

/// Chooses a few of the photons at random, evenly along their list and in proportion to power, and weighs them so that the
/// expectation of sums over them is that of all. For surfaces that cost a random walk for each photon: their noise, and that
/// of the choice, goes as that of other walks does, with the samples of the pixel.
fn choose(p: Point3, all: &[(f32, u32)], photons: &impl Photons, mut show: impl FnMut(u32, f32)) {
    let share = |(weight, index): &(f32, u32)| {
        let Xyz { x, y, z } = photons.power(*index);
        weight * (x + y + z)
    };
    let step = all.iter().map(share).sum::<f32>() / N_CHOSEN as f32;
    let is_sound = step > 0.0 && step.is_finite();
    if all.len() <= N_CHOSEN || !is_sound {
        all.iter().for_each(|(weight, index)| show(*index, *weight));
        return;
    }
    // The place is as random as any number, and the choice the same whoever asks.
    let bits = hash64(&[p.x, p.y, p.z].map(|v| u64::from(v.to_bits())));
    let mut next = step * (bits >> 40) as f32 / (1 << 24) as f32;
    let mut passed = 0.0;
    for photon in all {
        let of_this = share(photon);
        passed += of_this;
        let mut n = 0;
        while next < passed {
            n += 1;
            next += step;
        }
        if n > 0 {
            show(photon.1, photon.0 * (n as f32 * step / of_this));
        }
    }
}
