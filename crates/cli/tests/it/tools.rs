//! `compare`, `tonemap`, `hdr`, `fuse`, `study` and `bench`.

use etendue::image::Image;
use etendue::io::images::write_image;

use crate::support::{Folder, ROOM, assert_same};

/// A folder with two images of 8 x 4 pixels, `b` twice as bright as `a`.
fn images() -> Folder {
    let folder = Folder::new();
    let pixels: Vec<[f32; 3]> = (0..32).map(|i| [0.1 + i as f32 / 64.0, 0.2, 0.3]).collect();
    write_image(folder.path("a.exr"), &Image::rgb(8, 4, pixels.clone())).expect("written");
    let twice = pixels.iter().map(|p| p.map(|v| 2.0 * v)).collect();
    write_image(folder.path("b.exr"), &Image::rgb(8, 4, twice)).expect("written");
    write_image(folder.path("small.exr"), &Image::rgb(4, 4, vec![[0.5; 3]; 16])).expect("written");
    folder
}

/// An image does not differ from itself.
#[test]
fn equal_images() {
    let folder = images();
    let run = folder.run("compare a.exr a.exr --json").expect(0);
    assert_eq!(run.stderr, "");
    let json = run.json();
    for key in ["mse", "rmse", "relmse", "mape", "smape", "flip"] {
        assert_eq!(json[key], 0.0, "{key}");
    }
    assert_eq!(json["mean_ratio"], 1.0);
    assert_eq!(json["pixels"], 32);
    // Infinite, which JSON cannot say.
    assert!(json["psnr"].is_null());
    let text = folder.run("compare a.exr a.exr").expect(0).stdout;
    assert!(text.lines().any(|line| line.split_whitespace().eq(["mse", "0.000000"])), "{text}");
}

/// Known differences have known measures.
#[test]
fn different_images() {
    let folder = images();
    let json = folder.run("compare b.exr a.exr --json").expect(0).json();
    let number = |key: &str| json[key].as_f64().expect("a number");
    assert!((number("mean_ratio") - 2.0).abs() < 1e-5, "{json}");
    assert!((number("rmse").powi(2) - number("mse")).abs() < 1e-6, "{json}");
    assert!(number("flip") > 0.0 && number("psnr").is_finite(), "{json}");
    let json = folder.run("compare b.exr a.exr --json --scale-reference 2").expect(0).json();
    assert_eq!(json["mse"], 0.0);
}

/// Pictures of the difference, of all kinds.
#[test]
fn difference_maps() {
    let folder = images();
    for kind in ["flip", "absolute", "relative"] {
        folder.run(&format!("compare b.exr a.exr -o {kind}.png --map {kind}")).expect(0);
        assert_eq!(folder.image(&format!("{kind}.png")).width, 8);
    }
}

/// What cannot be compared.
#[test]
fn refused_comparisons() {
    let folder = images();
    folder.write("text.exr", "this is text");
    let before = folder.files();
    folder
        .run("compare a.exr small.exr -o map.png")
        .expect(2)
        .says("a.exr and small.exr")
        .says("8 x 4 against 4 x 4");
    folder.run("compare a.exr none.exr").expect(2).says("none.exr");
    folder.run("compare none.exr a.exr --json").expect(2).says("none.exr");
    folder
        .run("compare a.exr text.exr")
        .expect(2)
        .says("text.exr")
        .says("the contents are not those of a `exr` file");
    folder.run("compare a.exr b.exr -o map.gif").expect(2).says("map.gif");
    folder.run("compare a.exr b.exr -o none/map.png").expect(2).says("there is no folder none");
    folder.run("compare a.exr .").expect(2).says("folder");
    folder.run("compare a.exr").expect(2);
    assert_eq!(folder.files(), before);
}

