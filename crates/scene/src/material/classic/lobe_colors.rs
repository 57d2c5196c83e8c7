//! What the diffuse part and the highlight of a surface reflect.

use etendue_spectrum::{Sampled, Spectrum, Wavelengths};

use crate::light::LightUnits;
use crate::light::emission::emitted;
use crate::material::{MaterialContext, limits};
use crate::parameters::{ParameterSpec, Parameters, SpectrumRole};
use crate::texture::{SpectrumTexture, Textures};

/// Albedo of the diffuse part and strength of the highlight. Where they sum to more than 1 both are scaled down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LobeColors {
    /// Diffuse.
    pub kd: SpectrumTexture,
    /// Highlight.
    pub ks: SpectrumTexture,
}

impl LobeColors {
    pub(super) const KD: ParameterSpec = ParameterSpec {
        name: "kd",
        kind: "spectrum texture",
        default: "0.5",
        unit: "",
        doc: "Albedo of the diffuse part, in [0, 1].",
    };
    pub(super) const KS: ParameterSpec = ParameterSpec {
        name: "ks",
        kind: "spectrum texture",
        default: "0.2",
        unit: "",
        doc: "Strength of the highlight, in [0, 1]; kd + ks may not exceed 1.",
    };

    pub(super) const AMBIENT: ParameterSpec = ParameterSpec {
        name: "ambient",
        kind: "spectrum",
        default: "0",
        unit: "cd/m^2",
        doc: "Ambient term k_a I_a: radiance that the eye sees whatever falls here; it lights nothing.",
    };

    /// The ambient term, in the unit of lights.
    pub(super) fn ambient(p: &mut Parameters<'_, '_>) -> Option<Spectrum> {
        let spectrum = p.spectrum("ambient", SpectrumRole::Illuminant)?;
        if limits::least(p, &spectrum) < 0.0 {
            let span = p.span_of("ambient");
            p.diagnostics()
                .warning(span, "an ambient term that is negative at some wavelength is taken as 0");
            return None;
        }
        Some(emitted(spectrum, 1.0, LightUnits::Photometric, &p.context.spectra))
    }

    pub(super) fn build(p: &mut Parameters<'_, '_>) -> Self {
        let (kd, ks) = (limits::albedo(p, "kd", 0.5), limits::albedo(p, "ks", 0.2));
        limits::sum_of_albedos(p, ["kd", "ks"], [kd, ks]);
        Self { kd, ks }
    }

    /// Both at a point.
    pub(super) fn at(
        &self,
        textures: &Textures,
        ctx: &MaterialContext,
        lambda: &Wavelengths,
    ) -> (Sampled, Sampled) {
        self.with_gain(1.0, textures, ctx, lambda)
    }

    /// Both at a point, for a highlight whose albedo is up to `gain` times its strength.
    pub(super) fn with_gain(
        &self,
        gain: f32,
        textures: &Textures,
        ctx: &MaterialContext,
        lambda: &Wavelengths,
    ) -> (Sampled, Sampled) {
        let value = |texture| textures.eval_spectrum(texture, &ctx.texture, lambda).clamp(0.0, 1.0);
        let (kd, ks) = (value(self.kd), value(self.ks));
        let excess = (kd + ks * gain).max(Sampled::ONE);
        (kd / excess, ks / excess)
    }

    pub(super) const fn is_constant(&self) -> bool {
        self.kd.constant().is_some() && self.ks.constant().is_some()
    }
}
