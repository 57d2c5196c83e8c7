//! Affine and projective transforms with their inverses, and their interpolation in time.
//!
//! A transform is named by both ends, `world_from_object`, so that a wrong product is visible: inner names meet.

use std::ops::Mul;

use glam::{DMat3, DMat4, DQuat, DVec3, DVec4};

use crate::{Bounds3, Normal3, Point3, Ray, Vector3};

/// A 4x4 matrix with its inverse. Points are columns: `p' = M p`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// Rows of the matrix.
    m: [[f32; 4]; 4],
    /// Rows of the inverse.
    inverse: [[f32; 4]; 4],
}

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

fn rows(m: DMat4) -> [[f32; 4]; 4] {
    m.transpose().to_cols_array_2d().map(|row| row.map(|x| x as f32))
}

fn matrix(rows: [[f32; 4]; 4]) -> DMat4 {
    DMat4::from_cols_array_2d(&rows.map(|row| row.map(f64::from))).transpose()
}

fn dvec(v: Vector3) -> DVec3 {
    DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
}

impl Transform {
    /// The transform that changes nothing.
    pub const IDENTITY: Self = {
        let m = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
        Self { m, inverse: m }
    };

    fn from_glam(m: DMat4) -> Self {
        Self { m: rows(m), inverse: rows(m.inverse()) }
    }

    /// From the rows of a matrix; `None` if it has no inverse.
    #[must_use]
    pub fn from_rows(m: [[f32; 4]; 4]) -> Option<Self> {
        let d = matrix(m);
        let determinant = d.determinant();
        (determinant != 0.0 && determinant.is_finite()).then(|| Self { m, inverse: rows(d.inverse()) })
    }

    /// Translation by `v`.
    #[must_use]
    pub fn translate(v: Vector3) -> Self {
        Self::from_glam(DMat4::from_translation(dvec(v)))
    }

    /// Scaling along the axes; `None` if a factor is 0.
    #[must_use]
    pub fn scale(x: f32, y: f32, z: f32) -> Option<Self> {
        Self::from_rows([[x, 0.0, 0.0, 0.0], [0.0, y, 0.0, 0.0], [0.0, 0.0, z, 0.0], [0.0, 0.0, 0.0, 1.0]])
    }

    /// Rotation about `axis` by an angle in radians; `None` for the zero axis.
    #[must_use]
    pub fn rotate(angle_rad: f32, axis: Vector3) -> Option<Self> {
        let axis = dvec(axis).try_normalize()?;
        Some(Self::from_glam(DMat4::from_axis_angle(axis, f64::from(angle_rad))))
    }

    /// `camera_from_world` of a viewer at `eye` who looks at `target`: +z ahead, +y up, left-handed as in pbrt.
    /// `None` if the directions are degenerate.
    #[must_use]
    pub fn look_at(eye: Point3, target: Point3, up: Vector3) -> Option<Self> {
        let forward = dvec(target - eye).try_normalize()?;
        let right = dvec(up).try_normalize()?.cross(forward).try_normalize()?;
        let up = forward.cross(right);
        let world_from_camera = DMat4::from_cols(
            right.extend(0.0),
            up.extend(0.0),
            forward.extend(0.0),
            dvec(eye.as_vector()).extend(1.0),
        );
        Some(Self::from_glam(world_from_camera.inverse()))
    }

    /// Perspective projection: z in [near, far] to [0, 1], the view cone of full angle `fov_rad` to [-1, 1].
    #[must_use]
    pub fn perspective(fov_rad: f32, near: f32, far: f32) -> Self {
        let inv_tan = 1.0 / (f64::from(fov_rad) / 2.0).tan();
        let (near, far) = (f64::from(near), f64::from(far));
        Self::from_glam(DMat4::from_cols(
            DVec4::new(inv_tan, 0.0, 0.0, 0.0),
            DVec4::new(0.0, inv_tan, 0.0, 0.0),
            DVec4::new(0.0, 0.0, far / (far - near), 1.0),
            DVec4::new(0.0, 0.0, -far * near / (far - near), 0.0),
        ))
    }

    /// The transform in the other direction.
    #[inline]
    #[must_use]
    pub const fn inverse(&self) -> Self {
        Self { m: self.inverse, inverse: self.m }
    }

