//! Where the light at a point of a floor comes from (SPEC SCENE-31).

use std::fmt::Write;

use etendue_math::{Point3, Vector3};

use super::settings::{SEED, count, number};
use super::text::{placed, sphere};
use super::{Files, Generator, Settings};
use crate::photons::{PhotonCloud, PhotonKind};
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
        count("emitted", "200000", [1, 10_000_000], "photons that leave the lamp"),
        SEED,
    ],
    generate,
};

const BOX: &str = include_str!("../../../../scenes/box.pbrt");

/// The box's camera in its file.
const LOOK_AT: &str = "LookAt 0 0.9 -2.8   0 0.9 0   0 1 0";

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
# They are the nearest to the point of all that left the lamp.

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

/// Directions towards where the photons nearest to the place came from.
fn directions(settings: &Settings, [x, y, z]: [f32; 3]) -> Vec<Vector3> {
    let scene = StudyScene::standard_box().build();
    let n_emitted = u64::from(settings.count("emitted"));
    let cloud = PhotonCloud::trace(&scene, n_emitted, PhotonKind::All, u64::from(settings.count("seed")));
    let up = Vector3::new(0.0, 1.0, 0.0);
    let near = cloud.nearest(Point3::new(x, y, z), Some(up), settings.count("photons") as usize);
    near.into_iter().map(|photon| photon.wi).collect()
}
