//! Loop subdivision of triangle meshes.
//!
//! Each level splits every triangle into four; old and new vertices become weighted means of their neighbours, at
//! open edges of the neighbours on that edge. At last vertices are moved to where infinitely many levels would
//! take them, and normals are those of the limit surface (Loop 1987, "Smooth Subdivision Surfaces Based on
//! Triangles"; Hoppe et al. 1994, "Piecewise Smooth Surface Reconstruction" for boundaries). Normals point
//! against the winding of the triangles, as they do in pbrt-v4. Texture coordinates are dropped.

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::double;
use crate::mesh::TriangleMesh;

#[cfg(test)]
mod tests;

const NONE: u32 = u32::MAX;

/// Refines a mesh `levels` times by Loop's rules and moves the vertices to the limit surface, with normals there.
///
/// The number of triangles grows by a factor of four per level. Edges should have at most two triangles.
#[must_use]
pub fn loop_subdivide(mesh: &TriangleMesh, levels: u32) -> TriangleMesh {
    let mut positions: Vec<DVec3> = mesh.positions.iter().map(|p| double::point(*p)).collect();
    let mut topology = Topology::new(mesh.indices.clone(), positions.len());
    for _ in 0..levels {
        (positions, topology) = refine(&positions, &topology);
    }
    let rings: Vec<Ring> = (0..positions.len() as u32).map(|vertex| topology.ring(vertex)).collect();
    let limit: Vec<DVec3> = rings
        .iter()
        .enumerate()
        .map(|(vertex, ring)| match ring {
            Ring::Closed(ring) => weight_closed(&positions, vertex, ring, limit_weight(ring.len())),
            Ring::Open(ring) => weight_open(&positions, vertex, ring, 1.0 / 5.0),
            Ring::None => positions[vertex],
        })
        .collect();
    let normals = rings.iter().enumerate().map(|(vertex, ring)| limit_normal(&limit, vertex, ring));
    TriangleMesh {
        normals: normals.map(|n| double::to_normal(n.normalize_or_zero())).collect(),
        positions: limit.iter().map(|p| double::to_point(*p)).collect(),
        indices: topology.faces,
        ..TriangleMesh::default()
    }
}

/// Which faces touch.
struct Topology {
    faces: Vec<[u32; 3]>,
    /// Face beyond the edge from corner k to corner k + 1.
    neighbours: Vec<[u32; 3]>,
    /// Some face of each vertex.
    start_faces: Vec<u32>,
}

/// Neighbours of a vertex in order.
enum Ring {
    /// The vertex belongs to no face.
    None,
    /// All around.
    Closed(Vec<u32>),
    /// From one open edge to the other.
    Open(Vec<u32>),
}

const fn next(corner: usize) -> usize {
    (corner + 1) % 3
}

const fn previous(corner: usize) -> usize {
    (corner + 2) % 3
}

fn edge(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}

impl Topology {
    fn new(faces: Vec<[u32; 3]>, n_vertices: usize) -> Self {
        let mut neighbours = vec![[NONE; 3]; faces.len()];
        let mut start_faces = vec![NONE; n_vertices];
        let mut open = HashMap::new();
        for (index, face) in faces.iter().enumerate() {
            for corner in 0..3 {
                start_faces[face[corner] as usize] = index as u32;
                let edge = edge(face[corner], face[next(corner)]);
                match open.remove(&edge) {
                    None => {
                        open.insert(edge, (index, corner));
                    }
                    Some((other, other_corner)) => {
                        neighbours[index][corner] = other as u32;
                        neighbours[other][other_corner] = index as u32;
                    }
                }
            }
        }
        Self { faces, neighbours, start_faces }
    }

    fn corner(&self, face: u32, vertex: u32) -> usize {
        self.faces[face as usize].iter().position(|&v| v == vertex).unwrap_or(0)
    }

    fn next_face(&self, face: u32, vertex: u32) -> u32 {
        self.neighbours[face as usize][self.corner(face, vertex)]
    }

    fn previous_face(&self, face: u32, vertex: u32) -> u32 {
        self.neighbours[face as usize][previous(self.corner(face, vertex))]
    }

    fn next_vertex(&self, face: u32, vertex: u32) -> u32 {
        self.faces[face as usize][next(self.corner(face, vertex))]
    }

    fn previous_vertex(&self, face: u32, vertex: u32) -> u32 {
        self.faces[face as usize][previous(self.corner(face, vertex))]
    }

    fn ring(&self, vertex: u32) -> Ring {
        let start = self.start_faces[vertex as usize];
        if start == NONE {
            return Ring::None;
        }
        let mut ring = Vec::with_capacity(6);
        let mut face = start;
        // Faces of opposite winding could lead in circles that miss the start.
        for _ in 0..self.faces.len() {
            ring.push(self.next_vertex(face, vertex));
            let beyond = self.next_face(face, vertex);
            if beyond == start {
                return Ring::Closed(ring);
            }
            if beyond == NONE {
                break;
            }
            face = beyond;
        }
        ring.clear();
        ring.push(self.next_vertex(face, vertex));
        for _ in 0..self.faces.len() {
            ring.push(self.previous_vertex(face, vertex));
            face = self.previous_face(face, vertex);
            if face == NONE {
                break;
            }
        }
        Ring::Open(ring)
    }
}

