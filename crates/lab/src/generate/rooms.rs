//! Rooms whose light comes by detours: what bidirectional and Metropolis methods are made for.

use super::settings::{count, number};
use super::text::{Frame, cuboid, quad, revolved, sphere};
use super::{Files, Generator, Settings};

/// A lamp that lights a spot of the ceiling alone (SPEC SCENE-4).
pub(super) const CEILING_LAMP: Generator = Generator {
    name: "ceiling-lamp",
    id: "SCENE-4",
    doc: "a shielded lamp lights a small part of the ceiling, and that the room",
    parameters: &[number(
        "depth",
        "0.25",
        [0.05, 0.6],
        "m",
        "from the rim of the lamp's shade down to its bulb",
    )],
    generate: ceiling_lamp,
};

/// A door ajar (SPEC SCENE-5).
pub(super) const DOOR: Generator = Generator {
    name: "door",
    id: "SCENE-5",
    doc: "a room lit through a door that is ajar, with three pots: matte, metal, glass",
    parameters: &[number("angle", "18", [1.0, 90.0], "degrees", "by which the door is open")],
    generate: door,
};

/// A wall with many holes (SPEC SCENE-5).
pub(super) const HOLES: Generator = Generator {
    name: "holes",
    id: "SCENE-5",
    doc: "a room lit through a wall with many small holes",
    parameters: &[count("holes", "10", [1, 64], "holes across and up")],
    generate: holes,
};

/// The inner faces of a room, white; the left wall is reddish, the right one bluish. Materials are left as they were set
/// last.
fn room(min: [f32; 3], max: [f32; 3]) -> String {
    let [x0, y0, z0] = min;
    let [x1, y1, z1] = max;
    let level = |y| quad([x0, y, z0], [x1, y, z0], [x0, y, z1], [x1, y, z1]);
    let facing = |z| quad([x0, y0, z], [x1, y0, z], [x0, y1, z], [x1, y1, z]);
    let side = |x| quad([x, y0, z0], [x, y0, z1], [x, y1, z0], [x, y1, z1]);
    let white = "Material \"diffuse\" \"rgb reflectance\" [ 0.75 0.73 0.7 ]\n";
    [
        white,
        &level(y0),
        &level(y1),
        &facing(z0),
        &facing(z1),
        "Material \"diffuse\" \"rgb reflectance\" [ 0.68 0.35 0.28 ]\n",
        &side(x0),
        "Material \"diffuse\" \"rgb reflectance\" [ 0.32 0.42 0.62 ]\n",
        &side(x1),
        white,
    ]
    .concat()
}

/// A table of legs and a top, standing on y = 0.
fn table([x0, x1]: [f32; 2], height: f32, [z0, z1]: [f32; 2]) -> String {
    let leg = |x: f32, z: f32| cuboid([x, 0.0, z], [x + 0.06, height - 0.04, z + 0.06]);
    [
        cuboid([x0, height - 0.04, z0], [x1, height, z1]),
        leg(x0 + 0.03, z0 + 0.03),
        leg(x1 - 0.09, z0 + 0.03),
        leg(x0 + 0.03, z1 - 0.09),
        leg(x1 - 0.09, z1 - 0.09),
    ]
    .concat()
}

