//! Surfaces that emit on one or both sides: the same radiance L in all directions, Phi = pi A L for one side (SPEC RAD-9,
//! EMI-5, EMI-6), or less away from the normal, by a [`Profile`] (EMI-8). Each primitive of an emissive shape is a light; what it emits is shared.
//!
//! As in pbrt-v4, a picture is looked up with the shape's (u, v), v upwards. Power is split between the primitives by
//! area: `power` of a mesh is that of the whole shape (pbrt-v4 gives that power to every triangle).
//!
//! **Alpha.** Rays meet a surface of alpha a with probability a, and then find the radiance L; a sample of the light
//! therefore returns the mean, a L. Constant alpha 0 is the exception, as in pbrt-v4: it makes an invisible light, whose
//! surface no ray meets, but which is sampled with the whole of L. Sampling is then the only technique that finds it, so
//! that it counts as a delta light in multiple importance sampling.

use std::f32::consts::PI;

use etendue_geometry::{FlatLamp, Geometry, GeometryId, Lamp, Reference, ShapeSample};
use etendue_math::{Frame, Normal3, Point2, Point3, Ray, Vector3, warp};
use etendue_spectrum::{Sampled, Spectrum, SpectrumTables, Wavelengths};

use super::build::{self, spec};
use super::{
    EmittedRay, LightBounds, LightContext, LightImage, LightImageId, LightPoint, LightPower, LightSample,
    LightTables, Profile,
};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::{FloatTexture, TextureContext};

/// Index of an emission in [`LightTables`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct AreaEmissionId(pub u32);

/// What a surface emits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaEmission {
    /// Radiance, where there is no picture.
    radiance: Spectrum,
    /// How radiance depends on direction; `None` for the same in all.
    profile: Option<Profile>,
    /// Picture of radiance, and radiance where it is 1 in multiples of its illuminant.
    picture: Option<(LightImageId, f32)>,
    /// True if both sides emit.
    two_sided: bool,
    /// Measures of the mean radiance.
    mean: LightPower,
    /// Share of the surface that emits.
    coverage: FloatTexture,
    /// False if no ray meets the surface.
    is_visible: bool,
}

impl AreaEmission {
    /// Parameters in scene files.
    pub const PARAMETERS: &[ParameterSpec] = &[
        spec("L", "spectrum", "illuminant of the colour space", "cd/m^2", "radiance, if no picture is given"),
        spec("filename", "string", "", "", "picture of radiance over the (u, v) of the shape"),
        spec("twosided", "bool", "false", "", "true if both sides emit"),
        build::SCALE,
        spec("power", "float", "", "lm", "flux of the whole shape; replaces the size of L"),
        spec("exponent", "float", "0", "", "radiance falls as this power of the cosine to the normal"),
        spec("spreadangle", "float", "90", "degrees", "largest angle between the normal and what is emitted"),
        super::LightUnits::PARAMETER,
    ];

    /// The same radiance everywhere.
    #[must_use]
    pub fn uniform(radiance: Spectrum, two_sided: bool, spectra: &SpectrumTables) -> Self {
        let mean = LightPower::of(&radiance, spectra);
        let coverage = FloatTexture::Constant(1.0);
        Self { radiance, profile: None, picture: None, two_sided, mean, coverage, is_visible: true }
    }

    /// Radiance from a picture, times `scale`.
    #[must_use]
    pub fn pictured(
        id: LightImageId,
        image: &LightImage,
        scale: f32,
        two_sided: bool,
        spectra: &SpectrumTables,
    ) -> Self {
        let radiance = image.mean().scaled(scale);
        Self { picture: Some((id, scale)), ..Self::uniform(radiance, two_sided, spectra) }
    }

    /// On a shape of which rays meet the share `alpha`.
    #[must_use]
    pub fn with_alpha(self, alpha: FloatTexture) -> Self {
        match alpha {
            FloatTexture::Constant(alpha) if alpha <= 0.0 => Self { is_visible: false, ..self },
            FloatTexture::Constant(alpha) => {
                Self { coverage: FloatTexture::Constant(alpha.min(1.0)), ..self }
            }
            FloatTexture::Node(_) => Self { coverage: alpha, ..self },
        }
    }

