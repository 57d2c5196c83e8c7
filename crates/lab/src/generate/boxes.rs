//! The standard box with other surfaces: fractal walls, water.

use std::f32::consts::TAU;

use etendue_math::{Point3, Rng};
use etendue_scene::LoadedMesh;

use super::mesh::Grid;
use super::settings::{SEED, count, number};
use super::text::{Frame, placed, quad, sphere};
use super::{Files, Generator, Settings};

/// The box with fractal walls (SPEC SCENE-11).
pub(super) const FRACTAL: Generator = Generator {
    name: "fractal-box",
    id: "SCENE-11",
    doc: "the box with walls of one fractal surface, 1.7 million triangles by 13 instances",
    parameters: &[
        count("levels", "8", [1, 12], "steps of subdivision: the surface has 2 * 4^levels triangles"),
        number("height", "0.1", [0.0, 0.3], "m", "by which the middles of edges move"),
        number("hurst", "0.75", [0.1, 1.0], "", "smoothness: each step is 2^-hurst times the one before"),
        SEED,
    ],
    generate: fractal_box,
};

/// The box with water (SPEC SCENE-12).
pub(super) const WATER: Generator = Generator {
    name: "water-box",
    id: "SCENE-12",
    doc: "the box half full of water with waves, a surface of 20 000 triangles",
    parameters: &[
        count("cells", "100", [2, 2000], "cells along each side of the surface, of two triangles each"),
        number("height", "0.02", [0.0, 0.1], "m", "of the waves, roughly"),
        SEED,
    ],
    generate: water_box,
};

/// Materials, camera and film of the standard box.
fn start(name: &str, look_at: &str, exposure_s: f32, max_depth: u32) -> String {
    let frame = Frame { name, resolution: [512, 512], exposure_s, samples: 256, max_depth }.text();
    format!(
        r#"LookAt {look_at}   0 1 0
Camera "perspective" "float fov" [ 45 ]
{frame}
WorldBegin

MakeNamedMaterial "white" "string type" "diffuse" "rgb reflectance" [ 0.75 0.73 0.7 ]
MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [ 0.64 0.08 0.05 ]
MakeNamedMaterial "green" "string type" "diffuse" "rgb reflectance" [ 0.11 0.42 0.22 ]
MakeNamedMaterial "silver" "string type" "conductor" "spectrum eta" "metal-Ag-eta" "spectrum k" "metal-Ag-k"
"#
    )
}

fn lamp(y: f32) -> String {
    let lamp = quad([-0.5, y, -0.3], [0.5, y, -0.3], [-0.5, y, 0.7], [0.5, y, 0.7]);
    format!(
        "AttributeBegin\n  NamedMaterial \"white\"\n  AreaLightSource \"diffuse\" \"float power\" [ 1500 ]\n  {lamp}AttributeEnd\n"
    )
}

fn fractal_box(settings: &Settings) -> Files {
    let (levels, height) = (settings.count("levels"), settings.number("height"));
    let (hurst, seed) = (settings.number("hurst"), settings.count("seed"));
    let n_stored = 2_usize << (2 * levels);
    let n_triangles = 13 * n_stored;
    // A tile from its corner along two sides, with the direction of its peaks.
    let tile = |corner: [f32; 3], u: [f32; 3], v: [f32; 3], peaks: [f32; 3]| {
        placed(corner, u, v, peaks, "ObjectInstance \"wall\"")
    };
    let third = 4.0 / 3.0;
    let along = |k: u32| -3.0 + third * k as f32;
    let row = |tile_at: &dyn Fn(f32) -> String| (0..3).map(|k| tile_at(along(k))).collect::<String>();
    let across = [2.0, 0.0, 0.0];
    let (deep, high) = ([0.0, 0.0, third], [0.0, 1.9, 0.0]);
    let surface = format!(
        "Shape \"fractal\" \"point3 P\" [ 0 0 0  1 0 0  1 1 0  0 1 0 ] \"integer indices\" [ 0 1 2  0 2 3 ]\n    \
         \"integer levels\" [ {levels} ] \"float amplitude\" [ {height} ] \"float hurst\" [ {hurst} ] \"integer seed\" [ {seed} ]\n"
    );
    let text = format!(
        r#"# The standard box with fractal walls: one surface of {n_stored} triangles, thirteen times; {n_triangles} elements in sight
# (SPEC SCENE-11).
#
# Lengths are in metres, as in the standard box. The surface is made by {levels} steps of midpoint subdivision; its border is
# flat, so that the tiles join. The balls float a little above the floor, and the lamp hangs below the ceiling.

{start}
# Objects have the material that is current where they are defined.
{walls}# The wall behind the camera.
NamedMaterial "white"
{front}
NamedMaterial "silver"
{mirror}
Material "dielectric" "float eta" [ 1.5 ]
{glass}
{lamp}"#,
        start = start("fractal-box", "0 0.9 -2.8   0 0.9 0", 0.014, 16),
        walls = [
            (
                "white",
                row(&|z| tile([-1.0, 0.0, z], across, deep, [0.0, 1.0, 0.0]))
                    + &row(&|z| tile([-1.0, 1.9, z], across, deep, [0.0, -1.0, 0.0]))
                    + &tile([-1.0, 0.0, 1.0], across, high, [0.0, 0.0, -1.0]),
            ),
            ("red", row(&|z| tile([-1.0, 0.0, z], deep, high, [1.0, 0.0, 0.0]))),
            ("green", row(&|z| tile([1.0, 0.0, z], deep, high, [-1.0, 0.0, 0.0]))),
        ]
        .map(|(color, tiles)| {
            let tiles = tiles.replace("\"wall\"", &format!("\"{color} wall\""));
            format!(
                "NamedMaterial \"{color}\"\nObjectBegin \"{color} wall\"\n  {surface}ObjectEnd\n{tiles}\n"
            )
        })
        .concat(),
        front = quad([-1.0, 0.0, -3.0], [1.0, 0.0, -3.0], [-1.0, 1.9, -3.0], [1.0, 1.9, -3.0]),
        mirror = sphere([-0.42, 0.56, 0.3], 0.42),
        glass = sphere([0.42, 0.52, -0.2], 0.36),
        lamp = lamp(1.7),
    );
    Files::of_text("fractal-box", text)
}

