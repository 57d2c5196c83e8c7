//! A plane of numbers, and what local operators ask of it: blurs, halving, doubling.

use rayon::prelude::*;

/// Rows of numbers, the top one first.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Plane {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) values: Vec<f32>,
}

impl Plane {
    pub(crate) fn new(width: usize, height: usize, values: Vec<f32>) -> Self {
        debug_assert_eq!(values.len(), width * height);
        Self { width, height, values }
    }

    pub(crate) fn zeros(width: usize, height: usize) -> Self {
        Self::new(width, height, vec![0.0; width * height])
    }

    pub(crate) fn row(&self, y: usize) -> &[f32] {
        &self.values[y * self.width..(y + 1) * self.width]
    }

    #[cfg(test)]
    pub(crate) fn at(&self, x: usize, y: usize) -> f32 {
        self.values[y * self.width + x]
    }

    pub(crate) fn map(&self, f: impl Fn(f32) -> f32 + Sync) -> Self {
        Self::new(self.width, self.height, self.values.par_iter().map(|value| f(*value)).collect())
    }

    pub(crate) fn range(&self) -> (f32, f32) {
        let ends = (f32::INFINITY, f32::NEG_INFINITY);
        self.values.iter().fold(ends, |(low, high), value| (low.min(*value), high.max(*value)))
    }

    /// A number for each pair of two planes of one size.
    pub(crate) fn zip(&self, other: &Self, f: impl Fn(f32, f32) -> f32 + Sync) -> Self {
        let values = self.values.par_iter().zip(&other.values).map(|(a, b)| f(*a, *b)).collect();
        Self::new(self.width, self.height, values)
    }

    /// Each row made from its index, in parallel.
    pub(crate) fn from_rows(width: usize, height: usize, fill: impl Fn(usize, &mut [f32]) + Sync) -> Self {
        let mut plane = Self::zeros(width, height);
        if width > 0 {
            plane.values.par_chunks_mut(width).enumerate().for_each(|(y, row)| fill(y, row));
        }
        plane
    }

    /// Convolution with a Gaussian of this standard deviation in pixels, cut at three of them; beyond the border the plane
    /// goes on as its border does.
    pub(crate) fn blurred(&self, sigma: f32) -> Self {
        let kernel = gaussian(sigma);
        self.blurred_along_columns(&kernel).blurred_along_rows(&kernel)
    }

    fn blurred_along_columns(&self, kernel: &[f32]) -> Self {
        let last = self.height.saturating_sub(1);
        Self::from_rows(self.width, self.height, |y, row| {
            for (k, weight) in kernel.iter().enumerate() {
                for source in [Some(y.saturating_sub(k)), (k > 0).then_some((y + k).min(last))] {
                    let Some(source) = source else { continue };
                    for (sum, value) in row.iter_mut().zip(self.row(source)) {
                        *sum += weight * value;
                    }
                }
            }
        })
    }

    fn blurred_along_rows(&self, kernel: &[f32]) -> Self {
        let radius = kernel.len() - 1;
        Self::from_rows(self.width, self.height, |y, row| {
            let source = self.row(y);
            let (first, last) = (source[0], source[source.len() - 1]);
            let mut padded = vec![first; radius];
            padded.extend_from_slice(source);
            padded.resize(source.len() + 2 * radius, last);
            for (k, weight) in kernel.iter().enumerate() {
                for shift in [Some(radius - k), (k > 0).then_some(radius + k)] {
                    let Some(shift) = shift else { continue };
                    for (sum, value) in row.iter_mut().zip(&padded[shift..]) {
                        *sum += weight * value;
                    }
                }
            }
        })
    }

    /// The largest value of the square that reaches so many pixels from each to all sides.
    pub(crate) fn largest_around(&self, reach: usize) -> Self {
        let last = self.height.saturating_sub(1);
        let of_columns = Self::from_rows(self.width, self.height, |y, row| {
            row.copy_from_slice(self.row(y));
            for source in y.saturating_sub(reach)..=(y + reach).min(last) {
                raise(row, self.row(source));
            }
        });
        Self::from_rows(self.width, self.height, |y, row| {
            let source = of_columns.row(y);
            row.copy_from_slice(source);
            for shift in 1..=reach.min(self.width - 1) {
                raise(row, &source[shift..]);
                raise(&mut row[shift..], source);
            }
        })
    }

    /// Half the size: each value is the mean of four, of fewer at odd borders.
    pub(crate) fn halved(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        Self::from_rows(width, height, |y, row| {
            let (a, b) = (self.row(2 * y), self.row((2 * y + 1).min(self.height - 1)));
            for (x, value) in row.iter_mut().enumerate() {
                let (left, right) = (2 * x, (2 * x + 1).min(self.width - 1));
                *value = 0.25 * (a[left] + a[right] + b[left] + b[right]);
            }
        })
    }

