//! Orthonormal frames: shading happens where the normal is +z (SPEC RAD-12).

use crate::Vector3;

/// A right-handed orthonormal basis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// First tangent.
    pub x: Vector3,
    /// Second tangent.
    pub y: Vector3,
    /// Normal.
    pub z: Vector3,
}

impl Frame {
    /// A frame around the unit vector `z`, without branches or loss of precision near -z
    /// (Duff et al. 2017, "Building an Orthonormal Basis, Revisited", JCGT 6(1)).
    #[inline]
    #[must_use]
    pub fn from_z(z: Vector3) -> Self {
        let sign = 1.0_f32.copysign(z.z);
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        let x = Vector3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x);
        let y = Vector3::new(b, sign + z.y * z.y * a, -z.y);
        Self { x, y, z }
    }

    /// A frame with the unit normal `z` and a first tangent as near to `x` as orthogonality allows;
    /// any tangent if `x` is parallel to `z`.
    #[inline]
    #[must_use]
    pub fn from_zx(z: Vector3, x: Vector3) -> Self {
        let tangent = x - z * x.dot(z);
        let length_squared = tangent.length_squared();
        if length_squared <= 1e-12 * x.length_squared() || !length_squared.is_finite() {
            return Self::from_z(z);
        }
        let x = tangent / length_squared.sqrt();
        Self { x, y: z.cross(x), z }
    }

    /// World coordinates of a vector given in this frame.
    #[inline]
    #[must_use]
    pub fn to_world(self, v: Vector3) -> Vector3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }

    /// Coordinates in this frame of a vector given in the world.
    #[inline]
    #[must_use]
    pub fn to_local(self, v: Vector3) -> Vector3 {
        Vector3::new(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }
}