    /// True if it depends on the place.
    #[inline]
    const fn varies(&self) -> bool {
        self.picture.is_some() || self.coverage.constant().is_none()
    }

    /// True if both sides emit.
    #[must_use]
    pub const fn two_sided(&self) -> bool {
        self.two_sided
    }

    /// Radiance that leaves a surface with geometric normal `ng` at texture coordinates `uv` in the unit direction `wo`.
    #[inline]
    #[must_use]
    pub fn le(
        &self,
        context: &LightContext,
        ng: Normal3,
        uv: Point2,
        wo: Vector3,
        lambda: &Wavelengths,
    ) -> Sampled {
        if !self.two_sided && ng.dot_vector(wo) <= 0.0 {
            return Sampled::ZERO;
        }
        let Some((image, scale)) = self.picture else {
            return self.radiance.sample(context.spectra, lambda) * self.relative(ng, wo);
        };
        let uv = Point2::new(uv.x, 1.0 - uv.y);
        let scale = scale * self.relative(ng, wo);
        context.tables.image(image).bilinear(uv, context.spectra, lambda) * scale
    }

    /// Radiance in a direction over that along the normal.
    #[inline]
    fn relative(&self, ng: Normal3, wo: Vector3) -> f32 {
        self.profile.map_or(1.0, |profile| profile.relative(ng.dot_vector(wo).abs()))
    }

    /// A direction around +z in proportion to radiance times cosine.
    fn sample_direction(&self, u: Point2) -> Vector3 {
        self.profile.map_or_else(|| warp::sample_cosine_hemisphere(u), |profile| profile.sample(u))
    }

    /// Density per steradian of [`sample_direction`](Self::sample_direction).
    fn direction_pdf(&self, cosine: f32) -> f32 {
        self.profile.map_or_else(|| warp::cosine_hemisphere_pdf(cosine), |profile| profile.pdf_w(cosine))
    }

    /// Flux of one side per square metre where the radiance along the normal is 1.
    fn projected_solid_angle(&self) -> f32 {
        self.profile.map_or(PI, |profile| profile.projected_solid_angle())
    }

    /// Flux per square metre of surface, of one or both sides; textured alpha counts as 1.
    #[must_use]
    pub fn exitance(&self) -> LightPower {
        self.mean * f64::from(self.sides() * self.projected_solid_angle() * self.mean_coverage())
    }

    /// Share of the surface that emits; 1 for textures, whose mean is not known.
    fn mean_coverage(&self) -> f32 {
        self.coverage.constant().unwrap_or(1.0)
    }

    /// Share of the surface that emits at a point with normal `n`.
    #[inline]
    fn coverage(&self, context: &LightContext, p: Point3, n: Normal3, uv: Point2) -> f32 {
        match self.coverage {
            FloatTexture::Constant(coverage) => coverage,
            FloatTexture::Node(_) => {
                let at = TextureContext { p, n, uv, ..TextureContext::default() };
                context.textures.eval_float(self.coverage, &at).clamp(0.0, 1.0)
            }
        }
    }

    const fn sides(&self) -> f32 {
        if self.two_sided { 2.0 } else { 1.0 }
    }

    /// From an `AreaLightSource`; `area_m2` is the area of the whole shape.
    pub(super) fn build(p: &mut Parameters, area_m2: f32, tables: &mut LightTables) -> Option<Self> {
        let two_sided = p.bool("twosided", false);
        let power = p.float("power", -1.0);
        let sides = if two_sided { 2.0 } else { 1.0 };
        let profile = Profile::read(p);
        let flux_per_radiance =
            profile.map_or(PI, |profile| profile.projected_solid_angle()) * sides * area_m2;
        if !p.has("filename") {
            let source = build::Source::read(p, "L");
            let radiance = source.spectrum(p, power, |l| l * f64::from(flux_per_radiance));
            return Some(Self { profile, ..Self::uniform(radiance, two_sided, &p.context.spectra) });
        }
        if p.has("L") {
            let span = p.span_of("filename");
            p.diagnostics().error(span, "an area light takes \"L\" or \"filename\", not both");
            return None;
        }
        let size = build::PictureScale::read(p);
        let picture = build::read_picture(p)?;
        let image =
            LightImage::new(picture.width, picture.height, &picture.rgb, picture.space, picture.white);
        let scale = size.factor(p, &picture, power, image.mean(), flux_per_radiance);
        let id = tables.add_image(image);
        Some(Self { profile, ..Self::pictured(id, tables.image(id), scale, two_sided, &p.context.spectra) })
    }
}

