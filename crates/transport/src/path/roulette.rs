//! Russian roulette (Arvo and Kirk 1990; SPEC MC-11, PT-5).

/// The probability to continue a path whose throughput, freed of the squared relative index that refraction
/// multiplies in, has the largest component `brightness`; 1 where roulette does not pay.
///
/// A path that survives is divided by this probability, so that the expectation stays. Freed of the index, light
/// that enters glass and leaves it again does not play for a factor that comes back. Paths brighter than `threshold` all go
/// on. At 1 paths end as readily as light is absorbed, and survivors all carry the same; but most of a picture's error comes
/// from there then, and half of it costs less (measured in `docs/benchmarks.md`).
#[inline]
#[must_use]
pub fn survival_probability(brightness: f32, threshold: f32) -> f32 {
    let probability = brightness / threshold;
    if probability.is_nan() { 0.0 } else { probability.clamp(0.0, 1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half of the light is kept half of the time at double weight.
    #[test]
    fn expectation_is_kept() {
        for brightness in [0.01_f32, 0.3, 0.99, 1.0, 5.0] {
            let p = survival_probability(brightness, 0.7);
            assert!(p > 0.0 && p <= 1.0);
            let expectation = p * (brightness / p);
            assert!((expectation - brightness).abs() < 1e-6 * brightness);
        }
    }

    /// Below the threshold a path of half of it lives on half of the time; above, always. Without threshold all do.
    #[test]
    fn the_threshold_is_where_roulette_starts() {
        assert_eq!(survival_probability(0.3, 0.6), 0.5);
        assert_eq!(survival_probability(0.6, 0.6), 1.0);
        assert_eq!(survival_probability(0.7, 0.6), 1.0);
        assert_eq!(survival_probability(1e-6, 0.0), 1.0);
    }

    /// A path without throughput, or with a broken one, ends.
    #[test]
    fn nothing_continues_for_nothing() {
        assert_eq!(survival_probability(0.0, 0.5), 0.0);
        assert_eq!(survival_probability(f32::NAN, 0.5), 0.0);
    }
}