    /// Rows of the matrix.
    #[inline]
    #[must_use]
    pub const fn rows(&self) -> &[[f32; 4]; 4] {
        &self.m
    }

    /// True if this is exactly the identity.
    #[must_use]
    pub fn is_identity(&self) -> bool {
        *self == Self::IDENTITY
    }

    /// True if the transform turns left-handed frames into right-handed ones.
    #[must_use]
    pub fn swaps_handedness(&self) -> bool {
        let m = &self.m;
        let column = |c: usize| DVec3::new(f64::from(m[0][c]), f64::from(m[1][c]), f64::from(m[2][c]));
        DMat3::from_cols(column(0), column(1), column(2)).determinant() < 0.0
    }

    /// Transforms a point, with division by w where the transform is projective.
    #[inline]
    #[must_use]
    pub fn point(&self, p: Point3) -> Point3 {
        let m = &self.m;
        let row = |r: usize| m[r][0] * p.x + m[r][1] * p.y + m[r][2] * p.z + m[r][3];
        let w = row(3);
        let q = Point3::new(row(0), row(1), row(2));
        if w == 1.0 { q } else { Point3::new(q.x / w, q.y / w, q.z / w) }
    }

    /// Transforms a vector: translation does not apply.
    #[inline]
    #[must_use]
    pub fn vector(&self, v: Vector3) -> Vector3 {
        let m = &self.m;
        let row = |r: usize| m[r][0] * v.x + m[r][1] * v.y + m[r][2] * v.z;
        Vector3::new(row(0), row(1), row(2))
    }

    /// Transforms a normal by the inverse transpose; the length changes.
    #[inline]
    #[must_use]
    pub fn normal(&self, n: Normal3) -> Normal3 {
        let i = &self.inverse;
        let column = |c: usize| i[0][c] * n.x + i[1][c] * n.y + i[2][c] * n.z;
        Normal3::new(column(0), column(1), column(2))
    }

    /// Transforms a ray; its direction is not normalised, so that t means the same point before and after.
    #[inline]
    #[must_use]
    pub fn ray(&self, ray: &Ray) -> Ray {
        Ray { origin: self.point(ray.origin), direction: self.vector(ray.direction), time: ray.time }
    }

    /// The box around the transformed corners.
    #[must_use]
    pub fn bounds(&self, b: Bounds3) -> Bounds3 {
        if b.is_empty() {
            return b;
        }
        Bounds3::from_points(b.corners().map(|p| self.point(p)))
    }

    /// Bound of the absolute error of each coordinate of `self.point(p)`, where `p` itself is off by at most
    /// `p_error` (gamma arithmetic of Pharr et al. 2023, section 6.8.5).
    #[must_use]
    pub fn point_error(&self, p: Point3, p_error: Vector3) -> Vector3 {
        const GAMMA_3: f32 = 3.0 * (f32::EPSILON / 2.0) / (1.0 - 3.0 * (f32::EPSILON / 2.0));
        let m = &self.m;
        let row = |r: usize| {
            let carried = m[r][0].abs() * p_error.x + m[r][1].abs() * p_error.y + m[r][2].abs() * p_error.z;
            let rounded =
                (m[r][0] * p.x).abs() + (m[r][1] * p.y).abs() + (m[r][2] * p.z).abs() + m[r][3].abs();
            (GAMMA_3 + 1.0) * carried + GAMMA_3 * rounded
        };
        Vector3::new(row(0), row(1), row(2))
    }
}

/// `a_from_c = a_from_b * b_from_c`, formed in double precision.
impl Mul for Transform {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            m: rows(matrix(self.m) * matrix(other.m)),
            inverse: rows(matrix(other.inverse) * matrix(self.inverse)),
        }
    }
}

/// A transform at two times; between them translation, rotation and stretch are interpolated apart
/// (Shoemake and Duff 1992, "Matrix Animation and Polar Decomposition").
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnimatedTransform {
    /// The transform at `start_time` and before.
    pub start: Transform,
    /// The transform at `end_time` and after.
    pub end: Transform,
    /// Seconds.
    pub start_time: f32,
    /// Seconds.
    pub end_time: f32,
}

