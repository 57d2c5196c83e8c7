//! Reads the files that a document names, in parallel.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use etendue_image::Texels;
use etendue_scene::assets::{Contours, INTEGRATOR_FILES};
use etendue_scene::bsdf::measured::MeasuredBrdf;
use etendue_scene::bsdf::tabulated::BrdfGrid;
use etendue_scene::build::{MESH_FILE_PARAMETERS, MESH_FILES};
use etendue_scene::camera::LensPrescription;
use etendue_scene::document::{EmbeddedFile, Entity, ShapeEntity, Value};
use etendue_scene::light::Photometry;
use etendue_scene::{Assets, Diagnostics, Document, LoadedMesh, Span};
use etendue_spectrum::{known_but_missing, named_spectrum};
use rayon::prelude::*;

use crate::brdf_table::read_brdf_table;
use crate::contours::read_contours;
use crate::file::{check_regular, read_file};
use crate::ies::read_ies;
use crate::images::{read_texels, read_texels_from};
use crate::lens::read_lens;
use crate::measured::read_measured;
use crate::ply::{read_ply, read_ply_points};
use crate::spd::read_spd;

#[cfg(test)]
mod tests;

/// What a file should hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Mesh,
    Points,
    Image,
    Spectrum,
    Brdf,
    Measured,
    Lens,
    Luminaire,
    Contours,
    OfIntegrator,
}

/// Files by kind and name, with the first parameter that names each.
type Wanted = BTreeMap<(Kind, String), Option<Span>>;

/// What was read.
enum Loaded {
    /// With what was odd about its file.
    Mesh(Arc<LoadedMesh>, Vec<String>),
    Image(Arc<Texels>),
    Spectrum(Vec<[f32; 2]>),
    Brdf(BrdfGrid),
    Measured(Arc<MeasuredBrdf>),
    Lens(LensPrescription),
    Luminaire(Photometry),
    Contours(Contours),
    OfIntegrator(Arc<[u8]>),
}

/// Reads all files that parameters of the document name; what cannot be read is an error at the parameter.
///
/// Known are the meshes of `plymesh` and `fractal`, contours of `revolution`, the images of `heightfield`,
/// the images of `imagemap` textures, of lights and of normal maps, measured
/// spectra, the tables of `tabulated`, the measurements of `measured`, the lenses of `realistic` and the luminaires
/// of `ies` and of surfaces that emit, and the photon maps of integrators.
/// File names are relative to [`Document::base_directory`]; names in [`Document::embedded`] stand for what the document
/// brings along.
#[must_use]
pub fn load_assets(document: &Document) -> (Assets, Diagnostics) {
    let wanted: Vec<_> = wanted_files(document).into_iter().collect();
    let load = |((kind, name), _): &((Kind, String), Option<Span>)| match document.embedded.get(name) {
        Some(file) => load_embedded(*kind, name, file),
        None => load_file(*kind, &document.base_directory.join(name)),
    };
    // Files differ much in size, so that each is a task of its own.
    let loaded: Vec<_> = wanted.par_iter().with_max_len(1).map(load).collect();
    let (mut assets, mut diagnostics) = (Assets::default(), Diagnostics::default());
    for (((_, name), span), loaded) in wanted.into_iter().zip(loaded) {
        match loaded {
            Ok(Loaded::Mesh(mesh, warnings)) => {
                for warning in warnings {
                    diagnostics.warning(span, format!("mesh \"{name}\": {warning}"));
                }
                assets.meshes.insert(name, mesh);
            }
            Ok(Loaded::Image(texels)) => {
                assets.images.insert(name, texels);
            }
            Ok(Loaded::Spectrum(samples)) => {
                assets.spectra.insert(name, samples);
            }
            Ok(Loaded::Brdf(grid)) => {
                assets.brdfs.insert(name, grid);
            }
            Ok(Loaded::Measured(brdf)) => {
                assets.measured.insert(name, brdf);
            }
            Ok(Loaded::Lens(lens)) => {
                assets.lenses.insert(name, Arc::new(lens));
            }
            Ok(Loaded::Luminaire(photometry)) => {
                assets.luminaires.insert(name, Arc::new(photometry));
            }
            Ok(Loaded::Contours(contours)) => {
                assets.contours.insert(name, contours);
            }
            Ok(Loaded::OfIntegrator(bytes)) => {
                assets.of_integrator.insert(name, bytes);
            }
            Err(message) => {
                let error = diagnostics.error(span, message);
                if Path::new(&name).is_relative()
                    && !document.embedded.contains_key(&name)
                    && !document.base_directory.join(&name).exists()
                {
                    error.with_help("names of files are relative to the folder of the scene file");
                }
                assets.failed.insert(name);
            }
        }
    }
    (assets, diagnostics)
}

