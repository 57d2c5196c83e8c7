use std::collections::HashMap;

use etendue_math::{Point2, Point3, Transform};

use super::*;
use crate::test_support::{ball, cube};

/// A cube whose faces do not share vertices, as files with texture coordinates have it.
fn torn_cube() -> TriangleMesh {
    let whole = cube();
    let mut mesh = TriangleMesh::default();
    for (i, face) in whole.indices.iter().enumerate() {
        mesh.positions.extend(face.map(|v| whole.positions[v as usize]));
        mesh.uvs.extend([Point2::new(0.0, 0.0), Point2::new(1.0, 0.0), Point2::new(i as f32, 1.0)]);
        let first = 3 * i as u32;
        mesh.indices.push([first, first + 1, first + 2]);
    }
    mesh
}

/// Fails unless each edge of a mesh, by the places of its ends, has one face on each side.
#[track_caller]
fn assert_closed(mesh: &TriangleMesh) {
    let place = |v: u32| {
        let p = mesh.positions[v as usize];
        [p.x + 0.0, p.y + 0.0, p.z + 0.0].map(f32::to_bits)
    };
    let mut edges: HashMap<_, i32> = HashMap::new();
    for &[a, b, c] in &mesh.indices {
        for (p, q) in [(a, b), (b, c), (c, a)] {
            let (p, q) = (place(p), place(q));
            *edges.entry(if p < q { (p, q) } else { (q, p) }).or_insert(0) += if p < q { 1 } else { -1 };
        }
    }
    assert!(edges.values().all(|n| *n == 0), "an edge has a face on one side only");
}

/// What was closed stays closed, with four triangles for each and level, whether vertices were shared or not; both are the same
/// surface.
#[test]
fn fractals_of_closed_meshes_are_closed() {
    let fractal = Fractal { levels: 3, hurst: 0.8, amplitude: 0.2, seed: 5, keeps_border: true };
    let shared = fractal.subdivide(cube()).expect("small");
    let torn = fractal.subdivide(torn_cube()).expect("small");
    for mesh in [&shared, &torn] {
        assert_eq!(mesh.indices.len(), 12 * 64);
        assert!(mesh.validate().is_ok());
        assert_closed(mesh);
    }
    assert_eq!(torn.uvs.len(), torn.positions.len());
    assert!(shared.positions.iter().any(|p| p.abs().max_element() > 1.01), "nothing moved");
}

/// The border of an open mesh stays in its plane if it is to; the inside grows along the normal.
#[test]
fn borders_can_be_kept() {
    let p = Point3::new;
    let square = TriangleMesh {
        positions: vec![p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(1.0, 1.0, 0.0), p(0.0, 1.0, 0.0)],
        indices: vec![[0, 1, 2], [0, 2, 3]],
        ..TriangleMesh::default()
    };
    let fractal = Fractal { levels: 5, hurst: 0.5, amplitude: 0.3, seed: 1, keeps_border: true };
    let kept = fractal.subdivide(square.clone()).expect("small");
    let is_border = |p: &Point3| [p.x, p.y].iter().any(|x| *x == 0.0 || *x == 1.0);
    assert!(kept.positions.iter().filter(|p| is_border(p)).all(|p| p.z == 0.0));
    let free = Fractal { keeps_border: false, ..fractal }.subdivide(square).expect("small");
    assert!(free.positions.iter().filter(|p| is_border(p)).any(|p| p.z != 0.0));
    for (a, b) in kept.positions.iter().zip(&free.positions) {
        assert_eq!((a.x, a.y), (b.x, b.y), "points move along the normal");
    }
}

/// The noise of each level has the stated deviation.
#[test]
fn noise_falls_by_the_hurst_exponent_with_each_level() {
    let fractal = Fractal { levels: 7, hurst: 0.7, amplitude: 1.0, seed: 3, keeps_border: false };
    let n = 4000;
    for level in [1_u32, 4, 7] {
        let scale = f64::from(fractal.amplitude) * (-f64::from(fractal.hurst) * f64::from(level)).exp2();
        let values = (0..n).map(|i| scale * gaussian(&[fractal.seed, level.into(), i, i + 1]));
        let variance = values.map(|z| z * z).sum::<f64>() / n as f64 / (scale * scale);
        // The mean square of n unit Gaussians has a standard deviation of sqrt(2 / n).
        assert!((variance - 1.0).abs() < 4.0 * (2.0 / n as f64).sqrt(), "{variance}");
    }
}

/// Displacement splits edges until they are short in the world, moves vertices along normals, and opens no crack at seams,
/// whatever heights both sides ask for.
#[test]
fn displaced_meshes_have_short_edges_and_no_cracks() {
    let scale = Transform::scale(1.0, 2.0, 1.0).expect("invertible");
    let refined = Refined::new(torn_cube(), 0.3, &scale).expect("small");
    let mut rng = etendue_math::Rng::new(1, 0);
    let heights: Vec<f32> = refined.vertices().map(|_| 0.1 * rng.next_f32()).collect();
    let flat = refined.clone().displaced(&vec![0.0; heights.len()]);
    for &[a, b, c] in &flat.indices {
        for (p, q) in [(a, b), (b, c), (c, a)] {
            let way = scale.vector(flat.positions[q as usize] - flat.positions[p as usize]);
            assert!(way.length() <= 0.3 + 1e-6, "{way:?}");
        }
    }
    let bumpy = refined.displaced(&heights);
    assert!(bumpy.validate().is_ok());
    assert_closed(&flat);
    assert_closed(&bumpy);
    let ball = Refined::new(ball(3), 0.2, &Transform::IDENTITY).expect("small");
    let n = ball.vertices().len();
    let grown = ball.displaced(&vec![0.5; n]);
    for (p, n) in grown.positions.iter().zip(&grown.normals) {
        assert!(
            (p.as_vector().length() - 1.5).abs() < 0.02 && n.dot_vector(p.as_vector()) > 1.4,
            "{p:?} {n:?}"
        );
    }
}

/// Faces that meet at an edge keep it where the mesh has normals of its own for each.
#[test]
fn creases_of_the_mesh_are_kept() {
    let mut mesh = torn_cube();
    for face in &mesh.indices {
        let [a, b, c] = face.map(|v| mesh.positions[v as usize]);
        let n = (b - a).cross(c - a).normalized().as_normal();
        mesh.normals.extend([n; 3]);
    }
    let refined = Refined::new(mesh, 0.5, &Transform::IDENTITY).expect("small");
    let n = refined.vertices().len();
    let flat = refined.displaced(&vec![0.0; n]);
    assert!(flat.normals.iter().all(|n| n.abs().max_element() > 0.999));
}

/// Meshes do not grow beyond measure, and take no memory before that is known.
#[test]
fn too_many_triangles_are_refused() {
    let fractal = Fractal { levels: 30, hurst: 0.5, amplitude: 0.1, seed: 0, keeps_border: false };
    assert!(fractal.subdivide(cube()).is_err());
    assert!(Fractal { levels: u32::MAX, ..fractal }.subdivide(cube()).is_err());
    for length in [1e-30, 0.0, -1.0, f32::NAN] {
        assert!(Refined::new(cube(), length, &Transform::IDENTITY).is_err(), "{length}");
    }
    assert!(Refined::new(cube(), 1e-3, &Transform::IDENTITY).is_err());
}
