//! Glass on tables: caustics, and caustics seen through glass and mirrors.

use std::f32::consts::TAU;

use etendue_math::Rng;

use super::noise::value_noise;
use super::settings::{SEED, count, number};
use super::text::{Frame, cuboid, quad, revolved, sphere};
use super::{Files, Generator, Settings};

/// A wine glass on a table, before a mirror (SPEC SCENE-6).
pub(super) const WINEGLASS: Generator = Generator {
    name: "wineglass",
    id: "SCENE-6",
    doc: "the caustic of a wine glass, seen through its foot and in a mirror",
    parameters: &[number(
        "lamp-radius",
        "0.04",
        [1e-4, 0.1],
        "m",
        "of the lamp; the figure has a point, which only photons can show",
    )],
    generate: wineglass,
};

/// A glass ball on a wooden table (SPEC SCENE-10).
pub(super) const WOOD_BALL: Generator = Generator {
    name: "wood-ball",
    id: "SCENE-10",
    doc: "a glass ball on a wooden table, and the caustic below it",
    parameters: &[
        number("lamp-radius", "0.12", [1e-3, 0.3], "m", "of the lamp"),
        count("pixels", "512", [16, 4096], "pixels along a side of the picture of wood"),
        SEED,
    ],
    generate: wood_ball,
};

/// A lens above a cube (SPEC SCENE-21).
pub(super) const LENS: Generator = Generator {
    name: "lens",
    id: "SCENE-21",
    doc: "a lens throws a caustic onto a cube",
    parameters: &[number("lamp-radius", "0.1", [1e-3, 0.5], "m", "of the lamp")],
    generate: lens,
};

/// Contour of a wine glass of height 0.18, from the middle of the underside around the rim to the middle of the bowl.
const WINEGLASS_CONTOUR: [[f32; 2]; 24] = [
    [0.0, 0.0015],
    [0.015, 0.001],
    [0.03, 0.0],
    [0.0335, 0.0006],
    [0.034, 0.0014],
    [0.033, 0.0024],
    [0.024, 0.0045],
    [0.012, 0.008],
    [0.0055, 0.014],
    [0.0038, 0.03],
    [0.0036, 0.055],
    [0.0045, 0.075],
    [0.009, 0.083],
    [0.024, 0.094],
    [0.036, 0.115],
    [0.037, 0.14],
    [0.033, 0.165],
    [0.03, 0.18],
    [0.0292, 0.1803],
    [0.0288, 0.1795],
    [0.0318, 0.165],
    [0.0348, 0.118],
    [0.022, 0.098],
    [0.0, 0.0895],
];

fn wineglass(settings: &Settings) -> Files {
    let frame =
        Frame { name: "wineglass", resolution: [640, 480], exposure_s: 0.012, samples: 1024, max_depth: 24 };
    let text = format!(
        r#"# The caustic of a wine glass on a table, seen directly, through the foot of the glass, and in a mirror: paths with
# specular surfaces on both sides of the one matte surface, LS+DS+E (SPEC SCENE-6). A point light makes them invisible to all
# methods that start at the camera; here the lamp is a small ball.
#
# Lengths are in metres; x grows to the right, y upwards, z into the picture.
#   table    y = 0
#   glass    height 0.18, at the origin; a body of revolution of one smooth contour
#   mirror   upright at z = 0.13
#   lamp     a ball of radius {radius} at (-0.22, 0.3, -0.12), 60 lumen

LookAt 0.12 0.2 -0.42   0.02 0.065 0.02   0 1 0
Camera "perspective" "float fov" [ 34 ]
{frame}
WorldBegin

LightSource "infinite" "float illuminance" [ 12 ]

Texture "cloth" "spectrum" "checkerboard" "float uscale" [ 40 ] "float vscale" [ 40 ]
  "rgb tex1" [ 0.62 0.6 0.55 ] "rgb tex2" [ 0.5 0.47 0.42 ]
Material "diffuse" "texture reflectance" [ "cloth" ]
{table}
Material "conductor" "rgb reflectance" [ 0.92 0.92 0.92 ]
{mirror}Material "diffuse" "rgb reflectance" [ 0.2 0.12 0.07 ]
{back}
Material "dielectric" "float eta" [ 1.5 ]
AttributeBegin
  Rotate -90 1 0 0
  {glass}AttributeEnd

AttributeBegin
  Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  AreaLightSource "diffuse" "float power" [ 60 ]
  {lamp}AttributeEnd
"#,
        radius = settings.number("lamp-radius"),
        frame = frame.text(),
        table = quad([-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 1.0]),
        mirror = quad([-0.2, 0.001, 0.13], [0.2, 0.001, 0.13], [-0.2, 0.24, 0.13], [0.2, 0.24, 0.13]),
        back = cuboid([-0.21, 0.0, 0.1305], [0.21, 0.25, 0.14]),
        glass = revolved(&WINEGLASS_CONTOUR),
        lamp = sphere([-0.22, 0.3, -0.12], settings.number("lamp-radius")),
    );
    Files::of_text("wineglass", text)
}

