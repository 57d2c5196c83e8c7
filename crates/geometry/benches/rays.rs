//! Building and tracing: `cargo bench -p etendue-geometry`. One thread traces; the column "fastest" is the one to
//! read on a machine that does other things too.
//!
//! The mesh is a terrain of 1.62 million triangles. Camera rays are coherent; rays that scatter from what they hit are
//! not, and random rays, in any direction from anywhere in the box of the terrain, even less; shadow rays go from what
//! camera rays hit to points of a low sun. Each kind is traced by the instructions of the processor and portably. Without `--bench`, as under `cargo test`, everything runs
//! once on a small terrain.

use std::sync::OnceLock;

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use etendue_geometry::{Geometry, GeometryBuilder, Shape, TriangleMesh};
use etendue_math::{
    AnimatedTransform, Bounds3, Frame, Point3, Ray, Rng, Transform, Vector3, offset_ray_origin, warp,
};

#[expect(clippy::print_stdout, reason = "the memory belongs to the result")]
fn main() {
    if is_measured() {
        let geometry = &landscape().geometry;
        let n = geometry.counts().n_triangles as f64;
        let [hierarchy, all] = [geometry.hierarchy_bytes(), geometry.memory_bytes()].map(|b| b as f64 / n);
        println!("{n} triangles; bytes for each: hierarchy {hierarchy:.1}, all {all:.1}");
    }
    divan::main();
}

fn is_measured() -> bool {
    std::env::args().any(|argument| argument == "--bench")
}

/// Hills on several scales over the square [-1, 1]^2; z points up.
fn terrain(n: u32) -> TriangleMesh {
    let coordinate = |i: u32| 2.0 * i as f32 / n as f32 - 1.0;
    let mut mesh = TriangleMesh::default();
    for (j, i) in (0..=n).flat_map(|j| (0..=n).map(move |i| (j, i))) {
        let (x, y) = (coordinate(i), coordinate(j));
        let octave = |k: i32| {
            let f = 2.0_f32.powi(k);
            (f * (3.1 * x + 1.7 * y) + k as f32).sin() * (f * (2.9 * y - 1.3 * x)).cos() / f
        };
        mesh.positions.push(Point3::new(x, y, 0.12 * (0..7).map(octave).sum::<f32>()));
    }
    for (j, i) in (0..n).flat_map(|j| (0..n).map(move |i| (j, i))) {
        let a = j * (n + 1) + i;
        let b = a + n + 1;
        mesh.indices.extend([[a, a + 1, b], [a + 1, b + 1, b]]);
    }
    mesh
}

fn builder(mesh: TriangleMesh) -> GeometryBuilder {
    let mut builder = GeometryBuilder::new();
    builder.add(Shape::Triangles(mesh), &AnimatedTransform::constant(Transform::IDENTITY), false);
    builder
}

/// The terrain with rays of each kind.
struct Landscape {
    geometry: Geometry,
    portable: Geometry,
    camera: Vec<Ray>,
    random: Vec<Ray>,
    scattered: Vec<Ray>,
    shadow: Vec<Ray>,
}

fn landscape() -> &'static Landscape {
    static LANDSCAPE: OnceLock<Landscape> = OnceLock::new();
    LANDSCAPE.get_or_init(|| if is_measured() { Landscape::new(900, 256) } else { Landscape::new(24, 16) })
}

