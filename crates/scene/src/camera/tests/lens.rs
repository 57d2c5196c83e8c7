//! Apertures and the units of photographers.

use super::*;

/// The perspective camera of these parameters, and the number of problems.
fn thin(parameters: &[(&str, f32)], resolution: [u32; 2]) -> (Perspective, usize) {
    let entity = parameters
        .iter()
        .fold(Entity::new("perspective"), |entity, (name, x)| entity.with(name, Value::Floats(vec![*x])));
    let (camera, n_problems) = read(&entity, resolution);
    let Projection::Perspective(p) = camera.projection() else { panic!("a perspective camera") };
    (*p, n_problems)
}

/// A 50 mm lens sees 39.6 degrees across 36 mm of film, whatever the shape of the image, and 27.0 degrees across the 24 mm of
/// its height.
#[test]
fn focal_length_gives_the_view() {
    for resolution in [[300, 200], [360, 200], [200, 300]] {
        let (camera, n_problems) = thin(&[("focallength", 50.0)], resolution);
        assert_eq!(n_problems, 0);
        let across = (camera.tan_half_fov * camera.screen.window.x[1]).atan().to_degrees() * 2.0;
        assert!((across - 39.5978).abs() < 1e-3, "{across}");
        assert!(!camera.lens.has_area(), "a pinhole without an f-number");
    }
    let (camera, _) = thin(&[("focallength", 50.0)], [300, 200]);
    assert!(((2.0 * camera.tan_half_fov.atan()).to_degrees() - 26.9915).abs() < 1e-3);
    let (camera, _) = thin(&[("focallength", 50.0), ("sensorwidth", 18.0)], [300, 200]);
    assert!((camera.tan_half_fov * 1.5 - 9.0 / 50.0).abs() < 1e-6, "half the film, half the tangent");
}

/// Focused at 0.25 m, 50 mm of focal length need 62.5 mm between lens and film: the view narrows (CAM-3).
#[test]
fn cam_3_focusing_near_narrows_the_view() {
    let (camera, n_problems) = thin(&[("focallength", 50.0), ("focaldistance", 0.25)], [100, 100]);
    assert_eq!(n_problems, 0);
    assert!((camera.tan_half_fov - 18.0 / 62.5).abs() < 1e-6);
    let expected = field_of_view(0.036, 0.05, 0.25);
    assert!((2.0 * camera.tan_half_fov.atan() - expected).abs() < 1e-6);
}

/// The f-number gives the aperture, from the focal length or from the view that stands for it (CAM-3).
#[test]
fn cam_3_f_number_gives_the_aperture() {
    let (camera, n_problems) =
        thin(&[("focallength", 85.0), ("fstop", 1.7), ("focaldistance", 3.0)], [150, 100]);
    assert_eq!(n_problems, 0);
    assert!((camera.lens.radius - 0.025).abs() < 1e-8);
    let fov = (2.0 * camera.tan_half_fov.atan()).to_degrees();
    let (same, n_problems) = thin(&[("fov", fov), ("fstop", 1.7), ("focaldistance", 3.0)], [150, 100]);
    assert_eq!(n_problems, 0);
    assert!((same.lens.radius - 0.025).abs() < 1e-6, "{}", same.lens.radius);
}

/// Contradictions and impossible lenses are reported once.
#[test]
fn impossible_lenses_are_reported() {
    let problems = |parameters: &[(&str, f32)]| thin(parameters, [10, 10]).1;
    assert_eq!(problems(&[("fov", 40.0), ("focallength", 50.0)]), 1);
    assert_eq!(problems(&[("lensradius", 0.1), ("fstop", 2.0)]), 1);
    assert_eq!(problems(&[("focallength", 50.0), ("focaldistance", 0.05)]), 1);
    assert_eq!(problems(&[("focallength", 0.0)]), 1);
    assert_eq!(problems(&[("focallength", 1e-30)]), 1);
    assert_eq!(problems(&[("focallength", 50.0), ("fstop", 1e-38)]), 1);
    assert_eq!(problems(&[("lensradius", 1e30)]), 1);
    assert_eq!(problems(&[("fstop", 0.0)]), 1);
    assert_eq!(problems(&[("fstop", f32::NAN)]), 1);
    assert_eq!(problems(&[("focallength", 50.0), ("sensorwidth", -36.0)]), 1);
    assert_eq!(problems(&[("sensorwidth", 24.0)]), 1);
    assert_eq!(problems(&[("fov", 0.0)]), 1);
    assert_eq!(problems(&[("fov", 180.0)]), 1);
    assert_eq!(problems(&[("fov", 1e-44)]), 1);
    assert_eq!(problems(&[("focaldistance", 0.0)]), 1);
    let bladed = |n: i32| {
        let entity = Entity::new("perspective").with("blades", Value::Integers(vec![n]));
        read(&entity, [10, 10]).1
    };
    assert_eq!([0, 1, 2, 3, 9, -1, 1000].map(bladed), [0, 1, 1, 0, 0, 1, 1]);
}

/// Points of a polygon lie within it, and within half of its radius lies a quarter of them, on every side alike; its area is
/// the share of a square that it contains.
#[test]
fn polygons_are_sampled_evenly() {
    for (n, rotation_rad) in [(3, 0.0), (4, 0.2), (5, -1.0), (6, 7.0), (11, 0.5)] {
        let lens = Lens { radius: 0.5, blades: Some(Blades { n, rotation_rad }), focal_distance: 1.0 };
        let mut rng = Rng::new(hash64(&[70, u64::from(n)]), 1);
        let (mut inner, mut x, mut y, mut area) =
            (Moments::new(), Moments::new(), Moments::new(), Moments::new());
        for _ in 0..20_000 {
            let p = lens.sample(rng.next_point2());
            assert!(lens.contains(Point2::new(0.9999 * p.x, 0.9999 * p.y)), "{p:?} of {n}");
            inner.push(f64::from(u8::from(lens.contains(Point2::new(2.0 * p.x, 2.0 * p.y)))));
            x.push(f64::from(p.x));
            y.push(f64::from(p.y));
            let u = rng.next_point2();
            area.push(f64::from(u8::from(lens.contains(Point2::new(u.x - 0.5, u.y - 0.5)))));
        }
        for (moments, expected) in [(&inner, 0.25), (&x, 0.0), (&y, 0.0), (&area, f64::from(lens.area()))] {
            mean_test(moments, expected, SIGNIFICANCE).unwrap_or_else(|m| panic!("{n} blades: {m}"));
        }
    }
}
