//! The cognac glass on sand (SPEC SCENE-19, 20 and 28, appendix C): three interfaces with both of their sides known, and
//! absorption in the liquid (SPEC FRES-11, FRES-12).

use etendue_math::Point3;
use etendue_scene::LoadedMesh;

use super::mesh::Grid;
use super::noise::{fractal_noise, value_noise};
use super::settings::{Knob, SEED, count, number};
use super::text::{Frame, quad, sphere};
use super::{Files, Generator, Settings};

/// The glass on sand.
pub(super) const COGNAC: Generator = Generator {
    name: "cognac",
    id: "SCENE-19",
    doc: "a glass of cognac on sand of 2^21 triangles, and its red caustic",
    parameters: KNOBS,
    generate: |settings| generate(settings, &View::WHOLE),
};

/// Its caustic from near by.
pub(super) const CLOSEUP: Generator = Generator {
    name: "cognac-closeup",
    id: "SCENE-20",
    doc: "the caustic of the cognac glass from near by",
    parameters: KNOBS,
    generate: |settings| generate(settings, &View::CLOSEUP),
};

/// The glass under a wider lamp, whose penumbra is to be found.
pub(super) const PENUMBRA: Generator = Generator {
    name: "cognac-penumbra",
    id: "SCENE-28",
    doc: "the cognac glass under a square lamp, whose penumbra shadow photons find",
    parameters: KNOBS,
    generate: |settings| generate(settings, &View::PENUMBRA),
};

const KNOBS: &[Knob] = &[
    count("cells", "1024", [2, 4096], "cells along each side of the sand, of two triangles each"),
    number("lamp-radius", "0.03", [1e-3, 0.1], "m", "of the round lamp"),
    SEED,
];

/// What differs between the scenes.
struct View {
    name: &'static str,
    look_at: &'static str,
    fov: f32,
    has_square_lamp: bool,
}

impl View {
    const WHOLE: Self =
        Self { name: "cognac", look_at: "0.02 0.19 -0.4   0.03 0.032 0", fov: 27.0, has_square_lamp: false };
    const CLOSEUP: Self = Self {
        name: "cognac-closeup",
        look_at: "0.09 0.12 -0.19   0.1 0.0 -0.03",
        fov: 30.0,
        has_square_lamp: false,
    };
    const PENUMBRA: Self = Self { name: "cognac-penumbra", has_square_lamp: true, ..Self::WHOLE };
}

/// Where the lamp is.
const LAMP: [f32; 3] = [-0.32, 0.36, 0.16];

