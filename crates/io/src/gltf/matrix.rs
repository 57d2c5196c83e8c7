//! Affine maps of nodes in double precision, so that deep hierarchies lose nothing; they may be singular.

use etendue_math::{Normal3, Point3, Transform, Vector3};

/// Rows of an affine map, without the last one, which is `0 0 0 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Matrix([[f64; 4]; 3]);

impl Matrix {
    pub(super) const IDENTITY: Self =
        Self([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]);

    /// From columns, as glTF stores matrices.
    pub(super) fn from_columns(m: &[f32; 16]) -> Self {
        Self(std::array::from_fn(|row| std::array::from_fn(|column| f64::from(m[4 * column + row]))))
    }

    /// Scaling, then rotation by a quaternion `x y z w` of any length but 0, then translation.
    pub(super) fn from_parts(translation: [f32; 3], rotation: [f32; 4], scale: [f32; 3]) -> Self {
        let [x, y, z, w] = rotation.map(f64::from);
        let square = x * x + y * y + z * z + w * w;
        let k = if square > 0.0 { 2.0 / square } else { 0.0 };
        let turn = [
            [1.0 - k * (y * y + z * z), k * (x * y - z * w), k * (x * z + y * w)],
            [k * (x * y + z * w), 1.0 - k * (x * x + z * z), k * (y * z - x * w)],
            [k * (x * z - y * w), k * (y * z + x * w), 1.0 - k * (x * x + y * y)],
        ];
        Self(std::array::from_fn(|row| {
            let [a, b, c] = std::array::from_fn(|column| turn[row][column] * f64::from(scale[column]));
            [a, b, c, f64::from(translation[row])]
        }))
    }

    /// First `other`, then this.
    pub(super) fn times(&self, other: &Self) -> Self {
        let Self(b) = other;
        Self(self.0.map(|row| {
            std::array::from_fn(|column| {
                let sum: f64 = (0..3).map(|k| row[k] * b[k][column]).sum();
                if column == 3 { sum + row[3] } else { sum }
            })
        }))
    }

    /// The sum of maps with weights.
    pub(super) fn add_scaled(&mut self, other: &Self, weight: f64) {
        for (sum, term) in self.0.iter_mut().flatten().zip(other.0.iter().flatten()) {
            *sum += weight * term;
        }
    }

    pub(super) const ZERO: Self = Self([[0.0; 4]; 3]);

    pub(super) fn point(&self, p: Point3) -> Point3 {
        let [x, y, z] = self.linear([p.x, p.y, p.z].map(f64::from));
        let [tx, ty, tz] = self.0.map(|row| row[3]);
        Point3::new((x + tx) as f32, (y + ty) as f32, (z + tz) as f32)
    }

    pub(super) fn vector(&self, v: Vector3) -> Vector3 {
        let [x, y, z] = self.linear([v.x, v.y, v.z].map(f64::from));
        Vector3::new(x as f32, y as f32, z as f32)
    }

    /// A normal, by the matrix of cofactors, which is the inverse transpose but for its scale.
    pub(super) fn normal(&self, n: Normal3) -> Normal3 {
        let column = |i: usize| self.0.map(|row| row[i]);
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let (a, b, c) = (column(0), column(1), column(2));
        let (x, y, z) = (cross(b, c), cross(c, a), cross(a, b));
        let determinant: f64 = (0..3).map(|i| a[i] * x[i]).sum();
        let [nx, ny, nz] = [n.x, n.y, n.z].map(f64::from);
        let sum: [f64; 3] = std::array::from_fn(|i| x[i] * nx + y[i] * ny + z[i] * nz);
        let length = sum.iter().map(|s| s * s).sum::<f64>().sqrt().copysign(determinant);
        let [x, y, z] = if length == 0.0 { [nx, ny, nz] } else { sum.map(|s| s / length) };
        Normal3::new(x as f32, y as f32, z as f32)
    }

    fn linear(&self, v: [f64; 3]) -> [f64; 3] {
        self.0.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
    }

    /// The same without scaling: the columns orthogonal and of length 1, as cameras and lights need it. `None` if it is
    /// singular.
    pub(super) fn rigid(&self) -> Option<Self> {
        let column = |i: usize| {
            let [x, y, z] = self.0.map(|row| row[i] as f32);
            Vector3::new(x, y, z)
        };
        let z = column(2).try_normalized()?;
        let y = (column(1) - z * column(1).dot(z)).try_normalized()?;
        let x = y.cross(z);
        let t = self.0.map(|row| row[3]);
        let row = |x: f32, y: f32, z: f32, t: f64| [f64::from(x), f64::from(y), f64::from(z), t];
        Some(Self([row(x.x, y.x, z.x, t[0]), row(x.y, y.y, z.y, t[1]), row(x.z, y.z, z.z, t[2])]))
    }

    /// For the scene; `None` if it is singular or beyond single precision.
    pub(super) fn transform(&self) -> Option<Transform> {
        let [a, b, c] = self.0.map(|row| row.map(|value| value as f32));
        let all_finite = a.iter().chain(&b).chain(&c).all(|value| value.is_finite());
        all_finite.then(|| Transform::from_rows([a, b, c, [0.0, 0.0, 0.0, 1.0]])).flatten()
    }
}
