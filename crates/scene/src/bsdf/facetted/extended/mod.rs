//! glTF's material with its extensions: clear coat, sheen, thin film, coloured reflection, brushing, thin and solid glass.
//!
//! Light meets the coat first, then the fibres of the sheen, then a base of metal, plastic and glass ([`layers`],
//! [`coat`], [`sheen`], [`film`], [`base`]). Surfaces that use none of it are [`Principled`](super::Principled), which
//! is quicker. Since paths pass BSDFs by value, an [`ExtendedPrincipled`] keeps shares and colours in 16 bits each and
//! unpacks them where it is asked.

mod base;
mod catalogue;
mod coat;
mod film;
mod layers;
mod packed;
mod sheen;

pub(in crate::bsdf) use catalogue::configurations;
pub use film::ThinFilm;
pub use packed::ExtendedPrincipled;

use etendue_math::Vector3;
use etendue_spectrum::Sampled;

/// What the core of glTF and its extensions say of a surface at a point. Numbers are taken to be in their ranges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipledParameters {
    /// Albedo of the diffuse base, reflectance of metal, tint of glass; in [0, 1].
    pub base_color: Sampled,
    /// Share of metal.
    pub metallic: f32,
    /// Square root of alpha.
    pub roughness: f32,
    /// Index of what is not metal, at least 1; 0 reflects everything.
    pub ior: f32,
    /// Weight of the reflection of what is not metal, in [0, 1].
    pub specular: f32,
    /// Its colour along the normal.
    pub specular_color: Sampled,
    /// How much rougher facets are along the first tangent, in [0, 1].
    pub anisotropy: f32,
    /// Share of glass in what is not metal.
    pub transmission: f32,
    /// True if the glass fills what is below the surface.
    pub is_solid: bool,
    /// Share of the surface under a coat.
    pub clearcoat: f32,
    /// Square root of the coat's alpha.
    pub clearcoat_roughness: f32,
    /// Unit normal of the coat in the shading frame, above the surface.
    pub clearcoat_normal: Vector3,
    /// Colour of the sheen, in [0, 1].
    pub sheen_color: Sampled,
    /// Square root of the sheen's alpha; below 0.1 it counts as 0.1.
    pub sheen_roughness: f32,
    /// Film on the facets of the base.
    pub film: ThinFilm,
    /// Wavelengths in nm, which the film asks for.
    pub lambda_nm: [f32; 4],
}

impl Default for PrincipledParameters {
    /// White plastic as in glTF, without any extension.
    fn default() -> Self {
        Self {
            base_color: Sampled::ONE,
            metallic: 0.0,
            roughness: 0.5,
            ior: 1.5,
            specular: 1.0,
            specular_color: Sampled::ONE,
            anisotropy: 0.0,
            transmission: 0.0,
            is_solid: false,
            clearcoat: 0.0,
            clearcoat_roughness: 0.0,
            clearcoat_normal: Vector3::new(0.0, 0.0, 1.0),
            sheen_color: Sampled::ZERO,
            sheen_roughness: 0.0,
            film: ThinFilm::NONE,
            lambda_nm: [450.0, 520.0, 580.0, 640.0],
        }
    }
}
