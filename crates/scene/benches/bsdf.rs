//! Cost of sampling and evaluating every configuration of the catalogue: `cargo bench -p etendue-scene`. A rate of
//! 20 Mitem/s is 50 ns for each; the column "fastest" is the one to read on a machine that does other things too.
//!
//! Directions are spread over the hemisphere by their cosine; `eval` is f and its density, as a path asks for both.
//! Without `--bench`, as under `cargo test`, each runs once.

use std::fmt;

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use etendue_math::{Point2, Rng, Vector3, warp};
use etendue_scene::bsdf::catalogue::{Configuration, catalogue};
use etendue_scene::bsdf::{Lobes, TransportMode};

fn main() {
    divan::main();
}

/// A configuration that shows its model and name.
struct Row(Configuration);

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.0.model, self.0.name)
    }
}

fn rows() -> Vec<Row> {
    catalogue().into_iter().map(Row).collect()
}

const N: usize = 256;

/// Directions above the surface, and random numbers.
fn inputs(seed: u64) -> Vec<(Vector3, [f32; 3])> {
    let mut rng = Rng::new(seed, 0);
    let input = |_| {
        let w = warp::sample_cosine_hemisphere(rng.next_point2());
        (w, [rng.next_f32(), rng.next_f32(), rng.next_f32()])
    };
    (0..N).map(input).collect()
}

#[divan::bench(args = rows(), sample_count = 40)]
fn sample(bencher: Bencher, row: &Row) {
    let (kind, inputs) = (row.0.kind, inputs(1));
    bencher.counter(ItemsCount::new(N)).bench(|| {
        let one = |(wo, [u, x, y]): &(Vector3, [f32; 3])| {
            let point = Point2::new(*x, *y);
            kind.sample(*wo, *u, point, TransportMode::Radiance, Lobes::ALL)
                .map_or(0.0, |s| s.weight[0] + s.wi.z)
        };
        black_box(&inputs).iter().map(one).sum::<f32>()
    });
}

#[divan::bench(args = rows(), sample_count = 40)]
fn eval(bencher: Bencher, row: &Row) {
    let (kind, inputs) = (row.0.kind, inputs(2));
    bencher.counter(ItemsCount::new(N)).bench(|| {
        let inputs = black_box(&inputs);
        let one = |(wo, wi): (Vector3, Vector3)| {
            kind.eval(wo, wi, TransportMode::Radiance, Lobes::ALL)[0] + kind.pdf(wo, wi, Lobes::ALL)
        };
        inputs.iter().zip(inputs.iter().cycle().skip(1)).map(|(a, b)| one((a.0, b.0))).sum::<f32>()
    });
}
