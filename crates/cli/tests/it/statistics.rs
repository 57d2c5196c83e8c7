//! `--stats` and the rules that stop a render.

use serde_json::Value;

use crate::support::{Folder, ROOM};

#[track_caller]
fn statistics(folder: &Folder, arguments: &str) -> Value {
    folder.run(&format!("render scene.pbrt -q -o out.exr --stats stats.json {arguments}")).expect(0);
    serde_json::from_slice(&folder.read("stats.json")).expect("JSON")
}

/// All keys are there with values that make sense together.
#[test]
fn keys() {
    let folder = Folder::with_scene(ROOM);
    let stats = statistics(&folder, "--spp 8 --threads 2");
    let number = |key: &str| stats[key].as_f64().unwrap_or_else(|| panic!("{key} in {stats}"));
    assert_eq!(stats["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(stats["integrator"], "path");
    for (key, value) in [("passes", 8), ("spp", 8), ("threads", 2), ("photons_stored", 0), ("nan_samples", 0)]
    {
        assert_eq!(stats[key], value, "{key}");
    }
    let n_samples = 8.0 * 40.0 * 24.0;
    assert_eq!(number("samples"), n_samples);
    assert!(number("rays") >= n_samples, "{stats}");
    assert!(number("shadow_rays") > 0.0, "{stats}");
    assert!(number("seconds_build") > 0.0 && number("seconds_render") > 0.0, "{stats}");
    assert!(number("seconds_total") >= number("seconds_build") + number("seconds_render"), "{stats}");
    assert!(number("relative_error") > 0.0, "{stats}");
    if cfg!(target_os = "linux") {
        assert!(number("peak_memory_bytes") > 1e6, "{stats}");
    }
}

/// Photons of a pass are forgotten after it: ten times as many passes take no more memory. (What a single pass keeps is a
/// multiple of what would be allowed to grow.)
#[test]
fn passes_of_photons_need_no_more_memory() {
    if !cfg!(target_os = "linux") {
        return;
    }
    let folder = Folder::with_scene(ROOM);
    let peak = |n_passes: u32| {
        let method = "--integrator sppm:photonsperiteration=400000 --threads 2";
        statistics(&folder, &format!("{method} --spp {n_passes}"))["peak_memory_bytes"]
            .as_f64()
            .expect("a number")
    };
    let (few, many) = (peak(2), peak(20));
    assert!(many < 1.15 * few, "{few} bytes become {many}");
}

/// Both kinds of rays are told apart: paths that find lights by chance ask for no visibility.
#[test]
fn shadow_rays_are_counted_apart() {
    let folder = Folder::with_scene(ROOM);
    let stats = statistics(&folder, "--spp 2 --integrator path:lights=scattering");
    assert_eq!(stats["shadow_rays"], 0, "{stats}");
    assert!(stats["rays"].as_u64() > Some(0), "{stats}");
}

/// The processor time of the process is that of its threads and a little more; no thread works longer than the render
/// takes, and the least busy one gives the share.
#[test]
fn threads_are_timed() {
    let folder = Folder::with_scene(ROOM);
    let stats = statistics(&folder, "--spp 8 --threads 3");
    let number = |key: &str| stats[key].as_f64().unwrap_or_else(|| panic!("{key} in {stats}"));
    let threads: Vec<f64> =
        stats["thread_cpu_seconds"].as_array().expect("a list").iter().filter_map(Value::as_f64).collect();
    assert_eq!(threads.len(), 3, "{stats}");
    let sum: f64 = threads.iter().sum();
    assert!(sum <= number("cpu_seconds"), "{stats}");
    // Elsewhere clocks may tick more slowly than this render takes.
    assert!(sum > 0.0 || !cfg!(target_os = "linux"), "{stats}");
    // Clocks of threads and walls need not agree on the last millisecond.
    assert!(threads.iter().all(|s| (0.0..number("seconds_render") + 0.02).contains(s)), "{stats}");
    let least = threads.iter().copied().fold(f64::INFINITY, f64::min);
    assert!((number("busy_share") - least / number("seconds_render")).abs() < 1e-9, "{stats}");
}

/// Rays are counted alike by any number of threads.
#[test]
fn counts_do_not_depend_on_threads() {
    let folder = Folder::with_scene(ROOM);
    let [one, two] = [1, 2].map(|n| statistics(&folder, &format!("--threads {n}")));
    for key in ["samples", "rays", "shadow_rays", "relative_error"] {
        assert_eq!(one[key], two[key], "{key}");
    }
}

/// The method that ran, not the one that it stands in for.
#[test]
fn stand_ins_are_told() {
    let folder = Folder::with_scene(ROOM);
    assert_eq!(statistics(&folder, "--spp 1 --integrator volpath")["integrator"], "path");
}

/// A time limit ends the render near it, with all finished passes.
#[test]
fn time_limit() {
    let folder = Folder::with_scene(ROOM);
    let stats = statistics(&folder, "--time 1500ms");
    let seconds = stats["seconds_render"].as_f64().expect("a number");
    // A busy machine may need its time for the pass that has begun.
    assert!((1.5..6.0).contains(&seconds), "{seconds}");
    assert!(stats["spp"].as_u64().is_some_and(|n| n > 1), "{stats}");
    // The number of samples still counts.
    let stats = statistics(&folder, "--time 100s --spp 2");
    assert_eq!(stats["spp"], 2);
    // Numbers as large as can be written are no end, and no failure.
    let stats = statistics(&folder, "--time 300000000000000h --spp 2");
    assert_eq!(stats["spp"], 2);
    let stats = statistics(&folder, "--time 100ms --spp 18446744073709551615");
    assert!(stats["spp"].as_u64().is_some_and(|n| n > 0), "{stats}");
    let stats = statistics(&folder, "--passes 18446744073709551613..18446744073709551615");
    assert_eq!(stats["spp"], 2);
    // No pass fits: a part of a picture, and no failure.
    let stats = statistics(&folder, "--time 1ms --resolution 1000x1000");
    assert_eq!(stats["spp"], 0);
}

/// An error target ends the render once it is reached, and not before.
#[test]
fn error_target() {
    let folder = Folder::with_scene(ROOM);
    let coarse = statistics(&folder, "--error 0.2");
    let fine = statistics(&folder, "--error 0.1");
    let get = |stats: &Value, key: &str| stats[key].as_f64().expect("a number");
    for (stats, target) in [(&coarse, 0.2), (&fine, 0.1)] {
        assert!(get(stats, "relative_error") <= target, "{stats}");
        assert!((16.0..4096.0).contains(&get(stats, "spp")), "{stats}");
    }
    assert!(get(&fine, "spp") > get(&coarse, "spp"));
    assert_eq!(statistics(&folder, "--error 0.000001 --spp 20")["spp"], 20);
}