/// All operators write all formats, in the range of a display.
#[test]
fn tonemapping() {
    let folder = Folder::with_scene(ROOM);
    let radiance = folder.render("a", "--spp 8");
    let operators = "clamp maximum exponential logarithmic reinhard reinhard-local bilateral gradient histogram filmic aces agx";
    for operator in operators.split(' ') {
        folder
            .run(&format!("tonemap a.exr -o {operator}.png -o {operator}.exr --operator {operator}"))
            .expect(0);
        let mapped = folder.image(&format!("{operator}.exr")).rgb_pixels().expect("colour");
        assert!(mapped.iter().flatten().all(|v| v.is_finite() && *v >= 0.0), "{operator}");
        assert_eq!(folder.image(&format!("{operator}.png")).width, radiance.width);
        assert!(mapped.iter().flatten().any(|v| *v > 0.05), "{operator}");
    }
    folder.run("tonemap a.exr -o dark.exr --exposure -3").expect(0);
    folder.run("tonemap a.exr -o plain.exr").expect(0);
    let sum = |name: &str| -> f64 {
        folder.image(name).rgb_pixels().expect("colour").iter().flatten().map(|v| f64::from(*v)).sum()
    };
    assert!(sum("dark.exr") < 0.5 * sum("plain.exr"));
    folder.run("tonemap a.exr -o dithered.png --dither").expect(0);
    folder.run("tonemap a.exr -o key.exr --operator reinhard --key 0.3 --white 2").expect(0);
    folder.run("tonemap a.exr -o colon.exr --operator reinhard:key=0.3,white=2").expect(0);
    assert_eq!(folder.image("key.exr").rgb_pixels(), folder.image("colon.exr").rgb_pixels());
    folder.run("tonemap a.exr -o auto.exr --exposure auto").expect(0);
    assert!(sum("auto.exr") > 0.0 && sum("auto.exr") != sum("plain.exr"));
    for (wrong, says) in [
        ("--operator rheinhard", "there are clamp"),
        ("--operator reinhard:kye=1", "has no parameter 'kye'"),
        ("--operator bilateral:space=-1", "must be above 0"),
        ("--operator agx:x", "key=value"),
        ("--exposure bright", "stops"),
        ("--white-balance 12", "kelvin"),
        ("--white-balance 0.9,0.9", "chromaticity"),
    ] {
        folder.run(&format!("tonemap a.exr -o no.png {wrong}")).expect(2).says(says);
    }
    assert!(!folder.files().iter().any(|file| file.contains("no.png")));
}

/// Light of a colour temperature becomes grey where that is taken for white, and stays as it is where that is the display's.
#[test]
fn white_is_balanced() {
    let folder = Folder::with_scene(ROOM);
    folder.render("a", "--spp 1");
    let ratios = |options: &str| {
        folder.run(&format!("tonemap a.exr -o b.exr {options}")).expect(0);
        let pixels = folder.image("b.exr").rgb_pixels().expect("colour");
        let sums = pixels
            .iter()
            .fold([0.0_f64; 3], |sums, rgb| std::array::from_fn(|i| sums[i] + f64::from(rgb[i])));
        [sums[0] / sums[1], sums[2] / sums[1]]
    };
    let plain = ratios("--operator maximum");
    let same = ratios("--operator maximum --white-balance 6504");
    assert!(
        (same[0] / plain[0] - 1.0).abs() < 0.01 && (same[1] / plain[1] - 1.0).abs() < 0.01,
        "{plain:?} {same:?}"
    );
    let warm = ratios("--operator maximum --white-balance 3000");
    assert!(warm[0] < plain[0] && warm[1] > plain[1], "{plain:?} {warm:?}");
}

