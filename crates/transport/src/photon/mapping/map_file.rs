//! A photon map in a file, with what a method needs of it besides: so that walks through a scene need not make it again.
//!
//! Little-endian:
//!
//! | bytes | |
//! |---|---|
//! | 8 | `ETPHOMAP` |
//! | 4 | version, 1 |
//! | 4 | what is in it: 0 all photons, 1 those that a surface has scattered, 2 caustics |
//! | 4 | width below which gloss was sharp (`f32`) |
//! | 4 | one of so many photons is a place where irradiance may be computed before; 0 for none |
//! | 8 | hash of the settings of its photons |
//! | 8 | hash of what becomes of the first photons in the scene |
//! | 8 | number of places, `n` |
//! | 8 | length of the map, `m` |
//! | m | the map ([`PhotonMap::to_bytes`]) |
//! | 24 n | position and normal of each place (six `f32`) |
//! | 8 | hash of the places |
//!
//! Whether a map fits a scene is told by the first photons: they are followed again, and come to other places or with other
//! power wherever lights, shapes or materials that matter to them have changed. What none of them meets is not noticed.

use etendue_math::{Normal3, Point3, Vector3, hash64};
use etendue_scene::assets::Assets;
use etendue_scene::document::Entity;
use etendue_scene::parameters::{BuildContext, Parameters};
use etendue_scene::{Diagnostics, Scene};

use super::fill::{Arrival, Shot, Traced, trace_map, visit};
use super::plan::{Content, MapPlan};
use super::settings::MappingSettings;
use crate::integrator::Control;
use crate::method::method_name;
use crate::photon::direct_view::DirectViewSettings;
use crate::photon::lack::Lack;
use crate::photon::map::bytes::{Reader, hash};
use crate::photon::map::{PhotonMap, PhotonMapError};
use crate::photon::walk::trace_photons_until;
use crate::photon::{PhotonEmitter, PhotonVertex};
use crate::render::Unobserved;

const MAGIC: [u8; 8] = *b"ETPHOMAP";
const VERSION: u32 = 1;
const HEADER: usize = 56;
const PLACE: usize = 24;
const HASH: usize = 8;

/// Photons by which a scene is known again.
const FIRST_PHOTONS: u64 = 4096;

/// A map as a method made it.
#[derive(Clone, Debug)]
pub struct MapFile {
    content: Content,
    sharp_alpha: f32,
    settings_hash: u64,
    photons_hash: u64,
    traced: Traced,
}

impl MapFile {
    /// The map of that content that the scene's method would make, or by `photonmap` if its method makes none.
    ///
    /// # Errors
    /// If the method makes others.
    pub fn trace(scene: &Scene, content: Content) -> Result<Self, String> {
        let own = plans(scene, &scene.integrator);
        let method = if own.is_some() { method_name(&scene.integrator.type_name) } else { "photonmap" };
        let plans = own.unwrap_or_else(|| {
            let settings = MappingSettings::default();
            vec![settings.global_plan(scene), settings.caustic_plan(scene)]
        });
        let Some(plan) = plans.iter().find(|plan| plan.content == content) else {
            let names: Vec<&str> = plans.iter().map(|plan| plan.content.name()).collect();
            let help = if content == Content::Scattered { "; photons:show=shadowrays asks one" } else { "" };
            return Err(format!(
                "as set, \"{method}\" asks no map \"{}\": {}{help}",
                content.name(),
                names.join(", ")
            ));
        };
        let emitter = plan.emitter(scene);
        let control = Control::new(&Unobserved);
        let traced = trace_map(scene, &emitter, plan, &control).unwrap_or_default();
        let (settings_hash, photons_hash) = hashes(scene, &emitter, plan);
        Ok(Self { content, sharp_alpha: plan.walk.sharp_alpha, settings_hash, photons_hash, traced })
    }

    /// The photons.
    #[must_use]
    pub const fn map(&self) -> &PhotonMap {
        &self.traced.map
    }

    /// Which they are.
    #[must_use]
    pub const fn content(&self) -> Content {
        self.content
    }

    /// Width of microfacets below which gloss was sharp for them.
    #[must_use]
    pub const fn sharp_alpha(&self) -> f32 {
        self.sharp_alpha
    }

