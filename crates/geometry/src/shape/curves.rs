//! Curves with a width: hair, fur, grass (as the shape `curve` of pbrt-v4).
//!
//! A cubic Bézier curve is looked at along the ray, halved until it is nearly straight, and hit where it passes within half its
//! width of the ray (Pharr, Jakob and Humphreys 2023, "Physically Based Rendering", section 6.7; Nakamaru and Ohno 2002,
//! "Ray Tracing for Curves Primitive"). u runs along each cubic, v from 0 to 1 across. The hierarchy holds pieces of curves, so that
//! boxes are small. Widths are scaled by the mean of how the transform scales lengths.

mod basis;
#[cfg(test)]
mod tests;

use etendue_math::{Bounds3, Normal3, Point2, Point3, Ray, Transform};
use glam::{DQuat, DVec2, DVec3};

pub use basis::{CurveBasis, bezier_segments};

use super::{Candidate, Candidates, LocalSurface};
use crate::double;
use crate::hit::{SurfaceDerivatives, SurfacePoint};
use crate::mesh::{MeshError, heap};

/// What a curve looks like from nearby.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CurveKind {
    /// A flat band that always faces the ray.
    #[default]
    Flat,
    /// The same with the normals of a tube.
    Cylinder,
    /// A flat band that faces its normals.
    Ribbon,
}

/// A cubic Bézier curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    /// Control points.
    pub controls: [Point3; 4],
    /// Width at both ends in metres.
    pub widths: [f32; 2],
    /// Normals at both ends; of ribbons only.
    pub normals: [Normal3; 2],
}

/// Curves of one kind.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurveSet {
    /// The curves.
    pub curves: Vec<Curve>,
    /// What they look like.
    pub kind: CurveKind,
    /// Each is cut into 2 to this power pieces for the hierarchy; at most [`CurveSet::MAX_SPLIT_DEPTH`].
    pub split_depth: u32,
}

impl CurveSet {
    /// More pieces for each curve only cost memory.
    pub const MAX_SPLIT_DEPTH: u32 = 6;

    /// True if the curves of another set can join these.
    #[must_use]
    pub fn accepts(&self, other: &Self) -> bool {
        let n = self.curves.len() + other.curves.len();
        (self.kind, self.split_depth) == (other.kind, other.split_depth) && n <= 1 << 22
    }

    /// Checks that all numbers are finite and that there are not too many pieces.
    pub fn validate(&self) -> Result<(), MeshError> {
        let is_finite = |curve: &Curve| {
            curve.controls.iter().all(|p| p.is_finite())
                && curve.widths.iter().all(|w| w.is_finite() && *w >= 0.0)
                && curve.normals.iter().all(|n| n.is_finite())
        };
        if let Some(vertex) = self.curves.iter().position(|curve| !is_finite(curve)) {
            return Err(MeshError::NotFinite { array: "curves", vertex });
        }
        let found = self.curves.len() << self.split_depth.min(Self::MAX_SPLIT_DEPTH);
        if found > 1 << 28 {
            return Err(MeshError::TooLarge { array: "pieces of curves", found });
        }
        Ok(())
    }
}

/// Curves in the space of their group.
#[derive(Clone, Debug)]
pub(crate) struct Curves {
    set: CurveSet,
}

/// A cubic by its control points.
type Cubic = [DVec3; 4];

fn point_at(c: &Cubic, u: f64) -> DVec3 {
    let [ab, bc, cd] = [0, 1, 2].map(|k| c[k].lerp(c[k + 1], u));
    let (abc, bcd) = (ab.lerp(bc, u), bc.lerp(cd, u));
    abc.lerp(bcd, u)
}

fn derivative_at(c: &Cubic, u: f64) -> DVec3 {
    let [ab, bc, cd] = [0, 1, 2].map(|k| c[k].lerp(c[k + 1], u));
    let (abc, bcd) = (ab.lerp(bc, u), bc.lerp(cd, u));
    let tangent = 3.0 * (bcd - abc);
    // Control points that coincide leave no direction there.
    if tangent.length_squared() > 0.0 { tangent } else { c[3] - c[0] }
}

fn halves(c: &Cubic) -> [Cubic; 2] {
    let [ab, bc, cd] = [0, 1, 2].map(|k| (c[k] + c[k + 1]) * 0.5);
    let (abc, bcd) = ((ab + bc) * 0.5, (bc + cd) * 0.5);
    let middle = (abc + bcd) * 0.5;
    [[c[0], ab, abc, middle], [middle, bcd, cd, c[3]]]
}

/// The part between two parameters: its control points are values of the blossom.
fn part(c: &Cubic, u0: f64, u1: f64) -> Cubic {
    let blossom = |u: [f64; 3]| {
        let a = [c[0].lerp(c[1], u[0]), c[1].lerp(c[2], u[0]), c[2].lerp(c[3], u[0])];
        let b = [a[0].lerp(a[1], u[1]), a[1].lerp(a[2], u[1])];
        b[0].lerp(b[1], u[2])
    };
    [blossom([u0; 3]), blossom([u0, u0, u1]), blossom([u0, u1, u1]), blossom([u1; 3])]
}

