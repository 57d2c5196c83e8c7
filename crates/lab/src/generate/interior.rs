//! Larger rooms: a hall with columns, and a corner for paths of every kind.

use std::f32::consts::PI;

use etendue_math::Point3;

use super::mesh::Grid;
use super::sun;
use super::text::{Frame, cuboid, quad, revolved, sphere};
use super::{Files, Generator, Settings};

/// A ball between two walls (SPEC SCENE-7).
pub(super) const GLOSSY_BALL: Generator = Generator {
    name: "glossy-ball",
    id: "SCENE-7",
    doc: "a glossy ball and two walls: paths LDDE, LDSE and LSSDE",
    parameters: &[],
    generate: glossy_ball,
};

/// A hall with columns (SPEC SCENE-8).
pub(super) const INTERIOR: Generator = Generator {
    name: "interior",
    id: "SCENE-8",
    doc: "an architectural interior: a vaulted hall with columns that the sun enters through windows",
    parameters: &[],
    generate: interior,
};

fn glossy_ball(_: &Settings) -> Files {
    let frame =
        Frame { name: "glossy-ball", resolution: [512, 512], exposure_s: 0.01, samples: 256, max_depth: 12 };
    let text = format!(
        r##"# A glossy ball and two matte walls (SPEC SCENE-7): light that two walls scatter (LDDE), that the ball shows of a wall
# (LDSE), and that a mirror and the ball throw onto a wall (LSSDE). To see them apart:
#   etendue render glossy-ball.pbrt -o layers.exr --lpe walls=LDDE --lpe reflection='LD[GS]E' --lpe caustic='L[GS][GS]DE'
#
# Lengths are in metres; x grows to the right, y upwards, z into the picture.
#   floor, walls   y = 0; x = -1.2, red; z = 1.2, white
#   ball           polished copper of radius 0.5 in the corner
#   mirror         a disk of radius 0.45 that faces the ball from the right
#   lamp           0.6 x 0.6 at y = 2.4, 2500 lumen

LookAt 1.4 1.3 -3.4   -0.1 0.62 0.2   0 1 0
Camera "perspective" "float fov" [ 36 ]
{frame}
WorldBegin

Material "diffuse" "rgb reflectance" [ 0.7 0.7 0.68 ]
{floor}{back}Material "diffuse" "rgb reflectance" [ 0.68 0.12 0.08 ]
{left}
Material "conductor" "spectrum eta" "metal-Cu-eta" "spectrum k" "metal-Cu-k" "float roughness" [ 0.05 ]
{ball}
AttributeBegin
  Material "conductor" "spectrum eta" "metal-Ag-eta" "spectrum k" "metal-Ag-k"
  Translate 0.95 0.55 0.35
  Rotate -80 0 1 0
  Shape "disk" "float radius" [ 0.45 ]
AttributeEnd

AttributeBegin
  AreaLightSource "diffuse" "float power" [ 2500 ]
  {lamp}AttributeEnd
"##,
        frame = frame.text(),
        floor = quad([-1.2, 0.0, -4.0], [4.0, 0.0, -4.0], [-1.2, 0.0, 1.2], [4.0, 0.0, 1.2]),
        back = quad([-1.2, 0.0, 1.2], [4.0, 0.0, 1.2], [-1.2, 3.0, 1.2], [4.0, 3.0, 1.2]),
        left = quad([-1.2, 0.0, -4.0], [-1.2, 0.0, 1.2], [-1.2, 3.0, -4.0], [-1.2, 3.0, 1.2]),
        ball = sphere([-0.35, 0.5, 0.4], 0.5),
        lamp = quad([-0.3, 2.4, -0.5], [0.3, 2.4, -0.5], [-0.3, 2.4, 0.1], [0.3, 2.4, 0.1]),
    );
    Files::of_text("glossy-ball", text)
}

/// Distance of columns along the hall, and how many there are on each side.
const BAY: f32 = 3.0;
const N_BAYS: u32 = 5;

