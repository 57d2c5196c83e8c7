use etendue_math::{Rng, Transform};
use rayon::prelude::*;

use super::partition::partition;
use super::{Box3, BuildPrimitive, NODE_COST, TriangleSource, build};
use crate::bvh::node::{EMPTY, INNER, TRIANGLES, leaf_range};
use crate::bvh::{Bvh, PrimitiveRef};
use crate::test_support::{ball, point_in_cube, single, soup};
use crate::{Shape, TriangleMesh};

/// Triangles without a mesh, none of them paired.
struct Loose(Vec<[[f32; 3]; 3]>);

impl TriangleSource for Loose {
    fn corners(&self, triangle: PrimitiveRef) -> [[f32; 3]; 3] {
        self.0[triangle.primitive as usize]
    }

    fn second(&self, _: PrimitiveRef) -> Option<u32> {
        None
    }
}

impl Loose {
    fn of_mesh(mesh: &TriangleMesh) -> Self {
        let corner = |v: &u32| {
            let p = mesh.positions[*v as usize];
            [p.x, p.y, p.z]
        };
        Self(mesh.indices.iter().map(|[a, b, c]| [corner(a), corner(b), corner(c)]).collect())
    }

    fn build(&self) -> Bvh {
        let primitive = |(i, corners): (usize, &[[f32; 3]; 3])| {
            BuildPrimitive::triangle(PrimitiveRef { geometry: 0, primitive: i as u32 }, corners)
        };
        build(self.0.iter().enumerate().map(primitive).collect(), self)
    }
}

fn contains(outer: &Box3, inner: &Box3) -> bool {
    (0..3).all(|axis| outer.min[axis] <= inner.min[axis] && outer.max[axis] >= inner.max[axis])
}

fn root_box(bvh: &Bvh) -> Box3 {
    let [min, max] = [bvh.bounds().min, bvh.bounds().max].map(|p| [p.x, p.y, p.z]);
    Box3 { min, max }
}

fn half_area(b: &Box3) -> f64 {
    let [x, y, z] = std::array::from_fn(|axis| f64::from(b.max[axis]) - f64::from(b.min[axis]));
    x * y + y * z + z * x
}

/// Walks a tree of triangles: each triangle lies in one leaf and in all boxes above it. Returns the depth.
#[track_caller]
fn check_tree(bvh: &Bvh, n_triangles: usize, corners: impl Fn(u32) -> [[f32; 3]; 3]) -> usize {
    let root = root_box(bvh);
    let mut found = vec![0_u32; n_triangles];
    let mut stack = vec![(0_u32, root, 1)];
    let mut depth = 0;
    while let Some((code, bounds, level)) = stack.pop() {
        depth = depth.max(level);
        if code >> 30 == INNER {
            let node = &bvh.nodes[code as usize];
            for (slot, &child) in node.children.iter().enumerate().filter(|(_, child)| **child != EMPTY) {
                let own = node.child_bounds(slot);
                assert!(contains(&bounds, &own), "{own:?} is not in {bounds:?}");
                stack.push((child, own, level + 1));
            }
            continue;
        }
        assert_eq!(code >> 30, TRIANGLES);
        let pairs =
            bvh.blocks[leaf_range(code)].iter().flat_map(|block| (0..4).filter_map(|i| block.pair(i)));
        for triangle in pairs.flat_map(|pair| std::iter::once(pair.first.primitive).chain(pair.second)) {
            found[triangle as usize] += 1;
            for p in corners(triangle) {
                assert!(contains(&bounds, &Box3 { min: p, max: p }), "{p:?} is not in {bounds:?}");
            }
        }
    }
    assert!(found.iter().all(|n| *n == 1), "a triangle is missing or twice in the tree");
    depth
}

/// Expected work of a ray that crosses the box of a tree, in tests of blocks.
fn cost(bvh: &Bvh) -> f64 {
    let root = half_area(&root_box(bvh));
    let mut sum = f64::from(NODE_COST) * root;
    for node in &bvh.nodes {
        for (slot, &child) in node.children.iter().enumerate().filter(|(_, child)| **child != EMPTY) {
            let weight = if child >> 30 == INNER { NODE_COST.into() } else { leaf_range(child).len() as f64 };
            sum += weight * half_area(&node.child_bounds(slot));
        }
    }
    sum / root
}

