//! Nearest points by Étendue, kiddo and nanoflann side by side: the same points, the same questions, in turns in one process
//! and one thread.
//!
//! Points are photons of a room: five walls, half of whose photons crowd towards a corner, and four balls. Questions come from
//! all over the same surfaces, in random order. Times are processor seconds of the thread. In each round the contestants
//! take turns over short runs of questions, so that what slows one slows the others; figures are the best over rounds, ratios medians of
//! ratios within a round. Numbers of points found and sums of squared distances are compared.

#[path = "../../embree/src/clock.rs"]
#[allow(dead_code, reason = "the other bench takes the time of all threads, too")]
mod clock;
mod nanoflann;

use std::num::NonZero;

use clap::Parser;
use etendue_geometry::points::{HeapTree, Neighbours, PackedPoints, PointTree};
use etendue_math::{Point3, Rng, warp};

use nanoflann::Flann;

/// Times look-ups of nearest points, and the building of trees.
#[derive(Debug, Parser)]
struct Arguments {
    /// Points
    #[arg(long, default_value_t = 1_000_000)]
    points: usize,
    /// Questions of each kind
    #[arg(long, default_value_t = 60_000)]
    questions: usize,
    /// Rounds
    #[arg(long, default_value_t = 7)]
    rounds: usize,
    /// Points in a leaf of nanoflann: 10, 16 and 32 were tried
    #[arg(long, default_value_t = 16)]
    leaf: usize,
}

/// Questions in a row before it is another's turn.
const RUN: usize = 2000;

/// What is asked: how many neighbours, within which radius; all within it if `k` is 0.
const KINDS: [(usize, f32, &str); 4] = [
    (50, f32::INFINITY, "nearest 50"),
    (200, f32::INFINITY, "nearest 200"),
    (50, 0.02, "nearest 50 within 0.02 m"),
    (0, 0.02, "all within 0.02 m"),
];

/// Who takes part.
const NAMES: [&str; 5] = ["map", "PointTree", "HeapTree", "kiddo", "nanoflann"];

fn photon(rng: &mut Rng, is_crowded: bool) -> [f32; 3] {
    let kind = rng.next_f32();
    if kind < 0.6 {
        let [mut a, mut b] = [rng.next_f32(), rng.next_f32()];
        if is_crowded && rng.next_f32() < 0.5 {
            (a, b) = (a.powi(3), b.powi(3));
        }
        return match (kind * 5.0 / 0.6) as u32 {
            0 => [a * 10.0, 0.0, b * 10.0],
            1 => [a * 10.0, 5.0, b * 10.0],
            2 => [0.0, a * 5.0, b * 10.0],
            3 => [10.0, a * 5.0, b * 10.0],
            _ => [a * 10.0, b * 5.0, 0.0],
        };
    }
    let balls = [([2.0, 1.0, 3.0], 1.0), ([6.0, 1.5, 4.0], 1.5), ([4.0, 0.5, 7.0], 0.5), ([8.0, 2.5, 8.0], 0.8)];
    let (centre, radius) = balls[rng.next_below(4) as usize];
    let w = warp::sample_uniform_sphere(rng.next_point2());
    [centre[0] + radius * w.x, centre[1] + radius * w.y, centre[2] + radius * w.z]
}

fn point([x, y, z]: [f32; 3]) -> Point3 {
    Point3::new(x, y, z)
}

type Kiddo = kiddo::ImmutableKdTree<f32, 3>;

struct Contestants<'a> {
    map: PackedPoints,
    tree: PointTree,
    heap: HeapTree,
    kiddo: Kiddo,
    flann: Flann<'a>,
    found: Neighbours,
}

fn sum_of(found: &Neighbours) -> (usize, f64) {
    (found.iter().len(), found.iter().map(|n| f64::from(n.distance_squared)).sum())
}

