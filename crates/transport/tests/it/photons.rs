//! The walk of photons against closed forms (SPEC PHT-1 to PHT-10).

use etendue_math::statistics::Moments;
use etendue_scene::Scene;
use etendue_scene::bsdf::Lobes;
use etendue_transport::photon::{
    Absorption, Onward, PhotonEmitter, PhotonPattern, PhotonVertex, PhotonWalk, Trail, trace_photons,
};

use crate::support::{Setup, expect_mean, expect_near, flat, lit};

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

/// True at matte surfaces, also at black ones, which have no lobe.
fn is_wall(vertex: &PhotonVertex<'_>) -> bool {
    !vertex.bsdf.lobes().is_specular()
}

/// All places of photons: number, word, luminous flux, and whether maps are for the surface.
fn places(scene: &Scene, walk: &PhotonWalk, n: u64) -> Vec<(u64, Trail, f64, bool)> {
    let emitter = PhotonEmitter::new(scene);
    trace_photons(scene, &emitter, 0..n, walk, |index, vertex, found| {
        found.push((index, vertex.trail, lumens(scene, vertex), vertex.is_stored()));
        Onward::Continue
    })
    .0
}

/// A lamp in a closed room of grey matte walls with a mirror on the floor.
fn room(name: &str, albedo: f64) -> Scene {
    let world = format!(
        "LightSource \"point\" {} AttributeBegin Translate 0 -1 0 Material \"conductor\" Shape \"sphere\" \"float radius\" 0.3 AttributeEnd
        Material \"diffuse\" {} Shape \"sphere\" \"float radius\" 2",
        lit("I", 1.0),
        flat("reflectance", albedo)
    );
    Setup { world: &world, ..Setup::default() }.scene(name)
}

/// PHT-4, PHT-6: between grey walls roulette keeps the flux of every photon, and as many go on as is reflected; without it all go
/// on with what is left.
#[test]
fn roulette_keeps_flux_and_scaling_keeps_photons() {
    let scene = room("roulette", 0.5);
    let walk = PhotonWalk { sampler: scene.sampler, ..PhotonWalk::default() };
    let is_matte = |trail: Trail| trail.events().all(|event| event == etendue_transport::lpe::Event::Diffuse);
    let matte = |walk: &PhotonWalk, n: usize| -> Vec<f64> {
        let all = places(&scene, walk, N);
        all.iter()
            .filter(|(_, trail, _, stored)| *stored && trail.len() == n && is_matte(*trail))
            .map(|p| p.2)
            .collect()
    };
    let (first, second) = (matte(&walk, 0), matte(&walk, 1));
    // Half of those at walls go on, and nearly all of them to walls again.
    let met = 1.0 - 0.5 * (1.0 - (1.0 - 0.09_f64).sqrt());
    assert!((second.len() as f64 / (0.5 * first.len() as f64) - met).abs() < 0.05);
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    expect_near("flux by roulette", mean(&second), mean(&first), 0.02);
    let scaled = PhotonWalk { absorption: Absorption::Scale, max_depth: 4, ..walk };
    let (first, second) = (matte(&scaled, 0), matte(&scaled, 1));
    assert!((second.len() as f64 / first.len() as f64 - met).abs() < 0.05);
    expect_near("flux by scaling", mean(&second), 0.5 * mean(&first), 0.02);
}

