//! `etendue photons`: a look at the photons of a scene.

use std::io::Write;
use std::path::Path;

use etendue::io::images::{write_atomically, write_image};
use etendue::lab::photons::{PhotonCloud, PhotonKind, PictureSettings, SeenPhoton};
use etendue::math::{Point3, Vector3};
use etendue::scene::Scene;
use etendue::transport::photon::mapping::{Content, MapFile};

use crate::args::{PhotonKindArgument, PhotonMapArgument, PhotonsArguments};
use crate::failure::{Failure, Result};
use crate::load::{self, Overrides};
use crate::threads::with_threads;
use crate::{list, outputs, photon_file, report};

/// What is written besides pictures.
const FORMATS: [&str; 4] = ["ply", "svg", "csv", photon_file::EXTENSION];

/// Runs the command.
pub(crate) fn run(arguments: &PhotonsArguments) -> Result<()> {
    with_threads(arguments.threads, || run_in_pool(arguments))
}

fn run_in_pool(arguments: &PhotonsArguments) -> Result<()> {
    check_outputs(arguments)?;
    let normal = arguments.normal.map(|[x, y, z]| Vector3::new(x, y, z));
    let normal = match normal.map(Vector3::try_normalized) {
        Some(None) => return Err(Failure::Usage("--normal: a normal has a length".to_owned())),
        normal => normal.flatten(),
    };
    let integrator = arguments.integrator.as_deref().map(load::integrator_entity).transpose()?;
    let overrides = Overrides { resolution: arguments.resolution, integrator, ..Overrides::default() };
    let scene =
        load::load(&arguments.scene, &overrides, etendue::transport::lpe::PathExpressions::default(), false)?
            .scene;
    if let Some(map) = arguments.map {
        return write_maps(arguments, &scene, map);
    }
    let kind = match arguments.kind {
        PhotonKindArgument::All => PhotonKind::All,
        PhotonKindArgument::Direct => PhotonKind::Direct,
        PhotonKindArgument::Caustic => PhotonKind::Caustic,
        PhotonKindArgument::Indirect => PhotonKind::Indirect,
    };
    let mut cloud = PhotonCloud::trace(&scene, arguments.photons, kind, arguments.seed);
    report::note(&format!("{} photons emitted, {} on surfaces", cloud.n_emitted, cloud.photons.len()));
    if cloud.photons.is_empty() {
        report::warning("no photon of that kind lies on a surface: there is nothing to show");
    }
    let Some([x, y, z]) = arguments.at else {
        return write_all(arguments, &scene, &cloud, None);
    };
    let near = cloud.nearest(Point3::new(x, y, z), normal, arguments.nearest as usize);
    // Without a normal, that of the nearest photon.
    let n = normal.or_else(|| near.first().map(|photon| photon.n.as_vector()));
    let n = n.unwrap_or(Vector3::new(0.0, 0.0, 1.0));
    cloud.photons = near;
    if arguments.outputs.is_empty() {
        list::print(PhotonCloud::directions_csv(&cloud.photons, n).trim_end());
    }
    write_all(arguments, &scene, &cloud, Some(n))
}

/// The map of a method, which its files hold.
fn write_maps(arguments: &PhotonsArguments, scene: &Scene, map: PhotonMapArgument) -> Result<()> {
    let content = match map {
        PhotonMapArgument::Global => Content::All,
        PhotonMapArgument::Scattered => Content::Scattered,
        PhotonMapArgument::Caustic => Content::Caustic,
    };
    let file = MapFile::trace(scene, content).map_err(Failure::Usage)?;
    report::note(&format!("{} photons emitted, {} stored", file.map().n_emitted(), file.map().len()));
    if file.map().is_empty() {
        report::warning("no photon is of that map: it is empty");
    }
    let bytes = file.to_bytes();
    for path in &arguments.outputs {
        photon_file::write_bytes(path, &bytes)?;
        report::note(&path.display().to_string());
    }
    Ok(())
}

fn check_outputs(arguments: &PhotonsArguments) -> Result<()> {
    for path in &arguments.outputs {
        let extension = outputs::extension(path);
        let is_directions = ["svg", "csv"].contains(&extension.as_str());
        if is_directions && arguments.at.is_none() {
            let message = format!("{}: directions belong to a point: add --at X,Y,Z", path.display());
            return Err(Failure::Usage(message));
        }
        if arguments.map.is_some() && !photon_file::is_map(path) {
            let message = format!("{}: --map writes .{}", path.display(), photon_file::EXTENSION);
            return Err(Failure::Usage(message));
        }
        if photon_file::is_map(path) && arguments.at.is_some() {
            let message =
                format!("{}: a map holds all photons: leave out --at, or write .ply", path.display());
            return Err(Failure::Usage(message));
        }
        if !FORMATS.contains(&extension.as_str()) && !outputs::is_image_name(path) {
            let message = format!(
                "{}: photons are written as pictures (.png, .exr, .ppm, .pfm, .hdr), .{}",
                path.display(),
                FORMATS.join(", .")
            );
            return Err(Failure::Usage(message));
        }
        outputs::check_file(path)?;
    }
    if arguments.outputs.is_empty() && arguments.at.is_none() {
        return Err(Failure::Usage(
            "name a file: -o photons.png for a picture, -o photons.ply for other programs".to_owned(),
        ));
    }
    outputs::check_distinct(arguments.outputs.iter())
}

fn write_all(
    arguments: &PhotonsArguments,
    scene: &Scene,
    cloud: &PhotonCloud,
    n: Option<Vector3>,
) -> Result<()> {
    let settings = PictureSettings { radius_px: arguments.radius, n_density: arguments.density as usize };
    let bytes = |path: &Path| -> Option<Vec<u8>> {
        let photons: &[SeenPhoton] = &cloud.photons;
        match (outputs::extension(path).as_str(), n) {
            ("ply", _) => Some(cloud.ply()),
            ("svg", Some(n)) => Some(PhotonCloud::directions_svg(photons, n).into_bytes()),
            ("csv", Some(n)) => Some(PhotonCloud::directions_csv(photons, n).into_bytes()),
            _ => None,
        }
    };
    for path in &arguments.outputs {
        match bytes(path) {
            _ if photon_file::is_map(path) => photon_file::write(path, scene, arguments)?,
            Some(bytes) => write_atomically(path, |file| file.write_all(&bytes))
                .map_err(|error| Failure::Running(format!("cannot write {}: {error}", path.display())))?,
            None => write_image(path, &cloud.picture(scene, settings))
                .map_err(|error| Failure::Running(format!("cannot write {error}")))?,
        }
        report::note(&path.display().to_string());
    }
    Ok(())
}
