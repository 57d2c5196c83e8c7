//! Photons that are aimed: projection maps change how often something is met, not how much light it gets (SPEC EMI-8 to EMI-10).

use etendue_math::statistics::Moments;
use etendue_scene::Scene;
use etendue_transport::photon::{
    EmissionSettings, MapScheme, Onward, PhotonEmitter, PhotonPattern, PhotonVertex, PhotonWalk, Target,
    trace_photons,
};

use crate::support::{Setup, expect_agreement, expect_mean, expect_near, flat, lit};

/// Lumens for each unit of flux at any wavelength, of light that is the same at all: the integral of y-bar.
const LUMENS: f64 = 106.856_9;

/// What arrives with a photon, in lumen if the light is the same at all wavelengths: without the noise of their choice.
fn lumens(vertex: &PhotonVertex<'_>) -> f64 {
    f64::from(vertex.flux[0]) * LUMENS
}

/// A mirror ball, a small glass ball and a ring of sharp metal above a matte floor, with the light `light`.
fn still_life(name: &str, light: &str) -> Scene {
    let world = format!(
        "AttributeBegin {light} AttributeEnd
        Material \"diffuse\" {} Shape \"bilinearmesh\" \"point3 P\" [-3 0 -3  3 0 -3  -3 0 3  3 0 3]
        AttributeBegin Translate -0.6 0.4 0 Material \"conductor\" Shape \"sphere\" \"float radius\" 0.4 AttributeEnd
        AttributeBegin Translate 0.9 0.25 -0.4 Material \"dielectric\" Shape \"sphere\" \"float radius\" 0.25 AttributeEnd
        AttributeBegin Translate 0.4 0.2 0.9 Rotate 90 1 0 0 Material \"conductor\" \"float roughness\" 0.001
        Shape \"cylinder\" \"float radius\" 0.3 \"float zmin\" -0.2 \"float zmax\" 0.2 AttributeEnd",
        flat("reflectance", 0.5)
    );
    Setup { world: &world, ..Setup::default() }.scene(name)
}

/// One light of every kind that sends photons in a way of its own.
fn lights() -> Vec<(&'static str, String)> {
    let area =
        |shape: &str| format!("Translate 0.2 3 0.3 AreaLightSource \"diffuse\" {} {shape}", lit("L", 5.0));
    vec![
        ("point", format!("LightSource \"point\" \"point3 from\" [0.3 2.5 -0.4] {}", lit("I", 3.0))),
        (
            "spot",
            format!(
                "LightSource \"spot\" \"point3 from\" [0 3 0] \"point3 to\" [0.2 0 0] \"float coneangle\" 50
                \"float conedeltaangle\" 25 {}",
                lit("I", 3.0)
            ),
        ),
        ("wide spot", format!("LightSource \"spot\" \"point3 from\" [0 2 0] \"point3 to\" [0 3 0] \"float coneangle\" 160 {}", lit("I", 3.0))),
        ("distant", format!("LightSource \"distant\" \"point3 from\" [1 4 2] \"point3 to\" [0 0 0] {}", lit("L", 2.0))),
        ("constant sky", format!("LightSource \"infinite\" {}", lit("L", 1.0))),
        ("sun and sky", "Rotate -90 1 0 0 LightSource \"sunsky\" \"float elevation\" 40".to_owned()),
        ("sphere", area("Shape \"sphere\" \"float radius\" 0.3")),
        ("disk", area("Rotate 90 1 0 0 Shape \"disk\" \"float radius\" 0.5")),
        ("square", area("Shape \"bilinearmesh\" \"point3 P\" [-0.4 0 -0.4  0.4 0 -0.4  -0.4 0 0.4  0.4 0 0.4] ReverseOrientation")),
        ("cylinder", area("Rotate 90 1 0 0 Shape \"cylinder\" \"float radius\" 0.2 \"float zmin\" -0.3 \"float zmax\" 0.3")),
        (
            "two-sided beam",
            format!(
                "Translate 0 2 0 Rotate 90 1 0 0 AreaLightSource \"diffuse\" {} \"bool twosided\" true \"float spreadangle\" 40
                \"float exponent\" 3 Shape \"disk\" \"float radius\" 0.3",
                lit("L", 5.0)
            ),
        ),
    ]
}

