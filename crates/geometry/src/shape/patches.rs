//! Bilinear patches p(u, v) = (1-u)(1-v) p00 + u (1-v) p10 + (1-u) v p01 + u v p11.
//!
//! A ray meets the patch where the volume spanned by it and a line of constant u vanishes: a quadratic equation in
//! u (Ramsey, Potter and Hansen 2004, "Ray Bilinear Patch Intersections"; Reshetov 2019, "Cool Patches"). It is
//! solved in double precision. Meshes of parallelograms are intersected as triangles (`flat.rs`). Patches that are
//! rectangles are sampled uniformly in solid angle, others by a density that is bilinear in the areas at the corners.

mod flat;
mod intersect;
#[cfg(test)]
mod tests;

use etendue_math::warp::SphericalRectangle;
use etendue_math::{Bounds3, Frame, Normal3, Point2, Point3, Ray, Transform, Vector3};
use glam::DVec3;

pub(crate) use flat::{entity_of, half_reference, resolve};
use intersect::intersect;

use super::{Candidate, Candidates, LocalSurface, weingarten};
use crate::bvh::intersect_triangle;
use crate::double;
use crate::hit::{ShapeSample, SurfaceDerivatives, SurfacePoint};
use crate::mesh::{BilinearMesh, heap};

/// A mesh of patches in the space of its group.
#[derive(Clone, Debug)]
pub(crate) struct Patches {
    mesh: BilinearMesh,
    /// True if normals without vertex normals point against dp/du x dp/dv.
    flips: bool,
    /// If all patches are parallelograms, their normals as the winding has them. Neighbours are then found by the same
    /// test, without gaps.
    planes: Option<Vec<Normal3>>,
    /// Largest magnitude of a coordinate.
    size: f64,
}

/// Solid angles in which rectangles are sampled by direction, in steradians.
const RECTANGLE_SAMPLING: std::ops::Range<f32> = 1e-4..6.22;

/// Corners p00, p10, p01, p11.
type Corners = [DVec3; 4];

/// Interpolates four corner values.
fn bilinear(c: &Corners, u: f64, v: f64) -> DVec3 {
    c[0].lerp(c[1], u).lerp(c[2].lerp(c[3], u), v)
}

fn derivative_u(c: &Corners, v: f64) -> DVec3 {
    (c[1] - c[0]).lerp(c[3] - c[2], v)
}

fn derivative_v(c: &Corners, u: f64) -> DVec3 {
    (c[2] - c[0]).lerp(c[3] - c[1], u)
}

fn mixed_derivative(c: &Corners) -> DVec3 {
    (c[0] + c[3]) - (c[1] + c[2])
}

/// Area per unit of u and v.
fn stretch(c: &Corners, u: f64, v: f64) -> f64 {
    derivative_u(c, v).cross(derivative_v(c, u)).length()
}

impl Patches {
    /// Moves a mesh into the space of its group, reusing its memory.
    pub(crate) fn new(
        mut mesh: BilinearMesh,
        group_from_shape: &Transform,
        reverse_orientation: bool,
    ) -> Self {
        if !group_from_shape.is_identity() {
            for p in &mut mesh.positions {
                *p = group_from_shape.point(*p);
            }
            for n in &mut mesh.normals {
                *n = group_from_shape.normal(*n);
            }
        }
        if reverse_orientation {
            for n in &mut mesh.normals {
                *n = -*n;
            }
        }
        let flips = reverse_orientation ^ group_from_shape.swaps_handedness();
        let size = double::largest_coordinate(mesh.positions.iter().copied().map(double::point));
        let mut patches = Self { mesh, flips, planes: None, size };
        let corners = || (0..patches.mesh.indices.len() as u32).map(|patch| patches.corners(patch));
        if corners().all(|corners| flat::is_parallelogram(&corners, size)) {
            patches.planes =
                Some(corners().map(|corners| double::to_normal(flat::normal(&corners))).collect());
        }
        patches
    }

