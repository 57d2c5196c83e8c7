//! From a scene file and overrides to a scene.

use std::path::Path;

use etendue::io::checkpoint::hash_bytes;
use etendue::io::{load_assets, read_scene};
use etendue::scene::assets::INTEGRATOR_FILES;
use etendue::scene::diagnostics::nearest_name;
use etendue::scene::document::{Document, Entity, Parameter, Value};
use etendue::scene::parameters::ParameterSpec;
use etendue::scene::{Diagnostics, Scene};
use etendue::transport::lpe::PathExpressions;
use etendue::transport::photon::mapping::check_map_files;
use etendue::transport::{INTEGRATORS, Integrator, method};

use crate::failure::{Failure, Result};
use crate::report;

/// What the command line changes in a scene.
#[derive(Clone, Debug, Default)]
pub(crate) struct Overrides {
    /// Pixels across and down.
    pub(crate) resolution: Option<[i32; 2]>,
    /// Part of the image in shares of its size.
    pub(crate) crop: Option<[f32; 4]>,
    /// Whether the film records what a denoiser needs.
    pub(crate) features: bool,
    /// Integrator in place of the scene's.
    pub(crate) integrator: Option<Entity>,
    /// Word for the parameter `wavelengths` of the integrator.
    pub(crate) wavelengths: Option<&'static str>,
}

/// A scene with the document it was built from.
pub(crate) struct LoadedScene {
    /// As written, with overrides.
    pub(crate) document: Document,
    /// As built.
    pub(crate) scene: Scene,
    /// The method that the scene or the overrides ask for.
    pub(crate) integrator: Box<dyn Integrator>,
    /// Problems that do not keep it from rendering.
    pub(crate) diagnostics: Diagnostics,
}

/// Reads and builds a scene with a method that fills layers by `expressions`; all problems are collected, and reported
/// unless `quiet` leaves out the warnings.
pub(crate) fn load(
    path: &Path,
    overrides: &Overrides,
    expressions: PathExpressions,
    quiet: bool,
) -> Result<LoadedScene> {
    let (mut document, mut diagnostics) = read_scene(path);
    apply(overrides, &mut document);
    // A document with syntax errors still tells which of its files are missing.
    let (assets, problems) = load_assets(&document);
    diagnostics.append(problems);
    // The scene takes meshes from their last owner, others it must copy.
    document.embedded.clear();
    let (integrator, mut method_problems) = match &document.integrator {
        Some(entity) => method(entity, expressions),
        None => method(&Entity::new("volpath"), expressions),
    };
    let (scene, mut problems) = Scene::build(&document, assets);
    if diagnostics.has_errors() {
        // What is left of a scene gives rise to warnings that the whole one would not.
        problems.remove_warnings();
        method_problems.remove_warnings();
    }
    diagnostics.append(problems);
    diagnostics.append(method_problems);
    if let Some(scene) = scene.as_ref().filter(|_| !diagnostics.has_errors()) {
        diagnostics.append(check_map_files(scene));
    }
    report::diagnostics(&diagnostics, &document.sources, quiet);
    match (scene, integrator) {
        (Some(scene), Some(integrator)) if !diagnostics.has_errors() => {
            Ok(LoadedScene { document, scene, integrator, diagnostics })
        }
        _ => Err(Failure::Scene),
    }
}

fn apply(overrides: &Overrides, document: &mut Document) {
    if let Some([x, y]) = overrides.resolution {
        let film = document.film.get_or_insert_with(|| Entity::new("rgb"));
        set(film, "xresolution", Value::Integers(vec![x]));
        set(film, "yresolution", Value::Integers(vec![y]));
        film.parameters.retain(|p| p.name != "pixelbounds");
    }
    if let Some(crop) = overrides.crop {
        let film = document.film.get_or_insert_with(|| Entity::new("rgb"));
        set(film, "cropwindow", Value::Floats(crop.to_vec()));
        film.parameters.retain(|p| p.name != "pixelbounds");
    }
    if overrides.features {
        let film = document.film.get_or_insert_with(|| Entity::new("rgb"));
        set(film, "features", Value::Bools(vec![true]));
    }
    if let Some(integrator) = &overrides.integrator {
        document.integrator = Some(integrator.clone());
    }
    if let Some(word) = overrides.wavelengths {
        let integrator = document.integrator.get_or_insert_with(|| Entity::new("path"));
        set(integrator, "wavelengths", Value::Strings(vec![word.to_owned()]));
    }
}

/// Gives a parameter a value, whatever it had.
fn set(entity: &mut Entity, name: &str, value: Value) {
    entity.parameters.retain(|p| p.name != name);
    entity.parameters.push(Parameter::new(name, value));
}

/// `path:maxdepth=3,regularize=true` as an entity. The types of values follow the integrator's table; for names that
/// have none, they follow from the values.
pub(crate) fn integrator_entity(text: &str) -> Result<Entity> {
    let (name, settings) = text.split_once(':').unwrap_or((text, ""));
    let mut entity = Entity::new(name);
    let specs = INTEGRATORS.iter().find(|m| m.name == name).map(|m| m.parameters);
    for setting in settings.split(',').filter(|s| !s.is_empty()) {
        let (key, value) = setting.split_once('=').ok_or_else(|| {
            Failure::Usage(format!(
                "'{setting}' is not a parameter; write --integrator NAME:key=value,key=value"
            ))
        })?;
        let value = match specs {
            Some(specs) => typed_value(name, key, value, specs)?,
            None => guessed_value(value),
        };
        if entity.parameters.iter().any(|parameter| parameter.name == key) {
            return Err(Failure::Usage(format!("--integrator: {key} is given twice")));
        }
        entity.parameters.push(Parameter::new(key, value));
    }
    find_files_from_here(&mut entity)?;
    Ok(entity)
}

