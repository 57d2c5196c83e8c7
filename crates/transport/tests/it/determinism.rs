//! One seed gives one image: for any number of threads, split of passes, or detour through files (SPEC ARCH-4, PAR-1).

use etendue_scene::film::FilmSums;
use etendue_scene::{Film, Scene};

use crate::support::{Setup, lit, luminance, render_layers, render_passes};

/// Several tiles, all kinds of events, many lights, a sampler and a wide filter.
fn scene(sampler: &str, seed_name: &str) -> Scene {
    scene_by("\"integer maxdepth\" 6", sampler, seed_name)
}

fn scene_by(integrator: &str, sampler: &str, seed_name: &str) -> Scene {
    let world = format!(
        "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0.7 0.5 0.2]
        Shape \"bilinearmesh\" \"point3 P\" [-3 -1 -3  3 -1 -3  -3 -1 3  3 -1 3] AttributeEnd
        AttributeBegin Translate -0.6 -0.5 0 Material \"dielectric\" \"spectrum eta\" \"glass-SF11\"
        Shape \"sphere\" \"float radius\" 0.5 AttributeEnd
        AttributeBegin Translate 0.6 -0.5 0 Material \"coateddiffuse\" Shape \"sphere\" \"float radius\" 0.5 AttributeEnd
        AttributeBegin Translate 0 0 1 Material \"diffuse\" Shape \"sphere\" \"float radius\" 0.4 \"float alpha\" 0.5
        AttributeEnd
        AttributeBegin AreaLightSource \"diffuse\" {} \"bool twosided\" true
        Shape \"trianglemesh\" \"point3 P\" [-1 2 0  1 2 0  0 2 1] AttributeEnd
        LightSource \"point\" {} \"point3 from\" [1 1 -1]
        LightSource \"infinite\" \"rgb L\" [0.2 0.3 0.4] \"float scale\" 0.2",
        lit("L", 5.0),
        lit("I", 1.0)
    );
    let camera = "LookAt 0 0.3 -3  0 -0.3 0  0 1 0 Camera \"perspective\" \"float lensradius\" 0.05 \"float focaldistance\" 3";
    let setup = Setup {
        size: [70, 40],
        sampler,
        filter: "\"mitchell\"",
        integrator,
        camera,
        world: &world,
        ..Setup::default()
    };
    setup.scene(seed_name)
}

fn in_threads(n: usize, work: impl FnOnce() -> Film + Send) -> Film {
    rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads").install(work)
}

/// ARCH-4, PAR-1: threads change no bit, neither of the image nor of a layer nor of the exact sums.
#[test]
fn threads_change_nothing() {
    let layers = [("caustic", "LS+DE"), ("indirect", "LDD+E")];
    for sampler in ["\"sobol\"", "\"independent\"", "\"halton\"", "\"stratified\""] {
        let scene = scene(sampler, "threads");
        let alone = in_threads(1, || render_layers(&scene, 0..3, &layers));
        for n in [2, 3] {
            let together = in_threads(n, || render_layers(&scene, 0..3, &layers));
            assert_eq!(together.sums(), alone.sums(), "{n} threads, {sampler}");
            assert_eq!(together.develop(), alone.develop());
        }
    }
}

/// The same where pixels share their paths, also for passes rendered apart.
#[test]
fn threads_and_splits_change_nothing_that_is_shared() {
    let scene = scene_by("\"integer maxdepth\" 6 \"integer reuse\" 4", "\"sobol\"", "shared");
    let alone = in_threads(1, || render_passes(&scene, 0..3));
    let together = in_threads(3, || render_passes(&scene, 0..3));
    assert_eq!(together.sums(), alone.sums());
    let mut parts = in_threads(2, || render_passes(&scene, 2..3)).sums().clone();
    parts.merge(in_threads(2, || render_passes(&scene, 0..2)).sums()).expect("different passes");
    assert_eq!(&parts, alone.sums());
}

