//! What every BSDF must satisfy, checked for each line of one table, and what single models promise.

mod classic;
mod extended;
mod facetted;
mod fresnel;
mod hair;
mod layered;
mod measured;
mod microfacets;
mod tabulated;

use std::f64::consts::TAU;

use etendue_math::statistics::{
    Moments, chi_square_test, integrate_sphere, mean_test, means_agree, sidak, sphere_chi_square,
};
use etendue_math::{Normal3, Point2, Rng, Vector3, hash64};
use etendue_spectrum::Sampled;
use rayon::prelude::*;

use super::catalogue::{Configuration, catalogue, coated, copper, glass, grey_base, silver};
use super::laws::{Law, Measures, density_p, direction, directions, draw};
use super::microfacet::Microfacets;
use super::*;

/// Significance of all statistical tests of this module together, split by [`significance`].
const SIGNIFICANCE: f64 = 1e-3;
/// No fewer than the statistical tests here.
const N_TESTS: usize = 600;
/// Directions per chi-square test.
const N_SAMPLES: usize = 50_000;

fn significance() -> f64 {
    sidak(SIGNIFICANCE, N_TESTS)
}

fn white_base() -> Base {
    Base::Diffuse(Diffuse { reflectance: Sampled::ONE })
}

fn seed(name: &str, index: usize) -> u64 {
    let words: Vec<u64> = name.bytes().map(u64::from).chain([index as u64]).collect();
    hash64(&words)
}

fn uniform_sphere(rng: &mut Rng) -> Vector3 {
    let z = 1.0 - 2.0 * rng.next_f32();
    let (sin, cos) = (TAU as f32 * rng.next_f32()).sin_cos();
    let r = (1.0 - z * z).max(0.0).sqrt();
    Vector3::new(r * cos, r * sin, z)
}

fn is_near(a: f32, b: f32, relative: f32, absolute: f32) -> bool {
    (a - b).abs() <= relative * a.abs().max(b.abs()) + absolute
}

