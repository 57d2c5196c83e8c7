//! Approximations against double precision, over every 2039th bit pattern, or every 61st if `ETENDUE_SLOW` is set.

use super::*;

/// Floats from `low` to `high`, both of one sign; the last always.
fn sweep(low: f32, high: f32) -> impl Iterator<Item = f32> {
    let stride = if std::env::var_os("ETENDUE_SLOW").is_some() { 61 } else { 2039 };
    let (a, b) = (low.to_bits(), high.to_bits());
    (a.min(b)..=a.max(b)).step_by(stride).chain([a.max(b)]).map(f32::from_bits)
}

/// Error in units of the distance between neighbouring floats at the exact result.
fn ulp_error(actual: f32, exact: f64) -> f64 {
    let nearest = exact as f32;
    if actual == nearest || (actual.is_nan() && exact.is_nan()) {
        return 0.0;
    }
    let ulp = f64::from(nearest.abs().next_up()) - f64::from(nearest.abs());
    (f64::from(actual) - exact).abs() / ulp
}

#[track_caller]
fn check(
    arguments: impl Iterator<Item = f32>,
    f: impl Fn(f32) -> f32,
    exact: impl Fn(f64) -> f64,
    bound: f64,
) {
    let (mut worst, mut at) = (0.0, 0.0);
    for x in arguments {
        let error = ulp_error(f(x), exact(f64::from(x)));
        if error.is_nan() || error > worst {
            (worst, at) = (error, x);
        }
    }
    assert!(worst <= bound, "{worst} ulp at {at:e}: {:e} instead of {:e}", f(at), exact(f64::from(at)));
}

/// The whole turn, from both sides, within 1.23e-7, the worst of all arguments; quarters exactly; results are nearly of length 1.
#[test]
fn sine_and_cosine_of_turns() {
    let (mut worst, mut worst_length) = (0.0_f64, 0.0_f64);
    for u in sweep(0.0, 1.0).chain(sweep(-0.0, -1.0)) {
        let (sin, cos) = sin_cos_turns(u);
        let (s, c) = (std::f64::consts::TAU * f64::from(u)).sin_cos();
        worst = worst.max((f64::from(sin) - s).abs()).max((f64::from(cos) - c).abs());
        let length = f64::from(sin) * f64::from(sin) + f64::from(cos) * f64::from(cos);
        worst_length = worst_length.max((length - 1.0).abs());
    }
    assert!(worst < 1.23e-7, "{worst:e}");
    // 2 (|sin| + |cos|) times that.
    assert!(worst_length < 3.5e-7, "{worst_length:e}");
    for (u, expected) in [(0.0, (0.0, 1.0)), (0.25, (1.0, 0.0)), (0.5, (0.0, -1.0)), (0.75, (-1.0, 0.0))] {
        assert_eq!(sin_cos_turns(u), expected, "{u}");
        assert_eq!(sin_cos_turns(u + 12345.0), expected, "{u}");
    }
    // The sine keeps its relative precision near 0.
    check(sweep(1e-30, 0.125), |u| sin_cos_turns(u).0, |u| (std::f64::consts::TAU * u).sin(), 2.5);
}

/// Angles in all octants and on their borders.
#[test]
fn angles_of_vectors() {
    let f = |x: f32, y: f32| {
        move |(sx, sy, swap): (f32, f32, bool)| if swap { (sx * y, sy * x) } else { (sx * x, sy * y) }
    };
    let mut worst = 0.0_f64;
    for t in sweep(1e-30, 1.0).chain([0.0]) {
        for scale in [1.0, 0.7_f32, 3e4] {
            for case in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
                for swap in [false, true] {
                    let (x, y) = f(scale, t * scale)((case.0, case.1, swap));
                    worst = worst.max(ulp_error(atan2(y, x), f64::from(y).atan2(f64::from(x))));
                }
            }
        }
    }
    assert!(worst <= 3.0, "{worst} ulp");
    for (y, x) in [(0.0, 0.0), (-0.0, 0.0), (0.0, -0.0), (-0.0, -0.0), (0.0, 1.0), (0.0, -1.0), (-0.0, -1.0)]
    {
        assert_eq!(atan2(y, x), f32::atan2(y, x), "{y} {x}");
    }
    assert!(atan2(f32::NAN, 1.0).is_nan() && atan2(1.0, f32::NAN).is_nan());
}

/// Arcs of sines and cosines, down to the smallest, and nothing beyond 1.
#[test]
fn arcs() {
    let both = || sweep(0.0, 1.0).chain(sweep(-0.0, -1.0));
    check(both(), asin, f64::asin, 2.5);
    check(both(), acos, f64::acos, 2.5);
    assert!(asin(1.000_001).is_nan() && acos(-1.000_001).is_nan() && acos(f32::NAN).is_nan());
    assert_eq!([acos(1.0), acos(-1.0), asin(1.0), asin(-1.0)], [0.0, PI, FRAC_PI_2, -FRAC_PI_2]);
}

/// Every float.
#[test]
fn exponentials() {
    check(sweep(0.0, f32::INFINITY).chain(sweep(-0.0, f32::NEG_INFINITY)), exp, f64::exp, 2.0);
    assert!(exp(f32::NAN).is_nan());
    assert_eq!([exp(0.0), exp(f32::INFINITY), exp(f32::NEG_INFINITY)], [1.0, f32::INFINITY, 0.0]);
}

/// Every float that has a logarithm, subnormal ones included.
#[test]
fn logarithms() {
    check(sweep(0.0, f32::INFINITY), ln, f64::ln, 2.0);
    check(sweep(0.0, f32::INFINITY), log2, f64::log2, 3.0);
    check(sweep(0.0, f32::INFINITY).chain(sweep(-0.0, -1.0)), ln_1p, f64::ln_1p, 3.0);
    for f in [ln, log2, |x| ln_1p(x - 1.0)] {
        assert_eq!([f(0.0), f(1.0), f(f32::INFINITY)], [f32::NEG_INFINITY, 0.0, f32::INFINITY]);
        assert!(f(-0.5).is_nan() && f(f32::NAN).is_nan());
    }
    assert!((-149..128).all(|k| log2(2.0_f64.powi(k) as f32) == k as f32));
}
