//! Textures from parameters.

use super::*;

/// Textures refer to earlier ones by name; one that yields spectra is there for every role.
#[test]
fn textures_are_found_by_name() {
    let assets = Assets::default();
    let mut context = BuildContext::new(&assets);
    let mut textures = Textures::default();
    let entity = |name: &str, value: TextureValue, entity: Entity| TextureEntity {
        name: name.to_owned(),
        value,
        world_from_texture: Transform::IDENTITY,
        entity,
    };
    let checks = Entity::new("checkerboard")
        .with("tex1", Value::Rgb(vec![[2.0, 2.0, 2.0]]))
        .with("tex2", Value::Texture("dark".to_owned()));
    let dark = Entity::new("constant").with("value", Value::Rgb(vec![[0.5, 0.5, 0.5]]));
    textures.define(&entity("dark", TextureValue::Spectrum, dark), &mut context);
    textures.define(&entity("checks", TextureValue::Spectrum, checks), &mut context);
    let amount = Entity::new("constant").with("value", floats(&[0.5]));
    textures.define(&entity("amount", TextureValue::Float, amount), &mut context);
    assert_eq!(context.float_textures["amount"], FloatTexture::Constant(0.5));
    assert!(context.diagnostics.list().is_empty(), "{:?}", context.diagnostics.list());
    textures.spectra = context.spectra.clone();
    let value = |role: SpectrumRole, u: f32| {
        let texture = context.spectrum_textures[&("checks".to_owned(), role)];
        textures.eval_spectrum(texture, &at_uv(u, 0.5), &lambda()).to_array()[0]
    };
    assert!((value(SpectrumRole::Unbounded, 0.5) - 2.0).abs() < 1e-3);
    assert!((value(SpectrumRole::Albedo, 0.5) - 1.0).abs() < 1e-3);
    assert!((value(SpectrumRole::Albedo, 1.5) - 0.5).abs() < 1e-3);
}

/// What cannot be built is reported once, with a hint.
#[test]
fn problems_are_reported() {
    let assets = Assets::default();
    let n_problems = |entity: Entity| read_float(&entity, &assets).2;
    assert_eq!(n_problems(Entity::new("checkerbord")), 1);
    assert_eq!(n_problems(Entity::new("ptex").with("filename", strings("a.ptx"))), 1);
    assert_eq!(n_problems(Entity::new("imagemap")), 1);
    assert_eq!(n_problems(Entity::new("imagemap").with("filename", strings("missing.png"))), 1);
    assert_eq!(n_problems(Entity::new("checkerboard").with("dimension", Value::Integers(vec![4]))), 1);
    assert_eq!(n_problems(Entity::new("mix").with("amont", floats(&[0.5]))), 1);
    assert_eq!(n_problems(Entity::new("bilerp").with("mapping", strings("conical"))), 1);
    assert_eq!(n_problems(Entity::new("fbm").with("octaves", Value::Integers(vec![-1]))), 1);
    let mut context = BuildContext::new(&assets);
    let entity = TextureEntity {
        name: "a".to_owned(),
        value: TextureValue::Spectrum,
        world_from_texture: Transform::IDENTITY,
        entity: Entity::new("wrinkled"),
    };
    Textures::default().define(&entity, &mut context);
    assert_eq!(context.diagnostics.list().len(), 1, "once, not once for each role");
}

/// Every kind in the tables can be built from its defaults, and asks only for parameters that its table lists.
#[test]
fn tables_list_what_is_asked_for() {
    let mut assets = Assets::default();
    assets.images.insert("a.png".to_owned(), gray(1, 1, &[1]));
    for (value, table) in [("float", FLOAT_TEXTURES), ("spectrum", SPECTRUM_TEXTURES)] {
        for (name, specs) in table {
            let mut entity = Entity::new(*name);
            for spec in *specs {
                let given = match (spec.name, spec.kind) {
                    ("filename", _) => strings("a.png"),
                    ("mapping", _) => strings("planar"),
                    ("wrap" | "wrapv", _) => strings("clamp"),
                    ("channel", _) => strings("g"),
                    ("name", _) => strings("vertex_color"),
                    ("filter", _) => strings("EWA"),
                    ("encoding", _) => strings("gamma 2.2"),
                    (_, "integer") => Value::Integers(vec![3]),
                    (_, "bool") => Value::Bools(vec![true]),
                    (_, "vector3") => Value::Vectors3(vec![Vector3::new(0.0, 0.0, 1.0)]),
                    (_, "rgb") => Value::Rgb(vec![[0.5; 3]]),
                    _ => floats(&[0.5]),
                };
                // These belong to other mappings than the planar one, or to fewer dimensions.
                if matches!(spec.name, "uscale" | "vscale" | "uvrotation" | "dimension") {
                    continue;
                }
                entity = entity.with(spec.name, given);
            }
            let n_problems = if value == "float" {
                read_float(&entity, &assets).2
            } else {
                read_spectrum(&entity, &assets, SpectrumRole::Albedo).2
            };
            assert_eq!(n_problems, 0, "{value} texture \"{name}\"");
        }
    }
}
