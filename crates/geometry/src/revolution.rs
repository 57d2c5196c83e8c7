//! Surfaces of revolution: a contour of heights and radii turned about the z axis (SPEC GEO-12).
//!
//! A point (h, r) of the contour becomes the circle (r cos φ, r sin φ, h). The curve through the points is smooth but
//! for creases (see `contour.rs`), and its normal (h', -r') in (r, z) is exact at each vertex: to the left of the contour as it
//! is read, so that one which runs upwards has its normals outside. The mesh is made of frusta of regular pyramids, whose
//! distance from the surface is at most that of chords from the curve and from the circle.

mod contour;
#[cfg(test)]
mod tests;

use std::f64::consts::{PI, TAU};

use etendue_math::{Normal3, Point2, Point3};
use glam::DVec2;

pub use contour::{ContourError, MAX_CONTOUR_POINTS};
use contour::{CurvePoint, smooth_pieces};

use crate::mesh::TriangleMesh;

/// More triangles are refused.
const MAX_TRIANGLES: f64 = (1_u32 << 24) as f64;

/// How a contour is revolved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Revolution {
    /// The contour has an edge where it turns by more than this angle, in radians.
    pub crease_rad: f32,
    /// Largest distance of the mesh from the surface, in metres; 0 or less for 10⁻⁴ of the largest extent.
    pub tolerance: f32,
    /// Azimuth up to which it is turned, in radians; 2 pi for all around.
    pub phi_max_rad: f32,
}

impl Default for Revolution {
    fn default() -> Self {
        Self { crease_rad: 80.0_f32.to_radians(), tolerance: 0.0, phi_max_rad: TAU as f32 }
    }
}

impl Revolution {
    /// The surface of a contour, given as points (height, radius), with normals and texture coordinates: u follows the
    /// azimuth, v the length of the contour. Where the contour ends on the axis or where it began, the body is closed.
    pub fn mesh(&self, contour: &[Point2]) -> Result<TriangleMesh, ContourError> {
        let pieces = smooth_pieces(contour, self.crease_rad.into())?;
        let tolerance = self.tolerance_for(contour);
        let radius = contour.iter().fold(0.0, |r: f64, p| r.max(p.y.into()));
        let phi_max = super::shape::clamp_azimuth(self.phi_max_rad.into());
        let n_sectors = sectors(radius, 0.5 * tolerance, phi_max);
        let triangles = |n_rows: usize| 2.0 * n_sectors * n_rows as f64;
        let mut n_rows = 0;
        let mut rows: Vec<Vec<CurvePoint>> = Vec::new();
        for piece in &pieces {
            let most = (MAX_TRIANGLES / triangles(1)) as usize;
            let row = piece.flattened(0.5 * tolerance, most - n_rows.min(most));
            n_rows += row.len();
            rows.push(row);
            if triangles(n_rows) > MAX_TRIANGLES {
                return Err(ContourError::TooFine { n_triangles: triangles(n_rows) });
            }
        }
        let length = rows.last().and_then(|row| row.last()).map_or(1.0, |point| point.s);
        let mut lathe = Lathe::new(n_sectors as u32, phi_max, length);
        for row in rows {
            lathe.turn(&row);
        }
        Ok(lathe.mesh)
    }

    fn tolerance_for(&self, contour: &[Point2]) -> f64 {
        if self.tolerance > 0.0 {
            return self.tolerance.into();
        }
        let (mut lower, mut upper) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for p in contour {
            lower = lower.min(DVec2::new(p.x.into(), 0.0));
            upper = upper.max(DVec2::new(p.x.into(), p.y.into()));
        }
        1e-4 * (upper - lower).max_element()
    }
}

/// Sides of a polygon in a circle whose chords are no farther from it than `tolerance`: r (1 - cos(pi / n)).
fn sectors(radius: f64, tolerance: f64, phi_max: f64) -> f64 {
    let half_angle = (1.0 - tolerance / radius).clamp(-1.0, 1.0).acos();
    (PI / half_angle).max(8.0).mul_add(phi_max / TAU, 0.0).ceil().max(1.0)
}

/// A mesh that grows by turning rows of points.
struct Lathe {
    mesh: TriangleMesh,
    /// Cosine and sine of each azimuth; the last is the first where the circle closes, to the last bit.
    azimuths: Vec<(f64, f64)>,
    length: f64,
}

impl Lathe {
    fn new(n_sectors: u32, phi_max: f64, length: f64) -> Self {
        let azimuth = |i: u32| {
            let is_closed = phi_max == TAU && i == n_sectors;
            let (sin, cos) = if is_closed {
                (0.0, 1.0)
            } else {
                (phi_max * f64::from(i) / f64::from(n_sectors)).sin_cos()
            };
            (cos, sin)
        };
        Self { mesh: TriangleMesh::default(), azimuths: (0..=n_sectors).map(azimuth).collect(), length }
    }

    fn turn(&mut self, row: &[CurvePoint]) {
        let first = self.mesh.positions.len() as u32;
        let n = self.azimuths.len() as u32;
        for point in row {
            self.push_circle(point);
        }
        for (i, pair) in row.windows(2).enumerate() {
            let start = first + i as u32 * n;
            for j in start..start + n - 1 {
                let [a, b, c, d] = [j, j + 1, j + 1 + n, j + n];
                if pair[0].p.y > 0.0 {
                    self.mesh.indices.push([a, b, if pair[1].p.y > 0.0 { c } else { d }]);
                }
                if pair[1].p.y > 0.0 {
                    self.mesh.indices.push([a, c, d]);
                }
            }
        }
    }

    fn push_circle(&mut self, point: &CurvePoint) {
        let (height, radius) = (point.p.x, point.p.y);
        let n = DVec2::new(point.tangent.x, -point.tangent.y).normalize_or(DVec2::X);
        let last = (self.azimuths.len() - 1) as f64;
        for (i, (cos, sin)) in self.azimuths.iter().enumerate() {
            let p = Point3::new((radius * cos) as f32, (radius * sin) as f32, height as f32);
            self.mesh.positions.push(p);
            self.mesh.normals.push(Normal3::new((n.x * cos) as f32, (n.x * sin) as f32, n.y as f32));
            self.mesh.uvs.push(Point2::new((i as f64 / last) as f32, (point.s / self.length) as f32));
        }
    }
}
