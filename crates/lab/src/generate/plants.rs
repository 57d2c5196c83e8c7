//! Trees of triangles.

use std::f32::consts::TAU;

use etendue_math::{Point3, Rng, Vector3};
use etendue_scene::LoadedMesh;

/// Leaves at random places within a ball, turned at random: two triangles each.
pub(super) fn crown(centre: [f32; 3], radius: f32, n_leaves: u32, seed: u64) -> LoadedMesh {
    let mut rng = Rng::new(seed, 0);
    let mut mesh = LoadedMesh::default();
    let [x, y, z] = centre;
    for _ in 0..n_leaves {
        let away = unit(&mut rng);
        // Denser outside, where the light is.
        let distance = radius * rng.next_f32().powf(0.25) * (0.75 + 0.25 * rng.next_f32());
        let p = Point3::new(x, y, z) + Vector3::new(away.x, 0.8 * away.y, away.z) * distance;
        let length = unit(&mut rng) * (0.055 * radius);
        let width = unit(&mut rng) * (0.025 * radius);
        leaf(&mut mesh, p, length, width);
    }
    mesh
}

/// A random direction.
fn unit(rng: &mut Rng) -> Vector3 {
    let y = 2.0 * rng.next_f32() - 1.0;
    let (sine, cosine) = (TAU * rng.next_f32()).sin_cos();
    let radius = (1.0 - y * y).max(0.0).sqrt();
    Vector3::new(radius * cosine, y, radius * sine)
}

/// A rhombus.
fn leaf(mesh: &mut LoadedMesh, stem: Point3, length: Vector3, width: Vector3) {
    let first = mesh.positions.len() as u32;
    let middle = stem + length * 0.5;
    mesh.positions.extend([stem, middle + width, stem + length, middle - width]);
    mesh.triangles.extend([[0, 1, 2], [0, 2, 3]].map(|corners| corners.map(|k| first + k)));
}

/// A fir of height 1 that stands on y = 0: a trunk, and whorls of branches with bundles of needles; `n_needles` on each
/// branch, two triangles each.
pub(super) fn fir(n_needles: u32, seed: u64) -> LoadedMesh {
    let mut rng = Rng::new(seed, 0);
    let mut mesh = LoadedMesh::default();
    trunk(&mut mesh);
    for whorl in 0..N_WHORLS {
        let t = whorl as f32 / N_WHORLS as f32;
        let height = 0.08 + 0.9 * t;
        for branch in 0..N_BRANCHES {
            let turn = TAU * (branch as f32 + 0.6 * rng.next_f32()) / N_BRANCHES as f32 + 2.4 * t * TAU;
            let length = (0.24 * (1.0 - t).powf(0.8) + 0.015) * (0.8 + 0.4 * rng.next_f32());
            let (sine, cosine) = turn.sin_cos();
            let start = Point3::new(0.0, height + 0.02 * (rng.next_f32() - 0.5), 0.0);
            // Branches droop more the lower they are.
            let along = Vector3::new(cosine, -0.45 + 0.6 * t, sine) * length;
            for k in 0..n_needles {
                let s = (k as f32 + rng.next_f32()) / n_needles as f32;
                let spread = unit(&mut rng);
                let needle = (along * 0.12 + spread * (0.12 * length + 0.012)) * (1.1 - 0.6 * s);
                leaf(&mut mesh, start + along * s, needle, unit(&mut rng) * (0.13 * needle.length()));
            }
        }
    }
    mesh
}

const N_WHORLS: u32 = 18;
const N_BRANCHES: u32 = 15;

/// A thin pyramid.
fn trunk(mesh: &mut LoadedMesh) {
    let top = mesh.positions.len() as u32;
    mesh.positions.push(Point3::new(0.0, 1.0, 0.0));
    let n = 6;
    for k in 0..n {
        let (sine, cosine) = (TAU * k as f32 / n as f32).sin_cos();
        mesh.positions.push(Point3::new(0.016 * cosine, 0.0, 0.016 * sine));
        mesh.triangles.push([top, top + 1 + (k + 1) % n, top + 1 + k]);
    }
}
