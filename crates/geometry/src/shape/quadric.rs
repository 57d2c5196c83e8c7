//! What spheres, disks, cylinders, cones, paraboloids, hyperboloids and tori share: they are intersected and sampled in their own space in double
//! precision, then carried to the space of the group by an affine map.

use etendue_math::{Bounds3, Normal3, Point2, Ray};
use glam::{DAffine3, DVec3};

use super::conic::Conic;
use super::cylinder::Cylinder;
use super::disk::Disk;
use super::sphere::Sphere;
use super::torus::Torus;
use super::{Candidates, LocalSurface};
use crate::double::{self, NormalMap};
use crate::hit::{ShapeSample, SurfaceDerivatives, SurfacePoint};

/// A quadric in its own space.
#[derive(Clone, Copy, Debug)]
pub(crate) enum QuadricShape {
    /// See [`Sphere`].
    Sphere(Sphere),
    /// See [`Disk`].
    Disk(Disk),
    /// See [`Cylinder`].
    Cylinder(Cylinder),
    /// See [`Conic`].
    Conic(Conic),
    /// See [`Torus`].
    Torus(Torus),
}

/// A point of a quadric in its own space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct QuadricPoint {
    /// Position, exactly on the surface.
    pub(crate) p: DVec3,
    /// Unit normal, to the outside.
    pub(crate) n: DVec3,
    pub(crate) dpdu: DVec3,
    pub(crate) dpdv: DVec3,
    pub(crate) dndu: DVec3,
    pub(crate) dndv: DVec3,
}

/// A uniformly chosen point of a quadric in its own space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct QuadricSample {
    pub(crate) p: DVec3,
    pub(crate) n: DVec3,
    pub(crate) uv: [f64; 2],
}

impl QuadricShape {
    /// Smallest coordinates, largest coordinates.
    fn bounds(&self) -> (DVec3, DVec3) {
        match self {
            Self::Sphere(shape) => shape.bounds(),
            Self::Disk(shape) => shape.bounds(),
            Self::Cylinder(shape) => shape.bounds(),
            Self::Conic(shape) => shape.bounds(),
            Self::Torus(shape) => shape.bounds(),
        }
    }

    fn intersect(&self, origin: DVec3, direction: DVec3) -> Candidates {
        match self {
            Self::Sphere(shape) => shape.intersect(origin, direction),
            Self::Disk(shape) => shape.intersect(origin, direction),
            Self::Cylinder(shape) => shape.intersect(origin, direction),
            Self::Conic(shape) => shape.intersect(origin, direction),
            Self::Torus(shape) => shape.intersect(origin, direction),
        }
    }

    /// The point of the surface nearest to `p`, which is almost on it.
    fn surface(&self, p: DVec3) -> QuadricPoint {
        match self {
            Self::Sphere(shape) => shape.surface(p),
            Self::Disk(shape) => shape.surface(p),
            Self::Cylinder(shape) => shape.surface(p),
            Self::Conic(shape) => shape.surface(p),
            Self::Torus(shape) => shape.surface(p),
        }
    }

    fn area(&self) -> f64 {
        match self {
            Self::Sphere(shape) => shape.area(),
            Self::Disk(shape) => shape.area(),
            Self::Cylinder(shape) => shape.area(),
            Self::Conic(shape) => shape.area(),
            Self::Torus(shape) => shape.area(),
        }
    }

    fn sample(&self, u: Point2) -> QuadricSample {
        match self {
            Self::Sphere(shape) => shape.sample(u),
            Self::Disk(shape) => shape.sample(u),
            Self::Cylinder(shape) => shape.sample(u),
            Self::Conic(shape) => shape.sample(u),
            Self::Torus(shape) => shape.sample(u),
        }
    }
}

/// A quadric in the space of its group.
#[derive(Clone, Debug)]
pub(crate) struct Quadric {
    shape: QuadricShape,
    group_from_shape: DAffine3,
    shape_from_group: DAffine3,
    normal_map: NormalMap,
    /// -1 if the orientation is reversed, else 1.
    sign: f64,
    /// Length of any unit vector after the map, if the map is a similarity.
    scale: Option<f64>,
    area: f64,
    /// Bound of the magnitude of all coordinates.
    size: f64,
}

impl Quadric {
    /// Places a quadric. A mirroring map keeps the outside outside.
    pub(crate) fn new(shape: QuadricShape, group_from_shape: DAffine3, reverse_orientation: bool) -> Self {
        let shape_from_group = group_from_shape.inverse();
        let sign = if reverse_orientation { -1.0 } else { 1.0 };
        let normal_map = NormalMap::new(&shape_from_group.matrix3);
        let scale = similarity(&group_from_shape);
        let mut quadric =
            Self { shape, group_from_shape, shape_from_group, normal_map, sign, scale, area: 0.0, size: 0.0 };
        quadric.area = match scale {
            Some(scale) => shape.area() * scale * scale,
            None => quadric.integrated_area(),
        };
        let bounds = quadric.bounds();
        quadric.size = f64::from(bounds.min.abs().max(bounds.max.abs()).as_vector().max_element());
        quadric
    }

    /// Area after a map that is no similarity, by the midpoint rule on the sampling square.
    fn integrated_area(&self) -> f64 {
        const N: u32 = 128;
        let mut sum = 0.0;
        for j in 0..N {
            for i in 0..N {
                let u = Point2::new((i as f32 + 0.5) / N as f32, (j as f32 + 0.5) / N as f32);
                sum += self.stretch(self.shape.sample(u).n);
            }
        }
        self.shape.area() * sum / f64::from(N * N)
    }

