//! Étendue and Embree side by side: the same triangles, the same rays, in turns in one process.
//!
//! Times are processor seconds, of the tracing thread or of all threads that build, since machines do other things
//! too. In each round the contestants take turns over short runs of rays, so that what slows one slows the others;
//! the figures are medians over rounds, and ratios are medians of ratios within a round.

mod clock;
mod contestant;
mod embree;
mod ffi;
mod measure;
mod report;
mod scenes;

use std::path::{Path, PathBuf};

use clap::{Parser, ValueEnum};
use etendue_lab::speed::{Model, RayKind, ray_sets};

use contestant::Kind;

/// Times rays and builds of Étendue and Embree 3 on the same triangles.
#[derive(Debug, Parser)]
pub(crate) struct Arguments {
    /// Models, separated by commas
    #[arg(long, value_enum, value_delimiter = ',', default_values_t = [Mesh::Box, Mesh::Bmw, Mesh::Terrain, Mesh::Fractal])]
    mesh: Vec<Mesh>,
    /// Kinds of rays: primary, random, bounce, shadow
    #[arg(long, value_delimiter = ',', default_value = "primary,random,bounce,shadow")]
    rays: Vec<String>,
    /// Who takes part
    #[arg(long, value_enum, value_delimiter = ',', default_values_t = Kind::ALL)]
    only: Vec<Kind>,
    /// Rounds over all rays
    #[arg(long, default_value_t = 5)]
    rounds: usize,
    /// Times that everything is built
    #[arg(long, default_value_t = 3)]
    builds: usize,
    /// Threads that build [default: all]
    #[arg(long)]
    threads: Option<usize>,
    /// Pixels across and down
    #[arg(long, num_args = 2, value_names = ["WIDTH", "HEIGHT"], default_values_t = [1024, 768])]
    resolution: Vec<u32>,
    /// Cells along a side of the terrain
    #[arg(long, default_value_t = 900)]
    terrain: u32,
    /// Folder with the scene bmw-m6
    #[arg(long, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/scenes"))]
    scenes: PathBuf,
    /// More settings of Embree, such as max_isa=avx2
    #[arg(long, default_value = "")]
    embree: String,
    /// Write the figures here, too
    #[arg(long)]
    json: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Mesh {
    Box,
    Bmw,
    Terrain,
    Fractal,
}

fn load(mesh: Mesh, arguments: &Arguments) -> Option<Model> {
    match mesh {
        Mesh::Box => Some(Model::cornell_box()),
        Mesh::Bmw => scenes::bmw_m6(&arguments.scenes),
        Mesh::Terrain => Some(Model::terrain(arguments.terrain)),
        Mesh::Fractal => Some(Model::fractal_box(3)),
    }
}

fn main() {
    let arguments = Arguments::parse();
    let n_threads =
        arguments.threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, |n| n.get()));
    let device = embree::Device::new(n_threads, &arguments.embree);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().expect("threads start");
    let mut figures = Vec::new();
    for &mesh in &arguments.mesh {
        let Some(model) = load(mesh, &arguments) else {
            println!("{mesh:?}: there is no such scene below {}", arguments.scenes.display());
            continue;
        };
        let buffers = embree::Buffers::new(&model);
        let builder = contestant::Builder { model: &model, device: &device, buffers: &buffers, pool: &pool };
        let (contestants, builds) = measure::builds(&builder, &arguments.only, arguments.builds);
        report::print_builds(&model, &arguments.only, &builds);
        let reference = builder.geometry();
        let is_wanted = |kind: RayKind| arguments.rays.iter().any(|name| name == kind.name());
        let sets = ray_sets(&model, &reference, [arguments.resolution[0], arguments.resolution[1]]);
        let mut rays = Vec::new();
        for set in sets.iter().filter(|set| is_wanted(set.kind)) {
            let traced = measure::rays(&contestants, set, arguments.rounds);
            report::print_rays(set, &arguments.only, &traced);
            rays.push((set.kind, traced));
        }
        figures.push(report::figures(&model, &arguments.only, &builds, &rays));
    }
    if let Some(path) = &arguments.json {
        write(path, &serde_json::Value::Array(figures));
    }
}

fn write(path: &Path, figures: &serde_json::Value) {
    std::fs::write(path, format!("{figures:#}\n")).expect("the file can be written");
}
