//! A car under an evenly white sky (SPEC SCENE-9, EXP-24).

use std::f32::consts::TAU;

use etendue_math::Point3;
use etendue_scene::LoadedMesh;

use super::mesh::{Grid, split};
use super::settings::count;
use super::text::{Frame, quad, revolved};
use super::{Files, Generator, Settings};

/// The car.
pub(super) const GENERATOR: Generator = Generator {
    name: "car",
    id: "SCENE-9",
    doc: "a car under a constant sky: little noise with 100 paths for each pixel",
    parameters: &[count("detail", "192", [16, 1024], "cells of the body along and around")],
    generate,
};

/// A cross-section of the body: place along the car, half its width, height of its bottom and of its top.
type Station = [f32; 4];

/// From the tail to the nose, which points along x.
const BODY: [Station; 13] = [
    [-2.24, 0.01, 0.52, 0.54],
    [-2.22, 0.34, 0.42, 0.66],
    [-2.12, 0.58, 0.34, 0.76],
    [-1.85, 0.74, 0.26, 0.86],
    [-1.3, 0.82, 0.2, 0.92],
    [-0.5, 0.82, 0.17, 0.9],
    [0.3, 0.8, 0.17, 0.88],
    [1.0, 0.81, 0.18, 0.88],
    [1.5, 0.78, 0.2, 0.82],
    [1.95, 0.62, 0.25, 0.7],
    [2.15, 0.44, 0.31, 0.6],
    [2.24, 0.24, 0.37, 0.53],
    [2.26, 0.01, 0.44, 0.46],
];

/// The cabin: its bottom is inside the body.
const CABIN: [Station; 9] = [
    [-2.0, 0.05, 0.6, 0.8],
    [-1.75, 0.46, 0.6, 0.96],
    [-1.3, 0.6, 0.6, 1.12],
    [-0.8, 0.64, 0.6, 1.24],
    [-0.3, 0.64, 0.6, 1.27],
    [0.1, 0.63, 0.6, 1.2],
    [0.4, 0.62, 0.6, 1.05],
    [0.7, 0.58, 0.6, 0.88],
    [0.85, 0.4, 0.6, 0.75],
];

/// A surface around stations, closed at its ends by their narrowness; cross-sections are superellipses, round for an
/// exponent of 2 and ever more rectangular above.
fn loft(stations: &[Station], exponent: f32, n: u32) -> LoadedMesh {
    let column = |k: usize| -> Vec<[f32; 2]> {
        let points: Vec<[f32; 2]> = (0..).zip(stations).map(|(i, s)| [i as f32, s[k]]).collect();
        spline(&points, n.div_ceil(stations.len() as u32 - 1))
    };
    let [x, width, bottom, top] = [0, 1, 2, 3].map(column);
    let n_along = x.len() as u32 - 1;
    let power = |c: f32| c.signum() * c.abs().powf(2.0 / exponent);
    Grid::tube([n, n_along]).mesh(|u, v| {
        let i = (v * n_along as f32).round() as usize;
        let (sine, cosine) = (TAU * u).sin_cos();
        let middle = 0.5 * (bottom[i][1] + top[i][1]);
        let y = middle + power(sine) * (top[i][1] - middle);
        // Sides lean inwards towards the top.
        let lean = 1.0 - 0.12 * ((y - middle) / (top[i][1] - bottom[i][1])).max(0.0);
        Point3::new(x[i][1], y, power(cosine) * width[i][1].max(0.0) * lean)
    })
}

/// Whether a point of the cabin lies in a window: below the roof, and not in one of the pillars.
fn is_window(p: Point3) -> bool {
    let windscreen = p.x > 0.12 && p.z.abs() < 0.52;
    let rear = p.x < -1.2 && p.z.abs() < 0.4;
    let side = (-1.15..-0.02).contains(&p.x) && p.y > 0.93 && p.y < 1.13 && (p.x + 0.55).abs() > 0.03;
    windscreen || rear || side
}

/// Contours of a wheel about its axis, as (radius, place along it).
const TYRE: [[f32; 2]; 9] = [
    [0.21, -0.09],
    [0.25, -0.105],
    [0.3, -0.105],
    [0.325, -0.085],
    [0.33, 0.0],
    [0.325, 0.085],
    [0.3, 0.105],
    [0.25, 0.105],
    [0.21, 0.09],
];
const RIM: [[f32; 2]; 8] = [
    [0.215, 0.085],
    [0.21, 0.1],
    [0.195, 0.095],
    [0.18, 0.06],
    [0.1, 0.05],
    [0.06, 0.07],
    [0.04, 0.095],
    [0.0, 0.1],
];

