//! Photons seen directly (Jensen 2001, chapter 8; SPEC VIS-1 to VIS-6).
//!
//! Rays go from the camera through mirrors and glass; at the first surface that scatters widely the photon map is asked for its
//! radiance. Eye paths `(LS*E)|(DS*E)` and photons `L(S|D)*D` together are all paths. What is blurred is the image itself, so
//! that direct light needs many photons (SPEC VIS-3); shadow rays may bring it instead (VIS-4), which leaves the smoother rest to the
//! map. With a few hundred photons the picture is the quickest of all, without shadows (VIS-5). The map of caustics alone (VIS-2) is
//! the part that nothing else shows as fast; photons carry four wavelengths, and one behind a prism (VIS-6).

use etendue_scene::film::TileSamples;
use etendue_scene::parameters::{ParameterSpec, Parameters};
use etendue_scene::{Film, Scene};

use super::estimate::DensityEstimate;
use super::lack::Lack;
use super::mapping::{
    Content, EyeMethod, EyePass, LIGHT_SAMPLER, LitMap, MAX_PHOTON_DEPTH, MOST_NEIGHBOURS, MOST_PHOTONS,
    MapNames, MapPlan, Probe, SHARP_ALPHA_SPEC, Seen, check_least_photons, describe_map, file, length,
    n_parameters, obtain, spec, with_shared,
};
use super::settings::WalkLimits;
use super::{PhotonSettings, Target};
use crate::integrator::{Control, Integrator, PassEnd, Passes, ReportEntry};
use crate::lpe::{PathExpressions, SHARP_ALPHA, read_sharp_alpha};
use crate::path::camera_pass::{CameraPass, WavelengthMode};

/// What is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Show {
    /// All light, by photons.
    #[default]
    All,
    /// Direct light by shadow rays, the rest by photons.
    ShadowRays,
    /// Caustics alone, without lamps.
    Caustics,
}

/// Settings.
#[derive(Clone, Debug, PartialEq)]
pub struct DirectViewSettings {
    /// Photons to store, about.
    pub n_photons: u32,
    /// Photons of an estimate.
    pub k: u32,
    /// The greatest radius of an estimate in metres; `None` for one that fits the density of photons.
    pub max_radius: Option<f32>,
    /// File of the map, as it is named; `None` to make it.
    pub file: Option<String>,
    /// What is shown.
    pub show: Show,
    /// Most scattering events of a walk from the camera.
    pub max_depth: u32,
    /// Most scattering events of a photon.
    pub max_photon_depth: u32,
    /// Glossy lobes narrower than this are followed by rays (SPEC LPE-5).
    pub sharp_alpha: f32,
    /// How photons leave and walk.
    pub photons: PhotonSettings,
    /// How density is estimated.
    pub estimate: DensityEstimate,
    /// How wavelengths are chosen.
    pub wavelengths: WavelengthMode,
}

impl Default for DirectViewSettings {
    fn default() -> Self {
        Self {
            n_photons: 500_000,
            k: 200,
            max_radius: None,
            file: None,
            show: Show::default(),
            max_depth: 32,
            max_photon_depth: 64,
            sharp_alpha: SHARP_ALPHA,
            photons: PhotonSettings::default(),
            estimate: DensityEstimate::default(),
            wavelengths: WavelengthMode::default(),
        }
    }
}

const OWN_PARAMETERS: [ParameterSpec; 10] = [
    spec("photons", "integer", "500000", "", "photons to store, about"),
    spec("nearest", "integer", "200", "", "photons of an estimate"),
    spec("radius", "float", "by density", "m", "greatest radius of an estimate"),
    spec(
        "map",
        "string",
        "none",
        "",
        "file of the map, written by `etendue photons --map`, in place of tracing it",
    ),
    spec(
        "show",
        "string",
        "all",
        "",
        "all (by photons), shadowrays (these for direct light, photons for the rest) or caustics (nothing else)",
    ),
    spec("maxdepth", "integer", "32", "", "most mirrors and boundaries that the camera sees through"),
    MAX_PHOTON_DEPTH,
    SHARP_ALPHA_SPEC,
    LIGHT_SAMPLER,
    WavelengthMode::PARAMETER,
];

impl DirectViewSettings {
    /// Parameters in scene files.
    pub const PARAMETERS: &'static [ParameterSpec] =
        &with_shared::<{ n_parameters(OWN_PARAMETERS.len()) }>(&OWN_PARAMETERS);