/// A piece of a curve, as a ray in the direction z from the origin sees it.
struct View<'a> {
    curve: &'a Curve,
    kind: CurveKind,
    direction: DVec3,
}

impl Curves {
    /// Moves curves into the space of their group.
    pub(crate) fn new(mut set: CurveSet, group_from_shape: &Transform, reverse_orientation: bool) -> Self {
        let scale = double::affine(group_from_shape).matrix3.determinant().abs().cbrt() as f32;
        for curve in &mut set.curves {
            curve.controls = curve.controls.map(|p| group_from_shape.point(p));
            curve.widths = curve.widths.map(|w| w * scale);
            let normal = |n| group_from_shape.normal(n) * if reverse_orientation { -1.0 } else { 1.0 };
            curve.normals = curve.normals.map(normal);
        }
        set.split_depth = set.split_depth.min(CurveSet::MAX_SPLIT_DEPTH);
        Self { set }
    }

    pub(crate) const fn n_curves(&self) -> usize {
        self.set.curves.len()
    }

    pub(crate) const fn n_primitives(&self) -> u32 {
        (self.set.curves.len() as u32) << self.set.split_depth
    }

    /// The curve of a piece, and where the piece begins and ends.
    fn piece(&self, primitive: u32) -> (&Curve, [f64; 2]) {
        let depth = self.set.split_depth;
        let curve = &self.set.curves[(primitive >> depth) as usize];
        let n = f64::from(1_u32 << depth);
        let first = f64::from(primitive & ((1 << depth) - 1));
        (curve, [first / n, (first + 1.0) / n])
    }

    pub(crate) fn bounds(&self, primitive: u32) -> Bounds3 {
        let (curve, [u0, u1]) = self.piece(primitive);
        let controls = part(&curve.cubic(), u0, u1);
        let radius = 0.5 * curve.width(u0).max(curve.width(u1));
        let min = controls.iter().fold(DVec3::INFINITY, |m, p| m.min(*p));
        let max = controls.iter().fold(DVec3::NEG_INFINITY, |m, p| m.max(*p));
        super::round_outwards(min - radius, max + radius)
    }

    /// The nearest hit of a piece.
    pub(crate) fn intersect(&self, primitive: u32, ray: &Ray) -> Candidates {
        let (curve, [u0, u1]) = self.piece(primitive);
        let direction = double::vector(ray.direction);
        let length = direction.length();
        let cubic = curve.cubic();
        let (origin, z) = (double::point(ray.origin), direction / length);
        // The curve runs along y, so that its boxes across the ray are narrow.
        let along = (cubic[3] - cubic[0]).reject_from_normalized(z);
        let y = along.try_normalize().unwrap_or_else(|| z.any_orthonormal_vector());
        let x = y.cross(z);
        let seen = part(&cubic, u0, u1).map(|p| {
            let p = p - origin;
            DVec3::new(p.dot(x), p.dot(y), p.dot(z))
        });
        let view = View { curve, kind: self.set.kind, direction: z };
        let mut nearest = None;
        view.search(&seen, [u0, u1], view.depth(&seen, [u0, u1]), &mut nearest);
        [nearest.map(|hit: Candidate| Candidate { t: hit.t / length, ..hit }), None]
    }

    /// Differential geometry. The normal of what is no ribbon is on the side of the ray's origin; in pbrt-v4 it is on the other,
    /// and v runs the other way.
    pub(crate) fn surface(&self, primitive: u32, ray: &Ray, t: f32, uv: [f32; 2]) -> LocalSurface {
        let (curve, _) = self.piece(primitive);
        let (u, v) = (f64::from(uv[0]), f64::from(uv[1]));
        let d = double::vector(ray.direction).normalize();
        let dpdu = derivative_at(&curve.cubic(), u);
        let mut width = curve.width(u);
        let mut across = match self.set.kind {
            CurveKind::Ribbon => {
                let n = curve.normal(u);
                width *= n.dot(d).abs();
                n.cross(dpdu)
            }
            CurveKind::Flat | CurveKind::Cylinder => dpdu.cross(d),
        };
        if self.set.kind == CurveKind::Cylinder {
            // The normal turns from one side to the other.
            let axis = dpdu.reject_from_normalized(d).normalize_or(d.any_orthonormal_vector());
            across = DQuat::from_axis_angle(axis, (0.5 - v) * std::f64::consts::PI) * across;
        }
        let dpdv = across.normalize_or(dpdu.any_orthonormal_vector()) * width;
        let n = dpdu.cross(dpdv).normalize_or(-d);
        let p = double::point(ray.origin) + double::vector(ray.direction) * f64::from(t);
        let rounded = double::to_point(p);
        let normal = double::to_normal(n);
        // Rays that leave begin outside of the curve.
        let p_error = double::rounding_error(rounded) + normal.abs().as_vector() * curve.width(u) as f32;
        let point = SurfacePoint {
            p: rounded,
            p_error,
            ng: normal,
            ns: normal,
            uv: Point2::new(uv[0], uv[1]),
            face_index: 0,
        };
        let (dpdu, dpdv) = (double::to_vector(dpdu), double::to_vector(dpdv));
        let derivatives = SurfaceDerivatives {
            dpdu,
            dpdv,
            shading_dpdu: dpdu,
            shading_dpdv: dpdv,
            ..SurfaceDerivatives::default()
        };
        LocalSurface { p, point, derivatives }
    }