fn generate(settings: &Settings) -> Files {
    let n = settings.count("detail");
    let frame =
        Frame { name: "car", resolution: [800, 450], exposure_s: 0.00018, samples: 100, max_depth: 12 };
    let mut wheels = String::new();
    for (x, side) in [-1.32, 1.38].into_iter().flat_map(|x| [(x, 1.0), (x, -1.0)]) {
        // The outer side of the wheel looks along z before it is turned.
        let turn = 90.0 - 90.0 * side;
        let z = 0.73 * side;
        wheels.push_str(&format!(
            "AttributeBegin\n  Translate {x} 0.33 {z}\n  Rotate {turn} 1 0 0\n  ObjectInstance \"wheel\"\nAttributeEnd\n"
        ));
    }
    let text = format!(
        r#"# A car under a constant white sky (SPEC SCENE-9, EXP-24). Light comes from everywhere, so that 100 paths for each pixel
# leave little noise.
#
# Lengths are in metres; y points up. The car is 4.5 long and its nose points along x; body and cabin are smooth surfaces
# around a dozen cross-sections. The sky gives 20 000 lux on the ground.

LookAt 4.6 1.55 -4.9   0.25 0.5 0   0 1 0
Camera "perspective" "float fov" [ 29 ]
{frame}
WorldBegin

LightSource "infinite" "float illuminance" [ 20000 ]

Material "diffuse" "rgb reflectance" [ 0.45 0.45 0.45 ]
{ground}
Material "coateddiffuse" "rgb reflectance" [ 0.02 0.1 0.04 ] "float roughness" [ 0.01 ]
Shape "plymesh" "string filename" "car-body.ply"
Shape "plymesh" "string filename" "car-cabin.ply"
# Windows, dark as an interior looks from outside.
Material "coateddiffuse" "rgb reflectance" [ 0.015 0.015 0.018 ] "float roughness" [ 0.001 ]
Shape "plymesh" "string filename" "car-windows.ply"

MakeNamedMaterial "rubber" "string type" "diffuse" "rgb reflectance" [ 0.03 0.03 0.03 ]
MakeNamedMaterial "chrome" "string type" "conductor" "spectrum eta" "metal-Al-eta" "spectrum k" "metal-Al-k"
  "float roughness" [ 0.02 ]
ObjectBegin "wheel"
  NamedMaterial "rubber"
  {tyre}  # The wheel's arch.
  Shape "disk" "float radius" [ 0.4 ] "float height" [ 0.088 ]
  NamedMaterial "chrome"
  {rim}ObjectEnd
{wheels}
# Headlights, mouth and bumpers.
NamedMaterial "chrome"
AttributeBegin
  Translate 1.83 0.62 0.46
  Scale 0.2 0.085 0.1
  Shape "sphere"
AttributeEnd
AttributeBegin
  Translate 1.83 0.62 -0.46
  Scale 0.2 0.085 0.1
  Shape "sphere"
AttributeEnd
AttributeBegin
  Translate 2.12 0.36 0
  Scale 0.16 0.035 0.52
  Shape "sphere"
AttributeEnd
AttributeBegin
  Translate -2.12 0.42 0
  Scale 0.16 0.04 0.62
  Shape "sphere"
AttributeEnd
NamedMaterial "rubber"
AttributeBegin
  Translate 2.19 0.47 0
  Scale 0.09 0.055 0.22
  Shape "sphere"
AttributeEnd
"#,
        frame = frame.text(),
        tyre = revolved(&TYRE),
        rim = revolved(&RIM),
        ground = quad([-60.0, 0.0, -60.0], [60.0, 0.0, -60.0], [-60.0, 0.0, 60.0], [60.0, 0.0, 60.0]),
    );
    let cabin = loft(&CABIN, 2.6, n);
    let (windows, roof) = split(&cabin, is_window);
    Files::of_text("car", text)
        .with_mesh("car-body", &loft(&BODY, 2.7, n))
        .with_mesh("car-cabin", &roof)
        .with_mesh("car-windows", &windows)
}

/// Points on a smooth curve through the given ones, `n` from each to the next: Catmull and Rom's, centripetal
/// (Yuksel, Schaefer and Keyser 2011), which has no loops. Points that are given twice make corners.
fn spline(points: &[[f32; 2]], n: u32) -> Vec<[f32; 2]> {
    let at = |i: isize| points[i.clamp(0, points.len() as isize - 1) as usize];
    let mut curve = Vec::new();
    for i in 0..points.len() as isize - 1 {
        let corners = [at(i - 1), at(i), at(i + 1), at(i + 2)];
        if distance(corners[1], corners[2]) > 0.0 {
            curve.extend((0..n).map(|k| centripetal(corners, k as f32 / n as f32)));
        }
    }
    curve.extend(points.last());
    curve
}

fn distance(a: [f32; 2], b: [f32; 2]) -> f32 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The curve between the second and the third point, by the pyramid of Barry and Goldman (1988).
fn centripetal(points: [[f32; 2]; 4], t: f32) -> [f32; 2] {
    let [a, b, c, d] = points;
    // A point that is given twice has a knot of its own all the same.
    let step = |p: [f32; 2], q: [f32; 2]| distance(p, q).sqrt().max(1e-6);
    let t1 = step(a, b);
    let t2 = t1 + step(b, c);
    let t3 = t2 + step(c, d);
    let t = t1 + t * (t2 - t1);
    let mix = |p: [f32; 2], q: [f32; 2], t0: f32, t1: f32| {
        let w = (t - t0) / (t1 - t0);
        [p[0] + w * (q[0] - p[0]), p[1] + w * (q[1] - p[1])]
    };
    let (ab, bc, cd) = (mix(a, b, 0.0, t1), mix(b, c, t1, t2), mix(c, d, t2, t3));
    mix(mix(ab, bc, 0.0, t2), mix(bc, cd, t1, t3), t1, t2)
}