    /// True if the hierarchy holds the halves of patches, as triangles.
    pub(crate) const fn is_flat(&self) -> bool {
        self.planes.is_some()
    }

    /// Bytes on the heap.
    pub(crate) fn memory_bytes(&self) -> usize {
        self.mesh.memory_bytes() + self.planes.as_ref().map_or(0, heap)
    }

    /// Corners of a half, of which each patch has two.
    pub(crate) fn half_corners(&self, half: u32) -> [Point3; 3] {
        flat::corners(self.positions(half / 2), half % 2)
    }

    pub(crate) const fn mesh(&self) -> &BilinearMesh {
        &self.mesh
    }

    #[inline(always)]
    pub(crate) fn positions(&self, patch: u32) -> [Point3; 4] {
        let [a, b, c, d] = self.mesh.indices[patch as usize];
        let position = |vertex: u32| self.mesh.positions[vertex as usize];
        [position(a), position(b), position(c), position(d)]
    }

    #[inline(always)]
    fn corners(&self, patch: u32) -> Corners {
        let [a, b, c, d] = self.positions(patch);
        [double::point(a), double::point(b), double::point(c), double::point(d)]
    }

    fn normals(&self, patch: u32) -> Option<Corners> {
        (!self.mesh.normals.is_empty()).then(|| {
            self.mesh.indices[patch as usize].map(|vertex| double::normal(self.mesh.normals[vertex as usize]))
        })
    }

    fn uvs(&self, patch: u32) -> Option<Corners> {
        (!self.mesh.uvs.is_empty()).then(|| {
            self.mesh.indices[patch as usize].map(|vertex| {
                let uv = self.mesh.uvs[vertex as usize];
                DVec3::new(f64::from(uv.x), f64::from(uv.y), 0.0)
            })
        })
    }

    /// True if the corners are finite and the patch has an area.
    pub(crate) fn is_valid(&self, patch: u32) -> bool {
        self.positions(patch).iter().all(|p| p.is_finite()) && self.area(patch) > 0.0
    }

    pub(crate) fn bounds(&self, patch: u32) -> Bounds3 {
        Bounds3::from_points(self.positions(patch))
    }

    /// Texture coordinates at a position on the patch.
    pub(crate) fn uv(&self, patch: u32, uv: [f32; 2]) -> Point2 {
        match self.uvs(patch) {
            None => Point2::new(uv[0], uv[1]),
            Some(corners) => {
                let st = bilinear(&corners, f64::from(uv[0]), f64::from(uv[1]));
                Point2::new(st.x as f32, st.y as f32)
            }
        }
    }

    /// Up to two hits in order of t, with the position on the patch.
    pub(crate) fn intersect(&self, patch: u32, ray: &Ray) -> Candidates {
        if self.is_flat() {
            let hit = (2 * patch..2 * patch + 2).find_map(|half| {
                let (t, b) = intersect_triangle(ray, &self.half_corners(half).map(|p| [p.x, p.y, p.z]))?;
                let [u, v] = flat::position(half % 2, b).map(f64::from);
                Some(Candidate { t: t.into(), u, v })
            });
            return [hit, None];
        }
        intersect(&self.corners(patch), double::point(ray.origin), double::vector(ray.direction))
    }

    /// The geometric normal and the interpolated vertex normal.
    #[inline(always)]
    fn geometric_normal(&self, patch: u32, c: &Corners, u: f64, v: f64) -> (DVec3, Option<DVec3>) {
        let n = match &self.planes {
            Some(planes) => double::normal(planes[patch as usize]),
            None => derivative_u(c, v).cross(derivative_v(c, u)).normalize_or_zero(),
        };
        let n = if self.flips { -n } else { n };
        let Some(normals) = self.normals(patch) else { return (n, None) };
        let interpolated = bilinear(&normals, u, v);
        (if n.dot(interpolated) < 0.0 { -n } else { n }, Some(interpolated))
    }

