//! A point that emits equally in all directions: E = Phi cos(theta) / (4 pi r^2) (SPEC EMI-1, RAD-6).

use std::f32::consts::PI;

use etendue_geometry::Reference;
use etendue_math::{Bounds3, Normal3, Point2, Point3, Ray, Transform, Vector3, warp};
use etendue_spectrum::{Spectrum, Wavelengths};

use super::build::{self, spec};
use super::context::point_sample;
use super::{EmittedRay, LightBounds, LightContext, LightPower, LightSample};
use crate::parameters::{ParameterSpec, Parameters};

/// A point light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    /// Position.
    pub p: Point3,
    /// Intensity.
    pub intensity: Spectrum,
}

impl PointLight {
    /// Parameters in scene files.
    pub const PARAMETERS: &[ParameterSpec] = &[
        spec("I", "spectrum", "illuminant of the colour space", "cd", "intensity"),
        build::SCALE,
        build::POWER,
        spec("from", "point3", "0 0 0", "m", "position in the space of the light"),
        super::LightUnits::PARAMETER,
    ];

    pub(super) fn build(p: &mut Parameters, world_from_light: &Transform) -> Self {
        let source = build::Source::read(p, "I");
        let from = p.point3("from", Point3::ORIGIN);
        let power = p.float("power", -1.0);
        let intensity = source.spectrum(p, power, |i| i * f64::from(4.0 * PI));
        Self { p: world_from_light.point(from), intensity }
    }

    pub(super) fn sample_li(
        &self,
        context: &LightContext,
        reference: &Reference,
        _u: Point2,
        lambda: &Wavelengths,
    ) -> Option<LightSample> {
        point_sample(self.p, reference, self.intensity.sample(context.spectra, lambda))
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
        let w = warp::sample_uniform_sphere(u_direction);
        EmittedRay::from_point(self.p, w, self.intensity.sample(context.spectra, lambda), 1.0 / (4.0 * PI))
    }

    pub(super) fn emit_towards(
        &self,
        context: &LightContext,
        w: Vector3,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        EmittedRay::from_point(self.p, w, self.intensity.sample(context.spectra, lambda), 1.0)
    }

    pub(super) const fn pdf_le(&self, _: &LightContext, _: &Ray, _: Option<Normal3>) -> (f32, f32) {
        (0.0, 1.0 / (4.0 * PI))
    }

    pub(super) fn power(&self, context: &LightContext) -> LightPower {
        LightPower::of(&self.intensity, context.spectra) * f64::from(4.0 * PI) // Phi = 4 pi I
    }

    pub(super) fn bounds(&self, context: &LightContext) -> Option<LightBounds> {
        let intensity = LightPower::of(&self.intensity, context.spectra).weight;
        Some(LightBounds::point(Bounds3::new(self.p, self.p), intensity))
    }
}
