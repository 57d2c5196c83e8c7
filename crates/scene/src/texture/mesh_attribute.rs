//! The texture `meshattribute`: numbers or colours that a mesh has at its vertices or on its faces. Those of vertices are
//! interpolated with the barycentric weights of the point, or bilinearly on patches.

use std::collections::BTreeSet;

use etendue_image::luminance;

use crate::assets::{AttributeDomain, MeshAttribute};
use crate::parameters::ParameterSpec;

use super::TextureContext;

/// Parameters of the texture.
pub(super) const PARAMETERS: &[ParameterSpec] = &[
    ParameterSpec {
        name: "name",
        kind: "string",
        default: "vertex_color",
        unit: "",
        doc: "what the mesh has at its vertices (vertex_...) or faces (face_...); 0 on shapes that lack it",
    },
    ParameterSpec { name: "scale", kind: "float", default: "1", unit: "", doc: "factor of all values" },
];

/// Index of the name of an attribute in [`MeshAttributes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AttributeId(u32);

/// The point of a shape at which a texture is evaluated, for what shapes have at their vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapePoint {
    /// Index of the shape's geometry.
    pub geometry: u32,
    /// Triangle or patch.
    pub primitive: u32,
    /// Barycentric weights of the second and third vertex, or the position on the patch.
    pub uv: [f32; 2],
}

/// Vertices of each face.
#[derive(Clone, Debug)]
pub enum Corners {
    /// Of triangles.
    Triangles(Vec<[u32; 3]>),
    /// Of bilinear patches, in the order `p00 p10 p01 p11`.
    Patches(Vec<[u32; 4]>),
}

impl Corners {
    /// Number of faces.
    fn len(&self) -> usize {
        match self {
            Self::Triangles(triangles) => triangles.len(),
            Self::Patches(patches) => patches.len(),
        }
    }
}

/// An attribute of one shape.
#[derive(Clone, Debug)]
pub struct ShapeAttribute {
    n_components: usize,
    values: Vec<f32>,
    /// `None` for one value for each face.
    corners: Option<Corners>,
}

impl ShapeAttribute {
    /// The attribute of a mesh as that of a shape with these faces, of which the mesh has `first_face` others before; `None`
    /// if there are too few values.
    #[must_use]
    pub fn new(attribute: &MeshAttribute, corners: &Corners, first_face: usize) -> Option<Self> {
        let n = attribute.n_components.clamp(1, 3);
        let (values, corners) = match attribute.domain {
            AttributeDomain::Face => {
                let range = first_face * attribute.n_components
                    ..(first_face + corners.len()) * attribute.n_components;
                (attribute.values.get(range)?, None)
            }
            AttributeDomain::Vertex => (attribute.values.as_slice(), Some(corners.clone())),
        };
        let largest = match &corners {
            None => 0,
            Some(Corners::Triangles(all)) => all.iter().flatten().max().map_or(0, |v| *v as usize + 1),
            Some(Corners::Patches(all)) => all.iter().flatten().max().map_or(0, |v| *v as usize + 1),
        };
        if values.len() < largest * attribute.n_components {
            return None;
        }
        // What is more than a colour is left out.
        let values = values
            .chunks(attribute.n_components.max(1))
            .flat_map(|value| value[..n.min(value.len())].to_vec());
        Some(Self { n_components: n, values: values.collect(), corners })
    }