    pub(crate) fn memory_bytes(&self) -> usize {
        heap(&self.set.curves)
    }
}

impl Curve {
    fn cubic(&self) -> Cubic {
        self.controls.map(double::point)
    }

    fn width(&self, u: f64) -> f64 {
        f64::from(self.widths[0]) * (1.0 - u) + f64::from(self.widths[1]) * u
    }

    /// The unit normal of a ribbon, turned at constant speed.
    fn normal(&self, u: f64) -> DVec3 {
        let [a, b] = self.normals.map(|n| double::normal(n).normalize_or(DVec3::Z));
        let angle = a.angle_between(b);
        if angle.sin() < 1e-6 {
            return a;
        }
        (a * ((1.0 - u) * angle).sin() + b * (u * angle).sin()) / angle.sin()
    }
}

impl View<'_> {
    /// Halvings after which the curve is straight to a twentieth of its width, as bounded by second differences (Wang's formula).
    fn depth(&self, c: &Cubic, [u0, u1]: [f64; 2]) -> u32 {
        let bend = |k: usize| (c[k] - 2.0 * c[k + 1] + c[k + 2]).abs().max_element();
        let tolerance = 0.05 * self.curve.width(u0).max(self.curve.width(u1));
        let halvings =
            0.5 * (std::f64::consts::SQRT_2 * 6.0 * bend(0).max(bend(1)) / (8.0 * tolerance)).log2();
        if halvings > 0.0 { halvings.min(10.0).ceil() as u32 } else { 0 }
    }

    fn search(&self, c: &Cubic, u: [f64; 2], depth: u32, nearest: &mut Option<Candidate>) {
        let radius = 0.5 * self.curve.width(u[0]).max(self.curve.width(u[1]));
        let min = c[0].min(c[1]).min(c[2].min(c[3]));
        let max = c[0].max(c[1]).max(c[2].max(c[3]));
        let is_beside = min.x > radius || max.x < -radius || min.y > radius || max.y < -radius;
        if is_beside || max.z <= 0.0 || nearest.is_some_and(|hit| hit.t <= min.z) {
            return;
        }
        if depth == 0 {
            self.test(c, u, nearest);
            return;
        }
        let middle = 0.5 * (u[0] + u[1]);
        let [first, second] = halves(c);
        self.search(&first, [u[0], middle], depth - 1, nearest);
        self.search(&second, [middle, u[1]], depth - 1, nearest);
    }

    /// The hit of a piece that is almost straight: where it passes nearest to the ray, between the lines across its ends.
    fn test(&self, c: &Cubic, [u0, u1]: [f64; 2], nearest: &mut Option<Candidate>) {
        let [a, b, p, q] = c.map(DVec3::truncate);
        let side = |end: DVec2, next: DVec2| (next - end).dot(-end);
        if side(a, b) < 0.0 || side(q, p) < 0.0 {
            return;
        }
        let chord = q - a;
        let length_squared = chord.length_squared();
        if length_squared == 0.0 {
            return;
        }
        let w = (-a.dot(chord) / length_squared).clamp(0.0, 1.0);
        let u = u0 + (u1 - u0) * w;
        let mut width = self.curve.width(u);
        if self.kind == CurveKind::Ribbon {
            width *= self.curve.normal(u).dot(self.direction).abs();
        }
        let centre = point_at(c, w);
        let distance = centre.truncate().length();
        if distance > 0.5 * width || centre.z <= 0.0 || nearest.is_some_and(|hit| hit.t <= centre.z) {
            return;
        }
        let tangent = derivative_at(c, w);
        let is_left = tangent.x * -centre.y + centre.x * tangent.y > 0.0;
        let offset = if width > 0.0 { distance / width } else { 0.0 };
        // A ribbon has one front, others face the ray.
        let is_behind = self.kind == CurveKind::Ribbon && self.curve.normal(u).dot(self.direction) > 0.0;
        let v = if is_left ^ is_behind { 0.5 - offset } else { 0.5 + offset };
        *nearest = Some(Candidate { t: centre.z, u, v: v.clamp(0.0, 1.0) });
    }
}
