//! Files of photon maps, `.photons`: written by `etendue photons`, read by `etendue info`.

use std::io::Write;
use std::path::Path;

use etendue::io::images::write_atomically;
use etendue::io::read_file;
use etendue::scene::Scene;
use etendue::transport::lpe::Event;
use etendue::transport::photon::map::PhotonMapError;
use etendue::transport::photon::mapping::MapFile;
use etendue::transport::photon::{PhotonMap, Trail};
use serde_json::{Value, json};

use crate::args::{PhotonKindArgument, PhotonsArguments};
use crate::failure::{Failure, Result};
use crate::outputs;

/// What such files are called.
pub(crate) const EXTENSION: &str = "photons";

/// Whether a file is called like a photon map.
pub(crate) fn is_map(path: &Path) -> bool {
    outputs::extension(path) == EXTENSION
}

/// Traces photons and writes their map.
pub(crate) fn write(path: &Path, scene: &Scene, arguments: &PhotonsArguments) -> Result<()> {
    let keeps = |trail: Trail| match arguments.kind {
        PhotonKindArgument::All => true,
        PhotonKindArgument::Direct => trail.is_empty(),
        PhotonKindArgument::Caustic => trail.is_caustic(),
        PhotonKindArgument::Indirect => !trail.is_empty() && !trail.is_caustic(),
    };
    write_bytes(path, &PhotonMap::trace(scene, arguments.photons, arguments.seed, keeps).to_bytes())
}

/// Writes a file of a map.
pub(crate) fn write_bytes(path: &Path, bytes: &[u8]) -> Result<()> {
    write_atomically(path, |file| file.write_all(bytes))
        .map_err(|error| Failure::Running(format!("cannot write {}: {error}", path.display())))
}

/// What a map holds.
pub(crate) fn describe(path: &Path) -> Result<Value> {
    let bytes = read_file(path).map_err(|error| Failure::Usage(error.to_string()))?;
    let damaged = |error| Failure::Usage(format!("{}: {error}", path.display()));
    match MapFile::from_bytes(&bytes) {
        Err(PhotonMapError::NotOfMethod) => {
            Ok(describe_map(&PhotonMap::from_bytes(&bytes).map_err(damaged)?))
        }
        Err(error) => Err(damaged(error)),
        Ok(file) => {
            let mut facts = describe_map(file.map());
            facts["map"] = json!({ "content": file.content().name(), "sharpalpha": file.sharp_alpha() });
            Ok(facts)
        }
    }
}

fn describe_map(map: &PhotonMap) -> Value {
    let mut counts = vec![0_u64; map.trails().len() + 1];
    for photon in map.photons() {
        counts[photon.trail_number().min(map.trails().len())] += 1;
    }
    let mut trails: Vec<(u64, String)> = map
        .trails()
        .iter()
        .map(|trail| word(*trail))
        .chain(["others".to_owned()])
        .zip(counts)
        .map(|(word, count)| (count, word))
        .filter(|(count, _)| *count > 0)
        .collect();
    trails.sort_by(|a, b| b.cmp(a));
    let n_kinds = trails.len();
    let most: serde_json::Map<String, Value> =
        trails.into_iter().take(20).map(|(count, word)| (word, json!(count))).collect();
    let positions = || map.photons().map(|photon| photon.position());
    let min = positions().reduce(etendue::math::Point3::min);
    let max = positions().reduce(etendue::math::Point3::max);
    let corner = |p: Option<etendue::math::Point3>| p.map_or(Value::Null, |p| json!([p.x, p.y, p.z]));
    json!({
        "photons": { "emitted": map.n_emitted(), "stored": map.len(), "memory_bytes": map.memory_bytes() },
        "mean_power_y": map.mean_power(),
        "bounds": { "min": corner(min), "max": corner(max) },
        "kinds_of_trails": n_kinds,
        "photons_by_trail": most,
        "radius_of_50_photons": map.radius_from_density(50, 0.1),
    })
}

/// The letters of a trail from the light on.
fn word(trail: Trail) -> String {
    let letter = |event: Event| match event {
        Event::Diffuse => 'D',
        Event::SharpGlossy | Event::WideGlossy => 'G',
        Event::Specular => 'S',
        Event::Volume => 'V',
    };
    let rest = if trail.is_whole() { "" } else { "..." };
    ["L".to_owned(), trail.events().map(letter).collect(), rest.to_owned()].concat()
}
