//! Odd but legal scenes render.

use crate::support::{Folder, WORLD_LINE, mean, scene, unlit_scene};

/// Renders a scene without a complaint and returns the mean of the image.
#[track_caller]
fn brightness(text: &str, arguments: &str) -> f64 {
    let folder = Folder::with_scene(text);
    let run = folder.run(&format!("render scene.pbrt -o out.exr --no-progress {arguments}")).expect(0);
    assert!(!run.stderr.contains("warning"), "{}", run.stderr);
    let image = folder.image("out.exr");
    let finite = image.channels.iter().flat_map(|channel| &channel.values).all(|value| value.is_finite());
    assert!(finite);
    mean(&image)
}

/// Triangles without area reflect and emit nothing.
#[test]
fn triangles_without_area() {
    let triangle = "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 3 4 5 6 6 6 ]\n\
        \"point3 P\" [ 0 0 3 1 0 3 0 1 3   0 0 4 1 1 4 2 2 4   1 1 5 ]";
    assert!(brightness(&scene("", triangle), "--spp 16") > 0.0);
    let point = "\"point3 P\" [ 1 1 3 1 1 3 1 1 3 ]";
    assert_eq!(brightness(&scene("", &format!("Shape \"trianglemesh\" {point}")), ""), 0.0);
    let lamp = format!(
        "AreaLightSource \"diffuse\"\nShape \"trianglemesh\" {point}\nShape \"disk\" \"float height\" 3"
    );
    assert!(brightness(&scene("", &lamp), "--spp 16") > 0.0);
    let patch =
        "Shape \"bilinearmesh\" \"point3 P\" [ 0 0 3 0 0 3 0 0 3 0 0 3 ]\nShape \"disk\" \"float height\" 3";
    assert!(brightness(&scene("", patch), "--spp 16") > 0.0);
}

/// Lights of no power, of all kinds.
#[test]
fn lights_without_power() {
    for light in [
        "LightSource \"point\" \"rgb I\" [ 0 0 0 ]",
        "LightSource \"point\" \"float scale\" 0",
        "LightSource \"spot\" \"rgb I\" [ 0 0 0 ]",
        "LightSource \"distant\" \"rgb L\" [ 0 0 0 ]",
        "LightSource \"infinite\" \"rgb L\" [ 0 0 0 ]",
        "AreaLightSource \"diffuse\" \"rgb L\" [ 0 0 0 ]\nShape \"sphere\"",
        "AreaLightSource \"diffuse\" \"float scale\" 0\nShape \"sphere\"",
    ] {
        let world = format!("{light}\nAreaLightSource \"\"\nTranslate 0 0 4\nShape \"sphere\"");
        for sampler in ["bvh", "power", "uniform"] {
            let options = format!("Integrator \"path\" \"string lightsampler\" \"{sampler}\"");
            assert_eq!(brightness(&unlit_scene(&options, &world), ""), 0.0, "{light} by {sampler}");
            brightness(&scene(&options, &world), "");
        }
    }
}

/// A camera inside of closed shapes, on a surface, and in glass.
#[test]
fn camera_inside() {
    assert!(brightness(&scene("", "Shape \"sphere\" \"float radius\" 2"), "") > 0.0);
    assert!(
        brightness(&scene("", "Material \"dielectric\"\nShape \"sphere\" \"float radius\" 2"), "") >= 0.0
    );
    brightness(&scene("", "Shape \"disk\""), "");
    brightness(&scene("", "Material \"dielectric\"\nShape \"disk\""), "");
}

/// Without lights the image is black, and this is said.
#[test]
fn no_lights() {
    let text = unlit_scene("", "Shape \"sphere\"");
    let folder = Folder::with_scene(&text);
    folder
        .run("render scene.pbrt -o out.exr")
        .expect(0)
        .says("warning: the scene has no lights; the image will be black");
    assert_eq!(mean(&folder.image("out.exr")), 0.0);
}

/// Without shapes there is the sky.
#[test]
fn no_shapes() {
    let mean = brightness(&scene("", "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]"), "--spp 16");
    assert!((mean - 1.0).abs() < 0.2, "{mean}");
    assert_eq!(brightness(&scene("", ""), ""), 0.0);
}

/// One pixel, one row, one column; and parts of a film.
#[test]
fn small_films() {
    let text = scene("", "LightSource \"infinite\"\nTranslate 0 0 3\nShape \"sphere\"");
    for size in ["1x1", "1x7", "7x1", "33x1"] {
        assert!(brightness(&text, &format!("--resolution {size}")) > 0.0, "{size}");
    }
    let folder = Folder::with_scene(&text);
    let whole = folder.render("whole", "");
    let part = folder.render("part", "--crop 0.5,1,0.5,1");
    assert_eq!((part.width, part.height), (4, 3));
    // A pixel is the same in the whole and in the part.
    let (whole, part) = (whole.rgb_pixels().expect("colour"), part.rgb_pixels().expect("colour"));
    for y in 0..3 {
        assert_eq!(part[4 * y..4 * y + 4], whole[8 * (y + 3) + 4..8 * (y + 3) + 8]);
    }
    let one = folder.render("one", "--crop 0.3,0.4,0.8,0.9");
    assert_eq!((one.width, one.height), (1, 1));
}

/// Enormous, tiny and far away scenes.
#[test]
fn scales() {
    for scale in ["1e-15", "1e-6", "1e6", "1e15"] {
        let world = format!(
            "Scale {scale} {scale} {scale}\nTranslate 0 0 3\nShape \"sphere\"\nLightSource \"infinite\""
        );
        assert!(brightness(&unlit_scene("", &world), "") > 0.0, "{scale}");
    }
    brightness(
        &scene(
            "",
            "Translate 1e30 0 0\nShape \"sphere\"\nShape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]",
        ),
        "",
    );
}

