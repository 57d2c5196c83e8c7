//! What scene files may say of the path tracer.

use etendue_scene::document::{Entity, Value};
use etendue_scene::parameters::{ParameterSpec, Parameters};

use crate::lpe::{SHARP_ALPHA, SHARP_ALPHA_PARAMETER, read_sharp_alpha};
use crate::path::adaptive::AdaptivePixels;
use crate::path::camera_pass::WavelengthMode;

/// Largest side of a group of pixels that share paths.
pub(super) const MAX_REUSE: u32 = 8;

/// How lights are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightStrategy {
    /// By sampling them and by running into them, weighted (the best).
    #[default]
    Both,
    /// By sampling them alone, but for what sampling cannot find.
    Lights,
    /// By running into them alone: slow for small lights, black for point lights (SPEC PT-1).
    Scattering,
}

/// Settings of the path tracer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSettings {
    /// Most scattering events of a path; paths that would need more are lost, which darkens.
    pub max_depth: u32,
    /// Paths of more scattering events than this play roulette.
    pub roulette_depth: u32,
    /// Paths whose throughput is below this play roulette.
    pub roulette_threshold: f32,
    /// Directions in which a path goes on from each surface; 1 for path tracing, more to see why (SPEC PT-2).
    pub branches: u32,
    /// Walks that share the way from the camera to the first surface that scatters widely.
    pub splitting: u32,
    /// Light samples at the surface where these walks part.
    pub light_samples: u32,
    /// Pixels across and down of the groups whose paths share what they find; 1 for none.
    pub reuse: u32,
    /// Widens narrow lobes after the first wide scattering event: less noise, biased.
    pub regularize: bool,
    /// Glossy events narrower than this count as specular in path expressions without `G` (SPEC LPE-5).
    pub sharp_alpha: f32,
    /// How lights are found.
    pub lights: LightStrategy,
    /// How wavelengths are chosen.
    pub wavelengths: WavelengthMode,
    /// Interpolates pixels; biased.
    pub adaptive: Option<AdaptivePixels>,
}

impl Default for PathSettings {
    fn default() -> Self {
        Self {
            max_depth: 5,
            roulette_depth: 1,
            roulette_threshold: 0.5,
            branches: 1,
            splitting: 1,
            light_samples: 1,
            reuse: 1,
            regularize: false,
            sharp_alpha: SHARP_ALPHA,
            lights: LightStrategy::default(),
            wavelengths: WavelengthMode::default(),
            adaptive: None,
        }
    }
}

impl PathSettings {
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
            name: "roulettedepth",
            kind: "integer",
            default: "1",
            unit: "",
            doc: "scattering events before roulette may end a path",
        },
        ParameterSpec {
            name: "roulettethreshold",
            kind: "float",
            default: "0.5",
            unit: "",
            doc: "throughput below which roulette may end a path; a path of half of it lives on with probability 1/2",
        },
        ParameterSpec {
            name: "branches",
            kind: "integer",
            default: "1",
            unit: "",
            doc: "directions in which a path goes on from each surface; more than 1 only to compare with",
        },
        ParameterSpec {
            name: "splitting",
            kind: "integer",
            default: "1",
            unit: "",
            doc: "walks that share the way from the camera to the first surface that scatters widely",
        },
        ParameterSpec {
            name: "lightsamples",
            kind: "integer",
            default: "as splitting",
            unit: "",
            doc: "samples of the lights at the surface where these walks part",
        },
        ParameterSpec {
            name: "reuse",
            kind: "integer",
            default: "1",
            unit: "pixels",
            doc: "side of the groups of pixels whose paths share the surfaces that they find, 1 to 8; 1 for none",
        },
        ParameterSpec {
            name: "regularize",
            kind: "bool",
            default: "false",
            unit: "",
            doc: "widen narrow lobes after the first wide one: less noise, biased",
        },
        SHARP_ALPHA_PARAMETER,
        ParameterSpec {
            name: "lights",
            kind: "string",
            default: "both",
            unit: "",
            doc: "how lights are found: both, lights (sampling alone) or scattering (running into them alone)",
        },
        ParameterSpec {
            name: "lightsampler",
            kind: "string",
            default: "bvh",
            unit: "",
            doc: "how a light is chosen: bvh, power or uniform",
        },
        WavelengthMode::PARAMETER,
        AdaptivePixels::PIXELS,
        AdaptivePixels::CONTRAST,
        AdaptivePixels::BLOCK_SIZE,
    ];

    /// Reads the parameters of an integrator entity.
    pub fn from_parameters(p: &mut Parameters<'_, '_>) -> Self {
        let default = Self::default();
        let max_depth = p.count("maxdepth", default.max_depth);
        let roulette_depth = p.count("roulettedepth", default.roulette_depth);
        let roulette_threshold = p.float("roulettethreshold", default.roulette_threshold);
        let branches = p.count("branches", default.branches).max(1);
        let splitting = p.count("splitting", default.splitting).max(1);
        let light_samples = p.count("lightsamples", splitting).max(1);
        let reuse = p.count_within("reuse", default.reuse, 1, MAX_REUSE);
        let regularize = p.bool("regularize", false);
        let sharp_alpha = read_sharp_alpha(p);
        let strategies = [
            ("both", LightStrategy::Both),
            ("lights", LightStrategy::Lights),
            ("scattering", LightStrategy::Scattering),
        ];
        let lights = p.choice("lights", "both", &strategies);
        let wavelengths = p.choice("wavelengths", "hero", WavelengthMode::CHOICES);
        let adaptive = AdaptivePixels::from_parameters(p);
        // Read where the scene is built.
        p.ignore("lightsampler");
        Self {
            max_depth,
            roulette_depth,
            roulette_threshold,
            branches,
            splitting,
            light_samples,
            reuse,
            regularize,
            sharp_alpha,
            lights,
            wavelengths,
            adaptive,
        }
    }

    /// The entity that gives these settings.
    #[must_use]
    pub fn to_entity(self) -> Entity {
        Entity::new("path").with("maxdepth", Value::Integers(vec![self.max_depth as i32]))
    }
}
