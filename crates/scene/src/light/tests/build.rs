//! Lights from documents: defaults, errors and warnings.

use super::*;

/// All messages of a world, with their help.
fn messages(world: &World) -> String {
    let describe = |d: &crate::Diagnostic| format!("{} {}\n", d.message, d.help.as_deref().unwrap_or(""));
    world.diagnostics.list().iter().map(describe).collect()
}

#[track_caller]
fn check_error(entity: Entity, picture: Option<Texels>, expected: &str) {
    let world = World::with_picture(entity, picture);
    assert!(world.diagnostics.has_errors());
    assert!(messages(&world).contains(expected), "{}", messages(&world));
}

#[test]
fn every_kind_of_light_reads_what_it_documents() {
    // Documentation is made from the tables of parameters, so a reader must know each name in them.
    for kind in LightKind::ALL {
        for spec in kind.parameters() {
            let value = match spec.kind {
                "float" if spec.name == "time" => floats(&[12.0]),
                "float" => floats(&[1.0]),
                "vector3" => Value::Vectors3(vec![Vector3::new(1.0, 2.0, 3.0)]),
                "bool" => Value::Bools(vec![true]),
                "point3" => point(1.0, 2.0, 3.0),
                "point3[4]" => Value::Points3(
                    [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]]
                        .map(|[x, y]| Point3::new(x, y, 0.0))
                        .to_vec(),
                ),
                "spectrum" => rgb(1.0, 1.0, 1.0),
                "string" if spec.name == "units" => string("radiometric"),
                "string" if spec.name == "date" => string("2026-06-21"),
                "string" => string("map"),
                other => panic!("a parameter of type {other}"),
            };
            let entity = Entity::new(kind.name()).with(spec.name, value);
            let world = if kind == LightKind::Diffuse {
                let mut assets = Assets::default();
                assets.images.insert("map".to_owned(), Arc::new(grey_picture(4)));
                let table = Photometry::new(PhotometricWeb::C, vec![0.0, 90.0], vec![0.0], vec![1.0, 2.0]);
                assets.luminaires.insert("map".to_owned(), Arc::new(table.expect("the table is right")));
                let sphere = Shape::Sphere {
                    radius: 1.0,
                    z_min: -1.0,
                    z_max: 1.0,
                    phi_max_rad: std::f32::consts::TAU,
                };
                World::new(&[], vec![(sphere, Transform::IDENTITY, entity)], &assets)
            } else if kind == LightKind::Ies {
                let table = Photometry::new(PhotometricWeb::C, vec![0.0, 90.0], vec![0.0], vec![1.0, 2.0]);
                let mut assets = Assets::default();
                assets.luminaires.insert("map".to_owned(), Arc::new(table.expect("the table is right")));
                let entity =
                    if spec.name == "filename" { entity } else { entity.with("filename", string("map")) };
                World::new(&[placed(entity, Transform::IDENTITY)], vec![], &assets)
            } else if ["latitude", "longitude", "date", "time", "timezone"].contains(&spec.name) {
                let entity =
                    if spec.name == "latitude" { entity } else { entity.with("latitude", floats(&[50.0])) };
                World::of(if spec.name == "date" {
                    entity
                } else {
                    entity.with("date", string("2026-06-21"))
                })
            } else if kind == LightKind::Projection && spec.name != "filename" {
                World::with_picture(entity.with("filename", string("map")), Some(grey_picture(4)))
            } else {
                World::with_picture(entity, Some(grey_picture(4)))
            };
            assert!(!messages(&world).contains("does not know"), "{}", messages(&world));
            let n = if kind == LightKind::SunSky { 2 } else { 1 };
            assert_eq!(world.lights.len(), n, "{} {}: {}", kind.name(), spec.name, messages(&world));
        }
    }
}

#[test]
fn mistakes_are_reported_with_a_remedy() {
    // Each message says what is wrong and, where it can be known, what to do.
    check_error(Entity::new("pointt"), None, "did you mean \"point\"?");
    check_error(Entity::new("infinite").with("filename", string("missing")), None, "was not loaded");
    let wide = Texels::from_fn(8, 4, 3, |_, _, _| 1.0);
    check_error(Entity::new("infinite").with("filename", string("map")), Some(wide), "latitude-longitude");
    let tall = Texels::from_fn(4, 5, 3, |_, _, _| 1.0);
    check_error(Entity::new("goniometric").with("filename", string("map")), Some(tall), "4 x 5");
    let infinite = Texels::from_fn(4, 4, 3, |_, _, _| f32::INFINITY);
    check_error(Entity::new("infinite").with("filename", string("map")), Some(infinite), "infinite");
    check_error(Entity::new("projection"), None, "needs \"filename\"");
    let both = Entity::new("infinite").with("filename", string("map")).with("L", rgb(1.0, 1.0, 1.0));
    check_error(both, Some(grey_picture(4)), "not both");
    check_error(Entity::new("distant").with("to", point(0.0, 0.0, 0.0)), None, "must differ");
    check_error(Entity::new("point").with("scale", floats(&[-1.0])), None, "at least 0");
    check_error(Entity::new("point").with("units", string("radiometrik")), None, "did you mean");
    let three = Value::Points3(vec![Point3::ORIGIN; 3]);
    check_error(Entity::new("infinite").with("portal", three), None, "four points");
    let skew = [[0.0, 0.0], [0.3, 1.0], [1.3, 1.0], [1.0, 0.0]].map(|[x, y]| Point3::new(x, y, 0.0)).to_vec();
    check_error(Entity::new("infinite").with("portal", Value::Points3(skew)), None, "perpendicular");
    let kite = [[0.0, 0.0], [0.0, 1.0], [1.5, 1.2], [1.0, 0.0]].map(|[x, y]| Point3::new(x, y, 0.0)).to_vec();
    check_error(Entity::new("infinite").with("portal", Value::Points3(kite)), None, "parallel");
}

#[test]
fn unknown_parameters_and_moving_lights_are_warned_of() {
    // The scene still renders, perhaps not as meant.
    let world = World::of(Entity::new("point").with("powr", floats(&[1.0])));
    assert!(!world.diagnostics.has_errors());
    assert!(messages(&world).contains("did you mean \"power\"?"), "{}", messages(&world));

    let mut entity = placed(Entity::new("point"), Transform::IDENTITY);
    entity.world_from_light.end = tilted();
    let world = World::new(&[entity], Vec::new(), &Assets::default());
    assert!(messages(&world).contains("moving"));
}

#[test]
fn the_default_spectrum_is_the_white_of_the_colour_space() {
    // Without L, an ACES scene has ACES white (about D60), which is redder than D65.
    let red_over_blue = |space| {
        let mut entity = Entity::new("infinite");
        let mut parameter = Parameter::new("scale", floats(&[1.0]));
        parameter.color_space = space;
        entity.parameters.push(parameter);
        let world = World::of(entity);
        let lambda = Wavelengths::from_parts([450.0, 500.0, 550.0, 650.0], [1.0; 4]);
        let w = Vector3::new(0.0, 0.0, 1.0);
        let le = world.light().le_infinite(&world.context(), Point3::ORIGIN, w, &lambda);
        le[3] / le[0]
    };
    use etendue_spectrum::ColorSpaceName::{Aces2065_1, Srgb};
    assert!(red_over_blue(Aces2065_1) > 1.05 * red_over_blue(Srgb));
}
