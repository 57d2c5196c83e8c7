//! Pictures as people use them: `compare`, `falsecolor`, `probe`, `image`, OpenEXR with all it holds, displays beyond sRGB, terminals.

use etendue::image::Image;
use etendue::io::images::write_image;

use crate::support::{Folder, ROOM, assert_same};

/// A ramp of luminance from 1 to 10,000.
fn ramp() -> Image {
    Image::from_fn(40, 20, |x, _| [10f32.powf(4.0 * x as f32 / 39.0); 3])
}

/// Metrics of renders, which carry variance and radiance.
#[test]
fn comparison_of_renders() {
    let folder = Folder::with_scene(&ROOM.replace("zsobol", "independent"));
    folder.render("a", "--spp 64 --seed 1");
    folder.render("b", "--spp 64 --seed 2");
    let json = folder.run("compare a.exr b.exr --json").expect(0).json();
    let number = |key: &str| json[key].as_f64().unwrap_or_else(|| panic!("{key}: {json}"));
    assert!((0.0..1.0).contains(&number("ssim")) && number("hdr_flip") > 0.0, "{json}");
    assert!(number("relmse_trimmed") <= number("relmse"), "{json}");
    // Two seeds of one scene: Student's t with 63 degrees of freedom at least, whose variance is at most 63 / 61.
    assert!((0.5..2.0).contains(&number("z_rms")) && number("p_mean") > 1e-6, "{json}");
    // Half of the picture is black, without variance.
    assert!((300.0..960.0).contains(&number("z_pixels")), "{json}");
    for kind in ["flip", "hdr-flip", "absolute", "signed", "relative", "z", "side-by-side", "split"] {
        folder.run(&format!("compare a.exr b.exr -o {kind}.png --map {kind}")).expect(0);
        let width = if kind == "side-by-side" { 3 * 40 + 2 } else { 40 };
        assert_eq!(folder.image(&format!("{kind}.png")).width, width, "{kind}");
    }
    folder.run("compare a.exr b.exr --difference d.png").expect(0);
    // A display's picture has no radiance and no variance.
    folder.run("tonemap a.exr -o a.png").expect(0);
    folder.run("tonemap b.exr -o b.png").expect(0);
    let json = folder.run("compare a.png b.png --json").expect(0).json();
    assert!(json["hdr_flip"].is_null() && json["z_rms"].is_null() && json["flip"].is_number(), "{json}");
    folder.run("compare a.png b.png -o z.png --map z").expect(2).says("variance.Y");
    folder.run("compare a.png b.png --exposure nan").expect(2).says("stops");
    folder.run("compare a.png b.png --pixels-per-degree 0").expect(2).says("1 to 1000");
}

/// Pixels that are not finite are named and left out.
#[test]
fn comparison_with_nan() {
    let folder = Folder::new();
    let mut image = ramp();
    write_image(folder.path("whole.exr"), &image).expect("written");
    image.channels[1].values[7] = f32::NAN;
    image.channels[0].values[9] = f32::INFINITY;
    write_image(folder.path("nan.exr"), &image).expect("written");
    let run = folder.run("compare nan.exr whole.exr").expect(0);
    assert!(
        run.stdout.contains("2 of 800 pixels are not finite (2 of the image, 0 of the reference)"),
        "{}",
        run.stdout
    );
    let json = folder.run("compare nan.exr whole.exr --json").expect(0).json();
    assert_eq!((&json["mse"], &json["hdr_flip"], &json["masked"]), (&0.0.into(), &0.0.into(), &2.into()));
    let says = "nan.exr: 2 of 800 pixels are not finite";
    folder.run("falsecolor nan.exr -o map.png").expect(0).says(says);
    folder.run("tonemap nan.exr -o shown.png").expect(0).says(says);
    folder.run("denoise nan.exr -o spread.exr --fireflies-only").expect(0).says(says);
    image.set_channel("variance.Y", vec![0.01; 800]);
    write_image(folder.path("noisy.exr"), &image).expect("written");
    folder.run("denoise noisy.exr -o clean.exr").expect(0).says("noisy.exr: 2 pixels are not finite");
    for command in ["tonemap whole.exr -o shown.png", "denoise whole.exr -o spread.exr --fireflies-only"] {
        let run = folder.run(command).expect(0);
        assert!(!run.stderr.contains("not finite"), "{command}: {}", run.stderr);
    }
    folder.run("image info nan.exr").expect(0).says("1 values are NaN, 1 are infinite");
}

