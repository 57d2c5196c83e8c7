//! Numbers and laws of reflection and refraction at a plane boundary.

use super::*;
use crate::bsdf::fresnel::*;

#[track_caller]
fn check(value: f32, expected: f32, tolerance: f32) {
    assert!((value - expected).abs() <= tolerance, "{value} is not {expected}");
}

/// The parallel part alone, to find where it vanishes.
fn parallel_amplitude(cos_i: f32, eta: f32) -> f32 {
    let cos_t = (1.0 - (1.0 - cos_i * cos_i) / (eta * eta)).sqrt();
    (eta * cos_i - cos_t) / (eta * cos_i + cos_t)
}

/// SPEC FRES-3: known reflectances of glass in air.
#[test]
fn dielectric_reflectances() {
    check(fresnel_dielectric(1.0, 1.5), 0.04, 1e-6);
    check(fresnel_dielectric(60.0_f32.to_radians().cos(), 1.5), 0.0892, 1e-4);
    check(fresnel_dielectric(1.0_f32.cos(), 1.5), 0.0775, 1e-4);
    check(fresnel_dielectric(1e-6, 1.5), 1.0, 1e-4);
    check(fresnel_dielectric(0.3, 1.0), 0.0, 1e-12);
    let ratio = (1.0 - 2.4_f32) / (1.0 + 2.4);
    check(fresnel_dielectric(1.0, 2.4), ratio * ratio, 1e-6);
}

/// SPEC FRES-3: at Brewster's angle, atan 1.5 = 56.31°, only perpendicular light is reflected.
#[test]
fn brewster_angle() {
    let angle = 1.5_f32.atan();
    check(angle.to_degrees(), 56.31, 0.01);
    check(parallel_amplitude(angle.cos(), 1.5), 0.0, 1e-6);
    // There the rest is ((1 - eta²) / (1 + eta²))² / 2.
    check(fresnel_dielectric(angle.cos(), 1.5), 0.5 * (1.25_f32 / 3.25).powi(2), 1e-6);
}

/// SPEC FRES-3: the boundary reflects the same from both sides, at angles that Snell's law relates.
#[test]
fn both_sides_reflect_alike() {
    for i in 1..90 {
        let cos_i = (i as f32).to_radians().cos();
        let cos_t = (1.0 - (1.0 - cos_i * cos_i) / 2.25).sqrt();
        check(fresnel_dielectric(-cos_t, 1.5), fresnel_dielectric(cos_i, 1.5), 2e-4);
    }
}

/// SPEC FRES-3: the complex equations contain the real ones, give (n-1)² + k² over (n+1)² + k² at normal incidence,
/// and 1 at grazing.
#[test]
fn conductor_reflectances() {
    for i in 0..90 {
        let cos = (i as f32).to_radians().cos();
        let reflected = fresnel_conductor(cos, Sampled::splat(1.5), Sampled::ZERO)[0];
        check(reflected, fresnel_dielectric(cos, 1.5), 1e-4);
    }
    let (eta, k) = (0.2_f32, 3.9_f32);
    let normal = ((eta - 1.0).powi(2) + k * k) / ((eta + 1.0).powi(2) + k * k);
    check(fresnel_conductor(1.0, Sampled::splat(eta), Sampled::splat(k))[0], normal, 1e-5);
    check(fresnel_conductor(0.0, Sampled::splat(eta), Sampled::splat(k))[0], 1.0, 1e-5);
    check(fresnel_conductor(0.0, Sampled::ONE, Sampled::ZERO)[0], 1.0, 0.0);
    check(fresnel_conductor(0.5, Sampled::ONE, Sampled::ZERO)[0], 0.0, 1e-6);
}