/// Light that reaches sharp shapes first, or matte ones through them, photon by photon, and the share of photons that hit a
/// sharp shape first.
fn caustics(
    scene: &Scene,
    settings: &EmissionSettings,
    n: u64,
    pattern: PhotonPattern,
) -> (Moments, Moments, f64) {
    let emitter = PhotonEmitter::aimed(scene, settings);
    let walk = PhotonWalk {
        pattern,
        sampler: scene.sampler,
        stream: settings.target as u32,
        ..PhotonWalk::default()
    };
    let (found, _) = trace_photons(scene, &emitter, 0..n, &walk, |index, vertex, found| {
        let is_sharp = !vertex.bsdf.lobes().is_diffuse();
        if vertex.trail.is_empty() && is_sharp {
            found.push((index, true, lumens(vertex)));
        } else if vertex.trail.is_caustic() && !is_sharp {
            found.push((index, false, lumens(vertex)));
        }
        if is_sharp && vertex.trail.len() < 12 { Onward::Continue } else { Onward::Stop }
    });
    let (mut first, mut caustic) = (vec![0.0; n as usize], vec![0.0; n as usize]);
    let mut n_hits = 0;
    for (index, is_first, value) in found {
        n_hits += u64::from(is_first);
        (if is_first { &mut first } else { &mut caustic })[index as usize] += value;
    }
    (first.into_iter().collect(), caustic.into_iter().collect(), n_hits as f64 / n as f64)
}

#[test]
fn maps_change_the_hit_rate_and_nothing_else() {
    let aimed = EmissionSettings { target: Target::SharpShapes, ..EmissionSettings::default() };
    for (name, light) in lights() {
        let scene = still_life(name, &light);
        let n = 20_000;
        let (first, caustic, rate) =
            caustics(&scene, &EmissionSettings::default(), 8 * n, PhotonPattern::Random);
        let (aimed_first, aimed_caustic, aimed_rate) = caustics(&scene, &aimed, n, PhotonPattern::Random);
        expect_agreement(&format!("{name}: first hits"), &first, &aimed_first, 0.4);
        expect_agreement(&format!("{name}: caustics"), &caustic, &aimed_caustic, 1.5);
        assert!(aimed_rate > 1.3 * rate, "{name}: hit rate {rate} without a map and {aimed_rate} with one");
        let retry = EmissionSettings { scheme: MapScheme::Retry, ..aimed };
        let (retried, _, retried_rate) = caustics(&scene, &retry, n / 2, PhotonPattern::Random);
        expect_agreement(&format!("{name}: first hits by retries"), &retried, &aimed_first, 0.5);
        expect_near(name, retried_rate, aimed_rate, 0.15);
    }
}

/// What is aimed at all shapes is all that would meet one: the same flux on first surfaces, of fewer photons that miss.
#[test]
fn aiming_at_all_shapes_leaves_out_what_misses() {
    let total = |scene: &Scene, target: Target| {
        let emitter =
            PhotonEmitter::aimed(scene, &EmissionSettings { target, ..EmissionSettings::default() });
        let (n, walk) =
            (20_000, PhotonWalk { sampler: scene.sampler, stream: target as u32, ..PhotonWalk::default() });
        let (found, _) = trace_photons(scene, &emitter, 0..n, &walk, |index, vertex, found| {
            found.push((index, lumens(vertex)));
            Onward::Stop
        });
        let mut values = vec![0.0; n as usize];
        found.iter().for_each(|(index, value)| values[*index as usize] += value);
        (values.into_iter().collect::<Moments>(), found.len())
    };
    for (name, light) in lights() {
        let scene = still_life(name, &light);
        let ((all, n_all), (aimed, n_aimed)) =
            (total(&scene, Target::Anything), total(&scene, Target::Shapes));
        expect_agreement(name, &all, &aimed, 0.15);
        assert!(
            n_aimed as f64 > 0.95 * n_all as f64,
            "{name}: {n_all} photons hit, {n_aimed} of those aimed"
        );
    }
}

