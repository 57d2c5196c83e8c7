//! The sun's disc: what of its light gets through the air, from a cone of 0.2666 degrees, darker towards the edge (limb
//! darkening by Hestroffer and Magnan 1998).
//!
//! The disc does not set bit by bit: it shines while its centre is above the horizon by more than -0.27 degrees.

use std::f32::consts::{PI, TAU};

use etendue_geometry::Reference;
use etendue_math::{Frame, Normal3, Point2, Ray, Vector3, warp};
use etendue_spectrum::atmosphere::{SUN_RADIUS_DEGREES, limb_darkening_exponent};
use etendue_spectrum::{Sampled, Spectrum, SpectrumTables, Wavelengths, photometry};

use super::dome::Atmosphere;
use crate::light::context::infinite_sample;
use crate::light::{EmittedRay, LightBounds, LightContext, LightPower, LightSample};

/// The limb darkening of paths that carry bands: that at 550 nm.
const BAND_NM: f32 = 550.0;

/// The disc of the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunLight {
    /// Unit direction from the scene to the centre of the disc.
    to_sun: Vector3,
    /// Irradiance on a plane that faces the disc.
    irradiance: Spectrum,
}

/// Sine of the disc's angular radius.
fn sin_radius() -> f32 {
    (SUN_RADIUS_DEGREES as f32).to_radians().sin()
}

/// 1 - cos of the disc's angular radius.
fn one_minus_cos() -> f32 {
    let s = sin_radius();
    s * s / (1.0 + (1.0 - s * s).sqrt())
}

/// Density per steradian of directions that light is emitted by, where the sine of the angle to the centre is `sine`.
fn emitted_pdf(sine: f32) -> f32 {
    let ratio = sine / sin_radius();
    let alpha = limb_darkening_exponent(BAND_NM);
    let limb = (1.0 - ratio * ratio).max(0.0).powf(alpha / 2.0) * (2.0 + alpha) / 2.0;
    limb * (1.0 - sine * sine).sqrt() / (PI * sin_radius() * sin_radius())
}

impl SunLight {
    /// The sun in a direction of the world, seen through that air, `scale` times as bright.
    pub(super) fn new(to_sun: Vector3, air: &Atmosphere, scale: f32, spectra: &mut SpectrumTables) -> Self {
        let table = spectra.add_dense(|nm| photometry::K_M * air.sunlight(f64::from(nm)) as f32);
        let irradiance = Spectrum::table(table, spectra).as_light(spectra).scaled(scale);
        Self { to_sun, irradiance }
    }

    /// Illuminance on a plane that faces the disc, as a flux per square metre.
    #[must_use]
    pub fn normal_irradiance(&self, context: &LightContext) -> LightPower {
        LightPower::of(&self.irradiance, context.spectra)
    }

    /// Radiance where the sine of the angle to the centre is `sine`.
    fn radiance(&self, context: &LightContext, sine: f32, lambda: &Wavelengths) -> Sampled {
        let ratio = sine / sin_radius();
        let mu = (1.0 - ratio * ratio).max(0.0).sqrt();
        let exponents = if lambda.is_bands() { [BAND_NM; 4] } else { lambda.lambda_nm() };
        // Of mu^alpha over the disc the mean is 2 / (2 + alpha).
        let limb = exponents.map(|nm| {
            let alpha = limb_darkening_exponent(nm);
            mu.powf(alpha) * (2.0 + alpha) / 2.0
        });
        let solid_angle = PI * sin_radius() * sin_radius();
        self.irradiance.sample(context.spectra, lambda) * Sampled::from_array(limb) * (1.0 / solid_angle)
    }

    /// Sine of the angle to the centre, where the direction meets the disc.
    fn sine_within(&self, w: Vector3) -> Option<f32> {
        // The cross product is exact where the cosine is not.
        let sine = w.cross(self.to_sun).length();
        (sine < sin_radius() && w.dot(self.to_sun) > 0.0).then_some(sine)
    }

    pub(in crate::light) fn le(
        &self,
        context: &LightContext,
        direction: Vector3,
        lambda: &Wavelengths,
    ) -> Sampled {
        self.sine_within(direction).map_or(Sampled::ZERO, |sine| self.radiance(context, sine, lambda))
    }

    fn sample_direction(&self, u: Point2) -> Vector3 {
        Frame::from_z(self.to_sun).to_world(warp::sample_narrow_cone(u, one_minus_cos()))
    }

    pub(in crate::light) fn sample_li(
        &self,
        context: &LightContext,
        _reference: &Reference,
        u: Point2,
        lambda: &Wavelengths,
    ) -> Option<LightSample> {
        let wi = self.sample_direction(u);
        infinite_sample(wi, self.le(context, wi, lambda), warp::narrow_cone_pdf(one_minus_cos()))
    }

    pub(in crate::light) fn pdf_li(&self, _: &LightContext, _: &Reference, wi: Vector3) -> f32 {
        self.sine_within(wi).map_or(0.0, |_| warp::narrow_cone_pdf(one_minus_cos()))
    }

    pub(in crate::light) fn sample_le(
        &self,
        context: &LightContext,
        u_position: Point2,
        u_direction: Point2,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        // By brightness at 550 nm: of mu^alpha over the disc the share up to mu is mu^(2 + alpha).
        let mu = u_direction.x.powf(1.0 / (2.0 + limb_darkening_exponent(BAND_NM)));
        let sine = sin_radius() * (1.0 - mu * mu).max(0.0).sqrt();
        let (y, x) = (TAU * u_direction.y).sin_cos();
        let local = Vector3::new(sine * x, sine * y, (1.0 - sine * sine).sqrt());
        let wi = Frame::from_z(self.to_sun).to_world(local);
        let le = self.radiance(context, sine, lambda);
        EmittedRay::from_infinity(context.tables, -wi, u_position, le, emitted_pdf(sine))
    }

    pub(in crate::light) fn pdf_le(
        &self,
        context: &LightContext,
        ray: &Ray,
        _: Option<Normal3>,
    ) -> (f32, f32) {
        let pdf_w = self.sine_within(-ray.direction).map_or(0.0, emitted_pdf);
        (context.tables.entry_pdf(ray.direction), pdf_w)
    }

    pub(in crate::light) fn power(&self, context: &LightContext) -> LightPower {
        self.normal_irradiance(context) * f64::from(context.tables.scene_sphere.cross_section())
    }

    pub(in crate::light) const fn bounds(&self, _: &LightContext) -> Option<LightBounds> {
        None
    }
}
