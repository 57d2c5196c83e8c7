//! How alike two pixels look: distances of patches, in units of their noise (Rousselle, Knaus and Zwicker 2012, equation 3).
//!
//! For pixels p and q of values u and variances v,
//!
//! `d(p, q) = ((u_p - u_q)^2 - (v_p + min(v_p, v_q))) / (epsilon + v_p + v_q)`,
//!
//! averaged over channels and over the pixels of the patches around p and q: 0 is expected of equal patches whatever their
//! noise. A weight is `exp(-max(0, d) / k^2)` at bandwidth k.

use crate::plane::Plane;

/// A rectangle of pixels; upper ends are exclusive.
#[derive(Clone, Debug)]
pub(super) struct Tile {
    pub(super) x: std::ops::Range<usize>,
    pub(super) y: std::ops::Range<usize>,
}

/// How far pixels are sought, and what is compared.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// Pixels to each side of a pixel that are compared with it.
    pub(super) window: usize,
    /// Pixels to each side that make a patch.
    pub(super) patch: usize,
}

impl Reach {
    /// Pixels in a window.
    pub(super) fn n_offsets(self) -> usize {
        (2 * self.window + 1).pow(2)
    }

    fn border(self) -> usize {
        self.window + self.patch
    }
}

/// Channels that are compared with their variances, with a border all around in which the outermost pixels go on.
#[derive(Debug)]
pub(super) struct Guide {
    reach: Reach,
    /// Size without the border.
    size: [usize; 2],
    channels: Vec<[Plane; 2]>,
    epsilon: f32,
}

/// Share of the mean square of the values below which differences of pixels without noise do not count.
const EPSILON: f64 = 1e-8;

impl Guide {
    /// Of values and variances, channel by channel.
    pub(super) fn new(values: &[Plane], variances: &[Plane], reach: Reach) -> Self {
        let squares = values.iter().flat_map(|plane| &plane.values).map(|v| f64::from(*v).powi(2));
        let n: usize = values.iter().map(|plane| plane.values.len()).sum();
        let epsilon = (EPSILON * squares.sum::<f64>() / n.max(1) as f64) as f32;
        let pad = |plane: &Plane| padded(plane, reach.border());
        let channels = values.iter().zip(variances).map(|(u, v)| [pad(u), pad(v)]).collect();
        let size = values.first().map_or([0, 0], |plane| [plane.width, plane.height]);
        Self { reach, size, channels, epsilon: epsilon.max(f32::MIN_POSITIVE) }
    }

    /// Distances of each pixel of a tile to those of its window: for each pixel, row by row, one number for each offset, row
    /// by row. Pixels beyond the picture are infinitely far.
    pub(super) fn distances(&self, tile: &Tile, distances: &mut Vec<f32>) {
        let Reach { window, patch } = self.reach;
        let n_offsets = self.reach.n_offsets();
        let (width, height) = (tile.x.len(), tile.y.len());
        distances.clear();
        distances.resize(width * height * n_offsets, f32::INFINITY);
        let mut scratch = Scratch::new(width, height, patch);
        let scale = 1.0 / (self.channels.len() * (2 * patch + 1).pow(2)).max(1) as f32;
        for offset in 0..n_offsets {
            let shift = [offset % (2 * window + 1), offset / (2 * window + 1)];
            self.compare(tile, shift, &mut scratch);
            scratch.sum_patches(patch);
            for y in 0..height {
                let y_inside = (tile.y.start + y + shift[1]).wrapping_sub(window) < self.size[1];
                if !y_inside {
                    continue;
                }
                for x in 0..width {
                    if (tile.x.start + x + shift[0]).wrapping_sub(window) < self.size[0] {
                        distances[(y * width + x) * n_offsets + offset] = scratch.sums[y * width + x] * scale;
                    }
                }
            }
        }
    }