/// A square floor of 16 square metres under a light of that intensity towards it at a height in metres.
fn far_light(name: &str, height: f64) -> (Scene, f64) {
    let lamp = |shape: &str| {
        format!(
            "Translate 0 {height} 0 Rotate 90 1 0 0 AreaLightSource \"diffuse\" {} {shape}",
            lit("L", 5.0)
        )
    };
    let (light, intensity) = match name {
        "point" => (format!("LightSource \"point\" \"point3 from\" [0 {height} 0] {}", lit("I", 3.0)), 3.0),
        "spot" => (
            format!(
                "LightSource \"spot\" \"point3 from\" [0 {height} 0] \"point3 to\" [0 0 0] \"float coneangle\" 25 {}",
                lit("I", 3.0)
            ),
            3.0,
        ),
        "sphere" => (lamp("Shape \"sphere\" \"float radius\" 0.5"), 5.0 * std::f64::consts::PI * 0.25),
        _ => (lamp("Shape \"disk\" \"float radius\" 0.5"), 5.0 * std::f64::consts::PI * 0.25),
    };
    let world = format!(
        "AttributeBegin {light} AttributeEnd
        Material \"diffuse\" {} Shape \"bilinearmesh\" \"point3 P\" [-2 0 -2  2 0 -2  -2 0 2  2 0 2]",
        flat("reflectance", 0.5)
    );
    (Setup { world: &world, ..Setup::default() }.scene(name), intensity)
}

/// Of what far lights send nearly nothing meets a small scene. Photons that are to reach it do, a good part of them, and bring its
/// illuminance, by the inverse square of the distance.
#[test]
fn photons_of_far_lights_are_aimed() {
    let n = 20_000;
    for name in ["point", "spot", "sphere", "disk"] {
        for height in [300.0, 1000.0, 1e5] {
            let (scene, intensity) = far_light(name, height);
            let settings = EmissionSettings::default();
            let emitter = PhotonEmitter::reaching(&scene, &settings);
            assert!(PhotonEmitter::new(&scene).hit_share(&scene) < 0.01, "{name} {height}");
            assert!(emitter.hit_share(&scene) > 0.1, "{name} {height}: {}", emitter.hit_share(&scene));
            let walk = PhotonWalk { sampler: scene.sampler, ..PhotonWalk::default() };
            let (found, _) = trace_photons(&scene, &emitter, 0..n, &walk, |_, vertex, found| {
                found.push(lumens(vertex));
                Onward::Stop
            });
            let misses = std::iter::repeat_n(0.0, n as usize - found.len());
            let values: Moments = found.iter().copied().chain(misses).collect();
            // The chance of a hit is at least 1/10: five standard errors are 5 * sqrt(9 / n).
            expect_mean(name, &values, intensity * 16.0 / (height * height), 0.11);
            let without = PhotonEmitter::reaching(&scene, &EmissionSettings { n_cells: 0, ..settings });
            assert_eq!(without.sent_share(), 1.0, "without projection maps");
        }
    }
}

/// Where a tenth of the photons meets something they leave as they do, bit for bit.
#[test]
fn photons_that_arrive_are_not_aimed() {
    let mut n_plain = 0;
    for (name, light) in lights() {
        let scene = still_life(name, &light);
        let (plain, settings) = (PhotonEmitter::new(&scene), EmissionSettings::default());
        let reaching = PhotonEmitter::reaching(&scene, &settings);
        if plain.hit_share(&scene) < 0.1 {
            continue;
        }
        n_plain += 1;
        let walk = PhotonWalk { sampler: scene.sampler, ..PhotonWalk::default() };
        for index in 0..50 {
            let ray = |emitter: &PhotonEmitter| {
                let lambda = walk.wavelengths.sample(0.3);
                let photon = emitter.emit(&scene, &mut walk.numbers(index), &lambda)?;
                Some((photon.ray.origin, photon.ray.direction, photon.flux))
            };
            assert_eq!(ray(&plain), ray(&reaching), "{name}");
        }
    }
    assert!(n_plain >= 10, "{n_plain}");
}