/// All ways to treat absorption bring the same flux to each depth, PHT-9: branching in up to 2^8 photons.
#[test]
fn absorption_is_the_same_in_the_mean() {
    let world = format!(
        "LightSource \"point\" {} Material \"smoothcoat\" {} Shape \"sphere\" \"float radius\" 2",
        lit("I", 1.0),
        flat("reflectance", 0.6)
    );
    let scene = Setup { world: &world, ..Setup::default() }.scene("absorption");
    let by_depth = |absorption: Absorption, n: u64| {
        let walk = PhotonWalk { absorption, max_depth: 8, sampler: scene.sampler, ..PhotonWalk::default() };
        let found = places(&scene, &walk, n);
        let mut flux = [0.0; 9];
        found.iter().for_each(|(_, trail, value, _)| flux[trail.len()] += value / n as f64);
        (flux, found.iter().filter(|(_, trail, ..)| trail.len() == 8).count())
    };
    let (roulette, _) = by_depth(Absorption::Roulette, N);
    let (scale, _) = by_depth(Absorption::Scale, 4000);
    let (branch, n_last) = by_depth(Absorption::Branch, 200);
    for depth in 0..=4 {
        expect_near("scaling", scale[depth], roulette[depth], 0.06);
        expect_near("branching", branch[depth], roulette[depth], 0.06);
    }
    assert_eq!(n_last, 200 * 256);
}

/// PHT-8: a coloured wall tints what it sends on, and the flux at every depth is the product of the reflectances, per wavelength.
#[test]
fn colours_are_right_in_the_mean() {
    let world = format!(
        "LightSource \"point\" {} Material \"diffuse\" \"rgb reflectance\" [0.8 0.3 0.1] Shape \"sphere\" \"float radius\" 2",
        lit("I", 1.0)
    );
    let scene = Setup { world: &world, ..Setup::default() }.scene("colours");
    let walk = PhotonWalk { sampler: scene.sampler, max_depth: 2, ..PhotonWalk::default() };
    let sum = |absorption: Absorption| {
        let walk = PhotonWalk { absorption, ..walk };
        let emitter = PhotonEmitter::new(&scene);
        let (found, _) = trace_photons(&scene, &emitter, 0..N, &walk, |_, vertex, found| {
            found.push((vertex.trail.len(), scene.film.output_rgb(vertex.flux, vertex.lambda)));
            Onward::Continue
        });
        let mut sums = [[0.0; 3]; 3];
        for (depth, rgb) in found {
            (0..3).for_each(|c| sums[depth][c] += f64::from(rgb[c]) / N as f64);
        }
        sums
    };
    let (roulette, scale) = (sum(Absorption::Roulette), sum(Absorption::Scale));
    for depth in 0..3 {
        for c in 0..3 {
            let error = 0.03 * scale[depth][0];
            assert!(
                (roulette[depth][c] - scale[depth][c]).abs() < error,
                "{depth} {c} {roulette:?} {scale:?}"
            );
        }
    }
}

/// PHT-10: nothing is kept on mirrors and clear glass, everything on matte walls, also where it is then absorbed.
#[test]
fn maps_are_for_surfaces_that_scatter_widely() {
    let scene = room("stored", 0.5);
    let emitter = PhotonEmitter::new(&scene);
    let (found, _) = trace_photons(&scene, &emitter, 0..4000, &PhotonWalk::default(), |_, vertex, found| {
        found.push((vertex.is_stored(), vertex.bsdf.lobes()));
        Onward::Continue
    });
    assert!(found.iter().all(|(stored, lobes)| *stored == lobes.is_diffuse()));
    assert!(found.iter().any(|(_, lobes)| *lobes == Lobes::SPECULAR_REFLECT));
    let n_first =
        places(&scene, &PhotonWalk::default(), 4000).iter().filter(|place| place.1.is_empty()).count();
    assert_eq!(n_first, 4000, "each photon arrives somewhere");
}

