//! Cost of sampling and evaluating every configuration of the catalogue: `cargo bench -p etendue-scene`. A rate of
//! 20 Mitem/s is 50 ns for each; the column "fastest" is the one to read on a machine that does other things too.
//!
//! Directions are spread over the hemisphere by their cosine. Calls are those of a path, in a frame: `eval` is f, cosine
//! and density together.
//! Without `--bench`, as under `cargo test`, each runs once.

use std::fmt;

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use etendue_math::{Normal3, Point2, Rng, Vector3, warp};
use etendue_scene::bsdf::catalogue::{Configuration, catalogue};
use etendue_scene::bsdf::{Bsdf, Lobes, TransportMode};

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

fn bsdf(row: &Row) -> Bsdf {
    let n = Normal3::new(0.0, 0.0, 1.0);
    Bsdf::new(n, n, Vector3::new(1.0, 0.0, 0.0), row.0.kind)
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
    let (bsdf, inputs) = (bsdf(row), inputs(1));
    bencher.counter(ItemsCount::new(N)).bench(|| {
        let one = |(wo, [u, x, y]): &(Vector3, [f32; 3])| {
            let point = Point2::new(*x, *y);
            bsdf.sample(*wo, *u, point, TransportMode::Radiance, Lobes::ALL)
                .map_or(0.0, |s| s.weight[0] + s.wi.z)
        };
        black_box(&inputs).iter().map(one).sum::<f32>()
    });
}

#[divan::bench(args = rows(), sample_count = 40)]
fn eval(bencher: Bencher, row: &Row) {
    let (bsdf, inputs) = (bsdf(row), inputs(2));
    bencher.counter(ItemsCount::new(N)).bench(|| {
        let inputs = black_box(&inputs);
        let one = |(wo, wi): (Vector3, Vector3)| {
            let (f_cos, pdf_w) = bsdf.eval_cos_and_pdf(wo, wi);
            f_cos[0] + pdf_w
        };
        inputs.iter().zip(inputs.iter().cycle().skip(1)).map(|(a, b)| one((a.0, b.0))).sum::<f32>()
    });
}
