//! Photons as small lights (SPEC EST-12) and as densities, in a sphere, where all of it is known.

use std::f32::consts::PI;

use etendue_math::{Point3, Ray, Vector3};
use etendue_scene::bsdf::Lobes;
use etendue_spectrum::{Sampled, Wavelengths, Xyz, flux_to_xyz, lift};
use etendue_transport::path::camera_pass::Tracer;
use etendue_transport::photon::estimate::gathering::{
    GatherChoice, GatherScratch, GatherSettings, PhotonLight, gather,
};
use etendue_transport::photon::estimate::{DensityEstimate, EstimateScratch, LitPlace, MapEstimate};
use etendue_transport::photon::{
    Onward, PhotonEmitter, PhotonMapBuilder, PhotonWalk, StoredPhoton, trace_photons,
};

use crate::support::{Setup, flat};

const ALBEDO: f32 = 0.5;
const RADIUS: f32 = 2.0;
const N: u64 = 4000;

/// A point light in the middle of a diffuse sphere. Each wall patch sees each other one by the same `cos cos / d^2 = 1 / (4 R^2)`, so that all choices of
/// photons give the same light, but for rounding: `a/pi E a / (1 - a)`. Their density has that of the light straight from the lamp as well.
#[test]
fn light_in_a_sphere() {
    let world = format!(
        "LightSource \"point\" \"float scale\" 3
        Material \"diffuse\" {} ReverseOrientation Shape \"sphere\" \"float radius\" {RADIUS}",
        flat("reflectance", f64::from(ALBEDO)),
    );
    let scene = Setup { world: &world, ..Setup::default() }.scene("light in a sphere");
    let emitter = PhotonEmitter::new(&scene);
    let (photons, _) = trace_photons(&scene, &emitter, 0..N, &PhotonWalk::default(), |_, vertex, kept| {
        let power = flux_to_xyz(vertex.flux, vertex.lambda);
        let photon = StoredPhoton {
            position: vertex.surface.point.p,
            power,
            wi: vertex.surface.wo,
            trail: vertex.trail,
            is_shadow: false,
        };
        kept.push((PhotonLight::new(vertex, N).expect("diffuse walls are lit"), photon));
        Onward::Continue
    });
    let direct =
        photons.iter().filter(|(_, photon)| photon.trail.is_empty()).fold([0.0_f64; 3], |sum, (_, p)| {
            let power = p.power.to_array();
            [0, 1, 2].map(|i| sum[i] + f64::from(power[i]) / N as f64)
        });
    let mut lambda = Wavelengths::sample_visible(0.4);
    let irradiance = Xyz::from(direct.map(|flux| (flux / f64::from(4.0 * PI * RADIUS * RADIUS)) as f32));
    let once = lift(irradiance, &lambda) * (ALBEDO / PI);

    let tracer = Tracer::new(&scene);
    let direction = Vector3::new(0.6, 0.48, 0.64);
    let ray = Ray { origin: Point3::new(0.3, 0.2, -0.4), direction, time: 0.0 };
    let hit = tracer.intersect(&ray).expect("the sphere is closed");
    let surface = scene.surface(&ray, &hit);
    let bsdf = scene.bsdf(&surface, &mut lambda).expect("walls scatter");
    let lights: Vec<PhotonLight> = photons.iter().map(|(light, _)| *light).collect();
    let gathered = |choice| {
        let settings = GatherSettings { choice, min_distance: 0.0 };
        gather(&tracer, (&surface, &bsdf, &lambda), &lights, settings, 0.3, &mut GatherScratch::default())
    };
    let all = gathered(GatherChoice::All);
    // The number of arrivals of a photon varies by its mean and more: five standard errors.
    expect_ratio("all", all, once, ALBEDO / (1.0 - ALBEDO), 5.0 * (2.0 * N as f32).sqrt().recip());
    // Photons differ in power and colour alone.
    expect_ratio("by importance", gathered(GatherChoice::Important(256)), all, 1.0, 0.1);
    expect_ratio("at random", gathered(GatherChoice::Random(512)), all, 1.0, 0.3);

    let mut builder = PhotonMapBuilder::new(photons.len());
    for (_, photon) in &photons {
        builder.store(photon);
    }
    builder.scale_power(1.0 / N as f32);
    let map = builder.balance(N);
    let estimate = MapEstimate { density: DensityEstimate::default(), k: 400, max_radius: 1.0 };
    let place =
        LitPlace { p: surface.point.p, wo: surface.wo, bsdf: &bsdf, lobes: Lobes::ALL, lambda: &lambda };
    let found = estimate.radiance(&map, &place, &mut EstimateScratch::default());
    // Some of the 400, where the sphere has turned, came from below the tangent plane.
    assert!((370..=400).contains(&found.density.n_photons) && !found.density.is_limited);
    // 400 photons of a few per cent different powers, more where the sphere is curved, by (r / 2R)^2 = 5 %.
    expect_ratio("density", found.radiance, once, 1.0 / (1.0 - ALBEDO), 0.3);
}

#[track_caller]
fn expect_ratio(what: &str, found: Sampled, base: Sampled, expected: f32, tolerance: f32) {
    let ratio = found.sum() / base.sum();
    assert!((ratio / expected - 1.0).abs() < tolerance, "{what}: {ratio} instead of {expected}");
}
