//! Command lines that mean nothing, and outputs that cannot be written.

use crate::support::{Folder, scene};

fn folder() -> Folder {
    Folder::with_scene(&scene("", "Shape \"sphere\""))
}

/// Renders with bad arguments; each text must be said.
#[track_caller]
fn refuse(arguments: &[&str], says: &[&str]) {
    let folder = folder();
    let all = [&["render", "scene.pbrt"], arguments].concat();
    let mut run = folder.run_with(&all).expect(2);
    for text in says {
        run = run.says(text);
    }
    assert_eq!(run.stdout, "");
    assert_eq!(folder.files(), ["scene.pbrt"]);
}

/// Values out of range or without meaning are answered by what would be right.
#[test]
fn values() {
    refuse(&["--spp", "0"], &["'0'", "--spp"]);
    refuse(&["--spp", "-4"], &["--spp"]);
    refuse(&["--spp", "many"], &["'many'", "--spp"]);
    refuse(&["--resolution", "0x5"], &["'0x5'", "such as 640x480"]);
    refuse(&["--resolution", "640"], &["'640'", "such as 640x480"]);
    refuse(&["--resolution", "99999999x99999999"], &["cannot be rendered", "2^30 pixels"]);
    refuse(&["--passes", "8..4"], &["'8..4'", "such as 0..8"]);
    refuse(&["--passes", "4..4"], &["'4..4'", "such as 0..8"]);
    refuse(&["--passes", "0..4", "--spp", "4"], &["cannot be used with"]);
    refuse(&["--crop", "0.5,0.2,0,1"], &["0.5,0.2,0,1"]);
    refuse(&["--crop", "2,3,0,1"], &["a crop is x0,x1,y0,y1 between 0 and 1"]);
    refuse(&["--time", "soon"], &["such as 30s"]);
    refuse(&["--time", "0s"], &["--time"]);
    refuse(&["--time", "5parsecs"], &["'parsecs' is not a unit of time"]);
    refuse(&["--error", "0"], &["a positive number is needed"]);
    refuse(&["--threads", "0"], &["--threads"]);
    refuse(&["--wavelengths", "seven"], &["hero", "single"]);
    refuse(&["--every", "1s"], &["--checkpoint"]);
    refuse(&["--resume"], &["--checkpoint"]);
    refuse(&["--nonsense"], &["--nonsense"]);
}

/// Integrators and their parameters.
#[test]
fn integrators() {
    refuse(&["--integrator", "pth"], &["unknown integrator \"pth\"", "did you mean \"path\"?"]);
    refuse(&["--integrator", "path:nosuch=1"], &["path has no parameter nosuch", "maxdepth"]);
    refuse(&["--integrator", "path:maxdeth=1"], &["path has no parameter maxdeth; did you mean maxdepth?"]);
    refuse(&["--integrator", "path:maxdepth=few"], &["'few' is not a value of type integer for maxdepth"]);
    refuse(&["--integrator", "path:maxdepth"], &["'maxdepth' is not a parameter"]);
    refuse(&["--integrator", "path:maxdepth=-3"], &["maxdepth", "-3"]);
    refuse(&["--integrator", "path:lights=none"], &["unknown lights \"none\"", "both, lights, scattering"]);
}

/// Path expressions and the names of their layers.
#[test]
fn path_expressions() {
    refuse(&["--lpe", "LDE"], &["NAME=EXPRESSION"]);
    refuse(&["--lpe", "a=L(DE"], &["L(DE"]);
    refuse(&["--lpe", "a=LXE"], &["LXE", "X"]);
    refuse(&["--lpe", "a="], &["path expression ''"]);
    refuse(&["--lpe", "=LDE"], &["its name"]);
    refuse(&["--lpe", "a b=LDE"], &["its name must consist of letters"]);
    refuse(&["--lpe", "a=LDE", "--lpe", "a=LSE"], &["its name is used twice"]);
    refuse(&["--lpe", "bounce0=LDE", "--bounces", "1"], &["its name is used twice"]);
    refuse(&["--lpe", "variance=LDE"], &["variance", "its name"]);
    refuse(&["--lpe", "sums=LDE"], &["sums", "its name"]);
}

