//! Caustics of metal and glass that the notebook draws: a ring, and a prism.

use super::settings::number;
use super::text::{Frame, quad, sphere};
use super::{Files, Generator, Settings};

/// A metal ring on a table (SPEC SCENE-16).
pub(super) const RING: Generator = Generator {
    name: "ring",
    id: "SCENE-16",
    doc: "a metal ring on a table: the caustic inside is a nephroid, or a cardioid for a lamp on the rim",
    parameters: &[
        number(
            "distance",
            "6",
            [1.0, 100.0],
            "m",
            "of the lamp from the middle; 1.2208 at 35 degrees is above the rim",
        ),
        number("elevation", "35", [5.0, 80.0], "degrees", "of the lamp, seen from the middle"),
        number("lamp-size", "0.05", [0.001, 0.2], "", "radius of the lamp as a share of its distance"),
    ],
    generate: ring,
};

/// A prism (SPEC SCENE-17).
pub(super) const PRISM: Generator = Generator {
    name: "prism",
    id: "SCENE-17",
    doc: "a prism draws a narrow lamp out into a spectrum: seen through it and, as prism-screen, on a screen",
    parameters: &[],
    generate: prism,
};

fn ring(settings: &Settings) -> Files {
    let (distance, size) = (settings.number("distance"), settings.number("lamp-size"));
    let (sine, cosine) = settings.number("elevation").to_radians().sin_cos();
    let [y, z] = [distance * cosine, distance * sine];
    let frame =
        Frame { name: "ring", resolution: [512, 512], exposure_s: 0.007, samples: 1024, max_depth: 8 };
    let text = format!(
        r#"# A ring of gold on a table, and the caustic of its inner side (SPEC SCENE-16). Seen from above, parallel light gives
# the nephroid with a cusp half way to the middle: the envelope of the rays that a circle reflects. Light from a point of the
# rim gives the cardioid.
#
# Lengths are in metres; z points up.
#   ring    inner radius 1, outer radius 1.06, height 0.45
#   lamp    a ball at distance {distance} whose radius is {size} of that; {power} lumen

LookAt 0 -1.9 3.9   0 -0.06 0   0 0 1
Camera "perspective" "float fov" [ 36 ]
{frame}
WorldBegin

LightSource "infinite" "float illuminance" [ 40 ]

Material "diffuse" "rgb reflectance" [ 0.7 0.66 0.6 ]
{table}
Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" "float roughness" [ 0 ]
Shape "cylinder" "float radius" [ 1 ] "float zmin" [ 0 ] "float zmax" [ 0.45 ]
Shape "cylinder" "float radius" [ 1.06 ] "float zmin" [ 0 ] "float zmax" [ 0.45 ]
Shape "disk" "float radius" [ 1.06 ] "float innerradius" [ 1 ] "float height" [ 0.45 ]

AttributeBegin
  Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  AreaLightSource "diffuse" "float power" [ {power} ]
  {lamp}AttributeEnd
"#,
        power = 3000.0 * distance * distance,
        frame = frame.text(),
        table = quad([-5.0, -5.0, 0.0], [5.0, -5.0, 0.0], [-5.0, 5.0, 0.0], [5.0, 5.0, 0.0]),
        lamp = sphere([0.0, y, z], size * distance),
    );
    Files::of_text("ring", text)
}

const PRISM_TEXT: &str = include_str!("../../../../scenes/prism.pbrt");

/// The prism itself, which ends the file.
const PRISM_START: &str = "# Corners are at the bottom";

fn prism(_: &Settings) -> Files {
    let start = PRISM_TEXT.find(PRISM_START).unwrap_or(0);
    Files::of_text("prism", PRISM_TEXT).with_text("prism-screen", prism_screen(&PRISM_TEXT[start..]))
}

/// The same prism and lamp, with a slit before the prism and a screen where the other file has its camera.
fn prism_screen(prism: &str) -> String {
    let frame = Frame {
        name: "prism-screen",
        resolution: [320, 160],
        exposure_s: 0.02,
        samples: 16384,
        max_depth: 8,
    };
    // The ray of least deviation enters at (0.29, 0.21), as seen from above, and leaves at (-0.29, 0.21).
    let at = |[x, z]: [f32; 2], [dx, dz]: [f32; 2], along: f32, aside: f32| {
        [x + along * dx - aside * dz, z + along * dz + aside * dx]
    };
    let upright = |a: [f32; 2], b: [f32; 2], half: f32| {
        let corner = |[x, z]: [f32; 2], y: f32| [x, y, z];
        quad(corner(a, -half), corner(b, -half), corner(a, half), corner(b, half))
    };
    let entry = |along, aside| at([0.29, 0.21], [0.826, -0.565], along, aside);
    let exit = |along, aside| at([-0.29, 0.21], [-0.817, -0.576], along, aside);
    let [eye_x, eye_z] = exit(0.9, -1.3);
    let [target_x, target_z] = exit(2.0, 0.0);
    format!(
        r#"# A prism of dense flint glass throws the spectrum of a lamp onto a screen (SPEC SCENE-17).
#
# Light of a narrow lamp passes a slit and the prism; the screen stands 2 m behind. Paths from the camera hardly ever find the
# lamp; --integrator light:maxdepth=8 and photons do. The notebook has three indices, for red, green and blue: --wavelengths bands.
#
# Lengths are in metres; y points up.
#   lamp     0.04 wide, 1.2 high, 3 m from the prism, 20 000 lumen
#   slit     0.03 wide, 0.8 m from the prism

LookAt {eye_x} 0.5 {eye_z}   {target_x} 0 {target_z}   0 1 0
Camera "perspective" "float fov" [ 40 ]
{frame}
WorldBegin

AttributeBegin
  Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  AreaLightSource "diffuse" "float power" [ 20000 ] "bool twosided" true
  {lamp}AttributeEnd

# The slit's two plates.
Material "diffuse" "rgb reflectance" [ 0.05 0.05 0.05 ]
{plates}
Material "diffuse" "rgb reflectance" [ 0.8 0.8 0.8 ]
{screen}
{prism}"#,
        frame = frame.text(),
        lamp = upright(entry(3.0, -0.02), entry(3.0, 0.02), 0.6),
        plates = upright(entry(0.8, -5.0), entry(0.8, -0.015), 4.0)
            + &upright(entry(0.8, 0.015), entry(0.8, 5.0), 4.0),
        screen = upright(exit(2.0, -0.8), exit(2.0, 0.8), 0.4),
    )
}
