//! How photons leave lights: directions of a diffuse point by rejection (SPEC EMI-4), and how many photons each of several
//! lights emits (SPEC EMI-9).

use etendue_math::{Rng, Vector3};

/// A direction uniform over the sphere: a point of the cube [-1, 1]^3, taken if it lies within the unit ball, though not
/// near its centre, where rounding would favour directions. The ball fills pi / 6 of the cube. The number of points that
/// were drawn comes with it.
///
/// [`etendue_math::warp::sample_uniform_sphere`] does the same by an explicit map, which needs two numbers and keeps even
/// points even. (The notebook draws coordinates in [0, 1], which gives an eighth of the sphere, and does not normalise: F4.)
pub fn sample_sphere_by_rejection(rng: &mut Rng) -> (Vector3, u32) {
    let mut n_points = 0;
    loop {
        n_points += 1;
        let mut coordinate = || 2.0 * rng.next_f32() - 1.0;
        let v = Vector3::new(coordinate(), coordinate(), coordinate());
        let length_squared = v.length_squared();
        if (1e-6..=1.0).contains(&length_squared) {
            return (v / length_squared.sqrt(), n_points);
        }
    }
}

/// How many of `n` photons each light emits, in proportion to its power, so that the power of a photon, `Phi_l / n_l`, is
/// nearly the same for all: whole parts first, then one more each for the largest remainders. Zeros if there is no power.
#[must_use]
pub fn share_photons(n: u64, powers: &[f64]) -> Vec<u64> {
    let weight = |power: f64| if power > 0.0 && power.is_finite() { power } else { 0.0 };
    let total: f64 = powers.iter().map(|power| weight(*power)).sum();
    if total <= 0.0 || !total.is_finite() {
        return vec![0; powers.len()];
    }
    let exact: Vec<f64> = powers.iter().map(|power| weight(*power) / total * n as f64).collect();
    let mut shares: Vec<u64> = exact.iter().map(|share| share.floor() as u64).collect();
    let mut by_remainder: Vec<usize> = (0..powers.len()).collect();
    by_remainder.sort_by(|a, b| exact[*b].fract().total_cmp(&exact[*a].fract()).then(a.cmp(b)));
    let left = n.saturating_sub(shares.iter().sum());
    for index in by_remainder.into_iter().take(left as usize) {
        shares[index] += 1;
    }
    shares
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use etendue_math::statistics::sphere_chi_square;

    use super::*;

    #[test]
    fn rejection_is_uniform_over_the_sphere_and_takes_pi_over_six() {
        let pdf = |_: Vector3| (1.0 / (4.0 * PI)) as f32;
        let sample = |rng: &mut Rng| Some(sample_sphere_by_rejection(rng).0);
        sphere_chi_square(60_000, 4, sample, pdf, 1e-5).unwrap_or_else(|error| panic!("{error}"));
        let (n, mut rng) = (30_000, Rng::new(4, 2));
        let (mut mean, mut n_points) = (Vector3::splat(0.0), 0);
        for _ in 0..n {
            let (w, tries) = sample_sphere_by_rejection(&mut rng);
            mean += w / n as f32;
            n_points += tries;
        }
        // Each component of a direction has the variance 1/3; tries are geometric.
        assert!(mean.length() < 4.5 * (1.0 / f64::from(n)).sqrt() as f32, "{mean:?}");
        let (p, tries) = (PI / 6.0, f64::from(n_points) / f64::from(n));
        assert!(
            (tries - 1.0 / p).abs() < 4.5 * ((1.0 - p) / f64::from(n)).sqrt() / p,
            "{tries} points for each"
        );
    }

    #[test]
    fn photons_have_equal_power_within_rounding() {
        let powers = [10.0, 0.0, 3.3, 86.7, 1e-9];
        let shares = share_photons(100_000, &powers);
        assert_eq!(shares.iter().sum::<u64>(), 100_000);
        for (power, share) in powers.iter().zip(&shares) {
            assert!((power / 100.0 * 1e5 - *share as f64).abs() <= 1.0, "{share} photons of {power} W");
        }
        assert_eq!(share_photons(3, &[1.0, 1.0]), [2, 1]);
        assert_eq!(share_photons(7, &[0.0, f64::NAN, -1.0]), [0, 0, 0]);
        assert_eq!(share_photons(7, &[]), Vec::<u64>::new());
    }
}
