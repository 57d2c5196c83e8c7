//! What every BSDF must satisfy, checked for each line of one table, and what single models promise.

mod fresnel;
mod layered;
mod microfacets;

use std::f64::consts::TAU;

use etendue_math::statistics::{
    Moments, chi_square_test, integrate_sphere, mean_test, means_agree, sidak, sphere_chi_square,
};
use etendue_math::{Normal3, ONE_MINUS_EPSILON, Point2, Rng, Vector3, hash64};
use etendue_spectrum::Sampled;

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

/// One configuration of a BSDF.
struct Row {
    name: &'static str,
    kind: BsdfKind,
    /// Nothing is lost, so that a white furnace stays white.
    is_lossless: bool,
}

impl Row {
    /// `eval` is an estimate, and `pdf` a likeness of the density.
    fn is_stochastic(&self) -> bool {
        matches!(self.kind, BsdfKind::Layered(_))
    }

    /// `wo` above the surface, and below it where that differs.
    fn directions(&self) -> Vec<Vector3> {
        let above = [5.0_f32, 45.0, 75.0, 89.0].map(|angle| direction(angle, 0.7));
        if self.kind.lobes().is_transmissive() {
            above
                .into_iter()
                .chain([direction(160.0, 2.0), direction(130.0, 4.0), direction(95.0, 0.1)])
                .collect()
        } else {
            above.to_vec()
        }
    }
}

fn row(name: &'static str, kind: BsdfKind) -> Row {
    Row { name, kind, is_lossless: false }
}

fn lossless(name: &'static str, kind: BsdfKind) -> Row {
    Row { name, kind, is_lossless: true }
}

fn diffuse(reflectance: [f32; 4]) -> BsdfKind {
    BsdfKind::Diffuse(Diffuse { reflectance: Sampled::from_array(reflectance) })
}

fn sheet(reflectance: [f32; 4], transmittance: [f32; 4]) -> BsdfKind {
    BsdfKind::DiffuseTransmission(DiffuseTransmission {
        reflectance: Sampled::from_array(reflectance),
        transmittance: Sampled::from_array(transmittance),
    })
}

fn copper(alpha_x: f32, alpha_y: f32) -> Conductor {
    Conductor {
        microfacets: Microfacets::new(alpha_x, alpha_y),
        eta: Sampled::from_array([1.25, 1.1, 0.5, 0.25]),
        k: Sampled::from_array([2.2, 2.5, 2.7, 3.6]),
    }
}

/// A metal that reflects everything.
fn silver(alpha: f32) -> Conductor {
    Conductor {
        microfacets: Microfacets::new(alpha, alpha),
        eta: Sampled::splat(1e-3),
        k: Sampled::splat(1e4),
    }
}

fn glass(alpha_x: f32, alpha_y: f32, eta: f32) -> Dielectric {
    Dielectric { microfacets: Microfacets::new(alpha_x, alpha_y), eta }
}

fn coated(coat: Dielectric, base: Base) -> Layered {
    Layered { coat, base, thickness: 0.01, g: 0.0, albedo: Sampled::ZERO, max_depth: 10, n_samples: 1 }
}

fn white_base() -> Base {
    Base::Diffuse(Diffuse { reflectance: Sampled::ONE })
}

fn grey_base() -> Base {
    Base::Diffuse(Diffuse { reflectance: Sampled::from_array([0.2, 0.4, 0.6, 0.8]) })
}

