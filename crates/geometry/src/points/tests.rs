//! Tests of the structures of points against a search through all of them.

use std::collections::HashMap;

use etendue_math::{Point3, Rng};

use super::item::{bounds, finite_items};
use super::{GrowingTree, HeapTree, Neighbours, NotInOrder, PackedPoints, PointIndex, PointTree, Structure};
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

fn search(index: &PointIndex, p: Point3, k: usize, max_radius: f32) -> Vec<(u32, u32)> {
    let mut found = Neighbours::new();
    index.nearest(p, k, max_radius, &mut found);
    let mut all: Vec<(u32, u32)> = found.iter().map(|n| (n.distance_squared.to_bits(), n.index)).collect();
    all.sort_unstable();
    all
}

fn search_within(index: &PointIndex, p: Point3, radius: f32) -> Vec<(u32, u32)> {
    let mut all = Vec::new();
    index.within(p, radius, |n| all.push((n.distance_squared.to_bits(), n.index)));
    all.sort_unstable();
    all
}

fn structures(points: &[Point3]) -> Vec<PointIndex> {
    Structure::ALL.map(|structure| PointIndex::new(structure, points, 0.07)).into()
}

/// All structures answer as the search through all points does.
#[track_caller]
fn check_at(indices: &[PointIndex], points: &[Point3], p: Point3, k: usize, max_radius: f32) {
    let (nearest, within) =
        (search_all(points, p, k, max_radius), search_all(points, p, usize::MAX, max_radius));
    for (index, structure) in indices.iter().zip(Structure::ALL) {
        let case =
            || format!("{} of {} points, {k} within {max_radius} of {p:?}", structure.name(), points.len());
        assert_eq!(search(index, p, k, max_radius), nearest, "{}", case());
        assert_eq!(search_within(index, p, max_radius), within, "{}", case());
    }
}

