//! Displacement: vertices move along their normals by what a texture says, after edges have been split until they are short
//! (as `plymesh` of pbrt-v4 does).

use etendue_math::{Normal3, Point2, Point3, Transform};

use super::{Edge, MAX_REFINED_TRIANGLES, Refiner, TooManyTriangles};
use crate::double;
use crate::mesh::TriangleMesh;

/// A mesh with short edges that waits for heights.
#[derive(Clone, Debug)]
pub struct Refined {
    refiner: Refiner,
    has_normals: bool,
}

impl Refined {
    /// Splits the edges of a mesh until none is longer than `edge_length` metres in the world.
    pub fn new(
        mesh: TriangleMesh,
        edge_length: f32,
        world_from_object: &Transform,
    ) -> Result<Self, TooManyTriangles> {
        let has_normals = !mesh.normals.is_empty();
        let mut refiner = Refiner::new(mesh);
        let map = double::affine(world_from_object).matrix3;
        let length = |refiner: &Refiner, (a, b): Edge| {
            let way = refiner.positions[b as usize] - refiner.positions[a as usize];
            (map * way).length() / f64::from(edge_length)
        };
        let is_long = |refiner: &Refiner, edge: Edge| length(refiner, edge) > 1.0;
        // A face with an edge of n lengths becomes n faces or more.
        let least = |&[a, b, _]: &[u32; 3]| length(&refiner, refiner.site_edge(a, b)).max(1.0);
        let n: f64 = refiner.faces.iter().map(least).sum();
        let found = if edge_length > 0.0 { n as usize } else { usize::MAX };
        if found > MAX_REFINED_TRIANGLES {
            return Err(TooManyTriangles { found });
        }
        while !refiner.split(is_long)?.is_empty() {}
        Ok(Self { refiner, has_normals })
    }

    /// Position, unit normal and texture coordinates of each vertex.
    pub fn vertices(&self) -> impl ExactSizeIterator<Item = (Point3, Normal3, Point2)> + '_ {
        let refiner = &self.refiner;
        (0..refiner.sites.len()).map(|vertex| {
            let p = double::to_point(refiner.positions[refiner.sites[vertex] as usize]);
            let uv = refiner.uvs.get(vertex).copied().unwrap_or_default();
            (p, double::to_normal(refiner.normals[vertex]), uv)
        })
    }

    /// Moves each vertex by its height along its normal, and vertices at the same place by the mean, so that no crack opens.
    ///
    /// # Panics
    /// If there is not one height for each vertex.
    #[must_use]
    pub fn displaced(self, heights: &[f32]) -> TriangleMesh {
        let mut refiner = self.refiner;
        assert_eq!(heights.len(), refiner.sites.len(), "a height for each vertex");
        let mut moves = vec![(glam::DVec3::ZERO, 0.0); refiner.positions.len()];
        for ((&site, n), &height) in refiner.sites.iter().zip(&refiner.normals).zip(heights) {
            let (sum, count) = &mut moves[site as usize];
            *sum += *n * f64::from(height);
            *count += 1.0;
        }
        for (p, (sum, count)) in refiner.positions.iter_mut().zip(moves) {
            *p += sum / f64::max(count, 1.0);
        }
        refiner.into_mesh(self.has_normals)
    }
}
