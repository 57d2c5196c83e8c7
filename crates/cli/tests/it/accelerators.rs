//! Structures that find what rays meet, as a scene chooses them.

use crate::support::Folder;

/// Everything that a structure has to pass on: meshes, patches, formulae, holes by alpha, instances still and moving.
const WORLD: &str = r#"
Film "rgb" "integer xresolution" 48 "integer yresolution" 32
Sampler "independent" "integer pixelsamples" 2
LookAt 0 -6 3  0 0 0.5  0 0 1
Camera "perspective" "float fov" 40 "float shutteropen" 0 "float shutterclose" 1
Integrator "path" "integer maxdepth" 4
ACCELERATOR
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 20 18 15 ]
  Translate 0 0 4
  Shape "disk" "float radius" 0.5
AttributeEnd
Texture "holes" "float" "checkerboard" "float uscale" 6 "float vscale" 6 "float tex1" 0 "float tex2" 1
Shape "bilinearmesh" "point3 P" [ -4 -4 0  4 -4 0  -4 4 0  4 4 0.7 ]
Shape "bilinearmesh" "point3 P" [ -2 1 0  2 1 0  -2 1 2  2 1 2 ] "texture alpha" "holes"
ObjectBegin "thing"
  Material "conductor"
  Shape "sphere" "float radius" 0.4
  Material "diffuse" "rgb reflectance" [ 0.8 0.3 0.2 ]
  Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3  0 3 1  1 3 2 ]
    "point3 P" [ -0.5 -0.5 -0.2  0.6 -0.4 -0.2  0 0.6 -0.2  0 0 0.7 ]
ObjectEnd
AttributeBegin
  Translate -1.5 0 0.5
  ObjectInstance "thing"
  Translate 1.5 -0.5 0
  Scale 1 -0.7 1.2
  ObjectInstance "thing"
AttributeEnd
AttributeBegin
  ActiveTransform EndTime
  Translate 0.6 0 0.3
  ActiveTransform All
  Translate 1.4 0 0.6
  ObjectInstance "thing"
AttributeEnd
"#;

/// SPEC ACC-4: the picture is the same, bit for bit, whatever the structure.
#[test]
fn pictures_do_not_depend_on_the_structure() {
    let folder = Folder::new();
    let render = |accelerator: &str| {
        folder.write("scene.pbrt", WORLD.replace("ACCELERATOR", accelerator));
        folder.run("render scene.pbrt -q --seed 3 -o out.pfm").expect(0);
        folder.read("out.pfm")
    };
    let expected = render("");
    assert!(expected[100..].iter().any(|byte| *byte != 0));
    let list = folder.run("list accelerators --json").expect(0).json();
    let items = list["items"].as_array().expect("a list").clone();
    assert_eq!(items.len(), 8);
    for item in items {
        let name = item["name"].as_str().expect("a name");
        assert!(render(&format!("Accelerator \"{name}\"")) == expected, "{name}");
    }
    assert!(render("Accelerator \"kdtree\" \"integer maxdepth\" 3 \"integer maxprims\" 4") == expected);
}

/// What a structure cannot be is said where it stands.
#[test]
fn wrong_parameters_are_located() {
    let folder =
        Folder::with_scene(&WORLD.replace("ACCELERATOR", "Accelerator \"grid\" \"float density\" -1"));
    folder.run("info scene.pbrt").expect(0).says("scene.pbrt:7:20: warning").says("but is -1; 0 is taken");
    folder.write("scene.pbrt", WORLD.replace("ACCELERATOR", "Accelerator \"octree\" \"integer maxdpth\" 4"));
    folder.run("info scene.pbrt").expect(0).says("did you mean \"maxdepth\"?");
}
