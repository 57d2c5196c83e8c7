//! Coated surfaces, whose values are estimates: what is true of their means.

use super::*;
use crate::bsdf::fresnel::fresnel_dielectric;

fn stochastic_rows() -> Vec<Configuration> {
    catalogue()
        .into_iter()
        .filter(|row| row.kind.is_stochastic() && row.kind.lobes().has_non_specular())
        .collect()
}

/// A direction of the upper hemisphere with density cos / pi, mixed with the claimed density so that peaks are found.
fn importance_sample(kind: &BsdfKind, wo: Vector3, rng: &mut Rng) -> Option<(Vector3, f32)> {
    let wi = if rng.next_f32() < 0.5 {
        etendue_math::warp::sample_cosine_hemisphere(Point2::new(rng.next_f32(), rng.next_f32()))
    } else {
        let sample = draw(kind, wo, TransportMode::Radiance, Lobes::ALL, rng)?;
        if sample.is_specular() {
            return None;
        }
        sample.wi
    };
    Some((wi, wi.z))
}

/// Asking twice gives the same answer, and both sides of the surface are alike.
#[test]
fn values_are_functions_of_their_arguments() {
    for row in stochastic_rows() {
        let (wo, wi) = (direction(35.0, 0.4), direction(50.0, 2.4));
        let eval = |a, b| row.kind.eval(a, b, TransportMode::Radiance, Lobes::ALL);
        assert_eq!(eval(wo, wi), eval(wo, wi), "{}", row.name);
        assert_eq!(eval(wo, wi), eval(-wo, -wi), "{}", row.name);
        assert_eq!(eval(wo, -wi), Sampled::ZERO, "{}", row.name);
        let sample = |w| row.kind.sample(w, 0.7, Point2::new(0.1, 0.6), TransportMode::Radiance, Lobes::ALL);
        assert_eq!(sample(wo), sample(wo), "{}", row.name);
        assert_eq!(sample(wo).map(|s| s.wi), sample(-wo).map(|s| -s.wi), "{}", row.name);
    }
}

/// Weights for combining techniques need a positive density wherever samples go, for every choice of lobes.
#[test]
fn density_is_positive_where_samples_go() {
    for row in stochastic_rows() {
        let mut rng = Rng::new(seed(row.name, 60), 0);
        for wo in directions(&row.kind) {
            for lobes in [Lobes::ALL, Lobes::DIFFUSE, Lobes::GLOSSY, Lobes::NON_SPECULAR] {
                for _ in 0..500 {
                    let Some(sample) = draw(&row.kind, wo, TransportMode::Radiance, lobes, &mut rng) else {
                        continue;
                    };
                    let pdf = row.kind.pdf(wo, sample.wi, lobes);
                    assert!(sample.is_specular() || pdf > 1e-4, "{}, {lobes:?}: {pdf}", row.name);
                }
            }
        }
    }
}

/// The density is like the truth: f cos / pdf of samples does not vary wildly, so that weights make sense.
#[test]
fn density_resembles_the_samples() {
    for row in stochastic_rows() {
        let wo = direction(40.0, 0.2);
        let mut rng = Rng::new(seed(row.name, 70), 0);
        let mut ratio = Moments::default();
        for _ in 0..40_000 {
            let Some((wi, cos)) = importance_sample(&row.kind, wo, &mut rng) else { continue };
            let f = row.kind.eval(wo, wi, TransportMode::Radiance, Lobes::ALL)[3] * cos;
            ratio.push(f64::from(f / row.kind.pdf(wo, wi, Lobes::ALL)));
        }
        assert!(ratio.mean() < 2.0 && ratio.standard_deviation() < 4.0, "{}: {ratio:?}", row.name);
    }
}

/// Where a coated surface has a density, it samples by it, and finds the same reflectance as its walks do.
#[test]
fn samples_by_density_have_it() {
    for (index, row) in stochastic_rows().into_iter().filter(|row| row.kind.has_density()).enumerate() {
        for wo in directions(&row.kind) {
            let by_density = |rng: &mut Rng| {
                let u = Point2::new(rng.next_f32(), rng.next_f32());
                row.kind.sample_by_density(wo, rng.next_f32(), u, TransportMode::Radiance)
            };
            let seed = seed("by density", index);
            sphere_chi_square(
                N_SAMPLES,
                seed,
                |rng| by_density(rng).filter(|sample| !sample.is_specular()).map(|sample| sample.wi),
                |wi| row.kind.pdf(wo, wi, Lobes::ALL),
                significance(),
            )
            .unwrap_or_else(|error| panic!("{}, {wo:?}: {error}", row.name));
            let mut rng = Rng::new(seed, 1);
            let mut albedo = |draw: &dyn Fn(&mut Rng) -> Option<BsdfSample>| -> Moments {
                (0..20_000)
                    .map(|_| draw(&mut rng).map_or(0.0, |sample| f64::from(sample.weight[0])))
                    .collect()
            };
            let walks = albedo(&|rng| draw(&row.kind, wo, TransportMode::Radiance, Lobes::ALL, rng));
            let density = albedo(&by_density);
            means_agree(&walks, &density, significance())
                .unwrap_or_else(|error| panic!("albedo of {}, {wo:?}: {error}", row.name));
        }
    }
}