/// Outputs that cannot be are refused before anything is rendered.
#[test]
fn outputs() {
    refuse(&["-o", "a.gif"], &["a.gif", ".exr, .png, .ppm, .pfm, .hdr"]);
    refuse(&["-o", "a"], &["a: images are written as"]);
    refuse(&["-o", "a.exr", "-o", "none/b.exr"], &["none/b.exr: there is no folder none"]);
    for twice in [["-o", "b.exr", "-o", "./b.exr"], ["-o", "b.exr", "--checkpoint", "b.exr"]] {
        refuse(&twice, &["b.exr: this file is named twice"]);
    }
    refuse(&["--stats", "scene.pbrt"], &["scene.pbrt: this file is named twice"]);
    refuse(&["--stats", "none/stats.json"], &["none/stats.json: there is no folder none"]);
    refuse(&["--checkpoint", "none/a.checkpoint"], &["none/a.checkpoint: there is no folder none"]);
}

/// Outputs that the file system refuses end with code 1, also before anything is rendered.
#[test]
fn unwritable_outputs() {
    let folder = folder();
    std::fs::create_dir(folder.path("a.exr")).expect("made");
    for arguments in ["-o a.exr", "-o b.exr -o a.exr", "--stats a.exr", "--checkpoint a.exr"] {
        let run = folder.run(&format!("render scene.pbrt {arguments}")).expect(1);
        run.says("cannot write a.exr");
        assert_eq!(folder.files(), ["a.exr", "scene.pbrt"]);
    }
    // The scene's problems still come first.
    folder.run("render none.pbrt -o b.exr").expect(2).says("none.pbrt");
}

/// What cannot be written in the end is kept elsewhere, and the other outputs are written.
#[cfg(unix)]
#[test]
fn renders_are_not_lost() {
    use crate::support::signals::{end, send, wait_for};
    use std::os::unix::fs::symlink;

    let folder = folder();
    std::fs::create_dir(folder.path("there")).expect("made");
    std::fs::create_dir(folder.path("refuge")).expect("made");
    // A folder that vanishes during the render.
    let render = |outputs: &[&str]| {
        symlink("there", folder.path("link")).expect("linked");
        let arguments =
            ["render", "scene.pbrt", "-q", "--spp", "1000000", "--checkpoint", "state", "--every", "0s"];
        let mut command = folder.command(&[&arguments, outputs].concat());
        command.env("TMPDIR", folder.path("refuge")).stderr(std::process::Stdio::piped());
        let child = command.spawn().expect("the program starts");
        wait_for(&folder.path("state"));
        std::fs::remove_file(folder.path("link")).expect("removed");
        send(&child, "-INT");
        let ended = end(child);
        std::fs::remove_file(folder.path("state")).expect("removed");
        ended
    };

    let (code, text) = render(&["-o", "link/a.exr", "-o", "b.png"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("cannot write link/a.exr") && !text.contains("is kept"), "{text}");
    assert_eq!(folder.image("b.png").width, 8);

    let (code, text) = render(&["-o", "link/a.exr"]);
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("cannot write link/a.exr") && text.contains("the image is kept in"), "{text}");
    let kept: Vec<_> = std::fs::read_dir(folder.path("refuge")).expect("there").flatten().collect();
    assert_eq!(kept.len(), 1);
    assert_eq!(etendue::io::read_image(kept[0].path()).expect("an image").width, 8);
}

/// Help and version are answers, not errors.
#[test]
fn help() {
    let folder = Folder::new();
    let run = folder.run("--help").expect(0);
    for command in ["render", "info", "list", "compare", "merge", "tonemap"] {
        assert!(run.stdout.contains(command), "{}", run.stdout);
    }
    assert!(folder.run("--version").expect(0).stdout.starts_with("etendue "));
    for command in ["render", "info", "list", "compare", "merge", "tonemap"] {
        folder.run(&format!("{command} --help")).expect(0);
    }
    folder.run("").expect(2);
    folder.run("rendr a.pbrt").expect(2).says("'rendr'").says("render");
}