fn interior(_: &Settings) -> Files {
    let frame =
        Frame { name: "interior", resolution: [640, 480], exposure_s: 0.0006, samples: 256, max_depth: 24 };
    let mut columns = String::new();
    for (k, x) in (0..=N_BAYS).flat_map(|k| [-2.2, 2.2].map(|x| (k, x))) {
        let z = BAY * k as f32;
        columns.push_str(&format!(
            "AttributeBegin\n  Translate {x} 0 {z}\n  ObjectInstance \"column\"\nAttributeEnd\n"
        ));
    }
    let text = format!(
        r#"# A hall with two rows of columns and a barrel vault; the sun enters through the windows of the left aisle, and almost all
# that is seen is lit by several bounces (SPEC SCENE-8: with a thousand paths for each pixel, a billion rays, it is noisy).
#
# Lengths are in metres; x grows to the right, y upwards, z into the picture.
#   nave      x -2.2 to 2.2, vault of radius 2.2 above y = 4.5
#   aisles    to x = -4 and x = 4, flat ceilings at y = 4.5
#   length    z -3 to 16.5; columns every 3 m from z = 0
#   windows   in the left wall between columns, 1.5 wide, from y = 0.9 to 3.9; one in the end wall
#   sun       elevation 36 degrees, from the left; a clear sky

LookAt -0.9 1.65 -2.6   0.35 2.15 7   0 1 0
Camera "perspective" "float fov" [ 62 ]
{frame}
WorldBegin

{light}
# Floor of dark and light marble.
Texture "tiles" "spectrum" "checkerboard" "float uscale" [ 16 ] "float vscale" [ 39 ]
  "rgb tex1" [ 0.62 0.58 0.5 ] "rgb tex2" [ 0.22 0.16 0.13 ]
Material "coateddiffuse" "texture reflectance" [ "tiles" ] "float roughness" [ 0.04 ]
{floor}
Material "diffuse" "rgb reflectance" [ 0.78 0.74 0.66 ]
# Ceilings of the aisles, beams above the columns, walls.
{ceilings}{beams}{right}{entrance}{end_wall}{window_wall}
Shape "plymesh" "string filename" "interior-vault.ply"

Material "diffuse" "rgb reflectance" [ 0.72 0.66 0.56 ]
ObjectBegin "column"
  AttributeBegin
    Rotate -90 1 0 0
    {column}  AttributeEnd
ObjectEnd
{columns}
# Benches, and a bronze ball on a pedestal.
Material "diffuse" "rgb reflectance" [ 0.32 0.18 0.1 ]
{benches}
Material "diffuse" "rgb reflectance" [ 0.6 0.6 0.58 ]
{pedestal}
Material "conductor" "spectrum eta" "metal-CuZn-eta" "spectrum k" "metal-CuZn-k" "float roughness" [ 0.1 ]
{ball}"#,
        frame = frame.text(),
        light = sun::light([-1.0, 0.76, 0.35]),
        floor = quad([-4.0, 0.0, -3.0], [4.0, 0.0, -3.0], [-4.0, 0.0, 16.5], [4.0, 0.0, 16.5]),
        ceilings = [-4.0, 2.2].map(|x| cuboid([x, 4.5, -3.0], [x + 1.8, 4.6, 16.5])).concat(),
        beams = [-2.5, 2.0].map(|x| cuboid([x, 4.0, -3.0], [x + 0.5, 4.6, 16.5])).concat(),
        right = quad([4.0, 0.0, -3.0], [4.0, 0.0, 16.5], [4.0, 4.6, -3.0], [4.0, 4.6, 16.5]),
        entrance = quad([-4.0, 0.0, -3.0], [4.0, 0.0, -3.0], [-4.0, 6.8, -3.0], [4.0, 6.8, -3.0]),
        end_wall = [
            cuboid([-4.0, 0.0, 16.5], [-1.0, 6.8, 16.8]),
            cuboid([1.0, 0.0, 16.5], [4.0, 6.8, 16.8]),
            cuboid([-1.0, 0.0, 16.5], [1.0, 1.2, 16.8]),
            cuboid([-1.0, 4.8, 16.5], [1.0, 6.8, 16.8]),
        ]
        .concat(),
        window_wall = window_wall(),
        column = revolved(&COLUMN),
        benches = [[-1.9, 1.0], [-1.9, 4.0], [1.4, 4.0], [1.4, 7.0]]
            .map(|[x, z]| {
                let top = cuboid([x, 0.4, z], [x + 0.5, 0.46, z + 1.8]);
                let feet = [z + 0.1, z + 1.6].map(|z| cuboid([x + 0.05, 0.0, z], [x + 0.45, 0.4, z + 0.1]));
                top + &feet.concat()
            })
            .concat(),
        pedestal = cuboid([0.95, 0.0, 1.6], [1.45, 1.0, 2.1]),
        ball = sphere([1.2, 1.3, 1.85], 0.3),
    );
    Files::of_text("interior", text).with_mesh("interior-vault", &vault())
}

/// The wall at x = -4, 0.3 thick, with a window in each bay.
fn window_wall() -> String {
    let slab = |y: [f32; 2], z: [f32; 2]| cuboid([-4.3, y[0], z[0]], [-4.0, y[1], z[1]]);
    let mut wall = slab([0.0, 0.9], [-3.0, 16.5]) + &slab([3.9, 4.6], [-3.0, 16.5]);
    let mut start = -3.0;
    for k in 0..N_BAYS {
        let z = BAY * (k as f32 + 0.5);
        wall += &slab([0.9, 3.9], [start, z - 0.75]);
        start = z + 0.75;
    }
    wall + &slab([0.9, 3.9], [start, 16.5])
}

/// Contour of a column of height 4 with foot and capital.
const COLUMN: [[f32; 2]; 15] = [
    [0.36, 0.0],
    [0.36, 0.1],
    [0.34, 0.14],
    [0.28, 0.18],
    [0.25, 0.24],
    [0.24, 0.4],
    [0.245, 1.5],
    [0.21, 3.4],
    [0.21, 3.45],
    [0.24, 3.5],
    [0.22, 3.55],
    [0.24, 3.7],
    [0.34, 3.86],
    [0.36, 3.9],
    [0.36, 4.0],
];

fn vault() -> etendue_scene::LoadedMesh {
    Grid::sheet([64, 1]).mesh(|u, v| {
        let angle = PI * u;
        Point3::new(2.25 * angle.cos(), 4.55 + 2.25 * angle.sin(), -3.0 + 19.5 * v)
    })
}
