//! What the extensions of glTF 2.0 say of a `principled` material: `KHR_materials_specular`, `anisotropy`, `clearcoat`,
//! `sheen`, `iridescence`, `transmission`, `volume` and `dispersion`. `KHR_materials_ior` is the plain material's index.

use etendue_math::{Frame, Vector3, sqr};
use etendue_spectrum::{Sampled, Wavelengths};

use super::{MaterialContext, Materials, Perturbation, PrincipledMaterial, limits, spec};
use crate::bsdf::facetted::{ExtendedPrincipled, PrincipledParameters, ThinFilm};
use crate::bsdf::{Bsdf, BsdfKind, Facetted};
use crate::medium::{Absorption, Interface};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::{FloatTexture, SpectrumTexture, Textures};

/// Index of extensions in [`Materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ExtensionsId(pub u32);

/// A material with extensions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipledExtensions {
    /// The material itself.
    pub base: PrincipledMaterial,
    /// Weight of what is reflected and is not metal.
    pub specular: FloatTexture,
    /// Its colour along the normal.
    pub specular_color: SpectrumTexture,
    /// How much rougher facets are along the first direction.
    pub anisotropy: FloatTexture,
    /// That direction, in degrees from the first tangent to the second.
    pub anisotropy_rotation_deg: FloatTexture,
    /// Share of the surface that is coated.
    pub clearcoat: FloatTexture,
    /// Square root of the coat's alpha.
    pub clearcoat_roughness: FloatTexture,
    /// Relief of the coat, which has none of that of the base.
    pub clearcoat_perturbation: Perturbation,
    /// Colour of the fibres.
    pub sheen_color: SpectrumTexture,
    /// Square root of their alpha.
    pub sheen_roughness: FloatTexture,
    /// Share of the facets that have a thin film.
    pub iridescence: FloatTexture,
    /// Index of the film.
    pub iridescence_ior: f32,
    /// Thickness of the film in nm.
    pub iridescence_thickness_nm: FloatTexture,
    /// Share of glass in what is not metal.
    pub transmission: FloatTexture,
    /// What a solid has on both of its sides; `None` if the surface is thin or opaque.
    pub interface: Option<Interface>,
    /// 20 over Abbe's number of a solid.
    pub dispersion: f32,
}

const FILM_INDICES: [f32; 2] = [1.0, 4.0];
/// Thicker films have more colours than wavelengths of a path can show.
const FILM_THICKNESSES_NM: [f32; 2] = [0.0, 1e4];
const TURNS_DEG: [f32; 2] = [-360.0, 360.0];
const POSITIVE: [f32; 2] = [0.0, f32::INFINITY];
const DISTANCES_M: [f32; 2] = [1e-9, f32::INFINITY];

pub(super) const SPECULAR: ParameterSpec =
    spec::spec("specular", "float texture", "1", "Weight of the reflection of what is not metal, in [0, 1].");
pub(super) const SPECULAR_COLOR: ParameterSpec = spec::spec(
    "specularcolor",
    "spectrum texture",
    "1",
    "Factor of the reflectance along the normal of what is not metal; may exceed 1.",
);
pub(super) const ANISOTROPY: ParameterSpec = spec::spec(
    "anisotropy",
    "float texture",
    "0",
    "How far alpha along the first tangent is raised to 1: by the square of this, in [0, 1].",
);
pub(super) const ANISOTROPY_ROTATION: ParameterSpec = ParameterSpec {
    unit: "deg",
    ..spec::spec(
        "anisotropyrotation",
        "float texture",
        "0",
        "Turns the rougher direction from the first tangent to the second.",
    )
};
pub(super) const CLEARCOAT: ParameterSpec =
    spec::spec("clearcoat", "float texture", "0", "Share of the surface under a clear coat, in [0, 1].");
pub(super) const CLEARCOAT_ROUGHNESS: ParameterSpec =
    spec::spec("clearcoatroughness", "float texture", "0", "Square root of the coat's alpha, in [0, 1].");
pub(super) const CLEARCOAT_NORMAL_MAP: ParameterSpec = spec::spec(
    "clearcoatnormalmap",
    "string",
    "",
    "Image file of the coat's normals, which does not follow the relief below.",
);
pub(super) const CLEARCOAT_NORMAL_TEXTURE: ParameterSpec = spec::spec(
    "clearcoatnormaltexture",
    "spectrum texture",
    "",
    "The same as a texture \"imagemap\" of encoding linear.",
);
pub(super) const CLEARCOAT_NORMAL_SCALE: ParameterSpec =
    spec::spec("clearcoatnormalscale", "float", "1", "Factor of x and y of clearcoatnormaltexture.");
pub(super) const SHEEN_COLOR: ParameterSpec =
    spec::spec("sheencolor", "spectrum texture", "0", "Colour of the fibres on the surface, in [0, 1].");
pub(super) const SHEEN_ROUGHNESS: ParameterSpec = spec::spec(
    "sheenroughness",
    "float texture",
    "0",
    "Square root of the alpha of the fibres, in [0, 1]; below 0.1 it counts as 0.1.",
);
pub(super) const IRIDESCENCE: ParameterSpec =
    spec::spec("iridescence", "float texture", "0", "Share of the facets with a thin film, in [0, 1].");
