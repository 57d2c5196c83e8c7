//! Surfaces of triangle meshes: what a hit means, and sampling of single triangles.
//!
//! p = b0 p0 + b1 p1 + b2 p2; texture coordinates, normals and tangents are interpolated alike. dpdu and dpdv solve
//! p_i - p_2 = dpdu (u_i - u_2) + dpdv (v_i - v_2). Positions are formed in double precision, so that their error
//! is that of rounding them.

use etendue_math::warp::{SphericalTriangle, sample_uniform_triangle};
use etendue_math::{Bounds3, Frame, Normal3, Point2, Point3, Transform, Vector3};
use glam::DVec3;

use super::LocalSurface;
use crate::double;
use crate::hit::{ShapeSample, SurfaceDerivatives, SurfacePoint};
use crate::light_sampling::SPHERICAL_SAMPLING;
use crate::mesh::TriangleMesh;

/// A triangle mesh in the space of its group.
#[derive(Clone, Debug)]
pub(crate) struct Triangles {
    mesh: TriangleMesh,
    /// True if normals without vertex normals point against the winding.
    flips: bool,
    /// Largest magnitude of a coordinate.
    size: f64,
}

impl Triangles {
    /// Moves a mesh into the space of its group, reusing its memory.
    pub(crate) fn new(
        mut mesh: TriangleMesh,
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
            for s in &mut mesh.tangents {
                *s = group_from_shape.vector(*s);
            }
        }
        if reverse_orientation {
            for n in &mut mesh.normals {
                *n = -*n;
            }
        }
        let flips = reverse_orientation ^ group_from_shape.swaps_handedness();
        let size = largest_coordinate(&mesh.positions);
        Self { mesh, flips, size }
    }

    /// Moves the vertices; no normals leave those there are.
    pub(crate) fn set_vertices(&mut self, positions: Vec<Point3>, normals: Vec<Normal3>) {
        self.size = largest_coordinate(&positions);
        self.mesh.positions = positions;
        if !normals.is_empty() {
            self.mesh.normals = normals;
        }
    }

    /// One triangle with other corners, and other normals if there are any; all else stays.
    pub(crate) fn alone(&self, triangle: u32, corners: [Point3; 3], normals: Option<[Normal3; 3]>) -> Self {
        let mesh = TriangleMesh {
            positions: corners.to_vec(),
            indices: vec![[0, 1, 2]],
            normals: normals.or_else(|| self.normals(triangle)).map(Vec::from).unwrap_or_default(),
            tangents: self.of_corners(triangle, &self.mesh.tangents),
            uvs: self.of_corners(triangle, &self.mesh.uvs),
            face_indices: self.mesh.face_indices.get(triangle as usize).copied().into_iter().collect(),
        };
        Self { mesh, flips: self.flips, size: largest_coordinate(&corners) }
    }

    /// The values of an array per vertex at the corners of a triangle; none where the array is empty.
    fn of_corners<T: Copy>(&self, triangle: u32, values: &[T]) -> Vec<T> {
        let corners = self.mesh.indices[triangle as usize];
        corners.iter().filter_map(|v| values.get(*v as usize)).copied().collect()
    }

    pub(crate) const fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    #[inline(always)]
    pub(crate) fn positions(&self, triangle: u32) -> [Point3; 3] {
        let [a, b, c] = self.mesh.indices[triangle as usize];
        let position = |vertex: u32| self.mesh.positions[vertex as usize];
        [position(a), position(b), position(c)]
    }

    #[inline(always)]
    fn corners(&self, triangle: u32) -> [DVec3; 3] {
        let [a, b, c] = self.positions(triangle);
        [double::point(a), double::point(b), double::point(c)]
    }

    #[inline(always)]
    fn uvs(&self, triangle: u32) -> [Point2; 3] {
        if self.mesh.uvs.is_empty() {
            return [Point2::new(0.0, 0.0), Point2::new(1.0, 0.0), Point2::new(1.0, 1.0)];
        }
        let [a, b, c] = self.mesh.indices[triangle as usize];
        let uv = |vertex: u32| self.mesh.uvs[vertex as usize];
        [uv(a), uv(b), uv(c)]
    }

    #[inline(always)]
    fn normals(&self, triangle: u32) -> Option<[Normal3; 3]> {
        if self.mesh.normals.is_empty() {
            return None;
        }
        let [a, b, c] = self.mesh.indices[triangle as usize];
        let normal = |vertex: u32| self.mesh.normals[vertex as usize];
        Some([normal(a), normal(b), normal(c)])
    }

    /// Corners of a triangle that can be hit: they are finite and not on one line.
    #[inline]
    pub(crate) fn valid_corners(&self, triangle: u32) -> Option<[[f32; 3]; 3]> {
        let [a, b, c] = self.positions(triangle);
        let origin = double::point(a);
        let area = (double::point(b) - origin).cross(double::point(c) - origin).length_squared();
        // Differences of single-precision numbers do not overflow in double precision: others are infinite or NaN.
        (area > 0.0 && area < f64::INFINITY).then_some([[a.x, a.y, a.z], [b.x, b.y, b.z], [c.x, c.y, c.z]])
    }

    /// Texture coordinates for the barycentric weights of a hit.
    #[inline(always)]
    pub(crate) fn uv(&self, triangle: u32, b: [f32; 2]) -> Point2 {
        let uv = self.uvs(triangle);
        let b0 = 1.0 - b[0] - b[1];
        Point2::new(
            b0 * uv[0].x + b[0] * uv[1].x + b[1] * uv[2].x,
            b0 * uv[0].y + b[0] * uv[1].y + b[1] * uv[2].y,
        )
    }

    /// Unit normal of the winding, or against it where the mesh flips; the zero vector for no area.
    #[inline(always)]
    fn plane_normal(&self, corners: &[DVec3; 3]) -> Normal3 {
        let n = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let length = n.length();
        let scale = if length > 0.0 { 1.0 / length } else { 0.0 };
        double::to_normal(n * if self.flips { -scale } else { scale })
    }

    /// The geometric normal and the interpolated vertex normal, the latter not normalised.
    #[inline(always)]
    fn geometric_normal(
        &self,
        triangle: u32,
        corners: &[DVec3; 3],
        b: [f32; 3],
    ) -> (Normal3, Option<Normal3>) {
        let n = self.plane_normal(corners);
        let Some(normals) = self.normals(triangle) else { return (n, None) };
        let interpolated = interpolate_normals(&normals, b);
        (n.facing(interpolated.as_vector()), Some(interpolated))
    }

    /// The point at barycentric weights, before rounding too.
    #[inline(always)]
    pub(crate) fn point(&self, triangle: u32, b: [f32; 2]) -> (DVec3, SurfacePoint) {
        let corners = self.corners(triangle);
        let weights = [1.0 - b[0] - b[1], b[0], b[1]];
        let p = interpolate(&corners, b);
        let (ng, interpolated) = self.geometric_normal(triangle, &corners, weights);
        let rounded = double::to_point(p);
        let point = SurfacePoint {
            p: rounded,
            p_error: double::surface_error(rounded, self.size),
            ng,
            ns: interpolated.and_then(Normal3::try_normalized).unwrap_or(ng),
            uv: self.uv(triangle, b),
            face_index: self.mesh.face_indices.get(triangle as usize).copied().unwrap_or(0),
        };
        (p, point)
    }

    /// Differential geometry at barycentric weights.
    pub(crate) fn surface(&self, triangle: u32, b: [f32; 2]) -> LocalSurface {
        let (p, point) = self.point(triangle, b);
        let (dpdu, dpdv) = position_derivatives(&self.corners(triangle), &self.uvs(triangle));
        let mut derivatives = SurfaceDerivatives {
            dpdu,
            dpdv,
            shading_dpdu: dpdu,
            shading_dpdv: dpdv,
            ..SurfaceDerivatives::default()
        };
        self.shade(triangle, [1.0 - b[0] - b[1], b[0], b[1]], point.ns.as_vector(), &mut derivatives);
        LocalSurface { p, point, derivatives }
    }

    /// Fills in shading tangents and the derivatives of the shading normal `ns`.
    fn shade(&self, triangle: u32, b: [f32; 3], ns: Vector3, derivatives: &mut SurfaceDerivatives) {
        let normals = self.normals(triangle);
        if normals.is_none() && self.mesh.tangents.is_empty() {
            return;
        }
        let tangent = self.tangent(triangle, b).unwrap_or(derivatives.dpdu);
        let second = ns.cross(tangent);
        if second.length_squared() > 0.0 && second.is_finite() {
            derivatives.shading_dpdu = second.cross(ns);
            derivatives.shading_dpdv = second;
        } else {
            let frame = Frame::from_z(ns);
            derivatives.shading_dpdu = frame.x;
            derivatives.shading_dpdv = frame.y;
        }
        let Some(normals) = normals else { return };
        let (dndu, dndv) = normal_derivatives(&normals, &self.uvs(triangle));
        // Of the unit normal, not of the interpolated vector.
        let length = interpolate_normals(&normals, b).as_vector().length();
        if length > 0.0 {
            let unit = |dn: Vector3| (dn - ns * ns.dot(dn)) / length;
            derivatives.dndu = unit(dndu);
            derivatives.dndv = unit(dndv);
        }
    }

    fn tangent(&self, triangle: u32, b: [f32; 3]) -> Option<Vector3> {
        if self.mesh.tangents.is_empty() {
            return None;
        }
        let [s0, s1, s2] =
            self.mesh.indices[triangle as usize].map(|vertex| self.mesh.tangents[vertex as usize]);
        let s = s0 * b[0] + s1 * b[1] + s2 * b[2];
        (s.length_squared() > 0.0).then_some(s)
    }

    /// Area in square metres.
    pub(crate) fn area(&self, triangle: u32) -> f32 {
        area(&self.corners(triangle)) as f32
    }

    pub(crate) fn bounds(&self, triangle: u32) -> Bounds3 {
        Bounds3::from_points(self.positions(triangle))
    }

    /// The normal as the axis of a cone of no width.
    pub(crate) fn emission_cone(&self, triangle: u32) -> (Normal3, f32) {
        let corners = self.corners(triangle);
        (self.geometric_normal(triangle, &corners, [1.0 / 3.0; 3]).0, 1.0)
    }

    /// The normal, where the vertex normals, if there are any, all lie on its side.
    pub(crate) fn side(&self, triangle: u32) -> Option<Normal3> {
        let n = self.emission_cone(triangle).0;
        let normals = self.normals(triangle);
        let agree = normals.is_none_or(|normals| normals.iter().all(|vertex| vertex.dot(n) > 0.0));
        agree.then_some(n)
    }

    /// A point, uniform in area.
    pub(crate) fn sample_area(&self, triangle: u32, u: Point2) -> Option<ShapeSample> {
        let area = area(&self.corners(triangle));
        if area <= 0.0 || !area.is_finite() {
            return None;
        }
        let [_, b1, b2] = sample_uniform_triangle(u);
        Some(self.sample_at(triangle, [b1, b2.max(0.0)], (1.0 / area) as f32))
    }

    #[inline]
    fn sample_at(&self, triangle: u32, b: [f32; 2], pdf_a: f32) -> ShapeSample {
        let corners = self.corners(triangle);
        let p = double::to_point(interpolate(&corners, b));
        let n = self.geometric_normal(triangle, &corners, [1.0 - b[0] - b[1], b[0], b[1]]).0;
        ShapeSample { p, p_error: double::surface_error(p, self.size), n, uv: self.uv(triangle, b), pdf_a }
    }

    /// The triangle on the sphere of directions around `p`, where sampling by direction applies.
    #[inline]
    fn spherical(&self, triangle: u32, p: Point3) -> Option<SphericalTriangle> {
        let spherical = SphericalTriangle::new(self.positions(triangle), p)?;
        SPHERICAL_SAMPLING.contains(&spherical.solid_angle()).then_some(spherical)
    }

    /// A point uniform in solid angle from `p` with its density per steradian; `None` where sampling by area is
    /// to be used.
    #[inline]
    pub(crate) fn sample_solid_angle(
        &self,
        triangle: u32,
        p: Point3,
        u: Point2,
    ) -> Option<(ShapeSample, f32)> {
        let spherical = self.spherical(triangle, p)?;
        let [_, b1, b2] = spherical.sample(u);
        Some((self.sample_at(triangle, [b1, b2], 0.0), spherical.pdf_w()))
    }

    /// The density per steradian of [`sample_solid_angle`](Self::sample_solid_angle).
    #[inline]
    pub(crate) fn solid_angle_pdf(&self, triangle: u32, p: Point3) -> Option<f32> {
        self.spherical(triangle, p).map(|spherical| spherical.pdf_w())
    }
}

