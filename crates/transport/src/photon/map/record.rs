//! The photon of a map, in 20 bytes (SPEC KD-3).
//!
//! | bytes | |
//! |---|---|
//! | 12 | position, three `f32` |
//! | 4 | power, three mantissas and an exponent ([`PowerCodec`]) |
//! | 2 | direction, theta and phi |
//! | 2 | flags: axis of a cut of the tree (2 bits; 3 for none), shadow (1 bit), number of the trail (13 bits) |

use etendue_math::{Point3, Vector3, hash64, unit_f32};
use etendue_spectrum::Xyz;

use super::direction;
use super::power::PowerCodec;
use crate::photon::Trail;

/// What a photon is before it is packed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredPhoton {
    /// Where it arrived, in metres.
    pub position: Point3,
    /// The flux that it carries, not negative.
    pub power: Xyz,
    /// Towards where it came from; a unit vector.
    pub wi: Vector3,
    /// Its events before it arrived.
    pub trail: Trail,
    /// Whether it is a shadow photon, which marks where light does not arrive.
    pub is_shadow: bool,
}

/// A photon of a map.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Photon {
    pub(super) position: [f32; 3],
    pub(super) rest: Rest,
}

/// All of a photon but its position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub(super) struct Rest {
    pub(super) power: [u8; 4],
    pub(super) direction: [u8; 2],
    pub(super) flags: u16,
}

const _: () = assert!(size_of::<Photon>() == 20 && align_of::<Photon>() == 4);

/// Bits of the axis.
const AXIS_MASK: u16 = 0b11;
const SHADOW: u16 = 0b100;
const TRAIL_SHIFT: u32 = 3;

/// The number of all trails that the table has no room for.
pub(super) const OTHER_TRAILS: u16 = u16::MAX >> TRAIL_SHIFT;
/// The axis of photons at which nothing is cut.
pub(super) const NO_AXIS: u8 = 3;

impl Photon {
    /// Where it arrived, in metres.
    #[inline]
    #[must_use]
    pub const fn position(&self) -> Point3 {
        let [x, y, z] = self.position;
        Point3::new(x, y, z)
    }

    /// Towards where it came from: a unit vector, exact to 0.8 degrees.
    #[inline]
    #[must_use]
    pub fn wi(&self) -> Vector3 {
        self.rest.wi()
    }

    /// Whether it is a shadow photon.
    #[inline]
    #[must_use]
    pub const fn is_shadow(&self) -> bool {
        self.rest.flags & SHADOW != 0
    }

    /// The number of its trail in the table of the map, [`PhotonMap::trails`](super::PhotonMap::trails). Beyond the end are
    /// trails that the table has no room for.
    #[inline]
    #[must_use]
    pub const fn trail_number(&self) -> usize {
        (self.rest.flags >> TRAIL_SHIFT) as usize
    }

    /// Axis of a cut that this photon tells of, 0 to 2; 3 if none.
    #[must_use]
    pub const fn split_axis(&self) -> u8 {
        self.rest.split_axis()
    }
}

impl Rest {
    /// Packs a power, with the bytes of a direction and the flags but for the axis. The bits of position and power decide how
    /// the power is rounded, so that a map is a function of its photons alone.
    pub(super) fn new(
        position: [f32; 3],
        power: Xyz,
        codec: PowerCodec,
        direction: [u8; 2],
        flags: u16,
    ) -> Self {
        let [x, y, z] = position.map(|v| u64::from(v.to_bits()));
        let [bits_x, bits_y, bits_z] = power.to_array().map(|v| u64::from(v.to_bits()));
        let hash = hash64(&[x << 32 | bits_x, y << 32 | bits_y, z << 32 | bits_z]);
        let dither = [0, 21, 42].map(|shift| unit_f32(((hash >> shift) as u32) << 11));
        Self { power: codec.encode(power, dither), direction, flags: flags | u16::from(NO_AXIS) }
    }

    #[inline]
    pub(super) fn wi(self) -> Vector3 {
        direction::decode(self.direction)
    }

    pub(super) const fn split_axis(self) -> u8 {
        (self.flags & AXIS_MASK) as u8
    }

    pub(super) fn set_split_axis(&mut self, axis: u8) {
        self.flags = self.flags & !AXIS_MASK | u16::from(axis);
    }
}

/// Flags of a photon at which nothing is cut yet.
pub(super) fn flags(trail_number: u16, is_shadow: bool) -> u16 {
    trail_number.min(OTHER_TRAILS) << TRAIL_SHIFT | if is_shadow { SHADOW } else { 0 }
}
