//! A photon map as bytes, to be kept in a file: a walk through a scene reuses it.
//!
//! Little-endian:
//!
//! | bytes | |
//! |---|---|
//! | 8 | `ETPHOTON` |
//! | 4 | version, 1 |
//! | 4 | what powers are: 0 for XYZ, 1 for RGB |
//! | 8 | number of photons that were emitted |
//! | 4 | number of trails, `t` |
//! | 4 | number of photons, `n` |
//! | 8 t | trails |
//! | 20 n | photons ([`Photon`]) in the order of the tree |
//! | 8 | hash of all before |
//!
//! The cuts of the tree are found again from its order and from the axes in the flags, which also shows whether the order is
//! one of a tree. Nothing that is read can make a later question fail.

use std::fmt;

use etendue_geometry::points::{NotInOrder, PackedPoints};
use etendue_math::{Point3, hash64};

use super::record::{NO_AXIS, OTHER_TRAILS, Photon, Rest};
use super::{PhotonMap, PowerCodec};
use crate::photon::Trail;

const MAGIC: [u8; 8] = *b"ETPHOTON";
const VERSION: u32 = 1;
const HEADER: usize = 32;
const PHOTON: usize = 20;
const TRAIL: usize = 8;
const HASH: usize = 8;

/// Why bytes are no photon map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhotonMapError {
    /// They do not begin as one does.
    NotAMap,
    /// The version is one that this program does not know.
    Version(u32),
    /// There are fewer or more bytes than the header tells of.
    Length {
        /// By the header.
        expected: u64,
        /// What there is.
        found: u64,
    },
    /// The hash is not that of the bytes.
    Damaged,
    /// The header, a trail or the flags of a photon hold what no map has.
    Content,
    /// The photons are not in the order of a tree, or their positions not finite.
    Order,
    /// It is a map that no method made, with less than methods need.
    NotOfMethod,
}

impl fmt::Display for PhotonMapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotAMap => f.write_str("it is not a photon map"),
            Self::Version(version) => {
                write!(f, "it is a photon map of version {version}; this program reads version {VERSION}")
            }
            Self::Length { expected, found } => {
                write!(
                    f,
                    "a photon map of {expected} bytes is expected, {found} were found: it is cut short or damaged"
                )
            }
            Self::Damaged => f.write_str("the photon map is damaged: its check sum is wrong"),
            Self::Content => f.write_str("the photon map is damaged: it holds values that no map has"),
            Self::Order => {
                f.write_str("the photon map is damaged: its photons are not finite or not in order")
            }
            Self::NotOfMethod => f.write_str("it was not written for a method, but to be looked at"),
        }
    }
}

impl std::error::Error for PhotonMapError {}

impl From<NotInOrder> for PhotonMapError {
    fn from(_: NotInOrder) -> Self {
        Self::Order
    }
}

