//! Spherical rectangles from a ten-thousandth of the distance to a thousand times it.

use super::*;
use crate::{Frame, Rng};

/// Samples are where the inverse, which takes the solid angle from other formulas, wants them.
#[test]
fn any_size_is_precise() {
    let mut rng = Rng::new(32, 0);
    for size in [1e-4, 0.01, 0.3, 1.0, 10.0, 1e3] {
        let mut checked = 0;
        for _ in 0..3000 {
            let mut direction = || super::super::sample_uniform_sphere(rng.next_point2());
            let (frame, corner) = (Frame::from_z(direction()), Point3::ORIGIN + direction());
            let (edge_x, edge_y) = (frame.x * size, frame.y * (0.2 * size));
            let Some(rectangle) = SphericalRectangle::new(Point3::ORIGIN, corner, edge_x, edge_y) else {
                continue;
            };
            if rectangle.h < 1e-2 {
                continue;
            }
            checked += 1;
            let expected = rectangle.recomputed_solid_angle();
            let error = (f64::from(rectangle.solid_angle()) / expected - 1.0).abs();
            assert!(error < 1e-6 + 1e-13 / expected, "{expected} is wrong by {error}");
            let u = rng.next_point2();
            let [x, y] = rectangle.sample_local(u);
            let back = rectangle.invert_local(x, y);
            let miss = (back.x - u.x).abs().max((back.y - u.y).abs());
            assert!(f64::from(miss) < 1e-5 + 1e-13 / expected, "{u:?} became {back:?}, size {size}");
        }
        assert!(checked > 1000, "{checked} of size {size}");
    }
}

/// Where a rectangle in front fills nearly half of all directions it is not taken for one that fills none.
#[test]
fn nothing_is_not_everything() {
    let from_height = |z: f32, x: f32| {
        let corner = Point3::new(-1.0, -1.0, 0.0);
        let p = Point3::new(x, 0.1, z);
        SphericalRectangle::new(p, corner, Vector3::new(2.0, 0.0, 0.0), Vector3::new(0.0, 2.0, 0.0))
    };
    for z in [1e-2, 1e-4, 1e-6] {
        let above = from_height(z, 0.3).unwrap().solid_angle();
        assert!((above - TAU).abs() < 10.0 * z + 1e-6, "{above} at {z}");
        assert!(from_height(z, 3.0).is_none_or(|beside| beside.solid_angle() < z));
    }
}
