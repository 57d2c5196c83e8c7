//! `etendue render`.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Instant;

use etendue::image::Image;
use etendue::io::checkpoint::read_checkpoint;
use etendue::io::images::write_image;
use etendue::scene::{Film, Scene};
use etendue::transport::lpe::PathExpressions;
use etendue::transport::{Integrator, Outcome, Stop, method, render};

use crate::args::{RenderArguments, WavelengthArgument};
use crate::failure::{Failure, Result};
use crate::load::{LoadedScene, Overrides, fingerprint, load};
use crate::progress::{CheckpointPlan, ShowProgress, Watch, catch_interruption, is_interrupted};
use crate::stats::Statistics;
use crate::{metadata, report};

/// A render, as meant: what to do, where the results go.
struct Job {
    scene: Scene,
    integrator: Box<dyn Integrator>,
    film: Film,
    stop: Stop,
    outputs: Vec<PathBuf>,
    fingerprint: u64,
    checkpoint: Option<CheckpointPlan>,
}

/// Runs the command.
pub(crate) fn run(arguments: &RenderArguments) -> Result<()> {
    let started = Instant::now();
    let threads = arguments.threads.map_or(0, |n| n as usize);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| Failure::Running(format!("cannot start threads: {error}")))?;
    pool.install(|| run_in_pool(arguments, started))
}

fn run_in_pool(arguments: &RenderArguments, started: Instant) -> Result<()> {
    let mut job = prepare(arguments)?;
    if arguments.resume {
        resume(&mut job)?;
    }
    let seconds_build = started.elapsed().as_secs_f64();

    catch_interruption();
    let show = if arguments.quiet || arguments.no_progress { ShowProgress::No } else { ShowProgress::Yes };
    let missing = job.stop.passes.clone().filter(|pass| !job.film.holds_pass(*pass)).count() as u64;
    let n_pixels = job.film.settings().crop.n_pixels() as u64;
    let watch = Watch::new(missing * n_pixels, missing, arguments.time, job.checkpoint.clone(), show);
    let outcome = render(&job.scene, job.integrator.as_mut(), &mut job.film, &job.stop, &watch);
    watch.finish(&job.film, job.integrator.as_ref());

    write_outputs(arguments, &job)?;
    report_faults(&job.film);
    finish_statistics(arguments, &job, &watch, started, seconds_build)?;
    if outcome == Outcome::Stopped && is_interrupted() { Err(Failure::Interrupted) } else { Ok(()) }
}

fn prepare(arguments: &RenderArguments) -> Result<Job> {
    let overrides = Overrides {
        resolution: arguments.resolution,
        crop: arguments.crop,
        integrator: arguments.integrator.clone(),
        wavelengths: arguments.wavelengths.map(|w| match w {
            WavelengthArgument::Hero => "hero",
            WavelengthArgument::Single => "single",
            WavelengthArgument::Bands => "bands",
        }),
    };
    let LoadedScene { document, mut scene, .. } = load(&arguments.scene, &overrides, arguments.quiet)?;
    if let Some(seed) = arguments.seed {
        scene.sampler.seed = seed;
    }
    let layers = layers(arguments);
    let fingerprint = fingerprint(&document, &layers);
    let expressions = PathExpressions::new(&layers).map_err(|error| Failure::Usage(error.to_string()))?;
    let names = expressions.names().to_vec();
    let (integrator, problems) = method(&scene.integrator, expressions);
    report::diagnostics(&problems, &document.sources, arguments.quiet);
    let integrator = integrator.ok_or(Failure::Scene)?;
    let film = Film::new(scene.film.clone(), names);
    let outputs = outputs(arguments, &scene)?;
    let checkpoint = arguments.checkpoint.clone().map(|path| CheckpointPlan {
        path,
        every: arguments.every,
        fingerprint,
        seed: scene.sampler.seed,
    });
    let stop = Stop { passes: passes(arguments, &scene), error: arguments.error };
    Ok(Job { scene, integrator, film, stop, outputs, fingerprint, checkpoint })
}

/// Named expressions, those of `--bounces` first.
fn layers(arguments: &RenderArguments) -> Vec<(String, String)> {
    let bounces = arguments.bounces.map(|n| 0..=n).into_iter().flatten();
    let mut layers: Vec<(String, String)> =
        bounces.map(|k| (format!("bounce{k}"), format!("L.{{{k}}}E"))).collect();
    layers.extend(arguments.expressions.iter().cloned());
    layers
}

/// Passes to run: given ones, or as many as samples are wanted; without end where only time or error shall stop it.
fn passes(arguments: &RenderArguments, scene: &Scene) -> Range<u64> {
    if let Some(range) = &arguments.passes {
        return range.clone();
    }
    let is_open = arguments.time.is_some() || arguments.error.is_some();
    match arguments.spp {
        Some(spp) => 0..spp,
        None if is_open => 0..1 << 24,
        None => 0..u64::from(scene.sampler.samples_per_pixel),
    }
}

const FORMATS: [&str; 5] = ["exr", "png", "ppm", "pfm", "hdr"];

