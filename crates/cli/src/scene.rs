//! `etendue scene`: writes scenes of the notebook, with their meshes.

use std::fs;
use std::io::Write;
use std::path::Path;

use etendue::io::images::write_atomically;
use etendue::lab::generate::{Files, GENERATORS, Generator, SceneFile};

use crate::args::SceneArguments;
use crate::failure::{Failure, Result};
use crate::report;

/// Runs the command.
pub(crate) fn run(arguments: &SceneArguments) -> Result<()> {
    let Some(name) = &arguments.name else { return write_all(&arguments.out) };
    let generator = Generator::find(name).map_err(|error| Failure::Usage(error.0))?;
    let changes: Vec<(&str, &str)> =
        arguments.parameters.iter().map(|(name, value)| (name.as_str(), value.as_str())).collect();
    let files = generator.generate(changes).map_err(|error| Failure::Usage(error.0))?;
    make_folder(&arguments.out)?;
    write(&arguments.out, &files)
}

/// Every scene with its defaults; scenes may share meshes, which are the same then.
fn write_all(folder: &Path) -> Result<()> {
    make_folder(folder)?;
    for generator in GENERATORS {
        let files = generator.generate([]).map_err(|error| Failure::Running(error.0))?;
        write(folder, &files)?;
    }
    Ok(())
}

fn make_folder(folder: &Path) -> Result<()> {
    fs::create_dir_all(folder)
        .map_err(|error| Failure::Running(format!("cannot make the folder {}: {error}", folder.display())))
}

/// Meshes first, so that a scene whose file is there is whole.
fn write(folder: &Path, files: &Files) -> Result<()> {
    for SceneFile { name, bytes } in files.0.iter().rev() {
        let path = folder.join(name);
        write_atomically(&path, |file| file.write_all(bytes))
            .map_err(|error| Failure::Running(format!("cannot write {}: {error}", path.display())))?;
        report::note(&path.display().to_string());
    }
    Ok(())
}