/// Maps with legend and contours; statistics of the field.
#[test]
fn false_colors() {
    let folder = Folder::new();
    write_image(folder.path("ramp.exr"), &ramp()).expect("written");
    let run =
        folder.run("falsecolor ramp.exr -o map.png -o map.exr").expect(0).says("does not tell the unit");
    let lines: Vec<&str> =
        run.stdout.lines().map(|line| line.split(' ').next().unwrap_or_default()).collect();
    assert_eq!(lines, ["min", "mean", "max", "min"], "{}", run.stdout);
    assert!(run.stdout.contains(" cd/m²"), "{}", run.stdout);
    let map = folder.image("map.png");
    // Nine times as large, for small pictures can hardly be read, with a legend.
    assert!(map.width > 360 && map.height == 180);
    let json =
        folder.run("falsecolor ramp.exr -o bare.png --no-legend --json --palette heat").expect(0).json();
    assert!(
        (json["min"].as_f64().expect("a number") - 1.0).abs() < 1e-6 && json["unit"] == "cd/m²",
        "{json}"
    );
    assert_eq!(folder.image("bare.png").width, 360);
    // White paper that reflects 80 %.
    let arguments = "falsecolor ramp.exr -o lux.png --reflectance 0.8 --range 1,1000 --scale log --json";
    let json = folder.run(arguments).expect(0).json();
    let max = json["max"].as_f64().expect("a number");
    assert!((max / (std::f64::consts::PI * 1e4 / 0.8) - 1.0).abs() < 1e-5 && json["unit"] == "lx", "{json}");
    for (wrong, says) in [
        ("--quantity illuminance", "--reflectance"),
        ("--quantity luminance --reflectance 0.5", "is for illuminance"),
        ("--reflectance 0", "above 0"),
        ("--range 5,1", "MIN below MAX"),
        ("--range 0,1 --scale log", "above 0"),
        ("--range 0,inf", "MIN below MAX"),
        ("--multiply -1", "positive"),
    ] {
        folder.run(&format!("falsecolor ramp.exr -o no.png {wrong}")).expect(2).says(says);
    }
    folder.run("falsecolor none.exr -o no.png").expect(2).says("none.exr");
    folder.run("falsecolor ramp.exr -o no.gif").expect(2).says("no.gif");
    assert!(!folder.files().contains(&"no.png".to_owned()));
}

/// Exposure and colour space of a render are undone: luminance is that of the scene.
#[test]
fn luminance_of_renders() {
    let exposed = "\"float iso\" 400 \"float exposuretime\" 0.5";
    let mut shown = Vec::new();
    for (space, film) in [("srgb", ""), ("srgb", exposed), ("rec2020", exposed)] {
        let folder = Folder::with_scene(&format!(
            "ColorSpace \"{space}\"
            Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4 {film}
            Camera \"perspective\" WorldBegin
            LightSource \"infinite\" \"spectrum L\" [360 1 830 1] \"float scale\" 50"
        ));
        let image = folder.render("a", "--spp 256");
        let primaries = image.metadata.get("chromaticities").map(|text| text.starts_with("0.708 0.292"));
        assert_eq!(primaries, (space == "rec2020").then_some(true), "{:?}", image.metadata);
        let json = folder.run("falsecolor a.exr -o map.png --json").expect(0).json();
        let mean = json["mean"].as_f64().expect("a number");
        assert!((mean / 50.0 - 1.0).abs() < 0.02, "{space} {film}: {json}");
        // What a display shows is the same whatever the primaries of the file.
        folder.run("tonemap a.exr -o a.png --exposure -8").expect(0);
        shown.push(folder.image("a.png").rgb_pixels().expect("colour")[0]);
    }
    assert!((0..3).all(|c| (shown[1][c] / shown[2][c] - 1.0).abs() < 0.05), "{shown:?}");
}