impl PhotonMap {
    /// The map as bytes: the same for the same photons, on every machine.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let n = HEADER + self.trails.len() * TRAIL + self.len() * PHOTON + HASH;
        let mut bytes = Vec::with_capacity(n);
        let codec: u32 = match self.codec {
            PowerCodec::Xyz => 0,
            PowerCodec::Rgb => 1,
        };
        bytes.extend(MAGIC);
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(codec.to_le_bytes());
        bytes.extend(self.n_emitted.to_le_bytes());
        bytes.extend((self.trails.len() as u32).to_le_bytes());
        bytes.extend((self.len() as u32).to_le_bytes());
        bytes.extend(self.trails.iter().flat_map(|trail| trail.bits().to_le_bytes()));
        self.photons().for_each(|photon| bytes.extend(photon.to_bytes()));
        bytes.extend(hash(&bytes).to_le_bytes());
        bytes
    }

    /// The map that [`Self::to_bytes`] wrote.
    ///
    /// # Errors
    /// If the bytes are none, of another version, cut short or damaged.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, PhotonMapError> {
        let mut reader = Reader(bytes);
        if reader.array::<8>() != Some(MAGIC) {
            return Err(PhotonMapError::NotAMap);
        }
        let length = |expected: u64| PhotonMapError::Length { expected, found: bytes.len() as u64 };
        let version = reader.u32().ok_or_else(|| length(HEADER as u64))?;
        if version != VERSION {
            return Err(PhotonMapError::Version(version));
        }
        let header = (|| Some((reader.u32()?, reader.u64()?, reader.u32()?, reader.u32()?)))();
        let (codec, n_emitted, n_trails, n_photons) = header.ok_or_else(|| length(HEADER as u64))?;
        // Nothing is reserved before the bytes are known to be there.
        let content = u64::from(n_trails) * TRAIL as u64 + u64::from(n_photons) * PHOTON as u64;
        let expected = (HEADER + HASH) as u64 + content;
        if expected != bytes.len() as u64 {
            return Err(length(expected));
        }
        let (content, stored_hash) = bytes.split_at(bytes.len() - HASH);
        if Reader(stored_hash).u64() != Some(hash(content)) {
            return Err(PhotonMapError::Damaged);
        }
        let codec = match codec {
            0 => PowerCodec::Xyz,
            1 => PowerCodec::Rgb,
            _ => return Err(PhotonMapError::Content),
        };
        let (trails, photons) = content[HEADER..].split_at(n_trails as usize * TRAIL);
        let trails = read_trails(trails).ok_or(PhotonMapError::Content)?;
        let photons: Vec<Photon> = photons.as_chunks().0.iter().map(Photon::from_bytes).collect();
        let positions: Vec<Point3> = photons.iter().map(Photon::position).collect();
        let points = PackedPoints::from_ordered(&positions, |place| photons[place as usize].split_axis())?;
        let rest = photons.iter().map(|photon| photon.rest).collect();
        let map = Self { points, rest, codec, trails, n_emitted };
        if map.has_sound_flags() { Ok(map) } else { Err(PhotonMapError::Content) }
    }

    /// Whether trails are in the table, and only those photons name an axis that lie behind a cut.
    fn has_sound_flags(&self) -> bool {
        let has_trail = |photon: &Photon| {
            let number = photon.trail_number();
            number < self.trails.len() || number == usize::from(OTHER_TRAILS)
        };
        let n_cut = self.photons().filter(|photon| photon.split_axis() != NO_AXIS).count();
        self.photons().all(|photon| has_trail(&photon)) && n_cut == self.points.cuts().len()
    }
}

impl Photon {
    /// The 20 bytes of the photon.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; PHOTON] {
        let mut bytes = [0; PHOTON];
        for (place, coordinate) in bytes.as_chunks_mut::<4>().0.iter_mut().zip(self.position) {
            *place = coordinate.to_le_bytes();
        }
        bytes[12..16].copy_from_slice(&self.rest.power);
        bytes[16..18].copy_from_slice(&self.rest.direction);
        bytes[18..].copy_from_slice(&self.rest.flags.to_le_bytes());
        bytes
    }

    fn from_bytes(bytes: &[u8; PHOTON]) -> Self {
        let [a, b, c, d, e, f, g, h, i, j, k, l, x, y, z, exponent, theta, phi, low, high] = *bytes;
        Self {
            position: [[a, b, c, d], [e, f, g, h], [i, j, k, l]].map(f32::from_le_bytes),
            rest: Rest {
                power: [x, y, z, exponent],
                direction: [theta, phi],
                flags: u16::from_le_bytes([low, high]),
            },
        }
    }
}

/// Trails; `None` if one of them is none.
fn read_trails(bytes: &[u8]) -> Option<Vec<Trail>> {
    let words = bytes.as_chunks().0.iter().map(|word| u64::from_le_bytes(*word));
    let trails: Vec<Trail> = words.map(Trail::from_bits).collect::<Option<_>>()?;
    (trails.len() <= usize::from(OTHER_TRAILS)).then_some(trails)
}

/// A hash of bytes, the same on every machine.
pub(in crate::photon) fn hash(bytes: &[u8]) -> u64 {
    let (words, rest) = bytes.as_chunks::<8>();
    let mut tail = [0; 8];
    tail[..rest.len()].copy_from_slice(rest);
    let start = hash64(&[u64::from_le_bytes(tail), bytes.len() as u64]);
    words.iter().fold(start, |hash, word| hash64(&[hash, u64::from_le_bytes(*word)]))
}

/// Bytes that are read one number after the other; `None` beyond their end.
pub(in crate::photon) struct Reader<'a>(pub(in crate::photon) &'a [u8]);

impl Reader<'_> {
    pub(in crate::photon) fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (array, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*array)
    }

    pub(in crate::photon) fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub(in crate::photon) fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }
}

#[cfg(test)]
mod tests {
    use etendue_geometry::points::Neighbours;
    use etendue_math::Rng;

    use super::super::tests::random_map;
    use super::*;

