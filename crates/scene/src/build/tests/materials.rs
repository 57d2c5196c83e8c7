//! Materials by name and by index.

use super::*;
use crate::material::{Material, MixMaterial};

/// A document with these materials after the default one, and a sphere that names one of them.
fn document(materials: Vec<MaterialEntity>, name: &str) -> Document {
    let material = MaterialReference::Name(name.to_owned(), Some(HERE));
    let mut document = lit_with(vec![ShapeEntity { material, ..sphere() }]);
    document.materials.extend(materials);
    document
}

/// The material of the sphere.
fn material(scene: &Scene) -> &Material {
    scene.materials.get(scene.attributes[0].material)
}

fn mix(first: &str, second: &str) -> Entity {
    Entity::new("mix").with("materials", strings(&[first, second]))
}

fn parts(mixture: &Material) -> [MaterialId; 2] {
    let Material::Mix(MixMaterial { materials, .. }) = mixture else { panic!("{mixture:?} is no mixture") };
    *materials
}

/// A material may be named before the place that defines it, also by mixtures of mixtures.
#[test]
fn names_may_be_used_before_they_are_defined() {
    let materials = vec![
        named_material("outer", mix("inner", "glass")),
        named_material("inner", mix("glass", "metal")),
        named_material("metal", Entity::new("conductor")),
        named_material("glass", Entity::new("dielectric")),
    ];
    let scene = scene(&document(materials, "outer"));
    let [inner, glass] = parts(material(&scene)).map(|part| scene.materials.get(part));
    assert!(matches!(glass, Material::Dielectric(_)));
    let [glass, metal] = parts(inner).map(|part| scene.materials.get(part));
    assert!(matches!((glass, metal), (Material::Dielectric(_), Material::Conductor(_))));
}

/// Unnamed materials are found by their index, whatever order they were built in.
#[test]
fn materials_by_index() {
    let mut document = lit_with(
        [0, 1, 2].map(|i| ShapeEntity { material: MaterialReference::Index(i), ..sphere() }).to_vec(),
    );
    document.materials.push(MaterialEntity { name: None, entity: mix("glass", "glass") });
    document.materials.push(named_material("glass", Entity::new("dielectric")));
    let scene = scene(&document);
    let kinds = scene.attributes.iter().map(|a| scene.materials.get(a.material)).collect::<Vec<_>>();
    assert!(
        matches!(kinds.as_slice(), [Material::Diffuse(_), Material::Mix(_), Material::Dielectric(_)]),
        "{kinds:?}"
    );
}

/// Mixtures that contain each other have no end: they are errors, reported once for each circle.
#[test]
fn mixtures_in_a_circle_are_errors() {
    let check = |materials: Vec<(&str, Entity)>| {
        let first = materials[0].0;
        let mut named: Vec<MaterialEntity> =
            materials.iter().map(|(name, entity)| named_material(name, here(entity.clone()))).collect();
        named.push(named_material("glass", Entity::new("dielectric")));
        error_here(&document(named, first), "the mixture contains itself");
    };
    check(vec![("a", mix("a", "glass"))]);
    check(vec![("a", mix("b", "glass")), ("b", mix("glass", "a"))]);
    check(vec![("a", mix("b", "b")), ("b", mix("c", "c")), ("c", mix("a", "a"))]);
    check(vec![("entry", mix("a", "b")), ("a", mix("b", "glass")), ("b", mix("a", "glass"))]);
}

/// Neither a long chain of mixtures nor one that branches at every link takes long or overflows the stack.
#[test]
fn long_chains_of_mixtures() {
    let n = 20_000;
    let mut materials: Vec<MaterialEntity> = (0..n)
        .map(|i| named_material(&format!("m{i}"), mix(&format!("m{}", i + 1), &format!("m{}", i + 1))))
        .collect();
    materials.push(named_material(&format!("m{n}"), Entity::new("dielectric")));
    let scene = scene(&document(materials, "m0"));
    assert_eq!(scene.materials.len(), n + 3);
    let ray = down(0.0, 0.0);
    let hit = scene.intersect(&ray, f32::INFINITY).expect("the sphere is below");
    let mut lambda = etendue_spectrum::Wavelengths::sample_visible(0.5);
    let bsdf = scene.bsdf(&scene.surface(&ray, &hit), &mut lambda).expect("glass scatters");
    assert!(matches!(bsdf.kind(), crate::bsdf::BsdfKind::Dielectric(_)));
}

/// Materials that only pbrt-v4 has look grey.
#[test]
fn missing_materials_are_grey() {
    let entity = here(Entity::new("subsurface").with("name", strings(&["Apple"])));
    let document = document(vec![named_material("m", entity)], "m");
    let scene = warning_here(&document, "the material \"subsurface\" is not available yet");
    assert_eq!(*material(&scene), Material::default());
}

/// Names of materials that do not exist are errors, whether of types, of parts or of uses.
#[test]
fn unknown_materials_are_errors() {
    let check = |materials: Vec<MaterialEntity>, name: &str, message: &str, help: &str| {
        assert_helps(&error_here(&document(materials, name), message), help);
    };
    let glass = || named_material("glass", Entity::new("dielectric"));
    let typo = named_material("m", here(Entity::new("difuse")));
    check(vec![typo], "m", "unknown material \"difuse\"", "did you mean \"diffuse\"?");
    check(vec![glass()], "glas", "unknown material \"glas\"", "did you mean \"glass\"?");
    let half = named_material("half", here(mix("glass", "gloss")));
    check(vec![glass(), half], "half", "unknown material \"gloss\"", "did you mean \"glass\"?");
    let three = Entity::new("mix").with("materials", strings(&["glass", "glass", "glass"]));
    let three = named_material("three", here(three));
    error_here(&document(vec![glass(), three], "three"), "takes two names, not 3");
}

/// A mixture of something wrong is not wrong itself.
#[test]
fn errors_do_not_spread_to_mixtures() {
    let wrong = named_material("wrong", here(Entity::new("difuse")));
    error_here(
        &document(vec![wrong, named_material("half", mix("wrong", "wrong"))], "half"),
        "unknown material",
    );
}

/// A thousand shapes under one name that does not exist are one problem.
#[test]
fn problems_of_many_shapes_are_reported_once() {
    let mut document = document(Vec::new(), "nothing");
    document.shapes = vec![document.shapes[0].clone(); 1000];
    error_here(&document, "unknown material \"nothing\"");
}

/// Textures that only pbrt-v4 has are grey; textures that nobody has are errors.
#[test]
fn missing_and_unknown_textures() {
    let ptex = float_texture("p", here(Entity::new("ptex").with("filename", strings(&["a.ptx"]))));
    let diffuse = Entity::new("diffuse").with("displacement", texture("p"));
    let mut with_ptex = document(vec![named_material("m", diffuse)], "m");
    with_ptex.textures.push(ptex);
    warning_here(&with_ptex, "the texture \"ptex\" is not available yet");
    let typo = float_texture("p", here(Entity::new("checkerbord")));
    let problem = error_here(&Document { textures: vec![typo], ..lit() }, "unknown float texture");
    assert_helps(&problem, "did you mean \"checkerboard\"?");
}
