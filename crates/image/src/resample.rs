//! Smaller images by averaging.

use crate::{Channel, Image};

/// Averages blocks of `factor` by `factor` pixels of every channel; blocks at the right and lower edge average the
/// pixels that they have. A box filter keeps the mean exactly where `factor` divides the size, which makes it
/// the right one for comparing noisy images.
///
/// # Panics
/// When `factor` is zero.
pub fn box_downsample(image: &Image, factor: usize) -> Image {
    assert!(factor > 0, "the factor of a downsampling is at least 1");
    let mut small = Image::new(image.width.div_ceil(factor), image.height.div_ceil(factor));
    small.metadata = image.metadata.clone();
    for channel in &image.channels {
        let values = downsample_plane(&channel.values, [image.width, image.height], factor);
        small.channels.push(Channel { name: channel.name.clone(), values });
    }
    small
}

/// Averages the blocks of one plane.
fn downsample_plane(values: &[f32], [width, height]: [usize; 2], factor: usize) -> Vec<f32> {
    let mut small = Vec::with_capacity(width.div_ceil(factor) * height.div_ceil(factor));
    for top in (0..height).step_by(factor) {
        let bottom = (top + factor).min(height);
        for left in (0..width).step_by(factor) {
            let right = (left + factor).min(width);
            let rows = (top..bottom).map(|y| &values[y * width + left..y * width + right]);
            let sum: f64 = rows.flatten().map(|&value| f64::from(value)).sum();
            small.push((sum / ((bottom - top) * (right - left)) as f64) as f32);
        }
    }
    small
}
