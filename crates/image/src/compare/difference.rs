//! Pictures of differences: one number per pixel, shown in false colours.

use crate::{Image, luminance, srgb_decode};

/// What a difference map holds, on the luminances a (test) and b (reference) of each pixel.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum DifferenceKind {
    /// `a - b`, shown blue where the test is darker and red where it is brighter.
    Signed,
    /// `|a - b|`.
    Absolute,
    /// `(a - b)^2 / (b^2 + 0.01)`.
    RelativeSquared,
    /// FLIP's error, in [0, 1].
    Flip {
        /// Pixels per degree of visual angle.
        pixels_per_degree: f32,
        /// Exposure of both images in stops.
        exposure_ev: f32,
    },
    /// HDR-FLIP's error, in [0, 1].
    HdrFlip {
        /// Pixels per degree of visual angle.
        pixels_per_degree: f32,
    },
}

impl DifferenceKind {
    /// The difference of one pixel; FLIP needs the neighbourhood and is computed for the whole image.
    pub(super) fn of_pixel(self, test: [f32; 3], reference: [f32; 3]) -> f32 {
        let (a, b) = (luminance(test), luminance(reference));
        match self {
            DifferenceKind::Signed => a - b,
            DifferenceKind::Absolute | DifferenceKind::Flip { .. } | DifferenceKind::HdrFlip { .. } => {
                (a - b).abs()
            }
            DifferenceKind::RelativeSquared => (a - b) * (a - b) / (b * b + super::RELATIVE_OFFSET as f32),
        }
    }
}

/// One number per pixel, masked pixels 0.
#[derive(Clone, Debug, PartialEq)]
pub struct DifferenceMap {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// What the values are.
    pub kind: DifferenceKind,
    /// Row-major values, top row first.
    pub values: Vec<f32>,
}

impl DifferenceMap {
    /// Largest absolute value.
    pub fn max(&self) -> f32 {
        self.values.iter().fold(0.0, |max, value| max.max(value.abs()))
    }

    /// The values as they are in a channel `Y`.
    pub fn to_image(&self) -> Image {
        Image::gray(self.width, self.height, self.values.clone())
    }

    /// False colours in linear light, where `full_scale` gets the end of the colour ramp.
    ///
    /// # Panics
    /// When `full_scale` is not positive.
    pub fn to_false_colors(&self, full_scale: f32) -> Image {
        assert!(full_scale > 0.0, "a colour ramp has a positive end");
        let ramp: &[[f32; 3]] = if self.kind == DifferenceKind::Signed { &SIGNED_RAMP } else { &HEAT_RAMP };
        let color = |&value: &f32| {
            let unit = value / full_scale;
            let unit = if self.kind == DifferenceKind::Signed { 0.5 + 0.5 * unit } else { unit };
            ramp_color(ramp, unit)
        };
        Image::rgb(self.width, self.height, self.values.iter().map(color).collect())
    }
}

/// Black, violet, red, orange, pale yellow in sRGB values: lightness rises evenly.
pub(crate) const HEAT_RAMP: [[f32; 3]; 5] =
    [[0.0, 0.0, 0.02], [0.32, 0.07, 0.48], [0.72, 0.21, 0.47], [0.98, 0.53, 0.38], [0.99, 0.99, 0.75]];
/// Blue, white, red in sRGB values.
const SIGNED_RAMP: [[f32; 3]; 5] =
    [[0.02, 0.19, 0.38], [0.26, 0.58, 0.76], [0.97, 0.97, 0.97], [0.84, 0.38, 0.3], [0.4, 0.0, 0.12]];

/// Linear light at a place of a ramp of sRGB values.
pub(crate) fn ramp_color(ramp: &[[f32; 3]], unit: f32) -> [f32; 3] {
    let place = unit.clamp(0.0, 1.0) * (ramp.len() - 1) as f32;
    let index = (place as usize).min(ramp.len() - 2);
    let t = place - index as f32;
    std::array::from_fn(|c| srgb_decode((1.0 - t) * ramp[index][c] + t * ramp[index + 1][c]))
}
