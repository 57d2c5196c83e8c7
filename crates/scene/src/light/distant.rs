//! Parallel light from one direction, as from the sun: irradiance E on a facing plane, wherever and however large the
//! scene is (SPEC EMI-7).

use etendue_geometry::Reference;
use etendue_math::{Normal3, Point2, Point3, Ray, Transform, Vector3};
use etendue_spectrum::{Spectrum, Wavelengths};

use super::build::{self, spec};
use super::{EmittedRay, LightBounds, LightContext, LightPower, LightSample};
use crate::parameters::{ParameterSpec, Parameters};

/// A light so far away that its rays are parallel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistantLight {
    /// Unit direction from the scene to the light.
    pub to_light: Vector3,
    /// Irradiance on a plane that faces the light.
    pub irradiance: Spectrum,
}

impl DistantLight {
    /// Parameters in scene files.
    pub const PARAMETERS: &[ParameterSpec] = &[
        spec(
            "L",
            "spectrum",
            "illuminant of the colour space",
            "lx",
            "irradiance on a plane that faces the light",
        ),
        build::SCALE,
        build::ILLUMINANCE,
        spec("from", "point3", "0 0 0", "m", "light comes from here ..."),
        spec("to", "point3", "0 0 1", "m", "... towards this point"),
        super::LightUnits::PARAMETER,
    ];

    pub(super) fn build(p: &mut Parameters, world_from_light: &Transform) -> Option<Self> {
        let source = build::Source::read(p, "L");
        let from = p.point3("from", Point3::ORIGIN);
        let to = p.point3("to", Point3::new(0.0, 0.0, 1.0));
        let to_light = build::direction(p, "to", world_from_light.vector(from - to))?;
        let illuminance = p.float("illuminance", -1.0);
        Some(Self { to_light, irradiance: source.spectrum(p, illuminance, |e| e) })
    }

    pub(super) fn sample_li(
        &self,
        context: &LightContext,
        _reference: &Reference,
        _u: Point2,
        lambda: &Wavelengths,
    ) -> Option<LightSample> {
        let le = self.irradiance.sample(context.spectra, lambda);
        (!le.is_black()).then_some(LightSample {
            wi: self.to_light,
            le,
            pdf_w: 1.0,
            distance: f32::INFINITY,
            is_delta: true,
            p_light: None,
        })
    }

    pub(super) const fn pdf_li(&self, _: &LightContext, _: &Reference, _: Vector3) -> f32 {
        0.0
    }

    pub(super) fn sample_le(
        &self,
        context: &LightContext,
        u_position: Point2,
        _u_direction: Point2,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        let le = self.irradiance.sample(context.spectra, lambda);
        EmittedRay::from_infinity(context.tables, -self.to_light, u_position, le, 1.0)
    }

    pub(super) fn pdf_le(&self, context: &LightContext, _: &Ray, _: Option<Normal3>) -> (f32, f32) {
        (context.tables.entry_pdf(-self.to_light), 0.0)
    }

    pub(super) fn power(&self, context: &LightContext) -> LightPower {
        let area = context.tables.scene_sphere.cross_section();
        LightPower::of(&self.irradiance, context.spectra) * f64::from(area)
    }

    pub(super) const fn bounds(&self, _: &LightContext) -> Option<LightBounds> {
        None
    }
}