impl Contestants<'_> {
    /// Points found and the sum of squared distances.
    fn ask(&mut self, contestant: usize, p: [f32; 3], k: usize, radius: f32) -> (usize, f64) {
        let (mut n, mut sum) = (0, 0.0);
        let mut add = |d: f32| {
            n += 1;
            sum += f64::from(d);
        };
        match (contestant, k) {
            (0, 0) => self.map.within(point(p), radius, |n| add(n.distance_squared)),
            (1, 0) => self.tree.within(point(p), radius, |n| add(n.distance_squared)),
            (2, 0) => self.heap.within(point(p), radius, |n| add(n.distance_squared)),
            (0, _) => {
                self.map.nearest(point(p), k, radius, &mut self.found);
                return sum_of(&self.found);
            }
            (1, _) => {
                self.tree.nearest(point(p), k, radius, &mut self.found);
                return sum_of(&self.found);
            }
            (2, _) => {
                self.heap.nearest(point(p), k, radius, &mut self.found);
                return sum_of(&self.found);
            }
            (3, 0) => {
                let found = self.kiddo.query(&p).within::<kiddo::SquaredEuclidean<f32>>(radius * radius).execute();
                found.iter().for_each(|n| add(n.distance));
            }
            (3, _) => {
                let k = NonZero::new(k).expect("k is not 0");
                let query = self.kiddo.query(&p).nearest_n::<kiddo::SquaredEuclidean<f32>>(k);
                let found =
                    if radius.is_finite() { query.within(radius * radius).execute() } else { query.execute() };
                found.iter().for_each(|n| add(n.distance));
            }
            (_, 0) => return self.flann.within(p, radius * radius),
            _ => return self.flann.nearest(p, k, radius * radius),
        }
        (n, sum)
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() {
    let arguments = Arguments::parse();
    let mut rng = Rng::new(7, 0);
    let points: Vec<[f32; 3]> = (0..arguments.points).map(|_| photon(&mut rng, true)).collect();
    let questions: Vec<[f32; 3]> = (0..arguments.questions).map(|_| photon(&mut rng, false)).collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread starts");
    pool.install(|| run(&arguments, &points, &questions));
}

fn run(arguments: &Arguments, points: &[[f32; 3]], questions: &[[f32; 3]]) {
    let mut contestants = build(arguments, points);
    for (k, radius, name) in KINDS {
        let mut times = [const { Vec::new() }; NAMES.len()];
        let mut results = [(0_usize, 0.0_f64); NAMES.len()];
        for _ in 0..arguments.rounds {
            let mut spent = [0.0; NAMES.len()];
            results = [(0, 0.0); NAMES.len()];
            for (turn, run) in questions.chunks(RUN).enumerate() {
                for i in 0..NAMES.len() {
                    let contestant = (i + turn) % NAMES.len();
                    let start = clock::thread_seconds();
                    let (mut n, mut sum) = (0, 0.0);
                    for p in run {
                        let (m, s) = contestants.ask(contestant, *p, k, radius);
                        n += m;
                        sum += s;
                    }
                    spent[contestant] += clock::thread_seconds() - start;
                    results[contestant].0 += n;
                    results[contestant].1 += sum;
                }
            }
            for (times, spent) in times.iter_mut().zip(spent) {
                times.push(spent);
            }
        }
        println!("\n{name}: {:.2} found", results[0].0 as f64 / questions.len() as f64);
        report(&times, questions.len());
        for (name, (n, sum)) in NAMES.iter().zip(results) {
            let (n0, sum0) = results[0];
            if n != n0 || (sum - sum0).abs() > 1e-9 * sum0 {
                println!("  {name} found {n} (sum {sum}), where map found {n0} (sum {sum0})");
            }
        }
    }
}

fn report(times: &[Vec<f64>], n: usize) {
    let ratio = |a: usize, b: usize| median(times[a].iter().zip(&times[b]).map(|(a, b)| a / b).collect());
    for (i, name) in NAMES.iter().enumerate() {
        let best = times[i].iter().copied().fold(f64::INFINITY, f64::min);
        println!(
            "  {name:<10} {:>10.0} a second; {:.2} of kiddo, {:.2} of nanoflann",
            n as f64 / best,
            ratio(3, i),
            ratio(4, i)
        );
    }
}

/// Builds all trees a few times and tells the times.
fn build<'a>(arguments: &Arguments, points: &'a [[f32; 3]]) -> Contestants<'a> {
    let as_points: Vec<Point3> = points.iter().map(|p| point(*p)).collect();
    let mut times = [const { Vec::new() }; NAMES.len()];
    loop {
        let mut clock = clock::thread_seconds();
        let mut next = 0;
        let mut lap = |times: &mut [Vec<f64>; NAMES.len()]| {
            let now = clock::thread_seconds();
            times[next].push(now - clock);
            (clock, next) = (now, next + 1);
        };
        let (map, order) = PackedPoints::new(&as_points);
        lap(&mut times);
        let tree = PointTree::new(&as_points);
        lap(&mut times);
        let heap = HeapTree::new(&as_points);
        lap(&mut times);
        let kiddo = Kiddo::new_from_slice(points).expect("points make a tree");
        lap(&mut times);
        let flann = Flann::new(points, arguments.leaf);
        lap(&mut times);
        drop(order);
        if times[0].len() < arguments.rounds {
            continue;
        }
        println!("built {} points", points.len());
        let n = points.len() as f64;
        let bytes = [map.memory_bytes(), tree.memory_bytes(), heap.memory_bytes(), 0, flann.memory_bytes()];
        for (i, name) in NAMES.iter().enumerate() {
            let best = times[i].iter().copied().fold(f64::INFINITY, f64::min);
            let ratio = median(times[i].iter().zip(&times[3]).map(|(a, b)| a / b).collect());
            println!("  {name:<10} {best:.3} s, {ratio:.2} of kiddo's, {:.1} bytes a point", bytes[i] as f64 / n);
        }
        return Contestants { map, tree, heap, kiddo, flann, found: Neighbours::new() };
    }
}