/// SPEC SPD-3: inks leave the colour of the picture.
#[test]
fn inks_of_a_picture() {
    let folder = Folder::with_scene(ROOM);
    folder.render("a", "--spp 4");
    folder.run("tonemap a.exr -o inks.exr --cmyk").expect(0);
    folder.run("tonemap a.exr -o plain.exr").expect(0);
    folder.run("tonemap a.exr -o inks.png --cmyk").expect(2).says("inks are written as .exr");
    let inks = folder.image("inks.exr");
    let [c, m, y, k] = ["C", "M", "Y", "K"].map(|name| &inks.channel(name).expect("an ink").values);
    for (i, rgb) in folder.image("plain.exr").rgb_pixels().expect("colour").iter().enumerate() {
        for (ink, linear) in [c[i], m[i], y[i]].into_iter().zip(*rgb) {
            let left = (1.0 - ink) * (1.0 - k[i]);
            assert!((left - etendue::image::srgb_encode(linear.min(1.0))).abs() < 2e-3);
        }
    }
}

/// What cannot be shown.
#[test]
fn refused_tonemapping() {
    let folder = images();
    folder.write("text.png", "this is text");
    folder.write("text", "this is text");
    let mut depth = Image::new(2, 2);
    depth.set_channel("depth.Z", vec![1.0; 4]);
    write_image(folder.path("depth.exr"), &depth).expect("written");
    let before = folder.files();
    folder.run("tonemap text.png -o out.png").expect(2).says("text.png");
    folder.run("tonemap text -o out.png").expect(2).says("text: no known picture format");
    folder.run("tonemap none.exr -o out.png").expect(2).says("none.exr");
    folder.run("tonemap . -o out.png").expect(2).says("folder");
    folder
        .run("tonemap depth.exr -o out.png")
        .expect(2)
        .says("depth.exr: there are no channels R, G, B or Y");
    folder.run("tonemap a.exr -o out.gif").expect(2).says("out.gif");
    folder.run("tonemap a.exr -o none/out.png").expect(2).says("there is no folder none");
    folder.run("tonemap a.exr").expect(2).says("--output");
    folder.run("tonemap a.exr -o out.png --operator sepia").expect(2).says("reinhard");
    folder
        .run("tonemap a.exr -o out.png --operator reinhard --key 0")
        .expect(2)
        .says("a positive number is needed");
    assert_eq!(folder.files(), before);
}

/// A study writes its table and its figure into a folder, the same for the same seed.
#[test]
fn studies() {
    let folder = Folder::new();
    for out in ["a", "b/deep"] {
        let run = folder.run(&format!("study pixel --quick --out {out}")).expect(0);
        assert_eq!(run.stdout, "");
    }
    assert_eq!(folder.read("a/pixel.csv"), folder.read("b/deep/pixel.csv"));
    let svg = String::from_utf8(folder.read("a/pixel.svg")).expect("text");
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    folder.run("study scene-size --quick").expect(0).says("terrain, bounce rays");
    let csv = String::from_utf8(folder.read("scene-size.csv")).expect("text");
    let positive =
        |row: &str| row.rsplit(',').next().is_some_and(|s| s.parse::<f64>().is_ok_and(|s| s > 0.0));
    assert!(csv.lines().skip(1).all(positive), "the clock of the thread runs: {csv}");
    folder.write("file", "");
    folder.run("study pixel --quick --out file").expect(1).says("cannot make the folder file");
    folder.run("study everything").expect(2).says("convergence");
}

/// The speed of the machine, for programs and for people: every figure is positive.
#[test]
fn bench() {
    let folder = Folder::new();
    let json = folder.run("bench --quick --threads 2 --json").expect(0).json();
    assert_eq!(json["threads"], 2);
    assert!(json["avx2"].is_boolean());
    let figures = json["figures"].as_object().expect("figures");
    for key in
        ["primary_rays", "random_rays", "bounce_rays", "shadow_rays", "triangles_built", "paths", "look_ups"]
    {
        assert!(figures.contains_key(&format!("{key}_per_s")), "{key}");
    }
    for (name, figure) in figures {
        for threads in ["one_thread", "all_threads"] {
            assert!(figure[threads].as_f64().is_some_and(|rate| rate > 0.0), "{name}: {figure}");
        }
    }
    let text = folder.run("bench --quick --threads 2").expect(0).stdout;
    assert!(text.starts_with("2 threads"), "{text}");
    // A line of the machine, a head, and the figures.
    assert_eq!(text.lines().count(), 2 + figures.len(), "{text}");
    assert!(folder.files().is_empty());
}

