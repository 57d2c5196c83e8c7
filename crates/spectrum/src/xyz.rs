//! CIE XYZ colour and chromatic adaptation.

use crate::matrix::{Matrix3, invert, multiply, transform};

/// A colour as tristimulus values of the CIE 1931 2° observer; y is the luminance.
#[derive(Copy, Clone, Debug, PartialEq, Default)]
pub struct Xyz {
    /// X.
    pub x: f32,
    /// Y, the luminance.
    pub y: f32,
    /// Z.
    pub z: f32,
}

impl Xyz {
    /// From its components.
    #[inline]
    #[must_use]
    pub const fn new(x: f32, y: f32, z: f32) -> Self {
        Self { x, y, z }
    }

    /// The components.
    #[inline]
    #[must_use]
    pub const fn to_array(self) -> [f32; 3] {
        [self.x, self.y, self.z]
    }

    /// Chromaticity (x, y) = (X, Y) / (X + Y + Z); 0 for black.
    #[must_use]
    pub fn chromaticity(self) -> [f32; 2] {
        let sum = self.x + self.y + self.z;
        if sum == 0.0 {
            return [0.0; 2];
        }
        [self.x / sum, self.y / sum]
    }

    /// The colour of a chromaticity and a luminance.
    #[must_use]
    pub fn from_chromaticity(xy: [f32; 2], luminance: f32) -> Self {
        let [x, y, z] = xyz_of([f64::from(xy[0]), f64::from(xy[1])], f64::from(luminance));
        Self::new(x as f32, y as f32, z as f32)
    }
}

impl From<[f32; 3]> for Xyz {
    fn from([x, y, z]: [f32; 3]) -> Self {
        Self { x, y, z }
    }
}

/// XYZ of a chromaticity and a luminance.
pub(crate) fn xyz_of([x, y]: [f64; 2], luminance: f64) -> [f64; 3] {
    if y == 0.0 {
        return [0.0; 3];
    }
    [x * luminance / y, luminance, (1.0 - x - y) * luminance / y]
}

/// Cone responses of XYZ in the Bradford model (Lam 1985).
const BRADFORD: Matrix3 = [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]];

/// The matrix on XYZ that maps one white (chromaticity) to another by scaling cone responses (von Kries), keeping Y of
/// the white.
#[must_use]
pub fn white_balance(source_xy: [f32; 2], target_xy: [f32; 2]) -> [[f32; 3]; 3] {
    white_balance_f64(source_xy.map(f64::from), target_xy.map(f64::from)).map(|r| r.map(|v| v as f32))
}

/// [`white_balance`] in double precision.
pub(crate) fn white_balance_f64(source_xy: [f64; 2], target_xy: [f64; 2]) -> Matrix3 {
    let source = transform(&BRADFORD, xyz_of(source_xy, 1.0));
    let target = transform(&BRADFORD, xyz_of(target_xy, 1.0));
    let mut scaled = BRADFORD;
    for (i, row) in scaled.iter_mut().enumerate() {
        *row = row.map(|v| v * target[i] / source[i]);
    }
    multiply(&invert(&BRADFORD), &scaled)
}
