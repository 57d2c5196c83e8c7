//! Textures: numbers and spectra that vary over surfaces.

mod handle;

pub use handle::{FloatTexture, FloatTextureId, SpectrumTexture, SpectrumTextureId, TextureContext};