/// One level.
fn refine(positions: &[DVec3], topology: &Topology) -> (Vec<DVec3>, Topology) {
    let mut refined: Vec<DVec3> = (0..positions.len())
        .map(|vertex| match topology.ring(vertex as u32) {
            Ring::Closed(ring) => weight_closed(positions, vertex, &ring, even_weight(ring.len())),
            Ring::Open(ring) => weight_open(positions, vertex, &ring, 1.0 / 8.0),
            Ring::None => positions[vertex],
        })
        .collect();
    let mut edge_vertices = HashMap::new();
    let mut faces = Vec::with_capacity(4 * topology.faces.len());
    for (index, face) in topology.faces.iter().enumerate() {
        let odd: [u32; 3] = std::array::from_fn(|corner| {
            *edge_vertices.entry(edge(face[corner], face[next(corner)])).or_insert_with(|| {
                refined.push(odd_position(positions, topology, index, corner));
                (refined.len() - 1) as u32
            })
        });
        faces.push([face[0], odd[0], odd[2]]);
        faces.push([odd[0], face[1], odd[1]]);
        faces.push([odd[2], odd[1], face[2]]);
        faces.push(odd);
    }
    let n_vertices = refined.len();
    (refined, Topology::new(faces, n_vertices))
}

/// The new vertex on an edge.
fn odd_position(positions: &[DVec3], topology: &Topology, face: usize, corner: usize) -> DVec3 {
    let [a, b, c] = [corner, next(corner), previous(corner)].map(|corner| topology.faces[face][corner]);
    let position = |vertex: u32| positions[vertex as usize];
    let neighbour = topology.neighbours[face][corner];
    if neighbour == NONE {
        return (position(a) + position(b)) * 0.5;
    }
    let opposite =
        topology.faces[neighbour as usize].iter().copied().find(|&v| v != a && v != b).unwrap_or(c);
    (position(a) + position(b)) * 0.375 + (position(c) + position(opposite)) * 0.125
}

/// Weight of each neighbour when a vertex is smoothed.
fn even_weight(valence: usize) -> f64 {
    if valence == 3 { 3.0 / 16.0 } else { 3.0 / (8.0 * valence as f64) }
}

/// Weight of each neighbour in the limit.
fn limit_weight(valence: usize) -> f64 {
    1.0 / (valence as f64 + 3.0 / (8.0 * even_weight(valence)))
}

fn weight_closed(positions: &[DVec3], vertex: usize, ring: &[u32], weight: f64) -> DVec3 {
    let sum: DVec3 = ring.iter().map(|&v| positions[v as usize]).sum();
    positions[vertex] * (1.0 - ring.len() as f64 * weight) + sum * weight
}

fn weight_open(positions: &[DVec3], vertex: usize, ring: &[u32], weight: f64) -> DVec3 {
    let (first, last) = (ring[0] as usize, ring[ring.len() - 1] as usize);
    positions[vertex] * (1.0 - 2.0 * weight) + (positions[first] + positions[last]) * weight
}

/// Cross product of two tangents of the limit surface.
fn limit_normal(positions: &[DVec3], vertex: usize, ring: &Ring) -> DVec3 {
    match ring {
        Ring::None => DVec3::ZERO,
        Ring::Closed(ring) => {
            let step = TAU / ring.len() as f64;
            let (mut s, mut t) = (DVec3::ZERO, DVec3::ZERO);
            for (k, &neighbour) in ring.iter().enumerate() {
                let (sin, cos) = (step * k as f64).sin_cos();
                s += positions[neighbour as usize] * cos;
                t += positions[neighbour as usize] * sin;
            }
            s.cross(t)
        }
        Ring::Open(ring) => {
            let p: Vec<DVec3> = ring.iter().map(|&v| positions[v as usize]).collect();
            let s = p[p.len() - 1] - p[0];
            s.cross(across_boundary(positions[vertex], &p))
        }
    }
}

/// The tangent at an open edge that points into the surface.
fn across_boundary(vertex: DVec3, ring: &[DVec3]) -> DVec3 {
    let last = ring.len() - 1;
    match ring.len() {
        2 => ring[0] + ring[1] - vertex * 2.0,
        3 => ring[1] - vertex,
        4 => (ring[1] + ring[2]) * 2.0 - ring[0] - ring[3] - vertex * 2.0,
        n => {
            let theta = PI / (n - 1) as f64;
            let mut tangent = (ring[0] + ring[last]) * theta.sin();
            for (k, p) in ring.iter().enumerate().take(last).skip(1) {
                tangent += *p * ((2.0 * theta.cos() - 2.0) * (k as f64 * theta).sin());
            }
            -tangent
        }
    }
}