fn largest_coordinate(points: &[Point3]) -> f64 {
    points.iter().map(|p| p.abs().max_element()).filter(|x| x.is_finite()).fold(0.0, f32::max).into()
}

/// The point with barycentric weights b1 and b2.
#[inline(always)]
fn interpolate(corners: &[DVec3; 3], b: [f32; 2]) -> DVec3 {
    corners[0] + (corners[1] - corners[0]) * f64::from(b[0]) + (corners[2] - corners[0]) * f64::from(b[1])
}

#[inline(always)]
fn interpolate_normals(normals: &[Normal3; 3], b: [f32; 3]) -> Normal3 {
    normals[0] * b[0] + normals[1] * b[1] + normals[2] * b[2]
}

fn area(corners: &[DVec3; 3]) -> f64 {
    0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).length()
}

/// Differences of texture coordinates to the third corner and their determinant, unless it vanishes.
fn uv_system(uv: &[Point2; 3]) -> Option<([f64; 2], [f64; 2], f64)> {
    let difference = |a: Point2| [f64::from(a.x) - f64::from(uv[2].x), f64::from(a.y) - f64::from(uv[2].y)];
    let (duv02, duv12) = (difference(uv[0]), difference(uv[1]));
    let determinant = duv02[0] * duv12[1] - duv02[1] * duv12[0];
    (determinant.abs() >= 1e-9).then_some((duv02, duv12, determinant))
}

