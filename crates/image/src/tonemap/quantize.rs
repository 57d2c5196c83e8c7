//! From linear light to bytes (SPEC TONE-12).

use crate::{Encoding, Image};

/// How linear light becomes bytes.
#[derive(Copy, Clone, Debug, PartialEq, Default)]
pub struct Quantization {
    /// Transfer function, sRGB unless told otherwise.
    pub encoding: Encoding,
    /// What hides the steps between bytes.
    pub dither: Dither,
}

/// Where between two bytes a value is rounded up.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Default)]
pub enum Dither {
    /// At one half: plain rounding.
    #[default]
    None,
    /// At the threshold of an 8 by 8 Bayer matrix.
    Ordered,
    /// At a threshold hashed from the pixel, the channel and this seed.
    Hashed(u64),
}

/// Bytes of the picture of an image: RGB clipped to [0, 1], encoded and rounded, row-major. `None` for an image
/// without colour. NaN becomes 0.
pub fn to_u8(image: &Image, quantization: Quantization) -> Option<Vec<[u8; 3]>> {
    let pixels = image.rgb_pixels()?;
    let quantize = |(index, pixel): (usize, [f32; 3])| {
        let position = [index % image.width, index / image.width];
        std::array::from_fn(|channel| quantize_value(pixel[channel], position, channel, quantization))
    };
    Some(pixels.into_iter().enumerate().map(quantize).collect())
}

/// The byte of one linear value.
fn quantize_value(value: f32, position: [usize; 2], channel: usize, quantization: Quantization) -> u8 {
    if value.is_nan() {
        return 0;
    }
    let stored = quantization.encoding.encode(value.clamp(0.0, 1.0));
    let offset = quantization.dither.offset(position, channel);
    // Casts from float to integer saturate, so the brightest value plus its offset stays 255.
    (stored * 255.0 + offset).floor() as u8
}

impl Dither {
    /// Added before rounding down, inside (0, 1) and away from both ends by more than the rounding of a byte value
    /// that is exact already.
    fn offset(self, [x, y]: [usize; 2], channel: usize) -> f32 {
        match self {
            Dither::None => 0.5,
            Dither::Ordered => (bayer_8x8(x, y) as f32 + 0.5) / 64.0,
            Dither::Hashed(seed) => {
                let position = (x as u64) | ((y as u64) << 28) | ((channel as u64) << 56);
                let hash = mix(mix(seed ^ 0x9e37_79b9_7f4a_7c15).wrapping_add(position));
                0.001 + 0.998 * ((hash >> 40) as f32 / (1u32 << 24) as f32)
            }
        }
    }
}

/// Entry 0..64 of the recursive Bayer matrix: the interleaved bits of x ^ y and y, reversed.
fn bayer_8x8(x: usize, y: usize) -> usize {
    (0..3).fold(0, |entry, bit| {
        let (x, y) = ((x >> bit) & 1, (y >> bit) & 1);
        entry | (((x ^ y) << 1 | y) << (2 * (2 - bit)))
    })
}

/// A bijection of 64-bit words that spreads every input bit over all output bits (Steele et al. 2014, `SplitMix`).
fn mix(mut word: u64) -> u64 {
    word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The Bayer matrix holds each threshold once.
    #[test]
    fn bayer_is_a_permutation() {
        let mut entries: Vec<usize> = (0..64).map(|i| bayer_8x8(i % 8, i / 8)).collect();
        assert_eq!(entries[..2], [0, 32]);
        entries.sort_unstable();
        assert!(entries.iter().copied().eq(0..64));
    }
}
