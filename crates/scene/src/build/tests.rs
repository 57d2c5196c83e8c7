//! Documents made in code become scenes, and what is wrong with them is reported where it stands.

mod curves;
mod expressions;
mod heights;
mod lights;
mod materials;
mod meshes;
mod motion;
mod moving_lights;
mod point_cloud;
mod revolution;
mod settings;
mod shapes;

use etendue_geometry::GeometryId;
use etendue_math::{AnimatedTransform, Normal3, Point3, Ray, Transform, Vector3};

use super::*;
use crate::diagnostics::{Diagnostic, FileId, Severity, Span};
use crate::document::{
    LightEntity, MaterialEntity, MaterialReference, ObjectEntity, ShapeEntity, TextureEntity, TextureValue,
    Value,
};

/// Significance of each statistical test of this folder, of which there are fewer than ten.
const SIGNIFICANCE: f64 = 1e-5;

/// A document with a small film and a point light that sees everything from afar.
fn lit() -> Document {
    let film = Entity::new("rgb").with("xresolution", integers(&[4])).with("yresolution", integers(&[3]));
    let light = Entity::new("point").with("from", points(&[[0.0, 0.0, 1000.0]]));
    Document { film: Some(film), lights: vec![placed_light(light)], ..Document::default() }
}

/// The same with shapes.
fn lit_with(shapes: Vec<ShapeEntity>) -> Document {
    Document { shapes, ..lit() }
}

/// The same without the light.
fn dark_with(shapes: Vec<ShapeEntity>) -> Document {
    Document { lights: Vec::new(), ..lit_with(shapes) }
}

fn placed_light(entity: Entity) -> LightEntity {
    LightEntity { entity, world_from_light: still(Transform::IDENTITY), outside_medium: String::new() }
}

/// A shape of the default material at the origin.
fn shape(entity: Entity) -> ShapeEntity {
    ShapeEntity {
        entity,
        world_from_object: still(Transform::IDENTITY),
        reverse_orientation: false,
        material: MaterialReference::Index(0),
        area_light: None,
        inside_medium: String::new(),
        outside_medium: String::new(),
        has_medium_interface: false,
    }
}

fn sphere() -> ShapeEntity {
    shape(Entity::new("sphere"))
}

/// The square |x| <= 1, |y| <= 1 at z = 0 as two triangles with normal +z and texture coordinates from the lower left.
fn square() -> Entity {
    Entity::new("trianglemesh")
        .with("P", points(&[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]]))
        .with("indices", integers(&[0, 1, 2, 0, 2, 3]))
        .with("uv", floats(&[0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0]))
}

fn named_material(name: &str, entity: Entity) -> MaterialEntity {
    MaterialEntity { name: Some(name.to_owned()), entity }
}

fn float_texture(name: &str, entity: Entity) -> TextureEntity {
    let world_from_texture = Transform::IDENTITY;
    TextureEntity { name: name.to_owned(), value: TextureValue::Float, world_from_texture, entity }
}

fn still(transform: Transform) -> AnimatedTransform {
    AnimatedTransform::constant(transform)
}

/// A motion by 1 m along x within the first second.
fn moving() -> AnimatedTransform {
    let end = Transform::translate(Vector3::new(1.0, 0.0, 0.0));
    AnimatedTransform { start: Transform::IDENTITY, end, start_time: 0.0, end_time: 1.0 }
}

fn floats(values: &[f32]) -> Value {
    Value::Floats(values.to_vec())
}

fn integers(values: &[i32]) -> Value {
    Value::Integers(values.to_vec())
}

fn points(values: &[[f32; 3]]) -> Value {
    Value::Points3(values.iter().map(|[x, y, z]| Point3::new(*x, *y, *z)).collect())
}

fn strings(values: &[&str]) -> Value {
    Value::Strings(values.iter().map(|s| (*s).to_owned()).collect())
}

fn texture(name: &str) -> Value {
    Value::Texture(name.to_owned())
}

/// The place of the entity under test.
const HERE: Span = Span { file: FileId(0), start: 70, end: 77 };

