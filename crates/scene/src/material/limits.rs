//! Parameters that must lie in a range: what is outside is reported with its place and pulled in.
//!
//! Constants are looked at when the scene is built; textures are pulled in silently where they are evaluated.

use etendue_spectrum::{LAMBDA_MAX_NM, LAMBDA_MIN_NM, Spectrum};

use crate::parameters::{Parameters, SpectrumRole};
use crate::texture::{FloatTexture, SpectrumTexture};

/// Slack for sums of spectra made from colours.
const ROUNDING: f32 = 1e-3;

/// A reflectance in [0, 1]: negative ones are errors, larger ones warnings.
pub(super) fn albedo(p: &mut Parameters<'_, '_>, name: &'static str, default: f32) -> SpectrumTexture {
    let texture = p.spectrum_texture(name, Spectrum::Constant(default), SpectrumRole::Albedo);
    let Some(spectrum) = texture.constant() else { return texture };
    let values = || wavelengths().map(|nm| spectrum.at(&p.context.spectra, nm));
    let (least, greatest) = (values().fold(f32::INFINITY, f32::min), values().fold(0.0, f32::max));
    let span = p.span_of(name);
    if least < 0.0 {
        p.diagnostics().error(span, format!("\"{name}\" is a negative reflectance ({least})"));
    } else if greatest > 1.0 + ROUNDING {
        let message = format!("\"{name}\" is a reflectance above 1 ({greatest}); it is clamped to 1");
        p.diagnostics().warning(span, message);
    }
    texture
}

/// Warns if two reflectances of one surface sum to more than 1 at some wavelength.
pub(super) fn sum_of_albedos(p: &mut Parameters<'_, '_>, names: [&str; 2], textures: [SpectrumTexture; 2]) {
    let [Some(a), Some(b)] = textures.map(SpectrumTexture::constant) else { return };
    let tables = &p.context.spectra;
    let at = |spectrum: Spectrum, nm| spectrum.at(tables, nm).clamp(0.0, 1.0);
    let sum = wavelengths().map(|nm| at(a, nm) + at(b, nm)).fold(0.0, f32::max);
    if sum > 1.0 + ROUNDING {
        let [a, b] = names;
        let span = if p.has("ks") { p.span_of(b) } else { p.span_of(a) };
        let message =
            format!("\"{a}\" and \"{b}\" sum to {sum}: more light than arrives; both are scaled to sum to 1");
        p.diagnostics().warning(span, message);
    }
}

/// A number that may be textured, in [`least`, `greatest`]; a constant outside is a warning.
pub(super) fn float_within(
    p: &mut Parameters<'_, '_>,
    name: &'static str,
    default: f32,
    [least, greatest]: [f32; 2],
) -> FloatTexture {
    let texture = p.float_texture(name, default);
    let Some(value) = texture.constant() else { return texture };
    if (least..=greatest).contains(&value) {
        return texture;
    }
    let clamped = if value.is_nan() { default } else { value.clamp(least, greatest) };
    let span = p.span_of(name);
    let message =
        format!("\"{name}\" is {value}, but must be in [{least}, {greatest}]; it is taken as {clamped}");
    p.diagnostics().warning(span, message);
    FloatTexture::Constant(clamped)
}

/// A value of a texture, pulled into its range.
#[inline]
pub(super) fn clamp(value: f32, [least, greatest]: [f32; 2]) -> f32 {
    if value >= least { value.min(greatest) } else { least }
}

/// Wavelengths in nm at which constants are looked at.
fn wavelengths() -> impl Iterator<Item = f32> {
    const STEP_NM: f32 = 5.0;
    let n = ((LAMBDA_MAX_NM - LAMBDA_MIN_NM) / STEP_NM) as usize;
    (0..=n).map(|i| LAMBDA_MIN_NM + STEP_NM * i as f32)
}