/// Where results go; folders that do not exist and unknown formats are found before hours of work.
fn outputs(arguments: &RenderArguments, scene: &Scene) -> Result<Vec<PathBuf>> {
    let outputs = if arguments.outputs.is_empty() {
        let name = Path::new(&scene.film.filename).file_name();
        vec![name.map_or_else(|| PathBuf::from("etendue.exr"), PathBuf::from)]
    } else {
        arguments.outputs.clone()
    };
    for path in &outputs {
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_lowercase();
        if !FORMATS.contains(&extension.as_str()) {
            let message = format!("{}: images are written as .{}", path.display(), FORMATS.join(", ."));
            return Err(Failure::Usage(message));
        }
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
        if let Some(folder) = folder
            && !folder.is_dir()
        {
            return Err(Failure::Usage(format!("{}: there is no folder of that name", folder.display())));
        }
    }
    Ok(outputs)
}

fn resume(job: &mut Job) -> Result<()> {
    let Some(plan) = &job.checkpoint else { return Ok(()) };
    let path = plan.path.display();
    if !plan.path.exists() {
        report::note(&format!("{path} does not exist yet; starting from the beginning"));
        return Ok(());
    }
    let checkpoint = read_checkpoint(&plan.path)
        .map_err(|error| Failure::Usage(format!("cannot resume from {path}: {error}")))?;
    let refuse = |reason: &str| Err(Failure::Usage(format!("cannot resume from {path}: {reason}")));
    if checkpoint.fingerprint != plan.fingerprint {
        return refuse("it belongs to another scene, resolution, integrator or set of layers");
    }
    if checkpoint.seed != plan.seed {
        return refuse(&format!("it was rendered with seed {}, not {}", checkpoint.seed, plan.seed));
    }
    if job.film.sums_mut().restore(&checkpoint.sums, &checkpoint.passes).is_err() {
        return refuse("it does not fit this film");
    }
    if job.integrator.load(&checkpoint.state).is_err() {
        return refuse("its state belongs to another integrator");
    }
    Ok(())
}

fn write_outputs(arguments: &RenderArguments, job: &Job) -> Result<()> {
    let mut image = job.film.develop();
    let name = arguments.scene.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    image.metadata = metadata::describe(&job.scene, &job.film, job.fingerprint, &name);
    if arguments.passes.is_some() && job.film.n_passes() > 0 {
        image.channels.extend(job.film.sums().exact_channels());
    }
    write_all(&job.outputs, &image)
}

/// Writes an image to several files; all are tried before the first failure is reported.
pub(crate) fn write_all(outputs: &[PathBuf], image: &Image) -> Result<()> {
    let failures: Vec<String> = outputs
        .iter()
        .filter_map(|path| write_image(path, image).err())
        .map(|error| error.to_string())
        .collect();
    if failures.is_empty() { Ok(()) } else { Err(Failure::Running(failures.join("\n"))) }
}

fn report_faults(film: &Film) {
    let faults = film.sums().faults;
    if faults.invalid > 0 {
        let [x, y] = faults.first_pixel.unwrap_or_default();
        report::warning(&format!(
            "{} samples had NaN, infinite or negative radiance, first at pixel {x}, {y}; they count as black",
            faults.invalid
        ));
    }
    if faults.saturated > 0 {
        report::warning(&format!(
            "{} samples were too bright for the film and are cut off",
            faults.saturated
        ));
    }
}

fn finish_statistics(
    arguments: &RenderArguments,
    job: &Job,
    watch: &Watch,
    started: Instant,
    seconds_build: f64,
) -> Result<()> {
    let relative_error = job.film.relative_error();
    let mut statistics = Statistics {
        version: env!("CARGO_PKG_VERSION"),
        integrator: job.scene.integrator.type_name.clone(),
        seconds_total: 0.0,
        seconds_build,
        seconds_render: watch.elapsed().as_secs_f64(),
        cpu_seconds: 0.0,
        passes: job.film.n_passes(),
        spp: job.film.n_passes(),
        samples: watch.n_samples(),
        rays: 0,
        shadow_rays: 0,
        photons_stored: 0,
        peak_memory_bytes: 0,
        threads: rayon::current_num_threads(),
        nan_samples: job.film.sums().faults.invalid,
        saturated_samples: job.film.sums().faults.saturated,
        relative_error: relative_error.is_finite().then_some(relative_error),
    };
    statistics.measure_process(watch.rays());
    statistics.seconds_total = started.elapsed().as_secs_f64();
    if !arguments.quiet {
        let names: Vec<String> = job.outputs.iter().map(|p| p.display().to_string()).collect();
        report::note(&format!(
            "{}: {} samples per pixel in {:.1} s ({:.2} M samples/s)",
            names.join(", "),
            statistics.spp,
            statistics.seconds_render,
            statistics.samples as f64 / statistics.seconds_render.max(1e-9) / 1e6
        ));
    }
    match &arguments.stats {
        Some(path) => statistics.write(path),
        None => Ok(()),
    }
}
