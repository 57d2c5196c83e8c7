//! Russian roulette (Arvo and Kirk 1990; SPEC MC-11, PT-5), and its form for photons, which keeps their powers even
//! (Jensen 2001, "Realistic Image Synthesis Using Photon Mapping", section 5.2.4; SPEC PHT-6 to PHT-8).

use etendue_spectrum::Sampled;

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

/// What becomes of a photon at a surface that reflects in two ways.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhotonEvent {
    /// Reflected in all directions.
    Diffuse,
    /// Reflected about the mirror direction.
    Specular,
}

/// Lets a photon live on with a probability equal to the mean of what a scattering event multiplies its power by, and returns
/// the factor of the power of one that does: 1 in the mean over wavelengths, so that a thousand photons on a surface that
/// reflects half become five hundred of the same power, tinted by the surface (SPEC PHT-6, PHT-8).
#[inline]
#[must_use]
pub fn reflect_or_absorb(weight: Sampled, u: f32) -> Option<Sampled> {
    let survival = survival_probability(weight.average(), 1.0);
    (u < survival).then(|| weight / survival)
}

/// Chooses what becomes of a photon by the means of both reflectances, whose sum is at most 1, with the factor of its power;
/// `None` if it is absorbed (SPEC PHT-7, PHT-8).
#[inline]
#[must_use]
pub fn choose_photon_event(diffuse: Sampled, specular: Sampled, u: f32) -> Option<(PhotonEvent, Sampled)> {
    let p_diffuse = diffuse.average();
    if u < p_diffuse {
        return Some((PhotonEvent::Diffuse, diffuse / p_diffuse));
    }
    let p_specular = specular.average();
    (u < p_diffuse + p_specular).then(|| (PhotonEvent::Specular, specular / p_specular))
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

    const N: u32 = 1000;

    /// The middles of N equal steps: every probability is met to one part in N.
    fn numbers() -> impl Iterator<Item = f32> {
        (0..N).map(|i| (i as f32 + 0.5) / N as f32)
    }

    /// PHT-6: of 1000 photons on a surface that reflects half, 500 go on, at full power.
    #[test]
    fn half_of_the_photons_go_on_at_full_power() {
        let kept: Vec<Sampled> =
            numbers().filter_map(|u| reflect_or_absorb(Sampled::splat(0.5), u)).collect();
        assert_eq!(kept.len(), 500);
        assert!(kept.iter().all(|factor| *factor == Sampled::ONE));
        assert_eq!(reflect_or_absorb(Sampled::ZERO, 0.0), None);
        assert_eq!(reflect_or_absorb(Sampled::splat(1.2), 0.999), Some(Sampled::splat(1.2)));
    }

    /// PHT-7, PHT-8: each event is as frequent as its mean reflectance, the power per wavelength is right in the mean, and
    /// the mean over wavelengths of each photon's power stays.
    #[test]
    fn events_are_as_frequent_as_their_reflectance() {
        let diffuse = Sampled::from_array([0.1, 0.2, 0.3, 0.6]);
        let specular = Sampled::from_array([0.5, 0.4, 0.1, 0.2]);
        for (event, reflectance) in [(PhotonEvent::Diffuse, diffuse), (PhotonEvent::Specular, specular)] {
            let of_this = numbers().filter_map(|u| {
                choose_photon_event(diffuse, specular, u).filter(|(chosen, _)| *chosen == event)
            });
            let factors: Vec<Sampled> = of_this.map(|(_, factor)| factor).collect();
            assert_eq!(factors.len(), 300, "{event:?}");
            let mean = factors.iter().fold(Sampled::ZERO, |sum, factor| sum + *factor) / N as f32;
            for (mean, reflectance) in mean.to_array().into_iter().zip(reflectance.to_array()) {
                assert!((mean - reflectance).abs() < 1e-5, "{event:?} {mean} {reflectance}");
            }
            assert!(factors.iter().all(|factor| (factor.average() - 1.0).abs() < 1e-6));
        }
    }
}
