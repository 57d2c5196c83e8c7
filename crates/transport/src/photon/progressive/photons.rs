//! The photons of a group: light of its wavelengths, where it arrives at surfaces that receive.

use std::ops::Range;

use etendue_geometry::points::PackedPoints;
use etendue_math::{Point3, Vector3};
use etendue_scene::Scene;
use etendue_scene::bsdf::{Bsdf, Lobes};
use etendue_spectrum::{Sampled, Wavelengths};
use rayon::prelude::*;

use crate::integrator::{Control, RayCounts};
use crate::path::camera_pass::Tracer;
use crate::photon::{Onward, PhotonEmitter, PhotonVertex, PhotonWalk, Trail};

/// Photons that one task follows: results are in order of the photons for any number of threads.
const PHOTONS_PER_TASK: u64 = 4096;

/// A photon that arrived.
#[derive(Clone, Copy, Debug)]
pub(super) struct GroupPhoton {
    /// Flux at the wavelengths of the group, if it is the only one emitted.
    pub(super) flux: Sampled,
    pub(super) p: Point3,
    /// Direction to where it came from.
    pub(super) wi: Vector3,
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
    pub(super) emitter: &'p PhotonEmitter,
    pub(super) walk: &'p PhotonWalk,
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
    photons: Vec<GroupPhoton>,
    trails: Vec<Trail>,
}

impl GroupPhotons {
    /// Emits and follows photons of these indices in parallel; `None` if the render was stopped meanwhile.
    pub(super) fn trace(
        scene: &Scene,
        range: Range<u64>,
        plan: &PhotonPlan<'_>,
        control: &Control<'_>,
    ) -> Option<Self> {
        let n_emitted = range.end - range.start;
        let n_tasks = n_emitted.div_ceil(PHOTONS_PER_TASK);
        let parts: Vec<Part> = (0..n_tasks)
            .into_par_iter()
            .map(|task| {
                let mut part = Part::default();
                if !control.is_cancelled() {
                    let start = range.start + task * PHOTONS_PER_TASK;
                    let rays =
                        plan.trace_part(scene, start..range.end.min(start + PHOTONS_PER_TASK), &mut part);
                    control.tile_done(0, rays);
                }
                part
            })
            .collect();
        (!control.is_cancelled()).then(|| Self::new(&parts, n_emitted))
    }

    fn new(parts: &[Part], n_emitted: u64) -> Self {
        let all: Vec<GroupPhoton> = parts.iter().flat_map(|part| &part.photons).copied().collect();
        let all_trails: Vec<Trail> = parts.iter().flat_map(|part| &part.trails).copied().collect();
        let points: Vec<Point3> = all.par_iter().map(|photon| photon.p).collect();
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

    /// Visits the photons no farther from `p` than `radius`, always in the same order.
    #[inline]
    pub(super) fn within(&self, p: Point3, radius: f32, visit: &mut impl FnMut(&GroupPhoton, u32)) {
        self.tree.within(p, radius, |n| visit(&self.photons[n.index as usize], n.index));
    }

    /// The word of a photon's path.
    pub(super) fn trail(&self, index: u32) -> Trail {
        self.trails.get(index as usize).copied().unwrap_or_default()
    }
}

impl PhotonPlan<'_> {
    fn trace_part(&self, scene: &Scene, range: Range<u64>, part: &mut Part) -> RayCounts {
        let tracer = Tracer::new(scene);
        for index in range {
            let mut numbers = self.walk.numbers(index);
            // The place of a wavelength of its own.
            numbers.next_1d();
            let mut lambda = self.lambda;
            let photon = self.emitter.emit_at(self.time, scene, &mut numbers, &lambda);
            let Some(photon) = photon else { continue };
            self.walk.follow(&tracer, &photon, &mut numbers, &mut lambda, &mut |vertex| {
                self.keep(vertex, part);
                Onward::Continue
            });
        }
        tracer.counts()
    }

    fn keep(&self, vertex: &PhotonVertex<'_>, part: &mut Part) {
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
        let mut flux = vertex.flux * (vertex.bsdf.abs_cos(wi) / cos_geometric);
        let is_single = vertex.lambda.secondary_terminated() && !self.lambda.secondary_terminated();
        if is_single {
            flux = Sampled::from_array([flux[0], 0.0, 0.0, 0.0]);
        }
        if flux.is_black() || !flux.is_finite() {
            return;
        }
        part.photons.push(GroupPhoton {
            flux,
            p: surface.point.p,
            wi,
            depth: vertex.depth as u16,
            is_single,
            lobes: vertex.lobes,
        });
        if self.wants_trails {
            part.trails.push(vertex.trail);
        }
    }
}