/// Light below a uniform sky of luminance L: pi L lux, at points, on grids, in all formats.
#[test]
fn probes() {
    let scene = "Camera \"perspective\" WorldBegin
        LightSource \"infinite\" \"spectrum L\" [360 1 830 1] \"float scale\" 100
        Material \"diffuse\" \"spectrum reflectance\" [360 0.5 830 0.5]
        Shape \"bilinearmesh\" \"point3 P\" [-5 -5 0  5 -5 0  -5 5 0  5 5 0]";
    let folder = Folder::with_scene(scene);
    let run = folder.run("probe scene.pbrt --at 0,0,0 --at 1,1,1 --normal 0,0,2 --samples 256").expect(0);
    assert_eq!(run.stdout.lines().count(), 3);
    assert!(run.stdout.starts_with("x,y,z,nx,ny,nz,illuminance_lx,"), "{}", run.stdout);
    let json = folder.run("probe scene.pbrt --at 0,0,0 --normal 0,0,1 --json").expect(0).json();
    let point = &json["points"][0];
    let number = |key: &str| point[key].as_f64().unwrap_or_else(|| panic!("{json}"));
    // Student's t of 15 degrees of freedom exceeds 8 with probability below 1e-6.
    let limit = 8.0 * number("illuminance_error_lx") + 0.01;
    assert!((number("illuminance_lx") - 314.159).abs() < limit && limit < 5.0, "{json}");
    assert!((number("luminance_cd_m2") - 100.0).abs() < 2.0, "{json}");

    let grid = "probe scene.pbrt --at -1,-1,0 --normal 0,0,1 --grid 6x4 --u 2,0,0 --v 0,2,0 --samples 64";
    folder.run(&format!("{grid} -o grid.exr -o grid.csv")).expect(0);
    let image = folder.image("grid.exr");
    assert_eq!((image.width, image.height, &*image.metadata["etendue.unit"]), (6, 4, "lx"));
    assert_eq!(String::from_utf8(folder.read("grid.csv")).expect("text").lines().count(), 25);
    let json = folder.run("falsecolor grid.exr -o lux.png --json").expect(0).json();
    assert!(
        (json["mean"].as_f64().expect("a number") - 314.159).abs() < 5.0 && json["unit"] == "lx",
        "{json}"
    );
    folder
        .run("falsecolor grid.exr -o no.png --quantity luminance")
        .expect(2)
        .says("illuminance, not luminance");
    let again = folder.run(&format!("{grid} --seed 0 -o again.exr")).expect(0);
    assert_eq!(again.stdout, "");
    assert_same(&image, &folder.image("again.exr"));

    for (wrong, says) in [
        ("--at 0,0,0 --normal 0,0,0", "length above 0"),
        ("--at 0,0 --normal 0,0,1", "three numbers"),
        ("--at 0,0,nan --normal 0,0,1", "three numbers"),
        ("--at 0,0,0 --normal 0,0,1 --normal 0,1,0", "one for each"),
        ("--at 0,0,0 --normal 0,0,1 --grid 2x2", "--u"),
        ("--at 0,0,0 --normal 0,0,1 --grid 2x2000 --u 1,0,0 --v 0,1,0", "at most 1000"),
        ("--at 0,0,0 --at 1,0,0 --normal 0,0,1 --grid 2x2 --u 1,0,0 --v 0,1,0", "its corner"),
        ("--at 0,0,0 --normal 0,0,1 -o a.exr", "need a --grid"),
        ("--at 0,0,0 --normal 0,0,1 -o none/a.csv", "no folder none"),
        ("--at 0,0,0 --normal 0,0,1 --samples 0", "0"),
        ("--normal 0,0,1", "--at"),
    ] {
        folder.run(&format!("probe scene.pbrt {wrong}")).expect(2).says(says);
    }
    folder.run("probe none.pbrt --at 0,0,0 --normal 0,0,1").expect(2).says("none.pbrt");
}

/// A point far from everything, and one in a closed black room, read 0.
#[test]
fn probes_in_the_dark() {
    let scene = "Camera \"perspective\" WorldBegin LightSource \"point\" \"float scale\" 10
        AttributeBegin Translate 100 0 0 Shape \"sphere\" \"float radius\" 1 AttributeEnd";
    let folder = Folder::with_scene(scene);
    let run = folder
        .run("probe scene.pbrt --at 100,0,0 --at 1e30,0,0 --normal 1,0,0 --samples 16 --json")
        .expect(0);
    let json = run.json();
    for point in json["points"].as_array().expect("points") {
        assert_eq!(point["illuminance_lx"], 0.0, "{json}");
    }
}

