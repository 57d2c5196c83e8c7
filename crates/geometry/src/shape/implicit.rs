//! Implicit surfaces f(x, y, z) = 0 (SPEC GEO-5) within a box, with f a formula of the scene.
//!
//! The box is divided into cells; those in which interval arithmetic shows that f has no zero are dropped (Duff 1992,
//! "Interval arithmetic and recursive subdivision for implicit functions and constructive solid geometry"), the rest are
//! the primitives of the hierarchy. Within a cell a ray's first zero is isolated by intervals of f and of its slope
//! (Mitchell 1990, "Robust ray intersection with interval arithmetic"; see [`roots`]), so that no zero is stepped over. A signed
//! distance field has a bound on its slope from the start, and needs numbers only (Hart 1996, "Sphere tracing").
//!
//! The normal is the gradient: away from where f is negative. Texture coordinates are longitude and colatitude as seen
//! from the middle of the box. At its border the surface ends.

mod cells;
mod roots;

use std::f64::consts::{PI, TAU};

use etendue_math::expression::{Expression, Interval};
use etendue_math::{Bounds3, Frame, Point2, Ray, Vector3};
use glam::{DAffine3, DVec3};

use super::{LocalSurface, azimuth, round_outwards};
use crate::double::{self, NormalMap};
use crate::hit::{SurfaceDerivatives, SurfacePoint};
use cells::Cells;
use roots::{Line, Slopes};

/// The zeros of a formula in x, y and z, in metres.
#[derive(Clone, Debug, PartialEq)]
pub struct ImplicitSurface {
    function: Expression,
    /// Bound of the slope of a signed distance field.
    lipschitz: Option<f64>,
    /// Nothing is further from the origin.
    radius: f64,
    cells: Cells,
}

impl ImplicitSurface {
    /// The zeros of `function` within `bounds`, and within `radius` of the origin if that is given. With `lipschitz` the
    /// function is a signed distance field: its slope in any direction never exceeds that number. Finds the cells that may
    /// hold zeros, in parallel on the current rayon pool.
    #[must_use]
    pub fn new(function: Expression, bounds: Bounds3, radius: Option<f32>, lipschitz: Option<f32>) -> Self {
        let mut surface = Self {
            function,
            lipschitz: lipschitz.map(f64::from),
            radius: radius.map_or(f64::INFINITY, f64::from),
            cells: Cells::new(double::point(bounds.min), double::point(bounds.max)),
        };
        let mut cells = surface.cells.clone();
        cells.refine(surface.function.n_steps(), |min, max| surface.may_vanish(min, max));
        surface.cells = cells;
        surface
    }

    /// True if the function has no zero within the bounds.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.cells.len() == 0
    }

    /// Number of cells that may hold zeros.
    #[must_use]
    pub const fn n_cells(&self) -> usize {
        self.cells.len()
    }

    /// False if the function surely has no zero in a box.
    fn may_vanish(&self, min: DVec3, max: DVec3) -> bool {
        let nearest = DVec3::ZERO.clamp(min, max);
        if nearest.length() > self.radius {
            return false;
        }
        let (middle, half) = (0.5 * (min + max), 0.5 * (max - min));
        if let Some(lipschitz) = self.lipschitz {
            let distance = self.function.value(middle.to_array()).abs();
            return distance.is_nan() || distance <= lipschitz * half.length() * (1.0 + 1e-9);
        }
        let sides = std::array::from_fn(|axis| Interval::new(min[axis], max[axis]));
        let (range, slopes) = self.function.gradient_range(sides);
        if !range.contains(0.0) {
            return false;
        }
        // The value in the middle and how far the slopes may lead from there.
        let change: f64 = (0..3).map(|axis| slopes[axis].magnitude() * half[axis] * (1.0 + 1e-9)).sum();
        let at_middle = self.function.range(middle.to_array().map(Interval::point));
        let is_far = at_middle.low > change || at_middle.high < -change;
        at_middle.is_empty() || !is_far
    }

    /// The parameters of a ray within a cell and the radius.
    fn extent(&self, cell: u32, origin: DVec3, direction: DVec3) -> (f64, f64) {
        let (min, max) = self.cells.padded_box(cell);
        let (mut start, mut end) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            if direction[axis] == 0.0 {
                if origin[axis] < min[axis] || origin[axis] > max[axis] {
                    return (f64::INFINITY, f64::NEG_INFINITY);
                }
                continue;
            }
            let at = |side: f64| (side - origin[axis]) / direction[axis];
            let (a, b) = (at(min[axis]), at(max[axis]));
            start = start.max(a.min(b));
            end = end.min(a.max(b));
        }
        if self.radius.is_finite() {
            let nearest = -origin.dot(direction) / direction.length_squared();
            let squared = self.radius * self.radius - (origin + direction * nearest).length_squared();
            let half = squared.sqrt() / direction.length();
            // NaN outside: no parameter is between.
            (start, end) = if squared < 0.0 {
                (f64::INFINITY, f64::NEG_INFINITY)
            } else {
                (start.max(nearest - half), end.min(nearest + half))
            };
        }
        (start, end)
    }
}

