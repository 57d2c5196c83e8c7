//! Luxmeters where the illuminance is known (SPEC RAD-13).

use std::f64::consts::PI;

use etendue_math::{Normal3, Point3, Vector3};
use etendue_transport::probe::{Estimate, ProbePoint, ProbeSettings, Reading, probe};

use crate::support::{Setup, flat, lit, seed};

/// Standard errors, each from 16 batches, beyond which Student's t with 15 degrees of freedom lies with probability 5e-7 (a share of
/// 1e-3 for 2000 comparisons).
const T: f64 = 8.1;

fn upwards(x: f32, y: f32, z: f32) -> ProbePoint {
    ProbePoint { p: Point3::new(x, y, z), n: Normal3::new(0.0, 0.0, 1.0) }
}

fn read(name: &str, world: &str, points: &[ProbePoint]) -> Vec<Reading> {
    let scene = Setup { world, ..Setup::default() }.scene(name);
    probe(&scene, points, &ProbeSettings { samples: 16_384, seed: seed(name), ..ProbeSettings::default() })
}

/// Demands an expectation, and that an error of a share `resolution` would show.
#[track_caller]
fn expect(what: &str, estimate: Estimate, expected: f64, resolution: f64) {
    let Estimate { mean, standard_error } = estimate;
    let rounding = 1e-4 * expected;
    assert!(
        (mean - expected).abs() <= T * standard_error + rounding,
        "{what}: {mean} ± {standard_error}, not {expected}"
    );
    assert!(
        T * standard_error <= resolution * expected,
        "{what}: ± {standard_error} hides errors of {expected}"
    );
}

/// A lamp of intensity I in candela makes E = I cos / d^2, and none from below.
#[test]
fn point_light() {
    let light =
        format!("LightSource \"point\" {} \"float scale\" 90 \"point3 from\" [0 0 3]", flat("I", 1.0));
    let down = ProbePoint { n: Normal3::new(0.0, 0.0, -1.0), ..upwards(0.0, 0.0, 0.0) };
    let readings = read("a lamp above", &light, &[upwards(0.0, 0.0, 0.0), upwards(4.0, 0.0, 0.0), down]);
    expect("below the lamp", readings[0].illuminance_lx, 10.0, 0.02);
    expect("aside", readings[1].illuminance_lx, 90.0 * (3.0 / 5.0) / 25.0, 0.02);
    assert_eq!(readings[0].direct_lx, readings[0].illuminance_lx);
    assert_eq!(readings[2], Reading::default());
}

/// A disc of luminance L and radius R at height h makes E = pi L R^2 / (R^2 + h^2) below its centre; looking up one sees L.
#[test]
fn disc_lamp() {
    let light = format!(
        "AttributeBegin Translate 0 0 2 ReverseOrientation AreaLightSource \"diffuse\" {}
        Shape \"disk\" \"float radius\" 1.5 AttributeEnd",
        lit("L", 100.0)
    );
    let readings = read("a disc above", &light, &[upwards(0.0, 0.0, 0.0)]);
    expect("disc", readings[0].illuminance_lx, PI * 100.0 * 2.25 / (2.25 + 4.0), 0.02);
    expect("its luminance", readings[0].luminance_cd_m2, 100.0, 0.02);
}

/// A uniform sky makes E = pi L, whatever the sensor leans; a wall hides half of it.
#[test]
fn uniform_sky() {
    let light = format!("LightSource \"infinite\" {}", lit("L", 2.0));
    let leaning = Vector3::new(1.0, -2.0, 0.5).normalized();
    let leaning = ProbePoint { n: leaning.as_normal(), ..upwards(1.0, 2.0, 3.0) };
    let readings = read("sky", &light, &[upwards(0.0, 0.0, 0.0), leaning]);
    for reading in &readings {
        expect("sky", reading.illuminance_lx, 2.0 * PI, 0.02);
        expect("zenith", reading.luminance_cd_m2, 2.0, 0.02);
    }
    // A point of a black wall sees the half of the sky before it: the sensor stands on its surface and is not swallowed.
    let wall = format!(
        "{light} Material \"diffuse\" \"spectrum reflectance\" [400 0 800 0]
        Shape \"bilinearmesh\" \"point3 P\" [-1e4 -1e4 0  1e4 -1e4 0  -1e4 1e4 0  1e4 1e4 0]"
    );
    let up = read("on a wall", &wall, &[upwards(0.0, 0.0, 0.0)]);
    expect("on a wall", up[0].illuminance_lx, 2.0 * PI, 0.02);
}

/// In a closed white furnace of albedo a whose walls emit L, every wall has E = pi L / (1 - a).
#[test]
fn inside_a_furnace() {
    let world = format!(
        "Material \"diffuse\" {} ReverseOrientation AreaLightSource \"diffuse\" {} Shape \"sphere\" \"float radius\" 2",
        flat("reflectance", 0.5),
        lit("L", 1.0)
    );
    let readings = read("furnace", &world, &[upwards(0.3, 0.2, -0.4)]);
    expect("furnace", readings[0].illuminance_lx, 2.0 * PI, 0.02);
    expect("its direct part", readings[0].direct_lx, PI, 0.02);
    expect("its wall", readings[0].luminance_cd_m2, 2.0, 0.02);
}

/// The standard error is honest: means of independent seeds spread as it says.
#[test]
fn standard_error() {
    let world = format!(
        "Material \"diffuse\" {} LightSource \"infinite\" {} Shape \"sphere\" \"float radius\" 1",
        flat("reflectance", 0.5),
        lit("L", 1.0)
    );
    let scene = Setup { world: &world, ..Setup::default() }.scene("error");
    let side = ProbePoint { p: Point3::new(1.5, 0.0, 0.0), n: Normal3::new(0.0, 0.0, 1.0) };
    let n_seeds = 64;
    let readings: Vec<Estimate> = (0..n_seeds)
        .map(|seed| {
            probe(&scene, &[side], &ProbeSettings { samples: 64, seed, ..ProbeSettings::default() })[0]
        })
        .map(|reading| reading.illuminance_lx)
        .collect();
    let mean = readings.iter().map(|r| r.mean).sum::<f64>() / n_seeds as f64;
    let spread = readings.iter().map(|r| (r.mean - mean).powi(2)).sum::<f64>() / (n_seeds - 1) as f64;
    let stated = readings.iter().map(|r| r.standard_error.powi(2)).sum::<f64>() / n_seeds as f64;
    // F with 63 and 960 degrees of freedom lies within these with probability 1 - 1e-6.
    assert!((0.36..2.2).contains(&(spread / stated)), "{spread} against {stated}");
}

/// One seed gives one reading, for any number of points beside it.
#[test]
fn readings_do_not_depend_on_others() {
    let light = format!("LightSource \"infinite\" {}", lit("L", 2.0));
    let one = read("alone", &light, &[upwards(0.0, 0.0, 0.0)]);
    let two = read("alone", &light, &[upwards(0.0, 0.0, 0.0), upwards(1.0, 0.0, 0.0)]);
    assert_eq!(one[0], two[0]);
}
