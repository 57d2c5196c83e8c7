//! Film, sampler, camera, filter and what stands in for the features that are missing.

use etendue_math::SamplerKind;

use super::*;
use crate::document::{CameraEntity, MediumEntity, Parameter};
use crate::film::PixelBounds;
use etendue_geometry::{Accelerator, KdTreeSettings};

fn film(entity: Entity) -> Document {
    Document { film: Some(here(entity)), ..lit() }
}

fn sampler(entity: Entity) -> Document {
    Document { sampler: Some(here(entity)), ..lit() }
}

fn camera(entity: Entity) -> Document {
    let world_from_camera = still(Transform::IDENTITY);
    Document { camera: Some(CameraEntity { entity, world_from_camera, medium: String::new() }), ..lit() }
}

/// A film of 40 by 30 pixels.
fn small() -> Entity {
    Entity::new("rgb").with("xresolution", integers(&[40])).with("yresolution", integers(&[30]))
}

/// An image has at least one pixel, and not more than memory can hold.
#[test]
fn films_have_pixels() {
    for (x, y) in [(0, 30), (40, 0), (-1, 30), (i32::MAX, i32::MAX), (1 << 16, 1 << 15)] {
        let entity =
            Entity::new("rgb").with("xresolution", integers(&[x])).with("yresolution", integers(&[y]));
        error_here(&film(entity), "cannot be rendered");
    }
    let largest = Entity::new("rgb").with("xresolution", integers(&[1 << 15]));
    assert_eq!(scene(&film(largest.with("yresolution", integers(&[1 << 15])))).film.resolution, [1 << 15; 2]);
}

/// A crop keeps the pixels whose lower corner lies in the window; in pixels it is exact and takes precedence.
#[test]
fn crops_are_parts_of_the_image() {
    let crop = |entity: Entity| scene(&film(entity)).film.crop;
    assert_eq!(crop(small()), PixelBounds { min: [0, 0], max: [40, 30] });
    let window = small().with("cropwindow", floats(&[0.26, 0.5, 0.0, 0.1]));
    assert_eq!(crop(window.clone()), PixelBounds { min: [11, 0], max: [20, 3] });
    let bounds = integers(&[3, 100, 4, 5]);
    assert_eq!(crop(window.with("pixelbounds", bounds)), PixelBounds { min: [3, 4], max: [40, 5] });

    for window in [&[0.0, 1.0, 0.0][..], &[0.5, 0.5, 0.0, 1.0], &[0.9, 0.1, 0.0, 1.0], &[f32::NAN; 4], &[]] {
        error_here(&film(small().with("cropwindow", floats(window))), "\"cropwindow\" must be");
    }
    for bounds in [&[0, 40][..], &[50, 60, 0, 1], &[9, 3, 0, 1], &[-9, -3, 0, 1]] {
        error_here(&film(small().with("pixelbounds", integers(bounds))), "\"pixelbounds\" must be");
    }
}

/// Samplers of pbrt-v4 that differ only in how they scramble are one here; the number of samples is what was asked.
#[test]
fn samplers_by_name() {
    let settings = |entity: Entity| {
        let settings = scene(&sampler(entity)).sampler;
        (settings.kind, settings.samples_per_pixel)
    };
    for (name, kind) in [
        ("sobol", SamplerKind::Sobol),
        ("paddedsobol", SamplerKind::Sobol),
        ("pmj02bn", SamplerKind::Sobol),
        ("zsobol", SamplerKind::ZSobol),
    ] {
        let entity = Entity::new(name).with("pixelsamples", integers(&[7]));
        assert_eq!(settings(entity.with("randomization", strings(&["owen"]))), (kind, 7));
    }
    assert_eq!(settings(Entity::new("halton")), (SamplerKind::Halton, 16));
    assert_eq!(settings(Entity::new("independent")), (SamplerKind::Independent, 16));
    let strata = Entity::new("stratified").with("xsamples", integers(&[3])).with("ysamples", integers(&[5]));
    assert_eq!(settings(strata), (SamplerKind::Stratified { x: 3, y: 5, jitter: true }, 15));
    error_here(&sampler(Entity::new("sobol").with("pixelsamples", integers(&[0]))), "at least 1");
}

/// A seed is that of the sampler, else that of the options, else 0.
#[test]
fn seeds_come_from_sampler_or_options() {
    let mut document = lit();
    assert_eq!(scene(&document).sampler.seed, 0);
    document.options.push(Parameter::new("seed", integers(&[5])));
    assert_eq!(scene(&document).sampler.seed, 5);
    document.sampler = Some(Entity::new("zsobol").with("seed", integers(&[6])));
    assert_eq!(scene(&document).sampler.seed, 6);
}

/// A name that nothing has is an error that says what was probably meant.
#[test]
fn unknown_names_are_errors() {
    let check = |document: Document, message: &str, help: &str| {
        assert_helps(&error_here(&document, message), help);
    };
    check(film(Entity::new("rgbb")), "unknown film \"rgbb\"", "did you mean \"rgb\"?");
    check(film(Entity::new("photograph")), "unknown film", "known are: gbuffer, rgb, spectral");
    check(sampler(Entity::new("haltom")), "unknown sampler", "did you mean \"halton\"?");
    check(camera(here(Entity::new("sperical"))), "unknown camera", "did you mean \"spherical\"?");
    let filter = Some(here(Entity::new("gausian")));
    check(Document { filter, ..lit() }, "unknown pixel filter", "did you mean \"gaussian\"?");
    let accelerator = Some(here(Entity::new("bvhh")));
    check(Document { accelerator, ..lit() }, "unknown accelerator", "did you mean \"bvh\"?");
    let light = placed_light(here(Entity::new("distnat")));
    check(Document { lights: vec![light], ..lit() }, "unknown light", "did you mean \"distant\"?");
}

