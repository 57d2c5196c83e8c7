//! What recursive ray tracing may be told.

use etendue_scene::parameters::{ParameterSpec, Parameters};

use crate::lpe::{SHARP_ALPHA, SHARP_ALPHA_PARAMETER, read_sharp_alpha};
use crate::path::camera_pass::WavelengthMode;

/// The largest depth: each level may double the rays.
const MAX_DEPTH: u32 = 32;

/// Where the shadow ray of a light with an area goes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightPlace {
    /// To a random place, so that shadows become soft with many samples (Cook, Porter and Carpenter 1984).
    #[default]
    Random,
    /// To the middle of what can be sampled, so that all shadows are hard, without noise.
    Middle,
}

/// Settings of recursive ray tracing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WhittedSettings {
    /// Most scattering events between the camera and a light.
    pub max_depth: u32,
    /// Where shadow rays go.
    pub place: LightPlace,
    /// Glossy events narrower than this count as specular in path expressions without `G` (SPEC LPE-5).
    pub sharp_alpha: f32,
    /// How wavelengths are chosen.
    pub wavelengths: WavelengthMode,
}

impl Default for WhittedSettings {
    fn default() -> Self {
        Self {
            max_depth: 5,
            place: LightPlace::default(),
            sharp_alpha: SHARP_ALPHA,
            wavelengths: WavelengthMode::default(),
        }
    }
}

impl WhittedSettings {
    /// Parameters in scene files.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        ParameterSpec {
            name: "maxdepth",
            kind: "integer",
            default: "5",
            unit: "",
            doc: "most scattering events between the camera and a light, at most 32; the rays of a sample may double with each",
        },
        ParameterSpec {
            name: "shadowrays",
            kind: "string",
            default: "random",
            unit: "",
            doc: "where the shadow ray of a light with an area goes: random (soft shadows) or middle (hard ones)",
        },
        SHARP_ALPHA_PARAMETER,
        ParameterSpec {
            name: "lightsampler",
            kind: "string",
            default: "bvh",
            unit: "",
            doc: "how a light is chosen where there are more than 64: bvh, power or uniform",
        },
        WavelengthMode::PARAMETER,
    ];

    /// Reads the parameters of an integrator entity.
    pub fn from_parameters(p: &mut Parameters<'_, '_>) -> Self {
        let default = Self::default();
        let places = [("random", LightPlace::Random), ("middle", LightPlace::Middle)];
        // Read where the scene is built.
        p.ignore("lightsampler");
        Self {
            max_depth: p.count_within("maxdepth", default.max_depth, 0, MAX_DEPTH),
            place: p.choice("shadowrays", "random", &places),
            sharp_alpha: read_sharp_alpha(p),
            wavelengths: p.choice("wavelengths", "hero", WavelengthMode::CHOICES),
        }
    }
}
