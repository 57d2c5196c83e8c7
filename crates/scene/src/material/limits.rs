//! Parameters that must lie in a range: what is outside is reported with its place and pulled in.
//!
//! Constants are looked at when the scene is built; textures are pulled in silently where they are evaluated.

use etendue_spectrum::{LAMBDA_MAX_NM, LAMBDA_MIN_NM, Spectrum};

use super::MaterialContext;
use crate::parameters::{Parameters, SpectrumRole};
use crate::texture::{FloatTexture, SpectrumTexture, Textures};

/// Exponents of highlights.
pub(super) const EXPONENTS: [f32; 2] = [0.0, 1e6];
/// Roughness, alpha or its square.
pub(super) const ROUGHNESSES: [f32; 2] = [0.0, 10.0];
/// Slopes of facets.
pub(super) const SLOPES: [f32; 2] = [1e-3, 1.0];
/// Parts of a whole.
pub(super) const SHARES: [f32; 2] = [0.0, 1.0];

/// Slack for sums of spectra made from colours.
const ROUNDING: f32 = 1e-3;

/// A reflectance in [0, 1]: negative ones are errors, larger ones warnings.
pub(super) fn albedo(p: &mut Parameters<'_, '_>, name: &'static str, default: f32) -> SpectrumTexture {
    albedo_opt(p, name).unwrap_or(grey(default))
}

/// The same, or `None` if it is not given.
pub(super) fn albedo_opt(p: &mut Parameters<'_, '_>, name: &'static str) -> Option<SpectrumTexture> {
    let texture = p.spectrum_texture_opt(name, SpectrumRole::Albedo)?;
    let Some(spectrum) = texture.constant() else { return Some(texture) };
    let values = || wavelengths().map(|nm| spectrum.at(&p.context.spectra, nm));
    let (least, greatest) = (values().fold(f32::INFINITY, f32::min), values().fold(0.0, f32::max));
    let span = p.span_of(name);
    if least < 0.0 {
        p.diagnostics().error(span, format!("\"{name}\" is a negative reflectance ({least})"));
    } else if greatest > 1.0 + ROUNDING {
        let message = format!("\"{name}\" is a reflectance above 1 ({greatest}); it is clamped to 1");
        p.diagnostics().warning(span, message);
    }
    Some(texture)
}

/// A factor that may exceed 1; negative ones are errors.
pub(super) fn factor(p: &mut Parameters<'_, '_>, name: &'static str, default: f32) -> SpectrumTexture {
    let texture = p.spectrum_texture(name, Spectrum::Constant(default), SpectrumRole::Unbounded);
    let Some(spectrum) = texture.constant() else { return texture };
    let least = least(p, &spectrum);
    if least < 0.0 {
        let span = p.span_of(name);
        p.diagnostics().error(span, format!("\"{name}\" is negative ({least})"));
    }
    texture
}

/// The least value of a spectrum over the rendered wavelengths.
pub(super) fn least(p: &Parameters<'_, '_>, spectrum: &Spectrum) -> f32 {
    wavelengths().map(|nm| spectrum.at(&p.context.spectra, nm)).fold(f32::INFINITY, f32::min)
}

/// Whether an index of refraction is not positive somewhere between wavelengths where it is: beyond its data a spectrum is 0.
pub(super) fn has_gap(p: &Parameters<'_, '_>, spectrum: &Spectrum) -> bool {
    let values: Vec<f32> = wavelengths().map(|nm| spectrum.at(&p.context.spectra, nm)).collect();
    let is_given = |value: &f32| *value != 0.0;
    let ends = values.iter().position(is_given).zip(values.iter().rposition(is_given));
    ends.is_none_or(|(first, last)| values[first..=last].iter().any(|value| *value <= 0.0))
}

/// Warns if two reflectances of one surface sum to more than 1 in some band: single wavelengths of saturated colours
/// may, and are scaled without a word.
pub(super) fn sum_of_albedos(
    p: &mut Parameters<'_, '_>,
    [a, b]: [&'static str; 2],
    textures: [SpectrumTexture; 2],
) {
    let [Some(first), Some(second)] = textures.map(SpectrumTexture::constant) else { return };
    let bands = |spectrum: Spectrum| spectrum.bands().rgb().map(|value| value.clamp(0.0, 1.0));
    let sums = bands(first).into_iter().zip(bands(second)).map(|(a, b)| a + b);
    let sum = sums.fold(0.0, f32::max);
    if sum > 1.0 + ROUNDING {
        let span = if p.has(b) { p.span_of(b) } else { p.span_of(a) };
        let message =
            format!("\"{a}\" and \"{b}\" sum to {sum}: more light than arrives; both are scaled to sum to 1");
        p.diagnostics().warning(span, message);
    }
}

/// A number that may be textured, in `range`; a constant outside is a warning.
pub(super) fn float_within(
    p: &mut Parameters<'_, '_>,
    name: &'static str,
    default: f32,
    range: [f32; 2],
) -> FloatTexture {
    match p.float_texture(name, default) {
        FloatTexture::Constant(value) => FloatTexture::Constant(checked(p, name, value, range)),
        texture @ FloatTexture::Node(_) => texture,
    }
}

/// A number in `range`; one outside is a warning.
pub(super) fn constant_within(
    p: &mut Parameters<'_, '_>,
    name: &'static str,
    default: f32,
    range: [f32; 2],
) -> f32 {
    let value = p.float(name, default);
    checked(p, name, value, range)
}

/// The value, or the nearest in the range, with a warning.
fn checked(p: &mut Parameters<'_, '_>, name: &str, value: f32, range: [f32; 2]) -> f32 {
    let [least, greatest] = range;
    if (least..=greatest).contains(&value) {
        return value;
    }
    let taken = clamp(value, range);
    let span = p.span_of(name);
    let message =
        format!("\"{name}\" is {value}, but must be in [{least}, {greatest}]; it is taken as {taken}");
    p.diagnostics().warning(span, message);
    taken
}

/// One number for each tangent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerTangent {
    /// Along the first tangent.
    pub u: FloatTexture,
    /// Along the second tangent.
    pub v: FloatTexture,
}

impl PerTangent {
    /// From the names of the parameters for both, the first and the second tangent.
    pub(super) fn build(
        p: &mut Parameters<'_, '_>,
        [both, u, v]: [&'static str; 3],
        default: f32,
        range: [f32; 2],
    ) -> Self {
        let both = float_within(p, both, default, range);
        let mut along = |name| if p.has(name) { float_within(p, name, default, range) } else { both };
        Self { u: along(u), v: along(v) }
    }

    /// Both numbers at a point.
    #[inline]
    pub(super) fn at(&self, textures: &Textures, ctx: &MaterialContext, range: [f32; 2]) -> [f32; 2] {
        [self.u, self.v].map(|texture| clamp(textures.eval_float(texture, &ctx.texture), range))
    }

    /// True if both are the same everywhere.
    pub(super) fn is_isotropic(&self) -> bool {
        matches!((self.u, self.v), (FloatTexture::Constant(u), FloatTexture::Constant(v)) if u == v)
    }
}

/// A grey.
pub(super) const fn grey(value: f32) -> SpectrumTexture {
    SpectrumTexture::Constant(Spectrum::Constant(value))
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
