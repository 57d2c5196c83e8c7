//! What scene files say of photon mapping.

use etendue_scene::parameters::{ParameterSpec, Parameters};

use crate::lpe::{SHARP_ALPHA, SHARP_ALPHA_PARAMETER, read_sharp_alpha};
use crate::path::camera_pass::WavelengthMode;
use crate::photon::PhotonSettings;
use crate::photon::estimate::{DensityEstimate, Filter};

/// The most photons of a map.
pub(in crate::photon) const MOST_PHOTONS: u32 = 1 << 26;
/// The most megabytes of maps.
const MOST_MEGABYTES: f32 = 64_000.0;
/// The most photons of an estimate.
pub(in crate::photon) const MOST_NEIGHBOURS: u32 = 1 << 16;
/// The most rays that gather from one place.
const MOST_GATHER_RAYS: u32 = 4096;

/// Settings of the two-pass renderer.
#[derive(Clone, Debug, PartialEq)]
pub struct MappingSettings {
    /// Photons of the global map, about; `None` for as many as are sensible, or as memory holds.
    pub global_photons: Option<u32>,
    /// Photons of the caustic map, about; `None` for as many as are sensible, or as memory holds.
    pub caustic_photons: Option<u32>,
    /// Megabytes that both maps may take where numbers of photons are not given.
    pub memory: Option<f32>,
    /// File of the global map, as it is named; `None` to make it.
    pub global_file: Option<String>,
    /// File of the caustic map, as it is named; `None` to make it.
    pub caustic_file: Option<String>,
    /// Photons of an estimate of the global map.
    pub global_k: u32,
    /// Photons of an estimate of the caustic map.
    pub caustic_k: u32,
    /// The greatest radius of such an estimate in metres; `None` for one that fits the density of photons.
    pub global_radius: Option<f32>,
    /// The greatest radius of such an estimate in metres; `None` for one that fits the density of photons.
    pub caustic_radius: Option<f32>,
    /// Rays that gather are followed accurately at surfaces nearer than this, in metres; `None` for twice the radius of estimates.
    pub accurate_distance: Option<f32>,
    /// Surfaces seen by sharp scattering whose share of a pixel's light is less than this are treated approximately (SPEC PM-6).
    pub accurate_share: f32,
    /// Rays that gather from each surface that is seen.
    pub gather_rays: u32,
    /// Irradiance is computed before at one of so many photons; 0 for nowhere.
    pub precompute: u32,
    /// Most scattering events of a walk from the camera.
    pub max_depth: u32,
    /// Most scattering events of a photon.
    pub max_photon_depth: u32,
    /// Glossy lobes narrower than this are followed by rays, wider ones ask the maps (SPEC LPE-5).
    pub sharp_alpha: f32,
    /// Whether the terms have layers.
    pub layers: bool,
    /// How photons leave and walk.
    pub photons: PhotonSettings,
    /// How density is estimated.
    pub estimate: DensityEstimate,
    /// How wavelengths are chosen.
    pub wavelengths: WavelengthMode,
}

impl Default for MappingSettings {
    fn default() -> Self {
        Self {
            global_photons: None,
            caustic_photons: None,
            memory: None,
            global_file: None,
            caustic_file: None,
            global_k: 50,
            caustic_k: 80,
            global_radius: None,
            caustic_radius: None,
            accurate_distance: None,
            accurate_share: 0.0,
            gather_rays: 1,
            precompute: 4,
            max_depth: 32,
            max_photon_depth: 64,
            sharp_alpha: SHARP_ALPHA,
            layers: true,
            photons: PhotonSettings::default(),
            estimate: DensityEstimate::default(),
            wavelengths: WavelengthMode::default(),
        }
    }
}

pub(in crate::photon) const fn spec(
    name: &'static str,
    kind: &'static str,
    default: &'static str,
    unit: &'static str,
    doc: &'static str,
) -> ParameterSpec {
    ParameterSpec { name, kind, default, unit, doc }
}

