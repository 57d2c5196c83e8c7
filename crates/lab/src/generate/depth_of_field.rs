//! A row of things at several distances, and lenses of several widths (SPEC SCENE-38).

use super::settings::number;
use super::text::{Frame, cuboid, quad, sphere};
use super::{Files, Generator, Settings};

/// The row.
pub(super) const GENERATOR: Generator = Generator {
    name: "depth-of-field",
    id: "SCENE-38",
    doc: "a row of things at several distances, seen at f/1.4 and, as depth-of-field-f2.8 and so on, with smaller stops",
    parameters: &[
        number("focus", "0.85", [0.2, 10.0], "m", "distance that is sharp"),
        number("focal-length", "50", [8.0, 400.0], "mm", "of the lens"),
    ],
    generate,
};

/// Ratios of the focal length to the width of the lens. The first is that of the file that bears the scene's name.
const STOPS: [f32; 4] = [1.4, 2.8, 5.6, 16.0];

fn generate(settings: &Settings) -> Files {
    STOPS.into_iter().enumerate().fold(Files::default(), |files, (index, stop)| {
        let name = if index == 0 { "depth-of-field".to_owned() } else { format!("depth-of-field-f{stop}") };
        let text = text(&name, stop, settings.number("focus"), settings.number("focal-length"));
        files.with_text(&name, text)
    })
}

fn text(name: &str, stop: f32, focus: f32, focal_length: f32) -> String {
    let frame = Frame { name, resolution: [640, 360], exposure_s: 0.006, samples: 256, max_depth: 8 };
    let colors =
        ["0.7 0.2 0.12", "0.7 0.45 0.1", "0.55 0.6 0.15", "0.15 0.5 0.3", "0.15 0.35 0.6", "0.4 0.2 0.5"];
    let mut row = String::new();
    for (k, color) in colors.into_iter().enumerate() {
        // Distances along the view grow by the same factor.
        let z = 0.45 * 1.38_f32.powi(k as i32);
        let x = -0.12 + 0.055 * k as f32 + 0.1 * (z - 0.45);
        row.push_str(&format!(
            "# {z:.3} m away.\nMaterial \"coateddiffuse\" \"rgb reflectance\" [ {color} ] \"float roughness\" [ 0.02 ]\n"
        ));
        row.push_str(&sphere([x, 0.05, z], 0.05));
        row.push_str("Material \"diffuse\" \"rgb reflectance\" [ 0.7 0.7 0.7 ]\n");
        row.push_str(&cuboid([x - 0.005, 0.0, z + 0.06], [x + 0.005, 0.16, z + 0.07]));
    }
    format!(
        r#"# A row of balls and posts, focused at {focus} m by a lens of {focal_length} mm at f/{stop} (SPEC SCENE-38).
#
# Lengths are in metres; x grows to the right, y upwards, z into the picture. The lens is {lens_mm:.2} mm wide; the picture is
# that of a film 36 mm wide. Small bright lamps in the distance show the disk that a point out of focus becomes.

LookAt 0 0.17 0   0.07 0.04 0.85   0 1 0
Camera "perspective" "float focallength" [ {focal_length} ] "float fstop" [ {stop} ] "float focaldistance" [ {focus} ]
{frame}
WorldBegin

LightSource "infinite" "float illuminance" [ 350 ]
AttributeBegin
  AreaLightSource "diffuse" "float power" [ 900 ]
  {lamp}AttributeEnd

Texture "tiles" "spectrum" "checkerboard" "float uscale" [ 60 ] "float vscale" [ 80 ]
  "rgb tex1" [ 0.55 0.53 0.5 ] "rgb tex2" [ 0.3 0.28 0.26 ]
Material "diffuse" "texture reflectance" [ "tiles" ]
{floor}Material "diffuse" "rgb reflectance" [ 0.06 0.07 0.09 ]
{back}
{row}
# Small lamps.
AttributeBegin
  AreaLightSource "diffuse" "float scale" [ 40000 ]
  {sparks}AttributeEnd
"#,
        lens_mm = focal_length / stop,
        frame = frame.text(),
        lamp = quad([-0.6, 1.2, 0.2], [0.0, 1.2, 0.2], [-0.6, 1.2, 0.8], [0.0, 1.2, 0.8]),
        floor = quad([-1.5, 0.0, -0.5], [1.5, 0.0, -0.5], [-1.5, 0.0, 3.5], [1.5, 0.0, 3.5]),
        back = quad([-1.5, 0.0, 3.5], [1.5, 0.0, 3.5], [-1.5, 2.0, 3.5], [1.5, 2.0, 3.5]),
        sparks = (0..5)
            .map(|k| sphere([-0.75 + 0.34 * k as f32, 0.12 + 0.05 * (k % 2) as f32, 3.3], 0.004))
            .collect::<String>(),
    )
}