/// Patterns change how evenly photons fall, not how many; even ones vary less in what arrives through one quarter of the floor.
#[test]
fn patterns_agree_and_even_ones_vary_less() {
    let world = format!(
        "LightSource \"point\" \"point3 from\" [0.1 1 0.2] {}
        Material \"diffuse\" {} Shape \"bilinearmesh\" \"point3 P\" [-1 0 -1  1 0 -1  -1 0 1  1 0 1]",
        lit("I", 1.0),
        flat("reflectance", 0.5)
    );
    let mut scene = Setup { world: &world, ..Setup::default() }.scene("patterns");
    let patterns = PhotonPattern::NAMES.map(|(name, pattern)| (name, pattern.planned(4096)));
    let spread = patterns.map(|(name, pattern)| {
        let moments: Moments = (0..32)
            .map(|seed| {
                scene.sampler.seed = seed;
                let walk = PhotonWalk { pattern, sampler: scene.sampler, ..PhotonWalk::default() };
                let emitter = PhotonEmitter::new(&scene);
                let (found, _) = trace_photons(&scene, &emitter, 0..4096, &walk, |_, vertex, found| {
                    let p = vertex.surface.point.p;
                    found.push(if p.x > 0.0 && p.z > 0.0 { lumens(vertex) } else { 0.0 });
                    Onward::Stop
                });
                found.into_iter().sum::<f64>() / 4096.0
            })
            .collect();
        (name, moments)
    });
    expect_agreement("stratified", &spread[1].1, &spread[0].1, 0.1);
    expect_agreement("qmc", &spread[2].1, &spread[0].1, 0.1);
    let deviation = |i: usize| spread[i].1.variance().sqrt() / spread[i].1.mean();
    assert!(deviation(1) < 0.4 * deviation(0), "stratified {} random {}", deviation(1), deviation(0));
    assert!(deviation(2) < 0.4 * deviation(0), "qmc {} random {}", deviation(2), deviation(0));
}

/// EMI-9: two lights of half the power in one place are one light, and of unlike lights each sends photons of the same flux.
#[test]
fn many_lights_share_photons_by_power() {
    let lamp = |i: f64| format!("LightSource \"point\" {} \"point3 from\" [0 1 0]", lit("I", i));
    let floor =
        format!("Material \"diffuse\" {} Shape \"sphere\" \"float radius\" 3", flat("reflectance", 0.0));
    let flux = |lights: &str| {
        let world = format!("{lights} {floor}");
        let scene = Setup { world: &world, ..Setup::default() }.scene("halves");
        let walk = PhotonWalk { sampler: scene.sampler, ..PhotonWalk::default() };
        trace_photons(&scene, &PhotonEmitter::new(&scene), 0..4000, &walk, |_, vertex, found| {
            found.push((vertex.surface.point.p.y, lumens(vertex)));
            Onward::Stop
        })
        .0
    };
    let (one, halves) = (flux(&lamp(2.0)), flux(&format!("{} {}", lamp(1.0), lamp(1.0))));
    for (a, b) in one.iter().zip(&halves) {
        assert_eq!(a.0, b.0);
        expect_near("flux", b.1, a.1, 1e-5);
    }
    let unlike: Moments =
        flux(&format!("{} {} {}", lamp(2.0), lamp(0.01), lamp(31.0))).iter().map(|(_, flux)| *flux).collect();
    expect_mean("unlike lights", &unlike, 33.01 * 4.0 * std::f64::consts::PI, 0.02);
}

