//! Four triangles at once, watertight.
//!
//! Vertices are moved to the origin of the ray and sheared so that the ray becomes the z axis; the triangle is hit
//! if its three edge functions at the origin of the xy plane have one sign (Woop, Benthin and Wald 2013,
//! "Watertight Ray/Triangle Intersection", JCGT 2(1)). Both triangles at an edge compute exactly opposite values.
//! The sign of a difference of two rounded products is right unless it is 0, so that only then double precision
//! decides. Likewise the sign of t: where it lies within its error (Pharr et al. 2023, section 6.8.7), double precision
//! tells on which side of the triangle the ray starts. A ray that leaves a triangle by the error bound of its point does not
//! meet it again, and one that starts right before another, in a corner, does not slip through.

use glam::DVec3;

use super::PrimitiveRef;
use super::ray::TraversalRay;

/// Up to four triangles; unused places hold NaN and are never hit.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub(super) struct TriangleBlock {
    /// x, y, z of the first, then of the second and the third vertex.
    vertices: [[f32; 4]; 9],
    geometry: [u32; 4],
    primitive: [u32; 4],
}

/// Where a ray hits each of four triangles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lanes {
    pub(super) t: [f32; 4],
    pub(super) b1: [f32; 4],
    pub(super) b2: [f32; 4],
}

/// Sheared vertices, coordinate by coordinate.
type Sheared = [[[f32; 4]; 3]; 3];

impl TriangleBlock {
    /// No triangle.
    pub(super) const EMPTY: Self =
        Self { vertices: [[f32::NAN; 4]; 9], geometry: [u32::MAX; 4], primitive: [u32::MAX; 4] };

    /// Puts a triangle into a place.
    pub(super) fn set(&mut self, lane: usize, reference: PrimitiveRef, triangle: &[[f32; 3]; 3]) {
        for (vertex, p) in triangle.iter().enumerate() {
            for (axis, coordinate) in p.iter().enumerate() {
                self.vertices[vertex * 3 + axis][lane] = *coordinate;
            }
        }
        self.geometry[lane] = reference.geometry;
        self.primitive[lane] = reference.primitive;
    }

    /// What a place holds.
    #[inline]
    pub(super) const fn reference(&self, lane: usize) -> PrimitiveRef {
        PrimitiveRef { geometry: self.geometry[lane], primitive: self.primitive[lane] }
    }

    /// Which triangles the ray hits with t in (0, `t_max`), one bit each, and where.
    #[inline(always)]
    pub(super) fn intersect(&self, ray: &TraversalRay, t_max: f32) -> (u32, Lanes) {
        let sheared = self.sheared(ray);
        let [a, b, c] = &sheared;
        let mut edges = [[0.0_f32; 4]; 3];
        let mut zero = [0_u32; 4];
        for l in 0..4 {
            edges[0][l] = b[0][l] * c[1][l] - b[1][l] * c[0][l];
            edges[1][l] = c[0][l] * a[1][l] - c[1][l] * a[0][l];
            edges[2][l] = a[0][l] * b[1][l] - a[1][l] * b[0][l];
            zero[l] = u32::from((edges[0][l] == 0.0) | (edges[1][l] == 0.0) | (edges[2][l] == 0.0));
        }
        if (zero[0] | zero[1] | zero[2] | zero[3]) != 0 {
            edges_in_double(&sheared, &mut edges);
        }
        let mut lanes = Lanes { t: [0.0; 4], b1: [0.0; 4], b2: [0.0; 4] };
        let mut hit = [0_u32; 4];
        for l in 0..4 {
            let (e0, e1, e2) = (edges[0][l], edges[1][l], edges[2][l]);
            let inside =
                ((e0 >= 0.0) & (e1 >= 0.0) & (e2 >= 0.0)) | ((e0 <= 0.0) & (e1 <= 0.0) & (e2 <= 0.0));
            let determinant = e0 + e1 + e2;
            let inverse = 1.0 / determinant;
            let t = (e0 * a[2][l] + e1 * b[2][l] + e2 * c[2][l]) * ray.shear.z * inverse;
            lanes.t[l] = t;
            lanes.b1[l] = e1 * inverse;
            lanes.b2[l] = e2 * inverse;
            hit[l] = u32::from(inside & (determinant != 0.0) & (t < t_max));
        }
        let mask = hit[0] | hit[1] << 1 | hit[2] << 2 | hit[3] << 3;
        if mask == 0 {
            return (0, lanes);
        }
        self.decide_ahead(mask, ray, &sheared, &edges, lanes)
    }

