//! Measures building and tracing: `cargo run --release -p etendue-geometry --example rays_per_second [n]`.
//!
//! The mesh is a bumpy ball of n * n triangles (default 1024). Incoherent rays go from random points of the box
//! around it in random directions; coherent ones form a picture of it. One thread traces.

use std::time::Instant;

use etendue_geometry::{GeometryBuilder, Shape, TriangleMesh};
use etendue_math::{AnimatedTransform, Point3, Ray, Rng, Transform, Vector3, warp};

/// A grid over the sphere of directions with a radius that varies on several scales.
fn bumpy_ball(n_phi: u32) -> TriangleMesh {
    let n_theta = n_phi / 2;
    let mut mesh = TriangleMesh::default();
    for j in 0..=n_theta {
        for i in 0..=n_phi {
            let theta = std::f32::consts::PI * j as f32 / n_theta as f32;
            let phi = std::f32::consts::TAU * i as f32 / n_phi as f32;
            let bumps = (7.0 * theta).sin() * (9.0 * phi).cos() + 0.3 * (41.0 * theta + 53.0 * phi).sin();
            let r = 1.0 + 0.1 * bumps;
            mesh.positions.push(Point3::new(
                r * theta.sin() * phi.cos(),
                r * theta.sin() * phi.sin(),
                r * theta.cos(),
            ));
        }
    }
    for j in 0..n_theta {
        for i in 0..n_phi {
            let a = j * (n_phi + 1) + i;
            let b = a + n_phi + 1;
            mesh.indices.push([a, b, a + 1]);
            mesh.indices.push([a + 1, b, b + 1]);
        }
    }
    mesh
}

#[expect(clippy::print_stdout, reason = "the purpose of this program")]
fn main() {
    let n_phi = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(1024);
    let mesh = bumpy_ball(n_phi);
    let n_triangles = mesh.indices.len();
    let mut builder = GeometryBuilder::new();
    builder.add(Shape::Triangles(mesh), &AnimatedTransform::constant(Transform::IDENTITY), false);
    let start = Instant::now();
    let geometry = builder.build();
    println!(
        "{n_triangles} triangles, built in {:.3} s, hierarchy {:.1} bytes per triangle, all {:.1}",
        start.elapsed().as_secs_f64(),
        geometry.hierarchy_bytes() as f64 / n_triangles as f64,
        geometry.memory_bytes() as f64 / n_triangles as f64
    );
    let mut rng = Rng::new(1, 0);
    let rays: Vec<Ray> = (0..1_000_000)
        .map(|_| {
            let mut coordinate = || 2.4 * rng.next_f32() - 1.2;
            let origin = Point3::new(coordinate(), coordinate(), coordinate());
            Ray::new(origin, warp::sample_uniform_sphere(rng.next_point2()))
        })
        .collect();
    let coherent: Vec<Ray> = (0..1_000_000)
        .map(|i| {
            let (x, y) = ((i % 1000) as f32 / 500.0 - 1.0, (i / 1000) as f32 / 500.0 - 1.0);
            Ray::new(Point3::new(0.0, 0.0, 3.0), Vector3::new(0.6 * x, 0.6 * y, -1.0).normalized())
        })
        .collect();
    for (name, rays) in [("incoherent", &rays), ("coherent", &coherent)] {
        let start = Instant::now();
        let n_hits =
            rays.iter().filter(|ray| geometry.intersect(ray, f32::INFINITY, &|_| true).is_some()).count();
        let nearest = rays.len() as f64 / start.elapsed().as_secs_f64();
        let start = Instant::now();
        let n_occluded = rays.iter().filter(|ray| geometry.occluded(ray, f32::INFINITY, &|_| true)).count();
        let any = rays.len() as f64 / start.elapsed().as_secs_f64();
        println!(
            "{name}: {:.2} M rays/s nearest, {:.2} M rays/s any, {n_hits} hits, {n_occluded} occluded",
            nearest / 1e6,
            any / 1e6
        );
    }
}
