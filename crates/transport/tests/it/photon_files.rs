//! Photon maps in files: the same picture, bit for bit, and a word where a map was made for something else.

use etendue_math::Rng;
use etendue_math::statistics::Moments;
use etendue_scene::document::{Entity, Value};
use etendue_scene::{Diagnostics, Film, Scene, Severity};
use etendue_transport::lpe::PathExpressions;
use etendue_transport::photon::mapping::{Content, MapFile, check_map_files};
use etendue_transport::photon::{PhotonMap, map::PhotonMapError};
use etendue_transport::{Stop, Unobserved, method, render, with_own_layers};

use crate::support::{Setup, flat, lit};

/// A floor, a lamp and a glass ball at a height.
fn scene(height: f32, integrator: Entity) -> Scene {
    let world = format!(
        "Material \"diffuse\" {} Shape \"bilinearmesh\" \"point3 P\" [-1 -1 3  1 -1 3  -1 1 3  1 1 3]
        AttributeBegin Translate 0.2 0 {height} Material \"dielectric\" Shape \"sphere\" \"float radius\" 0.3 AttributeEnd
        LightSource \"point\" {} \"point3 from\" [0.5 0.5 1]",
        flat("reflectance", 0.5),
        lit("I", 1.0)
    );
    let mut scene = Setup { world: &world, ..Setup::default() }.scene("files");
    scene.integrator = integrator;
    scene
}

fn few(name: &str) -> Entity {
    let counts: &[&str] =
        if name == "photonmap" { &["globalphotons", "causticphotons"] } else { &["photons"] };
    counts.iter().fold(Entity::new(name), |entity, count| entity.with(count, Value::Integers(vec![3000])))
}

fn with_file(mut scene: Scene, parameter: &str, bytes: &[u8]) -> Scene {
    let name = format!("{parameter}.photons");
    scene.integrator = scene.integrator.with(parameter, Value::Strings(vec![name.clone()]));
    scene.integrator_files.insert(name, bytes.into());
    scene
}

fn image(scene: &Scene) -> Vec<Vec<f32>> {
    let expressions = with_own_layers(&scene.integrator, PathExpressions::default());
    let mut film = Film::new(scene.film.clone(), expressions.names().to_vec());
    let (integrator, problems) = method(&scene.integrator, expressions);
    assert!(problems.list().is_empty(), "{:?}", problems.list());
    let stop = Stop { passes: 0..2, error: None };
    render(scene, integrator.expect("a method").as_mut(), &mut film, &stop, &Unobserved);
    film.develop().channels.iter().map(|channel| channel.values.clone()).collect()
}

fn bytes(scene: &Scene, content: Content) -> Vec<u8> {
    MapFile::trace(scene, content).expect("the method has that map").to_bytes()
}

/// With maps from files, nothing in the picture changes.
#[test]
fn pictures_are_the_same() {
    let plain = scene(2.0, few("photonmap"));
    let (global, caustic) = (bytes(&plain, Content::All), bytes(&plain, Content::Caustic));
    assert_eq!(MapFile::from_bytes(&caustic).expect("it was written so").to_bytes(), caustic);
    let read = with_file(scene(2.0, few("photonmap")), "globalmap", &global);
    let read = with_file(read, "causticmap", &caustic);
    assert!(check_map_files(&read).list().is_empty());
    assert!(image(&plain) == image(&read));
    let direct = |show: &str| few("photons").with("show", Value::Strings(vec![show.to_owned()]));
    for (show, content) in
        [("all", Content::All), ("shadowrays", Content::Scattered), ("caustics", Content::Caustic)]
    {
        let plain = scene(2.0, direct(show));
        let read = with_file(scene(2.0, direct(show)), "map", &bytes(&plain, content));
        assert!(check_map_files(&read).list().is_empty());
        assert!(image(&plain) == image(&read), "{show}");
    }
    // A method makes the maps that it asks alone.
    assert!(MapFile::trace(&scene(2.0, direct("all")), Content::Caustic).is_err());
}

/// The file rules, whatever else says how many photons there should be.
#[test]
fn photons_come_from_the_file() {
    let global = bytes(&scene(2.0, few("photonmap")), Content::All);
    let others = few("photonmap").with("precompute", Value::Integers(vec![0]));
    let without = image(&scene(2.0, others.clone()));
    let none = Entity { parameters: Vec::new(), ..others.clone() }
        .with("globalphotons", Value::Integers(vec![0]))
        .with("causticphotons", Value::Integers(vec![3000]))
        .with("precompute", Value::Integers(vec![0]));
    assert!(without == image(&with_file(scene(2.0, none), "globalmap", &global)));
}

#[track_caller]
fn says(problems: &Diagnostics, severity: Severity, text: &str) {
    let list = problems.list();
    assert!(list.len() == 1 && list[0].severity == severity && list[0].message.contains(text), "{list:?}");
    assert!(list[0].help.as_ref().is_some_and(|help| help.contains("--map global")), "{list:?}");
}

