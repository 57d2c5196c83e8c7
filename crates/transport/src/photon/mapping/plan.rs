//! What a map is to hold, and how it is made and asked: what scenes say of it, in one place.

use etendue_scene::Scene;

use super::settings::{MOST_PHOTONS, MappingSettings};
use crate::photon::estimate::DensityEstimate;
use crate::photon::settings::WalkLimits;
use crate::photon::{EmissionSettings, PhotonEmitter, PhotonWalk, Target, Trail};

/// Which photons are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// `L(S|D)*D`.
    All,
    /// Those that a surface has scattered: `L(S|D)+D`.
    Scattered,
    /// `LS+D`.
    Caustic,
}

impl Content {
    /// Names, as `etendue photons --map` knows them.
    pub const NAMES: [(&'static str, Self); 3] =
        [("global", Self::All), ("scattered", Self::Scattered), ("caustic", Self::Caustic)];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, content)| *content == self).map_or("", |(name, _)| name)
    }

    pub(super) fn holds(self, trail: Trail) -> bool {
        match self {
            Self::All => true,
            Self::Scattered => !trail.is_empty(),
            Self::Caustic => trail.is_caustic(),
        }
    }

    /// The most photons that are emitted for each one that is to be stored.
    pub(super) const fn most_emitted(self) -> u64 {
        // Where so few of those arrive that were aimed, caustics are faint.
        if matches!(self, Self::Caustic) { 10 } else { 30 }
    }

    /// True if a photon may yet come to what is kept, from a surface with these sharp lobes.
    pub(super) fn may_follow(self, trail: Trail, is_sharp: bool) -> bool {
        self != Self::Caustic || is_sharp && (trail.is_empty() || trail.is_caustic())
    }
}

/// A map to be filled.
#[derive(Clone, Debug)]
pub(crate) struct MapPlan {
    /// Photons to store, about.
    pub(crate) n_photons: u64,
    /// Which.
    pub(crate) content: Content,
    /// Where they are sent.
    pub(crate) emission: EmissionSettings,
    /// How they walk.
    pub(crate) walk: PhotonWalk,
    /// Photons of each estimate.
    pub(crate) k: usize,
    /// The greatest radius of an estimate in metres; `None` for one that fits the density.
    pub(crate) max_radius: Option<f32>,
    /// How density is estimated.
    pub(crate) estimate: DensityEstimate,
    /// The place of one of so many photons is told; 0 for none.
    pub(crate) place_step: usize,
    /// The parameter that may name a file of the map.
    pub(crate) parameter: &'static str,
    /// The file, as it is named.
    pub(crate) file: Option<String>,
}

impl MapPlan {
    /// Who sends its photons.
    #[must_use]
    pub(super) fn emitter(&self, scene: &Scene) -> PhotonEmitter {
        match self.emission.target {
            Target::Anything => PhotonEmitter::reaching(scene, &self.emission),
            _ => PhotonEmitter::aimed(scene, &self.emission),
        }
    }
}

/// Photons of different maps are independent.
const GLOBAL_STREAM: u32 = 0;
const CAUSTIC_STREAM: u32 = 1;

/// Photons of the global map, unless the scene says otherwise. What it blurs is seen by rays that gather alone, so that their
/// number need not grow with the image.
const GLOBAL_PHOTONS: u64 = 200_000;
/// Photons of the caustic map, unless the scene says otherwise: one for each pixel within these bounds, so that caustics, which are
/// seen directly, are blurred over the same number of pixels at any resolution.
const CAUSTIC_PHOTONS: std::ops::RangeInclusive<u64> = 200_000..=4_000_000;

/// Bytes of a photon in a map.
const PHOTON_BYTES: f32 = 20.5;
/// Bytes of irradiance that is computed before, at one place.
const PLACE_BYTES: f32 = 61.0;

/// Photons that fit into a share of memory in megabytes, where irradiance of so many maps is computed before at one of `place_step`.
fn photons_within(megabytes: f32, place_step: u32, n_maps: f32) -> u64 {
    let places = if place_step > 0 { n_maps * PLACE_BYTES / place_step as f32 } else { 0.0 };
    ((megabytes * 1e6 / (PHOTON_BYTES + places)) as u64).min(u64::from(MOST_PHOTONS))
}

impl MappingSettings {
    /// The global map of a scene.
    #[must_use]
    pub(crate) fn global_plan(&self, scene: &Scene) -> MapPlan {
        let by_default =
            || self.memory.map_or(GLOBAL_PHOTONS, |all| photons_within(0.5 * all, self.precompute, 2.0));
        MapPlan {
            n_photons: self.global_photons.map_or_else(by_default, u64::from),
            content: Content::All,
            emission: self.photons.towards(Target::Anything, self.sharp_alpha),
            walk: self.photons.walk(scene, GLOBAL_STREAM, self.limits()),
            k: self.global_k as usize,
            max_radius: self.global_radius,
            estimate: self.global_estimate(),
            place_step: self.precompute as usize,
            parameter: "globalmap",
            file: self.global_file.clone(),
        }
    }

    /// The caustic map of a scene.
    #[must_use]
    pub(crate) fn caustic_plan(&self, scene: &Scene) -> MapPlan {
        let by_pixels = || {
            let n_pixels = scene.film.crop.n_pixels() as u64;
            n_pixels.clamp(*CAUSTIC_PHOTONS.start(), *CAUSTIC_PHOTONS.end())
        };
        let by_default =
            || self.memory.map_or_else(by_pixels, |all| photons_within(0.5 * all, self.precompute, 1.0));
        MapPlan {
            n_photons: self.caustic_photons.map_or_else(by_default, u64::from),
            content: Content::Caustic,
            emission: self.photons.towards(Target::SharpShapes, self.sharp_alpha),
            walk: self.photons.walk(scene, CAUSTIC_STREAM, self.limits()),
            k: self.caustic_k as usize,
            max_radius: self.caustic_radius,
            estimate: self.estimate,
            place_step: self.precompute as usize,
            parameter: "causticmap",
            file: self.caustic_file.clone(),
        }
    }

    const fn limits(&self) -> WalkLimits {
        WalkLimits {
            max_depth: self.max_photon_depth,
            sharp_alpha: self.sharp_alpha,
            wavelengths: self.wavelengths,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn photons_of_a_budget() {
        assert_eq!(photons_within(0.0, 4, 2.0), 0);
        assert_eq!(photons_within(20.5, 0, 2.0), 1_000_000);
        // One photon in four has a place in each of two maps.
        assert_eq!(photons_within(51.0, 4, 2.0), 1_000_000);
        assert_eq!(photons_within(64_000.0, 0, 1.0), u64::from(MOST_PHOTONS));
    }
}
