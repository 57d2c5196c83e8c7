//! From the name in a scene file to a method.

use etendue_scene::Assets;
use etendue_scene::diagnostics::{Diagnostics, nearest_name};
use etendue_scene::document::{Entity, Parameter, Value};
use etendue_scene::parameters::{BuildContext, ParameterSpec, Parameters};

use crate::ambient_occlusion::{AmbientOcclusion, OcclusionSettings};
use crate::integrator::Integrator;
use crate::light_tracing::{LightSettings, LightTracer};
use crate::lpe::PathExpressions;
use crate::path_tracing::{PathSettings, PathTracer};
use crate::photon::direct_view::{DirectView, DirectViewSettings};
use crate::photon::mapping::{MappingSettings, PhotonMapping, TERM_NAMES};
use crate::photon::progressive::{Progressive, ProgressiveSettings};
use crate::whitted::{Whitted, WhittedSettings};

/// What documentation says of a method.
#[derive(Clone, Copy, Debug)]
pub struct MethodSpec {
    /// Name in scene files.
    pub name: &'static str,
    /// One line.
    pub doc: &'static str,
    /// True if its expectation is the exact image, but for the depth limit (SPEC EQ-10).
    pub unbiased: bool,
    /// True if it converges to the exact image.
    pub consistent: bool,
    /// Parameters.
    pub parameters: &'static [ParameterSpec],
}

/// All methods.
pub const INTEGRATORS: &[MethodSpec] = &[
    MethodSpec {
        name: "path",
        doc: "path tracing with next event estimation, multiple importance sampling and Russian roulette",
        unbiased: true,
        consistent: true,
        parameters: PathSettings::PARAMETERS,
    },
    MethodSpec {
        name: "photonmap",
        doc: "photon mapping in two passes: direct light and mirrors by rays, caustics and indirect light by photon maps",
        unbiased: false,
        consistent: true,
        parameters: MappingSettings::PARAMETERS,
    },
    MethodSpec {
        name: "photons",
        doc: "photons seen directly: quick and blurred; caustics alone, or all that is not direct light",
        unbiased: false,
        consistent: true,
        parameters: DirectViewSettings::PARAMETERS,
    },
    MethodSpec {
        name: "whitted",
        doc: "recursive ray tracing: direct light, mirrors and glass alone (LD?S*E)",
        unbiased: false,
        consistent: false,
        parameters: WhittedSettings::PARAMETERS,
    },
    MethodSpec {
        name: "light",
        doc: "light tracing: paths from the lights, seen by the camera; for caustics; mirrors show nothing unless asked to",
        unbiased: true,
        consistent: true,
        parameters: LightSettings::PARAMETERS,
    },
    MethodSpec {
        name: "ao",
        doc: "ambient occlusion: how much of the sky each surface sees, whatever lights there are",
        unbiased: false,
        consistent: false,
        parameters: OcclusionSettings::PARAMETERS,
    },
    MethodSpec {
        name: "sppm",
        doc: "stochastic progressive photon mapping: photons around visible points, with radii that shrink from pass to pass",
        unbiased: false,
        consistent: true,
        parameters: ProgressiveSettings::PARAMETERS,
    },
    MethodSpec {
        name: "ppm",
        doc: "progressive photon mapping: the same with the same camera paths in all passes",
        unbiased: false,
        consistent: false,
        parameters: ProgressiveSettings::PARAMETERS,
    },
];

/// Other names of methods.
const ALIASES: &[(&str, &str)] = &[
    ("volpath", "path"),
    ("simplepath", "path"),
    ("simplevolpath", "path"),
    ("randomwalk", "path"),
    ("lightpath", "light"),
    ("ambientocclusion", "ao"),
];

/// Methods that scene files name and that are still to come.
const COMING: &[&str] = &["aov", "bdpt", "distribution", "function", "mlt", "pathmlt", "radiosity", "vcm"];

/// Parameters of pbrt's `simplepath` that choose what ours always does.
const FOREIGN_PARAMETERS: &[&str] = &["samplebsdf", "samplelights"];

/// The name of the method that [`method`] takes for a name: its own, that of the method it is another name of, or that
/// of the one that stands in for it.
#[must_use]
pub fn method_name(name: &str) -> &'static str {
    known_name(name).unwrap_or("path")
}

/// The name of the method of that name, or that it is another name of.
fn known_name(name: &str) -> Option<&'static str> {
    let name = ALIASES.iter().find(|(alias, _)| *alias == name).map_or(name, |(_, name)| name);
    INTEGRATORS.iter().find(|m| m.name == name).map(|m| m.name)
}

