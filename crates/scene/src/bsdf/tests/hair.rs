//! Hair against the formulas as printed, in double precision.

use std::f64::consts::PI;

use super::*;
use crate::bsdf::fresnel::fresnel_dielectric;
use crate::bsdf::hair::HairRoughness;

const ETA: f32 = 1.55;

fn roughness(beta_m: f32, beta_n: f32, alpha_deg: f32) -> HairRoughness {
    HairRoughness { beta_m, beta_n, alpha_rad: alpha_deg.to_radians() }
}

/// I0 by its series.
fn bessel_i0(x: f64) -> f64 {
    let mut term = 1.0;
    let mut sum = 1.0;
    for i in 1..500 {
        term *= (0.5 * x / f64::from(i)).powi(2);
        sum += term;
    }
    sum
}

/// S of Chiang et al. 2016 as it is printed, for one absorption coefficient.
fn printed(wo: Vector3, wi: Vector3, h: f64, rough: HairRoughness, sigma_a: f64) -> f64 {
    let (bm, bn) = (f64::from(rough.beta_m), f64::from(rough.beta_n));
    let v0 = (0.726 * bm + 0.812 * bm.powi(2) + 3.7 * bm.powi(20)).powi(2);
    let s = (PI / 8.0).sqrt() * (0.265 * bn + 1.194 * bn.powi(2) + 5.372 * bn.powi(22));
    let (alpha, eta) = (f64::from(rough.alpha_rad), f64::from(ETA));
    let angles = |w: Vector3| (f64::from(w.x).asin(), f64::from(w.z).atan2(f64::from(w.y)));
    let ((theta_o, phi_o), (theta_i, phi_i)) = (angles(wo), angles(wi));
    let eta_disk = (eta.powi(2) - theta_o.sin().powi(2)).sqrt() / theta_o.cos();
    let (gamma_o, gamma_t) = (h.asin(), (h / eta_disk).asin());
    let theta_t = (theta_o.sin() / eta).asin();
    let t = (-sigma_a * 2.0 * gamma_t.cos() / theta_t.cos()).exp();
    let cos = theta_o.cos() * gamma_o.cos();
    let f = f64::from(fresnel_dielectric(cos as f32, ETA));
    let a = [f, (1.0 - f).powi(2) * t, (1.0 - f).powi(2) * t * t * f];
    let rest = a[2] * f * t / (1.0 - t * f);
    let m = |theta: f64, v: f64| {
        (-theta_i.sin() * theta.sin() / v).exp() * bessel_i0(theta_i.cos() * theta.cos() / v)
            / ((1.0 / v).sinh() * 2.0 * v)
    };
    let cdf = |x: f64| 1.0 / (1.0 + (-x / s).exp());
    let n = |p: f64| {
        let turn = 2.0 * p * gamma_t - 2.0 * gamma_o + p * PI;
        let x = (phi_i - phi_o - turn + PI).rem_euclid(2.0 * PI) - PI;
        (-x / s).exp() / (s * (1.0 + (-x / s).exp()).powi(2)) / (cdf(PI) - cdf(-PI))
    };
    m(theta_o - 2.0 * alpha, v0) * a[0] * n(0.0)
        + m(theta_o + alpha, v0 / 4.0) * a[1] * n(1.0)
        + m(theta_o + 4.0 * alpha, 4.0 * v0) * a[2] * n(2.0)
        + m(theta_o, 4.0 * v0) * rest / (2.0 * PI)
}

/// The model is the printed one, at any place and roughness that double precision can print.
#[test]
fn hair_is_as_printed() {
    let mut rng = Rng::new(seed("hair", 0), 0);
    for i in 0..2000 {
        // The tilts keep theta within a right angle.
        let rough = roughness(0.2 + 0.8 * rng.next_f32(), 0.1 + 0.9 * rng.next_f32(), 4.0 * rng.next_f32());
        let (h, sigma_a) = (1.9 * rng.next_f32() - 0.95, 2.0 * rng.next_f32());
        let kind = BsdfKind::Hair(Hair::new(h, rough, ETA, Sampled::splat(sigma_a)));
        let (wo, wi) = (uniform_sphere(&mut rng), uniform_sphere(&mut rng));
        let wo = if wo.z < 0.0 { -wo } else { wo };
        if wo.x.abs() > 0.95 {
            continue;
        }
        let f = kind.eval(wo, wi, TransportMode::Radiance, Lobes::ALL)[0];
        let expected = printed(wo, wi, f64::from(h), rough, f64::from(sigma_a)) as f32;
        assert!(is_near(f * wi.z.abs(), expected, 2e-3, 1e-6), "{i}: {} {expected}", f * wi.z.abs());
    }
}

