//! From the name in a scene file to a method.

use etendue_scene::Assets;
use etendue_scene::diagnostics::{Diagnostics, nearest_name};
use etendue_scene::document::Entity;
use etendue_scene::parameters::{BuildContext, ParameterSpec, Parameters};

use crate::integrator::Integrator;
use crate::lpe::PathExpressions;
use crate::path_tracing::{PathSettings, PathTracer};

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
pub const INTEGRATORS: &[MethodSpec] = &[MethodSpec {
    name: "path",
    doc: "path tracing with next event estimation, multiple importance sampling and Russian roulette",
    unbiased: true,
    consistent: true,
    parameters: PathSettings::PARAMETERS,
}];

/// Other names of the path tracer.
const PATH_ALIASES: &[&str] = &["volpath", "simplepath", "simplevolpath", "randomwalk"];

/// Methods that scene files name and that are still to come.
const COMING: &[&str] = &[
    "ambientocclusion",
    "ao",
    "aov",
    "bdpt",
    "distribution",
    "function",
    "light",
    "lightpath",
    "mlt",
    "pathmlt",
    "photonmap",
    "photons",
    "ppm",
    "radiosity",
    "sppm",
    "vcm",
    "whitted",
];

/// Parameters of pbrt's `simplepath` that choose what ours always does.
const FOREIGN_PARAMETERS: &[&str] = &["samplebsdf", "samplelights"];

/// The name of the method that [`method`] takes for a name: its own, that of the method it is another name of, or that
/// of the one that stands in for it.
#[must_use]
pub fn method_name(name: &str) -> &'static str {
    INTEGRATORS.iter().find(|m| m.name == name).map_or("path", |m| m.name)
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
    } else if name != "path" && !PATH_ALIASES.contains(&name) {
        let own = INTEGRATORS.iter().map(|m| m.name);
        let known = own.chain(PATH_ALIASES.iter().copied()).chain(COMING.iter().copied());
        let near = nearest_name(name, known);
        let error = context.diagnostics.error(entity.span, format!("unknown integrator \"{name}\""));
        error.with_help(match near {
            Some(near) => format!("did you mean \"{near}\"?"),
            None => "`etendue list integrators` shows them".to_owned(),
        });
        return (None, context.diagnostics);
    }
    let mut p = Parameters::new(entity, &mut context);
    let settings = PathSettings::from_parameters(&mut p);
    let span_of_reuse = p.span_of("reuse");
    for foreign in FOREIGN_PARAMETERS {
        p.ignore(foreign);
    }
    if is_coming {
        // What another method is told says nothing to the one that stands in for it.
        p.accept_all();
    }
    p.finish();
    if context.diagnostics.has_errors() {
        return (None, context.diagnostics);
    }
    if settings.reuse > 1 && !expressions.is_empty() {
        let message = "layers by path expression need paths of their own: \"reuse\" is taken as 1";
        context.diagnostics.warning(span_of_reuse, message);
    }
    (Some(Box::new(PathTracer::new(settings, expressions))), context.diagnostics)
}