/// The table: a new configuration is one line.
fn table() -> Vec<Row> {
    // Deep walks: where they are cut, samples and estimates of f stop at slightly different events.
    let milky = |layered: Layered| Layered {
        albedo: Sampled::splat(0.9),
        thickness: 0.5,
        g: 0.4,
        max_depth: 100,
        ..layered
    };
    vec![
        row("diffuse", diffuse([0.1, 0.4, 0.6, 0.9])),
        lossless("diffuse, white", diffuse([1.0; 4])),
        row("sheet", sheet([0.1, 0.2, 0.3, 0.4], [0.5, 0.4, 0.2, 0.1])),
        lossless("sheet, white", sheet([0.3; 4], [0.7; 4])),
        row("copper mirror", BsdfKind::Conductor(copper(0.0, 0.0))),
        row("copper, alpha 0.05", BsdfKind::Conductor(copper(0.05, 0.05))),
        row("copper, alpha 0.4", BsdfKind::Conductor(copper(0.4, 0.4))),
        row("copper, alpha 1", BsdfKind::Conductor(copper(1.0, 1.0))),
        row("copper, brushed", BsdfKind::Conductor(copper(0.1, 0.5))),
        lossless("silver mirror", BsdfKind::Conductor(silver(0.0))),
        lossless("glass", BsdfKind::Dielectric(glass(0.0, 0.0, 1.5))),
        lossless("air in water", BsdfKind::Dielectric(glass(0.0, 0.0, 1.0 / 1.33))),
        lossless("no interface", BsdfKind::Dielectric(glass(0.3, 0.3, 1.0))),
        row("glass, alpha 0.1", BsdfKind::Dielectric(glass(0.1, 0.1, 1.5))),
        row("glass, alpha 0.5", BsdfKind::Dielectric(glass(0.5, 0.5, 1.5))),
        row("glass, brushed", BsdfKind::Dielectric(glass(0.6, 0.2, 1.5))),
        row("diamond, alpha 0.3", BsdfKind::Dielectric(glass(0.3, 0.3, 2.4))),
        row("rough air in water", BsdfKind::Dielectric(glass(0.3, 0.3, 1.0 / 1.33))),
        lossless("pane", BsdfKind::ThinDielectric(ThinDielectric { eta: 1.5 })),
        row("plastic", BsdfKind::Layered(coated(glass(0.0, 0.0, 1.5), grey_base()))),
        row("rough plastic", BsdfKind::Layered(coated(glass(0.3, 0.3, 1.5), grey_base()))),
        row("milky plastic", BsdfKind::Layered(milky(coated(glass(0.2, 0.2, 1.5), grey_base())))),
        row(
            "mirror in lacquer",
            BsdfKind::Layered(coated(glass(0.0, 0.0, 1.5), Base::Conductor(copper(0.0, 0.0)))),
        ),
        row(
            "rough lacquer",
            BsdfKind::Layered(coated(glass(0.3, 0.3, 1.5), Base::Conductor(copper(0.0, 0.0)))),
        ),
        row(
            "metal in lacquer",
            BsdfKind::Layered(coated(glass(0.0, 0.0, 1.5), Base::Conductor(copper(0.3, 0.3)))),
        ),
        row("rough both", BsdfKind::Layered(coated(glass(0.2, 0.1, 1.5), Base::Conductor(copper(0.2, 0.4))))),
        row(
            "milky lacquer",
            BsdfKind::Layered(milky(coated(glass(0.0, 0.0, 1.5), Base::Conductor(copper(0.0, 0.0))))),
        ),
    ]
}

/// A unit vector from polar angle in degrees and azimuth in radians.
fn direction(theta_deg: f32, phi: f32) -> Vector3 {
    let (sin, cos) = theta_deg.to_radians().sin_cos();
    Vector3::new(sin * phi.cos(), sin * phi.sin(), cos)
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

fn draw(
    kind: &BsdfKind,
    wo: Vector3,
    mode: TransportMode,
    lobes: Lobes,
    rng: &mut Rng,
) -> Option<BsdfSample> {
    let (u_component, u) = (rng.next_f32(), Point2::new(rng.next_f32(), rng.next_f32()));
    kind.sample(wo, u_component, u, mode, lobes)
}

fn is_near(a: f32, b: f32, relative: f32, absolute: f32) -> bool {
    (a - b).abs() <= relative * a.abs().max(b.abs()) + absolute
}

const BOTH_MODES: [TransportMode; 2] = [TransportMode::Radiance, TransportMode::Importance];

/// Directions come as often as their density says, for all lobes together and for reflection and transmission apart.
#[test]
fn samples_have_the_density_they_claim() {
    for row in table().iter().filter(|row| !row.is_stochastic() && row.kind.lobes().has_non_specular()) {
        for (i, wo) in row.directions().into_iter().enumerate() {
            for lobes in [Lobes::ALL, Lobes::TRANSMIT] {
                if !row.kind.lobes().intersects(lobes) {
                    continue;
                }
                sphere_chi_square(
                    N_SAMPLES,
                    seed(row.name, i),
                    |rng| draw(&row.kind, wo, TransportMode::Radiance, lobes, rng).map(|s| s.wi),
                    |wi| row.kind.pdf(wo, wi, lobes),
                    significance(),
                )
                .unwrap_or_else(|e| panic!("{}, wo {wo:?}, {lobes:?}: {e}", row.name));
            }
        }
    }
}

/// The test above must notice a density that is wrong by 5 %, also where its integral is right.
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
            let result = sphere_chi_square(
                n_samples,
                seed("mutation", i),
                |rng| draw(&kind, wo, TransportMode::Radiance, Lobes::ALL, rng).map(|s| s.wi),
                |wi| kind.pdf(wo, wi, Lobes::ALL) * factor(wi),
                significance(),
            );
            assert!(result.is_err(), "mutation {i} of {kind:?} passed");
        }
    }
}

