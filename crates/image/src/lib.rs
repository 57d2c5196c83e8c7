//! Pixels as data: what a renderer writes ([`Image`]), what it looks up ([`Texels`]), how it is shown
//! ([`tonemap`], [`falsecolor`]) and how two results are told apart ([`compare`]).
//!
//! An [`Image`] holds named planes of `f32` as an EXR file does; a [`Texels`] store keeps a texture in the width
//! its file had. Both are row-major with the top row first. No file is opened here; `io` reads and writes.

mod buffer;
pub mod compare;
pub mod denoise;
mod encoding;
pub mod exposures;
pub mod falsecolor;
mod plane;
mod resample;
mod texels;
pub mod tonemap;

pub use buffer::{Channel, Image};
pub use encoding::{DecodeTable, Encoding, pq_decode, pq_encode, srgb_decode, srgb_encode};
pub use resample::box_downsample;
pub use texels::{Chromaticities, TexelData, Texels};

#[cfg(test)]
mod tests;

/// Luminance of linear RGB with the weights of Rec. ITU-R BT.709, in the unit of the channels.
#[inline]
pub fn luminance([r, g, b]: [f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}