    /// With the hash that belongs to them.
    fn signed(mut bytes: Vec<u8>) -> Vec<u8> {
        let n = bytes.len() - HASH;
        let hash = hash(&bytes[..n]);
        bytes[n..].copy_from_slice(&hash.to_le_bytes());
        bytes
    }

    /// What is read answers as what was written, and is written as the same bytes.
    #[test]
    fn round_trip() {
        for n in [0, 1, 15, 16, 17, 33, 5000] {
            let (_, map) = random_map(n, 11);
            let bytes = map.to_bytes();
            assert_eq!(bytes.len(), HEADER + HASH + map.trails().len() * TRAIL + n * PHOTON);
            let read = PhotonMap::from_bytes(&bytes).expect("it was written so");
            assert!(read.photons().eq(map.photons()) && read.trails() == map.trails());
            assert_eq!((read.n_emitted(), read.len()), (map.n_emitted(), n));
            assert_eq!(read.to_bytes(), bytes);
            let mut rng = Rng::new(12, 0);
            let (mut a, mut b) = (Neighbours::new(), Neighbours::new());
            for _ in 0..50 {
                let p = Point3::new(rng.next_f32(), 0.0, rng.next_f32());
                map.nearest(p, 20, 0.3, &mut a);
                read.nearest(p, 20, 0.3, &mut b);
                assert!(a.iter().eq(b.iter()));
            }
        }
    }

    /// Bytes that are cut short anywhere, or too many, are an error.
    #[test]
    fn lengths() {
        let bytes = random_map(40, 13).1.to_bytes();
        for n in 0..bytes.len() {
            assert!(PhotonMap::from_bytes(&bytes[..n]).is_err(), "{n} bytes");
        }
        let mut longer = bytes;
        longer.push(0);
        assert!(matches!(PhotonMap::from_bytes(&longer), Err(PhotonMapError::Length { .. })));
        longer[28..32].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(matches!(PhotonMap::from_bytes(&longer), Err(PhotonMapError::Length { .. })));
    }

    /// Every flipped bit is noticed; with a hash that fits, what is read is refused or a map that answers.
    #[test]
    fn damage() {
        let bytes = random_map(40, 14).1.to_bytes();
        let mut found = Neighbours::new();
        for bit in 0..bytes.len() * 8 {
            let mut damaged = bytes.clone();
            damaged[bit / 8] ^= 1 << (bit % 8);
            assert!(PhotonMap::from_bytes(&damaged).is_err(), "bit {bit}");
            if let Ok(map) = PhotonMap::from_bytes(&signed(damaged)) {
                map.nearest(Point3::splat(0.5), 50, f32::INFINITY, &mut found);
                for photon in map.photons() {
                    assert!(map.power(&photon).y.is_finite() && photon.wi().is_finite());
                    let _ = map.trail(&photon);
                }
            }
        }
    }

    /// The kinds of errors, each with a fitting hash where one is looked at.
    #[test]
    fn errors() {
        let bytes = random_map(40, 15).1.to_bytes();
        let n_trails = u32::from_le_bytes([bytes[24], bytes[25], bytes[26], bytes[27]]) as usize;
        let with = |at: usize, new: &[u8]| {
            let mut bytes = bytes.clone();
            bytes[at..at + new.len()].copy_from_slice(new);
            PhotonMap::from_bytes(&signed(bytes)).expect_err("it is damaged")
        };
        let first = HEADER + n_trails * TRAIL;
        assert_eq!(with(0, b"P"), PhotonMapError::NotAMap);
        assert_eq!(with(8, &[2]), PhotonMapError::Version(2));
        assert_eq!(with(12, &[7]), PhotonMapError::Content);
        assert_eq!(with(HEADER, &u64::MAX.to_le_bytes()), PhotonMapError::Content);
        assert_eq!(with(first, &f32::NAN.to_le_bytes()), PhotonMapError::Order);
        assert_eq!(with(first, &f32::INFINITY.to_le_bytes()), PhotonMapError::Order);
        assert_eq!(with(first + 18, &0x7ff3_u16.to_le_bytes()), PhotonMapError::Content);
        // A photon of the first bucket beyond all others.
        assert_eq!(with(first, &[0; 3].map(|_| 9e9_f32.to_le_bytes()).concat()), PhotonMapError::Order);
        let mut flipped = bytes.clone();
        flipped[first] ^= 1;
        assert_eq!(PhotonMap::from_bytes(&flipped).expect_err("it is damaged"), PhotonMapError::Damaged);
        assert_eq!(PhotonMap::from_bytes(&[]).expect_err("it is empty"), PhotonMapError::NotAMap);
    }
}
