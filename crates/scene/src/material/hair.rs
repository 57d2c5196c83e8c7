//! Hair and fur, as in pbrt-v4.

use etendue_spectrum::{Sampled, Wavelengths};

use super::{MaterialContext, Materials, Perturbation, limits, spec};
use crate::bsdf::hair::HairRoughness;
use crate::bsdf::tabulated::spectrum_of_color;
use crate::bsdf::{BsdfKind, Hair};
use crate::parameters::{ParameterSpec, Parameters, SpectrumRole};
use crate::texture::{FloatTexture, SpectrumTexture, Textures};

/// Parameters of `hair`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HairMaterial {
    /// What colours it.
    pub color: HairColor,
    /// Index of refraction.
    pub eta: FloatTexture,
    /// Roughness along the fibre.
    pub beta_m: FloatTexture,
    /// Roughness about the fibre.
    pub beta_n: FloatTexture,
    /// Tilt of the scales in degrees.
    pub alpha_deg: FloatTexture,
    /// Relief.
    pub perturbation: Perturbation,
}

/// What colours hair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HairColor {
    /// An absorption coefficient per radius of the fibre.
    Absorption(SpectrumTexture),
    /// The colour of much hair, from which the absorption follows.
    Reflectance(SpectrumTexture),
    /// Concentrations of the brown and the red pigment.
    Pigments {
        /// Of eumelanin.
        eumelanin: FloatTexture,
        /// Of pheomelanin.
        pheomelanin: FloatTexture,
    },
}

const INDICES: [f32; 2] = [1.0, 4.0];
/// Smoother fibres are narrower than single precision tells apart.
const ROUGHNESSES: [f32; 2] = [0.01, 1.0];
const TILTS: [f32; 2] = [-90.0, 90.0];

/// Absorption by a unit of each pigment as linear sRGB (d'Eon et al. 2011).
const EUMELANIN: [f32; 3] = [0.419, 0.697, 1.37];
const PHEOMELANIN: [f32; 3] = [0.187, 0.4, 1.05];

impl HairMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        spec::spec(
            "sigma_a",
            "spectrum texture",
            "",
            "Absorption per radius of the fibre, in place of pigments.",
        ),
        spec::spec("reflectance", "spectrum texture", "", "Colour of much hair, in place of pigments."),
        spec::spec("color", "spectrum texture", "", "Another name of reflectance."),
        spec::spec(
            "eumelanin",
            "float texture",
            "1.3",
            "Concentration of the brown pigment; 0 if only the other is given.",
        ),
        spec::spec("pheomelanin", "float texture", "0", "Concentration of the red pigment."),
        spec::spec("eta", "float texture", "1.55", "Index of refraction inside, 1 to 4."),
        spec::spec("beta_m", "float texture", "0.3", "Roughness along the fibre, 0.01 to 1."),
        spec::spec("beta_n", "float texture", "0.3", "Roughness about the fibre, 0.01 to 1."),
        ParameterSpec {
            unit: "degrees",
            ..spec::spec("alpha", "float texture", "2", "Tilt of the scales towards the root.")
        },
        spec::DISPLACEMENT,
        spec::NORMAL_MAP,
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>, materials: &mut Materials) -> Self {
        Self {
            color: HairColor::build(p),
            eta: limits::float_within(p, "eta", 1.55, INDICES),
            beta_m: limits::float_within(p, "beta_m", 0.3, ROUGHNESSES),
            beta_n: limits::float_within(p, "beta_n", 0.3, ROUGHNESSES),
            alpha_deg: limits::float_within(p, "alpha", 2.0, TILTS),
            perturbation: Perturbation::build(p, materials),
        }
    }

    /// The fibre runs along u, and v goes across it: from -1 to 1 of the radius, on the side where v grows.
    pub(super) fn bsdf(&self, textures: &Textures, ctx: &MaterialContext, lambda: &Wavelengths) -> BsdfKind {
        let number = |texture, range| limits::clamp(textures.eval_float(texture, &ctx.texture), range);
        let roughness = HairRoughness {
            beta_m: number(self.beta_m, ROUGHNESSES),
            beta_n: number(self.beta_n, ROUGHNESSES),
            alpha_rad: number(self.alpha_deg, TILTS).to_radians(),
        };
        let sigma_a = self.color.absorption(textures, ctx, lambda, roughness.beta_n);
        let h = -1.0 + 2.0 * ctx.texture.uv.y;
        BsdfKind::Hair(Hair::new(h, roughness, number(self.eta, INDICES), sigma_a))
    }
}

impl HairColor {
    /// Of several ways to give it the first counts: absorption, colour, pigments.
    fn build(p: &mut Parameters<'_, '_>) -> Self {
        const WAYS: [&str; 5] = ["sigma_a", "reflectance", "color", "eumelanin", "pheomelanin"];
        let given: Vec<&str> = WAYS.into_iter().filter(|way| p.has(way)).collect();
        if let [first, others @ ..] = given.as_slice()
            && *first != "eumelanin"
        {
            for other in others {
                let span = p.span_of(other);
                p.diagnostics().warning(span, format!("\"{other}\" is ignored, as \"{first}\" is given"));
            }
        }
        let absorption = p.spectrum_texture_opt("sigma_a", SpectrumRole::Unbounded);
        let reflectance = limits::albedo_opt(p, "reflectance").or(limits::albedo_opt(p, "color"));
        let eumelanin = p.float_texture_opt("eumelanin");
        let pheomelanin = p.float_texture_opt("pheomelanin");
        let only_red = eumelanin.is_none() && pheomelanin.is_some();
        match (absorption, reflectance) {
            (Some(texture), _) => Self::Absorption(texture),
            (None, Some(texture)) => Self::Reflectance(texture),
            (None, None) => Self::Pigments {
                eumelanin: eumelanin.unwrap_or(FloatTexture::Constant(if only_red { 0.0 } else { 1.3 })),
                pheomelanin: pheomelanin.unwrap_or(FloatTexture::Constant(0.0)),
            },
        }
    }

    fn absorption(
        &self,
        textures: &Textures,
        ctx: &MaterialContext,
        lambda: &Wavelengths,
        beta_n: f32,
    ) -> Sampled {
        let spectrum = |texture| textures.eval_spectrum(texture, &ctx.texture, lambda);
        match *self {
            Self::Absorption(texture) => spectrum(texture).max(Sampled::ZERO),
            Self::Reflectance(texture) => absorption_of_color(spectrum(texture), beta_n),
            Self::Pigments { eumelanin, pheomelanin } => {
                let amount = |texture| textures.eval_float(texture, &ctx.texture).max(0.0);
                let (brown, red) = (amount(eumelanin), amount(pheomelanin));
                let rgb = std::array::from_fn(|c| brown * EUMELANIN[c] + red * PHEOMELANIN[c]);
                spectrum_of_color(rgb, lambda)
            }
        }
    }
}

/// The absorption coefficient with which much hair has this colour, by a fit. [Chiang et al. 2016 (9)]
fn absorption_of_color(color: Sampled, beta_n: f32) -> Sampled {
    const FIT: [f32; 6] = [5.969, -0.215, 2.532, -10.73, 5.574, 0.245];
    let scale = FIT.iter().rev().fold(0.0, |sum, c| sum * beta_n + c);
    // Nothing is quite black.
    color.clamp(1e-6, 1.0).map(|c| (c.ln() / scale).powi(2))
}