    /// The file: the same for the same map, on every machine.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let Traced { map, arrivals, place_step } = &self.traced;
        let map = map.to_bytes();
        let mut bytes = Vec::with_capacity(HEADER + map.len() + arrivals.len() * PLACE + HASH);
        bytes.extend(MAGIC);
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend((self.content as u32).to_le_bytes());
        bytes.extend(self.sharp_alpha.to_le_bytes());
        bytes.extend((*place_step as u32).to_le_bytes());
        for word in [self.settings_hash, self.photons_hash, arrivals.len() as u64, map.len() as u64] {
            bytes.extend(word.to_le_bytes());
        }
        let places = bytes.len() + map.len();
        bytes.extend(map);
        for Arrival { p, n } in arrivals {
            for number in [p.x, p.y, p.z, n.x, n.y, n.z] {
                bytes.extend(number.to_le_bytes());
            }
        }
        bytes.extend(hash(&[&bytes[..HEADER], &bytes[places..]].concat()).to_le_bytes());
        bytes
    }

    /// What [`Self::to_bytes`] wrote.
    ///
    /// # Errors
    /// If the bytes are none, of another version, cut short or damaged.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, PhotonMapError> {
        let mut reader = Reader(bytes);
        if reader.array::<8>() != Some(MAGIC) {
            // A map may be sound and still not be one of a method.
            return Err(PhotonMap::from_bytes(bytes).err().unwrap_or(PhotonMapError::NotOfMethod));
        }
        let length = |expected: u64| PhotonMapError::Length { expected, found: bytes.len() as u64 };
        let version = reader.u32().ok_or_else(|| length(HEADER as u64))?;
        if version != VERSION {
            return Err(PhotonMapError::Version(version));
        }
        let mut words = || Some((reader.u32()?, f32::from_bits(reader.u32()?), reader.u32()?));
        let (content, sharp_alpha, place_step) = words().ok_or_else(|| length(HEADER as u64))?;
        let mut words = || Some((reader.u64()?, reader.u64()?, reader.u64()?, reader.u64()?));
        let (settings_hash, photons_hash, n_places, n_map) = words().ok_or_else(|| length(HEADER as u64))?;
        // Nothing is reserved before the bytes are known to be there.
        let expected = (HEADER as u64 + HASH as u64)
            .saturating_add(n_map)
            .saturating_add(n_places.saturating_mul(PLACE as u64));
        if expected != bytes.len() as u64 {
            return Err(length(expected));
        }
        let (map, rest) = bytes[HEADER..].split_at(n_map as usize);
        let (places, stored_hash) = rest.split_at(rest.len() - HASH);
        if Reader(stored_hash).u64() != Some(hash(&[&bytes[..HEADER], places].concat())) {
            return Err(PhotonMapError::Damaged);
        }
        let content = Content::NAMES.iter().map(|(_, content)| *content).find(|c| *c as u32 == content);
        let content = content.filter(|_| sharp_alpha.is_finite()).ok_or(PhotonMapError::Content)?;
        let arrivals: Vec<Arrival> =
            places.as_chunks().0.iter().map(arrival).collect::<Option<_>>().ok_or(PhotonMapError::Content)?;
        let map = PhotonMap::from_bytes(map)?;
        let traced = Traced { map, arrivals, place_step: place_step as usize };
        Ok(Self { content, sharp_alpha, settings_hash, photons_hash, traced })
    }
}

/// A place of a file; `None` if it is none.
fn arrival(bytes: &[u8; PLACE]) -> Option<Arrival> {
    let mut numbers = bytes.as_chunks().0.iter().map(|number| f32::from_le_bytes(*number));
    let mut next = || numbers.next().filter(|number| number.is_finite());
    let p = Point3::new(next()?, next()?, next()?);
    let n = Vector3::new(next()?, next()?, next()?).try_normalized()?;
    Some(Arrival { p, n: Normal3::new(n.x, n.y, n.z) })
}

/// The map that a plan tells of, from its file if there is one that can be read, else by photons, and why it is empty if it is.
/// `None` if the render was cancelled meanwhile.
pub(crate) fn obtain(scene: &Scene, plan: &MapPlan, control: &Control<'_>) -> Option<(Traced, Option<Lack>)> {
    let file = plan.file.as_ref().and_then(|name| scene.integrator_files.get(name));
    // Front ends have reported files that do not fit (`check_map_files`).
    if let Some(file) = file.and_then(|bytes| MapFile::from_bytes(bytes).ok()) {
        return Some((file.traced, None));
    }
    let emitter = plan.emitter(scene);
    let traced = trace_map(scene, &emitter, plan, control)?;
    let lack = match plan.n_photons {
        _ if !traced.map.is_empty() => None,
        0 => Some(Lack::Unasked),
        _ => Some(Lack::of_light(scene, &emitter).unwrap_or(Lack::Unkept)),
    };
    Some((traced, lack))
}

