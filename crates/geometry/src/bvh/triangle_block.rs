//! Eight triangles at once, watertight.
//!
//! Vertices are moved to the origin of the ray and sheared so that the ray becomes the z axis; the triangle is hit
//! if its three edge functions at the origin of the xy plane have one sign (Woop, Benthin and Wald 2013,
//! "Watertight Ray/Triangle Intersection", JCGT 2(1)). Both triangles at an edge compute exactly opposite values.
//! The sign of a difference of two rounded products is right unless it is 0, so that only then double precision
//! decides. Likewise the sign of t: where it lies within its error (Pharr et al. 2023, section 6.8.7), double precision
//! tells on which side of the triangle the ray starts. A ray that leaves a triangle by the error bound of its point does not
//! meet it again, and one that starts right before another, in a corner, does not slip through.
//!
//! Triangles come in pairs that share an edge, as most do in a mesh: pair `i` is the quadrilateral p0 p1 p2 p3, cut into
//! p0 p1 p2 (lane `i`) and p2 p3 p0 (lane `i + 4`). Two rows of eight, p0 p2 and p1 p3, then hold four pairs, and
//! swapping the halves of the first row gives the third corners. Only lanes that pass the test of signs are finished,
//! one by one and with their corners in the order of the mesh, so that a hit does not depend on how triangles are paired.

use glam::DVec3;

use super::PrimitiveRef;
use super::lanes::{Lanes, Portable};
use super::pair::Pair;
use super::ray::TraversalRay;

/// Up to four pairs of triangles; unused places hold NaN and are never hit.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct TriangleBlock {
    /// x, y, z of p0 of each pair, then of p2.
    shared: [[f32; 8]; 3],
    /// x, y, z of p1 of each pair, then of p3.
    apart: [[f32; 8]; 3],
    primitive: [u32; 8],
    geometry: [u32; 4],
    /// Which corner of its mesh's triangle is the first here.
    first_corner: [u8; 8],
}

/// A triangle that a ray hits: t and the weights of the second and third vertex.
pub(super) type TriangleHit = (f32, [f32; 2]);

impl TriangleBlock {
    /// No triangle.
    pub(super) const EMPTY: Self = Self {
        shared: [[f32::NAN; 8]; 3],
        apart: [[f32::NAN; 8]; 3],
        primitive: [u32::MAX; 8],
        geometry: [u32::MAX; 4],
        first_corner: [0; 8],
    };

    /// Puts a pair of triangles into a place. `vertices` gives the corners of a triangle.
    pub(super) fn set(&mut self, place: usize, pair: Pair, vertices: impl Fn(PrimitiveRef) -> [[f32; 3]; 3]) {
        let first = vertices(pair.first);
        self.geometry[place] = pair.first.geometry;
        let Some(second) = pair.second else {
            self.set_triangle(place, pair.first.primitive, &first, 0);
            return;
        };
        let vertices = vertices(PrimitiveRef { primitive: second, ..pair.first });
        let (i, j) = super::pair::common_edge(&first, &vertices).expect("a pair has a common edge");
        self.set_triangle(place, pair.first.primitive, &first, (i + 1) % 3);
        self.set_triangle(place + 4, second, &vertices, (j + 1) % 3);
    }

    /// Sets the first two corners of a lane, and the third by way of its twin.
    fn set_triangle(&mut self, lane: usize, primitive: u32, triangle: &[[f32; 3]; 3], first_corner: usize) {
        let corner = |i: usize| triangle[(first_corner + i) % 3];
        for (axis, ((a, b), c)) in corner(0).into_iter().zip(corner(1)).zip(corner(2)).enumerate() {
            self.shared[axis][lane] = a;
            self.apart[axis][lane] = b;
            self.shared[axis][lane ^ 4] = c;
        }
        self.primitive[lane] = primitive;
        self.first_corner[lane] = first_corner as u8;
    }

    /// The triangles in a place.
    pub(super) fn pair(&self, place: usize) -> Option<Pair> {
        let exists = |primitive: &u32| *primitive != u32::MAX;
        let first = self.reference(place);
        let second = Some(self.primitive[place + 4]).filter(exists);
        exists(&first.primitive).then_some(Pair { first, second })
    }

    /// How many triangles it holds.
    pub(super) fn n_triangles(&self) -> u32 {
        self.primitive.iter().map(|primitive| u32::from(*primitive != u32::MAX)).sum()
    }

    /// What a lane holds.
    #[inline(always)]
    pub(super) const fn reference(&self, lane: usize) -> PrimitiveRef {
        PrimitiveRef { geometry: self.geometry[lane & 3], primitive: self.primitive[lane & 7] }
    }

