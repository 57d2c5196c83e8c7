//! Where the light at a point of a floor comes from (SPEC SCENE-31).

use std::f32::consts::{PI, TAU};
use std::fmt::Write;

use etendue_image::Image;
use etendue_math::{Rng, Vector3};

use super::settings::{SEED, count, number};
use super::text::{placed, sphere};
use super::{Files, Generator, Settings};
use crate::estimator::{Estimator, SamplerChoice};
use crate::scenes::StudyScene;

/// Directions at a point of the standard box.
pub(super) const GENERATOR: Generator = Generator {
    name: "incident",
    id: "SCENE-31",
    doc: "directions from which 50 photons arrive at a point of the standard box's floor, as rods",
    parameters: &[
        count("photons", "50", [1, 1000], "number of directions"),
        number("x", "0.56", [-0.95, 0.95], "m", "place on the floor: to the right"),
        number("z", "-0.16", [-2.5, 0.95], "m", "place on the floor: into the picture"),
        count("samples", "256", [1, 65536], "paths for each of the 2048 directions that are weighed"),
        SEED,
    ],
    generate,
};

const BOX: &str = include_str!("../../../../scenes/box.pbrt");

/// The box's camera in its file.
const LOOK_AT: &str = "LookAt 0 0.9 -2.8   0 0.9 0   0 1 0";
const CAMERA: &str = "Camera \"perspective\" \"float fov\" [ 45 ]";

fn generate(settings: &Settings) -> Files {
    let place = [settings.number("x"), 0.0, settings.number("z")];
    let directions = directions(settings, place);
    let mut rods = String::new();
    for direction in &directions {
        let _ = write!(rods, "{}", rod(place, *direction));
    }
    let n = directions.len();
    let eye = [place[0] + 0.2, 0.42, place[2] - 0.75];
    let text = BOX
        .replace(
            LOOK_AT,
            &format!("LookAt {} {} {}   {} 0.1 {}   0 1 0", eye[0], eye[1], eye[2], place[0], place[2]),
        )
        .replace("box.exr", "incident.exr");
    let text = text.find("\n\n").map_or(text.as_str(), |end| &text[end + 2..]);
    let [x, _, z] = place;
    let text = format!(
        r#"# Directions from which {n} photons arrive at the point ({x}, 0, {z}) on the floor of the standard box, as rods (SPEC SCENE-31).
# They come in clusters: from the lamp, through the glass ball, from the near walls. A path tracer that sends its paths that
# way has less noise.
#
# Photons of equal power arrive in proportion to radiance times cosine: radiance was found by path tracing.

{text}
# The rods, and the point.
Material "diffuse" "rgb reflectance" [ 0.9 0.75 0.1 ]
{rods}Material "diffuse" "rgb reflectance" [ 0.8 0.1 0.1 ]
{point}"#,
        point = sphere(place, 0.008),
    );
    Files::of_text("incident", text)
}

/// A thin cylinder along a direction.
fn rod(place: [f32; 3], direction: Vector3) -> String {
    let side = direction.cross(if direction.y.abs() < 0.9 {
        Vector3::new(0.0, 1.0, 0.0)
    } else {
        Vector3::new(1.0, 0.0, 0.0)
    });
    let side = side / side.length();
    let other = direction.cross(side);
    let columns = [side, other, direction].map(|v| [v.x, v.y, v.z]);
    let cylinder =
        "Shape \"cylinder\" \"float radius\" [ 0.0022 ] \"float zmin\" [ 0 ] \"float zmax\" [ 0.22 ]";
    placed(place, columns[0], columns[1], columns[2], cylinder)
}

/// Pixels of the picture of all directions.
const RESOLUTION: [u32; 2] = [64, 64];

/// Directions in proportion to radiance times cosine: a picture of all directions is rendered at the point, and its pixels
/// are drawn by their weights, systematically, each at a random place within.
fn directions(settings: &Settings, [x, _, z]: [f32; 3]) -> Vec<Vector3> {
    let text = BOX
        .replace(LOOK_AT, &format!("Translate {} -0.0005 {}", -x, -z))
        .replace(CAMERA, "Camera \"spherical\" \"string mapping\" \"equirectangular\"");
    let study = StudyScene::of_text("incident", &text).with_resolution(RESOLUTION);
    let estimator = Estimator::of_sampler(SamplerChoice::Sobol);
    let images = estimator.images(&study, u64::from(settings.count("seed")), &[settings.count("samples")]);
    let pixels = images.first().and_then(Image::rgb_pixels).unwrap_or_default();
    // Rows are equal steps of the angle from the zenith; of light from below, none passes the floor.
    let theta = |row: f32| PI * row / RESOLUTION[1] as f32;
    let weight = |(index, [r, g, b]): (usize, [f32; 3])| {
        let (sine, cosine) = theta((index / RESOLUTION[0] as usize) as f32 + 0.5).sin_cos();
        f64::from((r + g + b).max(0.0) * sine * cosine.max(0.0))
    };
    let weights: Vec<f64> = pixels.into_iter().enumerate().map(weight).collect();
    let mut rng = Rng::new(u64::from(settings.count("seed")), 31);
    let n = settings.count("photons");
    let step = weights.iter().sum::<f64>() / f64::from(n);
    let mut next = step * rng.next_f64();
    let mut before = 0.0;
    let mut directions = Vec::new();
    for (index, weight) in weights.into_iter().enumerate() {
        while step > 0.0 && before + weight > next && directions.len() < n as usize {
            let [column, row] = [index % RESOLUTION[0] as usize, index / RESOLUTION[0] as usize]
                .map(|k| k as f32 + rng.next_f32());
            let (sine, cosine) = theta(row).sin_cos();
            let (sin_phi, cos_phi) = (TAU * column / RESOLUTION[0] as f32).sin_cos();
            directions.push(Vector3::new(sine * cos_phi, cosine, sine * sin_phi));
            next += step;
        }
        before += weight;
    }
    directions
}
