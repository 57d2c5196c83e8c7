//! Fractal surfaces by midpoint subdivision (Fournier, Fussell and Carpenter 1982, "Computer Rendering of Stochastic Models",
//! doi:10.1145/358523.358553).
//!
//! Each level splits every triangle in four and moves the new vertices along the normal by Gaussian noise of standard
//! deviation a 2^(-H level): with H near 1 the surface is smooth, near 0 rough; its fractal dimension is about 3 - H.
//! Noise is a function of seed, level and edge. Normals are those of the first mesh, interpolated, so that what grows from a
//! plane is a height field.

use std::collections::HashMap;

use etendue_math::warp::sample_normal;
use etendue_math::{hash64, unit_f32};
use glam::DVec3;

use super::{Edge, MAX_REFINED_TRIANGLES, Refiner, TooManyTriangles};
use crate::mesh::TriangleMesh;

/// How a mesh becomes a fractal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fractal {
    /// Subdivision steps; each makes four triangles of one.
    pub levels: u32,
    /// Hurst exponent H, between 0 and 1.
    pub hurst: f32,
    /// Standard deviation a of the noise in metres, before the first level.
    pub amplitude: f32,
    /// Which of all such surfaces.
    pub seed: u64,
    /// Leaves the middles of open edges where they are, so that pieces fit together.
    pub keeps_border: bool,
}

/// A normally distributed number of mean 0 and deviation 1 that belongs to these words.
pub(crate) fn gaussian(words: &[u64]) -> f64 {
    let bits = hash64(words);
    // Half a step away from 0, where the inverse of the normal distribution is infinite.
    sample_normal(unit_f32((bits >> 32) as u32).max(1.2e-10), 0.0, 1.0).into()
}

impl Fractal {
    /// Refines a mesh. Texture coordinates stay; normals are those of the new surface. Vertices at the same place move alike,
    /// so that nothing tears.
    pub fn subdivide(&self, mesh: TriangleMesh) -> Result<TriangleMesh, TooManyTriangles> {
        let found = mesh.indices.len().saturating_mul(4_usize.saturating_pow(self.levels));
        if found > MAX_REFINED_TRIANGLES {
            return Err(TooManyTriangles { found });
        }
        let mut refiner = Refiner::new(mesh);
        let mut normals = refiner.site_normals();
        for level in 1..=self.levels {
            let borders = if self.keeps_border { border(&refiner) } else { HashMap::new() };
            let created = refiner.split(|_, _| true)?;
            let scale = f64::from(self.amplitude) * (-f64::from(self.hurst) * f64::from(level)).exp2();
            for (site, between) in created {
                let n = (normals[between.0 as usize] + normals[between.1 as usize]).normalize_or_zero();
                normals.push(n);
                debug_assert_eq!(normals.len(), site as usize + 1);
                let noise = gaussian(&[self.seed, level.into(), between.0.into(), between.1.into()]);
                let height = if borders.get(&between) == Some(&1) { 0.0 } else { scale * noise };
                let p: &mut DVec3 = &mut refiner.positions[site as usize];
                *p += n * height;
            }
        }
        Ok(refiner.into_mesh(false))
    }
}

/// Number of faces at each edge.
fn border(refiner: &Refiner) -> HashMap<Edge, u32> {
    let mut counts = HashMap::new();
    for &[a, b, c] in &refiner.faces {
        for (p, q) in [(a, b), (b, c), (c, a)] {
            *counts.entry(refiner.site_edge(p, q)).or_insert(0) += 1;
        }
    }
    counts
}