fn generate(settings: &Settings, view: &View) -> Files {
    let View { name, look_at, fov, .. } = view;
    let frame = Frame { name, resolution: [640, 480], exposure_s: 0.009, samples: 1024, max_depth: 24 };
    let lamp = if view.has_square_lamp {
        let [x, y, z] = LAMP;
        quad([x, y, z - 0.06], [x, y, z + 0.06], [x + 0.1, y + 0.06, z - 0.06], [x + 0.1, y + 0.06, z + 0.06])
    } else {
        sphere(LAMP, settings.number("lamp-radius"))
    };
    let sand = sand(settings.count("cells"), settings.count("seed"));
    let text = format!(
        r#"# A glass of cognac on sand ({id}). The notebook has about 350 000 caustic photons for it, and 33 994 photons of which 492
# carry shadow for the penumbra.
#
# Three interfaces, none of them double: glass and air, glass and cognac, cognac and air. Each material knows what is on both
# of its sides: the normals of the inner bowl look into the cognac, which is its exterior. Contours: `cognac-glass.csv`.
#
# Lengths are in metres; x grows to the right, y upwards, z into the picture. The glass is 10.7 cm high and stands at the
# origin; the sand is 0.7 x 0.7 and of {n_sand} triangles.

LookAt {look_at}   0 1 0
Camera "perspective" "float fov" [ {fov} ]
{frame}
WorldBegin

LightSource "infinite" "float illuminance" [ 30 ] "rgb L" [ 0.7 0.8 1 ]

Texture "sand" "spectrum" "imagemap" "string filename" "cognac-sand.ppm"
Material "schlick" "texture reflectance" [ "sand" ] "float roughness" [ 0.6 ]
Shape "plymesh" "string filename" "cognac-sand.ply"

# Index 1.5 inside of the glass; cognac has 1.36 and absorbs green and blue. Tolerances are in proportion to the largest
# radii, so that all three have as many corners around and meet in the same ones.
AttributeBegin
  Rotate -90 1 0 0
  Scale 0.01 0.01 0.01
  Material "dielectric" "float eta" [ 1.5 ]
  Shape "revolution" "string filename" "cognac-glass.csv" "string profile" "glass-air" "float tolerance" [ 0.0008 ]
  Material "dielectric" "float eta" [ 1.5 ] "float eta_exterior" [ 1.36 ] "rgb absorption_exterior" [ 6 30 100 ]
  Shape "revolution" "string filename" "cognac-glass.csv" "string profile" "glass-cognac" "float tolerance" [ 0.00076 ]
  Material "dielectric" "float eta" [ 1.36 ] "rgb absorption" [ 6 30 100 ]
  Shape "revolution" "string filename" "cognac-glass.csv" "string profile" "cognac-air" "float tolerance" [ 0.00076 ]
AttributeEnd

AttributeBegin
  Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  AreaLightSource "diffuse" "float power" [ 600 ] "bool twosided" {two_sided}
  {lamp}AttributeEnd
"#,
        id = match view.name {
            "cognac" => "SPEC SCENE-19",
            "cognac-closeup" => "SPEC SCENE-20: its caustic, through several layers",
            _ => "SPEC SCENE-28",
        },
        n_sand = sand.triangles.len(),
        frame = frame.text(),
        two_sided = view.has_square_lamp,
    );
    Files::of_text(name, text)
        .with_bytes("cognac-glass.csv", CSV.as_bytes().to_vec())
        .with_mesh("cognac-sand", &sand)
        .with_bytes("cognac-sand.ppm", sand_picture(settings.count("seed")))
}

const CSV: &str = include_str!("../../data/cognac-glass.csv");

/// Wavy sand with grains, flat below the glass.
fn sand(n: u32, seed: u32) -> LoadedMesh {
    // The normals point upwards.
    Grid::sheet([n; 2]).mesh(|u, v| {
        let (x, z) = (0.7 * (v - 0.5), 0.7 * (u - 0.5));
        let bend = 0.05 * (value_noise([8.0 * x, 8.0 * z], seed) - 0.5);
        let ripple = ((x + 0.35 * z + bend) * 150.0).sin();
        let grains = fractal_noise([x / 0.002, z / 0.002], 2, seed + 1);
        let dunes = fractal_noise([x / 0.12, z / 0.12], 3, seed + 2);
        let away = ((x.hypot(z) - 0.03) / 0.04).clamp(0.0, 1.0);
        let height = away * (0.0022 * ripple + 0.008 * dunes) + 0.0007 * grains - 0.0008;
        Point3::new(x, height, z)
    })
}

/// Grains of several colours, in sRGB.
fn sand_picture(seed: u32) -> Vec<u8> {
    let n = 512;
    let mut picture = format!("P6\n{n} {n}\n255\n").into_bytes();
    for (row, column) in (0..n).flat_map(|row| (0..n).map(move |column| (row, column))) {
        let p = [column as f32, row as f32];
        let grain = 0.55 + 0.45 * value_noise(p, seed + 3);
        let tint = value_noise(p.map(|x| 0.7 * x), seed + 4);
        let color = [225.0, 198.0 - 14.0 * tint, 160.0 - 40.0 * tint];
        picture.extend(color.map(|level: f32| (level * grain.powf(0.4)) as u8));
    }
    picture
}
