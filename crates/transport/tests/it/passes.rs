//! The pass loop: what an observer sees and can stop, and what the film then holds.

use std::sync::atomic::{AtomicU64, Ordering};

use etendue_scene::{Film, Scene};
use etendue_transport::lpe::PathExpressions;
use etendue_transport::{Flow, Integrator, Observer, Outcome, RayCounts, Stop, method, render};

use crate::support::{Setup, lit, render_passes};

/// Stops in a pass or after so many tiles, and counts.
#[derive(Debug)]
struct Watch {
    last_pass: u64,
    most_tiles: u64,
    tiles: AtomicU64,
    samples: AtomicU64,
    passes: AtomicU64,
}

impl Watch {
    fn new(last_pass: u64, most_tiles: u64) -> Self {
        let zero = || AtomicU64::new(0);
        Self { last_pass, most_tiles, tiles: zero(), samples: zero(), passes: zero() }
    }
}

impl Observer for Watch {
    fn tile_done(&self, n_samples: u64, rays: RayCounts) -> Flow {
        assert!(rays.closest >= n_samples, "each path has a ray from the camera");
        self.samples.fetch_add(n_samples, Ordering::Relaxed);
        let tiles = self.tiles.fetch_add(1, Ordering::Relaxed) + 1;
        if tiles >= self.most_tiles { Flow::Stop } else { Flow::Continue }
    }

    fn pass_done(&self, pass: u64, film: &Film, _: &dyn Integrator) -> Flow {
        assert!(film.holds_pass(pass));
        self.passes.fetch_add(1, Ordering::Relaxed);
        if pass >= self.last_pass { Flow::Stop } else { Flow::Continue }
    }
}

/// Six tiles.
fn scene() -> Scene {
    let world = format!("Shape \"sphere\" LightSource \"point\" {} \"point3 from\" [2 2 -3]", lit("I", 5.0));
    let camera = "LookAt 0 0 -3  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 50";
    Setup { size: [96, 50], camera, world: &world, ..Setup::default() }.scene("passes")
}

fn run(scene: &Scene, film: &mut Film, watch: &Watch) -> Outcome {
    let (integrator, _) = method(&scene.integrator, PathExpressions::default());
    let stop = Stop { passes: 0..20, error: None };
    render(scene, integrator.expect("the path tracer").as_mut(), film, &stop, watch)
}

/// Each pass brings one sample to each pixel, in tiles, until the observer has enough.
#[test]
fn observers_see_all_and_may_stop() {
    let scene = scene();
    let mut film = Film::new(scene.film.clone(), Vec::new());
    let watch = Watch::new(6, u64::MAX);
    assert_eq!(run(&scene, &mut film, &watch), Outcome::Stopped);
    assert_eq!(watch.passes.into_inner(), 7);
    assert_eq!(watch.tiles.into_inner(), 7 * 6);
    assert_eq!(watch.samples.into_inner(), 7 * 96 * 50);
    assert_eq!(film.sums(), render_passes(&scene, 0..7).sums());
    let rest = Watch::new(u64::MAX, u64::MAX);
    assert_eq!(run(&scene, &mut film, &rest), Outcome::Finished);
    assert_eq!(rest.passes.into_inner(), 13, "passes that are there are not rendered again");
    assert_eq!(film.sums(), render_passes(&scene, 0..20).sums());
}

/// A pass that is stopped leaves nothing: the film holds the passes before it, to the bit.
#[test]
fn stopped_passes_leave_nothing() {
    let scene = scene();
    let mut film = Film::new(scene.film.clone(), Vec::new());
    let watch = Watch::new(u64::MAX, 3 * 6 + 2);
    assert_eq!(run(&scene, &mut film, &watch), Outcome::Stopped);
    // Tiles that were under way may still finish the pass.
    let n = film.n_passes();
    assert!(n == 3 || n == 4, "{n} passes");
    assert_eq!(film.sums(), render_passes(&scene, 0..n).sums());
}

/// Stopped in its first pass, a render keeps the tiles that it has: better a part of a picture than none. It counts as no
/// pass.
#[test]
fn the_first_pass_may_be_partial() {
    let scene = scene();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let film = pool.install(|| {
        let mut film = Film::new(scene.film.clone(), Vec::new());
        assert_eq!(run(&scene, &mut film, &Watch::new(u64::MAX, 2)), Outcome::Stopped);
        film
    });
    assert_eq!(film.n_passes(), 0);
    let (part, whole) = (film.develop(), render_passes(&scene, 0..1).develop());
    let (part, whole) = (&part.channels[1].values, &whole.channels[1].values);
    let n_done = part.iter().filter(|v| **v != 0.0).count();
    assert!(n_done > 0 && part.iter().zip(whole).all(|(p, w)| *p == 0.0 || p == w));
    assert!(n_done < whole.iter().filter(|v| **v != 0.0).count());
}
