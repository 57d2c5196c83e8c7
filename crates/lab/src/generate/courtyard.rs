//! A house around a court, through the day (SPEC SCENE-15).

use std::f32::consts::PI;

use etendue_math::Point3;

use super::mesh::Grid;
use super::settings::number;
use super::sun;
use super::text::{Frame, cuboid, quad};
use super::{Files, Generator, Settings};

/// The house.
pub(super) const GENERATOR: Generator = Generator {
    name: "courtyard",
    id: "SCENE-15",
    doc: "a house of glass and curved walls around a court, at any time of a day in June",
    parameters: &[number("hour", "15", [4.5, 19.5], "h", "solar time: 12 is noon")],
    generate,
};

fn generate(settings: &Settings) -> Files {
    let hour = settings.number("hour");
    let frame =
        Frame { name: "courtyard", resolution: [800, 400], exposure_s: 0.00006, samples: 256, max_depth: 16 };
    let light = sun::light(sun::direction(hour));
    let mut posts = String::new();
    for (x, z) in [-5.0, 0.0, 5.0].into_iter().flat_map(|x| [(x, 4.2), (x, 9.0)]) {
        posts.push_str(&cuboid([x - 0.1, 0.0, z - 0.02], [x + 0.1, 3.0, z + 0.02]));
        posts.push_str(&cuboid([x - 0.02, 0.0, z - 0.1], [x + 0.02, 3.0, z + 0.1]));
    }
    let mut mullions = String::new();
    for k in 0..=6 {
        let x = -8.0 + 16.0 / 6.0 * k as f32;
        mullions.push_str(&cuboid([x - 0.03, 0.0, 3.47], [x + 0.03, 3.0, 3.53]));
    }
    let text = format!(
        r#"# A house around a walled court with a glass front, cross-shaped columns and curved walls inside, in the manner of the
# court houses that Mies van der Rohe drew in the 1930s (SPEC SCENE-15). Our plan; the sun goes by the formulas of spherical
# astronomy for latitude 52 degrees on 21 June. Now it is {hour} o'clock by the sun.
#
# Lengths are in metres; x grows to the right, which is east, y upwards, z into the picture, which is north.
#   court   x -9 to 9, z -9 to 3.5, walls of brick 3 high
#   house   z 3.5 to 11 under a roof slab at 3; front of glass at z = 3.5, back wall at z = 11

LookAt -6.6 1.7 -7.8   1.2 1.35 4.5   0 1 0
Camera "perspective" "float fov" [ 46 ]
{frame}
WorldBegin

{light}
# Paving of the court and floor of the house.
Texture "slabs" "spectrum" "checkerboard" "float uscale" [ 18 ] "float vscale" [ 20 ]
  "rgb tex1" [ 0.52 0.5 0.46 ] "rgb tex2" [ 0.46 0.44 0.41 ]
Material "diffuse" "texture reflectance" [ "slabs" ]
{floor}Material "diffuse" "rgb reflectance" [ 0.12 0.2 0.05 ]
{lawn}Material "diffuse" "rgb reflectance" [ 0.3 0.32 0.2 ]
{ground}
# Brick walls.
Texture "bricks" "spectrum" "checkerboard" "float uscale" [ 72 ] "float vscale" [ 40 ]
  "rgb tex1" [ 0.5 0.26 0.17 ] "rgb tex2" [ 0.44 0.22 0.15 ]
Material "diffuse" "texture reflectance" [ "bricks" ]
{walls}
# Roof.
Material "diffuse" "rgb reflectance" [ 0.8 0.8 0.78 ]
{roof}
# Columns and mullions of steel, panes.
Material "conductor" "spectrum eta" "metal-Al-eta" "spectrum k" "metal-Al-k" "float roughness" [ 0.15 ]
{posts}{mullions}
Material "thindielectric" "float eta" [ 1.5 ]
{panes}
# Curved walls of wood and of onyx, bent around the middle of the house.
Material "coateddiffuse" "rgb reflectance" [ 0.4 0.2 0.08 ] "float roughness" [ 0.1 ]
Shape "plymesh" "string filename" "courtyard-curve.ply"
Material "coateddiffuse" "rgb reflectance" [ 0.7 0.5 0.25 ] "float roughness" [ 0.05 ]
Shape "plymesh" "string filename" "courtyard-screen.ply"

# A pool, a bench, and a tree.
Material "coateddiffuse" "rgb reflectance" [ 0.03 0.08 0.09 ] "float roughness" [ 0 ]
{pool}Material "diffuse" "rgb reflectance" [ 0.7 0.7 0.68 ]
{bench}Material "diffuse" "rgb reflectance" [ 0.25 0.16 0.1 ]
AttributeBegin
  Translate 5.6 0 -3.4
  Rotate -90 1 0 0
  Shape "cylinder" "float radius" [ 0.12 ] "float zmin" [ 0 ] "float zmax" [ 3 ]
AttributeEnd
Material "diffusetransmission" "rgb reflectance" [ 0.1 0.2 0.05 ] "rgb transmittance" [ 0.08 0.14 0.02 ]
Shape "plymesh" "string filename" "courtyard-leaves.ply"
"#,
        frame = frame.text(),
        floor = quad([-9.0, 0.0, -9.0], [9.0, 0.0, -9.0], [-9.0, 0.0, 11.0], [9.0, 0.0, 11.0]),
        lawn = quad([1.5, 0.01, -7.5], [8.5, 0.01, -7.5], [1.5, 0.01, -0.5], [8.5, 0.01, -0.5]),
        ground = quad(
            [-400.0, -0.05, -400.0],
            [400.0, -0.05, -400.0],
            [-400.0, -0.05, 400.0],
            [400.0, -0.05, 400.0]
        ),
        walls = cuboid([-9.3, 0.0, -9.3], [-9.0, 3.0, 11.3])
            + &cuboid([9.0, 0.0, -9.3], [9.3, 3.0, 11.3])
            + &cuboid([-9.0, 0.0, -9.3], [9.0, 3.0, -9.0])
            + &cuboid([-9.0, 0.0, 11.0], [9.0, 3.0, 11.3]),
        roof = cuboid([-9.3, 3.0, 2.6], [9.3, 3.3, 11.3]),
        panes = quad([-9.0, 0.0, 3.5], [9.0, 0.0, 3.5], [-9.0, 3.0, 3.5], [9.0, 3.0, 3.5]),
        pool = quad([-4.5, 0.015, -5.5], [0.5, 0.015, -5.5], [-4.5, 0.015, -2.5], [0.5, 0.015, -2.5]),
        bench = cuboid([-2.6, 0.38, 0.6], [0.4, 0.46, 1.1])
            + &cuboid([-2.4, 0.0, 0.65], [-2.3, 0.38, 1.05])
            + &cuboid([0.1, 0.0, 0.65], [0.2, 0.38, 1.05]),
    );
    let bent = |centre: [f32; 2], radius: f32, [from, to]: [f32; 2]| {
        Grid::sheet([64, 1]).mesh(|u, v| {
            let (sine, cosine) = (PI * (from + u * (to - from))).sin_cos();
            Point3::new(centre[0] + radius * cosine, 3.0 * v, centre[1] + radius * sine)
        })
    };
    Files::of_text("courtyard", text)
        .with_mesh("courtyard-curve", &bent([2.5, 7.2], 2.2, [-0.1, 1.0]))
        .with_mesh("courtyard-screen", &bent([-4.6, 8.2], 2.6, [1.0, 1.6]))
        .with_mesh("courtyard-leaves", &super::plants::crown([5.6, 3.6, -3.4], 1.5, 9000, 3))
}
