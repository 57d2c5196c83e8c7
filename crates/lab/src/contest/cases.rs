//! The contests of the notebook.

use super::{Contest, ContestSettings, Way};
use crate::scenes::StudyScene;

fn path(max_depth: u32, n_samples: u32) -> Way {
    Way {
        name: "path".to_owned(),
        integrator: format!("\"path\" \"integer maxdepth\" {max_depth}"),
        n_samples,
        is_unbiased: true,
    }
}

fn biased(name: &str, integrator: &str, n_samples: u32) -> Way {
    Way { name: name.to_owned(), integrator: integrator.to_owned(), n_samples, is_unbiased: false }
}

/// EXP-4: the caustic of a glass ball on a table by 100,000 photons, beside path tracing, for lamps of three sizes. Only the
/// caustic counts.
#[must_use]
pub fn caustic(settings: &ContestSettings) -> Vec<Contest> {
    let photons = settings.count(100_000);
    let lamps = ["0.12", "0.03", "0.01"];
    lamps
        .map(|radius| Contest {
            name: format!("lamp of radius {radius} m"),
            scene: StudyScene::generated("wood-ball", &[("lamp-radius", radius), ("pixels", "128")])
                .with_resolution([settings.width, settings.width * 3 / 4]),
            paths: Some("LS+DE"),
            // What a light sends through the ball the camera sees where it arrives: without bias, and for small lamps with little noise.
            reference: Way {
                name: "light".to_owned(),
                integrator: "\"light\" \"integer maxdepth\" 12".to_owned(),
                n_samples: 4 * settings.reference_samples,
                is_unbiased: true,
            },
            ways: vec![
                biased(
                    "photons",
                    &format!(
                        "\"photons\" \"string show\" \"caustics\" \"integer photons\" {photons} \"integer nearest\" 60"
                    ),
                    4,
                ),
                path(12, 4 * settings.n_samples),
                Way {
                    name: "light tracing".to_owned(),
                    integrator: "\"light\" \"integer maxdepth\" 12".to_owned(),
                    n_samples: settings.n_samples / 4,
                    is_unbiased: true,
                },
            ],
        })
        .into()
}

/// The standard box, against long paths.
fn standard_box(name: &str, settings: &ContestSettings, ways: Vec<Way>) -> Contest {
    Contest {
        name: name.to_owned(),
        scene: StudyScene::standard_box().with_resolution([settings.width; 2]),
        paths: None,
        reference: path(64, settings.reference_samples),
        ways,
    }
}

/// EXP-5 and EXP-7: the standard box by photons that are seen directly, few and many, and with direct light by rays; beside
/// recursive ray tracing.
#[must_use]
pub fn seen_directly(settings: &ContestSettings) -> Vec<Contest> {
    let photons = |show: &str, n: u32, k: u32| {
        let integrator = format!(
            "\"photons\" \"string show\" \"{show}\" \"integer photons\" {} \"integer nearest\" {k}",
            settings.count(n)
        );
        let by_rays = if show == "all" { "" } else { ", direct by rays" };
        biased(&format!("{n} photons, {k} nearest{by_rays}"), &integrator, 4)
    };
    let ways = vec![
        biased("whitted", "\"whitted\" \"integer maxdepth\" 12", 4),
        photons("all", 200, 50),
        photons("all", 10_000, 100),
        photons("all", 500_000, 500),
        photons("shadowrays", 10_000, 50),
        photons("shadowrays", 500_000, 500),
        path(64, settings.n_samples),
    ];
    vec![standard_box("box", settings, ways)]
}

/// EXP-12: two passes beside path tracing, in the standard box and before a wine glass, whose caustic is also seen through glass.
#[must_use]
pub fn two_passes(settings: &ContestSettings) -> Vec<Contest> {
    let photons = |n: u32| {
        let n = settings.count(n);
        format!("\"photonmap\" \"integer globalphotons\" {n} \"integer causticphotons\" {n}")
    };
    let few = settings.n_samples / 2;
    let ways = |max_depth: u32| {
        vec![
            biased("photonmap", &photons(200_000), few),
            biased("photonmap, a tenth of the photons", &photons(20_000), few),
            path(max_depth, settings.n_samples),
        ]
    };
    let glass = Contest {
        name: "wineglass".to_owned(),
        scene: StudyScene::generated("wineglass", &[])
            .with_resolution([settings.width, settings.width * 3 / 4]),
        paths: None,
        reference: path(24, 8 * settings.reference_samples),
        ways: ways(24),
    };
    vec![standard_box("box", settings, ways(64)), glass]
}
