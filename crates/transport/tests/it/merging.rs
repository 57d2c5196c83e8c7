//! Renders of different seeds, merged (SPEC PAR-3, EXP-32).

use etendue_math::statistics::Moments;

use crate::radiometry::{DOWN, floor_means, strip_irradiance, strip_light_and_edge};
use crate::support::{Setup, expect_agreement, expect_near, flat, luminance, pixel_moments, render_passes};

/// K merged renders have 1 / K of the variance of one: the error falls by the root of K.
#[test]
fn merged_renders_are_as_good_as_one_long_one() {
    let world = format!(
        "Material \"diffuse\" {} Shape \"bilinearmesh\" \"point3 P\" [-9 -9 0  9 -9 0  -9 9 0  9 9 0] {}",
        flat("reflectance", 1.0),
        strip_light_and_edge()
    );
    let setup = Setup {
        size: [48, 48],
        integrator: "\"integer maxdepth\" 1",
        camera: DOWN,
        world: &world,
        ..Setup::default()
    };
    let scene = setup.scene("merging");
    let n_renders = 16;
    let errors = |film: &etendue_scene::Film, factor: f64| -> Moments {
        let expected = floor_means(film, |x, y| strip_irradiance(x, y) / std::f64::consts::PI);
        luminance(film).iter().zip(expected).map(|(v, e)| factor * (v - e) * (v - e)).collect()
    };
    let (mut single, mut merged) = (Moments::new(), None);
    for render in 0..n_renders {
        let mut scene = setup.scene(&format!("merging {render}"));
        scene.sampler.samples_per_pixel = 4;
        let film = render_passes(&scene, 0..4);
        single.merge(&errors(&film, 1.0));
        merged = Some(match merged {
            None => film,
            Some(mut merged) => {
                let merged_film: &mut etendue_scene::Film = &mut merged;
                merged_film.sums_mut().merge_independent(film.sums()).expect("the same film");
                merged
            }
        });
    }
    let merged = merged.expect("at least one");
    assert_eq!(merged.n_passes(), 4 * n_renders);
    expect_agreement("K merged renders", &errors(&merged, n_renders as f64), &single, 0.6);
    let long = render_passes(&scene, 0..4 * n_renders);
    expect_agreement("one long render", &errors(&long, n_renders as f64), &single, 0.6);
    let (a, b) = (pixel_moments(&merged), pixel_moments(&long));
    expect_near("means", a.mean(), b.mean(), 0.02);
}