    /// Distances of single pixels of the tile and its border to those at an offset, of which 0 is the far upper left.
    fn compare(&self, tile: &Tile, shift: [usize; 2], scratch: &mut Scratch) {
        let Reach { window, patch } = self.reach;
        let (width, height) = (tile.x.len() + 2 * patch, tile.y.len() + 2 * patch);
        for y in 0..height {
            let row = &mut scratch.pixels[y * width..(y + 1) * width];
            row.fill(0.0);
            let (x_p, y_p) = (tile.x.start + window, tile.y.start + window + y);
            let (x_q, y_q) = (tile.x.start + shift[0], tile.y.start + shift[1] + y);
            for [values, variances] in &self.channels {
                let (u_p, u_q) = (&values.row(y_p)[x_p..x_p + width], &values.row(y_q)[x_q..x_q + width]);
                let (v_p, v_q) =
                    (&variances.row(y_p)[x_p..x_p + width], &variances.row(y_q)[x_q..x_q + width]);
                for x in 0..width {
                    let difference = u_p[x] - u_q[x];
                    let noise = v_p[x] + if v_q[x] < v_p[x] { v_q[x] } else { v_p[x] };
                    row[x] += (difference * difference - noise) / (self.epsilon + v_p[x] + v_q[x]);
                }
            }
        }
    }
}

/// Memory of a tile.
struct Scratch {
    width: usize,
    height: usize,
    /// Of the tile with a border of a patch.
    pixels: Vec<f32>,
    /// Summed along rows.
    rows: Vec<f32>,
    /// Summed over patches, of the tile.
    sums: Vec<f32>,
}

impl Scratch {
    fn new(width: usize, height: usize, patch: usize) -> Self {
        let (border, zeros) = (2 * patch, |n: usize| vec![0.0; n]);
        Self {
            width,
            height,
            pixels: zeros((width + border) * (height + border)),
            rows: zeros(width * (height + border)),
            sums: zeros(width * height),
        }
    }

    fn sum_patches(&mut self, patch: usize) {
        let side = 2 * patch + 1;
        let wide = self.width + 2 * patch;
        for (row, source) in self.rows.chunks_exact_mut(self.width).zip(self.pixels.chunks_exact(wide)) {
            row.copy_from_slice(&source[..self.width]);
            for k in 1..side {
                row.iter_mut().zip(&source[k..]).for_each(|(sum, value)| *sum += value);
            }
        }
        for (y, row) in self.sums.chunks_exact_mut(self.width).enumerate().take(self.height) {
            row.copy_from_slice(&self.rows[y * self.width..(y + 1) * self.width]);
            for k in 1..side {
                let source = &self.rows[(y + k) * self.width..];
                row.iter_mut().zip(source).for_each(|(sum, value)| *sum += value);
            }
        }
    }
}

/// The weight of a distance at a bandwidth; none below a thousandth.
#[inline]
pub(super) fn weight(distance: f32, bandwidth: f32) -> f32 {
    let exponent = distance.max(0.0) / (bandwidth * bandwidth);
    if exponent < 6.9 { (-exponent).exp() } else { 0.0 }
}

/// Square tiles that cover a picture, in rows of tiles.
pub(super) fn tile_rows(width: usize, height: usize, side: usize) -> Vec<Vec<Tile>> {
    let spans = |n: usize| (0..n).step_by(side).map(move |start| start..(start + side).min(n));
    spans(height).map(|y| spans(width).map(|x| Tile { x, y: y.clone() }).collect()).collect()
}

/// A plane with a border in which its outermost pixels go on.
fn padded(plane: &Plane, border: usize) -> Plane {
    let [last_x, last_y] = [plane.width, plane.height].map(|n| n.saturating_sub(1));
    Plane::from_rows(plane.width + 2 * border, plane.height + 2 * border, |y, row| {
        let source = plane.row(y.saturating_sub(border).min(last_y));
        for (x, value) in row.iter_mut().enumerate() {
            *value = source[x.saturating_sub(border).min(last_x)];
        }
    })
}