/// A smooth coat over a diffuse base has a closed form: light enters, and what the coat reflects back inside is
/// diffused again, f = T(wo) T(wi) / (pi eta²) · ρ t / (1 - ρ r), with the internal diffuse reflectance r of the coat.
/// Absorption by the medium is made negligible.
#[test]
fn smooth_coat_over_diffuse_base() {
    let eta = 1.5;
    let thin = |reflectance: f32| Layered {
        thickness: 1e-6,
        max_depth: 200,
        ..coated(glass(0.0, 0.0, eta), Base::Diffuse(Diffuse { reflectance: Sampled::splat(reflectance) }))
    };
    // r = ∫ 2 cos F dcos for light from inside.
    let n = 200_000;
    let r: f64 = (0..n)
        .map(|i| {
            let cos = (f64::from(i) + 0.5) / f64::from(n);
            2.0 * cos * f64::from(fresnel_dielectric(-(cos as f32), eta)) / f64::from(n)
        })
        .sum();
    for reflectance in [0.2_f32, 0.8] {
        let layered = thin(reflectance);
        let mut ratio = Moments::default();
        let mut rng = Rng::new(seed("closed form", 0), 0);
        for _ in 0..100_000 {
            let (wo, wi) = (direction(80.0 * rng.next_f32(), 1.0), direction(80.0 * rng.next_f32(), 3.0));
            let t = |w: Vector3| f64::from(1.0 - fresnel_dielectric(w.z, eta));
            let rho = f64::from(reflectance);
            let expected = t(wo) * t(wi) / (TAU / 2.0 * f64::from(eta * eta)) * rho / (1.0 - rho * r);
            let f = layered.eval(wo, wi, TransportMode::Radiance, Lobes::ALL);
            ratio.push(f64::from(f[0]) / expected);
        }
        mean_test(&ratio, 1.0, significance()).unwrap_or_else(|e| panic!("albedo {reflectance}: {e}"));
    }
}

/// A white base under a smooth clear coat loses nothing but what cut walks carry; a rough coat loses, at each crossing
/// and inner reflection, what bounces among its facets (asserted because the model lacks it).
#[test]
fn a_clear_coat_keeps_almost_everything() {
    for (alpha, expected) in [(0.0, 1.0), (0.2, 0.806)] {
        let layered =
            Layered { thickness: 1e-6, max_depth: 100, ..coated(glass(alpha, alpha, 1.5), white_base()) };
        let kind = BsdfKind::Layered(layered);
        let mut rng = Rng::new(seed("white coat", 0), 0);
        let mut kept = Moments::default();
        for _ in 0..40_000 {
            let sample = draw(&kind, direction(30.0, 0.0), TransportMode::Radiance, Lobes::ALL, &mut rng);
            kept.push(sample.map_or(0.0, |s| f64::from(s.weight[0])));
        }
        let error = (kept.mean() - expected).abs();
        assert!(error < 0.005 + 4.5 * kept.standard_error(), "alpha {alpha}: {}", kept.mean());
    }
}

/// The coat's reflection and what comes from below are different lobes; the coat's can be had alone.
#[test]
fn coat_and_base_are_different_lobes() {
    let plastic = coated(glass(0.0, 0.0, 1.5), grey_base());
    assert_eq!(plastic.lobes(), Lobes::SPECULAR_REFLECT | Lobes::DIFFUSE_REFLECT);
    let rough = coated(glass(0.2, 0.2, 1.5), grey_base());
    assert_eq!(rough.lobes(), Lobes::GLOSSY_REFLECT | Lobes::DIFFUSE_REFLECT);
    let mirror = coated(glass(0.0, 0.0, 1.5), Base::Conductor(copper(0.0, 0.0)));
    assert_eq!(mirror.lobes(), Lobes::SPECULAR_REFLECT);
    let metal = coated(glass(0.0, 0.0, 1.5), Base::Conductor(copper(0.2, 0.2)));
    assert_eq!(metal.lobes(), Lobes::SPECULAR_REFLECT | Lobes::GLOSSY_REFLECT);
    let wo = direction(60.0, 0.0);
    let u = Point2::new(0.5, 0.5);
    let coat = plastic.sample(wo, 0.9, u, TransportMode::Radiance, Lobes::SPECULAR).unwrap();
    assert!(is_near(coat.weight[0], fresnel_dielectric(wo.z, 1.5), 1e-5, 0.0) && coat.pmf == 1.0);
}