/// A photon map is written as a file, the same for any number of threads, and told about; broken ones are errors.
#[test]
fn photon_maps() {
    let folder = Folder::with_scene(ROOM);
    for (threads, out) in [("1", "a.photons"), ("2", "b.photons")] {
        let arguments = ["photons", "scene.pbrt", "--photons", "9000", "-o", out];
        let status = folder.command(&arguments).env("RAYON_NUM_THREADS", threads).status();
        assert!(status.expect("it starts").success());
    }
    let bytes = folder.read("a.photons");
    assert!(bytes == folder.read("b.photons"));
    let facts = folder.run("info a.photons --json").expect(0).json();
    assert_eq!(facts["photons"]["emitted"], 9000);
    assert!(facts["photons"]["stored"].as_u64().is_some_and(|n| n > 1000), "{facts}");
    folder.run("info a.photons").expect(0);
    let broken: [(&str, &[u8], &str); 3] = [
        ("short.photons", &bytes[..bytes.len() / 2], "cut short"),
        ("empty.photons", b"", "not a photon map"),
        ("other.photons", b"ETPHOTON\x09\0\0\0", "version 9"),
    ];
    for (name, bytes, says) in broken {
        folder.write(name, bytes);
        folder.run(&format!("info {name}")).expect(2).says(says);
    }
    folder.run("info missing.photons").expect(2).says("missing.photons");
}

/// A photon map that was written for `photonmap` gives the same picture, from a scene file as from the command line;
/// what is no such map is an error that says what to do.
#[test]
fn photon_maps_are_read() {
    let folder = Folder::with_scene(ROOM);
    let few = "globalphotons=3000,causticphotons=3000";
    for map in ["global", "caustic"] {
        let arguments =
            format!("photons scene.pbrt --map {map} --integrator photonmap:{few} -o {map}.photons");
        folder.run(&arguments).expect(0).says("stored");
        let facts = folder.run(&format!("info {map}.photons --json")).expect(0).json();
        assert_eq!(facts["map"]["content"], map);
    }
    let traced = folder.render("traced", &format!("--integrator photonmap:{few}"));
    let files = "globalmap=global.photons,causticmap=caustic.photons";
    let read = folder.render("read", &format!("--integrator photonmap:{files}"));
    assert_same(&traced, &read);
    let named = ROOM
        .replace("\"path\" \"integer maxdepth\" 4", "\"photonmap\" \"string globalmap\" \"global.photons\"");
    assert!(named != ROOM);
    folder.write("named.pbrt", named);
    folder.run("render named.pbrt --spp 1 -o named.png").expect(0);
    for (file, says) in [
        ("caustic.photons", "a global map is needed"),
        ("none.photons", "none.photons"),
        ("scene.pbrt", "--map global"),
    ] {
        folder
            .run(&format!("render scene.pbrt --integrator photonmap:globalmap={file} -o x.png"))
            .expect(2)
            .says(says);
    }
    folder.run("photons scene.pbrt --map global -o x.png").expect(2).says(".photons");
    folder.run("photons scene.pbrt --map global --photons 9 -o x.photons").expect(2);
}

