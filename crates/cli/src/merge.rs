//! `etendue merge`: adds renders of one scene (SPEC PAR-3).
//!
//! Files of `render --passes` carry exact sums, and parts of one seed add up to the bits of the whole. Other files are
//! averaged, weighted by their samples.

use std::path::Path;

use etendue::image::Image;
use etendue::io::images::read_image;
use etendue::scene::film::FilmSums;

use crate::args::MergeArguments;
use crate::failure::{Failure, Result};
use crate::{metadata, outputs, report};

/// One file to merge.
struct Part {
    name: String,
    image: Image,
    fingerprint: String,
    seed: String,
    sums: Option<FilmSums>,
    n_passes: u64,
}

/// Runs the command.
pub(crate) fn run(arguments: &MergeArguments) -> Result<()> {
    outputs::check_images(&arguments.outputs)?;
    let parts = arguments.images.iter().map(|path| open(path)).collect::<Result<Vec<Part>>>()?;
    check_one_scene(&parts)?;
    let image =
        if parts.iter().all(|part| part.sums.is_some()) { merge_exactly(parts)? } else { average(parts)? };
    outputs::write_all(&arguments.outputs, |path| outputs::write(path, &image))
}

fn open(path: &Path) -> Result<Part> {
    let name = path.display().to_string();
    let image = read_image(path).map_err(|error| Failure::Usage(error.to_string()))?;
    let foreign = || Failure::Usage(format!("{name}: it does not say which scene and passes it holds"));
    let entry = |key: &str| image.metadata.get(key).cloned().ok_or_else(foreign);
    let (fingerprint, seed) = (entry(metadata::FINGERPRINT)?, entry(metadata::SEED)?);
    let passes = metadata::passes(&image).ok_or_else(foreign)?;
    let n_passes = passes.iter().map(|r| r.end.saturating_sub(r.start)).sum();
    if n_passes == 0 {
        return Err(Failure::Usage(format!("{name}: it holds no complete pass")));
    }
    let bounds = metadata::pixels(&image).ok_or_else(foreign)?;
    let luminance = metadata::numbers(&image, metadata::LUMINANCE).ok_or_else(foreign)?;
    let mut sums = FilmSums::from_image(&image, bounds, luminance).ok();
    if let Some(sums) = &mut sums {
        for range in passes {
            sums.note_passes(range);
        }
    }
    Ok(Part { name, image, fingerprint, seed, sums, n_passes })
}

fn check_one_scene(parts: &[Part]) -> Result<()> {
    let first = &parts[0];
    for part in &parts[1..] {
        if part.fingerprint != first.fingerprint {
            let message =
                format!("{} and {} are not of the same scene, film and integrator", first.name, part.name);
            return Err(Failure::Usage(message));
        }
        if part.image.metadata.get("software") != first.image.metadata.get("software") {
            report::warning(&format!("{} and {} come from different versions", first.name, part.name));
        }
    }
    Ok(())
}

/// Adds exact sums: of one seed by their passes, of others as independent renders.
fn merge_exactly(parts: Vec<Part>) -> Result<Image> {
    let mut parts = parts.into_iter();
    let first = parts.next().expect("the command line asks for two images");
    let mut sums = first.sums.expect("all parts have sums");
    let mut seeds = vec![first.seed.clone()];
    for part in parts {
        let refuse = |error: String| Failure::Usage(format!("{}: {error}", part.name));
        let addend = part.sums.as_ref().expect("all parts have sums");
        if seeds == [part.seed.clone()] {
            sums.merge(addend).map_err(|error| refuse(error.to_string()))?;
        } else if seeds.contains(&part.seed) {
            return Err(refuse(format!(
                "seed {} is in the sum already; merge each seed by itself first",
                part.seed
            )));
        } else {
            sums.merge_independent(addend).map_err(|error| refuse(error.to_string()))?;
            seeds.push(part.seed.clone());
        }
    }
    let mut image = sums.develop();
    image.metadata = first.image.metadata;
    image.metadata.insert(metadata::SEED.to_owned(), seeds.join("+"));
    let passes: Vec<String> = sums.passes().iter().map(|r| format!("{}..{}", r.start, r.end)).collect();
    image.metadata.insert(metadata::PASSES.to_owned(), passes.join(" "));
    image.metadata.insert(metadata::SPP.to_owned(), sums.n_passes().to_string());
    image.channels.extend(sums.exact_channels());
    Ok(image)
}