/// What was made for something else is refused where light would be lost, and else shown with a warning.
#[test]
fn maps_are_checked_against_the_scene() {
    let plain = scene(2.0, few("photonmap"));
    let global = bytes(&plain, Content::All);
    let check = |height: f32, integrator: Entity, bytes: &[u8]| {
        check_map_files(&with_file(scene(height, integrator), "globalmap", bytes))
    };
    says(&check(1.9, few("photonmap"), &global), Severity::Warning, "another scene");
    let random = few("photonmap").with("photonpattern", Value::Strings(vec!["random".to_owned()]));
    says(&check(2.0, random, &global), Severity::Warning, "other settings");
    let sharper = few("photonmap").with("sharpalpha", Value::Floats(vec![0.2]));
    says(&check(2.0, sharper, &global), Severity::Error, "sharpalpha");
    says(&check(2.0, few("photonmap"), &bytes(&plain, Content::Caustic)), Severity::Error, "a caustic map");
    let looked_at = PhotonMap::trace(&plain, 1000, 0, |_| true).to_bytes();
    says(&check(2.0, few("photonmap"), &looked_at), Severity::Error, "to be looked at");
    says(&check(2.0, few("photonmap"), &global[..99]), Severity::Error, "cut short");
    says(&check(2.0, few("photonmap"), b"P6 1 1 255"), Severity::Error, "not a photon map");
    // The file's places are used as they are, or not at all.
    let with_step = |step: i32| few("photonmap").with("precompute", Value::Integers(vec![step]));
    says(&check(2.0, with_step(2), &global), Severity::Warning, "\"precompute\" 4");
    let without = bytes(&scene(2.0, with_step(0)), Content::All);
    says(&check(2.0, few("photonmap"), &without), Severity::Warning, "\"precompute\" 0");
    assert!(check(2.0, with_step(0), &global).list().is_empty());
    // More samples or rays change no map.
    let rays = few("photonmap").with("gatherrays", Value::Integers(vec![3]));
    assert!(check(2.0, rays, &global).list().is_empty());
}

/// No bytes make it panic or reserve memory that a file does not have: cut short anywhere, or changed anywhere.
#[test]
fn damage_is_noticed() {
    let small = Entity::new("photonmap").with("globalphotons", Value::Integers(vec![40]));
    let bytes = bytes(&scene(2.0, small), Content::All);
    for n in 0..bytes.len() {
        assert!(MapFile::from_bytes(&bytes[..n]).is_err(), "{n} bytes");
    }
    for place in 0..bytes.len() {
        for bit in 0..8 {
            let mut damaged = bytes.clone();
            damaged[place] ^= 1 << bit;
            assert!(MapFile::from_bytes(&damaged).is_err(), "byte {place}");
        }
    }
    let mut rng = Rng::new(1, 0);
    for _ in 0..1000 {
        let mut damaged = bytes.clone();
        for _ in 0..4 {
            let place = 12 + (rng.next_f32() * 44.0) as usize;
            damaged[place] = (rng.next_f32() * 256.0) as u8;
        }
        let result = MapFile::from_bytes(&damaged);
        assert!(
            damaged == bytes
                || matches!(result, Err(PhotonMapError::Damaged | PhotonMapError::Length { .. }))
        );
    }
}

/// However few photons are asked for, the flux of their map is that of many, in the mean.
#[test]
fn few_photons_have_all_the_flux() {
    let flux = |n: i32, seed: u32| {
        let world = format!(
            "Material \"diffuse\" {} Shape \"bilinearmesh\" \"point3 P\" [-1 -1 2  1 -1 2  -1 1 2  1 1 2]
            LightSource \"point\" {}",
            flat("reflectance", 0.5),
            lit("I", 1.0)
        );
        let mut scene = Setup { world: &world, ..Setup::default() }.scene(&format!("flux {n} {seed}"));
        scene.integrator = Entity::new("photonmap").with("globalphotons", Value::Integers(vec![n]));
        let file = MapFile::trace(&scene, Content::All).expect("the method has that map");
        let map = file.map();
        assert!(map.len() >= n as usize, "{} of {n}", map.len());
        (0..map.len()).map(|i| f64::from(map.power(&map.photon(i as u32)).y)).sum::<f64>()
    };
    let expected = flux(20_000, 0);
    for n in [1, 5] {
        let found: Moments = (0..40).map(|seed| flux(n, seed)).collect();
        let tolerance = 5.0 * found.standard_error() + 0.01 * expected;
        assert!((found.mean() - expected).abs() < tolerance, "{n}: {} instead of {expected}", found.mean());
        assert!(tolerance < 0.1 * expected, "{n}: {tolerance} of {expected}");
    }
}