    /// The point at a position on a patch with these corners.
    #[inline(always)]
    fn place(&self, c: &Corners, u: f64, v: f64) -> DVec3 {
        if self.is_flat() { flat::point(c, u, v) } else { bilinear(c, u, v) }
    }

    /// The point at a position on the patch, before rounding too.
    #[inline(always)]
    pub(crate) fn point(&self, patch: u32, uv: [f32; 2]) -> (DVec3, SurfacePoint) {
        let c = self.corners(patch);
        let (u, v) = (f64::from(uv[0]), f64::from(uv[1]));
        let p = self.place(&c, u, v);
        let (ng, interpolated) = self.geometric_normal(patch, &c, u, v);
        let rounded = double::to_point(p);
        let ns = interpolated.and_then(DVec3::try_normalize).unwrap_or(ng);
        let point = SurfacePoint {
            p: rounded,
            p_error: double::surface_error(rounded, self.size),
            ng: double::to_normal(ng),
            ns: double::to_normal(ns),
            uv: self.uv(patch, uv),
            face_index: self.mesh.face_indices.get(patch as usize).copied().unwrap_or(0),
        };
        (p, point)
    }

    /// Differential geometry at a position on the patch.
    pub(crate) fn surface(&self, patch: u32, uv: [f32; 2]) -> LocalSurface {
        let (p, point) = self.point(patch, uv);
        let c = self.corners(patch);
        let (u, v) = (f64::from(uv[0]), f64::from(uv[1]));
        let (ng, interpolated) = self.geometric_normal(patch, &c, u, v);
        let (pu, pv) = (derivative_u(&c, v), derivative_v(&c, u));
        let change = self.parameter_change(patch, u, v);
        let (dpdu, dpdv) = change.map_or((pu, pv), |change| change.apply(pu, pv));
        let (dnu, dnv) = weingarten(pu, pv, ng, [DVec3::ZERO, mixed_derivative(&c), DVec3::ZERO]);
        let (dndu, dndv) = change.map_or((dnu, dnv), |change| {
            let (a, b) = change.apply(double::vector(dnu), double::vector(dnv));
            (double::to_vector(a), double::to_vector(b))
        });
        let (dpdu, dpdv) = (double::to_vector(dpdu), double::to_vector(dpdv));
        let derivatives =
            SurfaceDerivatives { dpdu, dpdv, shading_dpdu: dpdu, shading_dpdv: dpdv, dndu, dndv };
        let mut surface = LocalSurface { p, point, derivatives };
        if let (Some(normals), Some(interpolated)) = (self.normals(patch), interpolated) {
            shade(&normals, interpolated, [u, v], change, &mut surface);
        }
        surface
    }

    /// How derivatives by texture coordinates follow from those by the position on the patch.
    fn parameter_change(&self, patch: u32, u: f64, v: f64) -> Option<ParameterChange> {
        let c = self.uvs(patch)?;
        let (du, dv) = (derivative_u(&c, v), derivative_v(&c, u));
        let determinant = du.x * dv.y - du.y * dv.x;
        (determinant.abs() > 1e-9).then(|| ParameterChange {
            duds: dv.y / determinant,
            dudt: -dv.x / determinant,
            dvds: -du.y / determinant,
            dvdt: du.x / determinant,
        })
    }

    /// Area in square metres, by Gauss' rule on cells.
    pub(crate) fn area(&self, patch: u32) -> f32 {
        const CELLS: u32 = 4;
        let c = self.corners(patch);
        if rectangle(&c) {
            return (c[1] - c[0]).cross(c[2] - c[0]).length() as f32;
        }
        // Nodes of the two-point rule on [0, 1].
        let nodes = [0.5 - 0.5 / 3.0_f64.sqrt(), 0.5 + 0.5 / 3.0_f64.sqrt()];
        let mut sum = 0.0;
        for i in 0..CELLS {
            for j in 0..CELLS {
                for x in nodes {
                    for y in nodes {
                        let u = (f64::from(i) + x) / f64::from(CELLS);
                        let v = (f64::from(j) + y) / f64::from(CELLS);
                        sum += stretch(&c, u, v);
                    }
                }
            }
        }
        (sum / f64::from(4 * CELLS * CELLS)) as f32
    }