/// Averages images of different seeds, weighted by their samples; the variances of the means add accordingly.
fn average(parts: Vec<Part>) -> Result<Image> {
    let total: u64 = parts.iter().map(|part| part.n_passes).sum();
    let mut seeds: Vec<String> = Vec::new();
    let mut sum: Vec<Vec<f64>> = Vec::new();
    let first_channels: Vec<String> = visible_channels(&parts[0].image);
    // Black halves would count as dark pictures.
    let is_left_out = |name: &str| is_of_half(name) && parts.iter().any(|part| has_empty_half(&part.image));
    for part in &parts {
        if seeds.contains(&part.seed) {
            let message = format!(
                "{}: seed {} is in the sum already; the same numbers twice do not improve an image. \
                 Render with another --seed, or split one seed with --passes",
                part.name, part.seed
            );
            return Err(Failure::Usage(message));
        }
        seeds.push(part.seed.clone());
        if visible_channels(&part.image) != first_channels || part.image.width != parts[0].image.width {
            return Err(Failure::Usage(format!("{}: its channels or size differ", part.name)));
        }
        let share = part.n_passes as f64 / total as f64;
        for (index, name) in first_channels.iter().enumerate() {
            let factor = if name.starts_with("variance.") { share * share } else { share };
            let channel = part.image.channel(name).expect("the name was listed");
            if sum.len() == index {
                sum.push(vec![0.0; channel.values.len()]);
            }
            for (total, value) in sum[index].iter_mut().zip(&channel.values) {
                *total += factor * f64::from(*value);
            }
        }
    }
    let mut image = Image::new(parts[0].image.width, parts[0].image.height);
    for (name, values) in first_channels.into_iter().zip(sum).filter(|(name, _)| !is_left_out(name)) {
        image.set_channel(&name, values.into_iter().map(|v| v as f32).collect());
    }
    image.metadata = parts[0].image.metadata.clone();
    image.metadata.insert(metadata::SEED.to_owned(), seeds.join("+"));
    image.metadata.insert(metadata::PASSES.to_owned(), format!("0..{total}"));
    image.metadata.insert(metadata::SPP.to_owned(), total.to_string());
    Ok(image)
}

/// True of channels that hold one half of the samples.
fn is_of_half(name: &str) -> bool {
    HALVES.iter().any(|half| name.strip_prefix(half).is_some_and(|rest| rest.starts_with('.')))
}

const HALVES: [&str; 2] = ["halfA", "halfB"];

/// True if no sample lies in one of the halves, as of few passes that follow each other, but the picture is not black.
fn has_empty_half(image: &Image) -> bool {
    let is_black = |layer: &str| {
        let pixels = image.layer_rgb(layer)?;
        Some(pixels.iter().flatten().all(|value| *value == 0.0))
    };
    is_black("") == Some(false) && HALVES.iter().any(|half| is_black(half) == Some(true))
}

fn visible_channels(image: &Image) -> Vec<String> {
    let names = image.channels.iter().map(|c| c.name.clone());
    names.filter(|name| !name.starts_with("sums.")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(seed: &str, n_passes: u64, half_b: f32) -> Part {
        let mut image = Image::rgb(1, 1, vec![[2.0; 3]]);
        image.set_rgb("halfA", &[[2.0; 3]]);
        image.set_rgb("halfB", &[[half_b; 3]]);
        let (name, fingerprint, seed) = ("part".to_owned(), String::new(), seed.to_owned());
        Part { name, image, fingerprint, seed, sums: None, n_passes }
    }

    /// Halves are averaged where all have samples, and else left out rather than darkened.
    #[test]
    fn empty_halves_are_left_out() {
        let whole = average(vec![part("1", 1, 2.0), part("2", 3, 6.0)]).expect("an average");
        assert_eq!(whole.layer_rgb("halfB"), Some(vec![[5.0; 3]]));
        let without = average(vec![part("1", 1, 0.0), part("2", 3, 6.0)]).expect("an average");
        assert_eq!(without.rgb_pixels(), Some(vec![[2.0; 3]]));
        assert!(without.channels.iter().all(|channel| !channel.name.starts_with("half")));
    }
}
