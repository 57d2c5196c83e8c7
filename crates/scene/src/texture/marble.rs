//! Layers of marble along y, bent by noise (after Perlin 1985): a cubic spline of colours at `(1 + sin(y + v fbm)) / 2`.

use etendue_math::{Point3, lerp};

use crate::parameters::ParameterSpec;

use super::noise::Octaves;
use super::{Mapping3, TextureContext};

/// Marble.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marble {
    /// Placement.
    pub mapping: Mapping3,
    /// Octaves of the noise that bends the layers.
    pub octaves: Octaves,
    /// Factor of the position.
    pub scale: f32,
    /// Strength of the bending.
    pub variation: f32,
}

/// Control points of the colour spline, sRGB reflectances before a factor of 1.5.
const COLORS: [[f32; 3]; 9] = [
    [0.58, 0.58, 0.6],
    [0.58, 0.58, 0.6],
    [0.58, 0.58, 0.6],
    [0.5, 0.5, 0.5],
    [0.6, 0.59, 0.58],
    [0.58, 0.58, 0.6],
    [0.58, 0.58, 0.6],
    [0.2, 0.2, 0.33],
    [0.58, 0.58, 0.6],
];

impl Marble {
    /// The reflectance at a point, linear sRGB.
    #[must_use]
    pub fn rgb(&self, ctx: &TextureContext) -> [f32; 3] {
        const N_SEGMENTS: usize = COLORS.len() - 3;
        const GAIN: f32 = 1.5;
        let c = self.mapping.map(ctx);
        let p = Point3::new(self.scale * c.p.x, self.scale * c.p.y, self.scale * c.p.z);
        let bend = self.octaves.fbm(p, c.dpdx * self.scale, c.dpdy * self.scale);
        let t = (0.5 + 0.5 * (p.y + self.variation * bend).sin()) * N_SEGMENTS as f32;
        let first = (t.floor() as usize).min(N_SEGMENTS - 1);
        let t = t - first as f32;
        std::array::from_fn(|channel| {
            // De Casteljau's scheme.
            let [a, b, c, d] = std::array::from_fn(|i| COLORS[first + i][channel]);
            let (ab, bc, cd) = (lerp(t, a, b), lerp(t, b, c), lerp(t, c, d));
            GAIN * lerp(t, lerp(t, ab, bc), lerp(t, bc, cd))
        })
    }
}

/// Parameters of the texture `marble`.
pub(super) const PARAMETERS: &[ParameterSpec] = &[
    ParameterSpec {
        name: "octaves",
        kind: "integer",
        default: "8",
        unit: "",
        doc: "number of octaves of noise",
    },
    ParameterSpec {
        name: "roughness",
        kind: "float",
        default: "0.5",
        unit: "",
        doc: "factor of the amplitude from one octave to the next finer one",
    },
    ParameterSpec { name: "scale", kind: "float", default: "1", unit: "", doc: "factor of the position" },
    ParameterSpec {
        name: "variation",
        kind: "float",
        default: "0.2",
        unit: "",
        doc: "strength of the bending",
    },
];
