//! What scene files may say of progressive photon mapping.

use etendue_scene::parameters::{ParameterSpec, Parameters};

use crate::lpe::{SHARP_ALPHA, SHARP_ALPHA_PARAMETER, read_sharp_alpha};
use crate::path::camera_pass::WavelengthMode;
use crate::photon::{PhotonPattern, PhotonSettings};

/// Most photons of a pass: what they take in memory is bounded by it.
const MAX_PHOTONS: u32 = 1 << 24;
/// Most groups of a pass.
const MAX_GROUPS: u32 = 64;

/// How the radius shrinks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RadiusUpdate {
    /// By the number of the pass alone.
    #[default]
    Schedule,
    /// By what each pixel has found, as in the first papers.
    PerPixel,
}

/// What brings the light that comes straight from lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DirectLighting {
    /// Samples of the lights; photons start to count after their first event.
    #[default]
    Lights,
    /// Photons, as all other light.
    Photons,
}

/// Settings of progressive photon mapping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProgressiveSettings {
    /// Camera paths are the same in all passes (SPEC PROG-1), in place of new ones (SPEC PROG-2).
    pub has_fixed_points: bool,
    /// Most scattering events of a path from the light to the camera; longer paths are lost.
    pub max_depth: u32,
    /// Photons emitted in a pass; `None` for as many as there are camera paths.
    pub photons: Option<u32>,
    /// Radius of the first pass in metres; `None` to choose it for each place from the density of photons.
    pub radius: Option<f32>,
    /// Share of new photons that count: how fast the radius shrinks.
    pub alpha: f32,
    /// Share of the photons that are aimed at what may cast caustics; 0 for none.
    pub caustic_share: f32,
    /// How the radius shrinks.
    pub update: RadiusUpdate,
    /// What brings direct light.
    pub direct: DirectLighting,
    /// Glossy lobes narrower than this are followed; wider ones receive photons.
    pub receiver_alpha: f32,
    /// Glossy events narrower than this count as specular in path expressions without `G`.
    pub sharp_alpha: f32,
    /// In what pattern photons leave.
    pub pattern: PhotonPattern,
    /// How wavelengths are chosen.
    pub wavelengths: WavelengthMode,
    /// Groups of photons and camera paths in a pass, each with wavelengths of its own.
    pub n_groups: u32,
    /// Changes the photons of a scene.
    pub seed: u64,
}

impl Default for ProgressiveSettings {
    fn default() -> Self {
        Self {
            has_fixed_points: false,
            max_depth: 5,
            photons: None,
            caustic_share: 0.25,
            radius: None,
            alpha: 2.0 / 3.0,
            update: RadiusUpdate::default(),
            direct: DirectLighting::default(),
            receiver_alpha: 0.15,
            sharp_alpha: SHARP_ALPHA,
            pattern: PhotonPattern::default(),
            wavelengths: WavelengthMode::default(),
            n_groups: 4,
            seed: 0,
        }
    }
}

