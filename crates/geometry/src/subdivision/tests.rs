use etendue_math::{Point3, Vector3};

use super::{even_weight, limit_weight};
use crate::TriangleMesh;
use crate::loop_subdivide;
use crate::test_support::{assert_close, octahedron};

fn tetrahedron() -> TriangleMesh {
    let p = Point3::new;
    TriangleMesh {
        positions: vec![p(1.0, 1.0, 1.0), p(1.0, -1.0, -1.0), p(-1.0, 1.0, -1.0), p(-1.0, -1.0, 1.0)],
        indices: vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
        ..TriangleMesh::default()
    }
}

/// The limit of a vertex is a fixed weighted mean of its neighbours, whatever the number of levels.
#[test]
fn vertices_go_to_their_limit_at_any_level() {
    for mesh in [tetrahedron(), octahedron()] {
        let n = mesh.positions.len();
        let direct = loop_subdivide(&mesh, 0);
        for levels in 1..4 {
            let refined = loop_subdivide(&mesh, levels);
            assert_eq!(refined.indices.len(), mesh.indices.len() << (2 * levels));
            // Closed surfaces of genus 0: V - E + F = 2 with 2 E = 3 F.
            assert_eq!(refined.positions.len(), refined.indices.len() / 2 + 2);
            refined.validate().expect("a valid mesh");
            for vertex in 0..n {
                assert_close(
                    refined.positions[vertex].as_vector(),
                    direct.positions[vertex].as_vector(),
                    1e-6,
                );
                let (a, b) = (refined.normals[vertex], direct.normals[vertex]);
                assert_close(a.as_vector(), b.as_vector(), 1e-5);
            }
        }
    }
}

/// For valence 3 the neighbours weigh 3/16 and, in the limit, 1/5 each.
#[test]
fn a_corner_of_the_tetrahedron_goes_where_the_weights_say() {
    assert!((even_weight(3) - 3.0 / 16.0).abs() < 1e-15);
    assert!((limit_weight(3) - 0.2).abs() < 1e-15);
    assert!((limit_weight(6) - 1.0 / 12.0).abs() < 1e-15);
    // (1 - 3/5) p - p / 5, since the four corners sum to zero.
    let limit = loop_subdivide(&tetrahedron(), 2).positions[0];
    assert_close(limit.as_vector(), Vector3::splat(0.2), 1e-6);
}

/// Normals are perpendicular to the surface and point against the winding.
#[test]
fn limit_normals_are_those_of_the_surface() {
    let mesh = loop_subdivide(&octahedron(), 4);
    for face in &mesh.indices {
        let [a, b, c] = face.map(|v| mesh.positions[v as usize]);
        let winding = (b - a).cross(c - a).normalized();
        for &v in face {
            let n = mesh.normals[v as usize];
            assert!((n.length() - 1.0).abs() < 1e-5);
            assert!(n.dot_vector(winding) < -0.95, "{n:?} {winding:?}");
        }
    }
}

/// Open edges follow their own curve: a flat sheet stays flat and its straight border straight.
#[test]
fn open_edges_stay_on_their_curve() {
    let p = Point3::new;
    let mut mesh = TriangleMesh::default();
    for j in 0..4_u32 {
        for i in 0..4_u32 {
            mesh.positions.push(p(i as f32, j as f32, 0.0));
        }
    }
    for j in 0..3 {
        for i in 0..3 {
            let a = j * 4 + i;
            mesh.indices.push([a, a + 1, a + 5]);
            mesh.indices.push([a, a + 5, a + 4]);
        }
    }
    mesh.positions.push(p(9.0, 9.0, 9.0));
    let refined = loop_subdivide(&mesh, 3);
    assert_eq!(refined.positions[16], p(9.0, 9.0, 9.0), "a vertex without faces stays");
    for (index, (position, n)) in refined.positions.iter().zip(&refined.normals).enumerate() {
        if index == 16 {
            continue;
        }
        assert!(position.z.abs() < 1e-6 && (n.z.abs() - 1.0).abs() < 1e-5, "{position:?} {n:?}");
        assert!(n.z < 0.0, "all to one side");
        assert!(position.x > -1e-6 && position.x < 3.0 + 1e-6);
    }
    // The middle of a straight border vertex run does not move.
    assert_close(refined.positions[1].as_vector(), Vector3::new(1.0, 0.0, 0.0), 1e-6);
}

/// Edges of three faces and faces of opposite winding do not hang the subdivision.
#[test]
fn broken_topology_terminates() {
    let mut mesh = octahedron();
    mesh.indices.push([0, 2, 1]);
    mesh.indices.push([0, 2, 3]);
    mesh.indices[1].swap(0, 1);
    let refined = loop_subdivide(&mesh, 2);
    refined.validate().expect("a valid mesh");
    assert!(loop_subdivide(&TriangleMesh::default(), 3).indices.is_empty());
}
