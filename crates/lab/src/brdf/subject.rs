//! What is looked at: the BSDF of a material, given by a name with parameters or taken from a scene.

use std::path::Path;

use etendue_io::pbrt::value_text;
use etendue_io::{load_assets, read_pbrt_str, read_scene};
use etendue_math::{Point3, Ray, Vector3};
use etendue_scene::bsdf::BsdfKind;
use etendue_scene::diagnostics::nearest_name;
use etendue_scene::document::{Document, Entity, MaterialReference};
use etendue_scene::material::MATERIALS;
use etendue_scene::{Diagnostics, Scene, Sources};
use etendue_spectrum::Wavelengths;

/// Wavelengths in nm at which a material is looked at: blue, green, orange, red.
pub const LAMBDA_NM: [f32; 4] = [460.0, 530.0, 590.0, 650.0];

/// The ball, its floor and its lamp.
const STUDIO: &str = include_str!("studio.pbrt");

/// A BSDF with the studio that shows it.
#[derive(Debug)]
pub struct Subject {
    /// Name of the material or, without one, of its type.
    pub name: String,
    /// Type of the material.
    pub model: String,
    /// Parameters as written.
    pub parameters: Vec<(String, String)>,
    /// The model at [`LAMBDA_NM`], or at the first of them alone if it disperses light; of a material that varies,
    /// at one point.
    pub kind: BsdfKind,
    /// True if the material disperses, so that only the first wavelength counts.
    pub is_dispersive: bool,
    /// A ball of the material under a lamp.
    pub studio: Scene,
}

/// Why there is nothing to look at.
#[derive(Clone, Debug)]
pub enum SubjectError {
    /// What was asked for does not exist.
    Request(String),
    /// The material or its scene is in error.
    Scene(Diagnostics, Sources),
}

/// A subject with what is odd about it.
pub type SubjectResult = Result<(Subject, Diagnostics, Sources), SubjectError>;

impl Subject {
    /// The material of that type with parameters in the syntax of scene files, where quotes and brackets may be left
    /// out: `float roughness 0.3`.
    ///
    /// # Errors
    /// If the type or a parameter is unknown, or a value is wrong.
    pub fn of_model(model: &str, parameters: &[String]) -> SubjectResult {
        let known = || MATERIALS.iter().map(|material| material.name);
        let Some(spec) = MATERIALS.iter().find(|material| material.name == model) else {
            return Err(SubjectError::Request(unknown("material", model, known())));
        };
        let lines: Vec<String> = parameters.iter().map(|text| format!("  {}\n", quoted(text))).collect();
        let text = format!("WorldBegin\nMaterial \"{model}\"\n{}", lines.concat());
        let (document, diagnostics) = read_pbrt_str("parameters", &text, Path::new(""));
        if diagnostics.has_errors() {
            return Err(SubjectError::Scene(diagnostics, document.sources));
        }
        let index = document.materials.len() - 1;
        for parameter in &document.materials[index].entity.parameters {
            let known = || spec.parameters.iter().map(|parameter| parameter.name);
            if !known().any(|name| name == parameter.name) {
                return Err(SubjectError::Request(unknown("parameter", &parameter.name, known())));
            }
        }
        Self::of_document(document, diagnostics, index)
    }

    /// A material of a scene file, by its name or, for those without, by its number in the file from 1.
    ///
    /// # Errors
    /// If the file cannot be read, has no such material, or the material is in error.
    pub fn of_scene(path: &Path, name: &str) -> SubjectResult {
        let (document, diagnostics) = read_scene(path);
        if diagnostics.has_errors() {
            return Err(SubjectError::Scene(diagnostics, document.sources));
        }
        let named = document.materials.iter().position(|material| material.name.as_deref() == Some(name));
        let n = document.materials.len();
        let numbered = || name.parse::<usize>().ok().filter(|index| (1..n).contains(index));
        match named.or_else(numbered) {
            Some(index) => Self::of_document(document, diagnostics, index),
            None => Err(SubjectError::Request(no_such_material(&document, name))),
        }
    }

