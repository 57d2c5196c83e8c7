//! A point light with a measured distribution of intensity: a grey picture over the sphere of directions in the
//! equal-area layout of Clarberg 2008 ("Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD").
//!
//! As in pbrt-v4, y and z of the picture's space are exchanged, so that its pole is +y of the light. The transform
//! should keep angles: solid angles are not corrected for uneven scaling.

use std::f32::consts::PI;

use etendue_geometry::Reference;
use etendue_math::{
    Bounds2, Bounds3, Normal3, PiecewiseConstant2, Point2, Point3, Ray, Transform, Vector3, warp,
};
use etendue_spectrum::{Sampled, Spectrum, Wavelengths};

use super::build::{self, spec};
use super::context::point_sample;
use super::{EmittedRay, LightBounds, LightContext, LightPower, LightSample};
use crate::parameters::{ParameterSpec, Parameters};

/// Index of a goniometric light in [`LightTables`](super::LightTables).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct GoniometricLightId(pub u32);

/// A point light with a picture of relative intensity.
#[derive(Clone, Debug)]
pub struct GoniometricLight {
    p: Point3,
    /// From the picture's space.
    world_from_light: Transform,
    light_from_world: Transform,
    /// Intensity where the picture is 1.
    intensity: Spectrum,
    /// Texels in a row and rows of the picture.
    size: usize,
    /// Relative intensity, rows from the top.
    values: Vec<f32>,
    mean: f64,
    distribution: PiecewiseConstant2,
}

impl GoniometricLight {
    /// Parameters in scene files.
    pub const PARAMETERS: &[ParameterSpec] = &[
        spec("I", "spectrum", "illuminant of the colour space", "cd", "intensity where the picture is 1"),
        spec(
            "filename",
            "string",
            "",
            "",
            "square equal-area picture of relative intensity; isotropic if absent",
        ),
        build::SCALE,
        build::POWER,
        super::LightUnits::PARAMETER,
    ];

    /// A light whose relative intensities are a square equal-area picture of `size` x `size`; the spectrum is the
    /// intensity where the picture is 1.
    ///
    /// # Panics
    /// When there are not `size * size` values, or none.
    #[must_use]
    pub fn new(world_from_light: &Transform, intensity: Spectrum, size: usize, values: Vec<f32>) -> Self {
        assert!(size > 0, "a picture has at least one texel");
        assert_eq!(values.len(), size * size, "one value per texel");
        let swap_yz =
            [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
        let swap_yz = Transform::from_rows(swap_yz).expect("an exchange of axes has an inverse");
        let world_from_light = *world_from_light * swap_yz;
        let values: Vec<f32> = values.into_iter().map(|v| v.max(0.0)).collect();
        let mean = values.iter().map(|v| f64::from(*v)).sum::<f64>() / values.len() as f64;
        let domain = Bounds2::new(Point2::splat(0.0), Point2::splat(1.0));
        Self {
            p: world_from_light.point(Point3::ORIGIN),
            world_from_light,
            light_from_world: world_from_light.inverse(),
            intensity,
            size,
            distribution: PiecewiseConstant2::new(&values, size, size, domain),
            values,
            mean,
        }
    }

    pub(super) fn build(p: &mut Parameters, world_from_light: &Transform) -> Option<Self> {
        let source = build::Source::read(p, "I");
        let power = p.float("power", -1.0);
        let (size, values) = if p.has("filename") {
            let picture = build::read_square_picture(p)?;
            (picture.width, super::image::sampling_weights(&picture.rgb))
        } else {
            let span = p.span();
            let text = "a goniometric light without \"filename\" emits equally in all directions";
            p.diagnostics().warning(span, text);
            (1, vec![1.0])
        };
        let mut light = Self::new(world_from_light, source.unit, size, values);
        light.intensity = source.spectrum(p, power, |i| i * (f64::from(4.0 * PI) * light.mean));
        Some(light)
    }

    /// Relative intensity in a direction of the picture's space.
    fn relative(&self, w_light: Vector3) -> f32 {
        let uv = warp::equal_area_sphere_to_square(w_light);
        let cell = |t: f32| ((t * self.size as f32).max(0.0) as usize).min(self.size - 1);
        self.values[cell(uv.y) * self.size + cell(uv.x)]
    }

    fn to_light_space(&self, w: Vector3) -> Option<Vector3> {
        self.light_from_world.vector(w).try_normalized()
    }

    fn intensity_towards(&self, context: &LightContext, w: Vector3, lambda: &Wavelengths) -> Option<Sampled> {
        let relative = self.relative(self.to_light_space(w)?);
        (relative > 0.0).then(|| self.intensity.sample(context.spectra, lambda) * relative)
    }

    pub(super) fn sample_li(
        &self,
        context: &LightContext,
        reference: &Reference,
        _u: Point2,
        lambda: &Wavelengths,
    ) -> Option<LightSample> {
        let w = (reference.p - self.p).try_normalized()?;
        point_sample(self.p, reference, self.intensity_towards(context, w, lambda)?)
    }

    pub(super) const fn pdf_li(&self, _: &LightContext, _: &Reference, _: Vector3) -> f32 {
        0.0
    }

    pub(super) fn sample_le(
        &self,
        context: &LightContext,
        _u_position: Point2,
        u_direction: Point2,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        let (uv, pdf_uv) = self.distribution.sample(u_direction);
        let w = self.world_from_light.vector(warp::equal_area_square_to_sphere(uv)).try_normalized()?;
        let le = self.intensity_towards(context, w, lambda)?;
        EmittedRay::from_point(self.p, w, le, pdf_uv / (4.0 * PI))
    }

    pub(super) fn emit_towards(
        &self,
        context: &LightContext,
        w: Vector3,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        EmittedRay::from_point(self.p, w, self.intensity_towards(context, w, lambda)?, 1.0)
    }

    pub(super) fn pdf_le(&self, _: &LightContext, ray: &Ray, _: Option<Normal3>) -> (f32, f32) {
        let pdf_w = self
            .to_light_space(ray.direction)
            .map_or(0.0, |w| self.distribution.pdf(warp::equal_area_sphere_to_square(w)) / (4.0 * PI));
        (0.0, pdf_w)
    }

    pub(super) fn power(&self, context: &LightContext) -> LightPower {
        LightPower::of(&self.intensity, context.spectra) * (f64::from(4.0 * PI) * self.mean)
    }

    pub(super) fn bounds(&self, context: &LightContext) -> Option<LightBounds> {
        let intensity = LightPower::of(&self.intensity, context.spectra).weight * self.mean;
        Some(LightBounds::point(Bounds3::new(self.p, self.p), intensity))
    }
}