/// PHT-2: photons carry flux and know no squared index. In a closed room a ball of glass changes how often the wall is met, but a
/// uniform field of light has the same irradiance behind it: photons through a ball of glass bring what falls on it.
#[test]
fn glass_in_a_furnace_keeps_the_flux() {
    let world = format!(
        "AttributeBegin Material \"diffuse\" {} AreaLightSource \"diffuse\" {} ReverseOrientation Shape \"sphere\" \"float radius\" 2 AttributeEnd
        Material \"dielectric\" \"float eta\" 1.8 Shape \"sphere\" \"float radius\" 0.8",
        flat("reflectance", 0.0),
        lit("L", 1.0)
    );
    let scene = Setup { world: &world, ..Setup::default() }.scene("furnace");
    let power = std::f64::consts::PI * 16.0 * std::f64::consts::PI;
    let at_walls =
        mean_over_photons(&scene, |vertex| if is_wall(vertex) { lumens(&scene, vertex) } else { 0.0 });
    expect_mean("the wall gets back what it sends", &at_walls, power, 0.01);
    let falls = mean_over_photons(&scene, |vertex| {
        if vertex.trail.is_empty() && !is_wall(vertex) { lumens(&scene, vertex) } else { 0.0 }
    });
    expect_mean(
        "the ball gets pi L of all around",
        &falls,
        std::f64::consts::PI * 4.0 * std::f64::consts::PI * 0.64,
        0.1,
    );
    // From inside the ball meets n^2 times as much flux on each side of its surface, most of it kept by total reflection.
    let inside = mean_over_photons(&scene, |vertex| {
        let is_inside = !is_wall(vertex) && vertex.surface.point.ng.dot_vector(vertex.surface.wo) < 0.0;
        if is_inside { lumens(&scene, vertex) } else { 0.0 }
    });
    // What refraction lets into a ball, it also lets out: chords of (1 - F) / (1 - F) hits each.
    expect_mean("inside", &inside, std::f64::consts::PI * 4.0 * std::f64::consts::PI * 0.64, 0.15);
}

/// Light of a lamp under water is absorbed on its way from where it starts, whether it meets the surface first or a stone; alpha
/// and interfaces let it pass.
#[test]
fn media_absorb_from_the_lamp_on() {
    let sigma = 0.3_f64;
    let world = format!(
        "LightSource \"point\" {}
        AttributeBegin Material \"interface\" Shape \"sphere\" \"float radius\" 0.5 AttributeEnd
        AttributeBegin Material \"diffuse\" Shape \"sphere\" \"float radius\" 0.7 \"float alpha\" 0 AttributeEnd
        AttributeBegin Material \"diffuse\" {} Shape \"sphere\" \"float radius\" 1 \"float phimax\" 180 AttributeEnd
        Material \"dielectric\" \"float eta\" 1 \"float absorption\" {sigma} Shape \"sphere\" \"float radius\" 2",
        lit("I", 1.0),
        flat("reflectance", 0.0)
    );
    let scene = Setup { world: &world, ..Setup::default() }.scene("under water");
    for (matte, distance) in [(true, 1.0_f64), (false, 2.0)] {
        let mean = mean_over_photons(&scene, |vertex| {
            if vertex.trail.is_empty() && is_wall(vertex) == matte { lumens(&scene, vertex) } else { 0.0 }
        });
        let expected = 2.0 * std::f64::consts::PI * (-sigma * distance).exp();
        expect_near("absorption", mean.mean(), expected, 0.02);
    }
}

/// The same photons by any number of threads, for every pattern.
#[test]
fn threads_make_no_difference() {
    let scene = room("threads", 0.7);
    for (name, pattern) in PhotonPattern::NAMES {
        let walk = PhotonWalk { pattern, sampler: scene.sampler, ..PhotonWalk::default() };
        let by = |n: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("a pool");
            pool.install(|| places(&scene, &walk, 10_000))
        };
        assert_eq!(by(1), by(3), "{name}");
    }
}