/// The function along a ray, t counted from a point near the surface so that numbers stay small.
#[derive(Clone, Copy, Debug)]
struct OnRay<'a> {
    surface: &'a ImplicitSurface,
    origin: DVec3,
    direction: DVec3,
}

impl Line for OnRay<'_> {
    fn value(&self, t: f64) -> f64 {
        self.surface.function.value((self.origin + self.direction * t).to_array())
    }

    fn finest(&self) -> f64 {
        // Slopes of a distance field never tell that there is one zero only; its halving ends where single precision does.
        if self.surface.lipschitz.is_some() { 1.0 / (1_u64 << 30) as f64 } else { 1.0 / (1_u64 << 46) as f64 }
    }

    fn slopes(&self, a: f64, b: f64) -> Slopes {
        if let Some(lipschitz) = self.surface.lipschitz {
            let steepest = lipschitz * self.direction.length() * (1.0 + 1e-9);
            let reach = steepest * 0.5 * (b - a);
            let middle = self.value(0.5 * (a + b));
            let range = if middle.is_nan() {
                Interval::ENTIRE
            } else {
                Interval::new(middle - reach, middle + reach)
            };
            return Slopes { range, slope: Interval::new(-steepest, steepest) };
        }
        let over = std::array::from_fn(|axis| {
            let (o, d) = (self.origin[axis], self.direction[axis]);
            let (x, y) = (o + d * a, o + d * b);
            let slack = f64::EPSILON * (o.abs() + d.abs() * a.abs().max(b.abs()));
            Interval::new(x.min(y) - slack, x.max(y) + slack)
        });
        let (range, slope) = self.surface.function.slope_range(over, self.direction.to_array());
        Slopes { range, slope }
    }
}

/// An implicit surface in the space of its group.
#[derive(Clone, Debug)]
pub(crate) struct Implicit {
    surface: ImplicitSurface,
    group_from_shape: DAffine3,
    shape_from_group: DAffine3,
    normal_map: NormalMap,
    /// -1 if the orientation is reversed, else 1.
    sign: f64,
    /// Bound of the magnitude of all coordinates in the space of the group.
    size: f64,
    /// Bound of the length of unit vectors in the space of the group.
    stretch: f64,
}

impl Implicit {
    /// Places a surface. A mirroring map keeps the outside outside.
    pub(crate) fn new(
        surface: ImplicitSurface,
        group_from_shape: DAffine3,
        reverse_orientation: bool,
    ) -> Self {
        let shape_from_group = group_from_shape.inverse();
        let m = group_from_shape.matrix3;
        let stretch = [m.x_axis, m.y_axis, m.z_axis].map(DVec3::length_squared).iter().sum::<f64>().sqrt();
        let mut placed = Self {
            surface,
            group_from_shape,
            shape_from_group,
            normal_map: NormalMap::new(&shape_from_group.matrix3),
            sign: if reverse_orientation { -1.0 } else { 1.0 },
            size: 0.0,
            stretch,
        };
        let (min, max) = placed.surface.cells.bounds();
        let bounds = placed.group_box(min, max);
        placed.size = f64::from(bounds.min.abs().max(bounds.max.abs()).as_vector().max_element());
        placed
    }

