//! What vertices and faces have beyond their shape: colours, weights, whatever a program has added. Properties `red green
//! blue` (or `r g b`) are `color`, those with numbers at their ends (`weight_0 weight_1`) one value of that name, and others
//! stand alone. Bytes of colours are encoded as in sRGB.

use etendue_image::srgb_decode;
use etendue_scene::{AttributeDomain, MeshAttribute};

use super::header::{Element, PropertyKind, Scalar};

/// An attribute that is being read.
#[derive(Debug)]
pub(super) struct Column {
    pub(super) attribute: MeshAttribute,
    /// Columns of the table.
    columns: Vec<usize>,
    /// True for colours in bytes.
    is_encoded: bool,
    /// Values of quads, which come after those of triangles.
    of_quads: Vec<f32>,
}

const COLORS: [[&str; 3]; 3] =
    [["red", "green", "blue"], ["r", "g", "b"], ["diffuse_red", "diffuse_green", "diffuse_blue"]];
/// Names with a meaning of their own, and opacity, which comes with colours.
const RESERVED: [&str; 17] = [
    "x",
    "y",
    "z",
    "nx",
    "ny",
    "nz",
    "u",
    "v",
    "s",
    "t",
    "texture_u",
    "texture_v",
    "texture_s",
    "texture_t",
    "face_indices",
    "alpha",
    "a",
];

/// The attributes of a table, in the order of its columns.
pub(super) fn columns_of(element: &Element, domain: AttributeDomain) -> Vec<Column> {
    let prefix = match domain {
        AttributeDomain::Vertex => "vertex",
        AttributeDomain::Face => "face",
    };
    let column = |name: &str, columns: Vec<usize>, is_encoded: bool| Column {
        attribute: MeshAttribute {
            name: format!("{prefix}_{name}"),
            domain,
            n_components: columns.len(),
            values: Vec::new(),
        },
        columns,
        is_encoded,
        of_quads: Vec::new(),
    };
    let mut found: Vec<Column> = Vec::new();
    for names in COLORS {
        let columns: Vec<usize> = names.iter().filter_map(|name| element.scalar(name)).collect();
        if columns.len() == 3 && found.is_empty() {
            let is_byte = element.properties[columns[0]].kind == PropertyKind::Scalar(Scalar::U8);
            found.push(column("color", columns, is_byte));
        }
    }
    for (index, property) in element.properties.iter().enumerate() {
        let is_scalar = matches!(property.kind, PropertyKind::Scalar(_));
        let is_taken = COLORS.as_flattened().contains(&property.name.as_str());
        if !is_scalar || is_taken || RESERVED.contains(&property.name.as_str()) {
            continue;
        }
        let base = match property.name.rsplit_once('_') {
            Some((base, digits)) if !base.is_empty() && digits.parse::<u32>().is_ok() => base,
            _ => &property.name,
        };
        let name = format!("{prefix}_{base}");
        match found.last_mut().filter(|last| last.attribute.name == name) {
            Some(last) => {
                last.columns.push(index);
                last.attribute.n_components += 1;
            }
            None => found.push(column(base, vec![index], false)),
        }
    }
    found
}

impl Column {
    fn value(&self, row: &[f64], index: usize) -> f32 {
        let value = row[self.columns[index]] as f32;
        if self.is_encoded { srgb_decode(value / 255.0) } else { value }
    }

    /// Takes the values of a row for as many vertices or triangles.
    pub(super) fn push(&mut self, row: &[f64], n: usize) {
        for _ in 0..n {
            for index in 0..self.columns.len() {
                let value = self.value(row, index);
                self.attribute.values.push(value);
            }
        }
    }

    /// Takes the values of a row for a quad.
    pub(super) fn push_quad(&mut self, row: &[f64]) {
        for index in 0..self.columns.len() {
            let value = self.value(row, index);
            self.of_quads.push(value);
        }
    }

    /// The attribute; `None` if a value is not finite.
    pub(super) fn finish(mut self) -> Option<MeshAttribute> {
        self.attribute.values.append(&mut self.of_quads);
        self.attribute.values.iter().all(|value| value.is_finite()).then_some(self.attribute)
    }
}
