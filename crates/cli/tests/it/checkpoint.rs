//! Interrupted renders: killed, stopped by Ctrl-C, and taken up again.

use std::time::Instant;

use etendue::math::{Rng, hash64};

use crate::support::{Folder, ROOM, assert_same, is_slow};

/// A render of the room in `n` passes that keeps its state after each.
fn arguments(n: u32) -> String {
    format!("render scene.pbrt -q -o out.exr --spp {n} --threads 2 --checkpoint state --every 0s --resume")
}

/// A render that is killed at random moments and taken up again ends with the bits of one that was left in peace.
#[test]
fn killed_renders() {
    const PASSES: u32 = 48;
    let folder = Folder::with_scene(ROOM);
    let begun = Instant::now();
    let whole = folder.render("whole", &format!("--spp {PASSES} --threads 2 --checkpoint other --every 0s"));
    let mut time = begun.elapsed();
    let wanted = if is_slow() { 20 } else { 3 };
    let mut rng = Rng::new(hash64(&[u64::from(PASSES)]), 0);
    let mut n_killed = 0;
    for _ in 0..10 * wanted {
        // Each life is a random share of what the whole takes; there is less to do in each.
        let mut child = folder.start(&arguments(PASSES));
        std::thread::sleep(time.mul_f64(0.6 * f64::from(rng.next_f32())));
        if child.try_wait().expect("it can be asked").is_none() {
            child.kill().expect("it can be killed");
            n_killed += 1;
        } else {
            // It came to its end: begin anew, with shorter lives where the machine has become quicker.
            assert_same(&whole, &folder.image("out.exr"));
            std::fs::remove_file(folder.path("state")).expect("removed");
            time = time.mul_f64(0.8);
        }
        child.wait().expect("it ends");
        if n_killed == wanted {
            break;
        }
    }
    assert_eq!(n_killed, wanted, "renders come to their end before they can be killed");
    folder.run(&arguments(PASSES)).expect(0);
    assert_same(&whole, &folder.image("out.exr"));
    assert_eq!(folder.image("out.exr").metadata, whole.metadata);
}

/// A finished render can be continued: more passes, the same bits as if they had been asked for at once.
#[test]
fn continued_renders() {
    let folder = Folder::with_scene(ROOM);
    let whole = folder.render("whole", "--spp 12 --lpe direct=L.?E");
    folder.render("out", "--spp 5 --lpe direct=L.?E --checkpoint state");
    folder.run("render scene.pbrt -o out.exr --spp 12 --lpe direct=L.?E --checkpoint state --resume --stats s.json")
        .expect(0);
    assert_same(&whole, &folder.image("out.exr"));
    let stats: serde_json::Value = serde_json::from_slice(&folder.read("s.json")).expect("JSON");
    assert_eq!(stats["spp"], 12);
    assert_eq!(stats["samples"], 7 * 40 * 24);
    // With nothing left to do, the image is written from the state.
    std::fs::remove_file(folder.path("out.exr")).expect("removed");
    let again = folder.render("out", "--spp 12 --lpe direct=L.?E --checkpoint state --resume");
    assert_same(&whole, &again);
}

/// Progressive photon mapping goes on with the radii that it had, those of the schedule and those of each pixel.
#[test]
fn continued_photons() {
    for update in ["schedule", "perpixel"] {
        let folder = Folder::with_scene(ROOM);
        let method = format!("--integrator sppm:photonsperiteration=2000,radiusupdate={update}");
        let whole = folder.render("whole", &format!("{method} --spp 5 --threads 1"));
        folder.render("out", &format!("{method} --spp 2 --checkpoint state"));
        let continued =
            folder.render("out", &format!("{method} --spp 5 --threads 2 --checkpoint state --resume"));
        assert_same(&whole, &continued);
    }
}

/// Without `--resume` a checkpoint is begun anew.
#[test]
fn checkpoints_without_resume() {
    let folder = Folder::with_scene(ROOM);
    folder.render("a", "--spp 4 --checkpoint state");
    let b = folder.render("b", "--spp 2 --checkpoint state");
    assert_eq!(b.metadata["etendue.passes"], "0..2");
    let c = folder.render("c", "--spp 1 --checkpoint state --resume");
    assert_eq!(c.metadata["etendue.passes"], "0..2");
}

/// Nothing to resume from is no failure: the first start and all others can be the same command.
#[test]
fn first_start() {
    let folder = Folder::with_scene(ROOM);
    folder
        .run("render scene.pbrt -o a.exr --spp 1 --checkpoint state --resume")
        .expect(0)
        .says("state does not exist yet; starting from the beginning");
    assert!(folder.path("state").is_file());
}

/// The state of another render is refused, and stays as it is.
#[test]
fn foreign_checkpoints() {
    let folder = Folder::with_scene(ROOM);
    folder.render("a", "--spp 2 --checkpoint state");
    let state = folder.read("state");
    folder.write("other.pbrt", ROOM.replace("0.7 0.4 0.2", "0.7 0.4 0.3"));
    let another = "it belongs to another scene, resolution, integrator or set of layers";
    for (arguments, says) in [
        ("other.pbrt", another),
        ("scene.pbrt --resolution 20x12", another),
        ("scene.pbrt --crop 0,0.5,0,1", another),
        ("scene.pbrt --integrator path:maxdepth=2", another),
        ("scene.pbrt --lpe direct=LDE", another),
        ("scene.pbrt --wavelengths single", another),
        ("scene.pbrt --seed 3", "it was rendered with seed 0, not 3"),
    ] {
        folder
            .run(&format!("render {arguments} -o b.exr --spp 4 --checkpoint state --resume"))
            .expect(2)
            .says("cannot resume from state")
            .says(says);
        assert!(!folder.path("b.exr").exists());
        assert!(folder.read("state") == state);
    }
}

