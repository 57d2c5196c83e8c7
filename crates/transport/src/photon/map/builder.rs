//! Photons on their way into a map (SPEC KD-10): they are stored light by light, scaled by how many that light emitted, and
//! then balanced.

use std::collections::HashMap;

use etendue_geometry::points::PackedPoints;
use etendue_math::Point3;
use etendue_spectrum::Xyz;
use rayon::prelude::*;

use super::power::PowerCodec;
use super::record::{self, OTHER_TRAILS, Rest, StoredPhoton};
use super::{PhotonMap, direction};
use crate::photon::Trail;

/// A map that takes photons and answers no questions yet; `create` in the book.
#[derive(Clone, Debug, Default)]
pub struct PhotonMapBuilder {
    max_photons: usize,
    codec: PowerCodec,
    photons: Vec<Waiting>,
    /// Photons before this one have been scaled.
    n_scaled: usize,
    trails: Vec<Trail>,
    numbers: HashMap<Trail, u16>,
    n_refused: u64,
}

/// A photon whose power may change yet: 28 bytes, those of the book's uncompressed photon.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    position: Point3,
    power: Xyz,
    direction: [u8; 2],
    flags: u16,
}

const _: () = assert!(size_of::<Waiting>() == 28);

/// What became of a photon that was to be stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storing {
    /// It is in the map.
    Stored,
    /// The map holds as many as it may.
    Full,
    /// Its position, direction or power is not finite, or its power negative.
    Refused,
}

impl PhotonMapBuilder {
    /// For up to so many photons. Nothing is reserved.
    #[must_use]
    pub fn new(max_photons: usize) -> Self {
        // Places in a map have 32 bits.
        let max_photons = max_photons.min(u32::MAX as usize - 1);
        Self { max_photons, ..Self::default() }
    }

    /// The same with powers kept as `codec` has them.
    #[must_use]
    pub const fn with_codec(mut self, codec: PowerCodec) -> Self {
        self.codec = codec;
        self
    }

    /// Takes a photon, whose power will be multiplied by the next [`Self::scale_power`].
    pub fn store(&mut self, photon: &StoredPhoton) -> Storing {
        let is_power = photon.power.to_array().iter().all(|v| v.is_finite() && *v >= 0.0);
        if !is_power || !photon.position.is_finite() || !photon.wi.is_finite() {
            self.n_refused += 1;
            return Storing::Refused;
        }
        if self.is_full() {
            return Storing::Full;
        }
        let flags = record::flags(self.number(photon.trail), photon.is_shadow);
        self.photons.push(Waiting {
            position: photon.position,
            power: photon.power,
            direction: direction::encode(photon.wi),
            flags,
        });
        Storing::Stored
    }

    /// Whether it takes no more photons.
    #[must_use]
    pub const fn is_full(&self) -> bool {
        self.photons.len() >= self.max_photons
    }

    /// Number of photons that are stored.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.photons.len()
    }

    /// Whether no photon is stored.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.photons.is_empty()
    }

    /// Number of photons that were not finite or had a negative power.
    #[must_use]
    pub const fn n_refused(&self) -> u64 {
        self.n_refused
    }

    /// Multiplies the powers of the photons that were stored since the last call: by 1 / number emitted, once for each light.
    pub fn scale_power(&mut self, factor: f32) {
        for photon in &mut self.photons[self.n_scaled..] {
            photon.power = Xyz::from(photon.power.to_array().map(|v| v * factor));
        }
        self.n_scaled = self.photons.len();
    }

    /// The map, put in order in parallel on the current rayon pool. `n_emitted` photons left the lights.
    #[must_use]
    pub fn balance(self, n_emitted: u64) -> PhotonMap {
        let Self { codec, photons, trails, .. } = self;
        let positions: Vec<Point3> = photons.iter().map(|photon| photon.position).collect();
        let (points, order) = PackedPoints::new(&positions);
        drop(positions);
        let pack = |index: &u32| {
            let Waiting { position: p, power, direction, flags } = photons[*index as usize];
            Rest::new([p.x, p.y, p.z], power, codec, direction, flags)
        };
        let mut rest: Vec<Rest> = order.par_iter().map(pack).collect();
        for (first, axis) in points.cuts() {
            rest[first as usize].set_split_axis(axis);
        }
        PhotonMap { points, rest, codec, trails, n_emitted }
    }

    /// The number of a trail, in order of first appearance.
    fn number(&mut self, trail: Trail) -> u16 {
        if let Some(number) = self.numbers.get(&trail) {
            return *number;
        }
        let number = self.trails.len() as u16;
        if number >= OTHER_TRAILS {
            return OTHER_TRAILS;
        }
        self.numbers.insert(trail, number);
        self.trails.push(trail);
        number
    }
}