    fn of_document(mut document: Document, mut diagnostics: Diagnostics, index: usize) -> SubjectResult {
        let material = document.materials[index].clone();
        move_to_studio(&mut document, index);
        let (assets, problems) = load_assets(&document);
        diagnostics.append(problems);
        let (studio, problems) = Scene::build(&document, assets);
        diagnostics.append(problems);
        let Some(studio) = studio.filter(|_| !diagnostics.has_errors()) else {
            return Err(SubjectError::Scene(diagnostics, document.sources));
        };
        let Some((kind, is_dispersive)) = kind_at_equator(&studio) else {
            let message = format!("the material \"{}\" scatters no light", material.entity.type_name);
            return Err(SubjectError::Request(message));
        };
        let model = material.entity.type_name.clone();
        let subject = Self {
            name: material.name.unwrap_or_else(|| model.clone()),
            parameters: parameter_text(&material.entity),
            model,
            kind,
            is_dispersive,
            studio,
        };
        Ok((subject, diagnostics, document.sources))
    }
}

/// What to say of a material that a scene does not have.
fn no_such_material(document: &Document, name: &str) -> String {
    let names: Vec<&str> = document.materials.iter().filter_map(|m| m.name.as_deref()).collect();
    // The first material is the default, which no file wrote.
    match (document.materials.len() - 1, names.is_empty()) {
        (0, _) => "the scene has no materials".to_owned(),
        (n, true) => format!("there is no material \"{name}\"; those of the scene are numbers from 1 to {n}"),
        (n, false) => {
            let message = unknown("material", name, names.into_iter());
            format!("{message}; all are also numbers from 1 to {n}")
        }
    }
}

fn unknown<'a>(what: &str, name: &str, known: impl Iterator<Item = &'a str> + Clone) -> String {
    let help = match nearest_name(name, known.clone()) {
        Some(near) => format!("did you mean \"{near}\"?"),
        None => format!("there are {}", known.collect::<Vec<_>>().join(", ")),
    };
    format!("there is no {what} \"{name}\"; {help}")
}

/// A parameter with the quotes and brackets of scene files, where it lacks them.
fn quoted(text: &str) -> String {
    let text = text.trim();
    if text.starts_with('"') {
        return text.to_owned();
    }
    let mut words = text.splitn(3, char::is_whitespace).map(str::trim);
    let [kind, name, value] = [(); 3].map(|()| words.next().unwrap_or(""));
    let is_bare = !value.starts_with(['"', '[']) && value.parse::<f32>().is_err();
    let is_text =
        ["string", "texture", "spectrum"].contains(&kind) && is_bare && !value.contains(char::is_whitespace);
    let value = if is_text { format!("\"{value}\"") } else { value.to_owned() };
    let value = if value.starts_with('[') { value } else { format!("[ {value} ]") };
    format!("\"{kind} {name}\" {value}")
}

/// Names and values of the parameters of an entity.
fn parameter_text(entity: &Entity) -> Vec<(String, String)> {
    entity.parameters.iter().map(|p| (p.name.clone(), value_text(&p.value))).collect()
}

/// Leaves of a scene its textures and materials, and puts a ball of one of them into the studio.
fn move_to_studio(document: &mut Document, index: usize) {
    let (mut studio, problems) = read_pbrt_str("studio", STUDIO, Path::new(""));
    assert!(!problems.has_errors(), "the studio is part of this crate and reads");
    let n_materials = document.materials.len();
    for (i, shape) in studio.shapes.iter_mut().enumerate() {
        if i == 0 {
            shape.material = MaterialReference::Index(index);
        } else if let MaterialReference::Index(own) = &mut shape.material {
            *own += n_materials;
        }
    }
    document.materials.append(&mut studio.materials);
    document.textures.append(&mut studio.textures);
    let kept = std::mem::take(document);
    *document = Document {
        sources: kept.sources,
        base_directory: kept.base_directory,
        options: kept.options,
        materials: kept.materials,
        textures: kept.textures,
        ..studio
    };
}

/// What a ray finds at the equator of the ball, away from its poles.
fn kind_at_equator(studio: &Scene) -> Option<(BsdfKind, bool)> {
    let ray = Ray { origin: Point3::new(0.3, -1.5, 1.1), direction: Vector3::new(0.0, 1.0, 0.0), time: 0.0 };
    let hit = studio.intersect(&ray, f32::INFINITY)?;
    let surface = studio.surface(&ray, &hit);
    let mut lambda = Wavelengths::from_parts(LAMBDA_NM, [1.0; 4]);
    let bsdf = studio.bsdf(&surface, &mut lambda)?;
    Some((*bsdf.kind(), lambda.secondary_terminated()))
}