/// Instances without shapes, objects without instances.
#[test]
fn empty_objects() {
    let world = "ObjectBegin \"none\"\nObjectEnd\nObjectInstance \"none\"\nObjectBegin \"unused\"\nShape \"sphere\"\n\
        ObjectEnd\nTranslate 0 0 3\nShape \"sphere\"";
    assert!(brightness(&scene("", world), "") >= 0.0);
    brightness(&scene("", "ObjectBegin \"none\"\nObjectEnd\nObjectInstance \"none\""), "");
}

/// Films of other kinds have their channels.
#[test]
fn films() {
    let film = "Film \"gbuffer\" \"integer xresolution\" 8 \"integer yresolution\" 6";
    let folder = Folder::with_scene(&scene(film, "Translate 0 0 3\nShape \"sphere\""));
    let image = folder.render("out", "");
    for channel in ["Albedo.R", "P.X", "N.Z", "Ns.Y", "u", "depth.Z"] {
        assert!(image.channel(channel).is_some(), "{channel}");
    }
    let film = "Film \"spectral\" \"integer xresolution\" 8 \"integer yresolution\" 6 \"integer nbuckets\" 4";
    let folder = Folder::with_scene(&scene(film, "Translate 0 0 3\nShape \"sphere\""));
    let image = folder.render("out", "");
    assert_eq!(image.channels.iter().filter(|c| c.name.starts_with("S0.")).count(), 4);
}

/// Blocks may be nested as deep as a program cares to write them.
#[test]
fn deep_blocks() {
    let n = 100_000;
    let world = format!("{}Shape \"sphere\"\n{}", "AttributeBegin\n".repeat(n), "AttributeEnd\n".repeat(n));
    assert!(brightness(&scene("", &world), "") > 0.0);
}

/// Textures may be nested, but are evaluated by recursion, so that there is a limit.
#[test]
fn deep_textures() {
    let chain = |n: usize| {
        let mut world = "Texture \"t0\" \"spectrum\" \"checkerboard\"\n".to_owned();
        for i in 1..n {
            let inner = format!("\"texture tex1\" \"t{}\"", i - 1);
            world += &format!("Texture \"t{i}\" \"spectrum\" \"checkerboard\" {inner}\n");
        }
        world + &format!("Material \"diffuse\" \"texture reflectance\" \"t{}\"\nShape \"sphere\"", n - 1)
    };
    assert!(brightness(&scene("", &chain(100)), "--spp 4") > 0.0);
    let folder = Folder::with_scene(&scene("", &chain(10_000)));
    folder
        .run("render scene.pbrt -o out.exr")
        .expect(2)
        .says("scene.pbrt:107:27: error: textures are nested in each other more than 100 deep")
        .says("\n1 error\n");
}

/// Mixtures of mixtures are chosen from by a walk, which may be long.
#[test]
fn deep_mixtures() {
    let mut world = "MakeNamedMaterial \"m0\" \"string type\" \"diffuse\"\n".to_owned();
    for i in 1..5000 {
        let parts = format!("\"string materials\" [ \"m{0}\" \"m{0}\" ]", i - 1);
        world += &format!("MakeNamedMaterial \"m{i}\" \"string type\" \"mix\" {parts}\n");
    }
    world += "NamedMaterial \"m4999\"\nShape \"sphere\"";
    assert!(brightness(&scene("", &world), "") > 0.0);
}

/// Numbers of materials that mean nothing are named with their place, and with the value that is taken; none ends the render.
#[test]
fn materials() {
    let check = |material: &str, says: &[&str]| {
        let folder = Folder::with_scene(&scene("", &format!("{material}\nShape \"sphere\"")));
        let mut run = folder.run("render scene.pbrt -o out.exr --spp 1").expect(0);
        run = run.says(&format!("scene.pbrt:{WORLD_LINE}:"));
        for text in says {
            run = run.says(text);
        }
    };
    let negative = "\"roughness\" is -0.2, but must be in [0, 10]; it is taken as 0";
    check("Material \"conductor\" \"float roughness\" -0.2", &[negative]);
    check("Material \"dielectric\" \"float roughness\" -0.2", &[negative]);
    let bright = "is a reflectance above 1 (1.4); it is clamped to 1";
    check("Material \"diffuse\" \"float reflectance\" 1.4", &[bright]);
    check("Material \"conductor\" \"float reflectance\" 1.4", &[bright]);
    let spectrum = "Material \"diffuse\" \"spectrum reflectance\" [ 400 0.5 500 1.4 600 0.5 ]";
    check(spectrum, &[bright]);
    for material in ["dielectric", "thindielectric", "coateddiffuse"] {
        check(&format!("Material \"{material}\" \"float eta\" 0"), &["must be positive; it is taken as 1"]);
    }
    let gap = "Material \"dielectric\" \"spectrum eta\" [ 400 1.5 600 -1 700 1.5 ]";
    check(gap, &["must be positive; it is taken as 1 where it is not"]);
    check("Material \"conductor\" \"float k\" -2", &["\"k\" is negative; it is taken as its absolute value"]);
    let grows = "Material \"dielectric\" \"spectrum absorption\" [ 400 -3 700 1 ]";
    check(grows, &["negative absorption is taken as 0"]);
    check(
        "Material \"phong\" \"float ambient\" -1",
        &["an ambient term that is negative at some wavelength is taken as 0"],
    );
}