/// Nothing to emit, nothing to meet, a light that shines away, one photon: no photons, no harm.
#[test]
fn empty_scenes_have_no_photons() {
    let lamp = format!("LightSource \"point\" {}", lit("I", 1.0));
    let ball = "Material \"conductor\" Shape \"sphere\"";
    let black = "LightSource \"point\" \"rgb I\" [0 0 0]";
    let sky = format!("LightSource \"infinite\" {}", lit("L", 1.0));
    let away =
        format!("LightSource \"spot\" {} \"point3 from\" [0 0 9] \"point3 to\" [0 0 10]", lit("I", 1.0));
    use etendue_transport::photon::{EmissionSettings, Target};
    for (world, has_photons) in [
        (String::new(), false),
        (lamp.clone(), false),
        (sky.clone(), false),
        (ball.to_owned(), false),
        (format!("{black} {ball}"), false),
        (format!("{away} {ball}"), false),
        (format!("{lamp} {ball}"), true),
        (format!("{sky} {ball}"), true),
    ] {
        let scene = Setup { world: &world, ..Setup::default() }.scene("empty");
        for (_, target) in Target::NAMES {
            for n in [0, 1, 500] {
                let emitter =
                    PhotonEmitter::aimed(&scene, &EmissionSettings { target, ..EmissionSettings::default() });
                let walk = PhotonWalk::default();
                let (found, _) = trace_photons(&scene, &emitter, 0..n, &walk, |_, vertex, found| {
                    assert!(vertex.flux.is_finite() && !vertex.flux.is_black());
                    found.push(());
                    Onward::Continue
                });
                assert_eq!(!found.is_empty(), has_photons && (n > 100 || !found.is_empty()), "{world} {n}");
            }
        }
    }
}

/// EMI-14: each switch of artists takes away just the photons whose word it names, as it does for paths from the camera.
#[test]
fn switches_take_away_what_they_name() {
    use etendue_transport::lpe::Event;
    let scene = |all: &str, linked: &str| {
        let world = format!(
            "LightSource \"point\" {} \"point3 from\" [0 1.5 0] \"string group\" \"key\"
            AttributeBegin Translate 0 -0.5 0 Material \"dielectric\" Shape \"sphere\" \"float radius\" 0.5 {all} {linked} AttributeEnd
            AttributeBegin Translate 1 -0.5 0 Material \"conductor\" Shape \"sphere\" \"float radius\" 0.4 {all} AttributeEnd
            Material \"diffuse\" {} Shape \"sphere\" \"float radius\" 2 {all}",
            lit("I", 1.0),
            flat("reflectance", 0.6)
        );
        Setup { world: &world, ..Setup::default() }.scene("switches")
    };
    let is_sharp = |event: &Event| matches!(event, Event::Specular | Event::SharpGlossy);
    let is_indirect = |trail: Trail| trail.events().any(|event| !is_sharp(&event));
    let whole = scene("", "");
    let walk = PhotonWalk { sampler: whole.sampler, max_depth: 6, ..PhotonWalk::default() };
    let kept = |scene: &Scene| -> Vec<(u64, Trail)> {
        places(scene, &walk, 3000)
            .into_iter()
            .filter(|place| place.3)
            .map(|place| (place.0, place.1))
            .collect()
    };
    let all = kept(&whole);
    let check = |what: &str, switch: &str, linked: &str, stays: &dyn Fn(Trail) -> bool| {
        // Photons end where all that they could still do is switched off.
        let expected: Vec<_> = all.iter().filter(|(_, trail)| stays(*trail)).copied().collect();
        assert!(expected.len() < all.len(), "{what}");
        assert_eq!(kept(&scene(switch, linked)), expected, "{what}");
    };
    // A wide event may have been at the end of a way that is switched off.
    let no_caustic_before = |trail: Trail| {
        let events: Vec<Event> = trail.events().collect();
        let first_wide = events.iter().position(|event| !is_sharp(event)).unwrap_or(events.len());
        first_wide == 0
    };
    check("caustics cast", "\"bool castscaustics\" false", "", &no_caustic_before);
    check("caustics received", "\"bool receivescaustics\" false", "", &no_caustic_before);
    check("indirect cast", "\"bool castsindirect\" false", "", &|trail| !is_indirect(trail));
    check("indirect received", "\"bool receivesindirect\" false", "", &|trail| !is_indirect(trail));
}