    /// Number of cells.
    pub(crate) const fn n_primitives(&self) -> u32 {
        self.surface.cells.len() as u32
    }

    /// Bytes on the heap.
    pub(crate) fn memory_bytes(&self) -> usize {
        self.surface.cells.memory_bytes()
    }

    fn group_box(&self, min: DVec3, max: DVec3) -> Bounds3 {
        let (mut lower, mut upper) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for corner in 0..8 {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { min[axis] } else { max[axis] };
            let p = self.group_from_shape.transform_point3(DVec3::new(pick(0), pick(1), pick(2)));
            lower = lower.min(p);
            upper = upper.max(p);
        }
        round_outwards(lower, upper)
    }

    /// Box around a cell.
    pub(crate) fn bounds(&self, cell: u32) -> Bounds3 {
        let (min, max) = self.surface.cells.padded_box(cell);
        self.group_box(min, max)
    }

    /// The first hit within a cell with t in (`after`, `t_max`].
    pub(crate) fn next_hit(&self, cell: u32, ray: &Ray, after: f64, t_max: f64) -> Option<f64> {
        let origin = self.shape_from_group.transform_point3(double::point(ray.origin));
        let direction = self.shape_from_group.transform_vector3(double::vector(ray.direction));
        let (start, end) = self.surface.extent(cell, origin, direction);
        // Beyond a hit go on where its distance differs in single precision.
        let start = start.max(after * (1.0 + f64::from(f32::EPSILON)));
        let end = end.min(t_max);
        if !(start <= end && end > 0.0) {
            return None;
        }
        let mut line = OnRay { surface: &self.surface, origin: origin + direction * start, direction };
        let mut passed = start;
        if line.value(0.0) == 0.0 && start <= after {
            // A ray that starts on the surface leaves it.
            passed += (end - start) * 1e-9;
            line.origin = origin + direction * passed;
        }
        let t = passed + roots::first_root(&line, end - passed)?;
        (t > after).then_some(t)
    }

    /// The point of the surface nearest to where `ray` is at `t`, the gradient there, and a bound of the error.
    fn settle(&self, ray: &Ray, t: f32) -> (DVec3, DVec3, f64) {
        let p = double::point(ray.origin) + double::vector(ray.direction) * f64::from(t);
        let mut p = self.shape_from_group.transform_point3(p);
        let direction = self.shape_from_group.transform_vector3(double::vector(ray.direction));
        // How far the rounding of t may have led from the surface.
        let reach = 2.0 * f64::from(f32::EPSILON) * f64::from(t) * direction.length();
        let mut gradient = DVec3::ZERO;
        for _ in 0..3 {
            let (value, slopes) = self.surface.function.gradient(p.to_array());
            gradient = DVec3::from_array(slopes);
            let step = gradient * (value / gradient.length_squared());
            if !step.is_finite() || step == DVec3::ZERO {
                break;
            }
            p -= step.clamp_length_max(reach);
        }
        let noise = self.surface.function.range(p.to_array().map(Interval::point));
        let error = 2.0 * noise.magnitude() / gradient.length();
        let error = if error <= reach { error } else { reach };
        (p, gradient, error)
    }

    /// The point of a hit of `ray`, before rounding too.
    pub(crate) fn point(&self, ray: &Ray, t: f32) -> (DVec3, SurfacePoint) {
        let (p, gradient, error) = self.settle(ray, t);
        self.point_at(ray, p, gradient, error)
    }