/// One primitive of an emissive shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaLight {
    /// The shape.
    pub geometry: GeometryId,
    /// Triangle or patch of the shape; 0 for quadrics and for two triangles that are one lamp.
    pub primitive: u32,
    /// What it emits.
    pub emission: AreaEmissionId,
    is_visible: bool,
    /// For the usual lamp a short way to its points.
    lamp: Option<Lamp>,
}

impl AreaLight {
    /// A primitive of the shape `id` of `geometry` with an emission of `tables`.
    #[must_use]
    pub fn new(
        geometry: &Geometry,
        id: GeometryId,
        primitive: u32,
        emission: AreaEmissionId,
        tables: &LightTables,
    ) -> Self {
        let emitted = &tables.emissions[emission.0 as usize];
        let lamp = geometry.lamp(id, primitive).filter(|lamp| !emitted.varies() || lamp.has_places());
        Self { geometry: id, primitive, emission, is_visible: emitted.is_visible, lamp }
    }

    /// The whole of a shape as one light, if it is a parallelogram of two triangles that emits the same everywhere.
    #[must_use]
    pub fn joined(
        geometry: &Geometry,
        id: GeometryId,
        emission: AreaEmissionId,
        tables: &LightTables,
    ) -> Option<Self> {
        let lamp = geometry.joined_lamp(id)?;
        let emitted = &tables.emissions[emission.0 as usize];
        let is_visible = emitted.is_visible;
        (!emitted.varies()).then_some(Self {
            geometry: id,
            primitive: 0,
            emission,
            is_visible,
            lamp: Some(lamp),
        })
    }

    /// The lamp, if it is flat, which may be more than the primitive.
    fn flat_lamp(&self) -> Option<&FlatLamp> {
        self.lamp.as_ref().and_then(Lamp::flat)
    }

    fn area(&self, context: &LightContext) -> f32 {
        let of_primitive = || context.geometry.area(self.geometry, self.primitive);
        self.flat_lamp().map_or_else(of_primitive, FlatLamp::area)
    }

    /// A point as seen from `reference`, with its density per steradian; with texture coordinates if `varies`.
    #[inline(always)]
    fn sample_point(
        &self,
        context: &LightContext,
        reference: &Reference,
        u: Point2,
        varies: bool,
    ) -> Option<(ShapeSample, f32)> {
        let Some(lamp) = &self.lamp else {
            return context.geometry.sample_from(self.geometry, self.primitive, reference, u);
        };
        let (mut sample, pdf_w, place) = lamp.sample_from(reference, u)?;
        if varies {
            sample.uv = context.geometry.texture_coordinates(self.geometry, self.primitive, place);
        }
        Some((sample, pdf_w))
    }

    /// Radiance along the normal, the mean over the shape.
    #[must_use]
    pub fn mean_radiance(&self, context: &LightContext) -> LightPower {
        self.emission(context).mean
    }

    /// False if no ray meets its surface.
    #[must_use]
    pub const fn is_visible(&self) -> bool {
        self.is_visible
    }

