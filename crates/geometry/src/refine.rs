//! Triangle meshes made finer by splitting edges, so that neighbours stay joined (SPEC GEO-11).
//!
//! Vertices at the same place are one *site*, whatever their texture coordinates: an edge is split, and its middle moved, by what
//! its sites say, so that no crack opens along seams.

mod displace;
mod fractal;
#[cfg(test)]
mod tests;

use std::collections::HashMap;
use std::fmt;

use etendue_math::{Normal3, Point2};
use glam::DVec3;

pub use displace::Refined;
pub use fractal::Fractal;
pub(crate) use fractal::gaussian;

use crate::double;
use crate::mesh::TriangleMesh;

/// A mesh is not refined beyond so many triangles.
pub const MAX_REFINED_TRIANGLES: usize = 1 << 23;

/// Why a mesh is not refined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooManyTriangles {
    /// How many the next step would have made.
    pub found: usize,
}

impl fmt::Display for TooManyTriangles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "this makes {} triangles or more, but at most {MAX_REFINED_TRIANGLES} are possible",
            self.found
        )
    }
}

impl std::error::Error for TooManyTriangles {}

/// A mesh whose edges can be split.
#[derive(Clone, Debug)]
struct Refiner {
    faces: Vec<[u32; 3]>,
    /// Site of each vertex.
    sites: Vec<u32>,
    /// Texture coordinates of each vertex, if there are any.
    uvs: Vec<Point2>,
    /// Normal of each vertex as given by the mesh or by its faces.
    normals: Vec<DVec3>,
    /// Position of each site.
    positions: Vec<DVec3>,
}

/// Two vertices or sites, the lower one first.
type Edge = (u32, u32);

const fn edge(a: u32, b: u32) -> Edge {
    if a < b { (a, b) } else { (b, a) }
}

impl Refiner {
    /// A mesh as it is.
    fn new(mesh: TriangleMesh) -> Self {
        let mut positions = Vec::new();
        let mut known = HashMap::new();
        let mut sites = Vec::with_capacity(mesh.positions.len());
        for p in &mesh.positions {
            // Adding 0 makes -0 to 0.
            let key = [p.x + 0.0, p.y + 0.0, p.z + 0.0].map(f32::to_bits);
            sites.push(*known.entry(key).or_insert_with(|| {
                positions.push(double::point(*p));
                positions.len() as u32 - 1
            }));
        }
        let mut refiner = Self { faces: mesh.indices, sites, uvs: mesh.uvs, normals: Vec::new(), positions };
        refiner.normals = if mesh.normals.is_empty() {
            let of_sites = refiner.site_normals();
            refiner.sites.iter().map(|&site| of_sites[site as usize]).collect()
        } else {
            mesh.normals.iter().map(|n| double::normal(*n).normalize_or_zero()).collect()
        };
        refiner
    }

    /// Twice the area of a face, along its normal.
    fn face_normal(&self, face: &[u32; 3]) -> DVec3 {
        let [a, b, c] = face.map(|vertex| self.positions[self.sites[vertex as usize] as usize]);
        (b - a).cross(c - a)
    }

    /// Means of the normals of faces around each site, weighted by area.
    fn site_normals(&self) -> Vec<DVec3> {
        let mut normals = vec![DVec3::ZERO; self.positions.len()];
        for face in &self.faces {
            let n = self.face_normal(face);
            for vertex in face {
                normals[self.sites[*vertex as usize] as usize] += n;
            }
        }
        normals.into_iter().map(DVec3::normalize_or_zero).collect()
    }

    fn site_edge(&self, a: u32, b: u32) -> Edge {
        edge(self.sites[a as usize], self.sites[b as usize])
    }

