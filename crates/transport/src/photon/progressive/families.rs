//! Families of photons: those whose first event is sharp, aimed at what may be sharp, and all others.
//!
//! Little of a lamp's light may meet what casts caustics. If few photons do, caustics are wide spots, and shine through where they are
//! hidden. So a share of the photons is aimed by projection maps (SPEC EMI-10), which leave what comes from there the same
//! in expectation. Paths whose first event is sharp belong to them, all others to the rest: nothing counts twice.

use std::ops::Range;

use etendue_scene::Scene;

use super::ProgressiveSettings;
use crate::lpe::Event;
use crate::photon::{EmissionSettings, PhotonEmitter, PhotonVertex, PhotonWalk, Target};

/// Photons of a group that are emitted alike.
#[derive(Clone, Debug)]
pub(super) struct Family {
    pub(super) emitter: PhotonEmitter,
    pub(super) walk: PhotonWalk,
    /// Photons of each group.
    pub(super) n_photons: u64,
    /// Those of all families.
    n_group: u64,
    first_events: FirstEvents,
}

/// The first events of a family's paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FirstEvents {
    Any,
    Sharp,
    NotSharp,
}

impl Family {
    /// The families among which so many photons of a group are divided. Each has streams of its own: one for the photons and, after
    /// it, one for pilots.
    pub(super) fn of(
        scene: &Scene,
        settings: &ProgressiveSettings,
        walk: PhotonWalk,
        n_group: u64,
    ) -> Vec<Self> {
        let emission = EmissionSettings { sharp_alpha: walk.sharp_alpha, ..EmissionSettings::default() };
        let family = |emitter, n_photons, first_events, stream| Self {
            emitter,
            walk: PhotonWalk { stream, ..walk },
            n_photons,
            n_group,
            first_events,
        };
        let plain = PhotonEmitter::reaching(scene, &emission);
        let n_aimed = (n_group as f64 * f64::from(settings.caustic_share)) as u64;
        if n_aimed > 0 && n_aimed < n_group {
            let at_sharp = EmissionSettings { target: Target::SharpShapes, ..emission };
            let aimed = PhotonEmitter::aimed(scene, &at_sharp);
            // Where as much of the light goes there anyway, nothing is won.
            let (sent, enough) = (aimed.sent_share(), f64::from(settings.caustic_share) * plain.sent_share());
            if sent > 0.0 && sent < enough {
                return vec![
                    family(plain, n_group - n_aimed, FirstEvents::NotSharp, 0),
                    family(aimed, n_aimed, FirstEvents::Sharp, 2),
                ];
            }
        }
        vec![family(plain, n_group, FirstEvents::Any, 0)]
    }

    /// Photons of a group that leave lights.
    pub(super) const fn n_emitted(&self) -> u64 {
        if self.emitter.is_idle() { 0 } else { self.n_photons }
    }

    /// Indices of the photons of a group.
    pub(super) const fn range(&self, group: u64) -> Range<u64> {
        group * self.n_photons..(group + 1) * self.n_photons
    }

    /// What flux is multiplied by where it is divided by the photons of all families.
    pub(super) fn weight(&self) -> f32 {
        (self.n_group as f64 / self.n_photons as f64) as f32
    }

    /// Whether a photon that arrives is of the family; `None` while it may become so.
    pub(super) fn holds(&self, vertex: &PhotonVertex<'_>) -> Option<bool> {
        let is_sharp = |event| matches!(event, Event::Specular | Event::SharpGlossy);
        match (self.first_events, vertex.trail.events().next()) {
            (FirstEvents::Any, _) | (FirstEvents::NotSharp, None) => Some(true),
            (FirstEvents::Sharp, None) => None,
            (FirstEvents::Sharp, Some(event)) => Some(is_sharp(event)),
            (FirstEvents::NotSharp, Some(event)) => Some(!is_sharp(event)),
        }
    }
}