/// Parameters that both methods with maps have.
pub(in crate::photon) const SHARP_ALPHA_SPEC: ParameterSpec = ParameterSpec {
    doc: "width of microfacets below which glossy lobes are followed by rays and count as S",
    ..SHARP_ALPHA_PARAMETER
};
pub(in crate::photon) const LIGHT_SAMPLER: ParameterSpec =
    spec("lightsampler", "string", "bvh", "", "how a light is chosen for shadow rays: bvh, power or uniform");
pub(in crate::photon) const MAX_PHOTON_DEPTH: ParameterSpec =
    spec("maxphotondepth", "integer", "64", "", "most scattering events of a photon");

const OWN_PARAMETERS: [ParameterSpec; 19] = [
    spec("globalphotons", "integer", "200000", "", "photons to store in the global map, about"),
    spec(
        "causticphotons",
        "integer",
        "1 per pixel",
        "",
        "photons to store in the caustic map, about; by default 200000 to 4000000",
    ),
    spec(
        "photonmemory",
        "float",
        "none",
        "MB",
        "memory of both maps, each half of it, where the numbers of photons are not given",
    ),
    spec(
        "globalmap",
        "string",
        "none",
        "",
        "file of the global map, written by `etendue photons --map global`, in place of tracing it",
    ),
    spec(
        "causticmap",
        "string",
        "none",
        "",
        "file of the caustic map, written by `etendue photons --map caustic`, in place of tracing it",
    ),
    spec("globalnearest", "integer", "50", "", "photons of an estimate of the global map"),
    spec("causticnearest", "integer", "80", "", "photons of an estimate of the caustic map"),
    spec("globalradius", "float", "by density", "m", "greatest radius of an estimate of the global map"),
    spec("causticradius", "float", "by density", "m", "greatest radius of an estimate of the caustic map"),
    spec(
        "accuratedistance",
        "float",
        "twice the mean radius",
        "m",
        "surfaces nearer than this to where gathering starts are treated accurately, against leaks in corners",
    ),
    spec(
        "accurateshare",
        "float",
        "0",
        "",
        "surfaces seen in mirrors and glass that are less than this share of a pixel ask the global map for all light",
    ),
    spec("gatherrays", "integer", "1", "", "rays that gather indirect light, for each camera sample"),
    spec(
        "precompute",
        "integer",
        "4",
        "",
        "irradiance is computed before at one of so many photons of each map; 0: not",
    ),
    spec("maxdepth", "integer", "32", "", "most scattering events of a walk from the camera"),
    MAX_PHOTON_DEPTH,
    SHARP_ALPHA_SPEC,
    spec("layers", "bool", "true", "", "layers direct, specular, caustic and indirect"),
    LIGHT_SAMPLER,
    WavelengthMode::PARAMETER,
];

/// Number of parameters of a method with maps that has so many of its own.
pub(in crate::photon) const fn n_parameters(n_own: usize) -> usize {
    n_own + PhotonSettings::PARAMETERS.len() + DensityEstimate::PARAMETERS.len()
}

/// The own parameters of a method with maps, then those of photons and of estimates.
pub(in crate::photon) const fn with_shared<const N: usize>(own: &[ParameterSpec]) -> [ParameterSpec; N] {
    let mut all = [MAX_PHOTON_DEPTH; N];
    let (n_own, n_photons) = (own.len(), PhotonSettings::PARAMETERS.len());
    let mut i = 0;
    while i < N {
        all[i] = if i < n_own {
            own[i]
        } else if i < n_own + n_photons {
            PhotonSettings::PARAMETERS[i - n_own]
        } else {
            DensityEstimate::PARAMETERS[i - n_own - n_photons]
        };
        i += 1;
    }
    all
}

impl MappingSettings {
    /// Parameters in scene files.
    pub const PARAMETERS: &'static [ParameterSpec] =
        &with_shared::<{ n_parameters(OWN_PARAMETERS.len()) }>(&OWN_PARAMETERS);

