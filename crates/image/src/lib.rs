//! Pixels as data: what a renderer writes ([`Image`]), what it looks up ([`Texels`]), how it is shown
//! ([`tonemap`]) and how two results are told apart ([`compare`]).
//!
//! An [`Image`] holds named planes of `f32` as an EXR file does; a [`Texels`] store keeps a texture in the width
//! its file had. Both are row-major with the top row first. No file is opened here; `io` reads and writes.

mod buffer;
mod encoding;
mod texels;

pub use buffer::{Channel, Image};
pub use encoding::{DecodeTable, Encoding, srgb_decode, srgb_encode};
pub use texels::{Chromaticities, TexelData, Texels};
