//! Generalised cosine lobes, made to fit measurements (Lafortune, Foo, Torrance and Greenberg 1997, "Non-Linear
//! Approximation of Reflectance Functions").
//!
//! `f = k_d/pi + k_s sum_i max(0, C_x wo.x wi.x + C_y wo.y wi.y + C_z wo.z wi.z)^n` (SPEC BRDF-22). A lobe is Phong's
//! about the direction `C wo`, which may be off the mirror direction, and grow or shrink with its length. `C = (-1,
//! -1, 1)` is Phong's highlight without scale, `C_x = C_y` is isotropic, positive ones reflect back to the light.
//! Reciprocal; energy depends on the coefficients: [`Lafortune::greatest_albedo`] tells.

use std::f32::consts::{FRAC_1_PI, TAU};

use etendue_math::approx::{exp, ln, ln_1p};
use etendue_math::{Frame, Point2, Vector3};
use etendue_spectrum::Sampled;

use super::lobed::{self, Lobed, Shares};
use super::powers::{cosine_power, power_pdf_scale, sample_cosine_power};
use crate::bsdf::{Lobes, TransportMode};

/// One lobe.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LafortuneLobe {
    /// Along the first tangent.
    pub cx: f32,
    /// Along the second tangent.
    pub cy: f32,
    /// Along the normal.
    pub cz: f32,
    /// Exponent, at least 0.
    pub exponent: f32,
}

/// Lafortune's reflection in the shading frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lafortune {
    /// Diffuse albedo.
    pub kd: Sampled,
    /// Multiplies all lobes.
    pub ks: Sampled,
    /// The lobes; those whose coefficients are 0 do not count.
    pub lobes: [LafortuneLobe; 3],
}

/// The lobe as seen from one direction.
struct Axis {
    /// Where it points.
    axis: Vector3,
    /// Logarithm of its height.
    ln_height: f32,
    exponent: f32,
}

impl Axis {
    fn height_times_power(&self, wi: Vector3) -> f32 {
        let one_minus_cos = 0.5 * (self.axis - wi).length_squared();
        if one_minus_cos >= 1.0 {
            return 0.0;
        }
        exp(self.ln_height + self.exponent * ln_1p(-one_minus_cos)).min(f32::MAX)
    }

    /// Its integral without cosine and horizon.
    fn share(&self) -> f32 {
        exp(self.ln_height).min(1e30) * TAU / (self.exponent + 1.0)
    }
}

impl LafortuneLobe {
    fn axis(&self, wo: Vector3) -> Option<Axis> {
        let v = Vector3::new(self.cx * wo.x, self.cy * wo.y, self.cz * wo.z);
        let length2 = v.length_squared();
        (length2 > 0.0).then(|| Axis {
            axis: v / length2.sqrt(),
            ln_height: 0.5 * self.exponent * ln(length2),
            exponent: self.exponent,
        })
    }
}

impl Lafortune {
    fn axes(&self, wo: Vector3) -> impl Iterator<Item = Axis> {
        self.lobes.into_iter().filter_map(move |lobe| lobe.axis(wo))
    }

    /// The greatest albedo of the lobes alone for `ks` of 1, over directions on a grid: more than 1 makes light.
    #[must_use]
    pub fn greatest_albedo(lobes: [LafortuneLobe; 3]) -> f32 {
        const N_SAMPLES: u32 = 256;
        // Multiples of the powers of 1/g with g³ = g + 1 (Roberts 2018).
        const STEP: [f32; 2] = [0.754_877_7, 0.569_840_3];
        let model = Self { kd: Sampled::ZERO, ks: Sampled::ONE, lobes };
        let mean = |wo: Vector3| {
            let weight = |i: u32| {
                let u = STEP.map(|step| (0.5 + step * i as f32).fract());
                let u_component = (i as f32 + 0.5) / N_SAMPLES as f32;
                let point = Point2::new(u[0], u[1]);
                let sample =
                    lobed::sample(&model, wo, u_component, point, TransportMode::Radiance, Lobes::ALL);
                sample.map_or(0.0, |sample| sample.weight[0])
            };
            (0..N_SAMPLES).map(weight).sum::<f32>() / N_SAMPLES as f32
        };
        let directions = (0..10).flat_map(|i| [0.0_f32, 0.8, 1.57].map(|phi| (0.16 * i as f32, phi)));
        directions
            .map(|(theta, phi)| {
                let sin = theta.sin();
                mean(Vector3::new(sin * phi.cos(), sin * phi.sin(), theta.cos()))
            })
            .fold(0.0, f32::max)
    }
}

impl Lobed for Lafortune {
    fn diffuse(&self, _to: Vector3, _from: Vector3) -> Sampled {
        self.kd * FRAC_1_PI
    }

    fn glossy(&self, to: Vector3, from: Vector3) -> Sampled {
        self.ks * self.axes(to).map(|lobe| lobe.height_times_power(from)).sum::<f32>() // [SPEC BRDF-22]
    }

    fn shares(&self, wo: Vector3) -> Shares {
        let total: f32 = self.axes(wo).map(|lobe| lobe.share()).sum();
        // Never 0, so that the lobes present do not depend on the direction.
        let glossy = self.ks.max_value() * total.clamp(1e-3, 1.0);
        Shares { diffuse: self.kd.max_value(), glossy, mirror: 0.0 }
    }

    fn sample_glossy(&self, wo: Vector3, u_choice: f32, u: Point2) -> Option<Vector3> {
        let total: f32 = self.axes(wo).map(|lobe| lobe.share()).sum();
        let mut rest = u_choice * total;
        let chosen = self.axes(wo).find(|lobe| {
            rest -= lobe.share();
            rest < 0.0
        })?;
        Some(Frame::from_z(chosen.axis).to_world(sample_cosine_power(u, chosen.exponent)))
    }

    fn glossy_pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        let (mut total, mut sum) = (0.0, 0.0);
        for lobe in self.axes(wo) {
            total += lobe.share();
            let pdf = power_pdf_scale(lobe.exponent) * cosine_power(lobe.axis, wi, lobe.exponent);
            sum += lobe.share() * pdf;
        }
        if total > 0.0 { sum / total } else { 0.0 }
    }

    /// As Phong's, of the widest lobe.
    fn alpha(&self) -> f32 {
        let lobes = self.lobes.iter().filter(|lobe| (lobe.cx, lobe.cy, lobe.cz) != (0.0, 0.0, 0.0));
        lobes.map(|lobe| (0.5 / (lobe.exponent + 0.5)).sqrt()).fold(0.0, f32::max)
    }
}