fn position_derivatives(corners: &[DVec3; 3], uv: &[Point2; 3]) -> (Vector3, Vector3) {
    let (dp02, dp12) = (corners[0] - corners[2], corners[1] - corners[2]);
    if let Some((duv02, duv12, determinant)) = uv_system(uv) {
        let dpdu = (dp02 * duv12[1] - dp12 * duv02[1]) / determinant;
        let dpdv = (dp12 * duv02[0] - dp02 * duv12[0]) / determinant;
        if dpdu.cross(dpdv).length_squared() > 0.0 {
            return (double::to_vector(dpdu), double::to_vector(dpdv));
        }
    }
    let n = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let frame = Frame::from_z(double::to_vector(n.normalize_or(DVec3::Z)));
    (frame.x, frame.y)
}

/// Derivatives of the interpolated normal before normalisation.
fn normal_derivatives(normals: &[Normal3; 3], uv: &[Point2; 3]) -> (Vector3, Vector3) {
    let Some((duv02, duv12, determinant)) = uv_system(uv) else {
        return (Vector3::default(), Vector3::default());
    };
    let dn02 = double::normal(normals[0]) - double::normal(normals[2]);
    let dn12 = double::normal(normals[1]) - double::normal(normals[2]);
    let dndu = (dn02 * duv12[1] - dn12 * duv02[1]) / determinant;
    let dndv = (dn12 * duv02[0] - dn02 * duv12[0]) / determinant;
    (double::to_vector(dndu), double::to_vector(dndv))
}
