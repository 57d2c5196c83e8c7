//! Classes of scattering: how spread out a lobe is, and on which side of the surface it leaves.
//!
//! The classes separate paths: a caustic is light that arrives at a diffuse lobe through specular ones
//! (SPEC BRDF-9). Six lobes exist, the product of {diffuse, glossy, specular} and {reflect, transmit}.

use std::fmt;
use std::ops::{BitAnd, BitOr, BitOrAssign, Not};

use etendue_math::Vector3;
use etendue_spectrum::Sampled;

/// A set of lobes.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Lobes(u8);

impl Lobes {
    /// The empty set.
    pub const NONE: Self = Self(0);
    /// Broad scattering to the side of `wo`.
    pub const DIFFUSE_REFLECT: Self = Self(1);
    /// Broad scattering through the surface.
    pub const DIFFUSE_TRANSMIT: Self = Self(2);
    /// Scattering around the mirror direction.
    pub const GLOSSY_REFLECT: Self = Self(4);
    /// Scattering around the refracted direction.
    pub const GLOSSY_TRANSMIT: Self = Self(8);
    /// Mirror reflection, a Dirac distribution.
    pub const SPECULAR_REFLECT: Self = Self(16);
    /// Refraction or straight passage, a Dirac distribution.
    pub const SPECULAR_TRANSMIT: Self = Self(32);
    /// Both diffuse lobes.
    pub const DIFFUSE: Self = Self(1 | 2);
    /// Both glossy lobes.
    pub const GLOSSY: Self = Self(4 | 8);
    /// Both specular lobes.
    pub const SPECULAR: Self = Self(16 | 32);
    /// The lobes on the side of `wo`.
    pub const REFLECT: Self = Self(1 | 4 | 16);
    /// The lobes on the other side.
    pub const TRANSMIT: Self = Self(2 | 8 | 32);
    /// Everything that is no Dirac distribution.
    pub const NON_SPECULAR: Self = Self(1 | 2 | 4 | 8);
    /// Everything.
    pub const ALL: Self = Self(63);

    /// Each lobe by itself.
    pub const EACH: [Self; 6] = [
        Self::DIFFUSE_REFLECT,
        Self::DIFFUSE_TRANSMIT,
        Self::GLOSSY_REFLECT,
        Self::GLOSSY_TRANSMIT,
        Self::SPECULAR_REFLECT,
        Self::SPECULAR_TRANSMIT,
    ];

    /// The lobes in either set.
    #[inline]
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// The lobes in both sets.
    #[inline]
    #[must_use]
    pub const fn intersection(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// True if every lobe of `other` is in this set.
    #[inline]
    #[must_use]
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// True if the sets share a lobe.
    #[inline]
    #[must_use]
    pub const fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// True if there is no lobe.
    #[inline]
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// True if there are lobes, all of them Dirac distributions.
    #[inline]
    #[must_use]
    pub const fn is_specular(self) -> bool {
        self.0 != 0 && self.0 & !Self::SPECULAR.0 == 0
    }

    /// True if some lobe is no Dirac distribution, so that connecting to it makes sense.
    #[inline]
    #[must_use]
    pub const fn has_non_specular(self) -> bool {
        self.0 & Self::NON_SPECULAR.0 != 0
    }

    /// True if some lobe is diffuse.
    #[inline]
    #[must_use]
    pub const fn is_diffuse(self) -> bool {
        self.0 & Self::DIFFUSE.0 != 0
    }

    /// True if some lobe is glossy.
    #[inline]
    #[must_use]
    pub const fn is_glossy(self) -> bool {
        self.0 & Self::GLOSSY.0 != 0
    }

    /// True if some lobe reflects.
    #[inline]
    #[must_use]
    pub const fn is_reflective(self) -> bool {
        self.0 & Self::REFLECT.0 != 0
    }

    /// True if some lobe transmits.
    #[inline]
    #[must_use]
    pub const fn is_transmissive(self) -> bool {
        self.0 & Self::TRANSMIT.0 != 0
    }
}

impl BitOr for Lobes {
    type Output = Self;
    #[inline]
    fn bitor(self, other: Self) -> Self {
        self.union(other)
    }
}

impl BitOrAssign for Lobes {
    #[inline]
    fn bitor_assign(&mut self, other: Self) {
        *self = self.union(other);
    }
}

impl BitAnd for Lobes {
    type Output = Self;
    #[inline]
    fn bitand(self, other: Self) -> Self {
        self.intersection(other)
    }
}

impl Not for Lobes {
    type Output = Self;
    #[inline]
    fn not(self) -> Self {
        Self(!self.0 & Self::ALL.0)
    }
}

impl fmt::Debug for Lobes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const NAMES: [&str; 6] = [
            "diffuse reflect",
            "diffuse transmit",
            "glossy reflect",
            "glossy transmit",
            "specular reflect",
            "specular transmit",
        ];
        let mut list = f.debug_set();
        for (lobe, name) in Lobes::EACH.into_iter().zip(NAMES) {
            if self.contains(lobe) {
                list.entry(&format_args!("{name}"));
            }
        }
        list.finish()
    }
}

/// What a path carries from vertex to vertex. Radiance changes by a factor of the squared index ratio at refraction,
/// flux does not (SPEC FRES-8).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransportMode {
    /// The path starts at the camera; `wi` points to where light comes from.
    Radiance,
    /// The path starts at a light, carries flux, and `wi` points to where it goes.
    Importance,
}

impl TransportMode {
    /// The other mode.
    #[inline]
    #[must_use]
    pub const fn flipped(self) -> Self {
        match self {
            Self::Radiance => Self::Importance,
            Self::Importance => Self::Radiance,
        }
    }
}

/// A direction chosen by a BSDF.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// The chosen direction, away from the surface, of unit length.
    pub wi: Vector3,
    /// `f |cos| / pdf`: what the path's throughput is multiplied by.
    pub weight: Sampled,
    /// Density in 1/sr, equal to [`Bsdf::pdf`](super::Bsdf::pdf) for the same lobes; 0 for specular lobes.
    pub pdf_w: f32,
    /// Probability of the choice for specular lobes, 0 for others.
    pub pmf: f32,
    /// The one lobe that was chosen.
    pub lobe: Lobes,
    /// Index of the medium of `wi` relative to that of `wo`; 1 without refraction.
    pub eta: f32,
    /// Width of the lobe as GGX alpha: 0 for specular, 1 for diffuse.
    pub roughness: f32,
}

impl BsdfSample {
    /// True if the direction was the only one possible: no other technique can find it.
    #[inline]
    #[must_use]
    pub const fn is_specular(&self) -> bool {
        self.lobe.is_specular()
    }

    /// True if the path goes on behind the surface.
    #[inline]
    #[must_use]
    pub const fn is_transmission(&self) -> bool {
        self.lobe.is_transmissive()
    }

    /// A sample of a specular lobe.
    #[inline]
    pub(crate) const fn specular(wi: Vector3, weight: Sampled, pmf: f32, lobe: Lobes, eta: f32) -> Self {
        Self { wi, weight, pdf_w: 0.0, pmf, lobe, eta, roughness: 0.0 }
    }
}