fn load_file(kind: Kind, path: &Path) -> Result<Loaded, String> {
    if kind == Kind::Image {
        check_regular(path).map_err(|error| error.to_string())?;
        let texels = read_texels(path).map_err(|error| error.to_string())?;
        return Ok(Loaded::Image(Arc::new(texels)));
    }
    let bytes = read_file(path).map_err(|error| error.to_string())?;
    decode(kind, &bytes).map_err(|why| format!("`{}`: {why}", path.display()))
}

fn load_embedded(kind: Kind, name: &str, file: &EmbeddedFile) -> Result<Loaded, String> {
    match (kind, file) {
        (Kind::Mesh | Kind::Points, EmbeddedFile::Mesh(mesh)) => {
            Ok(Loaded::Mesh(Arc::clone(mesh), Vec::new()))
        }
        (Kind::Image, EmbeddedFile::Image(texels)) => Ok(Loaded::Image(Arc::clone(texels))),
        (Kind::Image, EmbeddedFile::Bytes(bytes)) => {
            let texels = read_texels_from(name, Arc::clone(bytes)).map_err(|error| error.to_string())?;
            Ok(Loaded::Image(Arc::new(texels)))
        }
        (_, EmbeddedFile::Bytes(bytes)) => decode(kind, bytes).map_err(|why| format!("`{name}`: {why}")),
        (_, EmbeddedFile::Mesh(_)) => Err(format!("`{name}` is a mesh")),
        (_, EmbeddedFile::Image(_)) => Err(format!("`{name}` is a picture")),
    }
}

/// What the bytes of a file hold that is no picture.
fn decode(kind: Kind, bytes: &[u8]) -> Result<Loaded, String> {
    match kind {
        Kind::Mesh => {
            let ply = read_ply(bytes).map_err(|error| error.to_string())?;
            Ok(Loaded::Mesh(Arc::new(ply.mesh), ply.warnings))
        }
        Kind::Points => {
            let ply = read_ply_points(bytes).map_err(|error| error.to_string())?;
            Ok(Loaded::Mesh(Arc::new(ply.mesh), ply.warnings))
        }
        Kind::Brdf => read_brdf_table(bytes).map(Loaded::Brdf).map_err(|error| error.to_string()),
        Kind::Contours => read_contours(bytes).map(Loaded::Contours).map_err(|error| error.to_string()),
        Kind::Measured => read_measured(bytes)
            .map(|brdf| Loaded::Measured(Arc::new(brdf)))
            .map_err(|error| error.to_string()),
        Kind::Lens => read_lens(bytes).map(Loaded::Lens).map_err(|error| error.to_string()),
        Kind::Spectrum | Kind::Image => {
            read_spd(bytes).map(Loaded::Spectrum).map_err(|error| error.to_string())
        }
        Kind::OfIntegrator => Ok(Loaded::OfIntegrator(bytes.into())),
        Kind::Luminaire => read_ies(bytes).map(Loaded::Luminaire).map_err(|error| error.to_string()),
    }
}

