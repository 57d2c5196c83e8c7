//! Things of any number of triangles: even, strewn and uneven.

use std::f32::consts::TAU;

use etendue_geometry::TriangleMesh;
use etendue_math::{Point3, Rng, Vector3, warp};

use crate::speed::{Lamp, Model};

/// The model of a name with about `size` triangles.
pub(super) fn named(name: &str, size: u32) -> Model {
    match name {
        "cloud" => cloud(size),
        "stadium" => stadium(size),
        _ => Model::terrain((size as f32 / 2.0).sqrt().round() as u32),
    }
}

/// Triangles in a cube of side 1, as large as they are far apart.
fn cloud(size: u32) -> Model {
    let mut rng = Rng::new(5, 0);
    let mut mesh = TriangleMesh::default();
    let side = 0.5 / (size as f32).cbrt();
    for k in 0..size {
        let centre = Point3::new(rng.next_f32() - 0.5, rng.next_f32() - 0.5, rng.next_f32() - 0.5);
        for _ in 0..3 {
            mesh.positions.push(centre + warp::sample_uniform_sphere(rng.next_point2()) * side);
        }
        mesh.indices.push([3 * k, 3 * k + 1, 3 * k + 2]);
    }
    Model {
        name: "cloud".to_owned(),
        meshes: vec![mesh],
        copies: Vec::new(),
        eye: Point3::new(0.9, 0.8, 1.2),
        target: Point3::ORIGIN,
        fov_rad: 40.0_f32.to_radians(),
        lamp: lamp(Point3::new(-0.5, 1.2, -0.5), 1.0),
    }
}

/// Rows around a field.
const TIERS: u32 = 6;
/// Pieces of a row.
const PIECES: u32 = 32;

/// A rippled ring of size 1 on the field of a stadium 300 times as wide, which has 384 triangles whatever the size.
fn stadium(size: u32) -> Model {
    let mut mesh = TriangleMesh::default();
    // The profile of the stand, from the middle of the field outwards.
    add_surface(&mut mesh, TIERS, PIECES, |u, v| {
        let step = (u * TIERS as f32).round();
        let (radius, height) = ((25.0 + 20.0 * step) * step.min(1.0), (step - 2.0).max(0.0) * 12.0 - 0.5);
        Point3::new(radius * (TAU * v).cos(), height, radius * (TAU * v).sin())
    });
    let n_body = size.saturating_sub(2 * TIERS * PIECES).max(64);
    let across = (n_body as f32 / 4.0).sqrt().round() as u32;
    add_surface(&mut mesh, across, n_body / 2 / across, |u, v| {
        let (a, b) = (TAU * u, TAU * v);
        let thickness = 0.35 + 0.04 * (9.0 * b).sin() * (7.0 * a).cos();
        let radius = 0.9 + thickness * a.cos();
        Point3::new(radius * b.cos(), thickness * a.sin(), radius * b.sin())
    });
    Model {
        name: "stadium".to_owned(),
        meshes: vec![mesh],
        copies: Vec::new(),
        eye: Point3::new(1.6, 1.5, 2.4),
        target: Point3::new(0.0, -0.1, 0.0),
        fov_rad: 45.0_f32.to_radians(),
        lamp: lamp(Point3::new(10.0, 60.0, 10.0), 20.0),
    }
}

/// Two triangles for each cell of the unit square, carried by a map.
fn add_surface(mesh: &mut TriangleMesh, nu: u32, nv: u32, map: impl Fn(f32, f32) -> Point3) {
    let first = mesh.positions.len() as u32;
    for (j, i) in (0..=nv).flat_map(|j| (0..=nu).map(move |i| (j, i))) {
        mesh.positions.push(map(i as f32 / nu as f32, j as f32 / nv as f32));
    }
    for (j, i) in (0..nv).flat_map(|j| (0..nu).map(move |i| (j, i))) {
        let a = first + j * (nu + 1) + i;
        mesh.indices.extend([[a, a + 1, a + nu + 2], [a, a + nu + 2, a + nu + 1]]);
    }
}

fn lamp(corner: Point3, side: f32) -> Lamp {
    Lamp { corner, edges: [Vector3::new(side, 0.0, 0.0), Vector3::new(0.0, 0.0, side)] }
}
