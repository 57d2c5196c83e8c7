//! The walk of photons against closed forms (SPEC PHT-1, PHT-4, PHT-6).

use etendue_math::statistics::Moments;
use etendue_scene::Scene;
use etendue_transport::photon::{Onward, PhotonEmitter, PhotonVertex, PhotonWalk, trace_photons};

use crate::support::{Setup, expect_mean, flat, lit};

const N: u64 = 20_000;

/// Mean over the photons of what `value` gives for their places.
fn mean_over_photons(scene: &Scene, value: impl Fn(&PhotonVertex<'_>) -> f64 + Sync) -> Moments {
    let emitter = PhotonEmitter::new(scene);
    let (values, _) = trace_photons(scene, &emitter, 0..N, &PhotonWalk::default(), |index, vertex, found| {
        found.push((index, value(vertex)));
        Onward::Continue
    });
    let mut sums = vec![0.0; N as usize];
    for (index, value) in values {
        sums[index as usize] += value;
    }
    sums.into_iter().collect()
}

/// A lamp in a closed room of reflectance a: all of its flux arrives, and 1 / (1 - a) of it in all.
#[test]
fn all_flux_arrives() {
    let albedo = 0.6;
    let world = format!(
        "AttributeBegin Material \"diffuse\" {} AreaLightSource \"diffuse\" {} Shape \"sphere\" \"float radius\" 0.2 AttributeEnd
        Material \"diffuse\" {} ReverseOrientation Shape \"sphere\" \"float radius\" 2",
        flat("reflectance", 0.0),
        lit("L", 3.0),
        flat("reflectance", albedo),
    );
    let scene = Setup { world: &world, ..Setup::default() }.scene("all flux arrives");
    let power = 3.0 * std::f64::consts::PI * (4.0 * std::f64::consts::PI * 0.04);
    let direct =
        mean_over_photons(
            &scene,
            |vertex| if vertex.trail.is_empty() { lumens(&scene, vertex) } else { 0.0 },
        );
    expect_mean("first hits", &direct, power, 0.01);
    let all = mean_over_photons(&scene, |vertex| lumens(&scene, vertex));
    // A photon that comes back to the lamp is absorbed there.
    let seen = 0.01; // of all that the wall sends, by (0.2 / 2)^2
    expect_mean("all hits", &all, power / (1.0 - albedo * (1.0 - seen)) * (1.0 + albedo * seen), 0.04);
}

/// What arrives with a photon, in lumen.
fn lumens(scene: &Scene, vertex: &PhotonVertex<'_>) -> f64 {
    let rgb = scene.film.output_rgb(vertex.flux, vertex.lambda);
    rgb.iter().zip(scene.film.luminance_weights()).map(|(value, weight)| f64::from(value * weight)).sum()
}