    /// Reads the parameters of an integrator entity.
    pub fn from_parameters(p: &mut Parameters<'_, '_>) -> Self {
        let default = Self::default();
        // Read where the scene is built.
        p.ignore("lightsampler");
        let photons =
            |p: &mut Parameters<'_, '_>, name| p.has(name).then(|| p.count_within(name, 0, 0, MOST_PHOTONS));
        let nearest =
            |p: &mut Parameters<'_, '_>, name, default| p.count_within(name, default, 1, MOST_NEIGHBOURS);
        let settings = Self {
            global_photons: photons(p, "globalphotons"),
            caustic_photons: photons(p, "causticphotons"),
            memory: within(p, "photonmemory", "megabytes", 0.0..=MOST_MEGABYTES),
            global_file: file(p, "globalmap"),
            caustic_file: file(p, "causticmap"),
            global_k: nearest(p, "globalnearest", default.global_k),
            caustic_k: nearest(p, "causticnearest", default.caustic_k),
            global_radius: length(p, "globalradius"),
            caustic_radius: length(p, "causticradius"),
            accurate_distance: length(p, "accuratedistance"),
            accurate_share: within(p, "accurateshare", "", 0.0..=1.0).unwrap_or_default(),
            gather_rays: p.count_within("gatherrays", default.gather_rays, 1, MOST_GATHER_RAYS),
            precompute: p.count("precompute", default.precompute),
            max_depth: p.count("maxdepth", default.max_depth),
            max_photon_depth: p.count("maxphotondepth", default.max_photon_depth),
            sharp_alpha: read_sharp_alpha(p),
            layers: p.bool("layers", default.layers),
            photons: PhotonSettings::from_parameters(p),
            estimate: DensityEstimate::from_parameters(p),
            wavelengths: p.choice("wavelengths", "hero", WavelengthMode::CHOICES),
        };
        let estimate = &settings.estimate;
        check_least_photons(p, estimate, "globalnearest", settings.global_k, "indirect light is left out");
        check_least_photons(p, estimate, "causticnearest", settings.caustic_k, "caustics are left out");
        settings
    }

    /// What users are told where they asked for no global photons.
    pub(super) fn unasked_advice(&self) -> &'static str {
        match self.global_photons {
            Some(_) => "\"globalphotons\" is 0: indirect light is left out",
            None => {
                "\"photonmemory\" holds no photons: indirect light is left out, and caustics unless \"causticphotons\" is given"
            }
        }
    }

    /// The estimate of the global map: by its settings, without a filter, since what it blurs is gathered from afar.
    #[must_use]
    pub const fn global_estimate(&self) -> DensityEstimate {
        DensityEstimate { filter: Filter::Constant, ..self.estimate }
    }
}

/// Warns where estimates never have as many photons as they need to show anything.
pub(in crate::photon) fn check_least_photons(
    p: &mut Parameters<'_, '_>,
    estimate: &DensityEstimate,
    nearest: &str,
    k: u32,
    so: &str,
) {
    let least = estimate.min_photons;
    if least > k {
        let span = p.span_of("minphotons");
        let message = format!("\"minphotons\" {least} is more than \"{nearest}\" {k}: {so}");
        p.diagnostics().warning(span, message);
    }
}

/// A file, as it is named; `None` if none is.
pub(in crate::photon) fn file(p: &mut Parameters<'_, '_>, name: &'static str) -> Option<String> {
    Some(p.string(name, "")).filter(|name| !name.is_empty())
}

/// A number within bounds; `None` if it is not given.
fn within(
    p: &mut Parameters<'_, '_>,
    name: &'static str,
    unit: &str,
    bounds: std::ops::RangeInclusive<f32>,
) -> Option<f32> {
    if !p.has(name) {
        return None;
    }
    let value = p.float(name, 0.0);
    if bounds.contains(&value) {
        return Some(value);
    }
    let (span, least, most) = (p.span_of(name), bounds.start(), bounds.end());
    let message = format!("\"{name}\" must be {least} to {most} {unit}, not {value}");
    p.diagnostics().error(span, message.replace(" ,", ","));
    None
}

/// A length in metres, not negative; `None` if it is not given.
pub(in crate::photon) fn length(p: &mut Parameters<'_, '_>, name: &'static str) -> Option<f32> {
    if !p.has(name) {
        return None;
    }
    let value = p.float(name, 0.0);
    if value >= 0.0 {
        return Some(value);
    }
    let span = p.span_of(name);
    p.diagnostics().error(span, format!("\"{name}\" must be at least 0, not {value}"));
    None
}
