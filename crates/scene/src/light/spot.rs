//! A point that emits into a cone, with a smooth edge.
//!
//! Intensity is full up to the angle `coneangle - conedeltaangle` from the axis, zero beyond `coneangle`, and between
//! them a cubic Hermite step *of the cosine*, as in pbrt-v4, so that the flux has a closed form:
//! Phi = 2 pi I ((1 - cos_start) + (cos_start - cos_end) / 2). The cone stays circular under any transform.

use std::f32::consts::PI;

use etendue_geometry::Reference;
use etendue_math::{Bounds3, Frame, Normal3, Point2, Point3, Ray, Transform, Vector3, safe_sqrt};
use etendue_spectrum::{Spectrum, Wavelengths};

use super::build::{self, spec};
use super::context::point_sample;
use super::{EmittedRay, LightBounds, LightContext, LightPower, LightSample};
use crate::parameters::{ParameterSpec, Parameters};

/// A spotlight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotLight {
    /// Position.
    pub p: Point3,
    /// Unit axis of the cone, away from the light.
    pub axis: Vector3,
    /// Cosine of the angle up to which intensity is full; at least `cos_end`.
    pub cos_start: f32,
    /// Cosine of the angle beyond which there is no light.
    pub cos_end: f32,
    /// Intensity along the axis.
    pub intensity: Spectrum,
}

/// Zero below `a`, one above `b`, a cubic between.
fn smooth_step(x: f32, a: f32, b: f32) -> f32 {
    if a >= b {
        return if x < a { 0.0 } else { 1.0 };
    }
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Solves 2 t^3 - t^4 = u, the distribution function of the smooth step, by bisection safeguarded Newton steps.
fn sample_smooth_step(u: f32) -> f32 {
    let (mut low, mut high) = (0.0_f32, 1.0_f32);
    let mut t = 0.5_f32;
    for _ in 0..24 {
        let value = t * t * t * (2.0 - t) - u;
        if value > 0.0 {
            high = t
        } else {
            low = t
        }
        let slope = t * t * (6.0 - 4.0 * t);
        let newton = t - value / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - t).abs() < 1e-7 {
            return next;
        }
        t = next;
    }
    t
}

impl SpotLight {
    /// Parameters in scene files.
    pub const PARAMETERS: &[ParameterSpec] = &[
        spec("I", "spectrum", "illuminant of the colour space", "cd", "intensity along the axis"),
        build::SCALE,
        build::POWER,
        spec("from", "point3", "0 0 0", "m", "position in the space of the light"),
        spec("to", "point3", "0 0 1", "m", "point on the axis"),
        spec("coneangle", "float", "30", "degree", "angle from the axis beyond which there is no light"),
        spec("conedeltaangle", "float", "5", "degree", "width of the soft edge within the cone"),
        super::LightUnits::PARAMETER,
    ];

    pub(super) fn build(p: &mut Parameters, world_from_light: &Transform) -> Option<Self> {
        let source = build::Source::read(p, "I");
        let from = p.point3("from", Point3::ORIGIN);
        let to = p.point3("to", Point3::new(0.0, 0.0, 1.0));
        let axis = build::direction(p, "to", world_from_light.vector(to - from))?;
        let cone = p.float("coneangle", 30.0).clamp(0.0, 180.0);
        let delta = p.float("conedeltaangle", 5.0).clamp(0.0, cone);
        let power = p.float("power", -1.0);
        let mut light = Self {
            p: world_from_light.point(from),
            axis,
            cos_start: (cone - delta).to_radians().cos(),
            cos_end: cone.to_radians().cos(),
            intensity: source.unit,
        };
        light.intensity = source.spectrum(p, power, |i| i * f64::from(light.solid_angle()));
        Some(light)
    }

    /// Flux divided by the intensity on the axis, in steradian.
    fn solid_angle(&self) -> f32 {
        2.0 * PI * ((1.0 - self.cos_start) + (self.cos_start - self.cos_end) / 2.0)
    }

    /// Share of the full intensity in the unit direction `w` away from the light.
    fn falloff(&self, w: Vector3) -> f32 {
        smooth_step(w.dot(self.axis), self.cos_end, self.cos_start)
    }

    pub(super) fn sample_li(
        &self,
        context: &LightContext,
        reference: &Reference,
        _u: Point2,
        lambda: &Wavelengths,
    ) -> Option<LightSample> {
        let falloff = self.falloff((reference.p - self.p).try_normalized()?);
        if falloff == 0.0 {
            return None;
        }
        point_sample(self.p, reference, self.intensity.sample(context.spectra, lambda) * falloff)
    }

    pub(super) const fn pdf_li(&self, _: &LightContext, _: &Reference, _: Vector3) -> f32 {
        0.0
    }

    pub(super) fn sample_le(
        &self,
        context: &LightContext,
        u_position: Point2,
        u_direction: Point2,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        let inner = 1.0 - self.cos_start;
        let edge = (self.cos_start - self.cos_end) / 2.0;
        let cos_theta = if u_position.x * (inner + edge) < inner || edge <= 0.0 {
            1.0 - u_direction.x * inner
        } else {
            self.cos_end + sample_smooth_step(u_direction.x) * (self.cos_start - self.cos_end)
        };
        let sin_theta = safe_sqrt(1.0 - cos_theta * cos_theta);
        let (sin_phi, cos_phi) = (2.0 * PI * u_direction.y).sin_cos();
        let local = Vector3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta);
        let w = Frame::from_z(self.axis).to_world(local);
        let falloff = smooth_step(cos_theta, self.cos_end, self.cos_start);
        let le = self.intensity.sample(context.spectra, lambda) * falloff;
        EmittedRay::from_point(self.p, w, le, falloff / self.solid_angle())
    }

    pub(super) fn emit_towards(
        &self,
        context: &LightContext,
        w: Vector3,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        let intensity = self.intensity.sample(context.spectra, lambda) * self.falloff(w);
        EmittedRay::from_point(self.p, w, intensity, 1.0)
    }

    pub(super) fn pdf_le(&self, _: &LightContext, ray: &Ray, _: Option<Normal3>) -> (f32, f32) {
        (0.0, self.falloff(ray.direction) / self.solid_angle())
    }

    pub(super) fn power(&self, context: &LightContext) -> LightPower {
        LightPower::of(&self.intensity, context.spectra) * f64::from(self.solid_angle())
    }

    pub(super) fn bounds(&self, context: &LightContext) -> Option<LightBounds> {
        let edge = self.cos_end.acos() - self.cos_start.acos();
        Some(LightBounds {
            bounds: Bounds3::new(self.p, self.p),
            w: self.axis,
            cos_theta_o: self.cos_start,
            cos_theta_e: edge.max(0.0).cos(),
            intensity: LightPower::of(&self.intensity, context.spectra).weight as f32,
            two_sided: false,
        })
    }
}