/// Damaged states are told from whole ones.
#[test]
fn damaged_checkpoints() {
    let folder = Folder::with_scene(ROOM);
    folder.render("a", "--spp 2 --checkpoint state");
    let good = folder.read("state");
    let mut flipped = good.clone();
    flipped[good.len() / 2] ^= 4;
    for (bytes, says) in [
        (&flipped[..], "damaged"),
        (&good[..good.len() / 2], "damaged"),
        (&good[..10], "damaged"),
        (b"", "not a checkpoint"),
        (b"text", "not a checkpoint"),
    ] {
        folder.write("state", bytes);
        folder
            .run("render scene.pbrt -o b.exr --spp 4 --checkpoint state --resume")
            .expect(2)
            .says("cannot resume from state")
            .says(says);
        assert!(!folder.path("b.exr").exists());
        assert_eq!(folder.read("state"), bytes);
    }
}

/// Passes that depend on those before are not rendered alone.
#[test]
fn dependent_passes_are_not_split() {
    let folder = Folder::with_scene(ROOM);
    let method = "--integrator ppm:radiusupdate=perpixel --resolution 8x8";
    folder
        .run(&format!("render scene.pbrt {method} --passes 2..4 -o b.exr"))
        .expect(2)
        .says("each pass of this method depends on those before");
    folder.run(&format!("render scene.pbrt {method} --passes 0..2 --checkpoint c -o a.exr")).expect(0);
    folder
        .run(&format!("render scene.pbrt {method} --passes 2..4 --checkpoint c --resume -o b.exr"))
        .expect(0);
}

#[cfg(unix)]
mod signals {
    use super::*;
    use crate::support::signals::{end, send, wait_for};

    /// Ctrl-C ends the render, writes what is finished, says so by the exit code, and the render can go on later.
    #[test]
    fn interrupted_renders() {
        for signal in ["-INT", "-TERM"] {
            let folder = Folder::with_scene(ROOM);
            let child = folder.start(&arguments(1_000_000));
            wait_for(&folder.path("state"));
            send(&child, signal);
            let (code, text) = end(child);
            assert_eq!(code, Some(130), "{text}");
            assert!(text.contains("interrupted; what was finished is written"), "{text}");
            let image = folder.image("out.exr");
            let n: u64 = image.metadata["etendue.spp"].parse().expect("a number");
            assert!((1..1_000_000).contains(&n), "{n}");
            let whole = folder.render("whole", &format!("--spp {n}"));
            assert_same(&whole, &image);

            let more = n + 3;
            let whole = folder.render("whole", &format!("--spp {more}"));
            let resumed = folder.render("out", &format!("--spp {more} --checkpoint state --resume"));
            assert_same(&whole, &resumed);
        }
    }

    /// A first pass that is cut short leaves a part of a picture, but no state that would count it twice.
    #[cfg(target_os = "linux")]
    #[test]
    fn interrupted_first_pass() {
        use crate::support::scene;
        use crate::support::signals::wait_for_handler;

        // A room of white walls, large enough for seconds in one pass.
        let world =
            "Material \"diffuse\" \"rgb reflectance\" [ 0.9 0.9 0.9 ]\nShape \"sphere\" \"float radius\" 5";
        let text = scene("Integrator \"path\" \"integer maxdepth\" 60 \"integer roulettedepth\" 60", world);
        let folder = Folder::with_scene(&text);
        let child = folder.start(&(arguments(4) + " --resolution 600x400"));
        wait_for_handler(&child);
        send(&child, "-INT");
        let (code, text) = end(child);
        assert_eq!(code, Some(130), "{text}");
        let image = folder.image("out.exr");
        assert_eq!(image.metadata["etendue.spp"], "0", "the first pass was too quick for this test");
        assert!(!folder.path("state").exists());
        // Nor can its sums be merged.
        folder.run("merge out.exr out.exr -o merged.exr").expect(2).says("it holds no complete pass");
    }

    /// Where nothing is finished, as while photons are traced, an older picture stays.
    #[cfg(target_os = "linux")]
    #[test]
    fn interrupted_before_the_first_sample() {
        use crate::support::signals::wait_for_handler;

        let folder = Folder::with_scene(ROOM);
        std::fs::write(folder.path("out.exr"), "an older picture").expect("written");
        let child = folder.start(&(arguments(4) + " --integrator photonmap:globalphotons=60000000"));
        wait_for_handler(&child);
        send(&child, "-INT");
        let (code, text) = end(child);
        assert_eq!(code, Some(130), "{text}");
        assert!(text.contains("interrupted before anything was finished"), "{text}");
        assert_eq!(std::fs::read_to_string(folder.path("out.exr")).expect("read"), "an older picture");
        assert!(!folder.path("state").exists());
    }
}
