//! `etendue render`.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use etendue::io::checkpoint::read_checkpoint;
use etendue::scene::{Film, Scene};
use etendue::transport::lpe::PathExpressions;
use etendue::transport::{Integrator, Outcome, Passes, Stop, method_name, render, with_own_layers};

use crate::args::{RenderArguments, WavelengthArgument};
use crate::failure::{Failure, Result};
use crate::load::{LoadedScene, Overrides, fingerprint, integrator_entity, load};
use crate::progress::{CheckpointPlan, ShowProgress, Watch, catch_interruption, is_interrupted};
use crate::stats::{RenderClock, RenderTime, Statistics};
use crate::threads::with_threads;
use crate::{denoise, metadata, outputs, preview, report, stats};

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
    with_threads(arguments.threads, || run_in_pool(arguments, started))
}

fn run_in_pool(arguments: &RenderArguments, started: Instant) -> Result<()> {
    let mut job = prepare(arguments)?;
    if arguments.resume {
        resume(&mut job, arguments.quiet)?;
    }
    if job.integrator.passes() == Passes::Sequential
        && job.film.sums().n_missing(&(0..job.stop.passes.start)) > 0
    {
        return Err(Failure::Usage(format!(
            "--passes {}..{}: each pass of this method depends on those before, so that it cannot be split over machines; render from 0, or --resume from a checkpoint",
            job.stop.passes.start, job.stop.passes.end
        )));
    }
    let seconds_build = started.elapsed().as_secs_f64();

    catch_interruption();
    let show = if arguments.quiet || arguments.no_progress { ShowProgress::No } else { ShowProgress::Yes };
    let clock = RenderClock::start();
    let watch = Watch::new(&job.film, &job.stop, arguments.time, job.checkpoint.clone(), show);
    let outcome = render(&job.scene, job.integrator.as_mut(), &mut job.film, &job.stop, &watch);
    let time = clock.elapsed();
    if outcome == Outcome::Stopped && watch.n_samples() == 0 && job.film.n_passes() == 0 {
        watch.clear();
        let names: Vec<String> = job.outputs.iter().map(|path| path.display().to_string()).collect();
        // A picture of nothing would take the place of an older one.
        return Err(if is_interrupted() {
            Failure::InterruptedEarly
        } else {
            let message = "nothing was rendered in the time given; allow more";
            Failure::Running(format!("{}: {message}", names.join(", ")))
        });
    }
    watch.finish(&job.film, job.integrator.as_ref());

    // A failure of one file keeps none of the others from being written.
    let written = write_outputs(arguments, &job);
    let statistics = statistics(&job, &watch, started, seconds_build, &time);
    let noted = arguments.stats.as_ref().map_or(Ok(()), |path| statistics.write(path));
    if !arguments.quiet {
        report_faults(&job.film);
        job.integrator.report().iter().filter_map(|e| e.advice.as_deref()).for_each(report::warning);
    }
    written?;
    if !arguments.quiet {
        report_end(&job, &statistics);
    }
    noted?;
    if outcome == Outcome::Stopped && is_interrupted() { Err(Failure::Interrupted) } else { Ok(()) }
}

