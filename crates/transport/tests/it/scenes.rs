//! The scenes of the repository: they render, and show what they are for.

use std::path::Path;

use etendue_io::{load_assets, read_pbrt};
use etendue_scene::document::Value;
use etendue_scene::{Film, Scene};

use crate::support::{channel, luminance, render_passes};

/// A scene of the repository at another size, with parameters of the integrator in addition.
pub(crate) fn scene(name: &str, size: [i32; 2], parameter: Option<(&'static str, Value)>) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name);
    let (mut document, problems) = read_pbrt(&path);
    assert!(!problems.has_errors(), "{name}: {problems:?}");
    let film = document.film.as_mut().expect("a film");
    film.parameters.retain(|p| !p.name.ends_with("resolution"));
    *film = film.clone().with("xresolution", Value::Integers(vec![size[0]]));
    *film = film.clone().with("yresolution", Value::Integers(vec![size[1]]));
    if let Some((parameter, value)) = parameter {
        let integrator = document.integrator.as_mut().expect("an integrator");
        *integrator = integrator.clone().with(parameter, value);
    }
    let (assets, problems) = load_assets(&document);
    assert!(!problems.has_errors(), "{name}: {problems:?}");
    let (scene, problems) = Scene::build(&document, assets);
    assert!(!problems.has_errors(), "{name}: {problems:?}");
    scene.expect("a scene")
}

/// SCENE-18, SCENE-40: all of them show something.
#[test]
fn scenes_of_the_repository_render() {
    for name in
        ["balls.pbrt", "box.pbrt", "cornell.pbrt", "cylinder.pbrt", "extensions.pbrt", "soft-shadow.pbrt"]
    {
        let film = render_passes(&scene(name, [32, 24], None), 0..4);
        assert!(luminance(&film).iter().filter(|value| **value > 0.0).count() > 400, "{name} is dark");
    }
}

/// Means of red, green and blue over the columns of a prism's picture.
fn columns(film: &Film) -> [Vec<f64>; 3] {
    let image = film.develop();
    let width = image.width;
    ["R", "G", "B"].map(|name| {
        let values = channel(&image, name);
        (0..width).map(|x| values.iter().skip(x).step_by(width).sum::<f64>()).collect()
    })
}

/// The column of the largest value.
fn peak(columns: &[f64]) -> usize {
    (0..columns.len()).max_by(|a, b| columns[*a].total_cmp(&columns[*b])).expect("columns")
}

/// SCENE-17, EXP-35: wavelengths draw a white lamp out into a spectrum, blue bent most; three bands into three lamps with
/// darkness between them.
#[test]
fn a_prism_shows_a_spectrum_or_three_lamps() {
    let size = [120, 40];
    let [red, green, blue] = columns(&render_passes(&scene("prism.pbrt", size, None), 0..64));
    let (r, g, b) = (peak(&red), peak(&green), peak(&blue));
    assert!(b + 5 < g && g + 5 < r, "blue {b}, green {g}, red {r}");
    let light = |x: usize, of: &[Vec<f64>; 3]| of.iter().map(|channel| channel[x].max(0.0)).sum::<f64>();
    let spectrum = [red, green, blue];
    assert!((b..r).all(|x| light(x, &spectrum) > 0.0), "no gaps in the spectrum");
    let bands = Some(("wavelengths", Value::Strings(vec!["bands".to_owned()])));
    let lamps = columns(&render_passes(&scene("prism.pbrt", size, bands), 0..16));
    let (r, g, b) = (peak(&lamps[0]), peak(&lamps[1]), peak(&lamps[2]));
    assert!(b + 5 < g && g + 5 < r, "blue {b}, green {g}, red {r}");
    for (from, to) in [(b, g), (g, r)] {
        let middle = usize::midpoint(from, to);
        assert!(light(middle, &lamps) < 0.01 * light(from, &lamps), "light between the lamps at {middle}");
    }
}
