//! `etendue study`: experiments with the renderer, as a table and a figure.

use std::fs;
use std::path::Path;

use etendue::lab::{ConvergenceSettings, PixelSettings, convergence, pixel};

use crate::args::{StudyArguments, StudyName};
use crate::failure::{Failure, Result};
use crate::report;

/// Runs the command.
pub(crate) fn run(arguments: &StudyArguments) -> Result<()> {
    // Before the work, so that it is not in vain.
    fs::create_dir_all(&arguments.out).map_err(|error| {
        Failure::Running(format!("cannot make the folder {}: {error}", arguments.out.display()))
    })?;
    let (name, csv, svg, summary) = match arguments.name {
        StudyName::Convergence => {
            let settings = if arguments.quick {
                ConvergenceSettings::quick(arguments.seed)
            } else {
                ConvergenceSettings::full(arguments.seed)
            };
            let study = convergence(&settings, &mut |what| report::note(what));
            ("convergence", study.csv(), study.svg(), study.summary())
        }
        StudyName::Pixel => {
            let settings = if arguments.quick {
                PixelSettings::quick(arguments.seed)
            } else {
                PixelSettings::full(arguments.seed)
            };
            let study = pixel(&settings);
            ("pixel", study.csv(), study.svg(), study.summary())
        }
    };
    report::note(summary.trim_end());
    write(&arguments.out, &format!("{name}.csv"), &csv)?;
    write(&arguments.out, &format!("{name}.svg"), &svg)
}

fn write(folder: &Path, name: &str, text: &str) -> Result<()> {
    let path = folder.join(name);
    fs::write(&path, text)
        .map_err(|error| Failure::Running(format!("cannot write {}: {error}", path.display())))?;
    report::note(&path.display().to_string());
    Ok(())
}
