//! A shape in the space of its group, ready for intersection: one `match` per operation.

use glam::{DAffine3, DVec3};
use rayon::prelude::*;

use etendue_math::{Bounds3, Normal3, Point2, Point3, Ray, Transform, Vector3};

use super::cloud::Cloud;
use super::conic::Conic;
use super::curves::Curves;
use super::cylinder::Cylinder;
use super::disk::Disk;
use super::implicit::Implicit;
use super::moving::MovingTriangles;
use super::patches::{self, Patches};
use super::quadric::{self, Quadric, QuadricShape};
use super::sphere::Sphere;
use super::torus::Torus;
use super::triangles::Triangles;
use super::whole_sphere::WholeSphere;
use super::{Candidates, LocalSurface, Shape, Traced};
use crate::bvh::{BuildPrimitive, PrimitiveRef, append_pairs, intersect_triangle};
use crate::double;
use crate::geometry::GeometryCounts;
use crate::hit::{Reference, ShapeSample, SurfacePoint};
use crate::mesh::{MeshError, check_vertices};

/// A placed shape.
#[derive(Clone, Debug)]
pub(crate) enum Entity {
    /// A triangle mesh.
    Triangles(Triangles),
    /// A mesh of patches.
    Patches(Patches),
    /// A whole sphere.
    Sphere(WholeSphere),
    /// A stretched or cut sphere, or another shape given by a short formula.
    Quadric(Box<Quadric>),
    /// A shape that is no lamp.
    Traced(Box<Traced>),
}

impl Entity {
    /// Places a shape.
    pub(crate) fn new(shape: Shape, group_from_shape: &Transform, reverse_orientation: bool) -> Self {
        let map = double::affine(group_from_shape);
        let quadric =
            |shape: QuadricShape| Self::Quadric(Box::new(Quadric::new(shape, map, reverse_orientation)));
        match shape {
            Shape::Triangles(mesh) => {
                Self::Triangles(Triangles::new(mesh, group_from_shape, reverse_orientation))
            }
            Shape::Bilinear(mesh) => Self::Patches(Patches::new(mesh, group_from_shape, reverse_orientation)),
            Shape::Moving(mesh) => {
                let moving = MovingTriangles::new(mesh, group_from_shape, reverse_orientation);
                Self::Traced(Box::new(Traced::Moving(moving)))
            }
            Shape::Curves(set) => {
                let curves = Curves::new(set, group_from_shape, reverse_orientation);
                Self::Traced(Box::new(Traced::Curves(curves)))
            }
            Shape::Points(points) => {
                let cloud = Cloud::new(points, group_from_shape, reverse_orientation);
                Self::Traced(Box::new(Traced::Cloud(cloud)))
            }
            Shape::Sphere { radius, z_min, z_max, phi_max_rad } => {
                let sphere = Sphere::new(radius.into(), z_min.into(), z_max.into(), phi_max_rad.into());
                match quadric::similarity(&map) {
                    Some(scale) if sphere.is_whole() => {
                        Self::Sphere(WholeSphere::new(sphere.radius(), &map, scale, reverse_orientation))
                    }
                    _ => quadric(QuadricShape::Sphere(sphere)),
                }
            }
            Shape::Disk { height, radius, inner_radius, phi_max_rad } => quadric(QuadricShape::Disk(
                Disk::new(height.into(), radius.into(), inner_radius.into(), phi_max_rad.into()),
            )),
            Shape::Cylinder { radius, z_min, z_max, phi_max_rad } => quadric(QuadricShape::Cylinder(
                Cylinder::new(radius.into(), z_min.into(), z_max.into(), phi_max_rad.into()),
            )),
            Shape::Cone { radius, height, phi_max_rad } => {
                quadric(QuadricShape::Conic(Conic::cone(radius.into(), height.into(), phi_max_rad.into())))
            }
            Shape::Paraboloid { a, b, z_min, z_max, phi_max_rad } => {
                let round = Conic::paraboloid(a.into(), z_min.into(), z_max.into(), phi_max_rad.into());
                // An elliptic paraboloid is a round one, stretched.
                let stretch = DAffine3::from_scale(DVec3::new(1.0, f64::from(b) / f64::from(a), 1.0));
                let map = if a == b { map } else { map * stretch };
                let shape = QuadricShape::Conic(round);
                Self::Quadric(Box::new(Quadric::new(shape, map, reverse_orientation)))
            }
            Shape::Hyperboloid { p1, p2, phi_max_rad } => {
                let (p1, p2, phi_max) = (double::point(p1), double::point(p2), phi_max_rad.into());
                quadric(if p1.z == p2.z {
                    QuadricShape::Disk(Disk::swept(p1, p2, phi_max))
                } else {
                    QuadricShape::Conic(Conic::hyperboloid(p1, p2, phi_max))
                })
            }
            Shape::Implicit(surface) => {
                let implicit = Implicit::new(surface, map, reverse_orientation);
                Self::Traced(Box::new(Traced::Implicit(Box::new(implicit))))
            }
            Shape::Torus { major_radius, minor_radius, theta_min_rad, theta_max_rad, phi_max_rad } => {
                let theta = [theta_min_rad.into(), theta_max_rad.into()];
                let radii = [major_radius.into(), minor_radius.into()];
                let torus = Torus::new(radii[0], radii[1], theta[0], theta[1], phi_max_rad.into());
                quadric(QuadricShape::Torus(torus))
            }
        }
    }