fn wanted_files(document: &Document) -> Wanted {
    let mut wanted = Wanted::new();
    let objects = document.objects.iter().flat_map(|object| &object.shapes);
    for ShapeEntity { entity, .. } in document.shapes.iter().chain(objects) {
        match entity.type_name.as_str() {
            name if MESH_FILES.contains(&name) => {
                for parameter in MESH_FILE_PARAMETERS {
                    add(&mut wanted, Kind::Mesh, entity, parameter);
                }
            }
            "points" => add(&mut wanted, Kind::Points, entity, "filename"),
            "revolution" => add(&mut wanted, Kind::Contours, entity, "filename"),
            "heightfield" => add(&mut wanted, Kind::Image, entity, "filename"),
            _ => {}
        }
        add_spectra(&mut wanted, entity);
    }
    for texture in &document.textures {
        if texture.entity.type_name == "imagemap" {
            add(&mut wanted, Kind::Image, &texture.entity, "filename");
        }
        add_spectra(&mut wanted, &texture.entity);
    }
    for light in document.lights.iter().map(|light| &light.entity).chain(&document.area_lights) {
        let kind = if light.type_name == "ies" { Kind::Luminaire } else { Kind::Image };
        add(&mut wanted, kind, light, "filename");
        add(&mut wanted, Kind::Luminaire, light, "profile");
        add_spectra(&mut wanted, light);
    }
    for material in &document.materials {
        for name in ["normalmap", "clearcoatnormalmap"] {
            add(&mut wanted, Kind::Image, &material.entity, name);
        }
        match material.entity.type_name.as_str() {
            "tabulated" => add(&mut wanted, Kind::Brdf, &material.entity, "filename"),
            "measured" => add(&mut wanted, Kind::Measured, &material.entity, "filename"),
            _ => {}
        }
        add_spectra(&mut wanted, &material.entity);
    }
    let camera = document.camera.as_ref().map(|camera| &camera.entity);
    if let Some(camera) = camera.filter(|camera| camera.type_name == "realistic") {
        add(&mut wanted, Kind::Lens, camera, "lensfile");
        add_if(&mut wanted, Kind::Image, camera, "aperture", |name| name.contains('.'));
    }
    if let Some(integrator) = &document.integrator {
        for (_, parameter) in INTEGRATOR_FILES.iter().filter(|(name, _)| *name == integrator.type_name) {
            add(&mut wanted, Kind::OfIntegrator, integrator, parameter);
        }
    }
    let media = document.media.iter().map(|medium| &medium.entity);
    for entity in media.chain(camera).chain(&document.film) {
        add_spectra(&mut wanted, entity);
    }
    wanted
}

/// The file that a string parameter of that name gives.
fn add(wanted: &mut Wanted, kind: Kind, entity: &Entity, name: &str) {
    add_if(wanted, kind, entity, name, |file| !file.is_empty());
}

/// The file that a string parameter of that name gives, if it looks like one.
fn add_if(wanted: &mut Wanted, kind: Kind, entity: &Entity, name: &str, is_file: impl Fn(&str) -> bool) {
    for parameter in entity.parameters.iter().filter(|parameter| parameter.name == name) {
        let Value::Strings(files) = &parameter.value else { continue };
        for file in files.iter().filter(|file| is_file(file)) {
            wanted.entry((kind, file.clone())).or_insert(parameter.span);
        }
    }
}

/// Files of spectra: names of spectra that are not built in and look like files.
///
/// Other unknown names are left to the scene builder, which knows better what to suggest.
fn add_spectra(wanted: &mut Wanted, entity: &Entity) {
    for parameter in &entity.parameters {
        let Value::SpectrumNames(names) = &parameter.value else { continue };
        for name in names.iter().filter(|name| name.contains(['.', '/'])) {
            if named_spectrum(name).is_none() && known_but_missing(name).is_none() {
                wanted.entry((Kind::Spectrum, name.clone())).or_insert(parameter.span);
            }
        }
    }
}