    /// Axis and cosine of a cone that holds the normals at the corners.
    pub(crate) fn emission_cone(&self, patch: u32) -> (Normal3, f32) {
        let c = self.corners(patch);
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
        let normals = corners.map(|(u, v)| self.geometric_normal(patch, &c, u, v).0);
        let Some(axis) = normals.iter().sum::<DVec3>().try_normalize() else {
            return (Normal3::new(0.0, 0.0, 1.0), -1.0);
        };
        let cosine = normals.iter().map(|n| n.dot(axis)).fold(1.0, f64::min);
        (double::to_normal(axis), cosine as f32)
    }

    /// A point, uniform in area on rectangles and nearly so elsewhere.
    pub(crate) fn sample_area(&self, patch: u32, u: Point2) -> Option<ShapeSample> {
        let c = self.corners(patch);
        let u = [f64::from(u.x), f64::from(u.y)];
        let (uv, density) = if rectangle(&c) {
            (u, 1.0)
        } else {
            let weights = corner_weights(&c);
            let uv = sample_bilinear(&weights, u);
            (uv, bilinear_density(&weights, uv))
        };
        let pdf_a = density / stretch(&c, uv[0], uv[1]);
        pdf_a.is_finite().then(|| self.sample_at(patch, uv, pdf_a as f32))
    }

    fn sample_at(&self, patch: u32, uv: [f64; 2], pdf_a: f32) -> ShapeSample {
        let c = self.corners(patch);
        let p = double::to_point(self.place(&c, uv[0], uv[1]));
        ShapeSample {
            p,
            p_error: double::surface_error(p, self.size),
            n: double::to_normal(self.geometric_normal(patch, &c, uv[0], uv[1]).0),
            uv: self.uv(patch, uv.map(|x| x as f32)),
            pdf_a,
        }
    }

    /// Density per area of [`sample_area`](Self::sample_area) at a position on the patch.
    pub(crate) fn pdf_a(&self, patch: u32, uv: [f64; 2]) -> f32 {
        let c = self.corners(patch);
        let density = if rectangle(&c) { 1.0 } else { bilinear_density(&corner_weights(&c), uv) };
        (density / stretch(&c, uv[0], uv[1])) as f32
    }

    /// The normal at a position on the patch.
    pub(crate) fn normal(&self, patch: u32, uv: [f64; 2]) -> Normal3 {
        double::to_normal(self.geometric_normal(patch, &self.corners(patch), uv[0], uv[1]).0)
    }

    /// The position on the patch of a point that lies on it.
    pub(crate) fn position_of(&self, patch: u32, p: Point3, n: Normal3) -> Option<[f64; 2]> {
        let c = self.corners(patch);
        let (p, n) = (double::point(p), double::normal(n));
        let height = (c[3] - c[0]).length().max((c[2] - c[1]).length());
        let distance = |hit: &Candidate| (hit.t - 1.0).abs();
        intersect(&c, p + n * height, -n * height)
            .into_iter()
            .flatten()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .map(|hit| [hit.u, hit.v])
    }

    fn spherical(&self, patch: u32, p: Point3) -> Option<SphericalRectangle> {
        let c = self.corners(patch);
        if !rectangle(&c) {
            return None;
        }
        let [corner, end_u, end_v] = [c[0], c[1], c[2]].map(double::to_point);
        let spherical = SphericalRectangle::new(p, corner, end_u - corner, end_v - corner)?;
        RECTANGLE_SAMPLING.contains(&spherical.solid_angle()).then_some(spherical)
    }

