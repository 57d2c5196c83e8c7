//! Where images go: what can be refused is refused before hours of work, and what was rendered is not lost.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use etendue::image::Image;
use etendue::io::images::{
    ExrBlocks, ExrNumbers, ExrSettings, ImageError, check_writable, write_exr, write_image,
};

use crate::args::ExrArguments;
use crate::failure::{Failure, Result};
use crate::{primaries, report};

/// Extensions of the formats that are written.
const FORMATS: [&str; 5] = ["exr", "png", "ppm", "pfm", "hdr"];

/// Lower-case extension, empty if there is none.
#[must_use]
pub(crate) fn extension(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// True if images are written with that extension.
#[must_use]
pub(crate) fn is_image_name(path: &Path) -> bool {
    FORMATS.contains(&extension(path).as_str())
}

/// Refuses unknown formats, folders that do not exist, and files that cannot be written.
pub(crate) fn check_images(paths: &[PathBuf]) -> Result<()> {
    for path in paths {
        if !is_image_name(path) {
            let message = format!("{}: images are written as .{}", path.display(), FORMATS.join(", ."));
            return Err(Failure::Usage(message));
        }
        check_file(path)?;
    }
    Ok(())
}

/// Refuses a file in a folder that does not exist, and one that cannot be written.
pub(crate) fn check_file(path: &Path) -> Result<()> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    if let Some(folder) = folder
        && !folder.is_dir()
    {
        let message = format!("{}: there is no folder {}; make it first", path.display(), folder.display());
        return Err(Failure::Usage(message));
    }
    check_writable(path)
        .map_err(|error| Failure::Running(format!("cannot write {}: {error}", path.display())))
}

/// Writes to several files; all are tried before failures are reported.
pub(crate) fn write_all(paths: &[PathBuf], write: impl Fn(&Path) -> WriteResult) -> Result<()> {
    let failures = failures(paths, write);
    if failures.is_empty() { Ok(()) } else { Err(Failure::Running(failures.join("\n"))) }
}

/// Refuses a file that would be overwritten by another one of the same command.
pub(crate) fn check_distinct<'p>(paths: impl Iterator<Item = &'p PathBuf>) -> Result<()> {
    let mut seen = HashSet::new();
    for path in paths {
        if !seen.insert(std::path::absolute(path).unwrap_or_else(|_| path.clone())) {
            let message =
                format!("{}: this file is named twice; one would overwrite the other", path.display());
            return Err(Failure::Usage(message));
        }
    }
    Ok(())
}

/// How .exr files are written, by the options; says where there are none.
pub(crate) fn exr_settings(arguments: ExrArguments, paths: &[PathBuf]) -> ExrSettings {
    if (arguments.half || arguments.tiles) && !paths.iter().any(|path| extension(path) == "exr") {
        report::warning("--half and --tiles have no effect: they are for .exr files");
    }
    ExrSettings {
        numbers: if arguments.half { ExrNumbers::Half } else { ExrNumbers::Float },
        blocks: if arguments.tiles { ExrBlocks::Tiles } else { ExrBlocks::Rows },
    }
}

/// Writes an image in the format of its name. Formats that cannot state primaries have those of sRGB.
pub(crate) fn write_with(path: &Path, image: &Image, exr: ExrSettings) -> WriteResult {
    if extension(path) == "exr" {
        write_exr(path, image, exr)
    } else {
        write_image(path, &primaries::for_untold(image))
    }
}

/// The same with the usual settings.
pub(crate) fn write(path: &Path, image: &Image) -> WriteResult {
    write_with(path, image, ExrSettings::default())
}

type WriteResult = std::result::Result<(), ImageError>;

fn failures(paths: &[PathBuf], write: impl Fn(&Path) -> WriteResult) -> Vec<String> {
    let message = |error: ImageError| format!("cannot write {error}");
    paths.iter().filter_map(|path| write(path).err()).map(message).collect()
}

/// Writes what took long to make: where every file fails, for example because the disk became full, it is kept in the
/// folder of temporary files.
pub(crate) fn write_precious(paths: &[PathBuf], image: &Image, exr: ExrSettings) -> Result<()> {
    let mut failures = failures(paths, |path| write_with(path, image, exr));
    if failures.is_empty() {
        return Ok(());
    }
    if failures.len() == paths.len() {
        let refuge = std::env::temp_dir().join(format!("etendue-{}.exr", std::process::id()));
        if write_image(&refuge, image).is_ok() {
            failures.push(format!("the image is kept in {}", refuge.display()));
        }
    }
    Err(Failure::Running(failures.join("\n")))
}
