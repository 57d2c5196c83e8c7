//! What paths from the lights cannot bring to the camera, for no chance leads a connection along it: light that the camera sees
//! directly, and what it sees in mirrors and through clear glass.

use etendue_scene::bsdf::{Lobes, TransportMode};
use etendue_spectrum::Sampled;

use super::PathSettings;
use super::walk::Walk;
use crate::path::camera_pass::{CameraPath, Follow, FollowedPath, Tracer};

/// Paths that show what emits and, as far as the depth allows, go on where the first surface scatters in single directions.
#[derive(Debug)]
pub(crate) struct Mirrored<'s> {
    pub(crate) settings: &'s PathSettings,
}

impl Follow for Mirrored<'_> {
    type Left = ();

    fn follow(&self, tracer: &Tracer<'_>, path: &mut CameraPath<'_, '_>) -> (Sampled, ()) {
        let mut walk = Walk::new(self.settings, path);
        let Some((surface, bsdf)) = walk.arrive(tracer, path) else { return (walk.radiance, ()) };
        if !bsdf.lobes().intersects(Lobes::SPECULAR) {
            return (walk.radiance, ());
        }
        path.sampler.start_vertex();
        path.sampler.skip_light();
        let (u_component, u) = (path.sampler.next_1d(), path.sampler.next_2d());
        let sample = bsdf.sample(surface.wo, u_component, u, TransportMode::Radiance, Lobes::SPECULAR);
        let Some(sample) = sample else { return (walk.radiance, ()) };
        walk.leave(tracer.scene, &surface, &sample, 1.0, path.layers);
        let goes_on = walk.survives_roulette(path);
        (walk.follow_if(goes_on, tracer, path), ())
    }

    fn join(&self, _: &Tracer<'_>, _: &mut [FollowedPath<()>]) {}
}