/// What a render's file tells, and what remains of it in half precision and tiles.
#[test]
fn openexr() {
    let folder = Folder::with_scene(ROOM);
    let image = folder.render("a", "--spp 2 --seed 5 --lpe direct=LDE");
    let json = folder.run("image info a.exr --json").expect(0).json();
    assert_eq!(json["size"], serde_json::json!([40, 24]));
    assert_eq!(json["parts"][0]["blocks"], "scan lines");
    let metadata = &json["metadata"];
    for key in [
        "software",
        "etendue.scene",
        "etendue.seed",
        "etendue.passes",
        "etendue.integrator",
        "etendue.unit",
        "worldToCamera",
        "worldToNDC",
        "whiteLuminance",
    ] {
        assert!(metadata[key].is_string(), "{key}: {json}");
    }
    assert_eq!(metadata["etendue.seed"], "5");
    let types: Vec<&str> =
        json["parts"][0]["types"].as_array().expect("types").iter().filter_map(|t| t.as_str()).collect();
    assert!(types.contains(&"direct.R: float") && types.contains(&"variance.Y: float"), "{types:?}");
    assert_eq!(
        folder.run("info a.exr --json").expect(0).stdout,
        folder.run("image info a.exr --json").expect(0).stdout
    );

    // Tiles keep every bit.
    let tiles = folder.render("tiles", "--spp 2 --seed 5 --lpe direct=LDE --tiles");
    assert_same(&image, &tiles);
    assert_eq!(image.metadata, tiles.metadata);
    folder.render("half", "--spp 2 --seed 5 --half");
    let json = folder.run("image info half.exr --json").expect(0).json();
    let types = json["parts"][0]["types"].to_string();
    assert!(types.contains("R: half") && types.contains("variance.Y: float"), "{types}");
    folder.run("image convert a.exr -o copy.exr --tiles").expect(0);
    assert_same(&image, &folder.image("copy.exr"));
    folder.run("image convert a.exr -o direct.pfm --layer direct").expect(0);
    assert_eq!(folder.image("direct.pfm").rgb_pixels(), image.layer_rgb("direct"));
    folder
        .run("image convert a.exr -o no.exr --layer dircet")
        .expect(2)
        .says("no layer dircet; there are direct, variance");
    folder.run("image convert a.exr -o a.exr").expect(2).says("named twice");
    write_image(folder.path("bright.exr"), &Image::rgb(1, 1, vec![[1e6, 1.0, 1.0]])).expect("written");
    folder.run("image convert bright.exr -o half.exr --half").expect(0).says("above 65504");
}

/// A part of a picture lies in the window of the whole.
#[test]
fn windows() {
    let folder = Folder::with_scene(ROOM);
    folder.render("part", "--spp 1 --crop 0.25,0.75,0.5,1");
    let json = folder.run("image info part.exr --json").expect(0).json();
    assert_eq!(json["parts"][0]["data_window"], serde_json::json!([10, 12, 20, 12]));
    assert_eq!(json["parts"][0]["display_window"], serde_json::json!([0, 0, 40, 24]));
    assert_eq!(json["size"], serde_json::json!([20, 12]));
}

/// The matrices take points of the world to where the picture shows them.
#[test]
fn camera_matrices() {
    for camera in [
        "Camera \"perspective\" \"float fov\" 50",
        "Camera \"orthographic\" \"float screenwindow\" [-3 2 -1 2]",
    ] {
        // A small bright ball on black: where is it?
        let scene = format!(
            "Film \"rgb\" \"integer xresolution\" 90 \"integer yresolution\" 60
            LookAt 1 2 -6  0.2 0.1 0.3  0 1 0
            {camera} WorldBegin
            AttributeBegin Translate 0.7 0.9 1.1 AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]
            Shape \"sphere\" \"float radius\" 0.08 AttributeEnd"
        );
        let folder = Folder::with_scene(&scene);
        let image = folder.render("a", "--spp 16");
        let pixels = image.rgb_pixels().expect("colour");
        let mut sum = [0.0f64; 3];
        for (i, pixel) in pixels.iter().enumerate() {
            let weight = f64::from(pixel[1]);
            let place = [(i % 90) as f64 + 0.5, (i / 90) as f64 + 0.5, 1.0];
            (0..3).for_each(|c| sum[c] += weight * place[c]);
        }
        let shown = [sum[0] / sum[2] / 45.0 - 1.0, 1.0 - sum[1] / sum[2] / 30.0];
        let matrix: Vec<f64> =
            image.metadata["worldToNDC"].split(' ').map(|n| n.parse().expect("a number")).collect();
        let point = [0.7, 0.9, 1.1, 1.0];
        let column = |c: usize| (0..4).map(|r| point[r] * matrix[4 * r + c]).sum::<f64>();
        for c in 0..2 {
            let expected = column(c) / column(3);
            // A third of a pixel; a ball in perspective is not quite round.
            assert!((shown[c] - expected).abs() < 0.011, "{camera}: {shown:?}, {c}: {expected}");
        }
        assert!((0.0..=1.1).contains(&(column(2) / column(3))) || camera.contains("ortho"));
    }
}