/// Files that are named on the command line are looked for from the current folder, not from that of the scene.
fn find_files_from_here(entity: &mut Entity) -> Result<()> {
    for Parameter { name, value, .. } in &mut entity.parameters {
        let Value::Strings(files) = value else { continue };
        if INTEGRATOR_FILES.contains(&(entity.type_name.as_str(), name.as_str())) {
            for file in files.iter_mut().filter(|file| !file.is_empty()) {
                let path = std::path::absolute(&*file)
                    .map_err(|error| Failure::Usage(format!("{file}: {error}")))?;
                *file = path.to_string_lossy().into_owned();
            }
        }
    }
    Ok(())
}

/// The value of a parameter of the method `name`, of the type that its table states.
fn typed_value(name: &str, key: &str, value: &str, specs: &[ParameterSpec]) -> Result<Value> {
    let Some(spec) = specs.iter().find(|spec| spec.name == key) else {
        let known: Vec<&str> = specs.iter().map(|spec| spec.name).collect();
        let message = match nearest_name(key, known.iter().copied()) {
            Some(near) => format!("{name} has no parameter {key}; did you mean {near}?"),
            None => format!("{name} has no parameter {key}; it has {}", known.join(", ")),
        };
        return Err(Failure::Usage(message));
    };
    let kind = spec.kind;
    let wrong = || Failure::Usage(format!("'{value}' is not a value of type {kind} for {key}"));
    Ok(match kind {
        "integer" => Value::Integers(vec![value.parse().map_err(|_| wrong())?]),
        "float" => {
            let number: f32 = value.parse().map_err(|_| wrong())?;
            Value::Floats(vec![Some(number).filter(|n| n.is_finite()).ok_or_else(wrong)?])
        }
        "bool" => Value::Bools(vec![value.parse().map_err(|_| wrong())?]),
        _ => Value::Strings(vec![value.to_owned()]),
    })
}

/// A value of the type that its spelling suggests.
fn guessed_value(value: &str) -> Value {
    if let Ok(integer) = value.parse() {
        Value::Integers(vec![integer])
    } else if let Ok(number) = value.parse() {
        Value::Floats(vec![number])
    } else if let Ok(truth) = value.parse() {
        Value::Bools(vec![truth])
    } else {
        Value::Strings(vec![value.to_owned()])
    }
}

/// A hash of everything that determines the image but for the seed and the number of passes: the text of the scene,
/// what the command line changed, and the layers.
#[must_use]
pub(crate) fn fingerprint(document: &Document, layers: &[(String, String)]) -> u64 {
    let mut bytes = Vec::new();
    for file in document.sources.files() {
        bytes.extend_from_slice(&hash_bytes(file.text.as_bytes()).to_le_bytes());
    }
    for entity in [&document.film, &document.integrator].into_iter().flatten() {
        bytes.extend_from_slice(entity.type_name.as_bytes());
        for parameter in entity.parameters.iter().filter(|p| p.name != "filename") {
            bytes.extend_from_slice(format!("{} {:?}", parameter.name, parameter.value).as_bytes());
        }
    }
    bytes.extend_from_slice(format!("{layers:?}").as_bytes());
    hash_bytes(&bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Parameters on the command line get the types of the integrator's table.
    #[test]
    fn integrator_parameters_are_typed() {
        let entity = integrator_entity("path:maxdepth=3,regularize=true,lights=scattering").expect("good");
        assert_eq!(entity.type_name, "path");
        assert_eq!(entity.parameters[0].value, Value::Integers(vec![3]));
        assert_eq!(entity.parameters[1].value, Value::Bools(vec![true]));
        assert_eq!(entity.parameters[2].value, Value::Strings(vec!["scattering".to_owned()]));
    }

    /// Slips on the command line are refused, not guessed at.
    #[test]
    fn wrong_parameters_are_refused() {
        for text in ["path:maxdepth", "path:maxdepth=three", "path:maxdeep=3", "path:maxdepth=3,maxdepth=4"] {
            assert!(integrator_entity(text).is_err(), "{text}");
        }
    }

    /// The name of the output does not change the picture; its resolution does.
    #[test]
    fn fingerprint_ignores_names_of_outputs() {
        let film = |name: &str, x: i32| {
            let film = Entity::new("rgb")
                .with("filename", Value::Strings(vec![name.to_owned()]))
                .with("xresolution", Value::Integers(vec![x]));
            Document { film: Some(film), ..Document::default() }
        };
        assert_eq!(fingerprint(&film("a.exr", 8), &[]), fingerprint(&film("b.exr", 8), &[]));
        assert_ne!(fingerprint(&film("a.exr", 8), &[]), fingerprint(&film("a.exr", 9), &[]));
    }
}
