//! `etendue study`: experiments with the renderer, as a table and a figure.

use std::fs;
use std::path::Path;

use etendue::lab::contest::{
    Contest, ContestSettings, caustic, contest, photon_counts, seen_directly, two_passes,
};
use etendue::lab::estimates::{
    ConsistencySettings, CurveStudy, EdgeSettings, GatheringSettings, HandleSettings, WallSettings,
    consistency, edge, gathering, handle, walls,
};
use etendue::lab::{
    AcceleratorSettings, ConvergenceSettings, EmissionStudySettings, LightSizeSettings, NeighbourSettings,
    PixelSettings, SceneSizeSettings, accelerators, convergence, light_size, neighbours, photon_emission,
    pixel, scene_size,
};

use crate::args::{StudyArguments, StudyName};
use crate::failure::{Failure, Result};
use crate::report;
use crate::stats::thread_time;

/// Runs the command.
pub(crate) fn run(arguments: &StudyArguments) -> Result<()> {
    // Before the work, so that it is not in vain.
    fs::create_dir_all(&arguments.out).map_err(|error| {
        Failure::Running(format!("cannot make the folder {}: {error}", arguments.out.display()))
    })?;
    let (name, csv, svg, summary) = measure(arguments)?;
    report::note(summary.trim_end());
    write(&arguments.out, &format!("{name}.csv"), &csv)?;
    write(&arguments.out, &format!("{name}.svg"), &svg)
}

/// Name, table, figure and summary of a study.
fn measure(arguments: &StudyArguments) -> Result<(&'static str, String, String, String)> {
    let (quick, seed) = (arguments.quick, arguments.seed);
    let mut note = |what: &str| report::note(what);
    Ok(match arguments.name {
        StudyName::Convergence => {
            let settings =
                if quick { ConvergenceSettings::quick(seed) } else { ConvergenceSettings::full(seed) };
            let study = convergence(&settings, &mut note);
            ("convergence", study.csv(), study.svg(), study.summary())
        }
        StudyName::Pixel => {
            let settings = if quick { PixelSettings::quick(seed) } else { PixelSettings::full(seed) };
            let study = pixel(&settings);
            ("pixel", study.csv(), study.svg(), study.summary())
        }
        StudyName::SceneSize => {
            let settings = if quick { SceneSizeSettings::quick() } else { SceneSizeSettings::full() };
            let study =
                in_one_thread(|| scene_size(&settings, &thread_time, &mut |what| report::note(what)))?;
            ("scene-size", study.csv(), study.svg(), study.summary())
        }
        StudyName::Accelerators => {
            let settings = if quick { AcceleratorSettings::quick() } else { AcceleratorSettings::full() };
            let study =
                in_one_thread(|| accelerators(&settings, &thread_time, &mut |what| report::note(what)))?;
            ("accelerators", study.csv(), study.svg(), study.summary())
        }
        StudyName::LightSize => {
            let settings = if quick { LightSizeSettings::quick(seed) } else { LightSizeSettings::full(seed) };
            let study = light_size(&settings, &mut note);
            ("light-size", study.csv(), study.svg(), study.summary())
        }
        StudyName::EstimateConsistency => {
            let settings =
                if quick { ConsistencySettings::quick(seed) } else { ConsistencySettings::full(seed) };
            curves("estimate-consistency", consistency(&settings))
        }
        StudyName::EstimateEdge => {
            let settings = if quick { EdgeSettings::quick(seed) } else { EdgeSettings::full(seed) };
            curves("estimate-edge", edge(&settings))
        }
        StudyName::EstimateWalls => {
            let settings = if quick { WallSettings::quick(seed) } else { WallSettings::full(seed) };
            curves("estimate-walls", walls(&settings))
        }
        StudyName::EstimateHistogram => {
            let settings = if quick { HandleSettings::quick(seed) } else { HandleSettings::full(seed) };
            curves("estimate-histogram", handle(&settings))
        }
        StudyName::Gathering => {
            let settings = if quick { GatheringSettings::quick(seed) } else { GatheringSettings::full(seed) };
            curves("gathering", gathering(&settings, &mut note))
        }
        StudyName::PhotonEmission => {
            let settings =
                if quick { EmissionStudySettings::quick(seed) } else { EmissionStudySettings::full(seed) };
            let study = photon_emission(&settings, &mut note);
            ("photon-emission", study.csv(), study.svg(), study.summary())
        }
        StudyName::PhotonCaustic => contests("photon-caustic", caustic, arguments)?,
        StudyName::PhotonView => contests("photon-view", seen_directly, arguments)?,
        StudyName::PhotonPasses => contests("photon-passes", two_passes, arguments)?,
        StudyName::PhotonCounts => {
            let (settings, levels) = (contest_settings(arguments), if quick { 6 } else { 8 });
            let study = in_one_thread(|| {
                photon_counts(&settings, levels, &thread_time, &mut |what| report::note(what))
            })?;
            ("photon-counts", study.csv(), study.svg(), study.summary())
        }
        StudyName::Neighbours => {
            let settings = if quick { NeighbourSettings::quick(seed) } else { NeighbourSettings::full(seed) };
            let study =
                in_one_thread(|| neighbours(&settings, &thread_time, &mut |what| report::note(what)))?;
            ("neighbours", study.csv(), study.svg(), study.summary())
        }
    })
}

fn curves(name: &'static str, study: CurveStudy) -> (&'static str, String, String, String) {
    (name, study.csv(), study.svg(), study.summary)
}

fn contest_settings(arguments: &StudyArguments) -> ContestSettings {
    if arguments.quick {
        ContestSettings::quick(arguments.seed)
    } else {
        ContestSettings::full(arguments.seed)
    }
}

/// Runs methods beside each other.
fn contests(
    name: &'static str,
    of: fn(&ContestSettings) -> Vec<Contest>,
    arguments: &StudyArguments,
) -> Result<(&'static str, String, String, String)> {
    let settings = contest_settings(arguments);
    let study =
        in_one_thread(|| contest(&of(&settings), &settings, &thread_time, &mut |what| report::note(what)))?;
    Ok((name, study.csv(), study.svg(), study.summary()))
}

/// Runs a study in one thread, whose processor time is then that of all the work.
fn in_one_thread<T: Send>(run: impl FnOnce() -> T + Send) -> Result<T> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.map_err(|error| Failure::Running(format!("cannot start a thread: {error}")))?;
    Ok(pool.install(run))
}

fn write(folder: &Path, name: &str, text: &str) -> Result<()> {
    let path = folder.join(name);
    fs::write(&path, text)
        .map_err(|error| Failure::Running(format!("cannot write {}: {error}", path.display())))?;
    report::note(&path.display().to_string());
    Ok(())
}
