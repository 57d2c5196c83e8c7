//! Motion blur (CAM-4): streaks of moving objects and under moving cameras, by ambient occlusion, in which what is hit is 1.

use etendue_math::statistics::Moments;
use etendue_scene::document::Entity;

use crate::strategies::{blocks, ceiling_light, open_box};
use crate::support::{Setup, expect_mean, expect_same_image, luminance, render_passes};

/// Pixels across 2 m.
const SIZE: u32 = 64;
/// Side of the square that is seen, in metres.
const SIDE: f64 = 0.125;
/// A square in the middle of the picture, 5 m away.
const SQUARE: &str = "Shape \"bilinearmesh\" \"point3 P\" [-0.0625 -0.0625 5  0.0625 -0.0625 5  -0.0625 0.0625 5  0.0625 0.0625 5]";
const CAMERA: &str = "Camera \"orthographic\" \"float screenwindow\" [-1 1 -1 1]";

/// The picture of a shutter's time, as the share of time that each pixel sees the square.
fn seen(name: &str, camera: &str, world: &str) -> Vec<f64> {
    let mut scene = Setup { size: [SIZE, SIZE], camera, world, ..Setup::default() }.scene(name);
    scene.integrator = Entity::new("ao");
    luminance(&render_passes(&scene, 0..400))
}

/// The pixel that shows a point in metres.
fn pixel(x: f64, y: f64) -> usize {
    let index = |x: f64| ((x + 1.0) / 2.0 * f64::from(SIZE)) as usize;
    index(-y) * SIZE as usize + index(x)
}

/// Values of distinct pixels within a straight streak's core, between these ends.
fn core(values: &[f64], from: f64, to: f64) -> Moments {
    let n = ((to - from).abs() * f64::from(SIZE) / 3.0) as u32;
    let along = move |i: u32| from + (to - from) * (f64::from(i) + 0.5) / f64::from(n);
    (0..n).flat_map(|i| [-0.03, 0.002, 0.035].map(|y| values[pixel(along(i), y)])).collect()
}

/// A streak from the middle to the distance `way`: each point of its core sees the square for the time that it takes to pass,
/// the ends are where they should be, and nothing is beyond.
#[track_caller]
fn expect_streak(name: &str, values: &[f64], way: f64) {
    let (from, to) = (SIDE / 2.0 + 0.04, way.abs() - SIDE / 2.0 - 0.04);
    let inside = core(values, from * way.signum(), to * way.signum());
    expect_mean(name, &inside, SIDE / way.abs(), 0.15);
    let end = way + (SIDE / 2.0).copysign(way);
    assert!(values[pixel(end - 0.04 * way.signum(), 0.0)] > 0.0, "{name}: the streak is too short");
    for (x, y) in [(end + 0.04 * way.signum(), 0.0), (-0.11 * way.signum(), 0.0), (way / 2.0, 0.11)] {
        assert_eq!(values[pixel(x, y)], 0.0, "{name}: something at {x} {y}");
    }
    // What is smeared is not lost: the sum is the area of the square.
    let sum = values.iter().sum::<f64>() * (2.0 / f64::from(SIZE)).powi(2);
    assert!((sum / (SIDE * SIDE) - 1.0).abs() < 0.05, "{name}: {sum}");
}

/// A square that moves by 0.75 m leaves a streak that much longer than itself; half of the time, half of it.
#[test]
fn moving_objects_leave_streaks() {
    let world = format!("ActiveTransform EndTime Translate 0.75 0 0 ActiveTransform All {SQUARE}");
    expect_streak("object", &seen("object", CAMERA, &world), 0.75);
    let half = format!("{CAMERA} \"float shutteropen\" 0 \"float shutterclose\" 0.5");
    expect_streak("half shutter", &seen("half shutter", &half, &world), 0.375);
    let slow = format!("TransformTimes 0 2 {CAMERA}");
    expect_streak("slow", &seen("slow", &slow, &world), 0.375);
}

/// A camera that moves to the right has the world move to the left.
#[test]
fn moving_cameras_leave_streaks() {
    let camera = format!("ActiveTransform EndTime Translate -0.75 0 0 ActiveTransform All {CAMERA}");
    expect_streak("camera", &seen("camera", &camera, SQUARE), -0.75);
}

/// What moves with the camera is sharp.
#[test]
fn moving_together_is_standing_still() {
    let camera = format!("ActiveTransform EndTime Translate -0.5 0 0 ActiveTransform All {CAMERA}");
    let world = format!("ActiveTransform EndTime Translate 0.5 0 0 ActiveTransform All {SQUARE}");
    let values = seen("together", &camera, &world);
    // Five standard errors of white by random wavelengths.
    assert!((values[pixel(0.01, 0.01)] - 1.0).abs() < 0.04);
    assert_eq!(values[pixel(0.1, 0.0)], 0.0);
}

/// A square that turns around the axis follows the arc, not the chord: by a quarter turn at the radius 0.6 each point of the
/// arc sees it for the time `side / (0.6 pi / 2)`. So does a square under a camera that turns the other way.
#[test]
fn turning_follows_the_arc() {
    let square = "Shape \"bilinearmesh\" \"point3 P\"
        [0.5375 -0.0625 5  0.6625 -0.0625 5  0.5375 0.0625 5  0.6625 0.0625 5]";
    let turning = format!("ActiveTransform EndTime Rotate 90 0 0 1 ActiveTransform All {square}");
    let camera = format!("ActiveTransform EndTime Rotate 90 0 0 1 ActiveTransform All {CAMERA}");
    for (name, camera, world) in [("object", CAMERA, turning.as_str()), ("camera", camera.as_str(), square)] {
        let values = seen(&format!("turning {name}"), camera, world);
        let at = |angle_deg: f64, r: f64| {
            let (sin, cos) = angle_deg.to_radians().sin_cos();
            values[pixel(r * cos, r * sin)]
        };
        let arc: Moments = (0..14).map(|i| at(12.0 + 5.0 * f64::from(i), 0.6)).collect();
        expect_mean(name, &arc, SIDE / (0.6 * std::f64::consts::FRAC_PI_2), 0.25);
        assert_eq!(at(45.0, 0.6 * std::f64::consts::FRAC_1_SQRT_2), 0.0, "the middle of the chord");
        assert_eq!(at(45.0, 0.75), 0.0);
        assert_eq!(at(-20.0, 0.6), 0.0);
        assert_eq!(at(110.0, 0.6), 0.0);
    }
}

/// A lamp that moves and turns while the shutter is open lights a room alike whether it is sampled, run into, or both.
#[test]
fn moving_lamps_are_found_both_ways() {
    let motion = "ActiveTransform EndTime Translate 0.5 -0.6 0.2 Rotate 25 0 0 1 ActiveTransform All";
    let world = open_box(&format!("AttributeBegin {motion} {} AttributeEnd", ceiling_light(0.3)));
    let render = |lights: &str, n_passes| {
        let integrator = format!("\"integer maxdepth\" 3 \"string lights\" \"{lights}\"");
        blocks(&format!("moving lamp by {lights}"), &world, &integrator, n_passes)
    };
    let (both, lights, scattering) = (render("both", 300), render("lights", 300), render("scattering", 600));
    expect_same_image("both and lights", &both, &lights, 0.08);
    expect_same_image("both and scattering", &both, &scattering, 0.15);
}
