//! Reproducibility: one seed gives one image, for any number of threads and any split of the passes.

use crate::support::{Folder, ROOM, assert_same, differing_channels, mean};

/// Pixels, also as bytes of a PNG, do not depend on the number of threads.
#[test]
fn threads() {
    let folder = Folder::with_scene(ROOM);
    let render = |threads: usize| {
        let name = format!("t{threads}");
        folder
            .run(&format!(
                "render scene.pbrt -q --threads {threads} -o {name}.exr -o {name}.png --lpe caustic=LS+DE"
            ))
            .expect(0);
        (folder.image(&format!("{name}.exr")), folder.read(&format!("{name}.png")))
    };
    let (one, one_png) = render(1);
    assert!(mean(&one) > 0.0);
    for threads in [2, 3] {
        let (image, png) = render(threads);
        assert_same(&one, &image);
        assert_eq!(one_png, png);
    }
}

/// All samplers are reproducible.
#[test]
fn samplers() {
    for sampler in ["independent", "halton", "sobol", "zsobol", "stratified"] {
        let text =
            ROOM.replace("Sampler \"zsobol\" \"integer pixelsamples\" 4", &format!("Sampler \"{sampler}\""));
        let folder = Folder::with_scene(&text);
        let a = folder.render("a", "--threads 1 --resolution 20x12");
        let b = folder.render("b", "--threads 2 --resolution 20x12");
        assert_same(&a, &b);
        assert_eq!(a.metadata["etendue.spp"], "16", "{sampler}");
        let c = folder.render("c", "--seed 1 --resolution 20x12");
        assert!(!differing_channels(&a, &c).is_empty(), "{sampler}");
    }
}

/// Parts add up to the whole, bit by bit, in any order and grouping.
#[test]
fn passes() {
    let folder = Folder::with_scene(ROOM);
    let layer = "--lpe direct=L.?E";
    let whole = folder.render("whole", &format!("--passes 0..16 {layer}"));
    folder.render("a", &format!("--passes 0..8 {layer}"));
    folder.render("b", &format!("--passes 8..11 {layer} --threads 1"));
    folder.render("c", &format!("--passes 11..16 {layer} --threads 3"));
    folder.run("merge a.exr b.exr c.exr -o abc.exr").expect(0);
    folder.run("merge c.exr a.exr b.exr -o cab.exr -o cab.png").expect(0);
    folder.run("merge b.exr c.exr -o bc.exr").expect(0);
    folder.run("merge a.exr bc.exr -o a_bc.exr").expect(0);
    for name in ["abc.exr", "cab.exr", "a_bc.exr"] {
        let image = folder.image(name);
        assert_same(&whole, &image);
        assert_eq!(image.metadata, whole.metadata, "{name}");
    }
    // A plain render shows the same, without the sums.
    let plain = folder.render("plain", &format!("--spp 16 {layer}"));
    let extra = differing_channels(&whole, &plain);
    assert!(extra.iter().all(|name| name.starts_with("sums.")), "{extra:?}");
    assert_eq!(folder.image("cab.png").width, 40);
}

/// Parts of a part of the film.
#[test]
fn passes_of_a_crop() {
    let folder = Folder::with_scene(ROOM);
    let crop = "--crop 0.2,0.7,0.1,0.9";
    let whole = folder.render("whole", &format!("--passes 0..4 {crop}"));
    folder.render("a", &format!("--passes 0..2 {crop}"));
    folder.render("b", &format!("--passes 2..4 {crop}"));
    folder.run("merge a.exr b.exr -o ab.exr").expect(0);
    assert_same(&whole, &folder.image("ab.exr"));
    folder.render("other", "--passes 2..4");
    folder
        .run("merge a.exr other.exr -o no.exr")
        .expect(2)
        .says("not of the same scene, film and integrator");
    assert!(!folder.path("no.exr").exists());
}

/// Renders of different seeds are averaged, with sums or without.
#[test]
fn independent_renders() {
    let folder = Folder::with_scene(ROOM);
    for (extra, n) in [("--spp", ["4", "12"]), ("--passes", ["0..4", "0..12"])] {
        let a = folder.render("a", &format!("{extra} {} --seed 1", n[0]));
        let b = folder.render("b", &format!("{extra} {} --seed 2", n[1]));
        folder.run("merge a.exr b.exr -o ab.exr").expect(0);
        let ab = folder.image("ab.exr");
        assert_eq!(ab.metadata["etendue.spp"], "16");
        assert_eq!(ab.metadata["etendue.seed"], "1+2");
        for channel in ["R", "G", "B"] {
            let values =
                |image: &etendue::image::Image| image.channel(channel).expect("colour").values.clone();
            for ((a, b), ab) in values(&a).iter().zip(values(&b)).zip(values(&ab)) {
                let mean = 0.25 * a + 0.75 * b;
                assert!((ab - mean).abs() <= 1e-5 * mean.max(1e-3), "{ab} {mean}");
            }
        }
    }
}

/// What does not belong together is refused with the reason, and nothing is written.
#[test]
fn refused_merges() {
    let folder = Folder::with_scene(ROOM);
    folder.render("a", "--passes 0..4");
    folder.render("overlap", "--passes 3..6");
    folder.render("depth", "--passes 4..8 --integrator path:maxdepth=2");
    folder.render("size", "--passes 4..8 --resolution 20x12");
    folder.render("layer", "--passes 4..8 --lpe direct=L.?E");
    folder.render("plain", "--spp 4");
    folder.render("same", "--spp 4");
    folder.write("other.pbrt", ROOM.replace("0.7 0.4 0.2", "0.7 0.4 0.3"));
    folder.run("render other.pbrt -q --passes 4..8 -o scene.exr").expect(0);
    folder.run("render scene.pbrt -q --spp 1 -o flat.png -o flat.pfm").expect(0);
    let before = folder.files();
    for (images, says) in [
        ("a.exr overlap.exr", "overlap.exr"),
        ("a.exr a.exr", "a.exr"),
        ("a.exr depth.exr", "a.exr and depth.exr are not of the same scene, film and integrator"),
        ("a.exr size.exr", "not of the same scene, film and integrator"),
        ("a.exr layer.exr", "not of the same scene, film and integrator"),
        ("a.exr scene.exr", "not of the same scene, film and integrator"),
        ("plain.exr same.exr", "seed 0 is in the sum already"),
        ("a.exr plain.exr", "seed 0 is in the sum already"),
        ("a.exr flat.png", "flat.png: it does not say which scene and passes it holds"),
        ("a.exr flat.pfm", "flat.pfm: it does not say which scene and passes it holds"),
        ("a.exr none.exr", "none.exr"),
        ("a.exr other.pbrt", "other.pbrt"),
    ] {
        folder.run(&format!("merge {images} -o merged.exr")).expect(2).says(says);
        assert_eq!(folder.files(), before, "{images}");
    }
    folder.run("merge a.exr overlap.exr -o merged.exr").expect(2).says("3..4");
    folder.run("merge a.exr -o merged.exr").expect(2).says("2");
    folder.run("merge a.exr overlap.exr").expect(2).says("--output");
    folder.run("merge a.exr overlap.exr -o merged.gif").expect(2).says(".exr, .png");
}