/// A density integrates to at most 1; the likeness of coated surfaces may exceed it by little.
#[test]
fn densities_integrate_to_at_most_one() {
    for row in table().iter().filter(|row| row.kind.lobes().has_non_specular()) {
        let bound = if row.is_stochastic() { 1.05 } else { 1.005 };
        for wo in row.directions() {
            let total = integrate_sphere(|wi| f64::from(row.kind.pdf(wo, wi, Lobes::ALL)), 1e-2);
            assert!(total < bound, "{}, wo {wo:?}: {total}", row.name);
        }
    }
}

/// A sample's weight is f |cos| / pdf of its direction, its density is what `pdf` says, and its lobe is present.
#[test]
fn weights_are_f_cos_over_pdf() {
    for row in &table() {
        let mut rng = Rng::new(seed(row.name, 1), 0);
        for (wo, mode) in row.directions().into_iter().flat_map(|wo| BOTH_MODES.map(|mode| (wo, mode))) {
            for _ in 0..200 {
                let Some(sample) = draw(&row.kind, wo, mode, Lobes::ALL, &mut rng) else { continue };
                assert!(row.kind.lobes().contains(sample.lobe), "{}: {:?}", row.name, sample.lobe);
                assert!(Lobes::EACH.contains(&sample.lobe), "{}: one lobe", row.name);
                assert!((sample.wi.length() - 1.0).abs() < 1e-4, "{}: {:?}", row.name, sample.wi);
                assert_eq!(sample.is_transmission(), wo.z * sample.wi.z < 0.0, "{}", row.name);
                let pdf = row.kind.pdf(wo, sample.wi, Lobes::ALL);
                if sample.is_specular() {
                    assert!(
                        sample.pdf_w == 0.0 && sample.pmf > 0.0 && sample.pmf <= 1.0 + 1e-6,
                        "{}",
                        row.name
                    );
                    continue;
                }
                assert!(sample.pmf == 0.0 && sample.pdf_w > 0.0, "{}", row.name);
                assert!(is_near(sample.pdf_w, pdf, 2e-2, 1e-6), "{}: {} {pdf}", row.name, sample.pdf_w);
                if row.is_stochastic() {
                    continue;
                }
                let expected = row.kind.eval(wo, sample.wi, mode, Lobes::ALL) * (sample.wi.z.abs() / pdf);
                for i in 0..4 {
                    let (got, want) = (sample.weight[i], expected[i]);
                    assert!(is_near(got, want, 5e-3, 1e-6), "{}, {mode:?}, {wo:?}: {got} {want}", row.name);
                }
            }
        }
    }
}

/// Helmholtz: light may take every way backwards. Refracted radiance is symmetric after division by the squared index.
#[test]
fn light_paths_may_be_reversed() {
    for row in table().iter().filter(|row| !row.is_stochastic()) {
        let eta = if let BsdfKind::Dielectric(bsdf) = row.kind { bsdf.eta } else { 1.0 };
        let index2 = |w: Vector3| if w.z > 0.0 { 1.0 } else { eta * eta };
        let mut rng = Rng::new(seed(row.name, 2), 0);
        for _ in 0..2000 {
            let (a, b) = (uniform_sphere(&mut rng), uniform_sphere(&mut rng));
            let forward = row.kind.eval(a, b, TransportMode::Radiance, Lobes::ALL);
            let backward = row.kind.eval(b, a, TransportMode::Radiance, Lobes::ALL);
            let adjoint = row.kind.eval(b, a, TransportMode::Importance, Lobes::ALL);
            for i in 0..4 {
                // The radiance arriving along b is L / index², and so is what leaves along a.
                let (f, r) = (forward[i] * index2(b), backward[i] * index2(a));
                assert!(is_near(f, r, 2e-3, 1e-5), "{}: {f} {r}", row.name);
                assert!(
                    is_near(forward[i], adjoint[i], 2e-3, 1e-5),
                    "{}: {} {}",
                    row.name,
                    forward[i],
                    adjoint[i]
                );
            }
        }
    }
}

/// No surface reflects and transmits more flux than arrives; one without losses all of it.
#[test]
fn flux_is_conserved() {
    for row in &table() {
        for (i, wo) in row.directions().into_iter().enumerate() {
            for mode in BOTH_MODES {
                let mut rng = Rng::new(seed(row.name, 3 + i), 0);
                let mut total = Moments::default();
                for _ in 0..4000 {
                    let flux = draw(&row.kind, wo, mode, Lobes::ALL, &mut rng).map_or(0.0, |sample| {
                        let scale =
                            if mode == TransportMode::Radiance { sample.eta * sample.eta } else { 1.0 };
                        f64::from(sample.weight.max_value() * scale)
                    });
                    total.push(flux);
                }
                let mean = total.mean();
                let noise = 4.5 * total.standard_error();
                assert!(mean <= 1.0 + noise + 1e-4, "{}, {mode:?}, wo {wo:?}: {mean}", row.name);
                if row.is_lossless {
                    assert!((mean - 1.0).abs() <= noise + 1e-3, "{}, {mode:?}, wo {wo:?}: {mean}", row.name);
                }
            }
        }
    }
}

