//! Printing a document and reading it again gives the same document.

use std::path::{Path, PathBuf};

use etendue_math::{AnimatedTransform, Transform};
use etendue_scene::Document;
use etendue_scene::document::{Entity, MaterialReference, ShapeEntity, Value};

use super::super::{read_pbrt, read_pbrt_str, write_pbrt};
use super::{listed, read};

/// All that a document says but spans: exact text, and transforms, whose inverses may be rounded differently.
#[derive(Default)]
struct Content {
    text: Vec<String>,
    transforms: Vec<Transform>,
}

impl Content {
    fn of(document: &Document) -> Self {
        let mut content = Self::default();
        let mut line = |text: String| content.text.push(text);
        for option in &document.options {
            line(format!("option {} {:?}", option.name, option.value));
        }
        line(format!("film {:?}", document.film_color_space));
        let entities = [
            &document.film,
            &document.sampler,
            &document.filter,
            &document.integrator,
            &document.accelerator,
        ];
        for entity in entities {
            line(entity.as_ref().map(entity_text).unwrap_or_default());
        }
        if let Some(camera) = &document.camera {
            line(format!("camera {} {}", camera.medium, entity_text(&camera.entity)));
            content.transform(&camera.world_from_camera);
        }
        for (index, material) in document.materials.iter().enumerate() {
            let text = entity_text(&material.entity);
            // The default material is there without being written.
            if index > 0 || text != "diffuse " {
                content.text.push(text);
            }
        }
        for texture in &document.textures {
            content.text.push(format!(
                "{} {:?} {}",
                texture.name,
                texture.value,
                entity_text(&texture.entity)
            ));
            content.transforms.push(texture.world_from_texture);
        }
        for medium in &document.media {
            content.text.push(format!("{} {}", medium.name, entity_text(&medium.entity)));
            content.transform(&medium.world_from_medium);
        }
        for light in &document.lights {
            content.text.push(format!("{} {}", light.outside_medium, entity_text(&light.entity)));
            content.transform(&light.world_from_light);
        }
        for shape in &document.shapes {
            content.shape(document, shape);
        }
        for object in &document.objects {
            content.text.push(format!("object {}", object.name));
            for shape in &object.shapes {
                content.shape(document, shape);
            }
        }
        for instance in &document.instances {
            content.text.push(format!("instance {}", instance.object));
            content.transform(&instance.world_from_instance);
        }
        content
    }

    fn transform(&mut self, transform: &AnimatedTransform) {
        self.transforms.extend([transform.start, transform.end]);
        self.text.push(format!("times {} {}", transform.start_time, transform.end_time));
    }

    /// The material and the light by what they are, not by their index or name.
    fn shape(&mut self, document: &Document, shape: &ShapeEntity) {
        let material = match &shape.material {
            MaterialReference::Index(index) => Some(&document.materials[*index]),
            MaterialReference::Name(name, _) => {
                document.materials.iter().find(|m| m.name.as_deref() == Some(name))
            }
        };
        let material = material.map_or("unknown".to_owned(), |material| entity_text(&material.entity));
        let light = shape.area_light.map(|index| entity_text(&document.area_lights[index]));
        self.text.push(format!(
            "{} {material} {light:?} {} {:?}",
            entity_text(&shape.entity),
            shape.reverse_orientation,
            (&shape.inside_medium, &shape.outside_medium, shape.has_medium_interface),
        ));
        self.transform(&shape.world_from_object);
    }
}

fn entity_text(entity: &Entity) -> String {
    let parameters =
        entity.parameters.iter().map(|p| format!("{}: {:?} {:?}", p.name, p.value, p.color_space));
    format!("{} {}", entity.type_name, parameters.collect::<Vec<_>>().join(", "))
}

#[track_caller]
fn check_same_content(a: &Document, b: &Document) {
    let (a, b) = (Content::of(a), Content::of(b));
    for (a, b) in a.text.iter().zip(&b.text) {
        assert_eq!(a, b);
    }
    assert_eq!(a.text.len(), b.text.len());
    assert_eq!(a.transforms.len(), b.transforms.len());
    for (a, b) in a.transforms.iter().zip(&b.transforms) {
        let largest = a.rows().iter().flatten().fold(0.0_f32, |m, x| m.max(x.abs()));
        for (x, y) in a.rows().iter().flatten().zip(b.rows().iter().flatten()) {
            assert!((x - y).abs() <= 1e-5 * largest, "{a:?}\nis not\n{b:?}");
        }
    }
}

/// Also checks that printing once more changes nothing at all.
#[track_caller]
fn check_round_trip(document: &Document) {
    let printed = write_pbrt(document);
    let (again, diagnostics) = read_pbrt_str("printed.pbrt", &printed, Path::new(""));
    let problems = listed(&again, &diagnostics);
    assert!(problems.is_empty(), "{problems:#?}");
    check_same_content(document, &again);
    assert_eq!(write_pbrt(&again), printed, "printing is stable");
}

