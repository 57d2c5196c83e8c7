//! Spherical triangles against double precision, from a millionth of the distance to a million times it.

use super::*;
use crate::Rng;

/// A triangle of this size, about a point at distance 1 in a random direction.
fn random_triangle(rng: &mut Rng, size: f32) -> [Point3; 3] {
    let mut direction = || super::super::sample_uniform_sphere(rng.next_point2());
    let centre = Point3::ORIGIN + direction();
    [0; 3].map(|_| centre + direction() * size)
}

/// Solid angles are precise in relation to themselves, but for what single precision takes from a slanted view, and
/// samples are where double precision wants them.
#[test]
fn any_size_is_precise() {
    let mut rng = Rng::new(31, 0);
    for size in [1e-6, 1e-4, 0.01, 0.3, 1.0, 10.0, 1e6] {
        let mut checked = 0;
        for _ in 0..3000 {
            let v = random_triangle(&mut rng, size);
            let corners = v.map(|v| dvec(v - Point3::ORIGIN));
            let [a, b, c] = corners.map(DVec3::normalize);
            // The triple product by edges, as unit vectors to a small triangle are too near each other even so.
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let height = (a.dot(normal) / normal.length()).abs() * corners[0].length();
            let cosine = height / corners.map(DVec3::length).into_iter().fold(0.0, f64::max);
            let Some(triangle) = SphericalTriangle::new(v, Point3::ORIGIN) else { continue };
            if cosine < 1e-3 || triangle.solid_angle() > 6.22 {
                continue;
            }
            checked += 1;
            let triple = (corners[0].dot(normal) / corners.map(DVec3::length).iter().product::<f64>()).abs();
            let expected = 2.0 * triple.atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a));
            let error = (f64::from(triangle.solid_angle()) / expected - 1.0).abs();
            assert!(error < 1e-6 / cosine, "{expected} is wrong by {error}, size {size}, cosine {cosine}");
            let u = rng.next_point2();
            let weights = triangle.sample(u).map(f64::from);
            let w = corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
            let back = invert(corners, w).unwrap();
            let miss = (back.x - u.x).abs().max((back.y - u.y).abs());
            assert!(f64::from(miss) < 1e-4 / cosine, "{u:?} became {back:?}, size {size}, cosine {cosine}");
        }
        assert!(checked > 1000, "{checked} of size {size}");
    }
}
