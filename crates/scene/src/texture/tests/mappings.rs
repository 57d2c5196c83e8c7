//! From points to texture coordinates, with their change per pixel.

use super::*;

/// The change of texture coordinates per pixel is their difference between the points that neighbouring pixels see.
#[test]
fn mappings_agree_with_finite_differences() {
    let placed =
        Transform::translate(Vector3::new(0.1, 0.2, -0.3)) * Transform::scale(2.0, 1.0, 0.5).unwrap();
    let texture_from_world = placed.inverse();
    let mappings = [
        Mapping2::Uv { su: 3.0, sv: -2.0, du: 0.1, dv: 0.2 },
        Mapping2::TurnedUv { rows: [[0.5, -1.5], [2.0, 0.3]], du: 0.1, dv: 0.2 },
        Mapping2::Spherical(texture_from_world),
        Mapping2::Cylindrical(texture_from_world),
        Mapping2::Planar {
            texture_from_world,
            vs: Vector3::new(1.0, 2.0, 0.5),
            vt: Vector3::new(-1.0, 0.3, 0.2),
            ds: 0.4,
            dt: 0.5,
        },
    ];
    let (dpdx, dpdy) = (Vector3::new(2e-3, -1e-3, 1e-3), Vector3::new(0.0, 1e-3, 3e-3));
    let context = |p: Point3, uv: Point2| TextureContext {
        p,
        uv,
        dpdx,
        dpdy,
        dudx: 1e-3,
        dudy: -2e-3,
        dvdx: 3e-3,
        dvdy: 1e-3,
        ..TextureContext::default()
    };
    let (p, uv) = (Point3::new(1.0, 0.7, 0.9), Point2::new(0.3, 0.6));
    for mapping in mappings {
        let c = mapping.map(&context(p, uv));
        let right = mapping.map(&context(p + dpdx, Point2::new(uv.x + 1e-3, uv.y + 3e-3))).st;
        let below = mapping.map(&context(p + dpdy, Point2::new(uv.x - 2e-3, uv.y + 1e-3))).st;
        for (found, expected) in [
            (c.dsdx, right.x - c.st.x),
            (c.dtdx, right.y - c.st.y),
            (c.dsdy, below.x - c.st.x),
            (c.dtdy, below.y - c.st.y),
        ] {
            assert!((found - expected).abs() < 2e-5, "{mapping:?}: {found} but {expected}");
        }
    }
}

/// Angles on a globe: the pole is at s = 0, the equator at s = 1/2, and t goes once around.
#[test]
fn spherical_mapping_has_its_pole_at_z() {
    let map = |x: f32, y: f32, z: f32| Mapping2::Spherical(Transform::IDENTITY).map(&at_point(x, y, z)).st;
    assert_eq!(map(0.0, 0.0, 2.0).x, 0.0);
    assert!((map(3.0, 0.0, 0.0) - Point2::new(0.5, 0.0)).length() < 1e-6);
    assert!((map(0.0, 1.0, 0.0) - Point2::new(0.5, 0.25)).length() < 1e-6);
    assert!((map(0.0, -1.0, 0.0) - Point2::new(0.5, 0.75)).length() < 1e-6);
    let cylindrical = Mapping2::Cylindrical(Transform::IDENTITY).map(&at_point(2.0, 0.0, 0.7)).st;
    assert!((cylindrical - Point2::new(0.5, 0.7)).length() < 1e-6);
}
