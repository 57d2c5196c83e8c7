//! Triangles whose vertices move in straight lines while the shutter is open (SPEC CAM-4).
//!
//! Corners are formed in single precision at the time of the ray, the same for all triangles of a vertex, so that meshes without
//! holes have none at any time.

#[cfg(test)]
mod tests;

use etendue_math::{Bounds3, Normal3, Point2, Point3, Ray, Transform, Vector3};

use super::{Candidate, Candidates, LocalSurface, Triangles};
use crate::bvh::intersect_triangle;
use crate::mesh::{MeshError, TriangleMesh, check_vertices, heap};

/// A triangle mesh with two places for each vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MovingMesh {
    /// The mesh at the first time.
    pub mesh: TriangleMesh,
    /// Where the vertices are at the second time.
    pub end_positions: Vec<Point3>,
    /// Their normals then; empty for those of the mesh.
    pub end_normals: Vec<Normal3>,
    /// Both times in seconds; before and after them nothing moves.
    pub times: [f32; 2],
}

impl MovingMesh {
    /// Checks all arrays.
    pub fn validate(&self) -> Result<(), MeshError> {
        self.mesh.validate()?;
        let n = self.mesh.positions.len();
        if self.end_positions.len() != n {
            let found = self.end_positions.len();
            return Err(MeshError::WrongLength { array: "positions at the end", found, expected: n });
        }
        check_vertices("positions at the end", &self.end_positions, n, |p| p.is_finite())?;
        let expected = self.mesh.normals.len();
        if !self.end_normals.is_empty() && self.end_normals.len() != expected {
            let found = self.end_normals.len();
            return Err(MeshError::WrongLength { array: "normals at the end", found, expected });
        }
        check_vertices("normals at the end", &self.end_normals, n, |n| n.is_finite())
    }
}

/// A moving mesh in the space of its group.
#[derive(Clone, Debug)]
pub(crate) struct MovingTriangles {
    start: Triangles,
    end_positions: Vec<Point3>,
    end_normals: Vec<Normal3>,
    times: [f32; 2],
}

impl MovingTriangles {
    /// Moves a mesh into the space of its group.
    pub(crate) fn new(mesh: MovingMesh, group_from_shape: &Transform, reverse_orientation: bool) -> Self {
        let MovingMesh { mesh, mut end_positions, mut end_normals, times } = mesh;
        for p in &mut end_positions {
            *p = group_from_shape.point(*p);
        }
        for n in &mut end_normals {
            let mapped = group_from_shape.normal(*n);
            *n = if reverse_orientation { -mapped } else { mapped };
        }
        let start = Triangles::new(mesh, group_from_shape, reverse_orientation);
        Self { start, end_positions, end_normals, times }
    }

    pub(crate) const fn n_primitives(&self) -> u32 {
        self.start.mesh().indices.len() as u32
    }

    fn ends(&self, triangle: u32) -> [Point3; 3] {
        self.start.mesh().indices[triangle as usize].map(|v| self.end_positions[v as usize])
    }

    /// The share of the way that vertices have gone.
    fn way(&self, time: f32) -> f32 {
        let [start, end] = self.times;
        if end > start { ((time - start) / (end - start)).clamp(0.0, 1.0) } else { 0.0 }
    }

    fn corners(&self, triangle: u32, time: f32) -> [Point3; 3] {
        let (start, end, way) = (self.start.positions(triangle), self.ends(triangle), self.way(time));
        std::array::from_fn(|k| start[k].lerp(end[k], way))
    }

    /// The box over all times, with room for rounding.
    pub(crate) fn bounds(&self, triangle: u32) -> Bounds3 {
        let bounds = self.start.bounds(triangle).union(Bounds3::from_points(self.ends(triangle)));
        let largest = bounds.min.abs().max(bounds.max.abs());
        let margin = largest.as_vector() * (4.0 * f32::EPSILON) + Vector3::splat(f32::MIN_POSITIVE);
        Bounds3 { min: bounds.min - margin, max: bounds.max + margin }
    }

    pub(crate) fn intersect(&self, triangle: u32, ray: &Ray) -> Candidates {
        let corners = self.corners(triangle, ray.time).map(|p| [p.x, p.y, p.z]);
        let hit = intersect_triangle(ray, &corners);
        [hit.map(|(t, b)| Candidate { t: t.into(), u: b[0].into(), v: b[1].into() }), None]
    }

    /// Differential geometry of the triangle as it is at the time of the ray.
    pub(crate) fn surface(&self, triangle: u32, ray: &Ray, b: [f32; 2]) -> LocalSurface {
        let way = self.way(ray.time);
        let normals = (!self.end_normals.is_empty()).then(|| {
            let vertices = self.start.mesh().indices[triangle as usize].map(|v| v as usize);
            vertices.map(|v| self.start.mesh().normals[v].lerp(self.end_normals[v], way))
        });
        self.start.alone(triangle, self.corners(triangle, ray.time), normals).surface(0, b)
    }

    pub(crate) fn uv(&self, triangle: u32, b: [f32; 2]) -> Point2 {
        self.start.uv(triangle, b)
    }

    pub(crate) fn memory_bytes(&self) -> usize {
        self.start.mesh().memory_bytes() + heap(&self.end_positions) + heap(&self.end_normals)
    }
}
