//! The photons of a group: light of its wavelengths, where it arrives at surfaces that receive.

use std::ops::Range;

use etendue_geometry::points::PackedPoints;
use etendue_math::{Normal3, Point3, Vector3};
use etendue_scene::Scene;
use etendue_scene::bsdf::{Bsdf, Lobes};
use etendue_spectrum::{Sampled, Wavelengths};
use rayon::prelude::*;

use super::families::Family;
use super::patch::Patch;
use crate::integrator::{Control, RayCounts};
use crate::path::camera_pass::Tracer;
use crate::photon::{Onward, PhotonVertex, Trail};

/// Photons that one task follows: results are in order of the photons for any number of threads.
const PHOTONS_PER_TASK: u64 = 4096;

/// A photon that arrived.
#[derive(Clone, Copy, Debug)]
pub(super) struct GroupPhoton {
    /// Flux at the wavelengths of the group, if it is the only one emitted.
    pub(super) flux: Sampled,
    /// Direction to where it came from.
    pub(super) wi: Vector3,
    /// Geometric normal of the surface, on the side of `wi`.
    pub(super) n: Normal3,
    /// Events before it arrived.
    pub(super) depth: u16,
    /// Dispersion has left the first wavelength alone; the others are 0.
    pub(super) is_single: bool,
    /// The lobes through which it may be seen: all, but where artists have switched something off.
    pub(super) lobes: Lobes,
}

/// How the photons of a group are made.
#[derive(Clone, Copy, Debug)]
pub(super) struct PhotonPlan<'p> {
    pub(super) families: &'p [Family],
    pub(super) lambda: Wavelengths,
    /// When, in seconds; `None` for any time.
    pub(super) time: Option<f32>,
    /// Photons of fewer events are not kept.
    pub(super) least_depth: u32,
    /// Narrower glossy lobes do not receive.
    pub(super) receiver_alpha: f32,
    /// Keeps the words of their paths.
    pub(super) wants_trails: bool,
}

/// The photons of a group, to be found by place.
#[derive(Debug, Default)]
pub(super) struct GroupPhotons {
    tree: PackedPoints,
    photons: Vec<GroupPhoton>,
    /// The words of their paths, if they are wanted.
    trails: Vec<Trail>,
    pub(super) n_emitted: u64,
}

/// The lobes of a surface that receive photons: those that are not followed.
#[inline]
pub(super) fn receiving_lobes(bsdf: &Bsdf, receiver_alpha: f32) -> Lobes {
    let lobes = bsdf.lobes() & Lobes::NON_SPECULAR;
    if lobes.is_glossy() && bsdf.glossy_roughness() < receiver_alpha { lobes & Lobes::DIFFUSE } else { lobes }
}

#[derive(Debug, Default)]
struct Part {
    points: Vec<Point3>,
    photons: Vec<GroupPhoton>,
    trails: Vec<Trail>,
}

impl GroupPhotons {
    /// Emits and follows the photons of a group in parallel; `None` if the render was stopped meanwhile.
    pub(super) fn trace(
        scene: &Scene,
        group: u64,
        plan: &PhotonPlan<'_>,
        control: &Control<'_>,
    ) -> Option<Self> {
        let n_emitted = plan.families.iter().map(|family| family.n_photons).sum();
        let tasks_of = |family| {
            let range = Family::range(family, group);
            let starts = range.clone().step_by(PHOTONS_PER_TASK as usize);
            starts.map(move |start| (family, start..range.end.min(start + PHOTONS_PER_TASK)))
        };
        let tasks: Vec<_> = plan.families.iter().flat_map(tasks_of).collect();
        let parts: Vec<Part> = tasks
            .into_par_iter()
            .map(|(family, range)| {
                let mut part = Part::default();
                if !control.is_cancelled() {
                    control.tile_done(0, plan.trace_part(scene, family, range, &mut part));
                }
                part
            })
            .collect();
        (!control.is_cancelled()).then(|| Self::new(&parts, n_emitted))
    }