/// The light under a glass ball is what falls on it, less what it sends up: integrated over 10^6 rays through the ball with
/// exact Fresnel factors and all inner reflections.
#[test]
fn a_ball_of_glass_keeps_the_energy_of_its_caustic() {
    let (eta, n_rays) = (1.5_f64, 1_000_000);
    let mut down = 0.0;
    for i in 0..n_rays {
        let b2 = (f64::from(i) + 0.5) / f64::from(n_rays); // square of the distance from the axis, uniform in area
        let (cos_i, cos_t) = ((1.0 - b2).sqrt(), (1.0 - b2 / (eta * eta)).sqrt());
        let (s, p) =
            ((cos_i - eta * cos_t) / (cos_i + eta * cos_t), (eta * cos_i - cos_t) / (eta * cos_i + cos_t));
        let r = 0.5 * (s * s + p * p);
        let (theta_i, theta_t) = (cos_i.acos(), cos_t.acos());
        let mut is_down = |turn: f64, share: f64| down += if turn.cos() > 0.0 { share } else { 0.0 };
        is_down(std::f64::consts::PI - 2.0 * theta_i, r);
        for k in 0..30 {
            let inner = f64::from(k) * (std::f64::consts::PI - 2.0 * theta_t);
            is_down(2.0 * (theta_i - theta_t) + inner, (1.0 - r) * (1.0 - r) * r.powi(k));
        }
    }
    let expected = 2.0 * std::f64::consts::PI * 0.49 * down / f64::from(n_rays);
    // The floor is so large that what leaves the ball downwards meets it.
    let world = format!(
        "LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] {}
        AttributeBegin Material \"dielectric\" \"float eta\" {eta} Shape \"sphere\" \"float radius\" 0.7 AttributeEnd
        Material \"diffuse\" Shape \"bilinearmesh\" \"point3 P\" [-900 -900 -1  900 -900 -1  -900 900 -1  900 900 -1]",
        lit("L", 2.0)
    );
    let scene = Setup { world: &world, ..Setup::default() }.scene("caustic energy");
    let aimed = EmissionSettings { target: Target::SharpShapes, ..EmissionSettings::default() };
    let (first, caustic, rate) = caustics(&scene, &aimed, 60_000, PhotonPattern::Qmc);
    expect_mean("what falls on the ball", &first, 2.0 * std::f64::consts::PI * 0.49, 0.01);
    expect_mean("what leaves it downwards", &caustic, expected, 0.01);
    assert!(rate > 0.9, "of photons that are aimed {rate} meet the ball");
}

/// What coarse cells do not show is not lost: a cone wider than a hemisphere that ends abruptly on a target, and a luminaire whose beam
/// is narrower than the steps between looks at it.
#[test]
fn coarse_maps_lose_no_light() {
    let file = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("narrow beam.ies");
    let table = "IESNA91\nTILT=NONE\n1 -1 1 4 1 1 2 0 0 0\n1 1 50\n0 1 2 180\n0\n1000 1000 0 0\n";
    std::fs::write(&file, table).expect("the folder for tests can be written");
    let lights = [
        (
            "wide spot with a hard edge",
            format!(
                "LightSource \"spot\" \"point3 from\" [0 2 0] \"point3 to\" [0.983 1.816 0] \"float coneangle\" 100
                \"float conedeltaangle\" 0 {}",
                lit("I", 3.0)
            ),
        ),
        (
            "narrow beam",
            format!(
                "Translate -0.6 3 0 Rotate -90 1 0 0 LightSource \"ies\" \"string filename\" {:?}",
                file.to_str().expect("a folder with a plain name").replace('\\', "/")
            ),
        ),
    ];
    let coarse = |target| EmissionSettings { target, n_cells: 2, ..EmissionSettings::default() };
    for (name, light) in lights {
        let scene = still_life(name, &light);
        let (free, _, _) = caustics(&scene, &coarse(Target::Anything), 100_000, PhotonPattern::Random);
        let (aimed, _, _) = caustics(&scene, &coarse(Target::SharpShapes), 100_000, PhotonPattern::Random);
        expect_agreement(name, &free, &aimed, 0.2);
    }
}