/// The complex equations in complex arithmetic, as they are usually printed.
#[test]
fn conductor_agrees_with_complex_arithmetic() {
    type Complex = (f64, f64);
    let mul = |a: Complex, b: Complex| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
    let div = |a: Complex, b: Complex| {
        let n = b.0 * b.0 + b.1 * b.1;
        ((a.0 * b.0 + a.1 * b.1) / n, (a.1 * b.0 - a.0 * b.1) / n)
    };
    let sqrt = |a: Complex| {
        let r = a.0.hypot(a.1);
        (((r + a.0) / 2.0).max(0.0).sqrt(), ((r - a.0) / 2.0).max(0.0).sqrt().copysign(a.1))
    };
    let norm = |a: Complex| a.0 * a.0 + a.1 * a.1;
    for (eta, k) in [(0.2, 3.9), (1.25, 2.2), (1.5, 0.01), (4.0, 0.5), (0.05, 0.02)] {
        for i in 0..=90 {
            let cos = f64::from(i).to_radians().cos();
            let n = (eta, k);
            let sin2_t = div((1.0 - cos * cos, 0.0), mul(n, n));
            let cos_t = sqrt((1.0 - sin2_t.0, -sin2_t.1));
            let n_cos = (n.0 * cos, n.1 * cos);
            let n_cos_t = mul(n, cos_t);
            let parallel =
                div((n_cos.0 - cos_t.0, n_cos.1 - cos_t.1), (n_cos.0 + cos_t.0, n_cos.1 + cos_t.1));
            let perpendicular = div((cos - n_cos_t.0, -n_cos_t.1), (cos + n_cos_t.0, n_cos_t.1));
            let expected = 0.5 * (norm(parallel) + norm(perpendicular));
            let value =
                fresnel_conductor(cos as f32, Sampled::splat(eta as f32), Sampled::splat(k as f32))[0];
            check(value, expected as f32, 3e-4);
        }
    }
}

/// SPEC FRES-4: Schlick's fit, its limits, and where it fails.
#[test]
fn schlick_reflectances() {
    check(fresnel_schlick(1.0, 1.5), 0.04, 1e-6);
    check(fresnel_schlick(0.0, 1.5), 1.0, 1e-6);
    check(fresnel_schlick(60.0_f32.to_radians().cos(), 1.5), 0.070, 5e-4);
    check(fresnel_schlick(1.0_f32.cos(), 1.5), 0.0597, 1e-4);
    check(fresnel_schlick(0.2, 1.0), 0.0, 0.0);
    check(fresnel_schlick(-50.0_f32.to_radians().cos(), 1.5), 1.0, 0.0);
    for i in 0..=90 {
        let cos = (i as f32).to_radians().cos();
        check(fresnel_schlick(cos, 1.5), fresnel_dielectric(cos, 1.5), 0.05);
    }
}

/// SPEC FRES-1: the mirror direction has the same angle, lies in the plane of incidence, and mirrors back.
#[test]
fn mirror_direction() {
    let mut rng = Rng::new(seed("mirror", 0), 0);
    for _ in 0..1000 {
        let (w, n) = (uniform_sphere(&mut rng), uniform_sphere(&mut rng));
        let r = reflect(w, n);
        check(r.dot(n), w.dot(n), 1e-5);
        check(w.cross(n).dot(r), 0.0, 1e-5);
        check((reflect(r, n) - w).length(), 0.0, 1e-5);
        check(r.length(), 1.0, 1e-5);
    }
}

/// SPEC FRES-5, FRES-7: refracted directions have unit length, obey Snell's law and stay in the plane of incidence.
#[test]
fn snell() {
    let mut rng = Rng::new(seed("snell", 0), 0);
    for _ in 0..1000 {
        let (w, n) = (uniform_sphere(&mut rng), uniform_sphere(&mut rng));
        let Some(refraction) = refract(w, n, 1.5) else {
            assert!(w.dot(n) < 0.0, "light that enters glass is always refracted");
            continue;
        };
        let t = refraction.wt;
        check(t.length(), 1.0, 1e-4);
        check(w.cross(n).length(), refraction.eta * t.cross(n).length(), 1e-4);
        check(w.cross(n).dot(t), 0.0, 1e-5);
        assert!(t.dot(n) * w.dot(n) < 0.0);
        assert_eq!(refraction.eta, if w.dot(n) > 0.0 { 1.5 } else { 1.0 / 1.5 });
    }
}

/// SPEC FRES-6: from glass nothing passes to air beyond 41.8°, and everything is reflected.
#[test]
fn total_reflection() {
    let critical = (1.0 / 1.5_f32).asin().to_degrees();
    check(critical, 41.8, 0.02);
    let from_below = |angle: f32| -direction(angle, 0.4);
    let up = Vector3::new(0.0, 0.0, 1.0);
    assert!(refract(from_below(critical - 0.1), up, 1.5).is_some());
    assert!(refract(from_below(critical + 0.1), up, 1.5).is_none());
    assert!(refract(from_below(50.0), up, 1.5).is_none());
    assert_eq!(fresnel_dielectric(from_below(50.0).z, 1.5), 1.0);
}

