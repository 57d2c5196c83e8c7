//! The photon map (Jensen 2001, "Realistic Image Synthesis Using Photon Mapping", chapter 6 and appendix B; SPEC KD-1 to KD-12).
//!
//! A map is the photons in the order of a bucket tree ([`PackedPoints`]): coordinates in the buckets, the other eight bytes of
//! each photon beside them, half a byte for the cuts. That is 20.5 bytes a photon. The tree in heap order of the book
//! needs 20 and answers half as fast.
//!
//! [`PhotonMapBuilder`] is what the book's `create`, `store`, `scale_power` and `balance` are; [`PhotonMap`] has `locate`
//! (as [`PhotonMap::nearest`]), `irradiance_estimate` and `direction` (as [`Photon::wi`]). A balanced map takes no more
//! photons, which the types say.
//!
//! Photons are the same, bit for bit and in the same order, for any number of threads.

mod builder;
pub(in crate::photon) mod bytes;
mod direction;
mod power;
mod radius;
mod record;
mod trace;

#[cfg(test)]
mod tests;

use etendue_geometry::points::{Neighbour, Neighbours, PackedPoints};
use etendue_math::{Normal3, Point3};
use etendue_spectrum::Xyz;

pub use builder::{PhotonMapBuilder, Storing};
pub use bytes::PhotonMapError;

pub use power::PowerCodec;
pub use radius::radius_from_scene;
pub use record::{Photon, StoredPhoton};

use crate::photon::Trail;
use record::Rest;

/// Photons that answer questions about those nearby.
#[derive(Clone, Debug, Default)]
pub struct PhotonMap {
    points: PackedPoints,
    /// In the order of the points.
    rest: Vec<Rest>,
    codec: PowerCodec,
    trails: Vec<Trail>,
    n_emitted: u64,
}

impl PhotonMap {
    /// A map of photons whose powers are divided by the number emitted.
    #[must_use]
    pub fn from_photons<'a>(photons: impl IntoIterator<Item = &'a StoredPhoton>, n_emitted: u64) -> Self {
        let mut builder = PhotonMapBuilder::new(usize::MAX);
        for photon in photons {
            builder.store(photon);
        }
        builder.scale_power((1.0 / n_emitted.max(1) as f64) as f32);
        builder.balance(n_emitted)
    }

    /// Number of photons.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there are none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Number of photons that left the lights. Powers are divided by it already, if the builder was told to.
    #[must_use]
    pub const fn n_emitted(&self) -> u64 {
        self.n_emitted
    }

    /// The trails of the photons, in order of first appearance, by [`Photon::trail_number`].
    #[must_use]
    pub fn trails(&self) -> &[Trail] {
        &self.trails
    }

    /// Bytes on the heap.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        self.points.memory_bytes() + size_of_val(&*self.rest) + size_of_val(&*self.trails)
    }

    /// The photon at a place below [`Self::len`], which is what [`Neighbour::index`] names.
    ///
    /// # Panics
    /// If there is no such place.
    #[inline]
    #[must_use]
    pub fn photon(&self, place: u32) -> Photon {
        let Point3 { x, y, z } = self.points.point(place);
        Photon { position: [x, y, z], rest: self.rest[place as usize] }
    }

    /// All photons, in the order of the tree.
    pub fn photons(&self) -> impl ExactSizeIterator<Item = Photon> + '_ {
        (0..self.points.len() as u32).map(|place| self.photon(place))
    }

    /// The flux that a photon of this map carries: divided by the number emitted if the builder was told to.
    #[inline]
    #[must_use]
    pub fn power(&self, photon: &Photon) -> Xyz {
        self.codec.decode(photon.rest.power)
    }

    /// The events of a photon of this map before it arrived; `None` if it is one of too many kinds to tell.
    #[inline]
    #[must_use]
    pub fn trail(&self, photon: &Photon) -> Option<Trail> {
        self.trails.get(photon.trail_number()).copied()
    }

    /// Finds the `k` photons nearest to `p` among those no farther than `max_radius`, by their places; of equally near ones
    /// those of lower place. `locate` in the book.
    #[inline]
    pub fn nearest(&self, p: Point3, k: usize, max_radius: f32, found: &mut Neighbours) {
        self.points.nearest(p, k, max_radius, found);
    }

    /// Shows all photons no farther than `radius` from `p`, by their places.
    #[inline]
    pub fn within(&self, p: Point3, radius: f32, visit: impl FnMut(Neighbour)) {
        self.points.within(p, radius, visit);
    }

    /// The irradiance at `p` of a surface with normal `n`, in W/m² of XYZ: the power of the `k` nearest photons that arrive on
    /// the side of the normal over the area of the disk that holds them (SPEC KD-11).
    ///
    /// 0 if fewer than `min_photons` are found: the book has 8, a heuristic that darkens sparse places; 0 or 1 leave it out.
    pub fn irradiance_estimate(
        &self,
        p: Point3,
        n: Normal3,
        k: usize,
        max_radius: f32,
        min_photons: usize,
        found: &mut Neighbours,
    ) -> Xyz {
        self.nearest(p, k, max_radius, found);
        let area = std::f64::consts::PI * f64::from(found.limit_squared());
        let mut sum = [0.0_f64; 3];
        if found.iter().len() < min_photons.max(1) || area == 0.0 {
            return Xyz::default();
        }
        for neighbour in found.iter() {
            let rest = self.rest[neighbour.index as usize];
            if rest.wi().dot(n.as_vector()) > 0.0 {
                let power = self.codec.decode(rest.power).to_array();
                (0..3).for_each(|i| sum[i] += f64::from(power[i]));
            }
        }
        Xyz::from(sum.map(|v| (v / area) as f32))
    }
}