impl AnimatedTransform {
    /// A transform that does not move.
    #[must_use]
    pub const fn constant(transform: Transform) -> Self {
        Self { start: transform, end: transform, start_time: 0.0, end_time: 1.0 }
    }

    /// True if the two ends differ.
    #[inline]
    #[must_use]
    pub fn is_animated(&self) -> bool {
        self.start != self.end
    }

    /// The transform at a time in seconds. Decomposes both ends each time: see [`motion`](Self::motion).
    #[must_use]
    pub fn at(&self, time: f32) -> Transform {
        if !self.is_animated() || time <= self.start_time {
            return self.start;
        }
        if time >= self.end_time {
            return self.end;
        }
        self.motion().at(time)
    }

    /// The same motion with both ends decomposed, for many evaluations.
    #[must_use]
    pub fn motion(&self) -> Motion {
        let (translation0, rotation0, stretch0) = decompose(matrix(self.start.m));
        let (translation1, mut rotation1, stretch1) = decompose(matrix(self.end.m));
        if rotation0.dot(rotation1) < 0.0 {
            rotation1 = -rotation1;
        }
        Motion {
            ends: *self,
            translation: [translation0, translation1],
            rotation: [rotation0, rotation1],
            stretch: [stretch0, stretch1],
        }
    }

    /// A box that holds `bounds` at every time: the union over densely sampled times, widened by the largest
    /// step between neighbours, which bounds what lies between them.
    #[must_use]
    pub fn motion_bounds(&self, bounds: Bounds3) -> Bounds3 {
        if !self.is_animated() || bounds.is_empty() {
            return self.start.bounds(bounds);
        }
        const STEPS: u32 = 64;
        let motion = self.motion();
        let corners_at = |step: u32| {
            let t = step as f32 / STEPS as f32;
            let transform = motion.at(self.start_time + t * (self.end_time - self.start_time));
            bounds.corners().map(|p| transform.point(p))
        };
        let mut previous = corners_at(0);
        let mut result = Bounds3::from_points(previous);
        let mut largest_step = 0.0_f32;
        for step in 1..=STEPS {
            let corners = corners_at(step);
            for (a, b) in previous.iter().zip(&corners) {
                largest_step = largest_step.max(a.distance(*b));
            }
            result = result.union(Bounds3::from_points(corners));
            previous = corners;
        }
        let margin = Vector3::splat(largest_step / 2.0);
        Bounds3 { min: result.min - margin, max: result.max + margin }
    }
}

/// An [`AnimatedTransform`] whose ends are decomposed into translation, rotation and stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    ends: AnimatedTransform,
    translation: [DVec3; 2],
    rotation: [DQuat; 2],
    stretch: [DMat3; 2],
}

impl Motion {
    /// What was decomposed.
    #[must_use]
    pub const fn ends(&self) -> &AnimatedTransform {
        &self.ends
    }

    /// The transform at a time in seconds.
    #[must_use]
    pub fn at(&self, time: f32) -> Transform {
        let ends = &self.ends;
        if time <= ends.start_time || !ends.is_animated() {
            return ends.start;
        }
        if time >= ends.end_time {
            return ends.end;
        }
        let t = f64::from((time - ends.start_time) / (ends.end_time - ends.start_time));
        let rotation = DMat3::from_quat(self.rotation[0].slerp(self.rotation[1], t));
        let linear = rotation * (self.stretch[0] * (1.0 - t) + self.stretch[1] * t);
        let translation = self.translation[0].lerp(self.translation[1], t);
        Transform::from_glam(DMat4::from_mat3_translation(linear, translation))
    }
}

/// Translation, rotation and stretch of an affine matrix by polar decomposition.
fn decompose(m: DMat4) -> (DVec3, DQuat, DMat3) {
    let linear = DMat3::from_mat4(m);
    let mut rotation = linear;
    for _ in 0..100 {
        let next = (rotation + rotation.inverse().transpose()) * 0.5;
        let change = (next - rotation).abs().to_cols_array().into_iter().fold(0.0, f64::max);
        rotation = next;
        if change < 1e-12 {
            break;
        }
    }
    if rotation.determinant() < 0.0 {
        rotation = -rotation;
    }
    let stretch = rotation.inverse() * linear;
    (m.w_axis.truncate(), DQuat::from_mat3(&rotation).normalize(), stretch)
}