/// Pictures for displays beyond sRGB.
#[test]
fn displays() {
    let folder = Folder::new();
    write_image(folder.path("ramp.exr"), &ramp()).expect("written");
    let has_chunk = |name: &str, chunk: &[u8]| folder.read(name).windows(chunk.len()).any(|w| w == chunk);
    folder.run("tonemap ramp.exr -o p3.png --encoding p3 --operator reinhard").expect(0);
    assert!(has_chunk("p3.png", b"cICP\x0c\x0d\x00\x01"));
    folder.run("tonemap ramp.exr -o pq.png --encoding pq").expect(0);
    assert!(has_chunk("pq.png", b"cICP\x09\x10\x00\x01"));
    folder.run("tonemap ramp.exr -o srgb.png --operator reinhard").expect(0);
    assert!(!has_chunk("srgb.png", b"cICP"));
    // Grey is grey in both.
    let (p3, srgb) = (folder.image("p3.png"), folder.image("srgb.png"));
    for (a, b) in p3.rgb_pixels().expect("colour").iter().zip(srgb.rgb_pixels().expect("colour")) {
        assert!((0..3).all(|c| (a[c] - b[c]).abs() < 0.02), "{a:?} {b:?}");
    }
    folder.run("tonemap ramp.exr -o no.ppm --encoding p3").expect(2).says("only .png");
    folder
        .run("tonemap ramp.exr -o no.png --encoding pq --white-luminance 0")
        .expect(2)
        .says("at most 10000");
}

/// A preview stays out of pipes unless a protocol is named.
#[test]
fn previews() {
    let folder = Folder::with_scene(ROOM);
    let run = folder.run("render scene.pbrt -q --spp 1 -o a.exr --preview").expect(0);
    assert_eq!((run.stdout.as_str(), run.stderr.as_str()), ("", ""));
    folder.run("tonemap a.exr").expect(2).says("--output");
    let run = folder.run("tonemap a.exr --preview=blocks");
    assert_eq!(run.code, Some(0));
    // Forty letters in each of twelve lines.
    assert_eq!(run.stdout.lines().count(), 12);
    assert!(run.stdout.lines().all(|line| line.matches('▀').count() == 40), "{}", run.stdout);
    let run = folder.run("render scene.pbrt -q --spp 1 -o a.exr --preview=sixel");
    assert!(run.stdout.starts_with("\x1bP0;1;0q\"1;1;40;24") && run.code == Some(0));
    folder.run("render scene.pbrt -q -o a.exr --preview=ascii").expect(2).says("blocks");
}

/// Pictures that are broken get an error that names them, from every command that reads pictures.
#[test]
fn broken_pictures() {
    let folder = Folder::with_scene(ROOM);
    folder.render("good", "--spp 1");
    let good = folder.read("good.exr");
    folder.write("cut.exr", &good[..good.len() / 2]);
    let name = b"dataWindow\0box2i\0";
    let at = good.windows(name.len()).position(|w| w == name).expect("there") + name.len() + 4;
    let mut huge = good.clone();
    for (i, value) in [0i32, 0, 59_999, 59_999].into_iter().enumerate() {
        huge[at + 4 * i..at + 4 * i + 4].copy_from_slice(&value.to_le_bytes());
    }
    folder.write("huge.exr", &huge);
    folder.write("text.exr", "this is text");
    folder.write("empty.exr", "");
    let mut names = Image::new(2, 2);
    names.set_channel("depth.Z", vec![1.0; 4]);
    write_image(folder.path("depth.exr"), &names).expect("written");
    let before = folder.files();
    for bad in ["cut.exr", "huge.exr", "text.exr", "empty.exr", "none.exr", "."] {
        for command in [
            "image info BAD",
            "image convert BAD -o no.exr",
            "tonemap BAD -o no.png",
            "falsecolor BAD -o no.png",
            "compare BAD good.exr",
            "compare good.exr BAD",
        ] {
            folder.run(&command.replace("BAD", bad)).expect(2).says(bad);
        }
    }
    for command in ["tonemap depth.exr -o no.png", "falsecolor depth.exr -o no.png"] {
        folder.run(command).expect(2).says("no channels R, G, B or Y");
    }
    folder.run("compare depth.exr depth.exr").expect(2).says("channels R, G, B or Y");
    folder.run("image info depth.exr").expect(0);
    assert_eq!(folder.files(), before);
}