/// SPEC FRES-5: a slab with parallel faces displaces light but does not turn it; radiance is what it was.
#[test]
fn a_slab_restores_the_direction() {
    let glass = BsdfKind::Dielectric(glass(0.0, 0.0, 1.5));
    for angle in [0.0, 20.0, 60.0, 85.0] {
        let wo = direction(angle, 1.1);
        let u = Point2::new(0.5, 0.5);
        let first = glass.sample(wo, 0.5, u, TransportMode::Radiance, Lobes::TRANSMIT).unwrap();
        // The second face has its glass above: turn it over.
        let turned = |w: Vector3| Vector3::new(w.x, -w.y, -w.z);
        let inside = turned(-first.wi);
        let second = glass.sample(inside, 0.5, u, TransportMode::Radiance, Lobes::TRANSMIT).unwrap();
        check((turned(second.wi) + wo).length(), 0.0, 1e-5);
        let transmitted = 1.0 - fresnel_dielectric(wo.z, 1.5);
        check(first.weight[0] * 1.5 * 1.5, transmitted, 1e-5);
        check((first.weight * second.weight)[0], transmitted * transmitted, 2e-4);
        check(first.eta * second.eta, 1.0, 1e-6);
    }
}

/// SPEC FRES-8, FRES-2: a glass ball and a mirror ball in a white furnace are as bright as the furnace, whatever ways
/// light takes inside.
#[test]
fn glass_ball_in_a_white_furnace() {
    let glass = BsdfKind::Dielectric(glass(0.0, 0.0, 1.5));
    let mut rng = Rng::new(seed("ball", 0), 0);
    let mut n_inside = 0;
    for _ in 0..2000 {
        let mut n = uniform_sphere(&mut rng).as_normal();
        let mut wo = uniform_sphere(&mut rng);
        wo = if wo.dot_normal(n) < 0.0 { -wo } else { wo };
        let mut beta = 1.0;
        for _ in 0..200 {
            let bsdf = Bsdf::new(n, n, Vector3::new(1.0, 0.0, 0.0), glass);
            let u = Point2::new(0.5, 0.5);
            let sample = bsdf.sample(wo, rng.next_f32(), u, TransportMode::Radiance, Lobes::ALL).unwrap();
            beta *= sample.weight[0];
            if sample.wi.dot_normal(n) > 0.0 {
                check(beta, 1.0, 1e-3);
                break;
            }
            // The other end of the chord.
            n_inside += 1;
            let p = n.as_vector() - sample.wi * (2.0 * sample.wi.dot_normal(n));
            n = p.normalized().as_normal();
            wo = -sample.wi;
        }
    }
    assert!(n_inside > 1000);
}

/// SPEC FRES-9: choosing reflection or refraction has the mean of following both.
#[test]
fn stochastic_choice_has_the_mean_of_both() {
    let glass = BsdfKind::Dielectric(glass(0.0, 0.0, 1.5));
    let wo = direction(70.0, 0.0);
    let environment = |w: Vector3| 1.0 + f64::from(w.z) + 0.5 * f64::from(w.x);
    let both: f64 = [Lobes::REFLECT, Lobes::TRANSMIT]
        .map(|lobes| {
            let sample =
                glass.sample(wo, 0.5, Point2::new(0.5, 0.5), TransportMode::Importance, lobes).unwrap();
            assert_eq!(sample.pmf, 1.0);
            f64::from(sample.weight[0]) * environment(sample.wi)
        })
        .iter()
        .sum();
    let mut rng = Rng::new(seed("choice", 0), 0);
    let mut chosen = Moments::default();
    for _ in 0..50_000 {
        let sample = draw(&glass, wo, TransportMode::Importance, Lobes::ALL, &mut rng).unwrap();
        assert!(is_near(sample.weight[0], 1.0, 1e-5, 0.0), "no weight is needed");
        chosen.push(environment(sample.wi));
    }
    mean_test(&chosen, both, significance()).unwrap();
}