pub(super) const IRIDESCENCE_IOR: ParameterSpec =
    spec::spec("iridescenceior", "float", "1.3", "Index of refraction of the film, 1 to 4.");
pub(super) const IRIDESCENCE_THICKNESS: ParameterSpec = ParameterSpec {
    unit: "nm",
    ..spec::spec("iridescencethickness", "float texture", "400", "Thickness of the film.")
};
pub(super) const TRANSMISSION: ParameterSpec =
    spec::spec("transmission", "float texture", "0", "Share of glass in what is not metal, in [0, 1].");
pub(super) const THICKNESS: ParameterSpec = ParameterSpec {
    unit: "m",
    ..spec::spec(
        "thickness",
        "float",
        "0",
        "0: glass is a thin sheet. Above 0: the surface encloses a solid, however thick it is.",
    )
};
pub(super) const ATTENUATION_COLOR: ParameterSpec = spec::spec(
    "attenuationcolor",
    "spectrum",
    "1",
    "What the solid leaves of light after attenuationdistance, in [0, 1].",
);
pub(super) const ATTENUATION_DISTANCE: ParameterSpec = ParameterSpec {
    unit: "m",
    ..spec::spec("attenuationdistance", "float", "infinite", "Distance after which attenuationcolor is left.")
};
pub(super) const DISPERSION: ParameterSpec =
    spec::spec("dispersion", "float", "0", "20 over Abbe's number of the solid; 0 does not disperse.");

const ALL: [ParameterSpec; 18] = [
    SPECULAR,
    SPECULAR_COLOR,
    ANISOTROPY,
    ANISOTROPY_ROTATION,
    CLEARCOAT,
    CLEARCOAT_ROUGHNESS,
    CLEARCOAT_NORMAL_MAP,
    CLEARCOAT_NORMAL_TEXTURE,
    SHEEN_COLOR,
    SHEEN_ROUGHNESS,
    IRIDESCENCE,
    IRIDESCENCE_IOR,
    IRIDESCENCE_THICKNESS,
    TRANSMISSION,
    THICKNESS,
    ATTENUATION_COLOR,
    ATTENUATION_DISTANCE,
    DISPERSION,
];

impl PrincipledExtensions {
    /// The extensions of a material; `None` if none is named.
    pub(super) fn build(
        p: &mut Parameters<'_, '_>,
        base: &PrincipledMaterial,
        materials: &mut Materials,
    ) -> Option<Self> {
        if !ALL.iter().any(|parameter| p.has(parameter.name)) {
            return None;
        }
        let mut share = |name, default| limits::float_within(p, name, default, limits::SHARES);
        let (specular, anisotropy, iridescence) =
            (share("specular", 1.0), share("anisotropy", 0.0), share("iridescence", 0.0));
        let (clearcoat, clearcoat_roughness) = (share("clearcoat", 0.0), share("clearcoatroughness", 0.0));
        let (sheen_roughness, transmission) = (share("sheenroughness", 0.0), share("transmission", 0.0));
        Some(Self {
            base: *base,
            specular,
            specular_color: limits::factor(p, "specularcolor", 1.0),
            anisotropy,
            anisotropy_rotation_deg: limits::float_within(p, "anisotropyrotation", 0.0, TURNS_DEG),
            clearcoat,
            clearcoat_roughness,
            clearcoat_perturbation: Perturbation::build_normal_texture(
                p,
                CLEARCOAT_NORMAL_TEXTURE.name,
                CLEARCOAT_NORMAL_SCALE.name,
            )
            .or_else(|| Perturbation::build_normal_map(p, CLEARCOAT_NORMAL_MAP.name, materials))
            .unwrap_or_default(),
            sheen_color: limits::albedo(p, "sheencolor", 0.0),
            sheen_roughness,
            iridescence,
            iridescence_ior: limits::constant_within(p, "iridescenceior", 1.3, FILM_INDICES),
            iridescence_thickness_nm: limits::float_within(
                p,
                "iridescencethickness",
                400.0,
                FILM_THICKNESSES_NM,
            ),
            transmission,
            interface: Self::solid(p, transmission, materials),
            dispersion: limits::constant_within(p, "dispersion", 0.0, POSITIVE),
        })
    }

    /// The sides of a solid, if it is one.
    fn solid(
        p: &mut Parameters<'_, '_>,
        transmission: FloatTexture,
        materials: &mut Materials,
    ) -> Option<Interface> {
        let thickness = limits::constant_within(p, "thickness", 0.0, POSITIVE);
        let distance_m = limits::constant_within(p, "attenuationdistance", f32::INFINITY, DISTANCES_M);
        let color = limits::albedo(p, "attenuationcolor", 1.0);
        let span = p.span_of("attenuationcolor");
        let Some(color) = color.constant() else {
            p.diagnostics().error(span, "\"attenuationcolor\" may not be a texture");
            return None;
        };
        let is_solid = thickness > 0.0 && transmission.constant().is_none_or(|share| share > 0.0);
        if !is_solid {
            if let Some(name) =
                ["attenuationcolor", "attenuationdistance", "dispersion"].into_iter().find(|name| p.has(name))
            {
                let span = p.span_of(name);
                p.diagnostics().warning(
                    span,
                    format!("\"{name}\" has no effect: it needs \"thickness\" and \"transmission\" above 0"),
                );
            }
            return None;
        }
        let absorbs = distance_m.is_finite() && p.has("attenuationcolor");
        let inside = absorbs.then(|| materials.add_medium(Absorption::Color { color, distance_m }));
        Some(Interface { inside, outside: None })
    }

