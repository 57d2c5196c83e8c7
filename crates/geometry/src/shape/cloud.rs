//! Point-sampled surfaces (SPEC GEO-9; Schaufler and Jensen 2000, "Ray Tracing Point Sampled Geometry",
//! doi:10.1007/978-3-7091-6303-0_29).
//!
//! A ray is a cylinder: it finds a point that comes within the radius r of that point. Each point is thus a disk of radius r
//! across its normal, and the first disk that a ray meets is the hit. Position and normal are then means over all disks that the
//! ray crosses there, with weights that fall with the distance d of the ray from the point,
//!
//! w = (1 - d^2 / r^2)^2,
//!
//! so that they change smoothly as points enter and leave. (The paper has r - d.) A ray that leaves begins beyond all disks
//! nearby, which is what the thickness of the object means in the paper. Neighbours are looked up once, when the shape is placed.

mod normals;
#[cfg(test)]
mod tests;

use etendue_math::{Bounds3, Frame, Normal3, Point2, Point3, Ray, Transform};
use glam::DVec3;
use rayon::prelude::*;

use super::{Candidate, Candidates, LocalSurface};
use crate::double;
use crate::hit::{SurfaceDerivatives, SurfacePoint};
use crate::mesh::{MeshError, check_vertices, heap};
use crate::points::{Neighbours, PointTree};

pub use normals::estimate_normals;

/// More neighbours than so many are not looked at.
const MAX_NEIGHBOURS: usize = 64;

/// Points of a surface. Both arrays are as long as the positions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointCloud {
    /// Positions.
    pub positions: Vec<Point3>,
    /// Normals, of any length, outside.
    pub normals: Vec<Normal3>,
    /// Radius of each point in metres; 0 for none.
    pub radii: Vec<f32>,
}

impl PointCloud {
    /// Points whose radii are the distance of the `n_neighbours`-th nearest other point.
    ///
    /// Of points strewn at random, a share of about e^(-n) of the surface is then covered by no disk.
    #[must_use]
    pub fn with_local_radii(positions: Vec<Point3>, normals: Vec<Normal3>, n_neighbours: u32) -> Self {
        let tree = PointTree::new(&positions);
        let radius = |found: &mut Neighbours, p: &Point3| {
            tree.nearest(*p, n_neighbours as usize + 1, f32::MAX, found);
            found.iter().fold(0.0_f32, |r, neighbour| r.max(neighbour.distance_squared)).sqrt()
        };
        let radii = positions.par_iter().map_init(Neighbours::new, radius).collect();
        Self { positions, normals, radii }
    }

    /// Checks lengths and that all numbers are finite.
    pub fn validate(&self) -> Result<(), MeshError> {
        let n = self.positions.len();
        check_vertices("positions", &self.positions, n, |p| p.is_finite())?;
        for (array, found) in [("normals", self.normals.len()), ("radii", self.radii.len())] {
            if found != n {
                return Err(MeshError::WrongLength { array, found, expected: n });
            }
        }
        check_vertices("normals", &self.normals, n, |n| n.is_finite())?;
        check_vertices("radii", &self.radii, n, |r| r.is_finite() && *r >= 0.0)?;
        if n > 1 << 28 {
            return Err(MeshError::TooLarge { array: "positions", found: n });
        }
        Ok(())
    }
}

/// Points in the space of their group, with the neighbours of each.
#[derive(Clone, Debug)]
pub(crate) struct Cloud {
    points: PointCloud,
    /// Where the neighbours of each point begin, and the end of all.
    starts: Vec<u32>,
    neighbours: Vec<u32>,
    /// Largest magnitude of a coordinate.
    size: f64,
}

/// A disk in double precision.
#[derive(Clone, Copy)]
struct Disk {
    p: DVec3,
    n: DVec3,
    radius: f64,
}

impl Disk {
    /// Where a ray meets the plane of the disk, and the square of the distance there from its centre in radii.
    fn meet(&self, origin: DVec3, direction: DVec3) -> (f64, f64) {
        let t = self.n.dot(self.p - origin) / self.n.dot(direction);
        (t, (origin + direction * t).distance_squared(self.p) / (self.radius * self.radius))
    }
}

impl Cloud {
    /// Moves points into the space of their group.
    pub(crate) fn new(
        mut points: PointCloud,
        group_from_shape: &Transform,
        reverse_orientation: bool,
    ) -> Self {
        let scale = double::affine(group_from_shape).matrix3.determinant().abs().cbrt() as f32;
        for p in &mut points.positions {
            *p = group_from_shape.point(*p);
        }
        for n in &mut points.normals {
            let normal = group_from_shape.normal(*n).try_normalized().unwrap_or_default();
            *n = if reverse_orientation { -normal } else { normal };
        }
        for r in &mut points.radii {
            *r *= scale;
        }
        let size = double::largest_coordinate(points.positions.iter().map(|p| double::point(*p)));
        let lists = neighbours(&points);
        let mut starts = vec![0];
        let mut all = Vec::with_capacity(lists.iter().map(Vec::len).sum());
        for list in lists {
            all.extend(list);
            starts.push(all.len() as u32);
        }
        Self { points, starts, neighbours: all, size }
    }