/// Every model keeps every law but those that it is stated to break, and it does break those.
#[test]
fn laws_are_kept_or_stated() {
    let failures: Vec<String> = catalogue()
        .par_iter()
        .filter_map(|row| {
            let measures = Measures::of(&row.kind);
            let broken = measures.broken(&row.kind, row.is_lossless);
            (broken != row.breaks).then(|| {
                format!("{}: breaks {broken:?}, stated are {:?}: {measures:#?}", row.name, row.breaks)
            })
        })
        .collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// The laws notice what is a little wrong: 2 % of flux too much or too little, and values that are none.
#[test]
fn broken_laws_are_noticed() {
    let broken = |reflectance| {
        let kind = BsdfKind::Diffuse(Diffuse { reflectance: Sampled::splat(reflectance) });
        Measures::of(&kind).broken(&kind, true)
    };
    assert_eq!(broken(1.0), []);
    assert_eq!(broken(1.02), [Law::Energy, Law::Furnace]);
    assert_eq!(broken(0.98), [Law::Furnace]);
    assert_eq!(broken(-0.1), [Law::Furnace, Law::Soundness]);
    assert!(broken(f32::NAN).contains(&Law::Soundness));
}

/// The test of the density must notice one that is wrong by 5 %, also where its integral is right.
#[test]
fn a_density_off_by_a_twentieth_is_noticed() {
    type Mutation = fn(Vector3) -> f32;
    let mutations: [(usize, Mutation); 4] = [
        (N_SAMPLES, |_| 1.05),
        (N_SAMPLES, |_| 0.95),
        (4 * N_SAMPLES, |wi| if wi.x > 0.0 { 1.05 } else { 0.95 }),
        (4 * N_SAMPLES, |wi| if wi.z > 0.7 { 1.05 } else { 0.95 }),
    ];
    for kind in [BsdfKind::Conductor(copper(0.4, 0.4)), BsdfKind::Dielectric(glass(0.5, 0.5, 1.5))] {
        for (i, (n_samples, factor)) in mutations.into_iter().enumerate() {
            let wo = direction(45.0, 0.7);
            let p_value = density_p(&kind, wo, Lobes::ALL, n_samples, i as u64, factor);
            assert!(p_value < significance(), "mutation {i} of {kind:?} passed: {p_value}");
        }
    }
}

/// SPEC BRDF-9: a BSDF is the sum of its lobes, pointwise in `eval` and in the mean of samples.
#[test]
fn lobes_sum_to_the_whole() {
    for row in &catalogue() {
        let mode = TransportMode::Radiance;
        let mut rng = Rng::new(seed(row.name, 21), 0);
        for _ in 0..500 {
            let (wo, wi) = (uniform_sphere(&mut rng), uniform_sphere(&mut rng));
            let whole = row.kind.eval(wo, wi, mode, Lobes::ALL);
            let parts =
                Lobes::EACH.into_iter().fold(Sampled::ZERO, |sum, l| sum + row.kind.eval(wo, wi, mode, l));
            assert!(is_near(whole[2], parts[2], 1e-5, 1e-6), "{}: {whole:?} {parts:?}", row.name);
        }
        let wo = direction(60.0, 0.3);
        let mean = |lobes: Lobes, rng: &mut Rng| {
            let mut moments = Moments::default();
            for _ in 0..20_000 {
                let sample = draw(&row.kind, wo, mode, lobes, rng);
                assert!(sample.is_none_or(|s| lobes.contains(s.lobe)), "{}: unwanted lobe", row.name);
                moments.push(sample.map_or(0.0, |s| f64::from(s.weight[2])));
            }
            moments
        };
        let whole = mean(Lobes::ALL, &mut rng);
        let parts = Lobes::EACH.map(|lobe| mean(lobe, &mut rng));
        let sum: f64 = parts.iter().map(Moments::mean).sum();
        let variance: f64 = parts.iter().chain([&whole]).map(|m| m.standard_error().powi(2)).sum();
        assert!(
            (whole.mean() - sum).abs() < 5.0 * variance.sqrt() + 1e-4,
            "{}: {} {sum}",
            row.name,
            whole.mean()
        );
    }
}

/// SPEC BRDF-11, BRDF-4, BRDF-8: Lambert's albedo is its coefficient, and cos² of its samples is uniform.
#[test]
fn lambert_reflects_its_albedo() {
    let reflectance = Sampled::from_array([0.3, 0.5, 0.7, 0.9]);
    let (kind, wo) = (BsdfKind::Diffuse(Diffuse { reflectance }), direction(30.0, 0.0));
    for i in 0..4 {
        let cosine_f =
            |wi: Vector3| f64::from(kind.eval(wo, wi, TransportMode::Radiance, Lobes::ALL)[i] * wi.z.abs());
        let albedo = integrate_sphere(cosine_f, 1e-4);
        assert!((albedo - f64::from(kind.albedo(wo)[i])).abs() < 1e-3, "{albedo}");
    }
    let mut rng = Rng::new(seed("cos²", 0), 0);
    let mut counts = [0.0; 32];
    for _ in 0..32_000 {
        let sample = draw(&kind, wo, TransportMode::Radiance, Lobes::ALL, &mut rng).unwrap();
        counts[((sample.wi.z * sample.wi.z * 32.0) as usize).min(31)] += 1.0;
    }
    chi_square_test(&counts, &[1000.0; 32], 5.0, significance()).unwrap();
}

/// The furnace of the pane: all orders of bounces between its faces sum to R' = 2 R / (1 + R).
#[test]
fn a_pane_reflects_all_orders() {
    let pane = ThinDielectric { eta: 1.5 };
    assert!(is_near(pane.reflectance(1.0), 2.0 * 0.04 / 1.04, 1e-5, 0.0));
    assert_eq!(pane.reflectance(0.0), 1.0);
}

/// Radiance seen in a direction does not depend on whether camera or light is traced: with a bent shading normal, flux
/// needs the factor of Veach.
#[test]
fn shading_normals_have_an_adjoint() {
    let ng = Normal3::new(0.0, 0.0, 1.0);
    let ns = Normal3::new(0.3, -0.1, 0.9).normalized();
    let bsdf = Bsdf::new(ns, ng, Vector3::new(1.0, 0.0, 0.0), BsdfKind::Conductor(copper(0.5, 0.5)));
    let mut rng = Rng::new(seed("adjoint", 0), 0);
    for _ in 0..1000 {
        let (a, b) = (uniform_sphere(&mut rng), uniform_sphere(&mut rng));
        let radiance = bsdf.eval(a, b, TransportMode::Radiance, Lobes::ALL)[0] * bsdf.abs_cos(b);
        let flux = bsdf.eval(b, a, TransportMode::Importance, Lobes::ALL)[0] * bsdf.abs_cos(a);
        // Projected by the true surface, both measure the same beam.
        let (x, y) = (radiance * a.dot_normal(ng).abs(), flux * b.dot_normal(ng).abs());
        assert!(is_near(x, y, 1e-3, 1e-6), "{x} {y}");
        let weight = bsdf.sample(a, 0.5, Point2::new(0.3, 0.6), TransportMode::Importance, Lobes::ALL);
        if let Some(s) = weight {
            let f = bsdf.eval(a, s.wi, TransportMode::Importance, Lobes::ALL)[0];
            let pdf = bsdf.pdf(a, s.wi, TransportMode::Importance, Lobes::ALL);
            assert!(is_near(s.weight[0], f * bsdf.abs_cos(s.wi) / pdf, 5e-3, 1e-6));
        }
    }
}

/// Turning the surface turns its scattering: world and shading frame agree.
#[test]
fn world_directions_scatter_as_local_ones() {
    let n = Vector3::new(0.4, 0.5, -0.7).normalized().as_normal();
    let tangent = Vector3::new(0.1, 2.0, 0.3);
    for row in &catalogue() {
        let bsdf = Bsdf::new(n, n, tangent, row.kind);
        let (wo, wi) = (direction(40.0, 1.0), direction(55.0, 3.0));
        let (world_o, world_i) = (bsdf.frame().to_world(wo), bsdf.frame().to_world(wi));
        if !row.kind.is_stochastic() {
            let local = row.kind.eval(wo, wi, TransportMode::Radiance, Lobes::ALL)[1];
            let world = bsdf.eval(world_o, world_i, TransportMode::Radiance, Lobes::ALL)[1];
            assert!(is_near(local, world, 1e-3, 1e-6), "{}: {local} {world}", row.name);
        }
        if let Some(s) = bsdf.sample(world_o, 0.3, Point2::new(0.4, 0.8), TransportMode::Radiance, Lobes::ALL)
        {
            assert!((s.wi.length() - 1.0).abs() < 1e-4, "{}", row.name);
        }
    }
}

/// A widened mirror is glossy and keeps its colour; what is rough already stays.
#[test]
fn regularization_widens_narrow_lobes() {
    let mut mirror = Bsdf::new(
        Normal3::new(0.0, 0.0, 1.0),
        Normal3::new(0.0, 0.0, 1.0),
        Vector3::new(1.0, 0.0, 0.0),
        BsdfKind::Conductor(copper(0.0, 0.0)),
    );
    assert!(mirror.lobes().is_specular());
    mirror.regularize();
    assert_eq!(mirror.lobes(), Lobes::GLOSSY_REFLECT);
    assert_eq!(Microfacets::new(0.0, 0.0).regularized().alpha(), (0.1, 0.1));
    assert_eq!(Microfacets::new(0.12, 0.2).regularized().alpha(), (0.24, 0.3));
    assert_eq!(Microfacets::new(0.5, 0.31).regularized().alpha(), (0.5, 0.31));
}

/// Only glossy surfaces have a glossy roughness, and it is that of their facets.
#[test]
fn glossy_roughness_is_alpha() {
    let n = Normal3::new(0.0, 0.0, 1.0);
    for row in &catalogue() {
        let bsdf = Bsdf::new(n, n, Vector3::new(1.0, 0.0, 0.0), row.kind);
        assert_eq!(bsdf.glossy_roughness() > 0.0, bsdf.lobes().is_glossy(), "{}", row.name);
    }
    let brushed = Bsdf::new(n, n, Vector3::new(1.0, 0.0, 0.0), BsdfKind::Conductor(copper(0.1, 0.5)));
    assert!(is_near(brushed.glossy_roughness(), 0.3, 1e-6, 0.0));
}

/// The colour of auxiliary images is about what a furnace shows.
#[test]
fn albedo_is_near_the_furnace() {
    for row in &catalogue() {
        let wo = direction(40.0, 0.5);
        let mut rng = Rng::new(seed(row.name, 30), 0);
        let mut furnace = Moments::default();
        for _ in 0..20_000 {
            let sample = draw(&row.kind, wo, TransportMode::Importance, Lobes::ALL, &mut rng);
            furnace.push(sample.map_or(0.0, |s| f64::from(s.weight[3])));
        }
        let albedo = f64::from(row.kind.albedo(wo)[3]);
        let tolerance = 4.0 * furnace.standard_deviation() / 4.0 + 0.02;
        assert!((albedo - furnace.mean()).abs() < tolerance, "{}: {albedo} {}", row.name, furnace.mean());
    }
}

/// Lobe sets behave as sets.
#[test]
fn lobes_are_sets() {
    let all = Lobes::EACH.into_iter().fold(Lobes::NONE, |a, b| a | b);
    assert_eq!(all, Lobes::ALL);
    assert_eq!(Lobes::REFLECT | Lobes::TRANSMIT, Lobes::ALL);
    assert_eq!(Lobes::DIFFUSE | Lobes::GLOSSY | Lobes::SPECULAR, Lobes::ALL);
    assert_eq!(!Lobes::SPECULAR, Lobes::NON_SPECULAR);
    assert!(Lobes::SPECULAR_REFLECT.is_specular() && !Lobes::NONE.is_specular() && !Lobes::ALL.is_specular());
    assert!((Lobes::GLOSSY & Lobes::TRANSMIT) == Lobes::GLOSSY_TRANSMIT);
    assert_eq!(format!("{:?}", Lobes::DIFFUSE_REFLECT), "{diffuse reflect}");
    assert!(std::mem::size_of::<Bsdf>() <= 192, "{}", std::mem::size_of::<Bsdf>());
}
