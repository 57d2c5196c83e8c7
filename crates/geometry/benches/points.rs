//! Look-ups of photons: `cargo bench -p etendue-geometry --bench points`. One thread asks; the column "fastest" is the
//! one to read on a machine that does other things too.
//!
//! A million points lie on the walls of a room and on a ball, half of those on the walls crowded towards a corner, as
//! the light of a lamp would have it. Questions come from all over the same surfaces, in random order. Without
//! `--bench`, as under `cargo test`, everything runs once with few points.

use std::sync::OnceLock;

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use etendue_geometry::points::{Neighbours, PointTree};
use etendue_math::{Point3, Rng, warp};

fn main() {
    divan::main();
}

fn n_points() -> u32 {
    if std::env::args().any(|argument| argument == "--bench") { 1_000_000 } else { 1000 }
}

/// A point of the surfaces; with `power` 3 crowded towards the corner at the origin, with 1 uniform.
fn photon(rng: &mut Rng, power: i32) -> Point3 {
    if rng.next_f32() < 0.3 {
        let w = warp::sample_uniform_sphere(rng.next_point2());
        return Point3::new(0.5, 0.3, 0.5) + w * 0.3;
    }
    let [a, b] = [rng.next_f32().powi(power), rng.next_f32().powi(power)];
    match rng.next_below(3) {
        0 => Point3::new(a, 0.0, b),
        1 => Point3::new(0.0, a, b),
        _ => Point3::new(a, b, 0.0),
    }
}

fn photons() -> Vec<Point3> {
    let mut rng = Rng::new(1, 0);
    (0..n_points()).map(|i| photon(&mut rng, if i % 2 == 0 { 1 } else { 3 })).collect()
}

/// Building with all threads, per point.
#[divan::bench(sample_count = 5, sample_size = 1)]
fn build(bencher: Bencher) {
    let points = photons();
    bencher.counter(ItemsCount::new(points.len())).bench(|| PointTree::new(black_box(&points)));
}

/// The nearest 8, 50 or 200 points.
#[divan::bench(args = [8, 50, 200], sample_count = 10, sample_size = 1)]
fn nearest(bencher: Bencher, k: usize) {
    static TREE: OnceLock<PointTree> = OnceLock::new();
    let tree = TREE.get_or_init(|| PointTree::new(&photons()));
    let mut rng = Rng::new(2, 0);
    let questions: Vec<Point3> = (0..n_points() / 20).map(|_| photon(&mut rng, 1)).collect();
    bencher.counter(ItemsCount::new(questions.len())).bench_local(|| {
        let mut found = Neighbours::new();
        for p in &questions {
            tree.nearest(black_box(*p), k, f32::INFINITY, &mut found);
        }
        found.limit_squared()
    });
}