#[track_caller]
fn check(points: &[Point3], rng: &mut Rng, n_questions: usize) {
    let indices = structures(points);
    for _ in 0..n_questions {
        let p = point_in_cube(rng, 1.2);
        let k = rng.next_below(70) as usize;
        for max_radius in [f32::INFINITY, 0.3, 0.0] {
            check_at(&indices, points, p, k, max_radius);
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
    let indices = structures(&points);
    for p in points[..512].iter().step_by(7) {
        check_at(&indices, &points, *p, 30, 2.0);
    }
}

/// All points in one place, asked for there and elsewhere: those of lowest index are the nearest.
#[test]
fn one_place() {
    let points = vec![Point3::splat(0.25); 500];
    let indices = structures(&points);
    for p in [0.25, 0.3, -1e20].map(Point3::splat) {
        for (k, max_radius) in [(0, 1.0), (1, 1.0), (50, 1.0), (500, 2.0), (501, f32::INFINITY), (5, 0.0)] {
            check_at(&indices, &points, p, k, max_radius);
        }
    }
}

/// Questions that lie on the planes that cut the tree, and between points at the ends of the range of numbers.
#[test]
fn on_planes_and_far_away() {
    let mut rng = Rng::new(6, 0);
    let mut points: Vec<Point3> = (0..600).map(|_| point_in_cube(&mut rng, 1.0)).collect();
    points.extend([3e19, -3e19, 1e-30, f32::MAX, f32::MIN].map(Point3::splat));
    let indices = structures(&points);
    for p in points.iter().step_by(3) {
        let q = point_in_cube(&mut rng, 1.0);
        for p in [Point3::new(p.x, q.y, q.z), Point3::new(q.x, p.y, q.z), Point3::new(q.x, q.y, p.z), *p] {
            for (k, max_radius) in [(17, 0.2), (1, f32::INFINITY), (700, f32::INFINITY)] {
                check_at(&indices, &points, p, k, max_radius);
            }
        }
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
    for radius in [f32::NAN, -1.0] {
        let none = search_tree(&tree, Point3::splat(0.0), 5, radius);
        assert!(none.is_empty(), "{none:?}");
    }
    for index in structures(&points) {
        for radius in [f32::NAN, -1.0] {
            assert!(search(&index, Point3::splat(0.0), 5, radius).is_empty());
            assert!(search_within(&index, Point3::splat(0.0), radius).is_empty());
        }
        assert_eq!(search_within(&index, Point3::splat(0.0), f32::INFINITY).len(), 100);
        assert!(search(&index, Point3::splat(f32::NAN), 5, f32::INFINITY).is_empty());
    }
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
        (tree.points.cuts().collect::<Vec<_>>(), tree.indices)
    };
    assert!(build(1) == build(3));
}

/// The rank of the root is that of the rule of the notebook, counted from 1.
#[test]
fn left_balanced_medians() {
    let ranks: Vec<usize> = (1..=10).map(|n| super::heap_tree::n_left(n) + 1).collect();
    assert_eq!(ranks, [1, 2, 2, 3, 4, 4, 4, 5, 6, 7]);
}

/// A tree in heap order has no holes, and below each node smaller points on the left, greater ones on the right.
#[test]
fn heap_order() {
    let mut rng = Rng::new(7, 0);
    for n in 1..=1000 {
        let points: Vec<Point3> = (0..n).map(|_| point_in_cube(&mut rng, 1.0)).collect();
        let tree = HeapTree::new(&points);
        let mut indices: Vec<u32> = tree.nodes.iter().map(|node| node.index).collect();
        indices.sort_unstable();
        assert!(indices.into_iter().eq(0..n), "{n} points");
        for node in 2..=n as usize {
            let (mut child, mut parent) = (node, node / 2);
            while parent > 0 {
                let axis = usize::from(tree.axes[parent - 1]);
                let (p, at) = (tree.nodes[node - 1].p[axis], tree.nodes[parent - 1].p[axis]);
                assert!(
                    if child % 2 == 0 { p <= at } else { p >= at },
                    "{n} points, node {node} below {parent}"
                );
                (child, parent) = (parent, parent / 2);
            }
        }
    }
}

/// Points that come in order make a deep tree of one that is not balanced; equal ones do not.
#[test]
fn depth_of_a_growing_tree() {
    let sorted: Vec<Point3> = (0..1000).map(|i| Point3::splat(i as f32)).collect();
    assert_eq!(GrowingTree::new(&sorted).depth(), 1000);
    assert!(GrowingTree::new(&[Point3::splat(1.0); 1000]).depth() < 40);
    assert_eq!(GrowingTree::new(&[]).depth(), 0);
}

/// Points in the order of a tree make the same tree, and are checked: wrong axes, points on the wrong side or not finite.
#[test]
fn packed_points_are_read_again() {
    let mut rng = Rng::new(8, 0);
    for n in [0, 1, 16, 17, 100, 1000, 1025] {
        let points: Vec<Point3> = (0..n).map(|_| point_in_cube(&mut rng, 1.0)).collect();
        let (packed, order) = PackedPoints::new(&points);
        let ordered: Vec<Point3> = order.iter().map(|i| points[*i as usize]).collect();
        assert_eq!(ordered, (0..n).map(|place| packed.point(place)).collect::<Vec<_>>());
        let cuts: HashMap<u32, u8> = packed.cuts().collect();
        let axis = |place: u32| cuts[&place];
        let again = PackedPoints::from_ordered(&ordered, axis).expect("they are in order");
        let mut found = [Neighbours::new(), Neighbours::new()];
        for _ in 0..20 {
            let p = point_in_cube(&mut rng, 1.2);
            packed.nearest(p, 20, 0.5, &mut found[0]);
            again.nearest(p, 20, 0.5, &mut found[1]);
            assert!(found[0].iter().eq(found[1].iter()));
        }
        if n < 100 {
            continue;
        }
        let mut reversed = ordered.clone();
        reversed.reverse();
        assert_eq!(PackedPoints::from_ordered(&reversed, axis).unwrap_err(), NotInOrder);
        assert!(PackedPoints::from_ordered(&ordered, |_| 3).is_err());
        reversed = ordered.clone();
        reversed[5].y = f32::NAN;
        assert!(PackedPoints::from_ordered(&reversed, axis).is_err());
    }
}

/// The nearest point of those that are accepted is the first accepted one of all in order of distance, then of place.
#[test]
fn nearest_of_some() {
    let mut rng = Rng::new(9, 0);
    for n in [0_u32, 1, 16, 40, 3000] {
        let mut points: Vec<Point3> = (0..n).map(|_| point_in_cube(&mut rng, 1.0)).collect();
        points.extend(points.clone());
        let (packed, order) = PackedPoints::new(&points);
        let ordered: Vec<Point3> = order.iter().map(|i| points[*i as usize]).collect();
        let near = points.iter().step_by(200).copied();
        let places: Vec<Point3> = near.chain((0..100).map(|_| point_in_cube(&mut rng, 1.2))).collect();
        for p in places {
            for (max_radius, modulus) in [(f32::INFINITY, 1), (0.3, 3), (f32::INFINITY, 97), (0.0, 1)] {
                let all = search_all(&ordered, p, usize::MAX, max_radius);
                let expected = all.into_iter().find(|(_, place)| place % modulus == 0);
                let found = packed.nearest_of(p, max_radius, |near| near.index % modulus == 0);
                let found = found.map(|near| (near.distance_squared.to_bits(), near.index));
                assert_eq!(found, expected, "{n} points, within {max_radius} of {p:?}");
            }
        }
        for nothing in [f32::NAN, -1.0] {
            assert_eq!(packed.nearest_of(Point3::splat(0.0), nothing, |_| true), None);
        }
        assert_eq!(packed.nearest_of(Point3::splat(f32::NAN), 1.0, |_| true), None);
        assert_eq!(packed.nearest_of(Point3::splat(0.0), f32::INFINITY, |_| false), None);
    }
}

/// Bounds of no points are empty.
#[test]
fn bounds_of_points() {
    let items =
        finite_items(&[Point3::new(1.0, 5.0, 3.0), Point3::new(4.0, 2.0, f32::NAN), Point3::splat(2.0)]);
    assert_eq!(bounds(&items), ([1.0, 2.0, 2.0], [2.0, 5.0, 3.0]));
    assert!(bounds(&[]).0[0] > bounds(&[]).1[0]);
}
