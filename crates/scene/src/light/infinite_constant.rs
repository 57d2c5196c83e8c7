//! The same radiance L from all directions; a horizontal plane under it receives E = pi L (SPEC EMI-12).

use std::f32::consts::PI;

use etendue_geometry::Reference;
use etendue_math::{Normal3, Point2, Ray, Vector3, warp};
use etendue_spectrum::{Sampled, Spectrum, Wavelengths};

use super::build::{self, spec};
use super::context::infinite_sample;
use super::{EmittedRay, LightBounds, LightContext, LightPower, LightSample};
use crate::parameters::{ParameterSpec, Parameters};

const UNIFORM_SPHERE: f32 = 1.0 / (4.0 * PI);

/// A uniform environment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InfiniteConstantLight {
    /// Radiance.
    pub radiance: Spectrum,
}

impl InfiniteConstantLight {
    /// Parameters of all kinds of infinite light in scene files.
    pub const PARAMETERS: &[ParameterSpec] = &[
        spec("L", "spectrum", "illuminant of the colour space", "cd/m^2", "radiance, if no picture is given"),
        spec("filename", "string", "", "", "square equal-area picture of radiance over the sphere"),
        spec(
            "portal",
            "point3[4]",
            "",
            "m",
            "corners of a rectangle in world space through which light enters",
        ),
        build::SCALE,
        spec(
            "illuminance",
            "float",
            "",
            "lx",
            "illuminance of a plane facing +z of the light; replaces the size of L",
        ),
        super::LightUnits::PARAMETER,
    ];

    pub(super) fn build(p: &mut Parameters, source: &build::Source) -> Self {
        let illuminance = p.float("illuminance", -1.0);
        Self { radiance: source.spectrum(p, illuminance, |l| l * f64::from(PI)) } // E = pi L
    }

    pub(super) fn le(&self, context: &LightContext, lambda: &Wavelengths) -> Sampled {
        self.radiance.sample(context.spectra, lambda)
    }

    pub(super) fn sample_li(
        &self,
        context: &LightContext,
        _reference: &Reference,
        u: Point2,
        lambda: &Wavelengths,
    ) -> Option<LightSample> {
        infinite_sample(warp::sample_uniform_sphere(u), self.le(context, lambda), UNIFORM_SPHERE)
    }

    pub(super) const fn pdf_li(&self, _: &LightContext, _: &Reference, _: Vector3) -> f32 {
        UNIFORM_SPHERE
    }

    pub(super) fn sample_le(
        &self,
        context: &LightContext,
        u_position: Point2,
        u_direction: Point2,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        let w = warp::sample_uniform_sphere(u_direction);
        let le = self.le(context, lambda);
        EmittedRay::from_infinity(context.tables, w, u_position, le, UNIFORM_SPHERE)
    }

    pub(super) fn pdf_le(&self, context: &LightContext, ray: &Ray, _: Option<Normal3>) -> (f32, f32) {
        (context.tables.entry_pdf(ray.direction), UNIFORM_SPHERE)
    }

    pub(super) fn power(&self, context: &LightContext) -> LightPower {
        let area = context.tables.scene_sphere.cross_section();
        LightPower::of(&self.radiance, context.spectra) * f64::from(4.0 * PI * area)
    }

    pub(super) const fn bounds(&self, _: &LightContext) -> Option<LightBounds> {
        None
    }
}