/// Each triangle is in one leaf whose box holds it, for meshes with and without pairs.
#[test]
fn every_triangle_lies_in_one_leaf() {
    for n in [1, 2, 5, 9, 100, 20_000] {
        let source = Loose::of_mesh(&soup(n, 0.1, n as u64));
        check_tree(&source.build(), n, |triangle| source.0[triangle as usize]);
    }
    let mesh = ball(6);
    let source = Loose::of_mesh(&mesh);
    let n = mesh.indices.len();
    let (geometry, _) = single(Shape::Triangles(mesh), Transform::IDENTITY, false);
    check_tree(&geometry.groups[0], n, |triangle| source.0[triangle as usize]);
}

/// Trees that defeat the heuristic are shallow all the same, and quickly built: many equal triangles, equal
/// centroids, and sizes that grow geometrically.
#[test]
fn degenerate_distributions_build() {
    const N: usize = 100_000;
    let corner = |s: f32| [[0.0, 0.0, 0.0], [s, 0.0, 0.0], [0.0, s, 0.0]];
    let check = |n: usize, position: &dyn Fn(usize) -> [[f32; 3]; 3], limit: usize| {
        let source = Loose((0..n).map(position).collect());
        let bvh = source.build();
        let depth = check_tree(&bvh, n, |triangle| source.0[triangle as usize]);
        assert!(depth <= limit && bvh.nodes.len() < n, "{} nodes in {depth} levels", bvh.nodes.len());
    };
    // Seven levels would hold 8^6 blocks of four.
    check(N, &|_| corner(1.0), 9);
    check(N, &|i| corner(1.0 + i as f32).map(|p| p.map(|x| x - (1.0 + i as f32) / 2.0)), 20);
    check(1000, &|i| corner(1.15_f32.powi(i as i32 - 500)).map(|p| [p[0] + p[1], p[0], p[1]]), 57);
}

/// Determinism: the tree does not depend on the number of threads, large enough for every way of parallel work.
#[test]
fn the_tree_is_the_same_for_any_number_of_threads() {
    let source = Loose::of_mesh(&soup(100_000, 0.02, 9));
    let build_with = |n_threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().expect("threads start");
        pool.install(|| format!("{:?}", source.build()))
    };
    let one = build_with(1);
    assert!(one == build_with(2) && one == build_with(3));
}

/// Parallel reordering moves the same values to each side as the condition says.
#[test]
fn partition_separates_all_values() {
    for (n, bound) in [(10, 3), (200_000, 70_000), (300_001, 0), (300_001, 300_001), (300_001, 299_990)] {
        let mut rng = Rng::new(5, n.into());
        let mut values: Vec<u32> = (0..n).collect();
        values.sort_by_cached_key(|_| rng.next_u32());
        let middle = partition(&mut values, &|value| *value < bound);
        assert_eq!(middle, bound.min(n) as usize);
        assert!(values[..middle].iter().all(|v| *v < bound) && values[middle..].iter().all(|v| *v >= bound));
        values.par_sort_unstable();
        assert!(values.into_iter().eq(0..n));
    }
}

