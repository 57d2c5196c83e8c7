//! Textures in space that are sums of noise: `fbm` (clouds), `wrinkled` (creases), `windy` (waves in gusts).

use etendue_math::Point3;

use crate::parameters::ParameterSpec;

use super::noise::Octaves;
use super::{Mapping3, TextureContext};

/// Fractional Brownian motion: mean 0, amplitude about 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fbm {
    /// Placement.
    pub mapping: Mapping3,
    /// Octaves.
    pub octaves: Octaves,
}

impl Fbm {
    /// The value at a point.
    #[must_use]
    pub fn eval(&self, ctx: &TextureContext) -> f32 {
        let c = self.mapping.map(ctx);
        self.octaves.fbm(c.p, c.dpdx, c.dpdy)
    }
}

/// Turbulence: the sum of absolute values of noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrinkled {
    /// Placement.
    pub mapping: Mapping3,
    /// Octaves.
    pub octaves: Octaves,
}

impl Wrinkled {
    /// The value at a point.
    #[must_use]
    pub fn eval(&self, ctx: &TextureContext) -> f32 {
        let c = self.mapping.map(ctx);
        self.octaves.turbulence(c.p, c.dpdx, c.dpdy)
    }
}

/// Waves whose height follows a slowly varying wind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Windy {
    /// Placement.
    pub mapping: Mapping3,
}

impl Windy {
    /// The value at a point.
    #[must_use]
    pub fn eval(&self, ctx: &TextureContext) -> f32 {
        const WIND: Octaves = Octaves { omega: 0.5, count: 3 };
        const WAVES: Octaves = Octaves { omega: 0.5, count: 6 };
        const WIND_SCALE: f32 = 0.1;
        let c = self.mapping.map(ctx);
        let p = Point3::new(WIND_SCALE * c.p.x, WIND_SCALE * c.p.y, WIND_SCALE * c.p.z);
        let wind = WIND.fbm(p, c.dpdx * WIND_SCALE, c.dpdy * WIND_SCALE);
        wind.abs() * WAVES.fbm(c.p, c.dpdx, c.dpdy)
    }
}

/// Parameters of the textures `fbm` and `wrinkled`.
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
];

/// Parameters of the texture `windy`: none.
pub(super) const WINDY_PARAMETERS: &[ParameterSpec] = &[];
