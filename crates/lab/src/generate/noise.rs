//! Random functions for generated scenes.

use etendue_math::hash64;

/// Noise in [0, 1): random numbers at the points of the integer lattice, blended smoothly between.
pub(super) fn value_noise(p: [f32; 2], seed: u32) -> f32 {
    let [x, y] = p.map(f32::floor);
    let smooth = |t: f32| t * t * (3.0 - 2.0 * t);
    let (tx, ty) = (smooth(p[0] - x), smooth(p[1] - y));
    let at = |i: f32, j: f32| lattice([x + i, y + j], seed);
    let row = |j: f32| at(0.0, j) + tx * (at(1.0, j) - at(0.0, j));
    row(0.0) + ty * (row(1.0) - row(0.0))
}

/// The random number of a point of the lattice.
fn lattice([x, y]: [f32; 2], seed: u32) -> f32 {
    let word = |v: f32| v as i64 as u64;
    (hash64(&[word(x), word(y), u64::from(seed)]) >> 40) as f32 / (1_u64 << 24) as f32
}

/// Octaves of [`value_noise`], each of twice the frequency and half the height; about 0, within (-1, 1).
pub(super) fn fractal_noise(p: [f32; 2], n_octaves: u32, seed: u32) -> f32 {
    let octave = |k: u32| {
        let scale = (1 << k) as f32;
        (value_noise(p.map(|x| x * scale), seed.wrapping_add(k)) - 0.5) / scale
    };
    (0..n_octaves).map(octave).sum()
}

/// Heights of a fractal surface over `2^n_levels + 1` by as many points, row by row: the midpoints of squares, then
/// those of their sides, are moved by Gaussian-like random numbers whose deviation falls by `2^-hurst` from level to level
/// (Fournier, Fussell and Carpenter 1982). It begins with 1 at the first level; the border stays 0, so that copies join.
pub(super) fn midpoint_heights(n_levels: u32, hurst: f32, seed: u32) -> Vec<f32> {
    let n = (1_usize << n_levels) + 1;
    let mut heights = vec![0.0_f32; n * n];
    let mut deviation = 1.0;
    let mut step = n - 1;
    while step > 1 {
        let half = step / 2;
        let random = |row: usize, column: usize| {
            // The sum of four uniform numbers, of variance 1.
            let uniform = |k: f32| lattice([row as f32, column as f32 + k * 1e6], seed) - 0.5;
            3.0_f32.sqrt() * (0..4).map(|k| uniform(k as f32)).sum::<f32>()
        };
        for row in (half..n).step_by(step) {
            for column in (half..n).step_by(step) {
                let corner =
                    |i: usize, j: usize| heights[(row - half + i * step) * n + column - half + j * step];
                let mean = 0.25 * (corner(0, 0) + corner(0, 1) + corner(1, 0) + corner(1, 1));
                heights[row * n + column] = mean + deviation * random(row, column);
            }
        }
        let sides = deviation * 0.5_f32.powf(0.5 * hurst);
        for row in (half..n - half).step_by(half) {
            let first = if (row / half) % 2 == 0 { half } else { step };
            for column in (first..n - half).step_by(step) {
                let at = |row: usize, column: usize| heights[row * n + column];
                let mean = 0.25
                    * (at(row - half, column)
                        + at(row + half, column)
                        + at(row, column - half)
                        + at(row, column + half));
                heights[row * n + column] = mean + sides * random(row, column);
            }
        }
        deviation *= 0.5_f32.powf(hurst);
        step = half;
    }
    heights
}
