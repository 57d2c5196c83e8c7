use etendue_math::{Point3, Ray, Rng, Transform, Vector3};

use crate::test_support::{any, assert_close, direction, point_in_cube, single};
use crate::{BilinearMesh, Shape};

/// The six faces of a cube of side 2, which share their vertices.
fn cube() -> BilinearMesh {
    let corner = |i: u32| {
        let side = |axis: u32| if i >> axis & 1 == 0 { -1.0 } else { 1.0 };
        Point3::new(side(0), side(1), side(2))
    };
    BilinearMesh {
        positions: (0..8).map(corner).collect(),
        indices: vec![[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 4, 5], [2, 3, 6, 7], [0, 2, 4, 6], [1, 3, 5, 7]],
        ..BilinearMesh::default()
    }
}

fn turned() -> Transform {
    let turn = Transform::rotate(0.7, Vector3::new(1.0, 2.0, 3.0)).expect("an axis");
    Transform::translate(Vector3::new(0.3, -5.0, 70.0)) * turn
}

/// No ray leaves a closed box of flat patches, wherever it stands; where it ends, the patch has the point and the normal
/// that its equation gives.
#[test]
fn boxes_of_flat_patches_are_closed() {
    let mut rng = Rng::new(31, 0);
    for transform in [Transform::IDENTITY, turned()] {
        let (geometry, id) = single(Shape::Bilinear(cube()), transform, false);
        assert_eq!(geometry.counts().n_patches, 6);
        for i in 0..20_000 {
            let target = if i % 2 == 0 { point_in_cube(&mut rng, 1.0) } else { edge_point(&mut rng) };
            let from = transform.point(point_in_cube(&mut rng, 0.99));
            let ray = Ray::new(from, transform.point(target) - from);
            let hit = geometry.intersect(&ray, f32::INFINITY, &any).expect("the box is closed");
            assert_eq!(hit.geometry, id);
            let s = geometry.surface_point(&ray, &hit);
            let [u, v] = hit.uv;
            let [a, b, c, _] = cube().indices[hit.primitive as usize]
                .map(|vertex| transform.point(cube().positions[vertex as usize]));
            assert_close((a + (b - a) * u + (c - a) * v).as_vector(), s.p.as_vector(), 3e-5);
            assert_close(ray.at(hit.t).as_vector(), s.p.as_vector(), 3e-5);
            assert_close((b - a).cross(c - a).normalized(), s.ng.as_vector(), 1e-5);
        }
    }
}

/// A point on an edge of the cube or on the line where a face is cut in two.
fn edge_point(rng: &mut Rng) -> Point3 {
    let p = direction(rng);
    let side = |x: f32| 1.0_f32.copysign(x);
    if rng.next_f32() < 0.5 {
        return Point3::new(side(p.x), side(p.y), p.z);
    }
    Point3::new(p.x, p.x, side(p.z))
}

/// A patch that is bent by more than rounding keeps its curved surface.
#[test]
fn bent_patches_are_not_cut_in_two() {
    for (lift, is_flat) in [(0.0, true), (1e-7, true), (1e-4, false)] {
        let mut mesh = cube();
        mesh.indices.truncate(1);
        mesh.positions[3].z += lift;
        let patches = super::Patches::new(mesh, &Transform::IDENTITY, false);
        assert_eq!(patches.is_flat(), is_flat, "{lift}");
    }
}