impl Landscape {
    /// A terrain of 2 n^2 triangles in a picture of `width`^2 pixels.
    fn new(n: u32, width: u32) -> Self {
        let geometry = builder(terrain(n)).build();
        let eye = Point3::new(0.0, -1.6, 0.9);
        let frame = Frame::from_z(Vector3::new(0.0, 1.5, -0.85).normalized());
        let offset = |i: u32| (i as f32 + 0.5) / width as f32 - 0.5;
        let camera: Vec<Ray> = (0..width * width)
            .map(|k| Vector3::new(offset(k % width), offset(k / width), 1.0).normalized())
            .map(|direction| Ray::new(eye, frame.to_world(direction)))
            .collect();
        let mut rng = Rng::new(1, 0);
        let (mut scattered, mut shadow) = (Vec::new(), Vec::new());
        let Bounds3 { min, max } = geometry.bounds();
        let mut random_ray = |_: &Ray| {
            let [x, y, z] = [rng.next_f32(), rng.next_f32(), rng.next_f32()];
            let origin = min + Vector3::new(x * (max - min).x, y * (max - min).y, z * (max - min).z);
            Ray::new(origin, warp::sample_uniform_sphere(rng.next_point2()))
        };
        let random = camera.iter().map(&mut random_ray).collect();
        for ray in &camera {
            let Some(hit) = geometry.intersect(ray, f32::INFINITY, &|_| true) else { continue };
            let point = geometry.surface_point(ray, &hit);
            let up = Frame::from_z(point.ng.as_vector());
            let spawn = |w: Vector3| Ray::new(offset_ray_origin(point.p, point.p_error, point.ng, w), w);
            scattered.push(spawn(up.to_world(warp::sample_cosine_hemisphere(rng.next_point2()))));
            let sun = Frame::from_z(Vector3::new(0.9, 0.2, 0.25).normalized());
            shadow.push(spawn(sun.to_world(warp::sample_uniform_cone(rng.next_point2(), 0.999))));
        }
        let portable = builder(terrain(n)).build().traced_portably();
        Self { geometry, portable, camera, random, scattered, shadow }
    }
}

/// Time to build the hierarchy: with all threads, per triangle.
#[divan::bench(sample_count = 3, sample_size = 1)]
fn build(bencher: Bencher) {
    let n = if is_measured() { 900 } else { 24 };
    bencher
        .counter(ItemsCount::new(2 * n * n))
        .with_inputs(|| builder(terrain(n)))
        .bench_values(|builder| builder.build());
}

/// The ways to trace.
const KERNELS: [&str; 2] = ["detected", "portable"];

impl Landscape {
    fn traced_by(&self, kernel: &str) -> &Geometry {
        if kernel == "portable" { &self.portable } else { &self.geometry }
    }
}

fn nearest(bencher: Bencher, kernel: &str, rays: &[Ray]) {
    let geometry = landscape().traced_by(kernel);
    bencher.counter(ItemsCount::new(rays.len())).bench(|| {
        let hits = rays.iter().map(|ray| geometry.intersect(black_box(ray), f32::INFINITY, &|_| true));
        hits.flatten().count()
    });
}

/// The nearest hit of camera rays.
#[divan::bench(sample_count = 30, sample_size = 1, args = KERNELS)]
fn nearest_of_camera_rays(bencher: Bencher, kernel: &str) {
    nearest(bencher, kernel, &landscape().camera);
}

/// The nearest hit of random rays.
#[divan::bench(sample_count = 30, sample_size = 1, args = KERNELS)]
fn nearest_of_random_rays(bencher: Bencher, kernel: &str) {
    nearest(bencher, kernel, &landscape().random);
}

/// The nearest hit of rays that scattered diffusely from the terrain.
#[divan::bench(sample_count = 30, sample_size = 1, args = KERNELS)]
fn nearest_of_scattered_rays(bencher: Bencher, kernel: &str) {
    nearest(bencher, kernel, &landscape().scattered);
}

/// Any hit of rays towards a low sun.
#[divan::bench(sample_count = 30, sample_size = 1, args = KERNELS)]
fn any_of_shadow_rays(bencher: Bencher, kernel: &str) {
    let geometry = landscape().traced_by(kernel);
    let shadow = &landscape().shadow;
    bencher.counter(ItemsCount::new(shadow.len())).bench(|| {
        shadow.iter().filter(|ray| geometry.occluded(black_box(ray), f32::INFINITY, &|_| true)).count()
    });
}
