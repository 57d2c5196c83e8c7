//! A map of the photons of a scene.

use etendue_math::{SamplerKind, SamplerSettings};
use etendue_scene::Scene;
use etendue_spectrum::flux_to_xyz;

use super::{PhotonMap, StoredPhoton};
use crate::photon::{
    EmissionSettings, Onward, PhotonEmitter, PhotonVertex, PhotonWalk, Trail, trace_photons,
};

impl PhotonMap {
    /// Emits so many photons, aimed at shapes if few would meet any, and stores those whose trail is to be kept wherever they
    /// meet a surface that is no mere mirror or glass (SPEC PHT-10). In parallel on the current rayon pool; the same for any number of
    /// threads.
    #[must_use]
    pub fn trace(scene: &Scene, n_emitted: u64, seed: u64, keeps: impl Fn(Trail) -> bool + Sync) -> Self {
        let emitter = PhotonEmitter::reaching(scene, &EmissionSettings::default());
        let sampler = SamplerSettings { kind: SamplerKind::Independent, seed, samples_per_pixel: 1 };
        let walk = PhotonWalk { sampler, ..PhotonWalk::default() };
        let (photons, _) = trace_photons(scene, &emitter, 0..n_emitted, &walk, |_, vertex, stored| {
            if keeps(vertex.trail) && vertex.bsdf.lobes().has_non_specular() {
                stored.push(StoredPhoton::of(vertex));
            }
            Onward::Continue
        });
        Self::from_photons(&photons, n_emitted)
    }
}

impl StoredPhoton {
    /// The photon that arrives at a vertex.
    #[inline]
    #[must_use]
    pub fn of(vertex: &PhotonVertex<'_>) -> Self {
        Self {
            position: vertex.surface.point.p,
            power: flux_to_xyz(vertex.flux, vertex.lambda),
            wi: vertex.surface.wo,
            trail: vertex.trail,
            is_shadow: false,
        }
    }
}
