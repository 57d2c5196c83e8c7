//! Open Image Denoise, where it is installed: its program `oidnDenoise` gets pictures as PFM files and leaves one.
//!
//! A program, not the library, so that nothing here is unsafe or has to be linked.

use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

use etendue::image::Image;
use etendue::image::denoise::with_clean_color;
use etendue::io::images::{read_image, write_image};

use crate::failure::{Failure, Result};
use crate::report;

const PROGRAM: &str = "oidnDenoise";

/// The picture as Open Image Denoise leaves it, and what it used: albedo and normals where both are there.
pub(crate) fn denoise(image: &Image, name: &str, quiet: bool) -> Result<(Image, String)> {
    let folder = Folder::new().map_err(|error| Failure::Running(format!("no temporary folder: {error}")))?;
    let color = image.rgb_pixels().unwrap_or_default();
    let n_broken = color.iter().filter(|pixel| pixel.iter().any(|v| !v.is_finite())).count();
    if n_broken > 0 && !quiet {
        let pixels = if n_broken == 1 { "pixel is" } else { "pixels are" };
        report::warning(&format!("{name}: {n_broken} {pixels} not finite and black for Open Image Denoise"));
    }
    let mut command = Command::new(PROGRAM);
    command.arg("--hdr").arg(folder.write("color.pfm", image, color)?);
    let features = image.layer_rgb("Albedo").zip(normals(image));
    let used = if features.is_some() { "albedo and normals" } else { "no features" };
    if let Some((albedo, normals)) = features {
        command.arg("--alb").arg(folder.write("albedo.pfm", image, albedo)?);
        command.arg("--nrm").arg(folder.write("normal.pfm", image, normals)?);
    } else if !quiet {
        report::warning(&format!(
            "{name}: there are no layers Albedo and Ns; edges and textures may blur. `render --features` writes them"
        ));
    }
    let result = folder.path.join("result.pfm");
    run(command.arg("-o").arg(&result))?;
    let pixels = result_pixels(&result, image)?;
    Ok((with_clean_color(image, &pixels), format!("denoised by Open Image Denoise with {used}")))
}

/// Shading normals as pixels.
fn normals(image: &Image) -> Option<Vec<[f32; 3]>> {
    let plane = |component| Some(&image.channel(&format!("Ns.{component}"))?.values);
    let [x, y, z] = [plane("X")?, plane("Y")?, plane("Z")?];
    Some((0..image.n_pixels()).map(|i| [x[i], y[i], z[i]]).collect())
}

fn run(command: &mut Command) -> Result<()> {
    let output = command.output().map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => Failure::Running(format!(
            "the program {PROGRAM} was not found; install Open Image Denoise (https://www.openimagedenoise.org) and add its \
             folder bin to PATH, or leave out --with oidn"
        )),
        _ => Failure::Running(format!("cannot start {PROGRAM}: {error}")),
    })?;
    if output.status.success() {
        return Ok(());
    }
    let text = String::from_utf8_lossy(&output.stderr);
    let last =
        text.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("it does not say why").trim();
    Err(Failure::Running(format!("{PROGRAM} failed ({}): {last}", output.status)))
}

fn result_pixels(path: &Path, image: &Image) -> Result<Vec<[f32; 3]>> {
    let refuse = |what: &str| Failure::Running(format!("{PROGRAM} left no picture: {what}"));
    let result = read_image(path).map_err(|error| refuse(&error.to_string()))?;
    if [result.width, result.height] != [image.width, image.height] {
        return Err(refuse(&format!("{} x {} pixels", result.width, result.height)));
    }
    result.rgb_pixels().ok_or_else(|| refuse("no colour"))
}

/// A folder of temporary files that goes when this value does.
struct Folder {
    path: PathBuf,
}

impl Folder {
    fn new() -> io::Result<Self> {
        // What an ended process of the same number left stays.
        let mut counter = 0_u32;
        loop {
            let path = std::env::temp_dir().join(format!("etendue-oidn-{}-{counter}", std::process::id()));
            match std::fs::create_dir(&path) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists && counter < 1000 => counter += 1,
                made => return made.map(|()| Self { path }),
            }
        }
    }

    /// Writes pixels of the size of `image`; those that are not finite are black.
    fn write(&self, name: &str, image: &Image, mut pixels: Vec<[f32; 3]>) -> Result<PathBuf> {
        let path = self.path.join(name);
        pixels.iter_mut().flatten().filter(|v| !v.is_finite()).for_each(|v| *v = 0.0);
        write_image(&path, &Image::rgb(image.width, image.height, pixels))
            .map_err(|error| Failure::Running(format!("cannot write {error}")))?;
        Ok(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // What cannot be removed is left to the system.
        let _ = std::fs::remove_dir_all(&self.path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder that is there already is in nobody's way, and both go.
    #[test]
    fn folders_differ() {
        let paths = {
            let folders = [(); 2].map(|()| Folder::new().expect("a folder"));
            assert!(folders.iter().all(|folder| folder.path.is_dir()));
            folders.each_ref().map(|folder| folder.path.clone())
        };
        assert_ne!(paths[0], paths[1]);
        assert!(paths.iter().all(|path| !path.exists()));
    }
}
