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