    /// Appends what the hierarchy has to hold; primitives that cannot be hit are left out.
    /// Returns the second triangles of pairs.
    pub(crate) fn append_primitives(&self, geometry: u32, primitives: &mut Vec<BuildPrimitive>) -> Vec<u32> {
        let reference = |primitive: u32| PrimitiveRef { geometry, primitive };
        match self {
            Self::Triangles(triangles) => {
                let mesh = triangles.mesh();
                let corners = |t: u32| self.valid_triangle(t);
                return append_pairs(geometry, &mesh.indices, mesh.positions.len(), corners, primitives);
            }
            Self::Patches(patches) if patches.is_flat() => {
                return append_halves(patches, geometry, primitives);
            }
            Self::Patches(patches) => primitives.extend(
                (0..self.n_primitives())
                    .filter(|&patch| patches.is_valid(patch))
                    .map(|patch| BuildPrimitive::item(reference(patch), patches.bounds(patch))),
            ),
            Self::Traced(shape) => {
                let boxes = (0..shape.n_primitives()).map(|primitive| (primitive, shape.bounds(primitive)));
                let is_there = |b: &Bounds3| !b.is_empty() && b.min.is_finite() && b.max.is_finite();
                let items = boxes.filter(|(_, bounds)| is_there(bounds));
                primitives.extend(items.map(|(i, bounds)| BuildPrimitive::item(reference(i), bounds)));
            }
            Self::Sphere(_) | Self::Quadric(_) => {
                let bounds = self.bounds(0);
                if bounds.min.is_finite() && bounds.max.is_finite() && self.area(0) > 0.0 {
                    primitives.push(BuildPrimitive::item(reference(0), bounds));
                }
            }
        }
        Vec::new()
    }

    /// Corners of a triangle, or half of a patch.
    pub(crate) fn triangle(&self, triangle: u32) -> [[f32; 3]; 3] {
        match self {
            Self::Triangles(triangles) => triangles.positions(triangle).map(|p| [p.x, p.y, p.z]),
            Self::Patches(patches) => patches.half_corners(triangle).map(|p| [p.x, p.y, p.z]),
            Self::Sphere(_) | Self::Quadric(_) | Self::Traced(_) => [[f32::NAN; 3]; 3],
        }
    }