fn ceiling_lamp(settings: &Settings) -> Files {
    let rim = 2.1;
    let bulb = rim - settings.number("depth");
    let frame =
        Frame { name: "ceiling-lamp", resolution: [640, 480], exposure_s: 0.02, samples: 256, max_depth: 24 };
    let text = format!(
        r#"# A lamp in a deep shade lights a small part of the ceiling; all other light in the room comes from there (SPEC SCENE-4).
# Paths from the camera find that spot by chance, paths from the lamp at once.
#
# Lengths are in metres; x grows to the right, y upwards, z into the picture.
#   room   x -2 to 2, y 0 to 2.6, z -2 to 2.4; closed, with the camera inside
#   lamp   a disk of radius 0.12 that shines upwards at height {bulb}, in a shade of radius 0.15 that ends at {rim};
#          10 000 lumen

LookAt 0.25 1.45 -1.95   -0.05 1.25 0   0 1 0
Camera "perspective" "float fov" [ 62 ]
{frame}
WorldBegin

{room}
# A table with a ball of glass, one of copper, and a box.
Material "diffuse" "rgb reflectance" [ 0.45 0.28 0.15 ]
{table}
Material "dielectric" "float eta" [ 1.5 ]
{glass}Material "conductor" "spectrum eta" "metal-Cu-eta" "spectrum k" "metal-Cu-k" "float roughness" [ 0.15 ]
{copper}Material "diffuse" "rgb reflectance" [ 0.25 0.5 0.3 ]
{block}
# The lamp: foot, stand, shade, bottom of the shade, bulb.
AttributeBegin
  Translate -1.2 0 1.3
  Rotate -90 1 0 0
  Material "conductor" "spectrum eta" "metal-Al-eta" "spectrum k" "metal-Al-k" "float roughness" [ 0.3 ]
  Shape "cylinder" "float radius" [ 0.2 ] "float zmin" [ 0 ] "float zmax" [ 0.03 ]
  Shape "disk" "float radius" [ 0.2 ] "float height" [ 0.03 ]
  Shape "cylinder" "float radius" [ 0.02 ] "float zmin" [ 0.03 ] "float zmax" [ {bottom} ]
  Material "diffuse" "rgb reflectance" [ 0.1 0.1 0.1 ]
  Shape "cylinder" "float radius" [ 0.15 ] "float zmin" [ {bottom} ] "float zmax" [ {rim} ]
  Shape "disk" "float radius" [ 0.15 ] "float height" [ {bottom} ]
  AreaLightSource "diffuse" "float power" [ 10000 ]
  Shape "disk" "float radius" [ 0.12 ] "float height" [ {bulb} ]
AttributeEnd
"#,
        frame = frame.text(),
        room = room([-2.0, 0.0, -2.0], [2.0, 2.6, 2.4]),
        table = table([-0.1, 1.5], 0.75, [0.5, 1.3]),
        glass = sphere([0.3, 0.91, 0.8], 0.16),
        copper = sphere([0.75, 0.93, 1.05], 0.18),
        block = cuboid([1.05, 0.75, 0.7], [1.3, 1.1, 0.95]),
        bottom = bulb - 0.02,
    );
    Files::of_text("ceiling-lamp", text)
}

/// The two rooms of the door and the holes: what is in front of the wall at z = 0 and the lamp behind it.
fn two_rooms(name: &str, power_lm: f32, exposure_s: f32) -> String {
    let frame = Frame { name, resolution: [640, 480], exposure_s, samples: 256, max_depth: 32 };
    format!(
        r#"# Lengths are in metres; x grows to the right, y upwards, z into the picture.
#   front room   x -2 to 2, y 0 to 2.6, z -4 to 0; closed, with the camera inside
#   back room    the same up to z = 3; in its ceiling a lamp of 1 x 1, {power_lm} lumen

LookAt -0.5 1.5 -3.9   0.15 0.95 0   0 1 0
Camera "perspective" "float fov" [ 58 ]
{frame}
WorldBegin

{room}
AttributeBegin
AreaLightSource "diffuse" "float power" [ {power_lm} ]
{lamp}AttributeEnd
"#,
        frame = frame.text(),
        room = room([-2.0, 0.0, -4.0], [2.0, 2.6, 3.0]),
        lamp = quad([-0.5, 2.59, 1.0], [0.5, 2.59, 1.0], [-0.5, 2.59, 2.0], [0.5, 2.59, 2.0]),
    )
}

/// Contour of a pot with a lid, of height about 0.3 and radius 0.18.
const POT: [[f32; 2]; 15] = [
    [0.0, 0.0],
    [0.11, 0.0],
    [0.125, 0.008],
    [0.16, 0.06],
    [0.18, 0.12],
    [0.165, 0.18],
    [0.13, 0.215],
    [0.125, 0.225],
    [0.115, 0.235],
    [0.06, 0.25],
    [0.02, 0.257],
    [0.022, 0.275],
    [0.03, 0.29],
    [0.02, 0.305],
    [0.0, 0.308],
];

