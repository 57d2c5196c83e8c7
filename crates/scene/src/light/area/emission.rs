//! What surfaces emit: radiance, a picture of it, and how it depends on direction.

use std::f32::consts::PI;

use etendue_geometry::{Reference, ShapeSample};
use etendue_math::{Frame, Normal3, Point2, Point3, Ray, Vector3, warp};
use etendue_spectrum::{Sampled, Spectrum, SpectrumTables, Wavelengths};

use super::{LuminousProfile, LuminousProfileId};
use crate::light::build::{self, spec};
use crate::light::{
    EmittedRay, LightContext, LightImage, LightImageId, LightPoint, LightPower, LightSample, LightTables,
    LightUnits, Profile,
};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::{FloatTexture, TextureContext};

/// Index of an emission in [`LightTables`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct AreaEmissionId(pub u32);

/// How radiance depends on direction.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Falloff {
    /// Not at all.
    Even,
    /// By a power of the cosine, within a cone.
    Cosine(Profile),
    /// By a luminaire's table.
    Table(LuminousProfileId),
}

/// What a surface emits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaEmission {
    /// Radiance, where there is no picture.
    radiance: Spectrum,
    /// How radiance depends on direction.
    falloff: Falloff,
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
        spec(
            "profile",
            "string",
            "",
            "",
            "photometric file (IES LM-63): candela of the shape by the angle to its normal; L is then that of a matte surface of the same flux",
        ),
        spec("spreadangle", "float", "90", "degrees", "largest angle between the normal and what is emitted"),
        LightUnits::PARAMETER,
    ];

    /// The same radiance everywhere.
    #[must_use]
    pub fn uniform(radiance: Spectrum, two_sided: bool, spectra: &SpectrumTables) -> Self {
        let mean = LightPower::of(&radiance, spectra);
        let coverage = FloatTexture::Constant(1.0);
        Self { radiance, falloff: Falloff::Even, picture: None, two_sided, mean, coverage, is_visible: true }
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
    pub(super) const fn varies(&self) -> bool {
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
            return self.radiance.sample(context.spectra, lambda) * self.relative(context, ng, wo);
        };
        let uv = Point2::new(uv.x, 1.0 - uv.y);
        let scale = scale * self.relative(context, ng, wo);
        context.tables.image(image).bilinear(uv, context.spectra, lambda) * scale
    }

    /// Radiance in a direction over that along the normal; for tables, over that of a matte surface of the same flux.
    #[inline]
    fn relative(&self, context: &LightContext, ng: Normal3, wo: Vector3) -> f32 {
        match &self.falloff {
            Falloff::Even => 1.0,
            Falloff::Cosine(profile) => profile.relative(ng.dot_vector(wo).abs()),
            Falloff::Table(id) => context.tables.profile(*id).relative(ng.dot_vector(wo).abs()),
        }
    }

    /// A direction around +z in proportion to radiance times cosine.
    #[inline]
    fn sample_direction(&self, context: &LightContext, u: Point2) -> Vector3 {
        match &self.falloff {
            Falloff::Even => warp::sample_cosine_hemisphere(u),
            Falloff::Cosine(profile) => profile.sample(u),
            Falloff::Table(id) => context.tables.profile(*id).sample(u),
        }
    }

    /// Density per steradian of [`sample_direction`](Self::sample_direction).
    #[inline]
    fn direction_pdf(&self, context: &LightContext, cosine: f32) -> f32 {
        match &self.falloff {
            Falloff::Even => warp::cosine_hemisphere_pdf(cosine),
            Falloff::Cosine(profile) => profile.pdf_w(cosine),
            Falloff::Table(id) => context.tables.profile(*id).pdf_w(cosine),
        }
    }

    /// Flux of one side per square metre where the mean radiance is 1.
    fn projected_solid_angle(&self) -> f32 {
        match &self.falloff {
            Falloff::Cosine(profile) => profile.projected_solid_angle(),
            Falloff::Even | Falloff::Table(_) => PI,
        }
    }

    /// Cosine of the largest angle to the normal.
    pub(super) fn cos_max(&self) -> f32 {
        match &self.falloff {
            Falloff::Cosine(profile) => profile.cos_max(),
            Falloff::Even | Falloff::Table(_) => 0.0,
        }
    }

    /// Radiance along the normal, the mean over the shape.
    pub(super) fn mean_radiance(&self, context: &LightContext) -> LightPower {
        let up = Vector3::new(0.0, 0.0, 1.0);
        self.mean * f64::from(self.relative(context, up.as_normal(), up))
    }

    /// The largest intensity of each square metre, by the weight of [`LightPower`].
    pub(super) fn peak_intensity(&self, context: &LightContext) -> f64 {
        let peak = match &self.falloff {
            Falloff::Even | Falloff::Cosine(_) => 1.0,
            Falloff::Table(id) => context.tables.profile(*id).peak(),
        };
        self.mean.weight * f64::from(peak * self.mean_coverage())
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

    /// What a point of the surface, chosen with density `pdf_w` per steradian, sends to `reference`.
    #[inline(always)]
    pub(super) fn towards(
        &self,
        context: &LightContext,
        s: &ShapeSample,
        pdf_w: f32,
        reference: &Reference,
        lambda: &Wavelengths,
    ) -> Option<LightSample> {
        let to_light = s.p - reference.p;
        let distance = to_light.length();
        let wi = to_light * (1.0 / distance);
        let le = self.le(context, s.n, s.uv, -wi, lambda) * self.coverage(context, s.p, s.n, s.uv);
        let is_valid = distance > 0.0 && pdf_w > 0.0 && pdf_w.is_finite();
        (is_valid && !le.is_black()).then_some(LightSample {
            wi,
            le,
            pdf_w,
            distance,
            is_delta: false,
            p_light: Some(LightPoint { p: s.p, p_error: s.p_error, n: Some(s.n), uv: s.uv }),
        })
    }

    /// A ray that leaves a point of the surface, in proportion to radiance times cosine.
    #[inline]
    pub(super) fn leaving(
        &self,
        context: &LightContext,
        s: &ShapeSample,
        mut u_direction: Point2,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        let mut side = 1.0;
        if self.two_sided {
            side = if u_direction.x < 0.5 { 1.0 } else { -1.0 };
            u_direction.x = (2.0 * u_direction.x).fract();
        }
        let local = self.sample_direction(context, u_direction);
        let w = Frame::from_z(s.n.as_vector() * side).to_world(local);
        let pdf_w = self.direction_pdf(context, local.z) / self.sides();
        let le = self.le(context, s.n, s.uv, w, lambda) * self.coverage(context, s.p, s.n, s.uv);
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

    /// A ray that leaves a point of the surface in the direction `w`, which is given: its `pdf_w` is 1.
    pub(super) fn leaving_towards(
        &self,
        context: &LightContext,
        s: &ShapeSample,
        w: Vector3,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        let cosine = s.n.dot_vector(w);
        let cosine = if self.two_sided { cosine.abs() } else { cosine };
        let le = self.le(context, s.n, s.uv, w, lambda) * self.coverage(context, s.p, s.n, s.uv);
        (cosine > 0.0 && s.pdf_a > 0.0 && !le.is_black()).then(|| EmittedRay {
            ray: Ray::new(s.p, w),
            p_error: s.p_error,
            n: Some(s.n),
            uv: s.uv,
            le,
            cosine,
            pdf_a: s.pdf_a,
            pdf_w: 1.0,
        })
    }

    /// True if radiance is the same in all directions.
    pub(super) const fn is_matte(&self) -> bool {
        matches!(self.falloff, Falloff::Even)
    }

    /// True if radiance depends on direction by a table, which may have details of any size.
    pub(super) const fn is_tabulated(&self) -> bool {
        matches!(self.falloff, Falloff::Table(_))
    }

    /// True if all rays of [`leaving`](Self::leaving) from points of one density carry the same flux.
    pub(super) const fn is_even(&self) -> bool {
        !self.varies() && !self.is_tabulated()
    }

    /// Density per steradian of [`leaving`](Self::leaving) at a cosine to the normal.
    pub(super) fn leaving_pdf(&self, context: &LightContext, cosine: f32) -> f32 {
        let cosine = if self.two_sided { cosine.abs() } else { cosine.max(0.0) };
        self.direction_pdf(context, cosine) / self.sides()
    }

    /// False if no ray meets the surface.
    pub(super) const fn is_visible(&self) -> bool {
        self.is_visible
    }

    /// From an `AreaLightSource`; `area_m2` is the area of the whole shape.
    pub(in crate::light) fn build(
        p: &mut Parameters,
        area_m2: f32,
        tables: &mut LightTables,
    ) -> Option<Self> {
        let two_sided = p.bool("twosided", false);
        let power = p.float("power", -1.0);
        let sides = if two_sided { 2.0 } else { 1.0 };
        let falloff = read_falloff(p, tables)?;
        let even = Self::uniform(Spectrum::Constant(1.0), two_sided, &p.context.spectra);
        let flux_per_radiance = Self { falloff, ..even }.projected_solid_angle() * sides * area_m2;
        if !p.has("filename") {
            let source = build::Source::read(p, "L");
            let radiance = match falloff {
                // The candela of the table, if nothing else is said.
                Falloff::Table(id) if power <= 0.0 && !p.has("L") => {
                    let lumens = tables.profile(id).lumens() * f64::from(sides);
                    source.with_luminance(p, lumens / f64::from(flux_per_radiance))
                }
                _ => source.spectrum(p, power, |l| l * f64::from(flux_per_radiance)),
            };
            return Some(Self { falloff, ..Self::uniform(radiance, two_sided, &p.context.spectra) });
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
        Some(Self { falloff, ..Self::pictured(id, tables.image(id), scale, two_sided, &p.context.spectra) })
    }
}

/// From `profile`, or `exponent` and `spreadangle`; `None` if there is an error.
fn read_falloff(p: &mut Parameters, tables: &mut LightTables) -> Option<Falloff> {
    if p.string_opt("profile").is_none() {
        return Some(Profile::read(p).map_or(Falloff::Even, Falloff::Cosine));
    }
    let span = p.span_of("profile");
    for other in ["exponent", "spreadangle"] {
        if p.has(other) {
            let span = p.span_of(other);
            let message = format!("\"{other}\" is ignored: the light has a \"profile\"");
            p.diagnostics().warning(span, message);
            p.ignore(other);
        }
    }
    let photometry = build::read_photometry(p, "profile")?;
    // Shapes may be many.
    if let Some(id) = tables.profile_of(&photometry) {
        return Some(Falloff::Table(id));
    }
    if photometry.varies_around_axis(0.05) {
        let message = "the luminaire's light depends on the angle around its axis; surfaces emit the mean";
        p.diagnostics().warning(span, message);
    }
    let Some(profile) = LuminousProfile::new(&photometry) else {
        p.diagnostics().error(span, "the luminaire emits no light in front of it");
        return None;
    };
    Some(Falloff::Table(tables.add_profile(profile)))
}
