//! Light tracing (Arvo 1986, "Backward Ray Tracing"; Dutré and Willems 1994, "Importance-driven Monte Carlo Light Tracing"):
//! paths leave the lights as photons do, and the camera looks at every surface that they meet.
//!
//! The light of a path is spread over the pixels where the camera sees its surfaces ([`connect`], [`SplatSums`]), so that it
//! finds in few paths what paths from the camera miss: light that comes to a surface through mirrors and glass, `LS+DE`. It cannot
//! find what the camera sees in mirrors and through glass, `L(S|D)*SE`: no connection hits on the one direction that counts. Paths
//! from the camera show those if asked to (`"bool mirrors" true`); without, the image is that of `path` for the expression
//! `L(S|D)*DE|LE`. What emits is seen by rays from the camera in any case (`LE`), since they show it without noise.
//!
//! A pass is one ray from the camera for each pixel, and as many paths from the lights. Unbiased but for `maxdepth`, the film's limit of what a
//! pixel gets in a pass, and filters that are so wide that splats are drawn by them.
//!
//! SPEC: BDPT-7, LPE-3, LPE-4.

mod connect;
mod settings;

use std::ops::Range;

use etendue_scene::camera::Projection;
use etendue_scene::film::{SplatSums, Splats, TileSamples};
use etendue_scene::{Film, Scene};
use rayon::prelude::*;

use self::connect::Connector;
use crate::integrator::{Control, Integrator, PassEnd, Passes, ReportEntry};
use crate::lpe::PathExpressions;
use crate::path::camera_pass::{CameraPass, Tracer};
use crate::path_tracing::{Mirrored, PathSettings, PathTracer};
use crate::photon::{PhotonEmitter, PhotonWalk, Switches};

pub use settings::LightSettings;

/// Most paths that one task follows, and tasks whose splats are in memory together; neither changes the result, which adds up path
/// by path.
const MAX_PATHS_PER_TASK: u64 = 1024;
const TASKS_PER_BATCH: u64 = 64;

/// Numbers that the paths of a task leave at most if the camera sees all of their events: half a megabyte.
const NUMBERS_PER_TASK: u64 = 1 << 17;

/// The stream of random numbers that choose points of the lens, apart from those of the paths.
const LENS_STREAM: u32 = 1;

/// The light tracer.
#[derive(Clone, Debug)]
pub struct LightTracer {
    settings: LightSettings,
    expressions: PathExpressions,
    /// Memory of the last pass, for the next.
    tiles: Vec<TileSamples>,
    sums: SplatSums,
    /// Of the scene that the first pass saw.
    emitter: Option<PhotonEmitter>,
    tally: Tally,
    /// In the place of this method where light cannot be traced to the camera.
    stand_in: Option<Box<PathTracer>>,
}

/// What paths from the lights did.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    n_paths: u64,
    /// How often the camera saw where one arrived.
    n_connections: u64,
    /// One arrived at a mirror or clear glass within the picture, to which nothing connects.
    met_mirrors: bool,
}

impl std::ops::AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.n_paths += other.n_paths;
        self.n_connections += other.n_connections;
        self.met_mirrors |= other.met_mirrors;
    }
}

impl LightTracer {
    /// A light tracer that fills the film's layers by these expressions, in their order.
    #[must_use]
    pub fn new(settings: LightSettings, expressions: PathExpressions) -> Self {
        Self {
            settings,
            expressions,
            tiles: Vec::new(),
            sums: SplatSums::default(),
            emitter: None,
            tally: Tally::default(),
            stand_in: None,
        }
    }

    /// The way through a lens of glass cannot be found from the far side: paths from the camera show all then.
    fn stand_in(&mut self) -> &mut PathTracer {
        let settings = PathSettings { max_depth: self.settings.max_depth, ..self.settings.of_camera_paths() };
        let new = || Box::new(PathTracer::new(settings, self.expressions.clone()));
        self.stand_in.get_or_insert_with(new)
    }
}

impl Integrator for LightTracer {
    fn passes(&self) -> Passes {
        Passes::Independent
    }

    fn run_pass(&mut self, scene: &Scene, pass: u64, film: &mut Film, control: &Control<'_>) -> PassEnd {
        if matches!(scene.camera.projection(), Projection::Realistic(_)) {
            return self.stand_in().run_pass(scene, pass, film, control);
        }
        let settings = &self.settings;
        let camera_settings = settings.of_camera_paths();
        let camera_pass = CameraPass {
            wavelengths: settings.wavelengths,
            expressions: &self.expressions,
            group_size: 1,
            adaptive: None,
        };
        let seen = Mirrored { settings: &camera_settings };
        let mut end = camera_pass.gather(scene, pass, film, control, &mut self.tiles, &seen);
        self.sums.restart(film);
        let [width, height] = film.settings().resolution;
        let n_paths = settings.n_paths.map_or(film.settings().crop.n_pixels() as u64, u64::from);
        let emitter = &*self.emitter.get_or_insert_with(|| PhotonEmitter::new(scene));
        let paths = LightPass { settings, expressions: &self.expressions, scene, emitter, film, control };
        let done = paths.run(pass * n_paths..(pass + 1) * n_paths, &mut self.sums);
        if done.n_paths < n_paths {
            end = PassEnd::Cancelled;
        }
        // Whole passes only, but for the very first: better a noisier picture than none.
        if end == PassEnd::Complete || film.n_passes() == 0 {
            let n_pixels = f64::from(width) * f64::from(height);
            self.sums.join(&mut self.tiles, film, n_pixels / done.n_paths.max(1) as f64);
            film.add_tiles(&self.tiles);
            self.tally += done;
        }
        end
    }