    /// Splits all edges between sites for which `is_split` holds, each in its middle; returns the new sites with the edges that they
    /// come from. Nothing changes if that makes too many triangles.
    fn split(
        &mut self,
        is_split: impl Fn(&Self, Edge) -> bool,
    ) -> Result<Vec<(u32, Edge)>, TooManyTriangles> {
        let splits = |refiner: &Self, face: &[u32; 3]| {
            let [a, b, c] = *face;
            [(a, b), (b, c), (c, a)].map(|(p, q)| is_split(refiner, refiner.site_edge(p, q)))
        };
        let n_new: usize =
            self.faces.iter().map(|face| splits(self, face).iter().filter(|s| **s).count()).sum();
        let found = self.faces.len() + n_new;
        if found > MAX_REFINED_TRIANGLES {
            return Err(TooManyTriangles { found });
        }
        let mut middles = Middles::default();
        let mut faces = Vec::with_capacity(found);
        for face in std::mem::take(&mut self.faces) {
            let splits = splits(self, &face);
            let middle: [Option<u32>; 3] = std::array::from_fn(|k| {
                splits[k].then(|| self.middle(face[k], face[(k + 1) % 3], &mut middles))
            });
            self.append_parts(face, middle, &mut faces);
        }
        self.faces = faces;
        Ok(middles.created)
    }

    /// The vertex in the middle of an edge.
    fn middle(&mut self, a: u32, b: u32, middles: &mut Middles) -> u32 {
        if let Some(vertex) = middles.vertices.get(&edge(a, b)) {
            return *vertex;
        }
        let between = self.site_edge(a, b);
        let site = *middles.sites.entry(between).or_insert_with(|| {
            let (p, q) = (self.positions[between.0 as usize], self.positions[between.1 as usize]);
            self.positions.push((p + q) * 0.5);
            let site = self.positions.len() as u32 - 1;
            middles.created.push((site, between));
            site
        });
        self.sites.push(site);
        let (a, b) = (a as usize, b as usize);
        self.normals.push((self.normals[a] + self.normals[b]).normalize_or(self.normals[a]));
        if !self.uvs.is_empty() {
            self.uvs.push(self.uvs[a].lerp(self.uvs[b], 0.5));
        }
        let vertex = self.sites.len() as u32 - 1;
        middles.vertices.insert(edge(a as u32, b as u32), vertex);
        vertex
    }

    /// The parts of a face whose edges, from corner k to k + 1, may have a vertex in the middle.
    fn append_parts(&self, face: [u32; 3], middle: [Option<u32>; 3], faces: &mut Vec<[u32; 3]>) {
        let [a, b, c] = face;
        match middle {
            [None, None, None] => faces.push(face),
            [Some(ab), Some(bc), Some(ca)] => {
                faces.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]])
            }
            [Some(ab), None, None] => faces.extend([[a, ab, c], [ab, b, c]]),
            [Some(ab), Some(bc), None] => {
                faces.push([ab, b, bc]);
                // The quadrilateral a, ab, bc, c is cut along its shorter diagonal.
                let p = |vertex: u32| self.positions[self.sites[vertex as usize] as usize];
                if p(a).distance_squared(p(bc)) <= p(ab).distance_squared(p(c)) {
                    faces.extend([[a, ab, bc], [a, bc, c]]);
                } else {
                    faces.extend([[a, ab, c], [ab, bc, c]]);
                }
            }
            _ => self.append_parts([b, c, a], [middle[1], middle[2], middle[0]], faces),
        }
    }

    /// The mesh with normals of its own faces. Vertices share a normal where they share a site and, if `keeps_creases`, had
    /// the same normal before.
    fn into_mesh(self, keeps_creases: bool) -> TriangleMesh {
        let mut groups = HashMap::new();
        let group = |vertex: usize| {
            let n = if keeps_creases { double::to_normal(self.normals[vertex]) } else { Normal3::splat(0.0) };
            (self.sites[vertex], [n.x, n.y, n.z].map(f32::to_bits))
        };
        for face in &self.faces {
            let n = self.face_normal(face);
            for &vertex in face {
                *groups.entry(group(vertex as usize)).or_insert(DVec3::ZERO) += n;
            }
        }
        let normal = |vertex: usize| {
            let n: DVec3 = groups.get(&group(vertex)).copied().unwrap_or_default();
            double::to_normal(n.normalize_or(self.normals[vertex]))
        };
        TriangleMesh {
            positions: self
                .sites
                .iter()
                .map(|&site| double::to_point(self.positions[site as usize]))
                .collect(),
            normals: (0..self.sites.len()).map(normal).collect(),
            indices: self.faces,
            uvs: self.uvs,
            ..TriangleMesh::default()
        }
    }
}

/// What a step of refinement has made so far.
#[derive(Debug, Default)]
struct Middles {
    vertices: HashMap<Edge, u32>,
    sites: HashMap<Edge, u32>,
    created: Vec<(u32, Edge)>,
}
