//! Meshes, rays and comparisons that several tests need.

use etendue_math::{AnimatedTransform, Point3, Ray, Rng, Transform, Vector3, warp};

use crate::{Geometry, GeometryBuilder, GeometryId, Hit, Shape, TriangleMesh, loop_subdivide};

/// The filter that refuses nothing.
pub(crate) fn any(_: &Hit) -> bool {
    true
}

/// A transform that does not move.
pub(crate) const fn still(transform: Transform) -> AnimatedTransform {
    AnimatedTransform::constant(transform)
}

/// A geometry of one shape.
pub(crate) fn single(
    shape: Shape,
    transform: Transform,
    reverse_orientation: bool,
) -> (Geometry, GeometryId) {
    let mut builder = GeometryBuilder::new();
    let id = builder.add(shape, &still(transform), reverse_orientation);
    (builder.build(), id)
}

/// A direction uniform on the sphere.
pub(crate) fn direction(rng: &mut Rng) -> Vector3 {
    warp::sample_uniform_sphere(rng.next_point2())
}

/// A point uniform in a cube around the origin.
pub(crate) fn point_in_cube(rng: &mut Rng, half_side: f32) -> Point3 {
    let mut coordinate = || (2.0 * rng.next_f32() - 1.0) * half_side;
    Point3::new(coordinate(), coordinate(), coordinate())
}

/// A ray from a point in a cube in a uniform direction.
pub(crate) fn ray(rng: &mut Rng, half_side: f32) -> Ray {
    Ray::new(point_in_cube(rng, half_side), direction(rng))
}

/// The octahedron with outward winding.
pub(crate) fn octahedron() -> TriangleMesh {
    let p = |x: f32, y: f32, z: f32| Point3::new(x, y, z);
    TriangleMesh {
        positions: vec![
            p(1.0, 0.0, 0.0),
            p(-1.0, 0.0, 0.0),
            p(0.0, 1.0, 0.0),
            p(0.0, -1.0, 0.0),
            p(0.0, 0.0, 1.0),
            p(0.0, 0.0, -1.0),
        ],
        indices: vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]],
        ..TriangleMesh::default()
    }
}

/// A sphere of triangles: the octahedron refined, its vertices moved to radius 1.
pub(crate) fn ball(levels: u32) -> TriangleMesh {
    let mut mesh = loop_subdivide(&octahedron(), levels);
    for p in &mut mesh.positions {
        *p = Point3::ORIGIN + p.as_vector().normalized();
    }
    mesh.normals.clear();
    mesh
}

/// The cube [-1, 1]³ with outward winding.
pub(crate) fn cube() -> TriangleMesh {
    let corner = |i: u32| {
        let pick = |bit: u32| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
        Point3::new(pick(0), pick(1), pick(2))
    };
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    TriangleMesh {
        positions: (0..8).map(corner).collect(),
        indices: quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        ..TriangleMesh::default()
    }
}

/// Small triangles strewn in a cube of half side 1.
pub(crate) fn soup(n: usize, size: f32, seed: u64) -> TriangleMesh {
    let mut rng = Rng::new(seed, 0);
    let mut mesh = TriangleMesh::default();
    for i in 0..n as u32 {
        let centre = point_in_cube(&mut rng, 1.0);
        for _ in 0..3 {
            mesh.positions.push(centre + point_in_cube(&mut rng, size).as_vector());
        }
        mesh.indices.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    mesh
}

/// The nearest hit of world-level entities by testing every primitive (SPEC ACC-1).
pub(crate) fn brute_force(geometry: &Geometry, ray: &Ray) -> Option<f32> {
    let mut nearest: Option<f32> = None;
    for entity in &geometry.entities {
        for primitive in 0..entity.n_primitives() {
            for candidate in entity.intersect(primitive, ray).into_iter().flatten() {
                let t = candidate.t as f32;
                if t > 0.0 && nearest.is_none_or(|best| t < best) {
                    nearest = Some(t);
                }
            }
        }
    }
    nearest
}

/// Fails unless two vectors agree within `tolerance` in every coordinate.
#[track_caller]
pub(crate) fn assert_close(a: Vector3, b: Vector3, tolerance: f32) {
    assert!((a - b).abs().max_element() <= tolerance, "{a:?} is not {b:?} within {tolerance}");
}