/// Passes 0..4 and 4..8, rendered apart and added, are passes 0..8, to the last bit; so are they in another order.
#[test]
fn split_passes_add_up_exactly() {
    for sampler in ["\"sobol\"", "\"stratified\""] {
        let scene = scene(sampler, "split");
        let whole = render_passes(&scene, 0..8);
        let (first, second) = (render_passes(&scene, 0..4), render_passes(&scene, 4..8));
        for (a, b) in [(&first, &second), (&second, &first)] {
            let mut sums = a.sums().clone();
            sums.merge(b.sums()).expect("different passes");
            assert_eq!(&sums, whole.sums(), "{sampler}");
            assert_eq!(sums.passes().to_vec(), std::iter::once(0..8).collect::<Vec<_>>());
        }
        let mut twice = first.sums().clone();
        assert!(twice.merge(first.sums()).is_err(), "the same passes twice");
    }
}

/// A film may be given up after some passes and filled on: passes that it holds are skipped.
#[test]
fn passes_that_are_there_are_skipped() {
    let scene = scene("\"sobol\"", "resume");
    let whole = render_passes(&scene, 0..5);
    let half = render_passes(&scene, 1..3);
    let mut resumed = Film::new(scene.film.clone(), Vec::new());
    resumed.sums_mut().restore(&half.sums().to_bytes(), half.passes()).expect("the same film");
    let (integrator, _) = etendue_transport::method(&scene.integrator, Default::default());
    let stop = etendue_transport::Stop { passes: 0..5, error: None };
    let mut integrator = integrator.expect("the path tracer");
    etendue_transport::render(
        &scene,
        integrator.as_mut(),
        &mut resumed,
        &stop,
        &etendue_transport::Unobserved,
    );
    assert_eq!(resumed.sums(), whole.sums());
}

/// Another seed gives another image; the same seed the same.
#[test]
fn seeds_matter() {
    for sampler in ["\"sobol\"", "\"independent\"", "\"halton\"", "\"stratified\""] {
        let render = |name: &str| luminance(&render_passes(&scene(sampler, name), 0..1));
        let (a, b) = (render("seed a"), render("seed b"));
        assert_eq!(a, render("seed a"));
        let different = a.iter().zip(&b).filter(|(a, b)| a != b).count();
        assert!(different > a.len() * 9 / 10, "{sampler}: {different} of {} pixels", a.len());
    }
}

/// A crop shows the same pixels as the whole image: numbers belong to the pixel.
#[test]
fn crop_shows_the_same_pixels() {
    let world = format!("Shape \"sphere\" LightSource \"infinite\" {}", lit("L", 1.0));
    let camera = "LookAt 0 0 -3  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 50";
    let render = |film: &str| {
        let setup = Setup { size: [20, 12], film, camera, world: &world, ..Setup::default() };
        luminance(&setup.film("crop", 4))
    };
    let (whole, crop) = (render("\"rgb\""), render("\"rgb\" \"integer pixelbounds\" [5 15 2 9]"));
    for (index, value) in crop.iter().enumerate() {
        let (x, y) = (5 + index % 10, 2 + index / 10);
        assert_eq!(*value, whole[20 * y + x], "pixel {x}, {y}");
    }
}

/// Sums travel through the channels of an image file and through a checkpoint without losing a bit.
#[test]
fn sums_survive_files() {
    let scene = scene("\"sobol\"", "files");
    let film = render_layers(&scene, 2..5, &[("caustic", "LS+DE")]);
    let mut image = film.develop();
    image.channels.extend(film.sums().exact_channels());
    image.channels.sort_by(|a, b| a.name.cmp(&b.name));
    let weights = film.settings().luminance_weights();
    let mut back = FilmSums::from_image(&image, film.settings().crop, weights).expect("sums in the image");
    back.note_passes(2..5);
    // A file orders channels by name.
    let (read, written) = (back.develop(), film.sums().develop());
    assert_eq!(read.channels.len(), written.channels.len());
    for channel in &written.channels {
        assert_eq!(read.channels.iter().find(|c| c.name == channel.name), Some(channel));
    }

    let mut restored = Film::new(scene.film.clone(), vec!["caustic".to_owned()]);
    restored.sums_mut().restore(&film.sums().to_bytes(), film.passes()).expect("the same film");
    assert_eq!(restored.sums(), film.sums());
    let mut other = Film::new(scene.film.clone(), Vec::new());
    assert!(other.sums_mut().restore(&film.sums().to_bytes(), film.passes()).is_err());
}
