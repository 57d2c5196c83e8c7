//! `etendue denoise`, and what `render --denoise` does after a render.

use std::path::Path;
use std::time::Instant;

use etendue::image::Image;
use etendue::image::denoise::{DenoiseError, Denoised, Settings, denoise, spread_fireflies};
use etendue::io::images::{ExrSettings, read_image};

use crate::args::{DenoiseArguments, DenoiserArgument};
use crate::failure::{Failure, Result};
use crate::threads::with_threads;
use crate::{oidn, outputs, report};

/// Metadata that tells what was done to a picture.
const DENOISED: &str = "etendue.denoised";

/// Runs the command.
pub(crate) fn run(arguments: &DenoiseArguments) -> Result<()> {
    with_threads(arguments.threads, || run_in_pool(arguments))
}

fn run_in_pool(arguments: &DenoiseArguments) -> Result<()> {
    outputs::check_images(&arguments.outputs)?;
    outputs::check_distinct(std::iter::once(&arguments.image).chain(&arguments.outputs))?;
    let name = arguments.image.display().to_string();
    let mut image = read_image(&arguments.image).map_err(|error| Failure::Usage(error.to_string()))?;
    let Some(pixels) = image.rgb_pixels() else {
        return Err(refusal(&name, DenoiseError::NoColor));
    };
    if !arguments.quiet && arguments.fireflies_only {
        report::non_finite(&name, &pixels, "they stay as they are");
    } else if !arguments.quiet && arguments.with == DenoiserArgument::Oidn {
        report::non_finite(&name, &pixels, "they count as black");
    }
    let started = Instant::now();
    let mut done = Vec::new();
    if arguments.fireflies || arguments.fireflies_only {
        let spread = spread_fireflies(&image);
        done.push(format!("{} spread", counted(spread.n_fireflies, "firefly", "fireflies")));
        image = spread.image;
    }
    if !arguments.fireflies_only {
        let (denoised, note) = match arguments.with {
            DenoiserArgument::Native => native(&image, &name, arguments.quiet)?,
            DenoiserArgument::Oidn => oidn::denoise(&image, &name, arguments.quiet)?,
        };
        image = denoised;
        done.push(note);
    }
    image.metadata.insert(DENOISED.to_owned(), done.join("; "));
    outputs::write_all(&arguments.outputs, |path| outputs::write(path, &image))?;
    if !arguments.quiet {
        let names: Vec<String> = arguments.outputs.iter().map(|path| path.display().to_string()).collect();
        let seconds = started.elapsed().as_secs_f64();
        report::note(&format!("{}: {} in {seconds:.1} s", names.join(", "), done.join("; ")));
    }
    Ok(())
}

/// Denoises what was rendered, and writes it to a file of its own.
pub(crate) fn after_render(image: &Image, path: &Path, exr: ExrSettings, quiet: bool) -> Result<()> {
    let name = path.display().to_string();
    let started = Instant::now();
    let (mut denoised, note) = native(image, &name, quiet)?;
    denoised.metadata.insert(DENOISED.to_owned(), note.clone());
    outputs::write_all(&[path.to_owned()], |path| outputs::write_with(path, &denoised, exr))?;
    if !quiet {
        report::note(&format!("{name}: {note} in {:.1} s", started.elapsed().as_secs_f64()));
    }
    Ok(())
}

/// The picture as the native denoiser leaves it, and what it used.
fn native(image: &Image, name: &str, quiet: bool) -> Result<(Image, String)> {
    let denoised = denoise(image, &Settings::default()).map_err(|error| refusal(name, error))?;
    if !quiet {
        warn(&denoised, name);
    }
    let features = match &denoised.features[..] {
        [] => "no features".to_owned(),
        names => names.join(", "),
    };
    let halves = if denoised.has_halves { "two halves of the samples" } else { "variances" };
    Ok((denoised.image, format!("denoised by regression on {features} with {halves}")))
}

fn warn(denoised: &Denoised, name: &str) {
    let missing = &denoised.missing_features;
    if !missing.is_empty() {
        report::warning(&format!(
            "{name}: there are no layers {}; edges and textures may blur. `render --features` writes them",
            missing.join(", ")
        ));
    }
    if denoised.is_noiseless {
        report::warning(&format!(
            "{name}: all variances are 0, as after a single sample per pixel; nothing is filtered"
        ));
    } else if !denoised.has_halves {
        report::warning(&format!(
            "{name}: there are no layers halfA and halfB of half the samples each, which tell signal from noise best. \
             `render --features` writes them"
        ));
    }
    if denoised.n_repaired > 0 {
        report::warning(&format!(
            "{name}: {} not finite; their neighbours stand in for them",
            counted(denoised.n_repaired, "pixel is", "pixels are")
        ));
    }
}

/// Why a picture is not denoised, and what would help.
pub(crate) fn refusal(name: &str, error: DenoiseError) -> Failure {
    let help = match error {
        DenoiseError::NoVariance => {
            "; render to .exr with --features, or remove fireflies alone with --fireflies-only"
        }
        DenoiseError::Empty | DenoiseError::NoColor => "",
    };
    Failure::Usage(format!("{name}: {error}{help}"))
}

fn counted(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}
