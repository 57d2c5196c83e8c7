//! The estimate on photon maps: what methods call.

use etendue_math::{Point3, Vector3};
use etendue_spectrum::Xyz;

use super::radiance::{LitPlace, RadianceEstimate, irradiance, radiance};
use super::{Density, DensityEstimate, EstimateScratch, Photons};
use crate::photon::map::PhotonMap;

impl Photons for PhotonMap {
    #[inline]
    fn position(&self, index: u32) -> Point3 {
        self.photon(index).position()
    }

    #[inline]
    fn wi(&self, index: u32) -> Vector3 {
        self.photon(index).wi()
    }

    #[inline]
    fn power(&self, index: u32) -> Xyz {
        self.power(&self.photon(index))
    }
}

/// How a map is asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapEstimate {
    /// How photons are weighed.
    pub density: DensityEstimate,
    /// Photons that are to count.
    pub k: usize,
    /// Photons farther than this do not count, in metres; infinite for no limit.
    pub max_radius: f32,
}

impl MapEstimate {
    /// Reflected (and transmitted) radiance of a place by the photons of a map whose powers are divided by the number emitted.
    #[inline]
    #[must_use]
    pub fn radiance(
        &self,
        map: &PhotonMap,
        place: &LitPlace<'_>,
        scratch: &mut EstimateScratch,
    ) -> RadianceEstimate {
        let wanted = self.find(map, place.p, scratch);
        radiance(&self.density, place, wanted, map, scratch)
    }

    /// Irradiance in XYZ on the side of the unit normal `n`.
    #[inline]
    #[must_use]
    pub fn irradiance(
        &self,
        map: &PhotonMap,
        (p, n): (Point3, Vector3),
        scratch: &mut EstimateScratch,
    ) -> (Xyz, Density) {
        let wanted = self.find(map, p, scratch);
        irradiance(&self.density, (p, n), wanted, map, scratch)
    }

    /// Finds the photons around a place, and tells how many were wanted.
    pub(crate) fn find(&self, map: &PhotonMap, p: Point3, scratch: &mut EstimateScratch) -> usize {
        let wanted = self.density.search_size(self.k);
        map.nearest(p, wanted, self.max_radius, &mut scratch.found);
        wanted
    }
}
