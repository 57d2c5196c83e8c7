//! Brushed metal as rows of parallel cylinders (Poulin and Fournier 1990, "A Model for Anisotropic Reflection").
//!
//! Cylinders of radius 1 lie along the first tangent, `spacing` apart, and rise by `height` above a flat floor (SPEC
//! BRDF-20). In the plane across them a facet at the angle `a` from the top has the normal `n(a)`. Each reflects as
//! Blinn's model `b(n) = k_d/pi + k_s c (n·h)ⁿ`, as far as it is seen and lit past its neighbours along straight
//! lines: `f = 1/(spacing cos_o cos_i) (∫ b(n(a)) (n(a)·wo) (n(a)·wi) da + floor b(n) cos_o cos_i)` over the angles,
//! and the width of floor, that are both seen and lit. What bounces between cylinders is lost.
//!
//! Reciprocal, and no brighter than Blinn's model. The integral over the highlight is Gauss's of 16 points where
//! `(n·h)ⁿ` is not negligible; all others are exact. Directions below 0.006° count as at 0.006°.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_2};

use etendue_math::approx::{asin, atan2, exp, ln_1p};
use etendue_math::{Frame, Point2, Vector3, sqr};
use etendue_spectrum::Sampled;

use super::lobed::{Lobed, Shares};
use super::powers::{
    alpha_of_exponent, blinn_scale, half_vector, height_power, power_pdf_scale, sample_cosine_power,
    widened_exponent,
};
use crate::bsdf::fresnel::reflect;

/// Grooved metal in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoulinFournier {
    /// Diffuse albedo of the material.
    pub kd: Sampled,
    /// Strength of its highlight.
    pub ks: Sampled,
    /// Exponent of the highlight, at least 0.
    pub exponent: f32,
    /// Distance of neighbouring axes in radii, more than 0. Below 2 the cylinders meet.
    pub spacing: f32,
    /// How far a cylinder rises above the floor, in radii, in [0, 1].
    pub height: f32,
}

/// An interval; empty if `end <= start`.
#[derive(Clone, Copy, Debug)]
struct Interval {
    start: f32,
    end: f32,
}

impl Interval {
    fn and(self, other: Self) -> Self {
        Self { start: self.start.max(other.start), end: self.end.min(other.end) }
    }

    fn length(self) -> f32 {
        (self.end - self.start).max(0.0)
    }

    fn mirrored_about(self, center: f32) -> Self {
        Self { start: 2.0 * center - self.end, end: 2.0 * center - self.start }
    }
}

/// What is seen from one direction, in the plane across the cylinders.
#[derive(Clone, Copy, Debug)]
struct View {
    /// Angle from the normal.
    psi: f32,
    cos_psi: f32,
    /// Angles of the cylinder.
    arc: Interval,
    /// Places on the floor, from one axis to the next.
    floor: Interval,
}

impl View {
    /// Width of the arc as seen: `∫ cos(a - psi) da`.
    fn seen_arc(&self) -> f32 {
        if self.arc.end <= self.arc.start {
            return 0.0;
        }
        (self.arc.end - self.psi).sin() - (self.arc.start - self.psi).sin()
    }

    /// Width of the floor as seen.
    fn seen_floor(&self) -> f32 {
        self.floor.length() * self.cos_psi
    }
}

impl PoulinFournier {
    /// With a wider highlight.
    pub(super) fn regularized(self) -> Self {
        Self { exponent: widened_exponent(self.exponent), ..self }
    }

    /// Half the angle that a cylinder spans above the floor, or above the valley with its neighbour.
    fn half_angle(&self) -> f32 {
        let to_floor = FRAC_PI_2 - asin(1.0 - self.height);
        to_floor.min(asin((0.5 * self.spacing).min(1.0)))
    }

    /// What is seen from `w`, past the neighbour on its side.
    fn view(&self, w: Vector3) -> View {
        const GRAZING: f32 = 1e-4;
        let psi = atan2(w.y, w.z).clamp(GRAZING - FRAC_PI_2, FRAC_PI_2 - GRAZING);
        let (slant, cos_psi) = (psi.abs(), psi.cos());
        let (half, d) = (self.half_angle(), self.spacing);
        let (edge, level) = (half.sin(), half.cos());
        let (mut arc, mut floor) = (
            Interval { start: (-half).max(slant - FRAC_PI_2), end: half },
            Interval { start: edge, end: d - edge },
        );
        if slant > FRAC_PI_2 - half {
            // The neighbour's outline hides what is behind the line that touches it.
            let outline = d * cos_psi - 1.0;
            arc.end = half.min(slant + asin(outline.clamp(-1.0, 1.0)));
            floor.end = floor.end.min((outline + level * slant.sin()) / cos_psi);
        }
        if psi < 0.0 {
            arc = arc.mirrored_about(0.0);
            floor = floor.mirrored_about(0.5 * d);
        }
        View { psi, cos_psi, arc, floor }
    }