/// What each direction sends out is what fibres of glass keep: by quadrature over all directions, by samples and in closed
/// form.
#[test]
fn hair_keeps_what_it_does_not_absorb() {
    for (sigma_a, h) in [(0.0, 0.0), (0.0, 0.9), (0.4, 0.5)] {
        let fibre = Hair::new(h, roughness(0.4, 0.5, 2.0), ETA, Sampled::splat(sigma_a));
        let kind = BsdfKind::Hair(fibre);
        for wo in [direction(20.0, 1.0), direction(70.0, 0.0), direction(130.0, 4.0)] {
            let f = |wi| f64::from(kind.eval(wo, wi, TransportMode::Radiance, Lobes::ALL)[0] * wi.z.abs());
            let (by_cubature, closed) = (integrate_sphere(f, 1e-4), f64::from(fibre.albedo(wo)[0]));
            assert!((by_cubature - closed).abs() < 1e-3, "{by_cubature} {closed}");
            assert!(sigma_a > 0.0 || (closed - 1.0).abs() < 1e-5, "{closed}");
        }
    }
}

/// Light cannot go back from a fibre that is seen at one place, but averages over its width come near: that is what
/// many fibres show.
#[test]
fn hair_is_reciprocal_in_the_mean_alone() {
    const N: usize = 201;
    let scattered = |wo: Vector3, wi: Vector3, i: usize| {
        let h = 2.0 * (i as f32 + 0.5) / N as f32 - 1.0;
        let fibre = Hair::new(h, roughness(0.5, 0.5, 2.0), ETA, Sampled::splat(0.2));
        fibre.eval(wo, wi, Lobes::ALL)[0] * wi.z.abs()
    };
    let mut rng = Rng::new(seed("hair", 1), 0);
    let (mut at_one_place, mut in_the_mean) = (Moments::default(), Moments::default());
    for _ in 0..200 {
        let (a, b) = (direction(80.0 * rng.next_f32(), 6.0 * rng.next_f32()), uniform_sphere(&mut rng));
        let difference = |x: f32, y: f32| f64::from((x - y).abs() / (x + y));
        let mean = |a, b| (0..N).map(|i| scattered(a, b, i)).sum::<f32>();
        at_one_place.push(difference(scattered(a, b, 20), scattered(b, a, 20)));
        in_the_mean.push(difference(mean(a, b), mean(b, a)));
    }
    let found = (at_one_place.mean(), in_the_mean.mean());
    assert!(found.0 > 0.2 && found.1 < 0.5 * found.0, "{found:?}");
}

/// Ribbons look the same from both sides: a highlight lies where the fibre faces it.
#[test]
fn hair_has_no_back() {
    let fibre = Hair::new(0.8, roughness(0.2, 0.2, 2.0), ETA, Sampled::splat(5.0));
    let kind = BsdfKind::Hair(fibre);
    let of = |w: Vector3| Vector3::new(w.x, w.y, -w.z);
    let (wo, wi) = (direction(10.0, 0.3), direction(60.0, 1.5));
    let f = |wo, wi| kind.eval(wo, wi, TransportMode::Radiance, Lobes::ALL)[0];
    assert!(is_near(f(wo, wi), f(of(wo), of(wi)), 1e-4, 0.0));
    // Light from the side on which it is seen is reflected, from the other it is not.
    let other = Vector3::new(wi.x, -wi.y, wi.z);
    assert!(f(wo, wi) > 10.0 * f(wo, other), "{} {}", f(wo, wi), f(wo, other));
}

/// Absorption makes it darker, and leaves the reflection at its surface.
#[test]
fn black_hair_shines() {
    let of = |sigma_a| Hair::new(0.2, roughness(0.3, 0.3, 2.0), ETA, Sampled::splat(sigma_a));
    let wo = direction(30.0, 1.0);
    let albedos = [0.0, 0.1, 1.0, 1e3, f32::MAX].map(|sigma_a| of(sigma_a).albedo(wo)[1]);
    assert!(albedos.is_sorted_by(|a, b| a >= b), "{albedos:?}");
    assert!(albedos[4] > 0.03 && albedos[4] < 0.1, "{albedos:?}");
}
