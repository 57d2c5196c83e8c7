//! Products and inverses of 3 × 3 matrices in double precision, rows first.

/// A matrix, rows first.
pub(crate) type Matrix3 = [[f64; 3]; 3];

/// Matrix times column vector.
pub(crate) fn transform(m: &Matrix3, v: [f64; 3]) -> [f64; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// Product of two matrices.
pub(crate) fn multiply(a: &Matrix3, b: &Matrix3) -> Matrix3 {
    a.map(|row| std::array::from_fn(|c| (0..3).map(|k| row[k] * b[k][c]).sum()))
}

/// Columns as rows.
pub(crate) fn transpose(m: &Matrix3) -> Matrix3 {
    std::array::from_fn(|r| std::array::from_fn(|c| m[c][r]))
}

/// Solution x of m x = v by Cramer's rule; `None` if the matrix is singular.
pub(crate) fn solve(m: &Matrix3, v: [f64; 3]) -> Option<[f64; 3]> {
    let columns = transpose(m);
    let det = triple(columns[0], columns[1], columns[2]);
    if det == 0.0 || !det.is_finite() {
        return None;
    }
    Some([
        triple(v, columns[1], columns[2]) / det,
        triple(columns[0], v, columns[2]) / det,
        triple(columns[0], columns[1], v) / det,
    ])
}

/// Inverse of a matrix known to be regular.
pub(crate) fn invert(m: &Matrix3) -> Matrix3 {
    let unit = |i: usize| std::array::from_fn(|k| f64::from(u8::from(k == i)));
    let column = |i| solve(m, unit(i)).expect("constant colour matrices are regular");
    transpose(&[column(0), column(1), column(2)])
}

/// The determinant of three columns.
fn triple(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}
