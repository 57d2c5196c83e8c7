//! A diffuse surface with up to three of Lafortune's lobes.

use etendue_spectrum::Wavelengths;

use super::LobeColors;
use crate::bsdf::Classic;
use crate::bsdf::classic::{Lafortune, LafortuneLobe};
use crate::material::{MaterialContext, limits, spec};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::Textures;

/// Parameters of `lafortune`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LafortuneMaterial {
    /// Of diffuse part and lobes.
    pub colors: LobeColors,
    /// The lobes; those not given are 0.
    pub lobes: [LafortuneLobe; 3],
    /// Greatest albedo of the lobes.
    pub gain: f32,
}

/// A highlight of albedo 1 along the normal: Lewis's with exponent 20.
const DEFAULT: [f32; 4] = [-1.0646, -1.0646, 1.0646, 20.0];

impl LafortuneMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        LobeColors::KD,
        ParameterSpec {
            name: "ks",
            kind: "spectrum texture",
            default: "0.2",
            unit: "",
            doc: "Multiplies all lobes, in [0, 1].",
        },
        ParameterSpec {
            name: "lobes",
            kind: "float[]",
            default: "-1.0646 -1.0646 1.0646 20",
            unit: "",
            doc: "Cx Cy Cz and exponent of each of one to three lobes.",
        },
        spec::DISPLACEMENT,
        spec::NORMAL_MAP,
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>) -> Self {
        let colors = LobeColors { kd: limits::albedo(p, "kd", 0.5), ks: limits::albedo(p, "ks", 0.2) };
        let lobes = Self::lobes(p);
        let gain = Lafortune::greatest_albedo(lobes);
        if gain > 1.01 {
            let span = p.span_of("lobes");
            let message =
                format!("\"lobes\" reflect {gain:.2} times what arrives; with \"ks\" they are scaled down");
            p.diagnostics().warning(span, message);
        }
        Self { colors, lobes, gain }
    }

    fn lobes(p: &mut Parameters<'_, '_>) -> [LafortuneLobe; 3] {
        let given = p.floats("lobes").unwrap_or(&DEFAULT);
        let is_sound = |lobe: &[f32]| {
            lobe.iter().all(|c| c.is_finite() && c.abs() <= 100.0) && (0.0..=1e6).contains(&lobe[3])
        };
        let numbers = if matches!(given.len(), 4 | 8 | 12) && given.chunks(4).all(is_sound) {
            given
        } else {
            let span = p.span_of("lobes");
            let message =
                "\"lobes\" are one to three groups of Cx Cy Cz exponent, with exponents from 0 to 1e6";
            p.diagnostics().error(span, message);
            &DEFAULT
        };
        let mut lobes = [LafortuneLobe::default(); 3];
        for (lobe, c) in lobes.iter_mut().zip(numbers.chunks_exact(4)) {
            *lobe = LafortuneLobe { cx: c[0], cy: c[1], cz: c[2], exponent: c[3] };
        }
        lobes
    }

    pub(super) fn bsdf(&self, textures: &Textures, ctx: &MaterialContext, lambda: &Wavelengths) -> Classic {
        let (kd, ks) = self.colors.with_gain(self.gain, textures, ctx, lambda);
        Classic::Lafortune(Lafortune { kd, ks, lobes: self.lobes })
    }

    pub(super) fn is_uniform(&self) -> bool {
        self.colors.is_constant() && self.lobes.iter().all(|lobe| lobe.cx == lobe.cy)
    }
}