    /// Area after the map per area before, where the normal is `n`.
    fn stretch(&self, n: DVec3) -> f64 {
        let matrix = self.group_from_shape.matrix3;
        matrix.determinant().abs() * (self.shape_from_group.matrix3.transpose() * n).length()
    }

    /// Box in the space of the group, rounded outwards.
    pub(crate) fn bounds(&self) -> Bounds3 {
        let (min, max) = self.shape.bounds();
        let mut lower = DVec3::INFINITY;
        let mut upper = DVec3::NEG_INFINITY;
        for corner in 0..8 {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { min[axis] } else { max[axis] };
            let p = self.group_from_shape.transform_point3(DVec3::new(pick(0), pick(1), pick(2)));
            lower = lower.min(p);
            upper = upper.max(p);
        }
        super::round_outwards(lower, upper)
    }

    /// Up to two hits in order of t, with u and v.
    pub(crate) fn intersect(&self, ray: &Ray) -> Candidates {
        let (origin, direction) = self.in_shape(ray);
        self.shape.intersect(origin, direction)
    }

    /// The hits after the first two.
    pub(crate) fn intersect_further(&self, ray: &Ray) -> Candidates {
        let QuadricShape::Torus(torus) = &self.shape else { return [None; 2] };
        let (origin, direction) = self.in_shape(ray);
        torus.intersect_further(origin, direction)
    }

    /// Origin and direction in the shape's own space.
    fn in_shape(&self, ray: &Ray) -> (DVec3, DVec3) {
        let origin = self.shape_from_group.transform_point3(double::point(ray.origin));
        (origin, self.shape_from_group.transform_vector3(double::vector(ray.direction)))
    }

    /// Differential geometry where `ray` hits at `t`.
    pub(crate) fn surface(&self, ray: &Ray, t: f32, uv: [f32; 2]) -> LocalSurface {
        let p = double::point(ray.origin) + double::vector(ray.direction) * f64::from(t);
        let local = self.shape.surface(self.shape_from_group.transform_point3(p));
        let p = self.group_from_shape.transform_point3(local.p);
        let (n, [dndu, dndv]) = self.normal_map.apply(local.n, [local.dndu, local.dndv]);
        let vector = |v: DVec3| double::to_vector(self.group_from_shape.transform_vector3(v));
        let (dpdu, dpdv) = (vector(local.dpdu), vector(local.dpdv));
        let n = double::to_normal(n * self.sign);
        let rounded = double::to_point(p);
        let point = SurfacePoint {
            p: rounded,
            p_error: double::surface_error(rounded, self.size),
            ng: n,
            ns: n,
            uv: Point2::new(uv[0], uv[1]),
            face_index: 0,
        };
        let derivatives = SurfaceDerivatives {
            dpdu,
            dpdv,
            shading_dpdu: dpdu,
            shading_dpdv: dpdv,
            dndu: double::to_vector(dndu * self.sign),
            dndv: double::to_vector(dndv * self.sign),
        };
        LocalSurface { p, point, derivatives }
    }

    /// Area in square metres.
    pub(crate) const fn area(&self) -> f32 {
        self.area as f32
    }

    /// A point, uniform in area before the map.
    pub(crate) fn sample_area(&self, u: Point2) -> Option<ShapeSample> {
        let sample = self.shape.sample(u);
        let p = double::to_point(self.group_from_shape.transform_point3(sample.p));
        let pdf_a = 1.0 / (self.shape.area() * self.stretch(sample.n));
        let sample = ShapeSample {
            p,
            p_error: double::surface_error(p, self.size),
            n: self.group_normal(sample.n),
            uv: Point2::new(sample.uv[0] as f32, sample.uv[1] as f32),
            pdf_a: pdf_a as f32,
        };
        (pdf_a.is_finite() && sample.n.is_finite()).then_some(sample)
    }

    /// Density per area at a point with the unit normal `n` after the map.
    pub(crate) fn pdf_a(&self, n: Normal3) -> f32 {
        if let Some(scale) = self.scale {
            return (1.0 / (self.shape.area() * scale * scale)) as f32;
        }
        let n = (self.group_from_shape.matrix3.transpose() * double::normal(n)).normalize();
        (1.0 / (self.shape.area() * self.stretch(n))) as f32
    }

    fn group_normal(&self, n: DVec3) -> Normal3 {
        double::to_normal(self.normal_map.apply(n, [DVec3::ZERO; 2]).0 * self.sign)
    }

    /// Axis and cosine of a cone that holds all normals.
    pub(crate) fn emission_cone(&self) -> (Normal3, f32) {
        match &self.shape {
            QuadricShape::Disk(_) => (self.group_normal(DVec3::Z), 1.0),
            QuadricShape::Sphere(_)
            | QuadricShape::Cylinder(_)
            | QuadricShape::Conic(_)
            | QuadricShape::Torus(_) => (Normal3::new(0.0, 0.0, 1.0), -1.0),
        }
    }
}

/// The factor by which a map scales all lengths, if there is one.
pub(super) fn similarity(map: &DAffine3) -> Option<f64> {
    let m = map.matrix3;
    let scale = m.determinant().abs().cbrt();
    let columns = [m.x_axis, m.y_axis, m.z_axis];
    let tolerance = 1e-5 * scale;
    let even = columns.iter().all(|c| (c.length() - scale).abs() < tolerance);
    let square = (0..3).all(|i| columns[i].dot(columns[(i + 1) % 3]).abs() < tolerance * scale);
    (even && square).then_some(scale)
}
