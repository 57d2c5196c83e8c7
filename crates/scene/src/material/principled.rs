//! The metallic-roughness material of glTF 2.0.

use etendue_spectrum::Wavelengths;

use super::principled_extensions as extensions;
use super::{ExtensionsId, MaterialContext, Materials, Perturbation, PrincipledExtensions, limits, spec};
use crate::bsdf::facetted::Principled;
use crate::bsdf::{BsdfKind, Facetted};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::{FloatTexture, SpectrumTexture, Textures};

/// Parameters of `principled`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipledMaterial {
    /// Colour of the diffuse base, or of the metal.
    pub base_color: SpectrumTexture,
    /// Share of metal.
    pub metallic: FloatTexture,
    /// Square root of alpha.
    pub roughness: FloatTexture,
    /// Index of what is not metal; 0 reflects everything.
    pub ior: f32,
    /// What glTF's extensions say.
    pub extensions: Option<ExtensionsId>,
    /// Relief.
    pub perturbation: Perturbation,
}

const INDICES: [f32; 2] = [1.0, 4.0];

impl PrincipledMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        spec::spec(
            "basecolor",
            "spectrum texture",
            "0.8",
            "Albedo of the base, or reflectance of the metal.",
        ),
        spec::spec("metallic", "float texture", "0", "Share of metal, in [0, 1]."),
        spec::spec("roughness", "float texture", "0.5", "Square root of the alpha of the facets, in [0, 1]."),
        spec::spec(
            "ior",
            "float",
            "1.5",
            "Index of refraction of what is not metal, 1 to 4; 0 reflects everything.",
        ),
        extensions::SPECULAR,
        extensions::SPECULAR_COLOR,
        extensions::ANISOTROPY,
        extensions::ANISOTROPY_ROTATION,
        extensions::CLEARCOAT,
        extensions::CLEARCOAT_ROUGHNESS,
        extensions::CLEARCOAT_NORMAL_MAP,
        extensions::CLEARCOAT_NORMAL_TEXTURE,
        extensions::CLEARCOAT_NORMAL_SCALE,
        extensions::SHEEN_COLOR,
        extensions::SHEEN_ROUGHNESS,
        extensions::IRIDESCENCE,
        extensions::IRIDESCENCE_IOR,
        extensions::IRIDESCENCE_THICKNESS,
        extensions::TRANSMISSION,
        extensions::THICKNESS,
        extensions::ATTENUATION_COLOR,
        extensions::ATTENUATION_DISTANCE,
        extensions::DISPERSION,
        spec::DISPLACEMENT,
        spec::NORMAL_MAP,
        spec::spec(
            "normaltexture",
            "spectrum texture",
            "",
            "Texture \"imagemap\" of tangent-space normals, of encoding linear; overrides normalmap.",
        ),
        spec::spec("normalscale", "float", "1", "Factor of x and y of normaltexture."),
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>, materials: &mut Materials) -> Self {
        let reflects_all = p.float("ior", 1.5) == 0.0;
        let plain = Self {
            base_color: limits::albedo(p, "basecolor", 0.8),
            metallic: limits::float_within(p, "metallic", 0.0, limits::SHARES),
            roughness: limits::float_within(p, "roughness", 0.5, limits::SHARES),
            ior: if reflects_all { 0.0 } else { limits::constant_within(p, "ior", 1.5, INDICES) },
            extensions: None,
            perturbation: Perturbation::build_normal_texture(p, "normaltexture", "normalscale")
                .unwrap_or_else(|| Perturbation::build(p, materials)),
        };
        let extensions = PrincipledExtensions::build(p, &plain, materials);
        Self { extensions: extensions.map(|extensions| materials.add_extensions(extensions)), ..plain }
    }

    /// The plain model: extensions are [`PrincipledExtensions::bsdf`].
    #[inline]
    pub(super) fn bsdf(&self, textures: &Textures, ctx: &MaterialContext, lambda: &Wavelengths) -> BsdfKind {
        let share = |texture| limits::clamp(textures.eval_float(texture, &ctx.texture), limits::SHARES);
        let base = textures.eval_spectrum(self.base_color, &ctx.texture, lambda).clamp(0.0, 1.0);
        let (metallic, roughness) = (share(self.metallic), share(self.roughness));
        BsdfKind::Facetted(Facetted::Principled(Principled::new(base, metallic, roughness, self.ior)))
    }
}