    /// Keeps the hits that lie ahead of the origin.
    #[inline]
    fn decide_ahead(
        &self,
        mask: u32,
        ray: &TraversalRay,
        sheared: &Sheared,
        edges: &[[f32; 4]; 3],
        mut lanes: Lanes,
    ) -> (u32, Lanes) {
        let mut result = mask;
        for lane in 0..4 {
            if mask >> lane & 1 == 0 {
                continue;
            }
            let t = lanes.t[lane];
            let error = t_error(lane, sheared, edges, ray.shear.z);
            if t.abs() <= error {
                lanes.t[lane] = self.t_in_double(lane, ray);
            }
            let is_ahead = lanes.t[lane] > 0.0;
            if !is_ahead {
                result &= !(1 << lane);
            }
        }
        (result, lanes)
    }

    /// Where the ray meets the plane of a triangle; 0 if it runs parallel. Only the sign of tiny values matters.
    #[cold]
    #[inline(never)]
    fn t_in_double(&self, lane: usize, ray: &TraversalRay) -> f32 {
        let vertex = |v: usize| {
            DVec3::from_array(std::array::from_fn(|axis| self.vertices[v * 3 + axis][lane].into()))
        };
        let a = vertex(0);
        let n = (vertex(1) - a).cross(vertex(2) - a);
        let slope = n.dot(DVec3::from_array(ray.direction.map(f64::from)));
        let height = n.dot(a - DVec3::from_array(ray.origin.map(f64::from)));
        let t = if slope == 0.0 { 0.0 } else { height / slope };
        // A tiny value must not lose its sign.
        if t > 0.0 { (t as f32).max(f32::MIN_POSITIVE) } else { (t as f32).min(0.0) }
    }

    #[inline(always)]
    fn sheared(&self, ray: &TraversalRay) -> Sheared {
        let [kx, ky, kz] = ray.shear.axes;
        let (ox, oy, oz) = (ray.origin[kx], ray.origin[ky], ray.origin[kz]);
        let mut result = [[[0.0_f32; 4]; 3]; 3];
        for (vertex, out) in result.iter_mut().enumerate() {
            let (px, py, pz) = (
                &self.vertices[vertex * 3 + kx],
                &self.vertices[vertex * 3 + ky],
                &self.vertices[vertex * 3 + kz],
            );
            for l in 0..4 {
                let z = pz[l] - oz;
                out[0][l] = (px[l] - ox) + ray.shear.x * z;
                out[1][l] = (py[l] - oy) + ray.shear.y * z;
                out[2][l] = z;
            }
        }
        result
    }
}

/// Edge functions in double precision, where products of single-precision numbers are exact.
#[cold]
#[inline(never)]
fn edges_in_double(sheared: &Sheared, edges: &mut [[f32; 4]; 3]) {
    let [a, b, c] = sheared;
    let edge = |p: &[[f32; 4]; 3], q: &[[f32; 4]; 3], l: usize| {
        let exact = f64::from(p[0][l]) * f64::from(q[1][l]) - f64::from(p[1][l]) * f64::from(q[0][l]);
        let rounded = exact as f32;
        // A tiny value must not lose its sign.
        if rounded == 0.0 && exact != 0.0 { f32::MIN_POSITIVE.copysign(exact as f32) } else { rounded }
    };
    for (edges, (p, q)) in edges.iter_mut().zip([(b, c), (c, a), (a, b)]) {
        *edges = std::array::from_fn(|l| edge(p, q, l));
    }
}

/// Bound of the error of t (Pharr et al. 2023, section 6.8.7).
#[inline]
fn t_error(lane: usize, sheared: &Sheared, edges: &[[f32; 4]; 3], scale: f32) -> f32 {
    const fn gamma(n: u32) -> f32 {
        let x = n as f32 * (f32::EPSILON / 2.0);
        x / (1.0 - x)
    }
    let largest = |axis: usize| {
        sheared[0][axis][lane].abs().max(sheared[1][axis][lane].abs()).max(sheared[2][axis][lane].abs())
    };
    let max_x = largest(0);
    let max_y = largest(1);
    let max_z = largest(2);
    let max_z_scaled = max_z * scale.abs();
    let delta_z = gamma(3) * max_z_scaled;
    let delta_x = gamma(5) * (max_x + max_z);
    let delta_y = gamma(5) * (max_y + max_z);
    let delta_e = 2.0 * (gamma(2) * max_x * max_y + delta_y * max_x + delta_x * max_y);
    let max_e = edges[0][lane].abs().max(edges[1][lane].abs()).max(edges[2][lane].abs());
    let determinant = edges[0][lane] + edges[1][lane] + edges[2][lane];
    3.0 * (gamma(3) * max_e * max_z_scaled + delta_e * max_z_scaled + delta_z * max_e) / determinant.abs()
}
