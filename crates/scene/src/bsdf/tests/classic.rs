//! The models of the literature: what each promises, and which laws some break, by how much.

use super::*;
use crate::bsdf::classic::*;

const RED: Sampled = Sampled::from_array([0.1, 0.2, 0.4, 0.5]);
const GREY: Sampled = Sampled::from_array([0.5, 0.4, 0.4, 0.3]);

fn phong(form: PhongForm, exponent: f32) -> BsdfKind {
    BsdfKind::Classic(Classic::Phong(Phong { kd: RED, ks: GREY, exponent, form }))
}

fn blinn(exponent: f32) -> BsdfKind {
    BsdfKind::Classic(Classic::BlinnPhong(BlinnPhong { kd: RED, ks: GREY, exponent }))
}

/// Albedo of one wavelength for light from or to `wo`, by quadrature of `eval`.
fn quadrature_albedo(kind: &BsdfKind, wo: Vector3, mode: TransportMode) -> f64 {
    let f = |wi: Vector3| f64::from(kind.eval(wo, wi, mode, Lobes::ALL)[0] * wi.z.max(0.0));
    integrate_sphere(f, 1e-3)
}

#[track_caller]
fn check(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value} is not {expected}");
}

/// A model of the table with a white highlight alone.
fn white_phong(form: PhongForm, exponent: f32) -> BsdfKind {
    BsdfKind::Classic(Classic::Phong(Phong { kd: Sampled::ZERO, ks: Sampled::ONE, exponent, form }))
}

/// SPEC BRDF-12, BRDF-13: a light of irradiance pi I shows `k_d cos + k_s cosⁿ alpha`, with 1 in the mirror direction and
/// 0 beyond 90° from it.
#[test]
fn phong_shows_his_equation() {
    let kind = phong(PhongForm::Illumination, 20.0);
    for (theta_i, theta_o) in [(0.0_f32, 0.0_f32), (30.0, 30.0), (30.0, 50.0), (80.0, 60.0), (80.0, -70.0)] {
        let (wi, wo) = (direction(theta_i, 0.0), direction(theta_o, std::f32::consts::PI));
        let shown = kind.eval(wo, wi, TransportMode::Radiance, Lobes::ALL)[0] * wi.z * std::f32::consts::PI;
        let alpha = (theta_o - theta_i).to_radians();
        let expected = 0.1 * wi.z + 0.5 * alpha.cos().max(0.0).powi(20);
        check(f64::from(shown), f64::from(expected), 1e-5);
    }
}

/// SPEC BRDF-13: what Phong's equation breaks. Its highlight shows an even surrounding `2 k_s / (n + 1)` times as bright along
/// the normal, twice for n = 0; of grazing light it makes more than arrives, 29 times at 89°; and exchanging both
/// directions changes it by the ratio of their cosines.
#[test]
fn phongs_equation_breaks_laws() {
    let normal = direction(0.0, 0.0);
    for n in [0.0_f32, 0.5, 1.0, 30.0] {
        let seen =
            quadrature_albedo(&white_phong(PhongForm::Illumination, n), normal, TransportMode::Radiance);
        check(seen, 2.0 / (f64::from(n) + 1.0), 2e-3);
    }
    let grazing = direction(89.0, 0.3);
    let kind = white_phong(PhongForm::Illumination, 0.0);
    check(quadrature_albedo(&kind, grazing, TransportMode::Importance), 29.13, 0.1);
    let (a, b) = (direction(20.0, 0.0), direction(70.0, 3.0));
    let f = |to, from| f64::from(kind.eval(to, from, TransportMode::Radiance, Lobes::ALL)[0]);
    check(f(a, b) / f(b, a), f64::from(a.z / b.z), 1e-3);
}

/// SPEC BRDF-14, BRDF-15: normalised highlights reflect k_s along the normal, and less elsewhere.
#[test]
fn normalised_highlights_reflect_their_strength() {
    for n in [0.0, 1.0, 10.0, 300.0] {
        let lewis = white_phong(PhongForm::Lewis, n);
        let blinn = BlinnPhong { kd: Sampled::ZERO, ks: Sampled::ONE, exponent: n };
        for kind in [lewis, BsdfKind::Classic(Classic::BlinnPhong(blinn))] {
            let albedo =
                |angle: f32| quadrature_albedo(&kind, direction(angle, 0.3), TransportMode::Radiance);
            check(albedo(0.0), 1.0, 3e-3);
            assert!(albedo(60.0) < 1.001 && albedo(85.0) < albedo(60.0) + 1e-3, "{kind:?}");
        }
    }
}

/// SPEC BRDF-15: Blinn's highlight with four times the exponent falls off as Phong's: the half vector turns half as far.
#[test]
fn blinn_needs_four_times_the_exponent() {
    let wi = direction(30.0, 0.0);
    for offset in [2.0_f32, 5.0, 10.0] {
        let wo = direction(30.0 + offset, std::f32::consts::PI);
        let mirror = direction(30.0, std::f32::consts::PI);
        let fall = |kind: BsdfKind| {
            let f = |w| kind.eval(w, wi, TransportMode::Radiance, Lobes::GLOSSY)[0];
            f64::from(f(wo) / f(mirror))
        };
        check(fall(blinn(400.0)), fall(phong(PhongForm::Lewis, 100.0)), 0.01);
    }
}

/// SPEC BRDF-9, LPE-5: samples that are named after a lobe carry, in the mean, what that lobe reflects.
#[test]
fn samples_are_named_by_what_lobes_reflect() {
    for row in configurations().iter().filter(|row| row.kind.lobes().has_non_specular()) {
        let wo = direction(50.0, 0.4);
        let mut rng = Rng::new(seed(row.name, 60), 0);
        let mut named = [Moments::default(); 2];
        for _ in 0..20_000 {
            let sample = draw(&row.kind, wo, TransportMode::Radiance, Lobes::NON_SPECULAR, &mut rng);
            for (moments, lobe) in named.iter_mut().zip([Lobes::DIFFUSE_REFLECT, Lobes::GLOSSY_REFLECT]) {
                let carried = sample.filter(|s| s.lobe == lobe).map_or(0.0, |s| s.weight.average());
                moments.push(f64::from(carried));
            }
        }
        for (moments, lobe) in named.iter().zip([Lobes::DIFFUSE_REFLECT, Lobes::GLOSSY_REFLECT]) {
            let f = |wi: Vector3| {
                let f = row.kind.eval(wo, wi, TransportMode::Radiance, lobe);
                f64::from(f.average() * wi.z.max(0.0))
            };
            let expected = integrate_sphere(f, 1e-3);
            let noise = 4.5 * moments.standard_error() + 3e-3;
            assert!((moments.mean() - expected).abs() < noise, "{}: {} {expected}", row.name, moments.mean());
        }
    }
}