    /// Tells which triangles the ray hits with t in (0, `t_max`], one bit each, and where, if there are any.
    #[inline(always)]
    pub(super) fn intersect<L: Lanes, T>(
        &self,
        lanes: L,
        ray: &TraversalRay,
        t_max: f32,
        found: impl FnOnce(u32, &Hits) -> T,
    ) -> Option<T> {
        let a = shear_rows(lanes, &self.shared, ray);
        let b = shear_rows(lanes, &self.apart, ray);
        let c = [lanes.swap_halves(a[0]), lanes.swap_halves(a[1]), lanes.swap_halves(a[2])];
        let mut edges = [edge_rows(lanes, b, c), edge_rows(lanes, c, a), edge_rows(lanes, a, b)];
        let mut mask = have_one_sign(lanes, edges);
        if mask == 0 {
            return None;
        }
        let sizes = [lanes.abs(edges[0]), lanes.abs(edges[1]), lanes.abs(edges[2])];
        let zeros = lanes.at_most(lanes.min(lanes.min(sizes[0], sizes[1]), sizes[2]), lanes.splat(0.0));
        if zeros & mask != 0 {
            let stored = [lanes.store(edges[0]), lanes.store(edges[1]), lanes.store(edges[2])];
            let decided = self.decide_edges(zeros & mask, ray, stored);
            edges = [lanes.load(&decided[0]), lanes.load(&decided[1]), lanes.load(&decided[2])];
            mask &= have_one_sign(lanes, edges);
        }
        // t is a mean of the scaled heights: it is positive where all of them are, and negative likewise.
        let scale = lanes.splat(ray.shear.z);
        let heights = [lanes.mul(a[2], scale), lanes.mul(b[2], scale), lanes.mul(c[2], scale)];
        let highest = lanes.max(lanes.max(heights[0], heights[1]), heights[2]);
        mask &= !lanes.at_most(highest, lanes.splat(0.0));
        if mask == 0 {
            return None;
        }
        let inverse = lanes.div(lanes.splat(1.0), ordered_sum(lanes, edges));
        let products = [
            lanes.mul(edges[0], heights[0]),
            lanes.mul(edges[1], heights[1]),
            lanes.mul(edges[2], heights[2]),
        ];
        let t = lanes.mul(ordered_sum(lanes, products), inverse);
        // NaN, where all edge functions are 0, is lost here.
        mask &= lanes.at_most(t, lanes.splat(t_max));
        if mask == 0 {
            return None;
        }
        let lowest = lanes.min(lanes.min(heights[0], heights[1]), heights[2]);
        let mut hits = Hits {
            t: lanes.store(t),
            edges: [lanes.store(edges[0]), lanes.store(edges[1]), lanes.store(edges[2])],
            inverse: lanes.store(inverse),
        };
        let mixed = mask & lanes.at_most(lowest, lanes.splat(0.0));
        if mixed != 0 {
            let highest = largest(lanes, heights);
            let error = t_error(lanes, [a, b, c], edges, highest);
            let unsure = mixed & lanes.at_most(lanes.abs(t), lanes.mul(error, lanes.abs(inverse)));
            if unsure != 0 {
                self.decide_t(unsure, ray, &mut hits.t);
            }
            mask &= !lanes.at_most(lanes.load(&hits.t), lanes.splat(0.0));
            if mask == 0 {
                return None;
            }
        }
        Some(found(mask, &hits))
    }

    /// The weights of the second and third vertex.
    #[inline(always)]
    pub(super) fn weights(&self, lane: usize, hits: &Hits) -> [f32; 2] {
        let [_, j, k] = self.mesh_order(lane);
        [hits.edges[j][lane] * hits.inverse[lane], hits.edges[k][lane] * hits.inverse[lane]]
    }

    /// Which corners of a lane are the first, second and third in the mesh.
    #[inline(always)]
    const fn mesh_order(&self, lane: usize) -> [usize; 3] {
        const ORDERS: [[usize; 3]; 4] = [[0, 1, 2], [2, 0, 1], [1, 2, 0], [0, 1, 2]];
        ORDERS[self.first_corner[lane] as usize & 3]
    }

    /// Corners of a triangle in the order of the mesh.
    #[inline(always)]
    fn corners(&self, lane: usize) -> [[f32; 3]; 3] {
        // As `mesh_order` has it, but without addresses to compute.
        let (p, q, r) = (self.corner(lane, 0), self.corner(lane, 1), self.corner(lane, 2));
        match self.first_corner[lane] {
            1 => [r, p, q],
            2 => [q, r, p],
            _ => [p, q, r],
        }
    }

