//! Random numbers: reference values and moments.

use super::*;
use crate::statistics::{Moments, chi_square_test, mean_test};

/// The first numbers of the reference implementation's demonstration (seed 42, stream 54).
#[test]
fn pcg32_matches_its_reference() {
    let mut rng = Rng::new(42, 54);
    let numbers: Vec<u32> = (0..6).map(|_| rng.next_u32()).collect();
    assert_eq!(numbers, [0xa15c_02b7, 0x7b47_f409, 0xba1d_3330, 0x83d2_f293, 0xbfa4_784b, 0xcbed_606e]);
}

/// Skipping n numbers leads where drawing n numbers leads.
#[test]
fn advance_equals_drawing() {
    let mut drawn = Rng::new(7, 3);
    let mut skipped = drawn.clone();
    for _ in 0..1234 {
        drawn.next_u32();
    }
    skipped.advance(1234);
    assert_eq!(drawn, skipped);
    skipped.advance(1234_u64.wrapping_neg());
    assert_eq!(skipped, Rng::new(7, 3));
}

/// Random numbers never reach 1, not even for the largest bits.
#[test]
fn unit_numbers_stay_below_one() {
    assert!(unit_f32(u32::MAX) < 1.0);
    assert!(unit_f64(u64::MAX) < 1.0);
    assert_eq!(unit_f32(0), 0.0);
    assert_eq!(unit_f32(1 << 31), 0.5);
    assert_eq!(ONE_MINUS_EPSILON.next_up(), 1.0);
}

/// MC-3: the expectation of a fair die is 3.5, that of x and x^2 over [0, 1) is 1/2 and 1/3.
#[test]
fn expectations_are_those_of_uniform_numbers() {
    let mut rng = Rng::new(1, 2);
    let n = 100_000;
    let dice: Vec<u32> = (0..n).map(|_| rng.next_below(6)).collect();
    mean_test(&dice.iter().map(|eye| f64::from(eye + 1)).collect::<Moments>(), 3.5, 1e-4).unwrap();
    let counts: Vec<f64> = (0..6).map(|eye| dice.iter().filter(|d| **d == eye).count() as f64).collect();
    chi_square_test(&counts, &[f64::from(n) / 6.0; 6], 5.0, 1e-4).unwrap();
    let numbers: Vec<f64> = (0..n).map(|_| f64::from(rng.next_f32())).collect();
    mean_test(&numbers.iter().copied().collect(), 0.5, 1e-4).unwrap();
    mean_test(&numbers.iter().map(|x| x * x).collect(), 1.0 / 3.0, 1e-4).unwrap();
    mean_test(&(0..n).map(|_| rng.next_f64()).collect(), 0.5, 1e-4).unwrap();
}

/// Neighbouring seeds, pixels and orders give hashes without relation: each bit differs in half of all cases.
#[test]
fn hashes_avalanche() {
    let mut flips = [0.0; 64];
    let trials = 4096;
    for i in 0..trials {
        let difference = hash64(&[i, 5]) ^ hash64(&[i ^ 1, 5]);
        for (bit, count) in flips.iter_mut().enumerate() {
            *count += (difference >> bit & 1) as f64;
        }
    }
    let sigma = (trials as f64 * 0.25).sqrt();
    for (bit, count) in flips.iter().enumerate() {
        assert!(
            (count - trials as f64 / 2.0).abs() < 5.0 * sigma,
            "bit {bit} flips {count} times of {trials}"
        );
    }
    assert_ne!(hash64(&[1, 2]), hash64(&[2, 1]));
    assert_ne!(hash64(&[]), hash64(&[0]));
    assert_ne!(hash64(&[0]), hash64(&[0, 0]));
    assert_ne!(mix64(1), mix64(2));
}