    fn point_at(&self, ray: &Ray, p: DVec3, gradient: DVec3, error: f64) -> (DVec3, SurfacePoint) {
        let group_p = self.group_from_shape.transform_point3(p);
        let (n, _) = self.normal_map.apply(gradient, [DVec3::ZERO; 2]);
        // Where the gradient vanishes, as at a tip, the surface faces the viewer.
        let n = if n.is_finite() { n * self.sign } else { -double::vector(ray.direction).normalize() };
        let n = double::to_normal(n);
        let rounded = double::to_point(group_p);
        let p_error =
            double::surface_error(rounded, self.size) + Vector3::splat((error * self.stretch) as f32);
        let [u, v] = self.uv(p);
        let uv = Point2::new(u as f32, v as f32);
        (group_p, SurfacePoint { p: rounded, p_error, ng: n, ns: n, uv, face_index: 0 })
    }

    /// Longitude and colatitude from +z, seen from the middle of the bounds.
    fn uv(&self, p: DVec3) -> [f64; 2] {
        let p = p - self.surface.cells.middle();
        [azimuth(p) / TAU, p.truncate().length().atan2(p.z) / PI]
    }

    /// Differential geometry of a hit of `ray`.
    pub(crate) fn surface(&self, ray: &Ray, t: f32) -> LocalSurface {
        let (p, gradient, error) = self.settle(ray, t);
        let (group_p, point) = self.point_at(ray, p, gradient, error);
        let Some(n) = gradient.try_normalize() else {
            return LocalSurface { p: group_p, point, derivatives: flat_derivatives(&point) };
        };
        let Some((dpdu, dpdv)) = tangents(p - self.surface.cells.middle(), n) else {
            return LocalSurface { p: group_p, point, derivatives: flat_derivatives(&point) };
        };
        let dn = [dpdu, dpdv].map(|tangent| self.normal_change(p, tangent));
        let (_, dn) = self.normal_map.apply(n, dn);
        let vector = |v: DVec3| double::to_vector(self.group_from_shape.transform_vector3(v));
        let [dndu, dndv] = dn.map(|dn| double::to_vector(dn * self.sign));
        let (dpdu, dpdv) = (vector(dpdu), vector(dpdv));
        let derivatives =
            SurfaceDerivatives { dpdu, dpdv, shading_dpdu: dpdu, shading_dpdv: dpdv, dndu, dndv };
        LocalSurface { p: group_p, point, derivatives }
    }

    /// Change of the unit normal along a tangent, by a difference of exact gradients.
    fn normal_change(&self, p: DVec3, tangent: DVec3) -> DVec3 {
        let (min, max) = self.surface.cells.bounds();
        let h = 1e-5 * (max - min).length();
        let along = tangent.normalize() * h;
        let normal = |p: DVec3| DVec3::from_array(self.surface.function.gradient(p.to_array()).1).normalize();
        let change = (normal(p + along) - normal(p - along)) * (tangent.length() / (2.0 * h));
        if change.is_finite() { change } else { DVec3::ZERO }
    }
}

/// The tangents at `p` along which longitude and colatitude over a turn and half a turn change by one, one at a time; `None`
/// where they do not tell points of the surface apart.
fn tangents(p: DVec3, n: DVec3) -> Option<(DVec3, DVec3)> {
    let ring = p.truncate().length_squared();
    let du = DVec3::new(-p.y, p.x, 0.0) / (ring * TAU);
    let across = ring.sqrt();
    let dv = DVec3::new(p.x * p.z / across, p.y * p.z / across, -across) / (p.length_squared() * PI);
    let (a, b) = (dv.cross(n), n.cross(du));
    let (dpdu, dpdv) = (a / du.dot(a), b / dv.dot(b));
    // Edge on, steps would lead out of the scene.
    let limit = 1e3 * p.length();
    (dpdu.length() < limit && dpdv.length() < limit).then_some((dpdu, dpdv))
}

/// Any tangents, of length 1, along which nothing else changes.
fn flat_derivatives(point: &SurfacePoint) -> SurfaceDerivatives {
    let frame = Frame::from_z(point.ng.as_vector());
    SurfaceDerivatives {
        dpdu: frame.x,
        dpdv: frame.y,
        shading_dpdu: frame.x,
        shading_dpdv: frame.y,
        ..SurfaceDerivatives::default()
    }
}