    /// A point uniform in solid angle from `p` with its density per steradian; `None` where sampling by area is
    /// to be used.
    pub(crate) fn sample_solid_angle(&self, patch: u32, p: Point3, u: Point2) -> Option<(ShapeSample, f32)> {
        let spherical = self.spherical(patch, p)?;
        let uv = spherical.sample_shares(u);
        Some((self.sample_at(patch, [uv.x, uv.y].map(f64::from), 0.0), spherical.pdf_w()))
    }

    /// The density per steradian of [`sample_solid_angle`](Self::sample_solid_angle).
    pub(crate) fn solid_angle_pdf(&self, patch: u32, p: Point3) -> Option<f32> {
        self.spherical(patch, p).map(|spherical| spherical.pdf_w())
    }
}

/// Inverse of the derivative of texture coordinates (s, t) by the position (u, v) on the patch.
#[derive(Clone, Copy)]
struct ParameterChange {
    duds: f64,
    dudt: f64,
    dvds: f64,
    dvdt: f64,
}

impl ParameterChange {
    fn apply(&self, by_u: DVec3, by_v: DVec3) -> (DVec3, DVec3) {
        (by_u * self.duds + by_v * self.dvds, by_u * self.dudt + by_v * self.dvdt)
    }
}

/// Shading frame and its derivatives from vertex normals.
fn shade(
    normals: &Corners,
    interpolated: DVec3,
    [u, v]: [f64; 2],
    change: Option<ParameterChange>,
    surface: &mut LocalSurface,
) {
    let length = interpolated.length();
    let Some(n) = interpolated.try_normalize() else { return };
    let ns = surface.point.ns.as_vector();
    let surface = &mut surface.derivatives;
    let second = ns.cross(surface.dpdu);
    if second.length_squared() > 0.0 {
        surface.shading_dpdu = second.cross(ns);
        surface.shading_dpdv = second;
    } else {
        let frame = Frame::from_z(ns);
        surface.shading_dpdu = frame.x;
        surface.shading_dpdv = frame.y;
    }
    let by_patch = (derivative_u(normals, v), derivative_v(normals, u));
    let (du, dv) = change.map_or(by_patch, |change| change.apply(by_patch.0, by_patch.1));
    let unit = |dn: DVec3| -> Vector3 { double::to_vector((dn - n * n.dot(dn)) / length) };
    surface.dndu = unit(du);
    surface.dndv = unit(dv);
}

/// True if the patch is flat with right angles.
fn rectangle(c: &Corners) -> bool {
    let (x, y) = (c[1] - c[0], c[2] - c[0]);
    let tolerance = 1e-5 * (x.length() + y.length());
    (c[3] - (c[1] + y)).length() < tolerance && x.dot(y).abs() < 1e-5 * x.length() * y.length()
}

/// Areas per unit square at the corners.
fn corner_weights(c: &Corners) -> [f64; 4] {
    [stretch(c, 0.0, 0.0), stretch(c, 1.0, 0.0), stretch(c, 0.0, 1.0), stretch(c, 1.0, 1.0)]
        .map(|w| w.max(1e-30))
}

/// x with density proportional to (1-x) a + x b.
fn sample_linear(a: f64, b: f64, u: f64) -> f64 {
    let root = (a * a + u * (b * b - a * a)).max(0.0).sqrt();
    if a + root == 0.0 { u } else { (u * (a + b) / (a + root)).clamp(0.0, 1.0) }
}

fn sample_bilinear(w: &[f64; 4], u: [f64; 2]) -> [f64; 2] {
    let v = sample_linear(w[0] + w[1], w[2] + w[3], u[1]);
    let x = sample_linear(w[0] + v * (w[2] - w[0]), w[1] + v * (w[3] - w[1]), u[0]);
    [x, v]
}

fn bilinear_density(w: &[f64; 4], [u, v]: [f64; 2]) -> f64 {
    let value = (1.0 - v) * ((1.0 - u) * w[0] + u * w[1]) + v * ((1.0 - u) * w[2] + u * w[3]);
    4.0 * value / (w[0] + w[1] + w[2] + w[3])
}