    /// `∫ g(a) (n(a)·h)ⁿ da` over an interval, by Gauss's rule where the power is not negligible.
    fn integrate_power(&self, h: Vector3, over: Interval, g: impl Fn(f32) -> f32) -> f32 {
        let n = self.exponent;
        let center = atan2(h.y, h.z);
        let reach = (5.0 / (n + 1.0).sqrt()).min(FRAC_PI_2);
        let near = over.and(Interval { start: center - reach, end: center + reach });
        let half = 0.5 * near.length();
        if half == 0.0 {
            return 0.0;
        }
        let middle = 0.5 * (near.start + near.end);
        // (n·h)ⁿ = (1 - h.x²)^(n/2) cosⁿ(a - center).
        let power = |a: f32| g(a) * exp(0.5 * n * ln_1p(-sqr((a - center).sin()).min(1.0 - 1e-7)));
        let sum: f32 = GAUSS_16
            .iter()
            .map(|(x, weight)| weight * (power(middle - half * x) + power(middle + half * x)))
            .sum();
        half * sum * exp(0.5 * n * ln_1p(-sqr(h.x).min(1.0 - 1e-7)))
    }
}

/// Half of the places and weights of Gauss's rule of 16 points in [-1, 1], which is symmetric.
const GAUSS_16: [(f32, f32); 8] = [
    (0.095_012_51, 0.189_450_61),
    (0.281_603_55, 0.182_603_42),
    (0.458_016_78, 0.169_156_52),
    (0.617_876_24, 0.149_595_99),
    (0.755_404_41, 0.124_628_97),
    (0.865_631_2, 0.095_158_51),
    (0.944_575_02, 0.062_253_52),
    (0.989_400_93, 0.027_152_46),
];

/// The normal of a cylinder at an angle from its top.
fn normal_at(a: f32) -> Vector3 {
    Vector3::new(0.0, a.sin(), a.cos())
}

impl Lobed for PoulinFournier {
    fn diffuse(&self, to: Vector3, from: Vector3) -> Sampled {
        let (o, i) = (self.view(to), self.view(from));
        let arc = o.arc.and(i.arc);
        // ∫ cos(a - psi_o) cos(a - psi_i) da.
        let primitive = |a: f32| 0.5 * a * (o.psi - i.psi).cos() + 0.25 * (2.0 * a - o.psi - i.psi).sin();
        let on_arc = if arc.length() > 0.0 { primitive(arc.end) - primitive(arc.start) } else { 0.0 };
        let scale = (on_arc / (o.cos_psi * i.cos_psi) + o.floor.and(i.floor).length()) / self.spacing;
        self.kd * (FRAC_1_PI * scale.max(0.0))
    }

    fn glossy(&self, to: Vector3, from: Vector3) -> Sampled {
        let Some(h) = half_vector(to, from) else { return Sampled::ZERO };
        let (o, i) = (self.view(to), self.view(from));
        let seen = |a: f32| (a - o.psi).cos().max(0.0) * (a - i.psi).cos().max(0.0);
        let on_arc = self.integrate_power(h, o.arc.and(i.arc), seen) / (o.cos_psi * i.cos_psi);
        let on_floor = o.floor.and(i.floor).length() * height_power(h, self.exponent);
        self.ks * (blinn_scale(self.exponent) * (on_arc + on_floor) / self.spacing)
    }

    fn shares(&self, _wo: Vector3) -> Shares {
        Shares { diffuse: self.kd.max_value(), glossy: self.ks.max_value(), mirror: 0.0 }
    }

    /// A place that is seen from `wo`, then a half vector about its normal.
    fn sample_glossy(&self, wo: Vector3, u_choice: f32, u: Point2) -> Option<Vector3> {
        let view = self.view(wo);
        let arc = view.seen_arc();
        let place = u_choice * (arc + view.seen_floor());
        let half = sample_cosine_power(u, self.exponent);
        let h = if place < arc {
            let height = (view.arc.start - view.psi).sin() + place;
            Frame::from_z(normal_at(view.psi + asin(height.clamp(-1.0, 1.0)))).to_world(half)
        } else {
            half
        };
        (wo.dot(h) > 0.0).then(|| reflect(wo, h))
    }

    fn glossy_pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        let Some(h) = half_vector(wo, wi) else { return 0.0 };
        let view = self.view(wo);
        let on_arc = self.integrate_power(h, view.arc, |a| (a - view.psi).cos().max(0.0));
        let (arc, floor) = (view.seen_arc(), view.seen_floor());
        let on_floor = floor * height_power(h, self.exponent);
        if arc + floor <= 0.0 {
            return 0.0;
        }
        power_pdf_scale(self.exponent) * (on_arc + on_floor) / ((arc + floor) * 4.0 * wo.dot(h))
    }

    fn alpha(&self) -> f32 {
        alpha_of_exponent(self.exponent)
    }
}
