//! Path tracing (Kajiya 1986) with next event estimation, multiple importance sampling and Russian roulette.
//!
//! A path leaves the camera and scatters until it is lost:
//! `L = sum over k of beta_k L_e(x_k)`, where `beta_k` is the product of `f |cos| / pdf` along the way. Each light is
//! found in two ways: by sampling it from every vertex, and by running into it. The power heuristic weighs the two
//! (Veach and Guibas 1995). Unbiased but for `maxdepth`.
//!
//! SPEC: PT-1 to PT-5, EQ-1, EQ-7, MC-11, MC-12, MC-15.

mod artist;
mod mirrored;
mod reuse;
mod settings;
pub(crate) mod walk;

use etendue_scene::film::TileSamples;
use etendue_scene::{Film, Scene};
use etendue_spectrum::Sampled;

use self::reuse::Reuse;
use self::walk::Walk;
use crate::integrator::{Control, Integrator, PassEnd, Passes};
use crate::lpe::PathExpressions;
use crate::path::camera_pass::{CameraPass, CameraPath, Follow, FollowedPath, Tracer};

pub(crate) use artist::Artist;
pub(crate) use mirrored::Mirrored;
pub use settings::{LightStrategy, PathSettings};

use self::settings::MAX_REUSE;

/// The path tracer.
#[derive(Clone, Debug)]
pub struct PathTracer {
    settings: PathSettings,
    expressions: PathExpressions,
    /// Memory of the last pass's tiles, for the next.
    tiles: Vec<TileSamples>,
}

impl PathTracer {
    /// A path tracer that fills the film's layers by these expressions, in their order. Where there are any, paths are not
    /// shared and pixels not interpolated; nor are they where paths are shared.
    #[must_use]
    pub fn new(mut settings: PathSettings, expressions: PathExpressions) -> Self {
        settings.reuse = if expressions.is_empty() { settings.reuse.clamp(1, MAX_REUSE) } else { 1 };
        if !expressions.is_empty() || settings.reuse > 1 {
            settings.adaptive = None;
        }
        Self { settings, expressions, tiles: Vec::new() }
    }
}

impl Integrator for PathTracer {
    fn passes(&self) -> Passes {
        Passes::Independent
    }

    fn run_pass(&mut self, scene: &Scene, pass: u64, film: &mut Film, control: &Control<'_>) -> PassEnd {
        let settings = &self.settings;
        // What is switched off depends on the way from the camera, so that paths cannot be shared.
        let group_size = if scene.controls.is_some() { 1 } else { settings.reuse };
        let camera_pass = CameraPass {
            wavelengths: settings.wavelengths,
            expressions: &self.expressions,
            group_size,
            adaptive: settings.adaptive,
        };
        if group_size > 1 {
            camera_pass.run(scene, pass, film, control, &mut self.tiles, &Reuse { settings })
        } else {
            camera_pass.run(scene, pass, film, control, &mut self.tiles, &Alone { settings })
        }
    }
}

/// Paths that leave nothing for others.
#[derive(Debug)]
struct Alone<'s> {
    settings: &'s PathSettings,
}

impl Follow for Alone<'_> {
    type Left = ();

    fn follow(&self, tracer: &Tracer<'_>, path: &mut CameraPath<'_, '_>) -> (Sampled, ()) {
        (Walk::new(self.settings, path).follow(tracer, path), ())
    }

    fn join(&self, _: &Tracer<'_>, _: &mut [FollowedPath<()>]) {}
}