/// SPEC BRDF-6: nothing reflects negative light.
#[test]
fn f_is_never_negative() {
    for row in &table() {
        let mut rng = Rng::new(seed(row.name, 20), 0);
        for mode in BOTH_MODES {
            for _ in 0..1000 {
                let (wo, wi) = (uniform_sphere(&mut rng), uniform_sphere(&mut rng));
                assert!(row.kind.eval(wo, wi, mode, Lobes::ALL).min_value() >= 0.0, "{}", row.name);
            }
        }
    }
}

/// SPEC BRDF-9: a BSDF is the sum of its lobes, pointwise in `eval` and in the mean of samples.
#[test]
fn lobes_sum_to_the_whole() {
    for row in &table() {
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

/// No direction and no random number, however extreme, makes a number that is none.
#[test]
fn extremes_stay_finite() {
    let tiny = f32::MIN_POSITIVE;
    let mut directions = vec![Vector3::new(0.0, 0.0, 1.0), Vector3::new(0.0, 0.0, -1.0)];
    for z in [0.0, tiny, 1e-20, 1e-7, 1e-3, 0.999_999_9] {
        let r = (1.0_f32 - z * z).max(0.0).sqrt();
        for sign in [1.0, -1.0] {
            directions.push(Vector3::new(r, 0.0, sign * z));
            directions.push(Vector3::new(-r * 0.6, r * 0.8, sign * z));
        }
    }
    let numbers = [0.0, tiny, 0.25, 0.5, 1.0 - 1e-4, ONE_MINUS_EPSILON];
    for row in &table() {
        for mode in BOTH_MODES {
            for &wo in &directions {
                for &wi in &directions {
                    let f = row.kind.eval(wo, wi, mode, Lobes::ALL);
                    assert!(
                        f.is_finite() || wo.z.abs().min(wi.z.abs()) < 1e-18,
                        "{}: {f:?} {wo:?} {wi:?}",
                        row.name
                    );
                    assert!(!f.to_array().iter().any(|x| x.is_nan()), "{}: {f:?} {wo:?} {wi:?}", row.name);
                    assert!(row.kind.pdf(wo, wi, Lobes::ALL) >= 0.0, "{}: pdf {wo:?} {wi:?}", row.name);
                }
                for u in numbers.iter().flat_map(|a| numbers.iter().map(move |b| (*a, *b))) {
                    for u_component in numbers {
                        let point = Point2::new(u.0, u.1);
                        let Some(s) = row.kind.sample(wo, u_component, point, mode, Lobes::ALL) else {
                            continue;
                        };
                        let is_sound = s.wi.is_finite() && s.weight.is_finite() && s.pdf_w.is_finite();
                        assert!(is_sound && s.weight.min_value() >= 0.0, "{}: {wo:?} {u:?} {s:?}", row.name);
                    }
                }
            }
        }
    }
}

/// SPEC BRDF-11, BRDF-4, BRDF-8: Lambert's albedo is its coefficient, and cos² of its samples is uniform.
#[test]
fn lambert_reflects_its_albedo() {
    let (kind, wo) = (diffuse([0.3, 0.5, 0.7, 0.9]), direction(30.0, 0.0));
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
    for row in &table() {
        let bsdf = Bsdf::new(n, n, tangent, row.kind);
        let (wo, wi) = (direction(40.0, 1.0), direction(55.0, 3.0));
        let (world_o, world_i) = (bsdf.frame().to_world(wo), bsdf.frame().to_world(wi));
        if !row.is_stochastic() {
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
    for row in &table() {
        let bsdf = Bsdf::new(n, n, Vector3::new(1.0, 0.0, 0.0), row.kind);
        assert_eq!(bsdf.glossy_roughness() > 0.0, bsdf.lobes().is_glossy(), "{}", row.name);
    }
    let brushed = Bsdf::new(n, n, Vector3::new(1.0, 0.0, 0.0), BsdfKind::Conductor(copper(0.1, 0.5)));
    assert!(is_near(brushed.glossy_roughness(), 0.3, 1e-6, 0.0));
}

/// The colour of auxiliary images is about what a furnace shows.
#[test]
fn albedo_is_near_the_furnace() {
    for row in &table() {
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