    #[inline(always)]
    fn corner(&self, lane: usize, corner: usize) -> [f32; 3] {
        let rows = if corner == 1 { &self.apart } else { &self.shared };
        let lane = if corner == 2 { lane ^ 4 } else { lane } & 7;
        [rows[0][lane], rows[1][lane], rows[2][lane]]
    }

    /// Recomputes edge functions, of which some are 0, in double precision.
    #[cold]
    #[inline(never)]
    fn decide_edges(&self, mask: u32, ray: &TraversalRay, edges: [[f32; 8]; 3]) -> [[f32; 8]; 3] {
        let mut edges = edges;
        for lane in (0..8).filter(|lane| mask >> lane & 1 != 0) {
            let exact = edges_in_double(&shear(ray, &self.corners(lane)));
            for (exact, corner) in exact.into_iter().zip(self.mesh_order(lane)) {
                edges[corner][lane] = exact;
            }
        }
        edges
    }

    /// Recomputes t in double precision.
    #[cold]
    #[inline(never)]
    fn decide_t(&self, mask: u32, ray: &TraversalRay, t: &mut [f32; 8]) {
        let mut mask = mask;
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize & 7;
            mask &= mask - 1;
            t[lane] = t_in_double(ray, self.corners(lane));
        }
    }
}

/// Where a ray hits eight triangles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hits {
    pub(super) t: [f32; 8],
    /// Edge functions opposite to the corners, in the order of the block.
    edges: [[f32; 8]; 3],
    /// Reciprocal of their sum.
    inverse: [f32; 8],
}

/// The same test on a single triangle.
pub(super) fn intersect(ray: &TraversalRay, corners: &[[f32; 3]; 3]) -> Option<TriangleHit> {
    // Most triangles end here: the same edge functions as in the block, of which two have opposite signs.
    let [a, b, c] = shear(ray, corners);
    let edges = [(b, c), (c, a), (a, b)].map(|(p, q)| p[0] * q[1] - p[1] * q[0]);
    if edges.iter().any(|e| *e < 0.0) && edges.iter().any(|e| *e > 0.0) {
        return None;
    }
    let mut block = TriangleBlock::EMPTY;
    block.set_triangle(0, 0, corners, 0);
    block.intersect(Portable, ray, f32::MAX, |_, hits| (hits.t[0], block.weights(0, hits)))
}

/// Eight points seen from the ray, which runs along z.
#[inline(always)]
fn shear_rows<L: Lanes>(lanes: L, rows: &[[f32; 8]; 3], ray: &TraversalRay) -> [L::Floats; 3] {
    let [kx, ky, kz] = ray.shear.axes;
    let x = lanes.sub(lanes.load(lanes.row(rows, kx)), lanes.splat(ray.origin[kx]));
    let y = lanes.sub(lanes.load(lanes.row(rows, ky)), lanes.splat(ray.origin[ky]));
    let z = lanes.sub(lanes.load(lanes.row(rows, kz)), lanes.splat(ray.origin[kz]));
    [
        lanes.add(x, lanes.mul(lanes.splat(ray.shear.x), z)),
        lanes.add(y, lanes.mul(lanes.splat(ray.shear.y), z)),
        z,
    ]
}

/// Twice the area, seen from the ray, of the triangle with the origin.
#[inline(always)]
fn edge_rows<L: Lanes>(lanes: L, p: [L::Floats; 3], q: [L::Floats; 3]) -> L::Floats {
    lanes.sub(lanes.mul(p[0], q[1]), lanes.mul(p[1], q[0]))
}

/// One bit for each lane whose edge functions are all at least or all at most 0.
#[inline(always)]
fn have_one_sign<L: Lanes>(lanes: L, edges: [L::Floats; 3]) -> u32 {
    // Where there is no triangle, the first and the last are NaN: they must come second to stay.
    let least = lanes.min(edges[1], lanes.min(edges[0], edges[2]));
    let greatest = lanes.max(edges[1], lanes.max(edges[0], edges[2]));
    let zero = lanes.splat(0.0);
    lanes.at_most(zero, least) | lanes.at_most(greatest, zero)
}

/// A sum whose rounding does not depend on the order of its terms: least and greatest first.
#[inline(always)]
fn ordered_sum<L: Lanes>(lanes: L, [a, b, c]: [L::Floats; 3]) -> L::Floats {
    let (low, high) = (lanes.min(a, b), lanes.max(a, b));
    let middle = lanes.max(low, lanes.min(high, c));
    lanes.add(lanes.add(lanes.min(low, c), lanes.max(high, c)), middle)
}

