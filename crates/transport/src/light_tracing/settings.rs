//! What scene files may say of light tracing.

use etendue_scene::parameters::{ParameterSpec, Parameters};

use crate::lpe::{SHARP_ALPHA, SHARP_ALPHA_PARAMETER, read_sharp_alpha};
use crate::path::camera_pass::WavelengthMode;
use crate::path_tracing::PathSettings;

/// Most scattering events of a path, each of which leaves something in memory.
const MAX_DEPTH: u32 = 1 << 16;

/// Most paths of a pass.
const MAX_PATHS: u32 = 1 << 30;

/// Settings of light tracing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSettings {
    /// Most scattering events of a path, that which the camera sees included; longer paths are lost, which darkens.
    pub max_depth: u32,
    /// Paths from the lights in each pass; `None` for one for each pixel.
    pub n_paths: Option<u32>,
    /// What mirrors and glass show is found by paths from the camera.
    pub mirrors: bool,
    /// Glossy events narrower than this count as specular in path expressions without `G` (SPEC LPE-5).
    pub sharp_alpha: f32,
    /// How wavelengths are chosen.
    pub wavelengths: WavelengthMode,
}

impl Default for LightSettings {
    fn default() -> Self {
        Self {
            max_depth: 5,
            n_paths: None,
            mirrors: false,
            sharp_alpha: SHARP_ALPHA,
            wavelengths: WavelengthMode::default(),
        }
    }
}

impl LightSettings {
    /// Parameters in scene files.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        ParameterSpec {
            name: "maxdepth",
            kind: "integer",
            default: "5",
            unit: "",
            doc: "most scattering events of a path; longer paths are lost",
        },
        ParameterSpec {
            name: "lightpaths",
            kind: "integer",
            default: "0",
            unit: "",
            doc: "paths from the lights in each pass; 0 for as many as there are pixels",
        },
        ParameterSpec {
            name: "mirrors",
            kind: "bool",
            default: "false",
            unit: "",
            doc: "find what mirrors and clear glass show by paths from the camera, else they show nothing",
        },
        SHARP_ALPHA_PARAMETER,
        WavelengthMode::PARAMETER,
    ];

    /// Reads the parameters of an integrator entity.
    pub fn from_parameters(p: &mut Parameters<'_, '_>) -> Self {
        let default = Self::default();
        let max_depth = p.count_within("maxdepth", default.max_depth, 0, MAX_DEPTH);
        let n_paths = p.count_within("lightpaths", 0, 0, MAX_PATHS);
        let mirrors = p.bool("mirrors", default.mirrors);
        let sharp_alpha = read_sharp_alpha(p);
        let wavelengths = p.choice("wavelengths", "hero", WavelengthMode::CHOICES);
        // Read where the scene is built; lights send paths by their power.
        p.ignore("lightsampler");
        Self { max_depth, n_paths: (n_paths > 0).then_some(n_paths), mirrors, sharp_alpha, wavelengths }
    }

    /// Of the paths from the camera that show what emits and, where wanted, what mirrors show.
    pub(super) fn of_camera_paths(&self) -> PathSettings {
        PathSettings {
            max_depth: if self.mirrors { self.max_depth } else { 0 },
            sharp_alpha: self.sharp_alpha,
            wavelengths: self.wavelengths,
            ..PathSettings::default()
        }
    }
}