    /// Values between the middles of this plane's pixels, for a plane of about twice the size, bilinear.
    pub(crate) fn doubled(&self, width: usize, height: usize) -> Self {
        let place = |i: usize, n: usize| {
            let at = (i as f32 + 0.5) * 0.5 - 0.5;
            let low = at.max(0.0).floor() as usize;
            (low.min(n - 1), (low + 1).min(n - 1), (at - low as f32).max(0.0))
        };
        Self::from_rows(width, height, |y, row| {
            let (y0, y1, ty) = place(y, self.height);
            let (a, b) = (self.row(y0), self.row(y1));
            for (x, value) in row.iter_mut().enumerate() {
                let (x0, x1, tx) = place(x, self.width);
                let top = a[x0] + (a[x1] - a[x0]) * tx;
                let bottom = b[x0] + (b[x1] - b[x0]) * tx;
                *value = top + (bottom - top) * ty;
            }
        })
    }
}

/// Raises values to others that are larger, as far as both go.
fn raise(values: &mut [f32], others: &[f32]) {
    for (value, other) in values.iter_mut().zip(others) {
        *value = if other > value { *other } else { *value };
    }
}

/// Weights of a Gaussian at 0, 1, 2 ... pixels; with both sides they sum to 1.
fn gaussian(sigma: f32) -> Vec<f32> {
    let radius = (3.0 * sigma).ceil() as usize;
    let weight = |k: usize| (-0.5 * (k as f32 / sigma).powi(2)).exp();
    let mut kernel: Vec<f32> = if sigma > 0.0 { (0..=radius).map(weight).collect() } else { vec![1.0] };
    let sum = 2.0 * kernel.iter().sum::<f32>() - kernel[0];
    for weight in &mut kernel {
        *weight /= sum;
    }
    kernel
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spot(size: usize) -> Plane {
        let mut plane = Plane::zeros(size, size);
        plane.values[size / 2 * size + size / 2] = 1.0;
        plane
    }

    /// A blurred spot has the variance of the Gaussian, the same in all directions, and its sum stays.
    #[test]
    fn blurs_are_gaussian() {
        let blurred = spot(41).blurred(4.0);
        let sum: f32 = blurred.values.iter().sum();
        assert!((sum - 1.0).abs() < 1e-5);
        let offset = |i: usize| (i as f32 - 20.0).powi(2);
        let variance: f32 = (0..41)
            .flat_map(|y| (0..41).map(move |x| (x, y)))
            .map(|(x, y)| blurred.at(x, y) * offset(x))
            .sum();
        // Cut at three standard deviations a Gaussian has 97.3 % of its variance.
        assert!((variance / 16.0 - 0.973).abs() < 0.01, "{variance}");
        assert!((blurred.at(23, 20) - blurred.at(20, 17)).abs() < 1e-8);
        let flat = Plane::new(5, 3, vec![2.5; 15]);
        assert!(flat.blurred(2.0).values.iter().all(|value| (value - 2.5).abs() < 1e-6));
    }

    /// A spot becomes a square, cut by the borders; reaches beyond the plane are harmless.
    #[test]
    fn largest_values_spread() {
        let mut plane = Plane::new(7, 5, vec![-1.0; 35]);
        plane.values[7 + 2] = 3.0;
        let found = plane.largest_around(2);
        for (i, value) in found.values.iter().enumerate() {
            let (x, y) = (i % 7, i / 7);
            assert_eq!(*value, if x <= 4 && y <= 3 { 3.0 } else { -1.0 }, "{x}, {y}");
        }
        assert_eq!(plane.largest_around(0), plane);
        assert_eq!(plane.largest_around(100).values, [3.0; 35]);
    }

    #[test]
    fn planes_are_halved_and_doubled() {
        let ramp = Plane::from_rows(9, 6, |y, row| {
            row.iter_mut().enumerate().for_each(|(x, value)| *value = x as f32 + 10.0 * y as f32);
        });
        let half = ramp.halved();
        assert_eq!((half.width, half.height), (5, 3));
        assert_eq!(half.at(1, 1), 2.5 + 25.0);
        let back = half.doubled(9, 6);
        assert!((back.at(4, 3) - ramp.at(4, 3)).abs() < 1e-4, "{}", back.at(4, 3));
        let one = Plane::new(1, 1, vec![3.0]);
        assert_eq!(one.halved(), one);
        assert_eq!(one.doubled(2, 1).values, [3.0, 3.0]);
    }
}
