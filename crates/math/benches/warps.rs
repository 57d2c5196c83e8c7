//! Cost of warps and of elementary functions: `cargo bench -p etendue-math --bench warps`. A rate of 100 Mitem/s is 10 ns
//! for each; arguments come from a table in the first-level cache.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use etendue_math::warp::{self, SphericalRectangle};
use etendue_math::{Point2, Point3, Rng, Vector3, approx};

fn main() {
    divan::main();
}

const N: usize = 512;

fn bench(bencher: Bencher, f: impl Fn(Point2) -> f32 + Sync) {
    let mut rng = Rng::new(1, 1);
    let points: Vec<Point2> = (0..N).map(|_| rng.next_point2()).collect();
    bencher.counter(ItemsCount::new(N)).bench(|| black_box(&points).iter().map(|p| f(*p)).sum::<f32>());
}

#[divan::bench]
fn concentric_disk(bencher: Bencher) {
    bench(bencher, |u| {
        let p = warp::sample_concentric_disk(u);
        p.x + p.y
    });
}

#[divan::bench]
fn cosine_hemisphere(bencher: Bencher) {
    bench(bencher, |u| warp::sample_cosine_hemisphere(u).max_element());
}

#[divan::bench]
fn uniform_sphere(bencher: Bencher) {
    bench(bencher, |u| warp::sample_uniform_sphere(u).max_element());
}

/// Points to be lit below a lamp a quarter of a metre wide.
fn below(u: Point2) -> Point3 {
    Point3::new(u.x - 0.5, 0.6 * u.y, 0.3 - u.x)
}

const CORNERS: [Point3; 3] =
    [Point3::new(-0.12, 1.0, -0.1), Point3::new(0.12, 1.0, -0.1), Point3::new(0.12, 1.0, 0.11)];

#[divan::bench]
fn spherical_triangle_pdf(bencher: Bencher) {
    bench(bencher, |u| 1.0 / warp::spherical_triangle_solid_angle(*black_box(&CORNERS), below(u)));
}

#[divan::bench]
fn spherical_triangle_sample(bencher: Bencher) {
    bench(bencher, |u| {
        warp::sample_spherical_triangle(*black_box(&CORNERS), below(u), u)
            .map_or(0.0, |(b, pdf_w)| b[0] * pdf_w)
    });
}

const EDGES: [Vector3; 2] = [Vector3::new(0.24, 0.0, 0.0), Vector3::new(0.0, 0.0, 0.21)];

#[divan::bench]
fn spherical_rectangle_pdf(bencher: Bencher) {
    bench(bencher, |u| {
        let [x, y] = *black_box(&EDGES);
        SphericalRectangle::new(below(u), CORNERS[0], x, y).map_or(0.0, |r| r.pdf_w())
    });
}

#[divan::bench]
fn spherical_rectangle_sample(bencher: Bencher) {
    bench(bencher, |u| {
        let [x, y] = *black_box(&EDGES);
        warp::sample_spherical_rectangle(below(u), CORNERS[0], x, y, u).map_or(0.0, |(q, pdf_w)| q.x * pdf_w)
    });
}

/// One function four ways: of the system's library and ours, one by one and in lanes of four.
macro_rules! functions {
    ($($name:ident $ours:path, $theirs:expr;)+) => { $(
        mod $name {
            use super::*;

            #[divan::bench]
            fn library(bencher: Bencher) {
                let theirs: fn(f32) -> f32 = $theirs;
                bench(bencher, |u| theirs(u.x));
            }

            #[divan::bench]
            fn approximate(bencher: Bencher) {
                bench(bencher, |u| $ours(u.x));
            }

            #[divan::bench]
            fn approximate_lanes(bencher: Bencher) {
                let mut rng = Rng::new(1, 1);
                let lanes: Vec<[f32; 4]> = (0..N / 4).map(|_| [0; 4].map(|_| rng.next_f32())).collect();
                bencher.counter(ItemsCount::new(N)).bench(|| {
                    let mut sums = [0.0; 4];
                    for lane in black_box(&lanes) {
                        for i in 0..4 {
                            sums[i] += $ours(lane[i]);
                        }
                    }
                    sums
                });
            }
        }
    )+ };
}

fn sin_turns(u: f32) -> f32 {
    let (sin, cos) = approx::sin_cos_turns(u);
    sin + cos
}

fn atan2(u: f32) -> f32 {
    approx::atan2(u, 0.5)
}

functions! {
    sin_cos sin_turns, |u| { let (sin, cos) = (std::f32::consts::TAU * u).sin_cos(); sin + cos };
    arc_tangent atan2, |u| u.atan2(0.5);
    arc_cosine approx::acos, f32::acos;
    exponential approx::exp, f32::exp;
    logarithm approx::ln, f32::ln;
    logarithm_1p approx::ln_1p, f32::ln_1p;
}