    /// True if nothing varies over the surface and no direction along it matters.
    pub(super) fn is_uniform(&self) -> bool {
        let numbers = [
            self.specular,
            self.clearcoat,
            self.clearcoat_roughness,
            self.sheen_roughness,
            self.iridescence,
            self.iridescence_thickness_nm,
            self.transmission,
        ];
        self.anisotropy == FloatTexture::Constant(0.0)
            && self.clearcoat_perturbation == Perturbation::None
            && numbers.into_iter().all(|number| number.constant().is_some())
            && [self.specular_color, self.sheen_color].into_iter().all(|color| color.constant().is_some())
    }

    /// How the material scatters light at a point, given without and with the relief of the base.
    #[inline(never)]
    pub(super) fn bsdf(
        &self,
        materials: &Materials,
        textures: &Textures,
        [plain, shaded]: [&MaterialContext; 2],
        lambda: &mut Wavelengths,
    ) -> Bsdf {
        let number = |texture| textures.eval_float(texture, &shaded.texture);
        let share = |texture| limits::clamp(number(texture), limits::SHARES);
        let transmission = share(self.transmission);
        let ior = self.index(transmission, lambda);
        let color = |texture| textures.eval_spectrum(texture, &shaded.texture, lambda).max(Sampled::ZERO);
        let frame = self.frame(shaded, number(self.anisotropy_rotation_deg));
        let parameters = PrincipledParameters {
            base_color: color(self.base.base_color).min(Sampled::ONE),
            metallic: share(self.base.metallic),
            roughness: share(self.base.roughness),
            ior,
            specular: share(self.specular),
            specular_color: color(self.specular_color),
            anisotropy: share(self.anisotropy),
            transmission,
            is_solid: self.interface.is_some(),
            clearcoat: share(self.clearcoat),
            clearcoat_roughness: share(self.clearcoat_roughness),
            clearcoat_normal: self.coat_normal(materials, textures, plain, &frame),
            sheen_color: color(self.sheen_color).min(Sampled::ONE),
            sheen_roughness: share(self.sheen_roughness),
            film: ThinFilm {
                share: share(self.iridescence),
                ior: self.iridescence_ior,
                thickness_nm: limits::clamp(number(self.iridescence_thickness_nm), FILM_THICKNESSES_NM),
            },
            lambda_nm: lambda.lambda_nm(),
        };
        let kind = BsdfKind::Facetted(Facetted::Extended(ExtendedPrincipled::new(&parameters)));
        Bsdf::new(shaded.ns, shaded.ng, frame.x, kind)
    }

    /// The index of refraction. Where a solid disperses light, the first wavelength counts for all.
    fn index(&self, transmission: f32, lambda: &mut Wavelengths) -> f32 {
        let ior = self.base.ior;
        if self.dispersion == 0.0 || transmission == 0.0 || ior == 0.0 || self.interface.is_none() {
            return ior;
        }
        lambda.terminate_secondary();
        // Cauchy's first two terms through Fraunhofer's lines d, F and C [KHR_materials_dispersion].
        let bend = 523_655.0 / sqr(lambda.lambda_nm()[0]) - 1.5168;
        (ior + (ior - 1.0) * self.dispersion / 20.0 * bend).max(1.0)
    }

    /// The shading frame with the rougher direction first.
    fn frame(&self, ctx: &MaterialContext, rotation_deg: f32) -> Frame {
        let frame = Frame::from_zx(ctx.ns.as_vector(), ctx.shading_dpdu);
        if rotation_deg == 0.0 {
            return frame;
        }
        let (sin, cos) = rotation_deg.to_radians().sin_cos();
        Frame::from_zx(frame.z, frame.x * cos + frame.y * sin)
    }

    /// The coat's normal in the shading frame of the base: it follows the surface and its own map alone.
    fn coat_normal(
        &self,
        materials: &Materials,
        textures: &Textures,
        plain: &MaterialContext,
        frame: &Frame,
    ) -> Vector3 {
        const UP: Vector3 = Vector3::new(0.0, 0.0, 1.0);
        let perturbation = &self.clearcoat_perturbation;
        if *perturbation == Perturbation::None && self.base.perturbation == Perturbation::None {
            return UP;
        }
        let perturbed = perturbation.apply(materials, textures, plain);
        let normal = frame.to_local(perturbed.as_ref().unwrap_or(plain).ns.as_vector());
        // A coat that looks away from what it covers has no place to be.
        if normal.z > 0.1 { normal } else { UP }
    }
}