    /// Corners of a triangle, or half of a patch, that can be hit.
    #[inline]
    pub(crate) fn valid_triangle(&self, triangle: u32) -> Option<[[f32; 3]; 3]> {
        match self {
            Self::Triangles(triangles) => triangles.valid_corners(triangle),
            Self::Patches(patches) => {
                (patches.is_flat() && patches.is_valid(triangle / 2)).then(|| self.triangle(triangle))
            }
            Self::Sphere(_) | Self::Quadric(_) | Self::Traced(_) => None,
        }
    }

    /// Number of triangles and halves of patches that can be hit.
    pub(crate) fn n_valid_triangles(&self) -> usize {
        let n = match self {
            Self::Triangles(_) => self.n_primitives(),
            Self::Patches(_) => 2 * self.n_primitives(),
            Self::Sphere(_) | Self::Quadric(_) | Self::Traced(_) => 0,
        };
        (0..n).into_par_iter().filter(|&t| self.valid_triangle(t).is_some()).count()
    }

    /// Checks what [`set_vertices`](Self::set_vertices) is about to take.
    pub(crate) fn check_vertices(&self, positions: &[Point3], normals: &[Normal3]) -> Result<(), MeshError> {
        let expected = match self {
            Self::Triangles(triangles) => triangles.mesh().positions.len(),
            Self::Patches(_) | Self::Sphere(_) | Self::Quadric(_) | Self::Traced(_) => 0,
        };
        if positions.len() != expected {
            return Err(MeshError::WrongLength { array: "positions", found: positions.len(), expected });
        }
        check_vertices("positions", positions, expected, |p| p.is_finite())?;
        check_vertices("normals", normals, expected, |n| n.is_finite())
    }

    /// Moves the vertices of a triangle mesh. No normals leave those there are.
    pub(crate) fn set_vertices(&mut self, positions: Vec<Point3>, normals: Vec<Normal3>) {
        if let Self::Triangles(triangles) = self {
            triangles.set_vertices(positions, normals);
        }
    }

    /// Triangles, patches or 1.
    pub(crate) const fn n_primitives(&self) -> u32 {
        match self {
            Self::Triangles(triangles) => triangles.mesh().indices.len() as u32,
            Self::Patches(patches) => patches.mesh().indices.len() as u32,
            Self::Sphere(_) | Self::Quadric(_) => 1,
            Self::Traced(shape) => shape.n_primitives(),
        }
    }

    /// Hits of a ray in order of t; triangles through the same test as in the hierarchy.
    pub(crate) fn intersect(&self, primitive: u32, ray: &Ray) -> Candidates {
        match self {
            Self::Triangles(_) => {
                let hit = intersect_triangle(ray, &self.triangle(primitive));
                let candidate =
                    hit.map(|(t, b)| super::Candidate { t: t.into(), u: b[0].into(), v: b[1].into() });
                [candidate, None]
            }
            Self::Patches(patches) => patches.intersect(primitive, ray),
            Self::Sphere(sphere) => sphere.intersect(ray),
            Self::Quadric(quadric) => quadric.intersect(ray),
            Self::Traced(shape) => shape.intersect(primitive, ray),
        }
    }

    /// The hits after the two of [`intersect`](Self::intersect), in order of t: tori are met up to four times.
    pub(crate) fn intersect_further(&self, ray: &Ray) -> Candidates {
        match self {
            Self::Quadric(quadric) => quadric.intersect_further(ray),
            _ => [None; 2],
        }
    }

    /// The point of a hit of `ray`, before rounding too.
    #[inline(always)]
    pub(crate) fn point(&self, primitive: u32, ray: &Ray, t: f32, uv: [f32; 2]) -> (DVec3, SurfacePoint) {
        match self {
            Self::Triangles(triangles) => triangles.point(primitive, uv),
            Self::Patches(patches) => patches.point(primitive, uv),
            Self::Sphere(sphere) => sphere.point(ray, t),
            Self::Traced(shape) => shape.point(primitive, ray, t, uv),
            Self::Quadric(quadric) => {
                let surface = quadric.surface(ray, t, uv);
                (surface.p, surface.point)
            }
        }
    }

