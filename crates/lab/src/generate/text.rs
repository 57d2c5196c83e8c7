//! Pieces of scene files.

use std::fmt::Write;

/// What all scenes say before `WorldBegin`: film, sampler and method.
///
/// The exposure time makes 1 / `exposure_s` cd/m² the white of the picture.
pub(super) struct Frame<'a> {
    /// Name of the picture, without ending.
    pub(super) name: &'a str,
    /// Pixels across and down.
    pub(super) resolution: [u32; 2],
    /// Exposure time in seconds at ISO 100.
    pub(super) exposure_s: f32,
    /// Samples per pixel.
    pub(super) samples: u32,
    /// Greatest number of scattering events.
    pub(super) max_depth: u32,
}

impl Frame<'_> {
    /// As directives.
    pub(super) fn text(&self) -> String {
        let Frame { name, resolution: [x, y], exposure_s, samples, max_depth } = self;
        format!(
            r#"Film "rgb" "string filename" [ "{name}.exr" ]
  "integer xresolution" [ {x} ] "integer yresolution" [ {y} ] "float exposuretime" [ {exposure_s} ]
Sampler "zsobol" "integer pixelsamples" [ {samples} ]
Integrator "path" "integer maxdepth" [ {max_depth} ]
"#
        )
    }
}

/// A flat quadrilateral with corners in the order of a bilinear patch: `p00 p10 p01 p11`. It emits where `dp/du` x
/// `dp/dv` points.
pub(super) fn quad(p00: [f32; 3], p10: [f32; 3], p01: [f32; 3], p11: [f32; 3]) -> String {
    format!("Shape \"bilinearmesh\" \"point3 P\" [ {} ]\n", numbers([p00, p10, p01, p11].as_flattened()))
}

/// A closed box with edges along the axes; faces look outwards.
pub(super) fn cuboid(min: [f32; 3], max: [f32; 3]) -> String {
    let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { min[axis] } else { max[axis] });
    let corners: Vec<f32> = (0..8).flat_map(corner).collect();
    format!(
        "Shape \"bilinearmesh\" \"integer indices\" [ 0 4 2 6  1 3 5 7  0 1 4 5  2 6 3 7  0 2 1 3  4 5 6 7 ]\n  \
         \"point3 P\" [ {} ]\n",
        numbers(&corners)
    )
}

/// A sphere at a place.
pub(super) fn sphere(centre: [f32; 3], radius: f32) -> String {
    let [x, y, z] = centre;
    format!(
        "AttributeBegin\n  Translate {x} {y} {z}\n  Shape \"sphere\" \"float radius\" [ {radius} ]\nAttributeEnd\n"
    )
}

/// Numbers separated by blanks, a line break after every twelfth.
pub(super) fn numbers(values: &[f32]) -> String {
    let mut text = String::new();
    for (index, value) in values.iter().enumerate() {
        let separator = match index {
            0 => "",
            _ if index % 12 == 0 => "\n  ",
            _ if index % 3 == 0 => "  ",
            _ => " ",
        };
        // Zero has one sign here.
        let _ = write!(text, "{separator}{}", value + 0.0);
    }
    text
}

/// A directive in a space of its own: its origin, the three axes as columns.
pub(super) fn placed(origin: [f32; 3], x: [f32; 3], y: [f32; 3], z: [f32; 3], directive: &str) -> String {
    let [x, y, z, origin] = [x, y, z, origin].map(|v| numbers(&v));
    format!(
        "AttributeBegin\n  ConcatTransform [ {x} 0  {y} 0  {z} 0  {origin} 1 ]\n  {directive}\nAttributeEnd\n"
    )
}

/// A surface of revolution about z; the contour is given as (radius, height), and has its normals to the right of the way
/// along it, as it is drawn with the radius to the right and the height upwards.
pub(super) fn revolved(contour: &[[f32; 2]]) -> String {
    let points: Vec<f32> = contour.iter().flat_map(|[radius, height]| [*height, *radius]).collect();
    format!("Shape \"revolution\" \"point2 contour\" [ {} ]\n", pairs(&points))
}

/// Numbers in pairs, eight to a line.
fn pairs(values: &[f32]) -> String {
    let pair = |p: &[f32]| format!("{} {}", p[0], p[1]);
    let lines: Vec<String> =
        values.chunks(16).map(|line| line.chunks_exact(2).map(pair).collect::<Vec<_>>().join("  ")).collect();
    lines.join("\n  ")
}
