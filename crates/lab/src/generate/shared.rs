//! Scenes that stand in the repository's `scenes` folder: the file as it is, but for numbers that are parameters.

use super::settings::number;
use super::{Files, Generator, Settings};

/// The standard box (SPEC SCENE-2).
pub(super) const BOX: Generator = Generator {
    name: "box",
    id: "SCENE-2",
    doc: "the standard box: coloured walls, a mirror ball, a glass ball, a lamp in the ceiling",
    parameters: &[],
    generate: |_| Files::of_text("box", include_str!("../../../../scenes/box.pbrt")),
};

/// The Cornell box (SPEC SCENE-3).
pub(super) const CORNELL: Generator = Generator {
    name: "cornell",
    id: "SCENE-3",
    doc: "the Cornell box: matte walls and two matte blocks, as radiosity shows it",
    parameters: &[],
    generate: |_| Files::of_text("cornell", include_str!("../../../../scenes/cornell.pbrt")),
};

const CYLINDER_TEXT: &str = include_str!("../../../../scenes/cylinder.pbrt");
const CYLINDER_ROUGHNESS: &str = "\"float roughness\" [ 1 ]";

/// Light on the rim of a polished ring (SPEC SCENE-18).
pub(super) const CYLINDER: Generator = Generator {
    name: "cylinder",
    id: "SCENE-18",
    doc: "a lamp on the rim of a polished cylinder: a cardioid on a floor of any gloss",
    parameters: &[number("roughness", "1", [0.001, 1.0], "", "of the floor: 1 matte, 0.01 nearly a mirror")],
    generate: cylinder,
};

fn cylinder(settings: &Settings) -> Files {
    let roughness = format!("\"float roughness\" [ {} ]", settings.number("roughness"));
    Files::of_text("cylinder", CYLINDER_TEXT.replace(CYLINDER_ROUGHNESS, &roughness))
}

/// Kinds of reflection (SPEC SCENE-40).
pub(super) const BALLS: Generator = Generator {
    name: "balls",
    id: "SCENE-40",
    doc: "kinds of reflection side by side: rough matte, matte, glossy, rough mirror",
    parameters: &[],
    generate: |_| Files::of_text("balls", include_str!("../../../../scenes/balls.pbrt")),
};
