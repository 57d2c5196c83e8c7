//! The texture `imagemap`: a picture laid onto a surface.

use etendue_spectrum::{Sampled, SpectrumTables, Wavelengths};

use crate::parameters::{ParameterSpec, SpectrumRole};

use super::image_map::ImageMap;
use super::uplift::Uplift;
use super::{Mapping2, TextureContext};

/// Index of a picture in the arena of [`Textures`](super::Textures).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ImageId(pub u32);

/// A picture on a surface; numbers come from the first channel that is looked up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageTexture {
    /// Texture coordinates.
    pub mapping: Mapping2,
    /// The picture.
    pub image: ImageId,
    /// Factors of its red, green and blue; of numbers, the first.
    pub scale: [f32; 3],
    /// Yields `1 - value` after scaling.
    pub invert: bool,
    /// Numbers become 1 from here on and 0 below, as the last step.
    pub cutoff: Option<f32>,
}

impl ImageTexture {
    /// The number at a point.
    #[must_use]
    pub fn eval_float(&self, image: &ImageMap, ctx: &TextureContext) -> f32 {
        let [value] = image.lookup::<1>(&self.mapping.map(ctx));
        self.number(value)
    }

    /// What becomes of a number of the picture.
    #[must_use]
    pub fn number(&self, value: f32) -> f32 {
        let value = self.scale[0] * value;
        let value = if self.invert { (1.0 - value).max(0.0) } else { value };
        match self.cutoff {
            Some(cutoff) => f32::from(u8::from(value >= cutoff)),
            None => value,
        }
    }

    /// The linear colour at a point, in the primaries of the picture, not negative.
    #[must_use]
    pub fn eval_rgb(&self, image: &ImageMap, ctx: &TextureContext) -> [f32; 3] {
        let [r, g, b] = image.lookup::<3>(&self.mapping.map(ctx));
        let rgb = [self.scale[0] * r, self.scale[1] * g, self.scale[2] * b];
        rgb.map(|c| if self.invert { (1.0 - c).max(0.0) } else { c.max(0.0) })
    }
}

/// A picture that yields spectra.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectrumImageTexture {
    /// The picture.
    pub texture: ImageTexture,
    /// How its colours become spectra.
    pub uplift: Uplift,
}

impl SpectrumImageTexture {
    /// The spectrum at a point.
    #[must_use]
    pub fn eval(
        &self,
        image: &ImageMap,
        tables: &SpectrumTables,
        ctx: &TextureContext,
        lambda: &Wavelengths,
    ) -> Sampled {
        self.uplift.sample(self.texture.eval_rgb(image, ctx), tables, lambda)
    }

    /// How its colours are read.
    #[must_use]
    pub const fn role(&self) -> SpectrumRole {
        self.uplift.role
    }
}

/// Parameters of the texture `imagemap`, besides those of its mapping.
pub(super) const PARAMETERS: &[ParameterSpec] = &[
    ParameterSpec { name: "filename", kind: "string", default: "", unit: "", doc: "the picture" },
    ParameterSpec {
        name: "filter",
        kind: "string",
        default: "bilinear",
        unit: "",
        doc: "point, bilinear, trilinear or EWA (elliptically weighted average)",
    },
    ParameterSpec {
        name: "wrap",
        kind: "string",
        default: "repeat",
        unit: "",
        doc: "beyond the borders: repeat, black, clamp, mirror or octahedralsphere",
    },
    ParameterSpec {
        name: "wrapv",
        kind: "string",
        default: "wrap",
        unit: "",
        doc: "the same beyond the upper and lower border alone",
    },
    ParameterSpec {
        name: "channel",
        kind: "string",
        default: "",
        unit: "",
        doc: "one channel of the picture: r, g, b or a, which is 1 where there is none; numbers: r by default",
    },
    ParameterSpec {
        name: "maxanisotropy",
        kind: "float",
        default: "8",
        unit: "",
        doc: "EWA: largest ratio of the axes of the footprint",
    },
    ParameterSpec { name: "scale", kind: "float", default: "1", unit: "", doc: "factor of all values" },
    ParameterSpec {
        name: "tint",
        kind: "rgb",
        default: "1 1 1",
        unit: "",
        doc: "factors of red, green, blue",
    },
    ParameterSpec {
        name: "cutoff",
        kind: "float",
        default: "",
        unit: "",
        doc: "numbers: 1 where the value is at least this, else 0",
    },
    ParameterSpec { name: "invert", kind: "bool", default: "false", unit: "", doc: "yield 1 - value" },
    ParameterSpec {
        name: "encoding",
        kind: "string",
        default: "sRGB",
        unit: "",
        doc: "of integer pictures: sRGB, linear or gamma followed by the exponent",
    },
];