/// Whoever reads a picture believes the primaries that it states, and formats that state none have those of sRGB.
#[test]
fn primaries() {
    let folder = Folder::with_scene(&format!("ColorSpace \"rec2020\"\n{ROOM}"));
    folder.run("render scene.pbrt -q --spp 4 -o a.exr -o a.png -o a.pfm").expect(0);
    folder.run("tonemap a.exr -o b.png").expect(0);
    folder.run("image convert a.exr -o c.png -o c.pfm").expect(0);
    assert_eq!(folder.read("a.png"), folder.read("b.png"));
    assert_eq!(folder.read("a.png"), folder.read("c.png"));
    assert_eq!(folder.read("a.pfm"), folder.read("c.pfm"));
    let json = folder.run("compare a.exr a.pfm --json").expect(0).json();
    assert!(json["mse"].as_f64().is_some_and(|mse| mse < 1e-10), "{json}");
    // The colours themselves are others.
    let raw = |name: &str| folder.image(name).rgb_pixels().expect("colour");
    assert!(raw("a.exr") != raw("a.pfm"));

    let mut green = Image::rgb(1, 1, vec![[0.0, 1.0, 0.0]]);
    let rec2020 = "0.708 0.292 0.17 0.797 0.131 0.046 0.3127 0.329";
    green.metadata.insert("chromaticities".to_owned(), rec2020.to_owned());
    write_image(folder.path("green.exr"), &green).expect("written");
    let json = folder.run("falsecolor green.exr -o green.png --json").expect(0).json();
    assert!(json["mean"].as_f64().is_some_and(|mean| (mean - 0.678).abs() < 1e-3), "{json}");

    // Wider displays are shown what sRGB cannot, and read back as that.
    folder.run("tonemap a.exr -o p3.png --encoding p3").expect(0);
    folder.run("tonemap a.exr -o pq.png --encoding pq").expect(0);
    for name in ["p3.png", "pq.png"] {
        let json = folder.run(&format!("compare {name} a.exr --clamp 1 --json")).expect(0).json();
        assert!(json["mse"].as_f64().is_some_and(|mse| mse < 1e-4), "{name}: {json}");
    }
}

/// Layers that are no light have no candela, and no colour for formats that hold nothing else.
#[test]
fn layers_of_features() {
    let folder = Folder::with_scene(ROOM);
    folder.render("a", "--spp 2 --features");
    folder.run("image convert a.exr -o albedo.exr --layer Albedo").expect(0);
    let metadata = folder.image("albedo.exr").metadata;
    assert!(
        !metadata.contains_key("whiteLuminance") && !metadata.contains_key("etendue.unit"),
        "{metadata:?}"
    );
    folder.run("falsecolor albedo.exr -o f.png").expect(0).says("does not tell the unit");
    folder
        .run("image convert a.exr -o depth.exr -o depth.png --layer depth")
        .expect(2)
        .says("the channels of layer depth are no colour");
    assert!(!folder.path("depth.exr").exists());
}

/// Options that come to nothing are told.
#[test]
fn unused_options() {
    let folder = Folder::new();
    write_image(folder.path("a.exr"), &ramp()).expect("written");
    let says = |arguments: &str, text: &str| {
        folder.run(&format!("tonemap a.exr -o a.png {arguments}")).expect(0).says(text);
    };
    says("--key 0.3", "--key has no effect");
    says("--white 3", "--white has no effect");
    says("--white-luminance 100", "--white-luminance has no effect");
    folder.run("image convert a.exr -o a.png --half").expect(0).says("--half and --tiles have no effect");
    folder.run("tonemap a.exr -o a.png --operator reinhard:key=1,key=2").expect(2).says("given twice");
    folder.run("compare a.exr a.exr --scale-reference 0").expect(2).says("a positive number");
}