/// What pbrt-v4 knows and is missing here leaves a warning in its place, and a scene.
#[test]
fn known_but_missing_features_have_stand_ins() {
    let sensor = small().with("sensor", strings(&["canon_eos_5d"]));
    warning_here(&film(sensor), "\"cie1931\" stands in for it");

    let world_from_medium = still(Transform::IDENTITY);
    let fog =
        MediumEntity { name: "fog".to_owned(), world_from_medium, entity: here(Entity::new("homogeneous")) };
    warning_here(&Document { media: vec![fog], ..lit() }, "\"fog\" is rendered as empty space");
}

/// Red, green and blue tell nothing of the spectrum, so a film that records it says that it will stay black.
#[test]
fn spectral_films_warn_of_bands() {
    let with = |word: &str| Document {
        film: Some(here(Entity::new("spectral"))),
        integrator: Some(Entity::new("path").with("wavelengths", strings(&[word]))),
        ..lit()
    };
    warning_here(&with("bands"), "spectral channels stay black");
    let _ = scene(&with("hero"));
    let _ = scene(&Document { film: lit().film, ..with("bands") });
}

/// Every structure can be chosen, and what it cannot be is said and mended.
#[test]
fn accelerators_are_chosen() {
    let with = |entity: Entity| Document { accelerator: Some(here(entity)), ..lit() };
    for (name, ..) in ACCELERATORS {
        assert_eq!(scene(&with(Entity::new(*name))).geometry.accelerator().name(), *name);
    }
    let check = |entity: Entity, expected: Accelerator, warning: &str| {
        assert_eq!(warning_here(&with(entity), warning).geometry.accelerator(), expected);
    };
    let kd_tree = |name: &str, value: Value| Entity::new("kdtree").with(name, value);
    let kd = KdTreeSettings::DEFAULT;
    let deep = Accelerator::KdTree(KdTreeSettings { max_depth: Some(60), ..kd });
    check(kd_tree("maxdepth", integers(&[61])), deep, "between 0 and 60, but is 61; 60 is taken");
    let greedy = Accelerator::KdTree(KdTreeSettings { empty_bonus: 1.0, ..kd });
    check(kd_tree("emptybonus", floats(&[7.0])), greedy, "but is 7; 1 is taken");
    let fine = Entity::new("grid").with("density", floats(&[1e9]));
    check(fine, Accelerator::Grid { density: 64.0 }, "but is 1000000000; 64 is taken");
    assert_helps(
        &error_here(&with(Entity::new("binarybvh").with("splitmethod", strings(&["sahh"]))), "splitmethod"),
        "did you mean \"sah\"?",
    );
    error_here(&with(kd_tree("maxdepth", integers(&[-7]))), "must not be negative");
}

/// A parameter that nobody asks for is ignored with a warning, so that scenes of other versions render.
#[test]
fn unknown_parameters_are_warnings() {
    let help = |document: Document| {
        let (_, problems) = build(&document);
        only_problem(&problems, Severity::Warning, "does not know the parameter").help.unwrap_or_default()
    };
    assert_eq!(help(film(small().with("xresoluton", integers(&[1])))), "did you mean \"xresolution\"?");
    let sobol = Entity::new("sobol").with("pixelsample", integers(&[1]));
    assert_eq!(help(sampler(sobol)), "did you mean \"pixelsamples\"?");
    let perspective = here(Entity::new("perspective").with("fv", floats(&[60.0])));
    assert_eq!(help(camera(perspective)), "did you mean \"fov\"?");
    let mesh = |name: &str| lit_with(vec![shape(here(square().with(name, floats(&[]))))]);
    assert_eq!(help(mesh("uvw")), "did you mean \"uv\"?");
    assert_eq!(help(mesh("smoothness")), "");
}

/// The tables of films, samplers and accelerators list what is asked for: the documentation is made from them.
#[test]
fn tables_list_what_is_asked_for() {
    let value = |spec: &ParameterSpec| match (spec.name, spec.kind) {
        ("cropwindow", _) => floats(&[0.0, 1.0, 0.0, 1.0]),
        ("pixelbounds", _) => integers(&[0, 1, 0, 1]),
        ("sensor", _) => strings(&["cie1931"]),
        ("splitmethod", _) => strings(&["sah"]),
        ("coordinatesystem", _) => strings(&["world"]),
        ("lambdamin" | "lambdamax", _) => floats(&[spec.default.parse().expect("a number")]),
        (_, "integer") => integers(&[3]),
        (_, "float") => floats(&[0.5]),
        (_, "bool") => Value::Bools(vec![true]),
        _ => strings(&["a.exr"]),
    };
    let entity = |name: &str, specs: &[ParameterSpec]| {
        specs.iter().fold(Entity::new(name), |entity, spec| entity.with(spec.name, value(spec)))
    };
    let common = FILMS[0].1;
    for (name, own) in FILMS {
        let own = if *name == "rgb" { &[] } else { *own };
        let _ = scene(&film(entity(name, &[common, own].concat())));
    }
    for (name, specs) in SAMPLERS {
        let _ = scene(&sampler(entity(name, specs)));
    }
    for (name, _, specs) in ACCELERATORS {
        let accelerator = Some(entity(name, specs));
        let _ = scene(&Document { accelerator, ..lit() });
    }
}
