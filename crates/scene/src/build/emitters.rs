//! Emissive shapes of objects: they become shapes of the world, one for each instance, for a light has one place. Where an
//! instance moves, they become an object of their own, which is used once.

use std::borrow::Cow;
use std::collections::HashMap;

use etendue_math::AnimatedTransform;

use crate::assets::Assets;
use crate::document::{Document, InstanceEntity, ObjectEntity, ShapeEntity, Value};

use super::motion::{FILENAME_1, P1};

/// The most primitives that copies may have together: a light of each is about 200 bytes.
const MAX_PRIMITIVES: usize = 4_000_000;

/// What a shape counts whose primitives are not known before it is built.
const MANY: usize = 100_000;

/// Faces in which a surface of revolution is turned by default, and pieces of its curve between two points.
const N_SECTORS: usize = 256;
const N_PIECES: usize = 16;

/// A document with the emissive shapes of its objects in their places.
pub(super) struct Placed<'d> {
    pub(super) document: Cow<'d, Document>,
    /// Objects that are used once, by a moving instance, whose shapes can therefore be lights: index of the instance.
    pub(super) moving: HashMap<String, usize>,
}

/// Puts the emissive shapes of objects in their places. Objects with whose copies there would be more than four million primitives
/// are left as they are, and so are shapes that move within their object and those that cannot emit: they stay dark, and a
/// warning says so where they are added.
pub(super) fn place_emitters<'d>(document: &'d Document, assets: &Assets) -> Placed<'d> {
    let emitters = emitters_by_object(document, assets);
    if emitters.is_empty() {
        return Placed { document: Cow::Borrowed(document), moving: HashMap::new() };
    }
    let mut changed = document.clone();
    for object in &mut changed.objects {
        if emitters.contains_key(object.name.as_str()) {
            object.shapes.retain(|shape| !is_emitter(shape));
        }
    }
    let mut moving = HashMap::new();
    for (index, instance) in document.instances.iter().enumerate() {
        let Some(shapes) = emitters.get(instance.object.as_str()) else { continue };
        let place = &instance.world_from_instance;
        if place.is_animated() {
            let (name, span) = (format!("{}\u{1f}{index}", instance.object), instance.span);
            moving.insert(name.clone(), changed.instances.len());
            changed.instances.push(InstanceEntity { object: name.clone(), ..instance.clone() });
            let shapes = shapes.iter().copied().cloned().collect();
            changed.objects.push(ObjectEntity { name, span, shapes });
            continue;
        }
        changed.shapes.extend(shapes.iter().map(|shape| ShapeEntity {
            world_from_object: AnimatedTransform::constant(place.start * shape.world_from_object.start),
            ..(*shape).clone()
        }));
    }
    Placed { document: Cow::Owned(changed), moving }
}

/// The emissive shapes of objects that are used, as long as there are not too many.
fn emitters_by_object<'d>(document: &'d Document, assets: &Assets) -> HashMap<&'d str, Vec<&'d ShapeEntity>> {
    let mut n_uses: HashMap<&str, usize> = HashMap::new();
    for instance in &document.instances {
        *n_uses.entry(&instance.object).or_default() += 1;
    }
    let mut n_primitives = 0_usize;
    let mut emitters: HashMap<&str, Vec<&ShapeEntity>> = HashMap::new();
    for object in &document.objects {
        let n_uses = n_uses.get(object.name.as_str()).copied().unwrap_or(0);
        let found: Vec<&ShapeEntity> = object.shapes.iter().filter(|shape| is_emitter(shape)).collect();
        if n_uses == 0 || found.is_empty() || emitters.contains_key(object.name.as_str()) {
            continue;
        }
        let n_each =
            found.iter().fold(0, |n: usize, shape| n.saturating_add(count_primitives(shape, assets)));
        let n_with = n_primitives.saturating_add(n_each.saturating_mul(n_uses));
        if n_with <= MAX_PRIMITIVES {
            n_primitives = n_with;
            emitters.insert(&object.name, found);
        }
    }
    emitters
}

/// True for a shape that emits where it stands in the world.
fn is_emitter(shape: &ShapeEntity) -> bool {
    shape.area_light.is_some()
        && !shape.world_from_object.is_animated()
        && !matches!(shape.entity.type_name.as_str(), "curve" | "points" | "implicit")
        && [P1, FILENAME_1].iter().all(|end| parameter(shape, end.name).is_none())
}

/// The value of a parameter as the entity gives it.
pub(super) fn parameter<'s>(shape: &'s ShapeEntity, name: &str) -> Option<&'s Value> {
    shape.entity.parameters.iter().find(|p| p.name == name).map(|p| &p.value)
}

/// About how many primitives a shape has.
fn count_primitives(shape: &ShapeEntity, assets: &Assets) -> usize {
    let integer = |name: &str, default: i32| match parameter(shape, name) {
        Some(Value::Integers(values)) => values.first().copied().unwrap_or(default),
        _ => default,
    };
    // Each step of subdivision makes four faces of one.
    let subdivided = |n: usize, levels: i32| n.saturating_mul(1 << (2 * levels.clamp(0, 15)));
    let filename = match parameter(shape, "filename") {
        Some(Value::Strings(names)) => names.first(),
        _ => None,
    };
    let n_faces = match (filename.and_then(|name| assets.meshes.get(name)), parameter(shape, "indices")) {
        (Some(mesh), _) => mesh.triangles.len() + mesh.quads.len(),
        (None, Some(Value::Integers(indices))) => indices.len() / 3 + 1,
        _ => 1,
    };
    match shape.entity.type_name.as_str() {
        "loopsubdiv" => subdivided(n_faces, integer("levels", 3)),
        "fractal" => subdivided(n_faces, integer("levels", 5)),
        "heightfield" => match (parameter(shape, "z"), filename.and_then(|name| assets.images.get(name))) {
            (Some(Value::Floats(heights)), _) => 2 * heights.len(),
            (None, Some(_)) => MANY.saturating_mul(10),
            _ => subdivided(2, integer("levels", 8)),
        },
        "revolution" => {
            let n_points = match (parameter(shape, "contour"), filename.and_then(|n| assets.contours.get(n)))
            {
                (Some(Value::Points2(points)), _) => points.len(),
                (_, Some(contours)) => contours.0.iter().map(|(_, contour)| contour.len()).sum(),
                _ => 1,
            };
            match parameter(shape, "tolerance") {
                Some(_) => MANY.max(2 * N_SECTORS * n_points),
                None => (2 * N_SECTORS * N_PIECES).saturating_mul(n_points),
            }
        }
        "parametric" => MANY.min(integer("maxtriangles", i32::MAX).max(1) as usize),
        "trianglemesh" | "plymesh" if parameter(shape, "displacement").is_some() => MANY.max(n_faces),
        _ => n_faces,
    }
}