    /// The value as a colour: grey where it has one component, no blue where it has two.
    fn rgb(&self, at: &ShapePoint) -> [f32; 3] {
        let value = |index: usize| -> [f32; 3] {
            let first = index * self.n_components;
            match self.values.get(first..first + self.n_components) {
                Some([x]) => [*x; 3],
                Some([x, y]) => [*x, *y, 0.0],
                Some([x, y, z]) => [*x, *y, *z],
                _ => [0.0; 3],
            }
        };
        let [u, v] = at.uv;
        let blend = |corners: &[u32], weights: &[f32]| {
            let mut sum = [0.0; 3];
            for (corner, weight) in corners.iter().zip(weights) {
                let corner = value(*corner as usize);
                sum = std::array::from_fn(|c| sum[c] + weight * corner[c]);
            }
            sum
        };
        let face = at.primitive as usize;
        match &self.corners {
            None => value(face),
            Some(Corners::Triangles(all)) => {
                all.get(face).map_or([0.0; 3], |corners| blend(corners, &[1.0 - u - v, u, v]))
            }
            Some(Corners::Patches(all)) => {
                let weights = [(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v];
                all.get(face).map_or([0.0; 3], |corners| blend(corners, &weights))
            }
        }
    }
}

/// The attributes that textures of the scene name, for all shapes that have them.
#[derive(Clone, Debug, Default)]
pub struct MeshAttributes {
    names: Vec<String>,
    /// For each geometry, if any of its shapes has attributes: those that it has.
    shapes: Vec<Vec<(AttributeId, ShapeAttribute)>>,
}

impl MeshAttributes {
    /// The id of a name.
    pub fn name(&mut self, name: &str) -> AttributeId {
        let known = self.names.iter().position(|known| known == name);
        let index = known.unwrap_or(self.names.len());
        if known.is_none() {
            self.names.push(name.to_owned());
        }
        AttributeId(index as u32)
    }

    /// Those attributes of a mesh that textures name, for a shape with these faces.
    #[must_use]
    pub fn of_shape(
        &self,
        attributes: &[MeshAttribute],
        corners: impl Fn() -> Corners,
        first_face: usize,
    ) -> Vec<(AttributeId, ShapeAttribute)> {
        let id = |name: &str| Some(AttributeId(self.names.iter().position(|known| known == name)? as u32));
        let wanted = attributes.iter().filter_map(|attribute| Some((id(&attribute.name)?, attribute)));
        wanted
            .filter_map(|(id, attribute)| Some((id, ShapeAttribute::new(attribute, &corners(), first_face)?)))
            .collect()
    }

    /// Gives a geometry its attributes.
    pub fn attach(&mut self, geometry: u32, attributes: Vec<(AttributeId, ShapeAttribute)>) {
        if attributes.is_empty() {
            return;
        }
        let index = geometry as usize;
        if self.shapes.len() <= index {
            self.shapes.resize_with(index + 1, Vec::new);
        }
        self.shapes[index] = attributes;
    }

    /// Names that no shape has.
    #[must_use]
    pub fn missing(&self) -> Vec<&str> {
        let found: BTreeSet<u32> = self.shapes.iter().flatten().map(|(id, _)| id.0).collect();
        let names = self.names.iter().enumerate();
        names.filter(|(index, _)| !found.contains(&(*index as u32))).map(|(_, name)| name.as_str()).collect()
    }

    fn rgb(&self, id: AttributeId, ctx: &TextureContext) -> [f32; 3] {
        let Some(at) = &ctx.shape_point else { return [0.0; 3] };
        let of_shape = self.shapes.get(at.geometry as usize).map_or(&[][..], Vec::as_slice);
        of_shape.iter().find(|(known, _)| *known == id).map_or([0.0; 3], |(_, attribute)| attribute.rgb(at))
    }
}

/// The texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshAttributeTexture {
    /// What it shows.
    pub attribute: AttributeId,
    /// Factor of its values.
    pub scale: f32,
}

impl MeshAttributeTexture {
    /// The linear colour at a point, not negative.
    #[must_use]
    pub fn eval_rgb(&self, attributes: &MeshAttributes, ctx: &TextureContext) -> [f32; 3] {
        attributes.rgb(self.attribute, ctx).map(|c| (self.scale * c).max(0.0))
    }

    /// The number at a point: the luminance of a colour.
    #[must_use]
    pub fn eval_float(&self, attributes: &MeshAttributes, ctx: &TextureContext) -> f32 {
        let [r, g, b] = attributes.rgb(self.attribute, ctx);
        self.scale * if r == g && g == b { r } else { luminance([r, g, b]) }
    }
}
