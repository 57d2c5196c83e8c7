//! Speed of the readers: `cargo bench -p etendue-io`. Run with `--test`, as by `cargo test --benches`, it takes a
//! small input once.

#![allow(clippy::print_stdout, reason = "a benchmark prints its result")]

use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

use etendue_io::{read_pbrt, read_pbrt_str, read_ply, write_pbrt};

fn main() {
    let quick = !std::env::args().any(|argument| argument == "--bench");
    let n_triangles = if quick { 1_000 } else { 600_000 };
    let scene = scene(n_triangles);
    report("pbrt text with inline meshes", scene.len(), || {
        let (document, diagnostics) = read_pbrt_str("bench", &scene, Path::new(""));
        assert!(diagnostics.list().is_empty() && document.shapes.len() == 10);
    });
    let (document, _) = read_pbrt_str("bench", &scene, Path::new(""));
    report("printing it", scene.len(), || assert!(write_pbrt(&document).len() > scene.len() / 4));
    let statements = "AttributeBegin Translate 1 2 3 NamedMaterial \"m\" Shape \"sphere\" \"float radius\" 1 AttributeEnd\n";
    let statements = format!("WorldBegin\n{}", statements.repeat(n_triangles / 10));
    report("pbrt text of short statements", statements.len(), || {
        assert!(!read_pbrt_str("bench", &statements, Path::new("")).1.has_errors());
    });
    let ply = ply(if quick { 1_000 } else { 1_000_000 });
    report("binary PLY", ply.len(), || assert!(read_ply(&ply).is_ok()));
    for path in std::env::args().skip(1).filter(|argument| argument.ends_with(".pbrt")) {
        let start = Instant::now();
        let (document, _) = read_pbrt(Path::new(&path));
        let read = start.elapsed();
        let (assets, diagnostics) = etendue_io::load_assets(&document);
        println!(
            "{path}: text {read:.2?}, {} assets {:.2?}, {} problems",
            assets.meshes.len() + assets.images.len(),
            start.elapsed() - read,
            diagnostics.list().len()
        );
    }
}

/// The best of five runs.
fn report(name: &str, n_bytes: usize, run: impl Fn()) {
    let seconds = (0..5).map(|_| {
        let start = Instant::now();
        run();
        start.elapsed().as_secs_f64()
    });
    let best = seconds.fold(f64::INFINITY, f64::min);
    println!(
        "{name}: {:.1} MB in {best:.3} s, {:.0} MB/s",
        n_bytes as f64 / 1e6,
        n_bytes as f64 / 1e6 / best
    );
}

/// Ten meshes with as many vertices as triangles.
fn scene(n_triangles: usize) -> String {
    let mut text = String::from("WorldBegin\n");
    for mesh in 0..10 {
        text.push_str("Shape \"trianglemesh\" \"integer indices\" [");
        let n = n_triangles / 10;
        for i in 0..n {
            let _ = write!(text, " {} {} {}", i, (i + 1) % n, (i + 2) % n);
        }
        text.push_str(" ]\n\"point3 P\" [");
        for i in 0..n {
            let x = ((i * 7919 + mesh) % 10_007) as f32 / 10_007.0;
            let _ = write!(text, " {} {} {}", x, -x * 13.7, x * x);
        }
        text.push_str(" ]\n");
    }
    text
}

fn ply(n_triangles: usize) -> Vec<u8> {
    let n_vertices = n_triangles / 2;
    let header = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {n_vertices}\nproperty float x\nproperty float y\n\
         property float z\nproperty float nx\nproperty float ny\nproperty float nz\nelement face {n_triangles}\n\
         property list uint8 int vertex_indices\nend_header\n"
    );
    let mut bytes = header.into_bytes();
    for i in 0..6 * n_vertices {
        bytes.extend((i as f32).to_le_bytes());
    }
    for i in 0..n_triangles {
        bytes.push(3);
        for corner in 0..3 {
            bytes.extend((((i + corner) % n_vertices) as i32).to_le_bytes());
        }
    }
    bytes
}
