//! Tests of the tree of points against a search through all of them.

use etendue_math::{Point3, Rng};

use super::{Neighbours, PointTree};
use crate::test_support::point_in_cube;

/// Bits of squared distance and index of the `k` nearest points, near ones first.
fn search_all(points: &[Point3], p: Point3, k: usize, max_radius: f32) -> Vec<(u32, u32)> {
    let squares = points.iter().map(|q| (*q - p).length_squared());
    let mut all: Vec<(u32, u32)> = (0..)
        .zip(squares)
        .filter(|(_, d)| *d <= max_radius * max_radius)
        .map(|(i, d)| (d.to_bits(), i))
        .collect();
    all.sort_unstable();
    all.truncate(k);
    all
}

fn search_tree(tree: &PointTree, p: Point3, k: usize, max_radius: f32) -> Vec<(u32, u32)> {
    let mut found = Neighbours::new();
    tree.nearest(p, k, max_radius, &mut found);
    let mut all: Vec<(u32, u32)> = found.iter().map(|n| (n.distance_squared.to_bits(), n.index)).collect();
    all.sort_unstable();
    all
}

#[track_caller]
fn check(points: &[Point3], rng: &mut Rng, n_questions: usize) {
    let tree = PointTree::new(points);
    for _ in 0..n_questions {
        let p = point_in_cube(rng, 1.2);
        let k = rng.next_below(70) as usize;
        for max_radius in [f32::INFINITY, 0.3, 0.0] {
            let found = search_tree(&tree, p, k, max_radius);
            assert_eq!(found, search_all(points, p, k, max_radius), "{} points, k = {k}", points.len());
        }
    }
}

/// The nearest points are found whatever their number; k may exceed it.
#[test]
fn any_number_of_points() {
    let mut rng = Rng::new(1, 0);
    for n in (0..70).chain([127, 128, 129, 1000, 1025]) {
        let points: Vec<Point3> = (0..n).map(|_| point_in_cube(&mut rng, 1.0)).collect();
        check(&points, &mut rng, 6);
    }
}

/// Points that cluster, as photons of a caustic do, and points in a plane.
#[test]
fn uneven_points() {
    let mut rng = Rng::new(2, 0);
    let mut points = Vec::new();
    for _ in 0..4000 {
        let (p, cluster) = (point_in_cube(&mut rng, 1.0), point_in_cube(&mut rng, 1e-3));
        points.extend([Point3::new(p.x, -1.0, p.z), Point3::new(0.5, 0.5, 0.5) + cluster.as_vector()]);
    }
    check(&points, &mut rng, 60);
}

/// Of equally near points those of lower index are found: points of a lattice, each of them four times.
#[test]
fn ties() {
    let mut rng = Rng::new(3, 0);
    let lattice = |i: u32| i as f32 / 4.0 - 1.0;
    let points: Vec<Point3> = (0..4 * 512)
        .map(|i| i % 512)
        .map(|i| Point3::new(lattice(i % 8), lattice(i / 8 % 8), lattice(i / 64)))
        .collect();
    check(&points, &mut rng, 60);
    let tree = PointTree::new(&points);
    for p in &points[..512] {
        assert_eq!(search_tree(&tree, *p, 30, 2.0), search_all(&points, *p, 30, 2.0));
    }
}

/// Points at infinity or nowhere are not found, and a question from nowhere has no answer.
#[test]
fn not_finite() {
    let mut rng = Rng::new(4, 0);
    let mut points: Vec<Point3> = (0..100).map(|_| point_in_cube(&mut rng, 1.0)).collect();
    points.extend([Point3::splat(f32::NAN), Point3::splat(f32::INFINITY), Point3::new(0.0, 0.0, f32::NAN)]);
    let tree = PointTree::new(&points);
    assert_eq!(search_tree(&tree, Point3::splat(0.0), 200, f32::INFINITY).len(), 100);
    for nowhere in [f32::NAN, f32::INFINITY] {
        let found = search_tree(&tree, Point3::splat(nowhere), 5, 1.0);
        assert!(found.is_empty(), "{found:?}");
    }
    let none = search_tree(&tree, Point3::splat(0.0), 5, f32::NAN);
    assert!(none.is_empty(), "{none:?}");
}

/// The limit is the distance of the farthest of k points, and the greatest radius where there are fewer.
#[test]
fn limits() {
    let points: Vec<Point3> = (0..20).map(|i| Point3::new(i as f32, 0.0, 0.0)).collect();
    let tree = PointTree::new(&points);
    let mut found = Neighbours::new();
    for (k, max_radius, expected) in [(4, 100.0, 9.0), (4, 2.5, 6.25), (50, 100.0, 10_000.0)] {
        tree.nearest(Point3::splat(0.0), k, max_radius, &mut found);
        assert_eq!(found.limit_squared(), expected);
    }
}

/// Any number of threads builds the same tree.
#[test]
fn threads() {
    let mut rng = Rng::new(5, 0);
    let points: Vec<Point3> = (0..40_000).map(|i| point_in_cube(&mut rng, 1.0 + (i % 2) as f32)).collect();
    let build = |n_threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().expect("threads start");
        let tree = pool.install(|| PointTree::new(&points));
        let splits: Vec<_> = tree.splits.iter().map(|s| (s.at.to_bits(), s.axis)).collect();
        let buckets: Vec<_> = tree.buckets.iter().map(|b| b.indices).collect();
        (splits, buckets)
    };
    assert!(build(1) == build(3));
}
