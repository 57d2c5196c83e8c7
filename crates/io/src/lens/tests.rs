//! Lens files, sound and broken.

use super::*;

const SINGLET: &str = "# a lens of crown glass\n60 5 1.5 20\n0 2 0 10 # stop\n-60\t0 1.0 20\n";

#[track_caller]
fn check(text: &str, expected: &str) {
    let message = read_lens(text.as_bytes()).map_err(|error| error.to_string());
    assert_eq!(message.err().as_deref().unwrap_or(""), expected);
}

/// Numbers count, not lines; lengths are millimetres; an index of 0 is air.
#[test]
fn surfaces_are_read() {
    let lens = read_lens(SINGLET.as_bytes()).unwrap();
    assert_eq!(lens.surfaces().len(), 3);
    let front = lens.surfaces()[0];
    assert_eq!((front.radius_m, front.thickness_m, front.eta, front.diameter_m), (0.06, 0.005, 1.5, 0.02));
    assert!(lens.stop().is_some_and(|stop| stop.eta == 1.0 && stop.diameter_m == 0.01));
    let on_one_line =
        SINGLET.lines().map(|line| line.split('#').next().unwrap()).collect::<Vec<_>>().join(" ");
    assert_eq!(read_lens(on_one_line.as_bytes()), Ok(lens));
}

/// What no lens has is refused, with its line.
#[test]
fn faults_are_located() {
    check(SINGLET, "");
    check("", "there is no surface that refracts");
    check("0 1 1 10", "there is no surface that refracts");
    check("50 5 1.5 20\n-50 0 1 two", "line 2: \"two\" should be a number");
    check(
        "50 5 1.5 20\n-50 0 1",
        "line 2: a surface needs four numbers: radius, distance to the next, index, diameter",
    );
    check("50 -5 1.5 20\n-50 0 1 20", "line 1: the distance to the next surface is negative");
    check(
        "50 5 0.5 20\n-50 0 1 20",
        "line 1: the index of refraction should be between 1 and 5, or 0 for air",
    );
    check("50 5 1.5 20\n\n-50 0 1 0", "line 3: the diameter should be positive");
    check(
        "50 5 1.5 101\n-50 0 1 20",
        "line 1: the diameter is larger than that of the sphere, which is twice the radius",
    );
    check("50 nan 1.5 20\n-50 0 1 20", "line 1: a number is not finite");
    check("50 1e99 1.5 20\n-50 0 1 20", "line 1: a number is not finite");
    check("50 5 1.5 20\n-50 0 1.5 20", "line 2: the last surface should have air behind it");
    check("-50 5 1.5 20\n50 0 1 20", "the lens as a whole does not gather light");
    check(
        "0 5 1 20\n50 5 1.5 20\n0 5 1 20\n-50 0 1 20",
        "line 3: this is a second stop (a surface of radius 0)",
    );
    check(&"50 5 1.5 20\n".repeat(300), "there are more than 200 surfaces");
    check(&"1 ".repeat(100_000), "there are more than 200 surfaces");
}

/// Damaged files are read without panic.
#[test]
fn damaged_files_do_not_panic() {
    let mut state = 5_u64;
    let mut below = |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 33) as usize % n
    };
    for _ in 0..20_000 {
        let mut bytes = SINGLET.as_bytes().to_vec();
        for _ in 0..=below(3) {
            let at = below(bytes.len());
            match below(3) {
                0 => bytes[at] = below(256) as u8,
                1 => bytes.insert(at, b"0123456789.-e #"[below(15)]),
                _ => bytes.truncate(at.max(1)),
            }
        }
        drop(read_lens(&bytes));
    }
}
