//! Photons are emitted until a map holds as many as planned.

use etendue_math::{Normal3, Point3};
use etendue_scene::Scene;

use super::lit_map::wide_lobes;
use super::plan::MapPlan;
use crate::integrator::{Control, RayCounts};
use crate::photon::map::{PhotonMap, PhotonMapBuilder, StoredPhoton};
use crate::photon::walk::trace_photons_until;
use crate::photon::{Absorption, Onward, PhotonEmitter, PhotonVertex};

/// Where a photon arrived, and the geometric normal on the side that it came from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrival {
    /// Place.
    pub(crate) p: Point3,
    /// Normal.
    pub(crate) n: Normal3,
}

/// A photon on its way into a map, with its number among those that were emitted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shot {
    index: u64,
    pub(super) photon: StoredPhoton,
    n: Normal3,
}

/// The least that are emitted, all before any are counted: maps of few photons would be too bright if emission stopped with them.
/// Photons that branch are too many for that.
const LEAST_EMITTED: u64 = 20_000;
/// After so many in vain there is nothing to be found, such as caustics where nothing mirrors or refracts.
const FRUITLESS: u64 = 200_000;

/// A map, and where its photons arrived.
#[derive(Clone, Debug, Default)]
pub(crate) struct Traced {
    /// The photons.
    pub(crate) map: PhotonMap,
    /// Of one of [`Self::place_step`] photons.
    pub(crate) arrivals: Vec<Arrival>,
    /// 0 for none.
    pub(crate) place_step: usize,
}

/// Emits photons until there are as many as planned, or as many were emitted as is worthwhile. Places where they arrived
/// come with it. `None` if the render was cancelled meanwhile.
#[must_use]
pub(crate) fn trace_map(
    scene: &Scene,
    emitter: &PhotonEmitter,
    plan: &MapPlan,
    control: &Control<'_>,
) -> Option<Traced> {
    let mut parts: Vec<Vec<Shot>> = Vec::new();
    let mut n_stored = 0;
    let mut n_emitted = 0;
    let most = plan.n_photons.saturating_mul(plan.content.most_emitted()).max(LEAST_EMITTED);
    // Of photons that branch few are enough to tell how many are kept.
    let first = if plan.walk.absorption == Absorption::Branch { 1 << 11 } else { 1 << 20 };
    let is_vain = plan.n_photons == 0 || emitter.is_idle();
    let mut next = if is_vain { 0 } else { (plan.n_photons / 4).max(LEAST_EMITTED).min(first) };
    while next > 0 {
        let range = n_emitted..n_emitted + next;
        n_emitted = range.end;
        let keep = |index, vertex: &PhotonVertex<'_>, kept: &mut Vec<Shot>| visit(plan, index, vertex, kept);
        let (more, _) = trace_photons_until(scene, emitter, range, &plan.walk, control, keep);
        if control.is_cancelled() {
            return None;
        }
        n_stored += more.iter().map(Vec::len).sum::<usize>();
        parts.extend(more);
        next = next_round(plan.n_photons, n_stored as u64, n_emitted, most);
    }
    // Of which those that are kept are a share.
    let mut emitted = n_emitted.max(1) as f64;
    if let Some(last) = plan.n_photons.checked_sub(1).and_then(|place| nth(&parts, place as usize)) {
        // No more than were wanted, but for the rest of the way of the last. How many were emitted for each is told by all:
        // emission that stops at a photon that is stored would tell too few, by one of their number.
        let last = last.index;
        for part in &mut parts {
            part.truncate(part.partition_point(|shot| shot.index <= last));
        }
        let n_kept = parts.iter().map(Vec::len).sum::<usize>();
        emitted *= n_kept as f64 / n_stored as f64;
        n_emitted = (emitted.round() as u64).max(1);
    }
    let n_places = if plan.place_step > 0 { usize::MAX } else { 0 };
    let places = parts.iter().flatten().step_by(plan.place_step.max(1)).take(n_places);
    let arrivals = places.map(|shot| Arrival { p: shot.photon.position, n: shot.n }).collect();
    let mut builder = PhotonMapBuilder::new(usize::MAX);
    // There may be many millions: those that are stored go as others come.
    for part in parts {
        for shot in &part {
            builder.store(&shot.photon);
        }
        // Whoever interrupts need not wait for all of them.
        control.tile_done(0, RayCounts::default());
        if control.is_cancelled() {
            return None;
        }
    }
    builder.scale_power((1.0 / emitted) as f32);
    Some(Traced { map: builder.balance(n_emitted), arrivals, place_step: plan.place_step })
}

/// The shot of that number.
fn nth(parts: &[Vec<Shot>], mut place: usize) -> Option<&Shot> {
    for part in parts {
        if let Some(shot) = part.get(place) {
            return Some(shot);
        }
        place -= part.len();
    }
    None
}

/// Keeps a photon that belongs into the map.
pub(super) fn visit(plan: &MapPlan, index: u64, vertex: &PhotonVertex<'_>, kept: &mut Vec<Shot>) -> Onward {
    let wide = wide_lobes(vertex.bsdf, plan.walk.sharp_alpha);
    if wide.intersects(vertex.lobes) && plan.content.holds(vertex.trail) {
        let ng = vertex.surface.point.ng;
        let photon = StoredPhoton::of(vertex);
        kept.push(Shot { index, photon, n: if ng.dot_vector(photon.wi) < 0.0 { -ng } else { ng } });
    }
    let is_sharp = wide != vertex.bsdf.lobes();
    if plan.content.may_follow(vertex.trail, is_sharp) { Onward::Continue } else { Onward::Stop }
}

/// Photons to emit next, by how many of those so far were stored; 0 to end.
fn next_round(wanted: u64, n_stored: u64, n_emitted: u64, most: u64) -> u64 {
    if n_stored >= wanted || n_emitted >= most {
        return 0;
    }
    if n_stored == 0 {
        return FRUITLESS.min(most).saturating_sub(n_emitted);
    }
    let missing = wanted - n_stored;
    let share = (n_stored as f64 / n_emitted as f64).max(1e-3);
    let needed = (missing as f64 / share * 1.02).ceil() as u64;
    needed.clamp(1000, 1 << 22).min(most - n_emitted)
}
