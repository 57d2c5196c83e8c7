//! The `etendue` command: what was typed becomes a call of the library, and its answer becomes text and files.
//!
//! Text for people goes to standard error, answers of `--json` and `list` to standard output. Exit codes: 0 done,
//! 1 failed while running, 2 bad usage or bad scene, 130 interrupted with what was finished written.

mod args;
mod bench;
mod brdf;
mod compare;
mod convert;
mod denoise;
mod exposures;
mod failure;
mod falsecolor;
mod image;
mod info;
mod list;
mod load;
mod merge;
mod metadata;
mod oidn;
mod outputs;
mod photon_file;
mod photons;
mod preview;
mod primaries;
mod probe;
mod progress;
mod render;
mod report;
mod scene;
mod stats;
mod study;
mod threads;
mod tonemap;

use std::process::ExitCode;

use clap::Parser;

use args::{Arguments, Command};

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let result = match arguments.command {
        Command::Render(arguments) => render::run(&arguments),
        Command::Info(arguments) => info::run(&arguments),
        Command::List(arguments) => list::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Convert(arguments) => convert::run(&arguments),
        Command::Merge(arguments) => merge::run(&arguments),
        Command::Tonemap(arguments) => tonemap::run(&arguments),
        Command::Image(arguments) => image::run(&arguments),
        Command::Falsecolor(arguments) => falsecolor::run(&arguments),
        Command::Probe(arguments) => probe::run(&arguments),
        Command::Hdr(arguments) => exposures::hdr(&arguments),
        Command::Fuse(arguments) => exposures::fusion(&arguments),
        Command::Denoise(arguments) => denoise::run(&arguments),
        Command::Study(arguments) => study::run(&arguments),
        Command::Brdf(arguments) => brdf::run(&arguments),
        Command::Bench(arguments) => bench::run(&arguments),
        Command::Scene(arguments) => scene::run(&arguments),
        Command::Photons(arguments) => photons::run(&arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            if let Some(message) = failure.message() {
                report::error(message);
            }
            ExitCode::from(failure.exit_code())
        }
    }
}