/// The entity with its parameters at that place.
fn here(mut entity: Entity) -> Entity {
    entity.span = Some(HERE);
    for parameter in &mut entity.parameters {
        parameter.span = Some(HERE);
    }
    entity
}

fn build(document: &Document) -> (Option<Scene>, Vec<Diagnostic>) {
    build_with(document, Assets::default())
}

fn build_with(document: &Document, assets: Assets) -> (Option<Scene>, Vec<Diagnostic>) {
    let (scene, diagnostics) = Scene::build(document, assets);
    assert_eq!(scene.is_none(), diagnostics.has_errors());
    (scene, diagnostics.list().to_vec())
}

/// The scene of a document without problems.
#[track_caller]
fn scene(document: &Document) -> Scene {
    let (scene, problems) = build(document);
    assert!(problems.is_empty(), "{problems:?}");
    scene.expect("no problem was reported")
}

/// The only problem of a document, which is an error at [`HERE`] that says `message`.
#[track_caller]
fn error_here(document: &Document, message: &str) -> Diagnostic {
    let (_, problems) = build(document);
    only_problem(&problems, Severity::Error, message)
}

/// The only problem of a document, which is a warning at [`HERE`] that says `message`, and the scene.
#[track_caller]
fn warning_here(document: &Document, message: &str) -> Scene {
    let (scene, problems) = build(document);
    only_problem(&problems, Severity::Warning, message);
    scene.expect("a warning leaves a scene")
}

#[track_caller]
fn only_problem(problems: &[Diagnostic], severity: Severity, message: &str) -> Diagnostic {
    let [problem] = problems else { panic!("not one problem that says {message:?} but {problems:?}") };
    assert!(problem.severity == severity && problem.span == Some(HERE), "{problem:?}");
    assert!(problem.message.contains(message), "{problem:?} does not say {message:?}");
    problem.clone()
}

#[track_caller]
fn assert_helps(problem: &Diagnostic, help: &str) {
    assert!(problem.help.as_deref().is_some_and(|text| text.contains(help)), "{problem:?} lacks {help:?}");
}

/// A ray downwards from z = 10.
fn down(x: f32, y: f32) -> Ray {
    Ray::new(Point3::new(x, y, 10.0), Vector3::new(0.0, 0.0, -1.0))
}

/// The shape that a downward ray meets, with its primitive.
fn below(scene: &Scene, x: f32, y: f32) -> Option<(GeometryId, u32)> {
    scene.intersect(&down(x, y), f32::INFINITY).map(|hit| (hit.geometry, hit.primitive))
}

/// The first lesson of every scene: a document that says nothing is pbrt-v4's default scene, empty and dark.
#[test]
fn an_empty_document_is_a_scene() {
    let (scene, problems) = build(&Document::default());
    let [problem] = problems.as_slice() else { panic!("{problems:?}") };
    assert!(problem.severity == Severity::Warning && problem.message.contains("no lights"));
    let scene = scene.expect("a warning leaves a scene");
    assert_eq!(scene.film.resolution, [1280, 720]);
    assert_eq!(scene.sampler.samples_per_pixel, 16);
    assert_eq!(scene.integrator.type_name, "volpath");
    assert_eq!(scene.materials.len(), 2);
    assert!(scene.attributes.is_empty() && scene.bounds().is_empty());
    assert!(!scene.has_alpha && !scene.has_passable);
}

/// All that is wrong is said at once, not only the first of it.
#[test]
fn all_problems_are_reported_together() {
    let mut document = lit_with(vec![shape(Entity::new("spere")), shape(Entity::new("trianglemesh"))]);
    document.camera = Some(crate::document::CameraEntity {
        entity: Entity::new("perspectiv"),
        world_from_camera: still(Transform::IDENTITY),
        medium: String::new(),
    });
    document.lights.push(placed_light(Entity::new("pont")));
    document.sampler = Some(Entity::new("sobl"));
    document.filter = Some(Entity::new("bx"));
    let (scene, problems) = build(&document);
    assert!(scene.is_none());
    assert_eq!(problems.len(), 6, "{problems:?}");
    assert!(problems.iter().all(|problem| problem.severity == Severity::Error));
}