/// One triangle seen from the ray.
fn shear(ray: &TraversalRay, corners: &[[f32; 3]; 3]) -> [[f32; 3]; 3] {
    let [kx, ky, kz] = ray.shear.axes;
    corners.map(|p| {
        let z = p[kz] - ray.origin[kz];
        [(p[kx] - ray.origin[kx]) + ray.shear.x * z, (p[ky] - ray.origin[ky]) + ray.shear.y * z, z]
    })
}

/// Where the ray meets the plane of a triangle; 0 if it does not.
#[inline(always)]
fn t_in_double(ray: &TraversalRay, [a, b, c]: [[f32; 3]; 3]) -> f32 {
    let (a, b, c) = (double(a), double(b), double(c));
    let n = (b - a).cross(c - a);
    let slope = n.dot(double(xyz(ray.direction)));
    let height = n.dot(a - double(xyz(ray.origin)));
    let is_ahead = (height > 0.0 && slope > 0.0) || (height < 0.0 && slope < 0.0);
    // A tiny value must not become 0.
    if is_ahead { ((height / slope) as f32).max(f32::MIN_POSITIVE) } else { 0.0 }
}

const fn xyz([x, y, z, _]: [f32; 4]) -> [f32; 3] {
    [x, y, z]
}

const fn double([x, y, z]: [f32; 3]) -> DVec3 {
    DVec3::new(x as f64, y as f64, z as f64)
}

/// Edge functions in double precision, where products of single-precision numbers are exact.
fn edges_in_double(sheared: &[[f32; 3]; 3]) -> [f32; 3] {
    let [a, b, c] = sheared;
    let edge = |p: &[f32; 3], q: &[f32; 3]| {
        let exact = f64::from(p[0]) * f64::from(q[1]) - f64::from(p[1]) * f64::from(q[0]);
        let rounded = exact as f32;
        // A tiny value must not lose its sign.
        if rounded == 0.0 && exact != 0.0 { f32::MIN_POSITIVE.copysign(exact as f32) } else { rounded }
    };
    [edge(b, c), edge(c, a), edge(a, b)]
}

/// Bound of the relative error of `n` roundings in a row (Pharr et al. 2023, section 6.8.1).
const fn gamma(n: u32) -> f32 {
    let x = n as f32 * (f32::EPSILON / 2.0);
    x / (1.0 - x)
}
const GAMMA_2: f32 = gamma(2);
const GAMMA_3: f32 = gamma(3);
const GAMMA_5: f32 = gamma(5);

/// Bound of the error of t, times the sum of the edge functions (Pharr et al. 2023, section 6.8.7).
#[inline(always)]
fn t_error<L: Lanes>(
    lanes: L,
    corners: [[L::Floats; 3]; 3],
    edges: [L::Floats; 3],
    max_height: L::Floats,
) -> L::Floats {
    let max_x = largest(lanes, [corners[0][0], corners[1][0], corners[2][0]]);
    let max_y = largest(lanes, [corners[0][1], corners[1][1], corners[2][1]]);
    let max_z = largest(lanes, [corners[0][2], corners[1][2], corners[2][2]]);
    let max_e = largest(lanes, edges);
    let [gamma_2, gamma_3, gamma_5] = [lanes.splat(GAMMA_2), lanes.splat(GAMMA_3), lanes.splat(GAMMA_5)];
    let delta_z = lanes.mul(gamma_3, max_height);
    let delta_x = lanes.mul(gamma_5, lanes.add(max_x, max_z));
    let delta_y = lanes.mul(gamma_5, lanes.add(max_y, max_z));
    let of_products = lanes.mul(gamma_2, lanes.mul(max_x, max_y));
    let of_factors = lanes.add(lanes.mul(delta_y, max_x), lanes.mul(delta_x, max_y));
    let delta_e = lanes.mul(lanes.splat(2.0), lanes.add(of_products, of_factors));
    let of_t = lanes.mul(lanes.add(lanes.mul(gamma_3, max_e), delta_e), max_height);
    lanes.mul(lanes.splat(3.0), lanes.add(of_t, lanes.mul(delta_z, max_e)))
}

#[inline(always)]
fn largest<L: Lanes>(lanes: L, v: [L::Floats; 3]) -> L::Floats {
    lanes.max(lanes.max(lanes.abs(v[0]), lanes.abs(v[1])), lanes.abs(v[2]))
}