    #[inline]
    fn emission<'a>(&self, context: &LightContext<'a>) -> &'a AreaEmission {
        &context.tables.emissions[self.emission.0 as usize]
    }

    #[inline]
    pub(super) fn le(
        &self,
        context: &LightContext,
        ng: Normal3,
        uv: Point2,
        wo: Vector3,
        lambda: &Wavelengths,
    ) -> Sampled {
        self.emission(context).le(context, ng, uv, wo, lambda)
    }

    #[inline(always)]
    pub(super) fn sample_li(
        &self,
        context: &LightContext,
        reference: &Reference,
        u: Point2,
        lambda: &Wavelengths,
    ) -> Option<LightSample> {
        let emission = self.emission(context);
        let (s, pdf_w) = self.sample_point(context, reference, u, emission.varies())?;
        let to_light = s.p - reference.p;
        let distance = to_light.length();
        let wi = to_light * (1.0 / distance);
        let le = emission.le(context, s.n, s.uv, -wi, lambda) * emission.coverage(context, s.p, s.n, s.uv);
        let is_valid = distance > 0.0 && pdf_w > 0.0 && pdf_w.is_finite();
        (is_valid && !le.is_black()).then_some(LightSample {
            wi,
            le,
            pdf_w,
            distance,
            is_delta: !self.is_visible,
            p_light: Some(LightPoint { p: s.p, p_error: s.p_error, n: Some(s.n), uv: s.uv }),
        })
    }

    pub(super) fn pdf_li(&self, context: &LightContext, reference: &Reference, wi: Vector3) -> f32 {
        if !self.is_visible {
            return 0.0;
        }
        match self.flat_lamp() {
            Some(lamp) => {
                let hit = lamp.intersect(&Ray::new(reference.p, wi));
                hit.map_or(0.0, |p| lamp.pdf_from(reference, p))
            }
            None => context.geometry.pdf_from(self.geometry, self.primitive, reference, wi),
        }
    }

    #[inline]
    pub(super) fn pdf_li_at(
        &self,
        context: &LightContext,
        reference: &Reference,
        p: Point3,
        ng: Normal3,
    ) -> f32 {
        if !self.is_visible {
            return 0.0;
        }
        match &self.lamp {
            Some(lamp) => lamp.pdf_from(reference, p),
            None => context.geometry.pdf_from_point(self.geometry, self.primitive, reference, p, ng),
        }
    }

    pub(super) fn sample_le(
        &self,
        context: &LightContext,
        u_position: Point2,
        mut u_direction: Point2,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        let emission = self.emission(context);
        let s = match self.flat_lamp() {
            Some(lamp) if !emission.varies() => lamp.sample_area(u_position),
            _ => context.geometry.sample_area(self.geometry, self.primitive, u_position)?,
        };
        let mut side = 1.0;
        if emission.two_sided {
            side = if u_direction.x < 0.5 { 1.0 } else { -1.0 };
            u_direction.x = (2.0 * u_direction.x).fract();
        }
        let local = emission.sample_direction(u_direction);
        let w = Frame::from_z(s.n.as_vector() * side).to_world(local);
        let pdf_w = emission.direction_pdf(local.z) / emission.sides();
        let le = emission.le(context, s.n, s.uv, w, lambda) * emission.coverage(context, s.p, s.n, s.uv);
        (pdf_w > 0.0 && s.pdf_a > 0.0 && !le.is_black()).then(|| EmittedRay {
            ray: Ray::new(s.p, w),
            p_error: s.p_error,
            n: Some(s.n),
            uv: s.uv,
            le,
            cosine: local.z,
            pdf_a: s.pdf_a,
            pdf_w,
        })
    }

    pub(super) fn pdf_le(&self, context: &LightContext, ray: &Ray, ng: Option<Normal3>) -> (f32, f32) {
        let Some(ng) = ng else { return (0.0, 0.0) };
        let emission = self.emission(context);
        let cosine = ng.dot_vector(ray.direction);
        let cosine = if emission.two_sided { cosine.abs() } else { cosine.max(0.0) };
        let area = self.area(context);
        (1.0 / area, emission.direction_pdf(cosine) / emission.sides())
    }

    pub(super) fn power(&self, context: &LightContext) -> LightPower {
        let area = self.area(context);
        self.emission(context).exitance() * f64::from(area)
    }

    pub(super) fn bounds(&self, context: &LightContext) -> Option<LightBounds> {
        let emission = self.emission(context);
        let of_primitive = || context.geometry.primitive_bounds(self.geometry, self.primitive);
        let (w, cos_theta_o) = context.geometry.emission_cone(self.geometry, self.primitive);
        let area = self.area(context);
        Some(LightBounds {
            bounds: self.flat_lamp().map_or_else(of_primitive, FlatLamp::bounds),
            w,
            cos_theta_o,
            cos_theta_e: emission.profile.map_or(0.0, |profile| profile.cos_max()),
            intensity: (emission.mean.weight * f64::from(area * emission.mean_coverage())) as f32,
            two_sided: emission.two_sided,
        })
    }
}