    /// Differential geometry of a hit of `ray`.
    pub(crate) fn surface(&self, primitive: u32, ray: &Ray, t: f32, uv: [f32; 2]) -> LocalSurface {
        match self {
            Self::Triangles(triangles) => triangles.surface(primitive, uv),
            Self::Patches(patches) => patches.surface(primitive, uv),
            Self::Sphere(sphere) => sphere.surface(ray, t),
            Self::Quadric(quadric) => quadric.surface(ray, t, uv),
            Self::Traced(shape) => shape.surface(primitive, ray, t, uv),
        }
    }

    /// Texture coordinates of a hit.
    pub(crate) fn uv(&self, primitive: u32, uv: [f32; 2]) -> Point2 {
        match self {
            Self::Triangles(triangles) => triangles.uv(primitive, uv),
            Self::Patches(patches) => patches.uv(primitive, uv),
            // The hit of a ray does not tell; `point` does.
            Self::Sphere(_) => Point2::default(),
            Self::Quadric(_) => Point2::new(uv[0], uv[1]),
            Self::Traced(shape) => shape.uv(primitive, uv),
        }
    }

    /// Box around a primitive.
    pub(crate) fn bounds(&self, primitive: u32) -> Bounds3 {
        match self {
            Self::Triangles(triangles) => triangles.bounds(primitive),
            Self::Patches(patches) => patches.bounds(primitive),
            Self::Sphere(sphere) => sphere.bounds(),
            Self::Quadric(quadric) => quadric.bounds(),
            Self::Traced(shape) => shape.bounds(primitive),
        }
    }

    /// Box around all primitives.
    pub(crate) fn whole_bounds(&self) -> Bounds3 {
        (0..self.n_primitives())
            .map(|primitive| self.bounds(primitive))
            .filter(|bounds| bounds.min.is_finite() && bounds.max.is_finite())
            .fold(Bounds3::EMPTY, Bounds3::union)
    }

    /// Area in square metres.
    pub(crate) fn area(&self, primitive: u32) -> f32 {
        match self {
            Self::Triangles(triangles) => triangles.area(primitive),
            Self::Patches(patches) => patches.area(primitive),
            Self::Sphere(sphere) => sphere.globe().area(),
            Self::Quadric(quadric) => quadric.area(),
            Self::Traced(_) => 0.0,
        }
    }

    /// Axis and cosine of the half angle of a cone that holds the normals.
    pub(crate) fn emission_cone(&self, primitive: u32) -> (Vector3, f32) {
        let (axis, cosine) = match self {
            Self::Triangles(triangles) => triangles.emission_cone(primitive),
            Self::Patches(patches) => patches.emission_cone(primitive),
            Self::Sphere(_) => WholeSphere::emission_cone(),
            Self::Quadric(quadric) => quadric.emission_cone(),
            Self::Traced(_) => WholeSphere::emission_cone(),
        };
        (axis.as_vector(), cosine)
    }

    /// A point by area.
    pub(crate) fn sample_area(&self, primitive: u32, u: Point2) -> Option<ShapeSample> {
        match self {
            Self::Triangles(triangles) => triangles.sample_area(primitive, u),
            Self::Patches(patches) => patches.sample_area(primitive, u),
            Self::Sphere(sphere) => Some(sphere.sample_area(u)),
            Self::Quadric(quadric) => quadric.sample_area(u),
            Self::Traced(_) => None,
        }
    }

    /// A point by direction from `reference`, with its density per steradian; `None` where that does not apply.
    #[inline]
    pub(crate) fn sample_direction(
        &self,
        primitive: u32,
        reference: &Reference,
        u: Point2,
    ) -> Option<(ShapeSample, f32)> {
        match self {
            Self::Triangles(triangles) => triangles.sample_solid_angle(primitive, reference.p, u),
            Self::Patches(patches) => patches.sample_solid_angle(primitive, reference.p, u),
            Self::Sphere(sphere) => sphere.sample_cone(reference, u),
            Self::Quadric(_) | Self::Traced(_) => None,
        }
    }