/// Checks first what costs nothing, so that slips show at once, then reads and builds the scene.
fn prepare(arguments: &RenderArguments) -> Result<Job> {
    let overrides = Overrides {
        resolution: arguments.resolution,
        crop: arguments.crop,
        features: arguments.features || arguments.denoise.is_some(),
        integrator: arguments.integrator.as_deref().map(integrator_entity).transpose()?,
        wavelengths: arguments.wavelengths.map(|w| match w {
            WavelengthArgument::Hero => "hero",
            WavelengthArgument::Single => "single",
            WavelengthArgument::Bands => "bands",
        }),
    };
    let layers = layers(arguments);
    let expressions = PathExpressions::new(&layers).map_err(|error| Failure::Usage(error.to_string()))?;
    outputs::check_images(&arguments.outputs)?;
    outputs::check_images(arguments.denoise.as_slice())?;
    let others = || arguments.checkpoint.iter().chain(&arguments.stats).chain(&arguments.denoise);
    for path in others() {
        outputs::check_file(path)?;
    }
    outputs::check_distinct(std::iter::once(&arguments.scene).chain(&arguments.outputs).chain(others()))?;

    let LoadedScene { document, mut scene, integrator, .. } =
        load(&arguments.scene, &overrides, expressions.clone(), arguments.quiet)?;
    let names = with_own_layers(&scene.integrator, expressions).names().to_vec();
    if let Some(seed) = arguments.seed {
        scene.sampler.seed = seed;
    }
    let fingerprint = fingerprint(&document, &layers);
    let film = Film::new(scene.film.clone(), names);
    let outputs = outputs(arguments, &scene)?;
    // The film's own name is known only now.
    outputs::check_distinct(std::iter::once(&arguments.scene).chain(&outputs).chain(others()))?;
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

/// Where results go: as asked for, or by the film's name into the current folder.
fn outputs(arguments: &RenderArguments, scene: &Scene) -> Result<Vec<PathBuf>> {
    if !arguments.outputs.is_empty() {
        return Ok(arguments.outputs.clone());
    }
    let name = Path::new(&scene.film.filename).file_name();
    let mut path = name.map_or_else(|| PathBuf::from("etendue.exr"), PathBuf::from);
    if !outputs::is_image_name(&path) {
        let wish = path.display().to_string();
        path.set_extension("exr");
        if !arguments.quiet {
            report::warning(&format!("images of the type of {wish} are not written; see {}", path.display()));
        }
    }
    outputs::check_images(std::slice::from_ref(&path))?;
    Ok(vec![path])
}

fn resume(job: &mut Job, quiet: bool) -> Result<()> {
    let Some(plan) = &job.checkpoint else { return Ok(()) };
    let path = plan.path.display();
    if !plan.path.exists() {
        if !quiet {
            report::note(&format!("{path} does not exist yet; starting from the beginning"));
        }
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
    // Tiles of a pass that was not completed belong to no pass, so that nothing can be added to them.
    if arguments.passes.is_some() && job.film.n_passes() > 0 {
        image.channels.extend(job.film.sums().exact_channels());
    }
    if let Some(wish) = arguments.preview {
        preview::show_radiance(&image, wish);
    }
    let paths: Vec<PathBuf> = job.outputs.iter().chain(&arguments.denoise).cloned().collect();
    let exr = outputs::exr_settings(arguments.exr, &paths);
    outputs::write_precious(&job.outputs, &image, exr)?;
    match &arguments.denoise {
        Some(path) => denoise::after_render(&image, path, exr, arguments.quiet),
        None => Ok(()),
    }
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

fn statistics(
    job: &Job,
    watch: &Watch,
    started: Instant,
    seconds_build: f64,
    time: &RenderTime,
) -> Statistics {
    let rays = watch.rays();
    let relative_error = job.film.relative_error();
    let report = job.integrator.report();
    Statistics {
        version: env!("CARGO_PKG_VERSION"),
        integrator: method_name(&job.scene.integrator.type_name),
        seconds_total: started.elapsed().as_secs_f64(),
        seconds_build,
        seconds_render: time.wall.as_secs_f64(),
        cpu_seconds: stats::cpu_time().map_or(0.0, |time| time.as_secs_f64()),
        thread_cpu_seconds: time.threads.iter().map(Duration::as_secs_f64).collect(),
        busy_share: time.busy_share(),
        passes: job.film.n_passes(),
        spp: job.film.n_passes(),
        samples: watch.n_samples(),
        interpolated_samples: rays.interpolated,
        rays: rays.closest,
        shadow_rays: rays.shadow,
        photons_stored: report.iter().find(|e| e.name == "photons_stored").map_or(0, |e| e.value as u64),
        peak_memory_bytes: stats::peak_memory().unwrap_or(0),
        threads: rayon::current_num_threads(),
        nan_samples: job.film.sums().faults.invalid,
        saturated_samples: job.film.sums().faults.saturated,
        relative_error: relative_error.is_finite().then_some(relative_error),
        report: report.into_iter().map(Into::into).collect(),
    }
}

fn report_end(job: &Job, statistics: &Statistics) {
    let names: Vec<String> = job.outputs.iter().map(|p| p.display().to_string()).collect();
    report::note(&format!(
        "{}: {} {} per pixel in {:.1} s ({:.2} M samples/s)",
        names.join(", "),
        statistics.spp,
        if statistics.spp == 1 { "sample" } else { "samples" },
        statistics.seconds_render,
        statistics.samples as f64 / statistics.seconds_render.max(1e-9) / 1e6
    ));
}