/// The method that an entity names, which fills layers by these expressions; a name that is known and not available
/// yet gives path tracing with a warning, an unknown name an error.
#[must_use]
pub fn method(entity: &Entity, expressions: PathExpressions) -> (Option<Box<dyn Integrator>>, Diagnostics) {
    let assets = Assets::default();
    let mut context = BuildContext::new(&assets);
    let name = entity.type_name.as_str();
    let is_coming = COMING.contains(&name);
    if is_coming {
        let message = format!("the integrator \"{name}\" is not available yet; \"path\" stands in for it");
        context.diagnostics.warning(entity.span, message);
    } else if known_name(name).is_none() {
        report_unknown(entity, &mut context.diagnostics);
        return (None, context.diagnostics);
    }
    let mut p = Parameters::new(entity, &mut context);
    let integrator: Box<dyn Integrator> = match method_name(name) {
        "ao" => read_occlusion(&mut p, expressions),
        "photonmap" => Box::new(PhotonMapping::new(MappingSettings::from_parameters(&mut p), expressions)),
        "photons" => Box::new(DirectView::new(DirectViewSettings::from_parameters(&mut p), expressions)),
        "whitted" => Box::new(Whitted::new(WhittedSettings::from_parameters(&mut p), expressions)),
        "light" => Box::new(LightTracer::new(LightSettings::from_parameters(&mut p), expressions)),
        "ppm" => read_progressive(&mut p, expressions, true),
        "sppm" => read_progressive(&mut p, expressions, false),
        _ => read_path(&mut p, expressions, is_coming),
    };
    p.finish();
    let integrator = (!context.diagnostics.has_errors()).then_some(integrator);
    (integrator, context.diagnostics)
}

/// Expressions with the layers that a method has by itself: the film that it is given is to have all of them.
#[must_use]
pub fn with_own_layers(entity: &Entity, expressions: PathExpressions) -> PathExpressions {
    let is_off = |p: &Parameter| p.name == "layers" && p.value == Value::Bools(vec![false]);
    if method_name(&entity.type_name) == "photonmap" && !entity.parameters.iter().any(is_off) {
        expressions.with_own_layers(TERM_NAMES)
    } else {
        expressions
    }
}

fn report_unknown(entity: &Entity, diagnostics: &mut Diagnostics) {
    let name = entity.type_name.as_str();
    let own = INTEGRATORS.iter().map(|m| m.name);
    let known = own.chain(ALIASES.iter().map(|(alias, _)| *alias)).chain(COMING.iter().copied());
    let near = nearest_name(name, known);
    let error = diagnostics.error(entity.span, format!("unknown integrator \"{name}\""));
    error.with_help(match near {
        Some(near) => format!("did you mean \"{near}\"?"),
        None => "`etendue list integrators` shows them".to_owned(),
    });
}

fn read_path(
    p: &mut Parameters<'_, '_>,
    expressions: PathExpressions,
    is_stand_in: bool,
) -> Box<dyn Integrator> {
    let settings = PathSettings::from_parameters(p);
    for foreign in FOREIGN_PARAMETERS {
        p.ignore(foreign);
    }
    if is_stand_in {
        // What another method is told says nothing to the one that stands in for it.
        p.accept_all();
    }
    if settings.reuse > 1 && !expressions.is_empty() {
        let span = p.span_of("reuse");
        let message = "layers by path expression need paths of their own: \"reuse\" is taken as 1";
        p.diagnostics().warning(span, message);
    }
    if settings.adaptive.is_some() && (settings.reuse > 1 || !expressions.is_empty()) {
        let span = p.span_of("pixels");
        let message = "neither layers by path expression nor \"reuse\" go with interpolation: all \"pixels\" are traced";
        p.diagnostics().warning(span, message);
    }
    Box::new(PathTracer::new(settings, expressions))
}

fn read_occlusion(p: &mut Parameters<'_, '_>, expressions: PathExpressions) -> Box<dyn Integrator> {
    let settings = OcclusionSettings::from_parameters(p);
    if !expressions.is_empty() {
        let span = p.span();
        let message = "ambient occlusion has no paths: layers by path expression stay black";
        p.diagnostics().warning(span, message);
    }
    Box::new(AmbientOcclusion::new(settings, expressions))
}

fn read_progressive(
    p: &mut Parameters<'_, '_>,
    expressions: PathExpressions,
    has_fixed_points: bool,
) -> Box<dyn Integrator> {
    let settings = ProgressiveSettings::from_parameters(p);
    Box::new(Progressive::new(ProgressiveSettings { has_fixed_points, ..settings }, expressions))
}
