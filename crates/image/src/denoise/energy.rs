//! Light that filtering lost. Weights by likeness leave out what is much brighter than its surroundings, and rare bright samples
//! are where much of the light is: without amends noisy pictures grow darker.

use rayon::prelude::*;

use crate::plane::Plane;

use super::input::Input;

/// Over how many pixels the light of the noisy and of the clean picture is compared: its noise falls below 1/57 of a pixel's.
const SIGMA: f32 = 16.0;

/// Over how many pixels the variance is averaged that tells whether a pixel is noisy.
const NOISE_SIGMA: f32 = 3.0;

/// Relative standard error at which half of the full share is given: what is sure changes by nothing.
const SURE: f32 = 0.02;

/// Most that is given or taken, as a share of what is there.
const MOST: f32 = 0.5;

/// Gives what each pixel lost to the noisy pixels around it, in proportion to their colour: with weights
/// `w = y v / (v + (0.02 y)^2)` of the clean value y of variance v, a pixel gains `w blur((noisy - clean) / blur(w))`. Since
/// blurring is symmetric, all gains together are all losses.
pub(super) fn give_back(input: &Input, pixels: &mut [[f32; 3]]) {
    let [width, height] = input.size;
    let plane = |value: &(dyn Fn(usize) -> f32 + Sync)| {
        Plane::new(width, height, (0..width * height).into_par_iter().map(value).collect())
    };
    for c in 0..3 {
        let [a, b] = [&input.halves[0][c].values, &input.halves[1][c].values];
        let variance = input.variance[c].blurred(NOISE_SIGMA);
        let weights = plane(&|i| {
            let (y, v) = (pixels[i][c].max(0.0), variance.values[i]);
            if v > 0.0 { y * v / (v + (SURE * y).powi(2)) } else { 0.0 }
        });
        let base = spread(&weights);
        let lost = plane(&|i| {
            let lost = 0.5 * (a[i] + b[i]) - pixels[i][c];
            if base.values[i] > 0.0 { lost / base.values[i] } else { 0.0 }
        });
        let share = spread(&lost);
        pixels.par_iter_mut().enumerate().for_each(|(i, pixel)| {
            pixel[c] += weights.values[i] * share.values[i].clamp(-MOST, MOST);
        });
    }
}

/// Blurred as if all were 0 beyond the border, which makes the blur symmetric.
fn spread(plane: &Plane) -> Plane {
    let border = (3.0 * SIGMA) as usize;
    let (width, height) = (plane.width, plane.height);
    let inside = |y: usize| (border..border + height).contains(&y).then(|| plane.row(y - border));
    let wide = Plane::from_rows(width + 2 * border, height + 2 * border, |y, row| {
        inside(y).into_iter().for_each(|source| row[border..border + width].copy_from_slice(source));
    });
    let blurred = wide.blurred(SIGMA);
    Plane::from_rows(width, height, |y, row| {
        row.copy_from_slice(&blurred.row(y + border)[border..border + width])
    })
}