/// ARCH-3: a scene with all that a document can hold survives printing.
#[test]
fn everything_survives_printing() {
    let document = read(
        r#"Option "seed" 3 Option "disablepixeljitter" true Option "msereferenceimage" "a\\b\".exr" Option "x" 1.5
        ColorSpace "rec2020" Film "rgb" "string filename" "ü \t.exr" "float diagonal" 35.000004
        ColorSpace "srgb" Sampler "halton" PixelFilter "box" "float xradius" .1
        Integrator "path" "bool regularize" true "integer maxdepth" -3
        Accelerator "bvh" TransformTimes 0.25 1.5 MediumInterface "fog" LookAt 1 2 3 0 0 0 0 1 0
        ActiveTransform EndTime Rotate 3 0 1 0 ActiveTransform All
        Camera "perspective" "float screenwindow" [ -1 1 -1e-7 12345678901234567890 ]
        WorldBegin Translate 1 2 3
        MakeNamedMedium "fog" "string type" "uniformgrid" "point3 p0" [0 0 0] "float density" [1 2 3 4 5 6 7 8]
        Texture "t" "float" "scale" "texture tex" "s" "float scale" 2
        Texture "t" "spectrum" "constant" "rgb value" [.1 .2 .3]
        ColorSpace "aces2065-1" Attribute "shape" "rgb color" [1 0 0] Attribute "light" "rgb L" [1 2 3]
        ColorSpace "dci-p3" Attribute "shape" "float alpha" 1 "vector3 v" [1 2 3]
        Material "diffuse" "rgb reflectance" [.1 .1 .1] Shape "sphere" "float radius" 2
        MakeNamedMaterial "glass" "string type" "dielectric" "spectrum eta" "glass-BK7"
        MakeNamedMaterial "material 1" "string type" "diffuse"
        AttributeBegin NamedMaterial "glass" ReverseOrientation Rotate 30 1 1 1
          AreaLightSource "diffuse" "blackbody L" 3000 "float scale" 2 MediumInterface "" "fog"
          Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0.1] "integer indices" [0 1 2] "point2 uv" [0 0 1 0 0 1]
            "normal N" [0 0 1 0 0 1 0 0 1] "vector2 w" [1 2]
          Shape "disk"
        AttributeEnd
        Material "conductor" "spectrum k" [400 1.5 700.25 2] "string materials" ["a" "b" "" ]
        AttributeBegin Material "interface" Shape "cylinder" AttributeEnd Shape "cylinder"
        ObjectBegin "tree" Shape "disk" "bool b" [true false] ActiveTransform EndTime Scale 1 1 2 Shape "cone" ObjectEnd
        Scale -1 1 1 ObjectInstance "tree" ActiveTransform StartTime Translate 1 0 0 ObjectInstance "tree"
        LightSource "distant" "illuminant" 3 LightSource "point" "spectrum I" "stdillum-D65""#
            .replace("\"illuminant\" 3", "\"float illuminance\" 3")
            .as_str(),
    );
    assert_eq!((document.shapes.len(), document.materials.len()), (5, 6));
    check_round_trip(&document);
}

/// Documents that no file wrote print as well.
#[test]
fn made_documents_survive_printing() {
    check_round_trip(&Document::default());
    let mut document = Document::default();
    document.materials[0].entity = Entity::new("diffuse").with("reflectance", Value::Rgb(vec![[0.5; 3]]));
    document.shapes.push(ShapeEntity {
        entity: Entity::new("sphere")
            .with("radius", Value::Floats(vec![f32::MIN_POSITIVE, f32::MAX, 0.1, -0.0])),
        world_from_object: AnimatedTransform::constant(Transform::IDENTITY),
        reverse_orientation: false,
        material: MaterialReference::Index(0),
        area_light: None,
        inside_medium: String::new(),
        outside_medium: String::new(),
        has_medium_interface: false,
    });
    check_round_trip(&document);
}

/// All scene files in the folder of shared scenes, if it is there.
#[expect(clippy::print_stdout, reason = "a skipped test should say so")]
pub(super) fn shared_scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/scenes");
    let mut scenes = Vec::new();
    let mut folders = vec![folder.clone()];
    while let Some(folder) = folders.pop() {
        let Ok(entries) = std::fs::read_dir(&folder) else { continue };
        for path in entries.filter_map(|entry| entry.ok().map(|entry| entry.path())) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "pbrt") {
                scenes.push(path);
            }
        }
    }
    scenes.sort();
    if scenes.is_empty() {
        assert!(
            std::env::var_os("ETENDUE_REQUIRE_SHARED").is_none_or(|value| value != "1"),
            "there are no scenes in {}",
            folder.display()
        );
        println!("skipped: there are no scenes in {}", folder.display());
    }
    scenes
}

/// ARCH-3: scenes made for pbrt-v4 are read without errors and survive printing.
#[test]
fn shared_scenes_survive_printing() {
    for scene in shared_scenes() {
        let (document, diagnostics) = read_pbrt(&scene);
        let problems = listed(&document, &diagnostics);
        assert!(!diagnostics.has_errors(), "{}: {problems:#?}", scene.display());
        assert!(document.camera.is_some() && document.film.is_some(), "{}", scene.display());
        assert!(!document.shapes.is_empty() || !document.instances.is_empty(), "{}", scene.display());
        check_round_trip(&document);
    }
}