    /// Reads the parameters of an integrator entity.
    pub fn from_parameters(p: &mut Parameters<'_, '_>) -> Self {
        let default = Self::default();
        // Read where the scene is built.
        p.ignore("lightsampler");
        let shows = [("all", Show::All), ("shadowrays", Show::ShadowRays), ("caustics", Show::Caustics)];
        let settings = Self {
            n_photons: p.count_within("photons", default.n_photons, 0, MOST_PHOTONS),
            k: p.count_within("nearest", default.k, 1, MOST_NEIGHBOURS),
            max_radius: length(p, "radius"),
            file: file(p, "map"),
            show: p.choice("show", "all", &shows),
            max_depth: p.count("maxdepth", default.max_depth),
            max_photon_depth: p.count("maxphotondepth", default.max_photon_depth),
            sharp_alpha: read_sharp_alpha(p),
            photons: PhotonSettings::from_parameters(p),
            estimate: DensityEstimate::from_parameters(p),
            wavelengths: p.choice("wavelengths", "hero", WavelengthMode::CHOICES),
        };
        let (estimate, k) = (&settings.estimate, settings.k);
        check_least_photons(p, estimate, "nearest", k, "photons show nothing");
        settings
    }

    /// What users are told of an empty map.
    fn advice(&self, lack: Lack) -> Option<&'static str> {
        match (lack, self.show) {
            (Lack::Unasked, _) => Some("\"photons\" is 0: what they would show is left out"),
            (Lack::Astray | Lack::Unkept, Show::Caustics) => Some(
                "no photon came through mirrors or glass to a surface that keeps it: there are no caustics",
            ),
            _ => lack.advice(),
        }
    }

    /// The map of a scene.
    #[must_use]
    pub(crate) fn plan(&self, scene: &Scene) -> MapPlan {
        let (content, target) = match self.show {
            Show::All => (Content::All, Target::Anything),
            Show::ShadowRays => (Content::Scattered, Target::Anything),
            Show::Caustics => (Content::Caustic, Target::SharpShapes),
        };
        let limits = WalkLimits {
            max_depth: self.max_photon_depth,
            sharp_alpha: self.sharp_alpha,
            wavelengths: self.wavelengths,
        };
        MapPlan {
            n_photons: u64::from(self.n_photons),
            content,
            emission: self.photons.towards(target, self.sharp_alpha),
            walk: self.photons.walk(scene, 0, limits),
            k: self.k as usize,
            max_radius: self.max_radius,
            estimate: self.estimate,
            place_step: 0,
            parameter: "map",
            file: self.file.clone(),
        }
    }
}

/// Photons seen directly.
#[derive(Debug)]
pub struct DirectView {
    settings: DirectViewSettings,
    expressions: PathExpressions,
    map: Option<(LitMap, Probe, Option<Lack>)>,
    /// Memory of the last pass's tiles, for the next.
    tiles: Vec<TileSamples>,
}

impl DirectView {
    /// A view of photons that fills the film's layers by these expressions.
    #[must_use]
    pub const fn new(settings: DirectViewSettings, expressions: PathExpressions) -> Self {
        Self { settings, expressions, map: None, tiles: Vec::new() }
    }
}

impl Integrator for DirectView {
    fn passes(&self) -> Passes {
        Passes::Independent
    }

    fn run_pass(&mut self, scene: &Scene, pass: u64, film: &mut Film, control: &Control<'_>) -> PassEnd {
        let settings = &self.settings;
        if self.map.is_none() {
            let plan = settings.plan(scene);
            self.map = obtain(scene, &plan, control).map(|(traced, lack)| {
                let map = LitMap::new(scene, &plan, traced.map);
                let probe = Probe::new(scene, &map, settings.sharp_alpha);
                (map, probe, lack)
            });
        }
        let Some((map, ..)) = &self.map else { return PassEnd::Cancelled };
        let camera_pass = CameraPass {
            wavelengths: settings.wavelengths,
            expressions: &self.expressions,
            group_size: 1,
            adaptive: None,
        };
        let method = EyeMethod {
            global: map,
            caustic: None,
            global_irradiance: None,
            caustic_irradiance: None,
            seen: match settings.show {
                Show::All => Seen::ByMap,
                Show::ShadowRays => Seen::ByMapAndShadowRays,
                Show::Caustics => Seen::ByMapAlone,
            },
            accurate_distance: 0.0,
            accurate_share: 0.0,
            n_gather: 1,
            max_depth: settings.max_depth,
            sharp_alpha: settings.sharp_alpha,
        };
        camera_pass.run(scene, pass, film, control, &mut self.tiles, &EyePass::new(method))
    }

    fn report(&self) -> Vec<ReportEntry> {
        let Some((map, probe, lack)) = &self.map else { return Vec::new() };
        let mut entries = describe_map(&NAMES, map, probe);
        if map.map.is_empty() {
            let advice = lack.and_then(|lack| self.settings.advice(lack));
            entries.push(ReportEntry::new("empty_map", 1.0, "").with_advice_if_any(advice));
        }
        entries
    }
}

const NAMES: MapNames = MapNames {
    emitted: "photons_emitted",
    stored: "photons_stored",
    mean_radius: "mean_radius",
    worst_radius: "worst_radius",
    max_radius: "max_radius",
    limited: "estimates_limited",
    photons_parameter: "photons",
    radius_parameter: "radius",
    expects_everywhere: true,
};