    /// The density per steradian of [`sample_direction`](Self::sample_direction) where that applies.
    #[inline]
    pub(crate) fn direction_pdf(&self, primitive: u32, reference: &Reference) -> Option<f32> {
        match self {
            Self::Triangles(triangles) => triangles.solid_angle_pdf(primitive, reference.p),
            Self::Patches(patches) => patches.solid_angle_pdf(primitive, reference.p),
            Self::Sphere(sphere) => sphere.globe().cone_pdf(reference.p),
            Self::Quadric(_) | Self::Traced(_) => None,
        }
    }

    /// Density per area of [`sample_area`](Self::sample_area) and the normal at a point found by a ray.
    pub(crate) fn area_pdf_at_hit(&self, primitive: u32, ray: &Ray, t: f32, uv: [f64; 2]) -> (f32, Normal3) {
        match self {
            Self::Triangles(triangles) => {
                (1.0 / triangles.area(primitive), triangles.emission_cone(primitive).0)
            }
            Self::Patches(patches) => (patches.pdf_a(primitive, uv), patches.normal(primitive, uv)),
            Self::Sphere(sphere) => (1.0 / sphere.globe().area(), sphere.point(ray, t).1.ng),
            Self::Traced(shape) => (0.0, shape.point(primitive, ray, t, uv.map(|x| x as f32)).1.ng),
            Self::Quadric(quadric) => {
                let n = quadric.surface(ray, t, [0.0; 2]).point.ng;
                (quadric.pdf_a(n), n)
            }
        }
    }

    /// Density per area of [`sample_area`](Self::sample_area) at a point on the primitive.
    pub(crate) fn area_pdf_at_point(&self, primitive: u32, p: Point3, n: Normal3) -> f32 {
        match self {
            Self::Triangles(triangles) => 1.0 / triangles.area(primitive),
            Self::Patches(patches) => {
                patches.position_of(primitive, p, n).map_or(0.0, |uv| patches.pdf_a(primitive, uv))
            }
            Self::Sphere(sphere) => 1.0 / sphere.globe().area(),
            Self::Quadric(quadric) => quadric.pdf_a(n),
            Self::Traced(_) => 0.0,
        }
    }

    /// Bytes on the heap.
    pub(crate) fn memory_bytes(&self) -> usize {
        match self {
            Self::Triangles(triangles) => triangles.mesh().memory_bytes(),
            Self::Patches(patches) => patches.memory_bytes(),
            Self::Sphere(_) => 0,
            Self::Quadric(_) => size_of::<Quadric>(),
            Self::Traced(shape) => shape.memory_bytes(),
        }
    }

    /// Adds this entity to the counts.
    pub(crate) const fn count(&self, counts: &mut GeometryCounts) {
        counts.n_geometries += 1;
        match self {
            Self::Triangles(triangles) => counts.n_triangles += triangles.mesh().indices.len(),
            Self::Patches(patches) => counts.n_patches += patches.mesh().indices.len(),
            Self::Sphere(_) | Self::Quadric(_) => counts.n_quadrics += 1,
            Self::Traced(shape) => shape.count(counts),
        }
    }
}

/// Appends the halves of all patches, in pairs. Returns the second half of each first one.
fn append_halves(patches: &Patches, geometry: u32, primitives: &mut Vec<BuildPrimitive>) -> Vec<u32> {
    let n = patches.mesh().indices.len() as u32;
    let half = |half: u32| {
        let corners = patches.half_corners(half).map(|p| [p.x, p.y, p.z]);
        BuildPrimitive::triangle(patches::half_reference(geometry, half), &corners)
    };
    let valid = (0..n).filter(|&patch| patches.is_valid(patch));
    primitives.extend(valid.map(|patch| half(2 * patch).paired(&half(2 * patch + 1))));
    (0..2 * n).map(|half| half | 1).collect()
}
