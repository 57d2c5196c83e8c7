//! Emissive shapes of objects: they become shapes of the world, one for each instance, for a light has one place.

use std::borrow::Cow;

use etendue_math::AnimatedTransform;

use crate::assets::Assets;
use crate::document::{Document, ShapeEntity, Value};

/// The most primitives that copies may have together: a light of each is about 200 bytes.
const MAX_PRIMITIVES: usize = 4_000_000;

/// What a shape counts whose primitives are not known yet.
const MANY: usize = 100_000;

/// The document with the emissive shapes of its objects in their places in the world. Instances or shapes that move, and
/// copies beyond four million primitives, leave it as it is; then such shapes stay dark, and a warning says so where they
/// are added.
pub(super) fn place_emitters<'d>(document: &'d Document, assets: &Assets) -> Cow<'d, Document> {
    let mut placed = Vec::new();
    let mut n_primitives = 0_usize;
    for instance in &document.instances {
        let object = document.objects.iter().find(|object| object.name == instance.object);
        let emitters =
            object.iter().flat_map(|object| &object.shapes).filter(|shape| shape.area_light.is_some());
        for shape in emitters {
            if instance.world_from_instance.is_animated() || shape.world_from_object.is_animated() {
                return Cow::Borrowed(document);
            }
            n_primitives = n_primitives.saturating_add(count_primitives(shape, assets));
            if n_primitives > MAX_PRIMITIVES {
                return Cow::Borrowed(document);
            }
            let place = instance.world_from_instance.start * shape.world_from_object.start;
            placed.push((shape, AnimatedTransform::constant(place)));
        }
    }
    if placed.is_empty() {
        return Cow::Borrowed(document);
    }
    let copy =
        |(shape, world_from_object): (&ShapeEntity, _)| ShapeEntity { world_from_object, ..shape.clone() };
    let copies: Vec<ShapeEntity> = placed.into_iter().map(copy).collect();
    let mut document = document.clone();
    for object in &mut document.objects {
        object.shapes.retain(|shape| shape.area_light.is_none());
    }
    document.shapes.extend(copies);
    Cow::Owned(document)
}

/// About how many primitives a shape has.
fn count_primitives(shape: &ShapeEntity, assets: &Assets) -> usize {
    let parameter = |name: &str| shape.entity.parameters.iter().find(|p| p.name == name).map(|p| &p.value);
    let loaded = match parameter("filename") {
        Some(Value::Strings(names)) => names.first().and_then(|name| assets.meshes.get(name)),
        _ => None,
    };
    if let Some(mesh) = loaded {
        return mesh.triangles.len() + mesh.quads.len();
    }
    let n_faces = match parameter("indices") {
        Some(Value::Integers(indices)) => indices.len() / 3 + 1,
        _ => 1,
    };
    match shape.entity.type_name.as_str() {
        _ if parameter("displacement").is_some() => MANY,
        "trianglemesh" | "plymesh" | "bilinearmesh" => n_faces,
        "sphere" | "disk" | "cylinder" | "cone" | "paraboloid" | "hyperboloid" | "torus" | "plane" => 1,
        // Shapes that are made of triangles when they are built.
        _ => n_faces.saturating_mul(MANY),
    }
}