fn water_box(settings: &Settings) -> Files {
    let surface = waves(settings.count("cells"), settings.number("height"), settings.count("seed"));
    let side = |x: f32| quad([x, 0.0, -3.0], [x, 0.0, 1.0], [x, 1.9, -3.0], [x, 1.9, 1.0]);
    let level = |y: f32| quad([-1.0, y, -3.0], [1.0, y, -3.0], [-1.0, y, 1.0], [1.0, y, 1.0]);
    let facing = |z: f32| quad([-1.0, 0.0, z], [1.0, 0.0, z], [-1.0, 1.9, z], [1.0, 1.9, z]);
    let text = format!(
        r#"# The standard box half full of water with waves, and the caustics below (SPEC SCENE-12). The notebook has 500 000 photons
# in each map and up to 100 of them in an estimate.
#
# Lengths are in metres, as in the standard box. The water stands {WATER_LEVEL} high; its surface has {n} triangles. The mirror
# ball is half in it; the glass ball is under water, and its material knows that.

{start}
NamedMaterial "white"
{floor}{ceiling}{back}{front}NamedMaterial "red"
{left}NamedMaterial "green"
{right}
Material "dielectric" "float eta" [ 1.333 ] "rgb absorption" [ 0.4 0.1 0.06 ]
Shape "plymesh" "string filename" "water-box.ply"

NamedMaterial "silver"
{mirror}
Material "dielectric" "float eta" [ 1.5 ] "float eta_exterior" [ 1.333 ] "rgb absorption_exterior" [ 0.4 0.1 0.06 ]
{glass}
{lamp}"#,
        n = surface.triangles.len(),
        start = start("water-box", "0 1.45 -2.7   0 0.72 0", 0.014, 24),
        floor = level(0.0),
        ceiling = level(1.9),
        back = facing(1.0),
        front = facing(-3.0),
        left = side(-1.0),
        right = side(1.0),
        mirror = sphere([-0.46, 0.42, 0.3], 0.42),
        glass = sphere([0.4, 0.22, -0.25], 0.22),
        lamp = lamp(1.895),
    );
    Files::of_text("water-box", text).with_mesh("water-box", &surface)
}

const WATER_LEVEL: f32 = 0.55;

/// Two dozen sine waves of random directions; the longer the wave the higher.
fn waves(n: u32, height: f32, seed: u32) -> LoadedMesh {
    let mut rng = Rng::new(u64::from(seed), 0);
    let waves: Vec<[f32; 4]> = (0..24)
        .map(|_| {
            let length = 0.15 + 0.6 * rng.next_f32();
            let (sine, cosine) = (TAU * rng.next_f32()).sin_cos();
            [TAU / length * cosine, TAU / length * sine, TAU * rng.next_f32(), 0.35 * height * length]
        })
        .collect();
    // The normals point upwards, out of the water.
    Grid::sheet([n; 2]).mesh(|u, v| {
        let (x, z) = (2.0 * v - 1.0, 4.0 * u - 3.0);
        let swell: f32 = waves.iter().map(|[kx, kz, phase, a]| a * (kx * x + kz * z + phase).sin()).sum();
        Point3::new(x, WATER_LEVEL + swell, z)
    })
}
