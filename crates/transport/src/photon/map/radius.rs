//! The radius within which photons are looked for, to begin with (SPEC KD-9). An estimate of `k` photons does not depend on it
//! once `k` are found everywhere; where photons are sparse, as between caustics, it saves looking through the whole map, and
//! what it leaves out is below an error that is chosen here.

use std::f32::consts::PI;

use etendue_geometry::points::Neighbours;
use etendue_math::Bounds3;
use rayon::prelude::*;

use super::PhotonMap;

/// Photons at which density is looked at.
const N_PROBES: usize = 1024;

/// A radius for a scene that nothing is known of but its size: a twentieth of the diagonal of its box. 0 for a single point.
#[must_use]
pub fn radius_from_scene(bounds: &Bounds3) -> f32 {
    let diagonal = (bounds.max - bounds.min).length();
    if diagonal.is_finite() { diagonal / 20.0 } else { 0.0 }
}

impl PhotonMap {
    /// The radius beyond which `k` photons of mean power make less irradiance than is allowed as error, in W/m² of Y:
    ///
    /// r² = k Φ / (π ΔE)
    ///
    /// with the mean power Φ. For a matte white surface a radiance error ΔL is an irradiance error π ΔL. `None` if the map is
    /// black or the error not positive.
    #[must_use]
    pub fn radius_from_error(&self, k: usize, irradiance_error: f32) -> Option<f32> {
        let mean = self.mean_power();
        let radius = (k as f32 * mean / (PI * irradiance_error)).sqrt();
        (irradiance_error > 0.0 && radius > 0.0 && radius.is_finite()).then_some(radius)
    }

    /// The radius that holds `k` photons around all but a share of the photons, such as 0.1, by a look at 1024 of them. Where
    /// light is, that many photons are then found. `None` if the map has fewer than `k`, or all in one place.
    #[must_use]
    pub fn radius_from_density(&self, k: usize, share_beyond: f32) -> Option<f32> {
        if k == 0 || self.len() < k {
            return None;
        }
        let n_probes = self.len().min(N_PROBES);
        let probe = |i: usize| (i as u64 * self.len() as u64 / n_probes as u64) as u32;
        let reach = |found: &mut Neighbours, i: usize| {
            self.nearest(self.photon(probe(i)).position(), k, f32::INFINITY, found);
            found.limit_squared()
        };
        let mut squares: Vec<f32> = (0..n_probes).into_par_iter().map_init(Neighbours::new, reach).collect();
        squares.sort_by(f32::total_cmp);
        let rank = (n_probes - 1) as f32 * (1.0 - share_beyond.clamp(0.0, 1.0));
        let radius = squares.get(rank as usize)?.sqrt();
        (radius > 0.0 && radius.is_finite()).then_some(radius)
    }

    /// Mean of the Y of the powers; 0 without photons.
    #[must_use]
    pub fn mean_power(&self) -> f32 {
        let sum: f64 = self.photons().map(|photon| f64::from(self.power(&photon).y)).sum();
        (sum / self.len().max(1) as f64) as f32
    }
}

#[cfg(test)]
mod tests {
    use etendue_math::{Normal3, Point3, Rng};

    use super::super::tests::photon;
    use super::*;

    /// A square metre with 10,000 photons of irradiance 1.
    fn square() -> PhotonMap {
        let mut rng = Rng::new(21, 0);
        let photons: Vec<_> =
            (0..10_000).map(|_| photon(Point3::new(rng.next_f32(), 0.0, rng.next_f32()))).collect();
        PhotonMap::from_photons(&photons, 10_000)
    }

    /// The radius that holds k photons of a uniform field: its area is k/n of the whole. Near edges it is larger.
    #[test]
    fn density() {
        let map = square();
        let expected = (100.0 / 10_000.0 / PI).sqrt();
        let median = map.radius_from_density(100, 0.5).expect("there are photons");
        assert!((median / expected - 1.0).abs() < 0.1, "{median} {expected}");
        let nearly_all = map.radius_from_density(100, 0.0).expect("there are photons");
        assert!((1.5..2.2).contains(&(nearly_all / expected)), "{nearly_all} {expected}");
        assert_eq!(map.radius_from_density(0, 0.1), None);
        assert_eq!(map.radius_from_density(10_001, 0.1), None);
        let one_place = PhotonMap::from_photons(&vec![photon(Point3::splat(1.0)); 50], 1);
        assert_eq!(one_place.radius_from_density(10, 0.1), None);
    }

    /// k photons within the radius that an error allows make that irradiance.
    #[test]
    fn error() {
        let map = square();
        let radius = map.radius_from_error(50, 0.1).expect("there is light");
        let irradiance = 50.0 * map.mean_power() / (PI * radius * radius);
        assert!((irradiance - 0.1).abs() < 1e-5);
        for bad in [0.0, -1.0, f32::NAN] {
            assert_eq!(map.radius_from_error(50, bad), None);
        }
        assert_eq!(PhotonMap::default().radius_from_error(50, 1.0), None);
    }

    /// The estimate does not depend on the radius once it is large enough.
    #[test]
    fn large_enough() {
        let map = square();
        let radius = map.radius_from_density(100, 0.0).expect("there are photons");
        let (p, up, mut found) = (Point3::new(0.5, 0.0, 0.5), Normal3::new(0.0, 1.0, 0.0), Neighbours::new());
        let mut estimate = |radius: f32| map.irradiance_estimate(p, up, 100, radius, 8, &mut found);
        let scene = Bounds3 { min: Point3::splat(0.0), max: Point3::new(1.0, 0.0, 1.0) };
        assert_eq!(estimate(radius), estimate(f32::INFINITY));
        assert_eq!(estimate(radius_from_scene(&scene) * 4.0), estimate(f32::INFINITY));
        assert_ne!(estimate(radius * 0.3), estimate(f32::INFINITY));
        assert_eq!(radius_from_scene(&Bounds3 { min: scene.min, max: scene.min }), 0.0);
    }
}