    fn report(&self) -> Vec<ReportEntry> {
        if self.stand_in.is_some() {
            let advice = "no way leads back through the glass of a \"realistic\" camera: \"path\" stood in for \"light\"";
            return vec![ReportEntry::new("stand_in", 1.0, "").with_advice(advice)];
        }
        let Tally { n_paths, n_connections, met_mirrors } = self.tally;
        let mut connections = ReportEntry::new("connections", n_connections as f64, "");
        if n_connections == 0 && self.settings.max_depth > 0 {
            connections = connections
                .with_advice("the camera saw no surface that light reached; \"path\" may find more");
        } else if met_mirrors && !self.settings.mirrors {
            connections = connections.with_advice(
                "mirrors and clear glass show nothing: \"bool mirrors\" true adds what the camera sees in them",
            );
        }
        vec![ReportEntry::new("light_paths", n_paths as f64, ""), connections]
    }
}

/// What the paths from the lights of a pass have in common.
#[derive(Debug)]
struct LightPass<'p> {
    settings: &'p LightSettings,
    expressions: &'p PathExpressions,
    scene: &'p Scene,
    emitter: &'p PhotonEmitter,
    film: &'p Film,
    control: &'p Control<'p>,
}

impl LightPass<'_> {
    /// Follows these paths, as far as it is not told to stop.
    fn run(&self, paths: Range<u64>, sums: &mut SplatSums) -> Tally {
        let n_paths = paths.end - paths.start;
        if self.emitter.is_dark() || self.settings.max_depth == 0 {
            return Tally { n_paths, ..Tally::default() };
        }
        let paths_per_task = self.paths_per_task();
        let n_tasks = n_paths.div_ceil(paths_per_task);
        let mut tally = Tally::default();
        for batch in (0..n_tasks).step_by(TASKS_PER_BATCH as usize) {
            let tasks = batch..n_tasks.min(batch + TASKS_PER_BATCH);
            let done: Vec<Option<(Splats<'_>, Tally)>> = tasks
                .into_par_iter()
                .map(|task| {
                    let start = paths.start + task * paths_per_task;
                    let end = paths.end.min(start + paths_per_task);
                    (!self.control.is_cancelled()).then(|| self.trace(start..end))
                })
                .collect();
            let mut splats = Vec::with_capacity(done.len());
            for (task, done) in done.into_iter().flatten() {
                tally += done;
                splats.push(task);
            }
            sums.add(&splats, &self.scene.filter);
        }
        tally
    }

    /// So many that their splats fit into the memory of a task, however long they get; one at least.
    fn paths_per_task(&self) -> u64 {
        let numbers_per_path =
            u64::from(self.settings.max_depth) * Splats::new(self.film).numbers_each() as u64;
        (NUMBERS_PER_TASK / numbers_per_path.max(1)).clamp(1, MAX_PATHS_PER_TASK)
    }

    /// What the paths of a task bring.
    fn trace(&self, paths: Range<u64>) -> (Splats<'_>, Tally) {
        let settings = self.settings;
        let walk = PhotonWalk {
            max_depth: settings.max_depth - 1,
            sharp_alpha: settings.sharp_alpha,
            wavelengths: settings.wavelengths,
            sampler: self.scene.sampler,
            ..PhotonWalk::default()
        };
        let lens = PhotonWalk { stream: LENS_STREAM, ..walk };
        let tracer = Tracer::new(self.scene);
        let mut splats = Splats::new(self.film);
        let mut layers = self.expressions.recorder();
        let (eye, mut events) = (layers.position(), Vec::new());
        let mut tally = Tally { n_paths: paths.end - paths.start, ..Tally::default() };
        for index in paths {
            events.clear();
            let mut connector = Connector {
                tracer: &tracer,
                splats: &mut splats,
                layers: &mut layers,
                eye: &eye,
                sharp_alpha: settings.sharp_alpha,
                numbers: lens.numbers(index),
                events: &mut events,
                last: None,
                switches: Switches::default(),
                met_mirrors: &mut tally.met_mirrors,
            };
            walk.trace(&tracer, self.emitter, index, &mut |vertex| connector.visit(vertex));
        }
        tally.n_connections = splats.len() as u64;
        self.control.tile_done(0, tracer.counts());
        (splats, tally)
    }
}