/// Problems of the photon maps that the scene's method is to read: errors where it cannot be done, warnings where a map was made for
/// something else.
#[must_use]
pub fn check_map_files(scene: &Scene) -> Diagnostics {
    let mut diagnostics = Diagnostics::default();
    for plan in plans(scene, &scene.integrator).into_iter().flatten() {
        let Some(name) = &plan.file else { continue };
        let span = scene.integrator.parameters.iter().find(|p| p.name == plan.parameter).and_then(|p| p.span);
        // If it could not be read, whoever tried has said why.
        let Some(bytes) = scene.integrator_files.get(name) else { continue };
        let wanted = plan.content.name();
        let remedy =
            || format!("`etendue photons SCENE --map {wanted} -o {wanted}.photons` writes one that fits");
        let file = match MapFile::from_bytes(bytes) {
            Ok(file) => file,
            Err(error) => {
                diagnostics.error(span, format!("\"{name}\": {error}")).with_help(remedy());
                continue;
            }
        };
        if file.content != plan.content {
            let message = format!("\"{name}\" is a {} map; a {wanted} map is needed", file.content.name());
            diagnostics.error(span, message).with_help(remedy());
        } else if file.sharp_alpha != plan.walk.sharp_alpha {
            let message = format!(
                "\"{name}\" was made with \"sharpalpha\" {}, here it is {}: light would be missing or counted twice",
                file.sharp_alpha, plan.walk.sharp_alpha
            );
            diagnostics.error(span, message).with_help(remedy());
        } else {
            let hashes = hashes(scene, &plan.emitter(scene), &plan);
            if let Some(difference) = difference(&file, hashes) {
                let message = format!("\"{name}\" was made {difference}; it is shown as it is");
                diagnostics.warning(span, message).with_help(remedy());
            }
            let step = file.traced.place_step;
            // Where the scene wants none, none is computed.
            if plan.place_step > 0 && step != plan.place_step {
                let message = format!(
                    "\"{name}\" was made with \"precompute\" {step}, here it is {}: that of the file counts",
                    plan.place_step
                );
                diagnostics.warning(span, message).with_help(remedy());
            }
        }
    }
    diagnostics
}

fn difference(file: &MapFile, (settings_hash, photons_hash): (u64, u64)) -> Option<&'static str> {
    if file.settings_hash != settings_hash {
        Some("with another seed or other settings of photons (pattern, absorption, depth, projection maps)")
    } else if file.photons_hash != photons_hash {
        Some("of another scene: lights, shapes or materials have changed")
    } else {
        None
    }
}

/// The maps of a method; `None` if it has none.
fn plans(scene: &Scene, entity: &Entity) -> Option<Vec<MapPlan>> {
    let assets = Assets::default();
    let mut context = BuildContext::new(&assets);
    let mut p = Parameters::new(entity, &mut context);
    match method_name(&entity.type_name) {
        "photonmap" => {
            let settings = MappingSettings::from_parameters(&mut p);
            Some(vec![settings.global_plan(scene), settings.caustic_plan(scene)])
        }
        "photons" => Some(vec![DirectViewSettings::from_parameters(&mut p).plan(scene)]),
        _ => None,
    }
}

/// What the photons of a map depend on: their settings, and the scene by what becomes of the first of them.
fn hashes(scene: &Scene, emitter: &PhotonEmitter, plan: &MapPlan) -> (u64, u64) {
    let walk = &plan.walk;
    let settings = format!(
        "{} {:?} {:?} {} {:?} {:?}",
        walk.sampler.seed, walk.pattern, walk.absorption, walk.max_depth, walk.wavelengths, plan.emission
    );
    let keep = |index, vertex: &PhotonVertex<'_>, kept: &mut Vec<Shot>| visit(plan, index, vertex, kept);
    let control = Control::new(&Unobserved);
    let (shots, _) = trace_photons_until(scene, emitter, 0..FIRST_PHOTONS, walk, &control, keep);
    let n_shots = shots.iter().map(Vec::len).sum::<usize>() as u64;
    let photons = shots.iter().flatten().fold(n_shots, |hash, Shot { photon, .. }| {
        let (p, power) = (photon.position, photon.power);
        let [a, b, c, d, e, f] = [p.x, p.y, p.z, power.x, power.y, power.z].map(|v| u64::from(v.to_bits()));
        hash64(&[hash, a | b << 32, c | d << 32, e | f << 32, photon.trail.bits()])
    });
    (hash(settings.as_bytes()), photons)
}