    fn new(parts: &[Part], n_emitted: u64) -> Self {
        let all: Vec<GroupPhoton> = parts.iter().flat_map(|part| &part.photons).copied().collect();
        let all_trails: Vec<Trail> = parts.iter().flat_map(|part| &part.trails).copied().collect();
        let points: Vec<Point3> = parts.iter().flat_map(|part| &part.points).copied().collect();
        let (tree, order) = PackedPoints::new(&points);
        let photons = order.par_iter().map(|index| all[*index as usize]).collect();
        let trails = if all_trails.is_empty() {
            Vec::new()
        } else {
            order.iter().map(|index| all_trails[*index as usize]).collect()
        };
        Self { tree, photons, trails, n_emitted }
    }

    /// Number of photons that arrived.
    pub(super) const fn len(&self) -> usize {
        self.photons.len()
    }

    /// Visits the photons that a patch holds, with their weight and index, always in the same order.
    #[inline]
    pub(super) fn visit(&self, patch: &Patch, visit: &mut impl FnMut(&GroupPhoton, f32, u32)) {
        self.tree.within(patch.p, patch.radius, |found| {
            let photon = &self.photons[found.index as usize];
            let side = photon.wi.dot_normal(patch.n);
            let weight = patch.weight(self.tree.point(found.index), photon.n, side);
            if weight > 0.0 {
                visit(photon, weight, found.index);
            }
        });
    }

    /// The word of a photon's path.
    pub(super) fn trail(&self, index: u32) -> Trail {
        self.trails.get(index as usize).copied().unwrap_or_default()
    }
}

impl PhotonPlan<'_> {
    fn trace_part(&self, scene: &Scene, family: &Family, range: Range<u64>, part: &mut Part) -> RayCounts {
        let tracer = Tracer::new(scene);
        for index in range {
            let mut numbers = family.walk.numbers(index);
            // The place of a wavelength of its own.
            numbers.next_1d();
            let mut lambda = self.lambda;
            let photon = family.emitter.emit_at(self.time, scene, &mut numbers, &lambda);
            let Some(photon) = photon else { continue };
            family.walk.follow(&tracer, &photon, &mut numbers, &mut lambda, &mut |vertex| {
                let holds = family.holds(vertex);
                if holds == Some(true) {
                    self.keep(vertex, family.weight(), part);
                }
                if holds == Some(false) { Onward::Stop } else { Onward::Continue }
            });
        }
        tracer.counts()
    }

    fn keep(&self, vertex: &PhotonVertex<'_>, weight: f32, part: &mut Part) {
        let received = receiving_lobes(vertex.bsdf, self.receiver_alpha) & vertex.lobes;
        if vertex.depth < self.least_depth || received.is_empty() {
            return;
        }
        let (surface, wi) = (vertex.surface, vertex.surface.wo);
        let cos_geometric = wi.dot_normal(surface.point.ng).abs();
        if cos_geometric == 0.0 {
            return;
        }
        // Flux falls on the geometric surface, and is reflected by the shading normal's [Veach 1997, section 5.3].
        let mut flux = vertex.flux * (weight * vertex.bsdf.abs_cos(wi) / cos_geometric);
        let is_single = vertex.lambda.secondary_terminated() && !self.lambda.secondary_terminated();
        if is_single {
            flux = Sampled::from_array([flux[0], 0.0, 0.0, 0.0]);
        }
        if flux.is_black() || !flux.is_finite() {
            return;
        }
        part.points.push(surface.point.p);
        part.photons.push(GroupPhoton {
            flux,
            wi,
            n: surface.point.ng.facing(wi),
            depth: vertex.depth as u16,
            is_single,
            lobes: vertex.lobes,
        });
        if self.wants_trails {
            part.trails.push(vertex.trail);
        }
    }
}