impl ProgressiveSettings {
    /// Parameters in scene files.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        ParameterSpec {
            name: "maxdepth",
            kind: "integer",
            default: "5",
            unit: "",
            doc: "most scattering events of a path, those of photon and camera path together; longer paths are lost",
        },
        ParameterSpec {
            name: "photonsperiteration",
            kind: "integer",
            default: "one for each camera path",
            unit: "",
            doc: "photons emitted in a pass, rounded up to a multiple of wavelengthgroups; -1 for the default",
        },
        ParameterSpec {
            name: "causticshare",
            kind: "float",
            default: "0.25",
            unit: "",
            doc: "share of the photons that are aimed at what may cast caustics, where less of the light goes there; 0 for none",
        },
        ParameterSpec {
            name: "radius",
            kind: "float",
            default: "from the density of photons",
            unit: "m",
            doc: "radius of the first pass within which photons count",
        },
        ParameterSpec {
            name: "alpha",
            kind: "float",
            default: "0.6667",
            unit: "",
            doc: "share of new photons that count; at 1 the radius stays, towards 0 it shrinks faster",
        },
        ParameterSpec {
            name: "radiusupdate",
            kind: "string",
            default: "schedule",
            unit: "",
            doc: "how the radius shrinks: schedule (by the number of the pass) or perpixel (by what each pixel has found)",
        },
        ParameterSpec {
            name: "direct",
            kind: "string",
            default: "lights",
            unit: "",
            doc: "what brings light straight from lights: lights (samples of them) or photons",
        },
        ParameterSpec {
            name: "receiveralpha",
            kind: "float",
            default: "0.15",
            unit: "",
            doc: "width of microfacets below which camera paths follow glossy reflections; wider ones receive photons",
        },
        SHARP_ALPHA_PARAMETER,
        WavelengthMode::PARAMETER,
        ParameterSpec {
            name: "wavelengthgroups",
            kind: "integer",
            default: "4",
            unit: "",
            doc: "groups of a pass, which share its photons; each has wavelengths of its own and a camera path for each pixel",
        },
        PhotonSettings::PATTERN,
        ParameterSpec { name: "seed", kind: "integer", default: "0", unit: "", doc: "changes the photons" },
        ParameterSpec {
            name: "lightsampler",
            kind: "string",
            default: "bvh",
            unit: "",
            doc: "how a light is chosen: bvh, power or uniform",
        },
    ];

    /// Reads the parameters of an integrator entity.
    pub fn from_parameters(p: &mut Parameters<'_, '_>) -> Self {
        let default = Self::default();
        let max_depth = p.count("maxdepth", default.max_depth);
        // pbrt's default is -1.
        let photons = match p.integer("photonsperiteration", -1) {
            -1 => None,
            _ => Some(p.count_within("photonsperiteration", 1, 1, MAX_PHOTONS)),
        };
        let caustic_share = p.float("causticshare", default.caustic_share);
        if !(0.0..1.0).contains(&caustic_share) {
            let span = p.span_of("causticshare");
            let message = format!("\"causticshare\" must be at least 0 and below 1, but is {caustic_share}");
            p.diagnostics().error(span, message);
        }
        let radius = p.has("radius").then(|| positive(p, "radius", 1.0));
        let alpha = p.float("alpha", default.alpha);
        if !(alpha > 0.0 && alpha <= 1.0) {
            let span = p.span_of("alpha");
            p.diagnostics().error(span, format!("\"alpha\" must be above 0 and at most 1, but is {alpha}"));
        }
        let updates = [("schedule", RadiusUpdate::Schedule), ("perpixel", RadiusUpdate::PerPixel)];
        let update = p.choice("radiusupdate", "schedule", &updates);
        let direct = [("lights", DirectLighting::Lights), ("photons", DirectLighting::Photons)];
        let direct = p.choice("direct", "lights", &direct);
        let receiver_alpha = p.float_within("receiveralpha", default.receiver_alpha, [0.0, 1.0]);
        let sharp_alpha = read_sharp_alpha(p);
        let pattern = PhotonSettings::read_pattern(p);
        let wavelengths = p.choice("wavelengths", "hero", WavelengthMode::CHOICES);
        let n_groups = p.count_within("wavelengthgroups", default.n_groups, 1, MAX_GROUPS);
        let seed = p.integer("seed", 0) as u64;
        // Read where the scene is built.
        p.ignore("lightsampler");
        Self {
            has_fixed_points: false,
            max_depth,
            photons,
            caustic_share,
            radius,
            alpha,
            update,
            direct,
            receiver_alpha,
            sharp_alpha,
            pattern,
            wavelengths,
            n_groups,
            seed,
        }
    }
}

/// A number that must be positive and finite.
fn positive(p: &mut Parameters<'_, '_>, name: &'static str, default: f32) -> f32 {
    let value = p.float(name, default);
    if value > 0.0 && value.is_finite() {
        return value;
    }
    let span = p.span_of(name);
    p.diagnostics().error(span, format!("\"{name}\" must be positive, but is {value}"));
    default
}