    pub(crate) const fn n_primitives(&self) -> u32 {
        self.points.positions.len() as u32
    }

    fn disk(&self, point: u32) -> Disk {
        let i = point as usize;
        Disk {
            p: double::point(self.points.positions[i]),
            n: double::normal(self.points.normals[i]),
            radius: self.points.radii[i].into(),
        }
    }

    /// The box of a disk: along an axis it reaches r sin of the angle between normal and axis.
    pub(crate) fn bounds(&self, point: u32) -> Bounds3 {
        let Disk { p, n, radius } = self.disk(point);
        if n == DVec3::ZERO || radius == 0.0 {
            return Bounds3::EMPTY;
        }
        let reach = radius * (DVec3::ONE - n * n).max(DVec3::ZERO).map(f64::sqrt);
        // What a disk along an axis lacks in thickness, rounding of the ray needs.
        let reach = reach + 1e-6 * radius;
        super::round_outwards(p - reach, p + reach)
    }

    pub(crate) fn intersect(&self, point: u32, ray: &Ray) -> Candidates {
        let (t, distance_squared) =
            self.disk(point).meet(double::point(ray.origin), double::vector(ray.direction));
        [(distance_squared <= 1.0).then_some(Candidate { t, u: 0.0, v: 0.0 }), None]
    }

    /// Means over the disks that the ray crosses around the one that it has met at `t`.
    pub(crate) fn surface(&self, point: u32, ray: &Ray, t: f32) -> LocalSurface {
        let (origin, direction) = (double::point(ray.origin), double::vector(ray.direction));
        let first = self.disk(point);
        let around =
            self.neighbours_of(point).iter().map(|&j| self.disk(j)).filter(|disk| disk.n.dot(first.n) > 0.0);
        let (mut weights, mut t_sum, mut n_sum) = (1e-9, 1e-9 * f64::from(t), first.n * 1e-9);
        for disk in around.clone().chain([first]) {
            let (t, distance_squared) = disk.meet(origin, direction);
            if distance_squared < 1.0 {
                let weight = (1.0 - distance_squared) * (1.0 - distance_squared);
                weights += weight;
                t_sum += weight * t;
                n_sum += weight * disk.n;
            }
        }
        let mean = n_sum.normalize_or(first.n);
        // At the outline the mean may look away although the ray came from this side.
        let n = if mean.dot(direction) * first.n.dot(direction) > 0.0 { mean } else { first.n };
        let p = origin + direction * (t_sum / weights);
        let reach = |disk: Disk| {
            let cosine = n.dot(disk.n).abs().min(1.0);
            n.dot(disk.p - p).abs() + disk.radius * (1.0 - cosine * cosine).sqrt()
        };
        let thickness = around.map(reach).fold(reach(first), f64::max);
        self.describe(p, n, thickness)
    }

    fn describe(&self, p: DVec3, n: DVec3, thickness: f64) -> LocalSurface {
        let rounded = double::to_point(p);
        let normal = double::to_normal(n);
        // Along the normal this is the thickness.
        let p_error = double::surface_error(rounded, self.size) + normal.abs().as_vector() * thickness as f32;
        let point = SurfacePoint {
            p: rounded,
            p_error,
            ng: normal,
            ns: normal,
            uv: Point2::default(),
            face_index: 0,
        };
        let frame = Frame::from_z(normal.as_vector());
        let derivatives = SurfaceDerivatives {
            dpdu: frame.x,
            dpdv: frame.y,
            shading_dpdu: frame.x,
            shading_dpdv: frame.y,
            ..SurfaceDerivatives::default()
        };
        LocalSurface { p, point, derivatives }
    }

    fn neighbours_of(&self, point: u32) -> &[u32] {
        let i = point as usize;
        &self.neighbours[self.starts[i] as usize..self.starts[i + 1] as usize]
    }

    pub(crate) fn memory_bytes(&self) -> usize {
        let PointCloud { positions, normals, radii } = &self.points;
        heap(positions) + heap(normals) + heap(radii) + heap(&self.starts) + heap(&self.neighbours)
    }
}

/// The other points whose disks a ray may cross together with that of each point, nearest first.
fn neighbours(points: &PointCloud) -> Vec<Vec<u32>> {
    let tree = PointTree::new(&points.positions);
    let list = |found: &mut Neighbours, (i, p): (usize, &Point3)| {
        let radius = points.radii[i];
        tree.nearest(*p, MAX_NEIGHBOURS, 3.0 * radius, found);
        let mut near: Vec<(u32, u32)> = found
            .iter()
            .filter(|other| {
                let reach = radius + points.radii[other.index as usize];
                other.index as usize != i && other.distance_squared < reach * reach
            })
            .map(|other| (other.distance_squared.to_bits(), other.index))
            .collect();
        near.sort_unstable();
        near.into_iter().map(|(_, index)| index).collect()
    };
    points.positions.par_iter().enumerate().map(|(i, p)| (i, p)).map_init(Neighbours::new, list).collect()
}
