//! The scene of the 250-line path tracer (SPEC SCENE-1, SMALL-10), in both versions of its author.

use super::text::{Frame, quad, sphere};
use super::{Files, Generator, Settings};

/// The scene.
pub(super) const GENERATOR: Generator = Generator {
    name: "small-box",
    id: "SCENE-1",
    doc: "the room of the 250-line path tracer, with its tiny lamp and, as small-box-later, with the later large one",
    parameters: &[],
    generate,
};

/// What differs between the versions.
struct Version {
    name: &'static str,
    comment: &'static str,
    look_at: &'static str,
    /// Inner walls: bottom, back, left, right, ceiling, front, as coordinates along down, right and the view.
    mirror: ([f32; 3], f32),
    glass: ([f32; 3], f32),
    matte: ([f32; 3], f32),
    lamp: ([f32; 3], f32),
    emission: f32,
    eta: f32,
    exposure_s: f32,
    /// From right, down and towards the camera to the axes of the version.
    axes: fn(f32, f32, f32) -> [f32; 3],
}

const FIRST: Version = Version {
    name: "small-box",
    comment: "# As first published: x points down, y to the right, z towards the camera. The lamp is a ball of radius 0.1 mm and\n\
              # luminance 120 cd/m^2: 12 millionths of a lumen. Without sampling of lights (--integrator path:lights=scattering) the\n\
              # picture is black in practice (EXP-25).",
    look_at: "LookAt 0 0 0   0 0 -1   -1 0 0",
    mirror: ([1.45, -0.75, -4.4], 1.05),
    glass: ([2.05, 0.8, -3.7], 0.45),
    matte: ([1.95, -1.75, -3.1], 0.6),
    lamp: ([-1.9, 0.0, -3.0], 1e-4),
    emission: 120.0,
    eta: 1.9,
    exposure_s: 2.5e6,
    axes: |right, down, near| [down, right, near],
};

const LATER: Version = Version {
    name: "small-box-later",
    comment: "# As in the later version: y points up, z towards the camera, and the lamp is a ball of radius 0.5 m and luminance\n\
              # 10 000 cd/m^2. Two balls reach 5 cm below the floor, as its numbers have it.",
    look_at: "LookAt 0 0 0   0 0 -1   0 1 0",
    mirror: ([-0.75, -1.45, -4.4], 1.05),
    glass: ([2.0, -2.05, -3.7], 0.5),
    matte: ([-1.75, -1.95, -3.1], 0.6),
    lamp: ([0.0, 1.9, -3.0], 0.5),
    emission: 10_000.0,
    eta: 1.5,
    exposure_s: 0.0013,
    axes: |right, down, near| [right, -down, near],
};

fn generate(_: &Settings) -> Files {
    Files::of_text(FIRST.name, text(&FIRST)).with_text(LATER.name, text(&LATER))
}

fn text(version: &Version) -> String {
    let Version { name, comment, look_at, eta, exposure_s, emission, .. } = version;
    let frame =
        Frame { name, resolution: [900, 900], exposure_s: *exposure_s, samples: 64, max_depth: 20 }.text();
    // Right, down, near: the planes have distances 2.75 to each side, 2.5 below, 3 above, 5.5 ahead and 0.5 behind.
    let wall = |corners: [[f32; 3]; 4]| {
        let [a, b, c, d] = corners.map(|[right, down, near]| (version.axes)(right, down, near));
        quad(a, b, c, d)
    };
    let (right, bottom, top, back, front) = (2.75, 2.5, -3.0, -5.5, 0.5);
    let level = |y: f32| wall([[-right, y, back], [right, y, back], [-right, y, front], [right, y, front]]);
    let facing = |z: f32| wall([[-right, bottom, z], [right, bottom, z], [-right, top, z], [right, top, z]]);
    let side = |x: f32| wall([[x, bottom, back], [x, bottom, front], [x, top, back], [x, top, front]]);
    let grey = [level(bottom), level(top), facing(back), facing(front)].concat();
    let (left_wall, right_wall) = (side(-right), side(right));
    let ball = |(centre, radius): ([f32; 3], f32)| sphere(centre, radius);
    let (mirror, glass, matte, lamp) =
        (ball(version.mirror), ball(version.glass), ball(version.matte), ball(version.lamp));
    format!(
        r#"# The room of the 250-line path tracer (SPEC SCENE-1, SMALL-10), with corrected numbers (erratum L37).
#
{comment}
#
# Its six planes are walls that meet; its colours are ten times reflectances, and 12 is clamped to 10. The full angle across
# the picture is 90 degrees. Mirror and glass have no colour, as in the program.

# The camera of this format is left-handed, and that of the program is not.
Scale -1 1 1
{look_at}
Camera "perspective" "float fov" [ 90 ]

{frame}
WorldBegin

# Bottom, ceiling, back, front.
Material "diffuse" "rgb reflectance" [ 0.6 0.6 0.6 ]
{grey}
# Left and right.
Material "diffuse" "rgb reflectance" [ 1 0.2 0.2 ]
{left_wall}Material "diffuse" "rgb reflectance" [ 0.2 1 0.2 ]
{right_wall}
Material "conductor" "rgb reflectance" [ 1 1 1 ]
{mirror}
Material "dielectric" "float eta" [ {eta} ]
{glass}
Material "diffuse" "rgb reflectance" [ 0.4 0.4 1 ]
{matte}
AttributeBegin
Material "diffuse" "rgb reflectance" [ 0 0 0 ]
AreaLightSource "diffuse" "float scale" [ {emission} ]
{lamp}AttributeEnd
"#
    )
}
