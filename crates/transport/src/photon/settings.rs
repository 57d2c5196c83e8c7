//! Parameters of scene files that say how photons leave lights and walk, for every method that follows photons.

use etendue_scene::Scene;
use etendue_scene::parameters::{ParameterSpec, Parameters};

use super::{Absorption, EmissionSettings, MapScheme, PhotonPattern, PhotonWalk, Target};
use crate::path::camera_pass::WavelengthMode;

/// What else a method says of the walk of its photons.
#[derive(Clone, Copy, Debug)]
pub struct WalkLimits {
    /// Most scattering events.
    pub max_depth: u32,
    /// Glossy events narrower than this are sharp.
    pub sharp_alpha: f32,
    /// Choice of wavelengths.
    pub wavelengths: WavelengthMode,
}

/// How photons leave and walk, as a scene asks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhotonSettings {
    /// In what pattern they leave.
    pub pattern: PhotonPattern,
    /// What becomes of what surfaces absorb.
    pub absorption: Absorption,
    /// How they find the cells of projection maps.
    pub scheme: MapScheme,
    /// Cells along the side of a projection map; 0 for no maps.
    pub n_cells: u32,
}

impl Default for PhotonSettings {
    fn default() -> Self {
        Self {
            pattern: PhotonPattern::default(),
            absorption: Absorption::default(),
            scheme: MapScheme::default(),
            n_cells: 128,
        }
    }
}

impl PhotonSettings {
    /// Parameters in scene files.
    pub const PARAMETERS: [ParameterSpec; 4] = [Self::PATTERN, Self::ABSORPTION, Self::CELLS, Self::SCHEME];

    /// `photonpattern`.
    pub const PATTERN: ParameterSpec = ParameterSpec {
        name: "photonpattern",
        kind: "string",
        default: "qmc",
        unit: "",
        doc: "pattern in which photons leave: qmc (scrambled Sobol), stratified, random, or grid (shows in caustics)",
    };
    const ABSORPTION: ParameterSpec = ParameterSpec {
        name: "absorption",
        kind: "string",
        default: "roulette",
        unit: "",
        doc: "photons become fewer (roulette), or for comparison weaker (scale) or many (branch)",
    };
    const CELLS: ParameterSpec = ParameterSpec {
        name: "projectioncells",
        kind: "integer",
        default: "128",
        unit: "",
        doc: "cells along the side of a projection map, at most 1024; 0 for no maps",
    };
    const SCHEME: ParameterSpec = ParameterSpec {
        name: "projectionscheme",
        kind: "string",
        default: "cell",
        unit: "",
        doc: "photons choose an active cell (cell), or directions until one is active (retry)",
    };

    /// Reads the four parameters of an integrator entity.
    pub fn from_parameters(p: &mut Parameters<'_, '_>) -> Self {
        Self {
            pattern: Self::read_pattern(p),
            absorption: p.choice("absorption", "roulette", &Absorption::NAMES),
            n_cells: p.count_within("projectioncells", 128, 0, 1024),
            scheme: p.choice("projectionscheme", "cell", &MapScheme::NAMES),
        }
    }

    /// Reads `photonpattern`.
    pub fn read_pattern(p: &mut Parameters<'_, '_>) -> PhotonPattern {
        p.choice("photonpattern", "qmc", &PhotonPattern::NAMES)
    }

    /// How photons walk through a scene.
    #[must_use]
    pub const fn walk(&self, scene: &Scene, stream: u32, limits: WalkLimits) -> PhotonWalk {
        PhotonWalk {
            max_depth: limits.max_depth,
            sharp_alpha: limits.sharp_alpha,
            wavelengths: limits.wavelengths,
            pattern: self.pattern,
            absorption: self.absorption,
            sampler: scene.sampler,
            stream,
        }
    }

    /// What photons for a target are sent by.
    #[must_use]
    pub fn towards(&self, target: Target, sharp_alpha: f32) -> EmissionSettings {
        let target = if self.n_cells == 0 { Target::Anything } else { target };
        EmissionSettings { target, scheme: self.scheme, n_cells: self.n_cells, sharp_alpha }
    }
}
