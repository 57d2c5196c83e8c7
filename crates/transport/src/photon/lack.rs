//! Why there are no photons, as far as users may care.

use etendue_scene::Scene;

use super::PhotonEmitter;

/// Why a map holds no photons.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lack {
    /// None were asked for.
    Unasked,
    /// No light sends any.
    Dark,
    /// None meets a shape, or less than one of thousands.
    Astray,
    /// Those that meet shapes are not for the map: mirrors and clear glass keep none, or none comes to a second surface.
    Unkept,
}

impl Lack {
    /// What lies with the lights; `None` if their photons meet shapes.
    pub(super) fn of_light(scene: &Scene, emitter: &PhotonEmitter) -> Option<Self> {
        if emitter.is_dark() {
            return Some(Self::Dark);
        }
        (emitter.is_idle() || emitter.hit_share(scene) == 0.0).then_some(Self::Astray)
    }

    /// What users are told if they would not know by themselves. Nothing is wrong where no photon is kept.
    pub(super) const fn advice(self) -> Option<&'static str> {
        match self {
            Self::Dark => Some(
                "no light sends photons into the scene: there is nothing but what lamps and surroundings show",
            ),
            Self::Astray => Some(
                "next to no photon meets a shape: lights shine past the scene, or are far from it; check where they are and where they point",
            ),
            Self::Unasked | Self::Unkept => None,
        }
    }
}