fn door(settings: &Settings) -> Files {
    let angle = settings.number("angle");
    let text = format!(
        r#"# A room that is lit through a door ajar, the scene that Metropolis light transport was shown with (SPEC SCENE-5; Veach
# and Guibas 1997).
#
{rooms}
# The wall around the door, which is 0.9 x 2.05; it opens by {angle} degrees into the back room.
{left}{right}{above}
AttributeBegin
  Material "diffuse" "rgb reflectance" [ 0.42 0.25 0.12 ]
  Translate 1.15 0 0.05
  Rotate {angle} 0 1 0
  {panel}AttributeEnd

# A table with three pots.
Material "diffuse" "rgb reflectance" [ 0.35 0.22 0.12 ]
{table}
AttributeBegin
  Translate -1.0 0.75 -1.5
  Material "diffuse" "rgb reflectance" [ 0.3 0.5 0.6 ]
  Rotate -90 1 0 0
  {pot}AttributeEnd
AttributeBegin
  Translate -0.5 0.75 -1.2
  Material "conductor" "spectrum eta" "metal-Al-eta" "spectrum k" "metal-Al-k" "float roughness" [ 0.05 ]
  Rotate -90 1 0 0
  {pot}AttributeEnd
AttributeBegin
  Translate 0 0.75 -1.5
  Material "dielectric" "float eta" [ 1.5 ]
  Rotate -90 1 0 0
  {pot}AttributeEnd
"#,
        rooms = two_rooms("door", 40_000.0, 0.03),
        left = cuboid([-2.0, 0.0, 0.0], [0.25, 2.6, 0.1]),
        right = cuboid([1.15, 0.0, 0.0], [2.0, 2.6, 0.1]),
        above = cuboid([0.25, 2.06, 0.0], [1.15, 2.6, 0.1]),
        panel = cuboid([-0.89, 0.005, -0.02], [0.0, 2.055, 0.02]),
        table = table([-1.4, 0.3], 0.75, [-1.9, -0.9]),
        pot = revolved(&POT),
    );
    Files::of_text("door", text)
}

fn holes(settings: &Settings) -> Files {
    let n = settings.count("holes");
    // The holes fill the square x -1 to 1, y 0.3 to 2.3; bars between them are half as wide as they are.
    let pitch = 2.0 / n as f32;
    let bar = pitch / 3.0;
    let mut grid = String::new();
    for k in 0..=n {
        let at = k as f32 * pitch;
        let (x0, x1) = ((-1.0 + at - bar / 2.0).max(-1.0), (-1.0 + at + bar / 2.0).min(1.0));
        let (y0, y1) = ((0.3 + at - bar / 2.0).max(0.3), (0.3 + at + bar / 2.0).min(2.3));
        grid.push_str(&cuboid([x0, 0.3, 0.0], [x1, 2.3, 0.1]));
        grid.push_str(&cuboid([-1.0, y0, 0.001], [1.0, y1, 0.099]));
    }
    let text = format!(
        r#"# A room that is lit through a wall with {n} x {n} holes (SPEC SCENE-5): once a path through one hole is known, paths
# through its neighbours are near.
#
{rooms}
# The wall, with holes from x = -1 to 1 and y = 0.3 to 2.3.
{left}{right}{below}{above}{grid}
Material "diffuse" "rgb reflectance" [ 0.6 0.5 0.2 ]
{ball}Material "conductor" "spectrum eta" "metal-Ag-eta" "spectrum k" "metal-Ag-k"
{mirror}"#,
        rooms = two_rooms("holes", 40_000.0, 0.012),
        left = cuboid([-2.0, 0.0, 0.0], [-1.0, 2.6, 0.1]),
        right = cuboid([1.0, 0.0, 0.0], [2.0, 2.6, 0.1]),
        below = cuboid([-1.0, 0.0, 0.0], [1.0, 0.3, 0.1]),
        above = cuboid([-1.0, 2.3, 0.0], [1.0, 2.6, 0.1]),
        ball = sphere([-0.9, 0.4, -1.2], 0.4),
        mirror = sphere([0.7, 0.35, -1.6], 0.35),
    );
    Files::of_text("holes", text)
}
