//! Samples per second of path tracing: `cargo bench -p etendue-transport`. One thread renders; the column "fastest"
//! is the one to read on a machine that does other things too.
//!
//! The scene is a diffuse Cornell box of 1 m with two blocks and an area lamp, 32 triangles, at most 8 scattering
//! events: tracing costs little there, so that shading, spectra and random numbers show. Without `--bench`, as under
//! `cargo test`, a small picture is rendered once.

use divan::Bencher;
use divan::counter::ItemsCount;
use etendue_math::{AnimatedTransform, Point3, SamplerKind, Transform, Vector3};
use etendue_scene::document::{
    CameraEntity, Document, Entity, MaterialEntity, MaterialReference, ShapeEntity, Value,
};
use etendue_scene::{Assets, Film, Scene};
use etendue_transport::lpe::PathExpressions;
use etendue_transport::path_tracing::{PathSettings, PathTracer};
use etendue_transport::{Stop, Unobserved, render};

fn main() {
    divan::main();
}

type Quad = [Point3; 4];

/// The parallelogram at `corner`; its normal is `u` x `v`.
fn quad(corner: [f32; 3], u: [f32; 3], v: [f32; 3]) -> Quad {
    let vector = |[x, y, z]: [f32; 3]| Vector3::new(x, y, z);
    let (p, u, v) = (Point3::ORIGIN + vector(corner), vector(u), vector(v));
    [p, p + u, p + u + v, p + v]
}

/// A block on the floor with a square base, turned about the vertical; its sides and top.
fn block(center: [f32; 2], width: f32, height: f32, angle_deg: f32) -> Vec<Quad> {
    let (sin, cos) = angle_deg.to_radians().sin_cos();
    let corner = |x: f32, z: f32| [center[0] + cos * x + sin * z, center[1] - sin * x + cos * z];
    let e = 0.5 * width;
    let base = [corner(-e, -e), corner(e, -e), corner(e, e), corner(-e, e)];
    let point = |[x, z]: [f32; 2], y: f32| Point3::new(x, y, z);
    let side = |i: usize| {
        let (a, b) = (base[i], base[(i + 1) % 4]);
        [point(b, 0.0), point(a, 0.0), point(a, height), point(b, height)]
    };
    let top = [3, 2, 1, 0].map(|i| point(base[i], height));
    (0..4).map(side).chain([top]).collect()
}

fn shape(quads: &[Quad], material: usize, area_light: Option<usize>) -> ShapeEntity {
    let n = quads.len() as i32;
    let indices = (0..n).flat_map(|i| [0, 1, 2, 0, 2, 3].map(|corner| 4 * i + corner)).collect();
    let positions = quads.iter().flatten().copied().collect();
    ShapeEntity {
        entity: Entity::new("trianglemesh")
            .with("indices", Value::Integers(indices))
            .with("P", Value::Points3(positions)),
        world_from_object: AnimatedTransform::constant(Transform::IDENTITY),
        reverse_orientation: false,
        material: MaterialReference::Index(material),
        area_light,
        inside_medium: String::new(),
        outside_medium: String::new(),
        has_medium_interface: false,
    }
}

fn cornell_box(width: i32) -> Scene {
    let mut white = vec![
        quad([-0.5, 0.0, 0.5], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]),
        quad([-0.5, 1.0, -0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
        quad([-0.5, 0.0, -0.5], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
    ];
    white.extend(block([-0.17, -0.15], 0.3, 0.6, 17.0));
    white.extend(block([0.17, 0.17], 0.3, 0.3, -17.0));
    let red = [quad([-0.5, 0.0, 0.5], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0])];
    let green = [quad([0.5, 0.0, -0.5], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0])];
    let lamp = [quad([-0.13, 0.999, -0.11], [0.26, 0.0, 0.0], [0.0, 0.0, 0.22])];
    let diffuse = |rgb: [f32; 3]| MaterialEntity {
        name: None,
        entity: Entity::new("diffuse").with("reflectance", Value::Rgb(vec![rgb])),
    };
    let look = Transform::look_at(
        Point3::new(0.0, 0.5, 1.9),
        Point3::new(0.0, 0.5, 0.0),
        Vector3::new(0.0, 1.0, 0.0),
    );
    let document = Document {
        camera: Some(CameraEntity {
            entity: Entity::new("perspective").with("fov", Value::Floats(vec![39.0])),
            world_from_camera: AnimatedTransform::constant(look.expect("eye and target differ").inverse()),
            medium: String::new(),
        }),
        film: Some(
            Entity::new("rgb")
                .with("xresolution", Value::Integers(vec![width]))
                .with("yresolution", Value::Integers(vec![width])),
        ),
        filter: Some(Entity::new("box")),
        materials: [[0.725, 0.71, 0.68], [0.63, 0.065, 0.05], [0.14, 0.45, 0.091], [0.0; 3]]
            .map(diffuse)
            .into(),
        area_lights: vec![Entity::new("diffuse").with("L", Value::Rgb(vec![[15.0; 3]]))],
        shapes: vec![
            shape(&white, 0, None),
            shape(&red, 1, None),
            shape(&green, 2, None),
            shape(&lamp, 3, Some(0)),
        ],
        ..Document::default()
    };
    let (scene, diagnostics) = Scene::build(&document, Assets::default());
    scene.unwrap_or_else(|| panic!("the box builds: {:?}", diagnostics.list()))
}

/// A pass of one sample per pixel after the other, so that quasi-random samples are not always the first.
#[divan::bench(args = [SamplerKind::Sobol, SamplerKind::Independent], sample_count = 40, sample_size = 1)]
fn path(bencher: Bencher, sampler: SamplerKind) {
    let is_measured = std::env::args().any(|argument| argument == "--bench");
    let width: i32 = if is_measured { 128 } else { 16 };
    let mut scene = cornell_box(width);
    scene.sampler.kind = sampler;
    let settings = PathSettings { max_depth: 8, ..PathSettings::default() };
    let expressions = PathExpressions::new(&[]).expect("no expression is in error");
    let mut tracer = PathTracer::new(settings, expressions);
    let mut film = Film::new(scene.film.clone(), Vec::new());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread starts");
    bencher.counter(ItemsCount::new(width as usize * width as usize)).bench_local(|| {
        let pass = film.n_passes();
        let stop = Stop { passes: pass..pass + 1, error: None };
        pool.install(|| render(&scene, &mut tracer, &mut film, &stop, &Unobserved))
    });
    let rgb = film.develop().rgb_pixels().expect("a film has colour");
    let mean = rgb.iter().flatten().sum::<f32>() / (3 * rgb.len()) as f32;
    // What other renderers find: 0.2437, 0.2248, 0.1936. A small picture of one sample is noisy.
    let tolerance = if is_measured { 0.02 } else { 0.25 };
    assert!((mean / 0.2207 - 1.0).abs() < tolerance, "mean radiance {mean}");
}