/// A rendered picture, photographed by several exposures, comes back; and its exposures blend.
#[test]
fn exposures_are_combined() {
    let folder = Folder::with_scene(ROOM);
    folder.render("a", "--spp 16");
    for (name, stops) in [("short", "-4"), ("middle", "-1"), ("long", "2")] {
        folder.run(&format!("tonemap a.exr -o {name}.png --exposure {stops}")).expect(0);
    }
    folder.run("hdr short.png middle.png long.png -o hdr.exr --times 1/16,1/2,4 --response srgb").expect(0);
    let pixels = |name: &str| folder.image(name).rgb_pixels().expect("colour");
    for (found, there) in pixels("hdr.exr").iter().zip(pixels("a.exr")) {
        // Below white of the shortest and above a few levels of the longest exposure.
        if there.iter().all(|v| (0.01..15.0).contains(v)) {
            assert!((found[1] / there[1] - 1.0).abs() < 0.05, "{found:?} {there:?}");
        }
    }
    folder.run("hdr short.png middle.png long.png -o recovered.exr --times 0.0625,0.5,4").expect(0);
    folder.run("fuse short.png middle.png long.png -o fused.png").expect(0);
    assert_eq!(folder.image("fused.png").width, folder.image("a.exr").width);
    for (wrong, says) in [
        ("hdr short.png long.png -o x.exr", "--times"),
        ("hdr short.png long.png -o x.exr --times 1", "1 times for 2 pictures"),
        ("hdr short.png long.png -o x.exr --times 1,-1", "time in seconds"),
        ("hdr short.png -o x.exr --times 1", "at least two"),
        ("hdr short.png long.png -o x.exr --times 1,1", "same time"),
        ("hdr short.png none.png -o x.exr --times 1,2", "none.png"),
        ("fuse short.png -o x.png", "at least two"),
        ("fuse short.png long.png -o x.png --contrast -1", "from 0 to 16"),
    ] {
        folder.run(wrong).expect(2).says(says);
    }
}

/// A JPEG file with exposure time, f-number and ISO in Exif data behind its first marker.
fn with_exif(jpeg: &[u8], time: [u32; 2], f_number: [u32; 2], iso: u16) -> Vec<u8> {
    let [short, long, rational] = [3_u16, 4, 5];
    let entry = |tag: u16, kind: u16, value: u32| {
        [&tag.to_le_bytes()[..], &kind.to_le_bytes(), &1_u32.to_le_bytes(), &value.to_le_bytes()].concat()
    };
    // A directory that points to that of Exif at 26, of three entries; the fractions are behind it, from 68 on.
    let mut exif = b"Exif\0\0II*\0\x08\0\0\0\x01\0".to_vec();
    exif.extend(entry(0x8769, long, 26));
    exif.extend([0; 4]);
    exif.extend(3_u16.to_le_bytes());
    exif.extend(entry(0x829a, rational, 68));
    exif.extend(entry(0x829d, rational, 76));
    exif.extend(entry(0x8827, short, iso.into()));
    exif.extend([0; 4]);
    exif.extend([time, f_number].concat().iter().flat_map(|number| number.to_le_bytes()));
    let length = u16::try_from(exif.len() + 2).expect("a short segment").to_be_bytes();
    [&jpeg[..2], &[0xff, 0xe1], &length, &exif, &jpeg[2..]].concat()
}

/// Exposures of photographs come from their time, f-number and ISO.
#[test]
fn exposures_of_photographs_are_read() {
    let folder = Folder::new();
    let jpeg = include_bytes!("../../../../docs/images/gallery/ring.jpg");
    folder.write("plain.jpg", jpeg);
    folder.write("short.jpg", with_exif(jpeg, [1, 30], [8, 1], 100));
    folder.write("long.jpg", with_exif(jpeg, [1, 4], [28, 10], 400));
    folder.run("hdr plain.jpg long.jpg -o x.exr").expect(2).says("plain.jpg: its Exif data");
    folder.run("hdr short.jpg long.jpg -o read.exr --response srgb").expect(0);
    let [short, long] = [1.0 / 30.0 / 64.0, 0.25 * 4.0 / 7.84];
    folder
        .run(&format!("hdr plain.jpg plain.jpg -o typed.exr --response srgb --times {short},{long}"))
        .expect(0);
    let pixels = |name: &str| folder.image(name).rgb_pixels().expect("colour");
    let (read, typed) = (pixels("read.exr"), pixels("typed.exr"));
    assert!(read.iter().flatten().any(|value| *value > 0.0));
    for (a, b) in read.iter().flatten().zip(typed.iter().flatten()) {
        assert!((a - b).abs() <= 1e-4 * b.abs(), "{a} read, {b} typed");
    }
}
