//! Fisheye cameras.

use super::*;

const SIZE: [u32; 2] = [200, 100];

fn of(mapping: FisheyeMapping, fov_deg: f32) -> Camera {
    let half_fov_rad = fov_deg.to_radians() / 2.0;
    camera(Projection::Fisheye(Fisheye { screen: screen(SIZE), mapping, half_fov_rad }), SIZE)
}

/// At half of the radius stands the angle that the law of the mapping gives.
#[test]
fn angles_follow_the_law() {
    #[track_caller]
    fn check(mapping: FisheyeMapping, fov_deg: f32, expected_deg: f32) {
        let camera = of(mapping, fov_deg);
        for (dx, dy) in [(25.0, 0.0), (-25.0, 0.0), (0.0, 25.0), (15.0, 20.0)] {
            let ray = camera.sample_ray(Point2::new(100.0 + dx, 50.0 + dy), MIDDLE, 0.0).unwrap().ray;
            let angle = ray.direction.z.acos().to_degrees();
            assert!((angle - expected_deg).abs() < 0.01, "{mapping:?}: {angle} but {expected_deg}");
            let azimuth = (-ray.direction.y).atan2(ray.direction.x) - dy.atan2(dx);
            assert!(azimuth.sin().abs() < 1e-5 && azimuth.cos() > 0.0, "right is +x, down is -y");
        }
    }
    check(FisheyeMapping::Equidistant, 180.0, 45.0);
    check(FisheyeMapping::Equidistant, 360.0, 90.0);
    // sin(t / 2) = sin(45 degrees) / 2, tan(t / 2) = tan(45 degrees) / 2, sin(t) = 1 / 2.
    check(FisheyeMapping::Equisolid, 180.0, 41.4096);
    check(FisheyeMapping::Stereographic, 180.0, 53.1301);
    check(FisheyeMapping::Orthographic, 180.0, 30.0);
}

/// The film is black beyond the circle, and importance integrates to the share of the film within it, pi / 8 of an image
/// twice as wide as high, where pixels and directions are each other's inverse.
#[test]
fn importance_integrates_to_the_circle() {
    for (mapping, fov) in [
        (FisheyeMapping::Equidistant, 200.0),
        (FisheyeMapping::Equisolid, 360.0),
        (FisheyeMapping::Stereographic, 220.0),
        (FisheyeMapping::Orthographic, 180.0),
    ] {
        let camera = of(mapping, fov);
        assert!(camera.sample_ray(Point2::new(100.0, 99.9), MIDDLE, 0.0).is_some());
        assert!(camera.sample_ray(Point2::new(151.0, 50.0), MIDDLE, 0.0).is_none());
        assert!(camera.sample_ray(Point2::new(0.0, 0.0), MIDDLE, 0.0).is_none());
        let mut rng = Rng::new(hash64(&[60, mapping as u64]), 1);
        let mut integral = Moments::new();
        for _ in 0..50_000 {
            let d = warp::sample_uniform_sphere(rng.next_point2());
            let ray = Ray::new(Point3::ORIGIN, d);
            let film = camera.we(&ray);
            integral.push(film.map_or(0.0, |film| f64::from(film.we)) * 4.0 * std::f64::consts::PI);
            // At the border, rounding decides.
            if let Some(film) = film.filter(|film| (film.p_film - Point2::new(100.0, 50.0)).length() < 49.99)
            {
                let back = camera.sample_ray(film.p_film, MIDDLE, 0.0).expect("a ray of the view").ray;
                assert!((back.direction - d).length() < 2e-3, "{mapping:?}: {d:?} {back:?}");
            }
        }
        mean_test(&integral, std::f64::consts::PI / 8.0, SIGNIFICANCE).unwrap_or_else(|m| panic!("{m}"));
    }
}

/// Views that a mapping cannot have are errors.
#[test]
fn views_beyond_the_mapping_are_refused() {
    let problems = |mapping: &str, fov: f32| {
        let entity = Entity::new("fisheye")
            .with("mapping", Value::Strings(vec![mapping.to_owned()]))
            .with("fov", Value::Floats(vec![fov]));
        read(&entity, SIZE).1
    };
    assert_eq!(problems("equidistant", 360.0), 0);
    assert_eq!(problems("equidistant", 361.0), 1);
    assert_eq!(problems("equisolid", 0.0), 1);
    assert_eq!(problems("stereographic", 360.0), 1);
    assert_eq!(problems("stereographic", 359.0), 0);
    assert_eq!(problems("orthographic", 180.0), 0);
    assert_eq!(problems("orthographic", 181.0), 1);
    assert_eq!(problems("fisch", 100.0), 1);
}