fn wood_ball(settings: &Settings) -> Files {
    let radius = settings.number("lamp-radius");
    let frame =
        Frame { name: "wood-ball", resolution: [640, 480], exposure_s: 0.02, samples: 1024, max_depth: 12 };
    let text = format!(
        r#"# A glass ball on a wooden table, and its caustic (SPEC SCENE-10). Photons show it at once: the notebook has 100 000
# of them beside 1000 paths for each pixel, which took several hundred times as long.
#
# Lengths are in metres; x grows to the right, y upwards, z into the picture.
#   ball    radius 0.2, index 1.5, standing on the table
#   lamp    a ball of radius {radius} at (-0.75, 1.1, 0.35), 1500 lumen

LookAt 0.15 0.75 -1.15   0.1 0.08 0   0 1 0
Camera "perspective" "float fov" [ 38 ]
{frame}
WorldBegin

LightSource "infinite" "float illuminance" [ 20 ]

Texture "wood" "spectrum" "imagemap" "string filename" "wood.ppm"
Material "coateddiffuse" "texture reflectance" [ "wood" ] "float roughness" [ 0.2 ]
{table}
Material "dielectric" "float eta" [ 1.5 ]
{ball}
AttributeBegin
  Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  AreaLightSource "diffuse" "float power" [ 1500 ]
  {lamp}AttributeEnd
"#,
        frame = frame.text(),
        table = quad([-1.5, 0.0, -1.5], [1.5, 0.0, -1.5], [-1.5, 0.0, 1.5], [1.5, 0.0, 1.5]),
        ball = sphere([0.0, 0.2, 0.0], 0.2),
        lamp = sphere([-0.75, 1.1, 0.35], radius),
    );
    let picture = wood(settings.count("pixels"), settings.count("seed"));
    Files::of_text("wood-ball", text).with_bytes("wood.ppm", picture)
}

/// A picture of planks: the rings of a trunk, cut along it and bent by noise, with fine fibres.
fn wood(n: u32, seed: u32) -> Vec<u8> {
    let mut picture = format!("P6\n{n} {n}\n255\n").into_bytes();
    let n_planks = 8.0;
    for (row, column) in (0..n).flat_map(|row| (0..n).map(move |column| (row, column))) {
        let (u, v) = (column as f32 / n as f32, row as f32 / n as f32);
        let plank = (v * n_planks).floor();
        let across = v * n_planks - plank;
        let mut rng = Rng::new(u64::from(seed), plank as u64);
        let (shift, tone) = (40.0 * rng.next_f32(), 0.85 + 0.3 * rng.next_f32());
        let bend = value_noise([3.0 * u + shift, 2.0 * across + shift], seed);
        let ring = 0.5 + 0.5 * (TAU * (4.0 * (across + rng.next_f32()) + 3.0 * bend)).sin();
        let fibre = value_noise([20.0 * u + shift, 400.0 * v], seed + 1);
        let gap = if !(0.012..=0.988).contains(&across) { 0.35 } else { 1.0 };
        let shade = gap * tone * (0.72 + 0.2 * ring.powi(2) + 0.16 * (fibre - 0.5));
        let sap = [196.0, 138.0, 84.0];
        picture.extend(sap.map(|level: f32| (level * shade).clamp(0.0, 255.0) as u8));
    }
    picture
}

fn lens(settings: &Settings) -> Files {
    let radius = settings.number("lamp-radius");
    let frame =
        Frame { name: "lens", resolution: [512, 512], exposure_s: 0.02, samples: 1024, max_depth: 12 };
    // Two caps of spheres of radius 0.5 that meet at a circle of radius 0.3.
    let offset = 0.5_f32.powi(2) - 0.3_f32.powi(2);
    let offset = offset.sqrt();
    let text = format!(
        r#"# A lens above a cube: the caustic on its top shows how estimates from photons blur an edge (SPEC SCENE-21; the notebook's
# figure has 10 000 photons, without a filter and with a cone of k = 1.1).
#
# Lengths are in metres; z points up.
#   cube    side 1, its top at z = 1
#   lens    two caps of spheres of radius 0.5 and index 1.5, of diameter 0.6; its middle at z = 1.45. Its focal length is
#           0.536, so that it throws an image of the lamp to 0.77 below its middle: the caustic is a disk with a sharp edge
#   lamp    a ball of radius {radius} at z = 3.4, 4000 lumen

LookAt 1.1 -2.1 2.3   0 0 1.02   0 0 1
Camera "perspective" "float fov" [ 34 ]
{frame}
WorldBegin

LightSource "infinite" "float illuminance" [ 25 ]

Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
Shape "bilinearmesh" "point3 P" [ -6 -6 0  6 -6 0  -6 6 0  6 6 0 ]
Material "diffuse" "rgb reflectance" [ 0.75 0.72 0.66 ]
{cube}
Material "dielectric" "float eta" [ 1.5 ]
AttributeBegin
  Translate 0 0 {lower}
  Shape "sphere" "float radius" [ 0.5 ] "float zmin" [ {offset} ] "float zmax" [ 0.5 ]
AttributeEnd
AttributeBegin
  Translate 0 0 {upper}
  Shape "sphere" "float radius" [ 0.5 ] "float zmin" [ -0.5 ] "float zmax" [ -{offset} ]
AttributeEnd

AttributeBegin
  Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  AreaLightSource "diffuse" "float power" [ 4000 ]
  {lamp}AttributeEnd
"#,
        frame = frame.text(),
        cube = cuboid([-0.5, -0.5, 0.0], [0.5, 0.5, 1.0]),
        lower = 1.45 - offset,
        upper = 1.45 + offset,
        lamp = sphere([0.0, 0.0, 3.4], radius),
    );
    Files::of_text("lens", text)
}