/// Neighbours become pairs wherever the mesh names them: cell by cell, or all lower triangles before all upper ones.
#[test]
fn most_triangles_of_a_mesh_are_paired() {
    const N: u32 = 60;
    let cell = |k: u32| (k % N) + (k / N) * (N + 1);
    let lower = (0..N * N).map(cell).map(|a| [a, a + N + 1, a + N + 2]);
    let upper = (0..N * N).map(cell).map(|a| [a, a + N + 2, a + 1]);
    let by_cell = lower.clone().zip(upper.clone()).flat_map(|(a, b)| [a, b]).collect();
    let mut rng = Rng::new(1, 0);
    let positions: Vec<_> = (0..(N + 1) * (N + 1))
        .map(|v| {
            point_in_cube(&mut rng, 0.2)
                + etendue_math::Vector3::new((v % (N + 1)) as f32, (v / (N + 1)) as f32, 0.0)
        })
        .collect();
    for indices in [by_cell, lower.chain(upper).collect::<Vec<_>>()] {
        let n = indices.len();
        let mesh = TriangleMesh { positions: positions.clone(), indices, ..TriangleMesh::default() };
        let (geometry, _) = single(Shape::Triangles(mesh), Transform::IDENTITY, false);
        let blocks = &geometry.groups[0].blocks;
        let n_pairs = blocks
            .iter()
            .flat_map(|block| (0..4).filter_map(|i| block.pair(i)))
            .filter(|pair| pair.second.is_some())
            .count();
        assert!(n_pairs * 2 > n * 9 / 10, "{n_pairs} pairs of {n} triangles");
    }
}

/// The box around boxes.
fn united(boxes: &[Box3]) -> Box3 {
    let mut all = boxes[0];
    for own in boxes {
        for axis in 0..3 {
            all.min[axis] = all.min[axis].min(own.min[axis]);
            all.max[axis] = all.max[axis].max(own.max[axis]);
        }
    }
    all
}

/// Sorts boxes along an axis by their centres.
fn sort(boxes: &mut [Box3], axis: usize) {
    boxes.sort_by(|a, b| (a.min[axis] + a.max[axis]).total_cmp(&(b.min[axis] + b.max[axis])));
}

/// Sorts boxes so that the cheapest of all splits between sorted centres is where it says.
fn sweep(boxes: &mut [Box3]) -> usize {
    let mut best = (f64::INFINITY, 0, 0);
    for axis in 0..3 {
        sort(boxes, axis);
        let blocks = |n: usize| n.div_ceil(4) as f64;
        let mut right = vec![0.0; boxes.len()];
        let mut all = boxes[boxes.len() - 1];
        for i in (1..boxes.len()).rev() {
            all = united(&[all, boxes[i]]);
            right[i] = half_area(&all) * blocks(boxes.len() - i);
        }
        all = boxes[0];
        for i in 1..boxes.len() {
            all = united(&[all, boxes[i - 1]]);
            let cost = half_area(&all) * blocks(i) + right[i];
            if cost < best.0 {
                best = (cost, axis, i);
            }
        }
    }
    sort(boxes, best.1);
    best.2
}

/// The work in a tree of nodes of eight made by exhaustive search: ranges are split at the cheapest of all planes,
/// always the one of largest area. Not yet divided by the area of the root.
fn sweep_cost(boxes: &mut [Box3]) -> f64 {
    let mut sum = f64::from(NODE_COST) * half_area(&united(boxes));
    let mut parts = vec![boxes];
    while parts.len() < 8 {
        let area = |i: usize| half_area(&united(parts[i]));
        let largest =
            (0..parts.len()).filter(|&i| parts[i].len() > 4).max_by(|&i, &j| area(i).total_cmp(&area(j)));
        let Some(largest) = largest else { break };
        let part = parts.swap_remove(largest);
        let n_left = sweep(part);
        let (left, right) = part.split_at_mut(n_left);
        parts.extend([left, right]);
    }
    for part in parts {
        sum += if part.len() > 4 { sweep_cost(part) } else { half_area(&united(part)) };
    }
    sum
}

/// The tree is as good as one that takes far longer to build: bins lose little against a search of all
/// planes, and the collapse at least cost gains more.
#[test]
fn the_tree_is_as_good_as_by_exhaustive_search() {
    for mesh in [soup(4000, 0.1, 3), soup(3000, 0.02, 4), ball(5)] {
        let source = Loose::of_mesh(&mesh);
        let bounds = |corners: &[[f32; 3]; 3]| united(&corners.map(|p| Box3 { min: p, max: p }));
        let mut boxes: Vec<Box3> = source.0.iter().map(bounds).collect();
        let bvh = source.build();
        let own = cost(&bvh);
        let reference = sweep_cost(&mut boxes) / half_area(&root_box(&bvh));
        assert!(own <= reference, "cost {own}, by exhaustive search {reference}");
    }
}
