//! Metals and glass.

use super::*;

/// Roughness is the square of alpha, or alpha itself, along each tangent.
#[test]
fn roughness_becomes_alpha() {
    let mut fixture = Fixture::default();
    let mut alpha = |entity: Entity| match fixture.kind(&entity) {
        BsdfKind::Conductor(metal) => metal.microfacets.alpha(),
        other => panic!("{other:?}"),
    };
    assert_eq!(alpha(plain("conductor").with("roughness", floats(0.25))), (0.5, 0.5));
    let linear = plain("conductor").with("remaproughness", Value::Bools(vec![false]));
    assert_eq!(alpha(linear.clone().with("roughness", floats(0.25))), (0.25, 0.25));
    let brushed = linear.with("roughness", floats(0.25)).with("vroughness", floats(0.125));
    assert_eq!(alpha(brushed), (0.25, 0.125));
}

/// A metal given by its colour reflects that colour along the normal.
#[test]
fn metals_by_reflectance() {
    let mut fixture = Fixture::default();
    for r in [0.0, 0.04, 0.5, 0.9, 0.99] {
        let entity = plain("conductor").with("reflectance", named_spectrum("r"));
        fixture.assets.spectra.insert("r".to_owned(), vec![[300.0, r], [900.0, r]]);
        let BsdfKind::Conductor(metal) = fixture.kind(&entity) else { panic!("not metal") };
        let reflected = fresnel_conductor(1.0, metal.eta, metal.k)[1];
        assert!((reflected - r).abs() < 1e-4, "{reflected} is not {r}");
    }
    let both = plain("conductor").with("reflectance", floats(0.5)).with("k", floats(2.0));
    let (_, diagnostics) = fixture.build(&both);
    assert!(diagnostics.has_errors());
}

/// SPEC FRES-10: glass whose index falls with the wavelength turns violet light more than red light, and then a
/// path follows one wavelength; glass with one index keeps them all.
#[test]
fn dispersion_gives_up_wavelengths() {
    let mut fixture = Fixture::default();
    let crown = |nm: f32| 1.5 + 0.0042 / (nm * 1e-3).powi(2); // Cauchy's formula, nm to µm.
    let samples: Vec<[f32; 2]> = (36..=83).map(|i| [i as f32 * 10.0, crown(i as f32 * 10.0)]).collect();
    let prism = fixture.build_clean(&plain("dielectric").with("eta", Value::SpectrumSamples(samples)));
    let mut deviations = Vec::new();
    for u in [0.02, 0.5, 0.98] {
        let mut lambda = Wavelengths::sample_visible(u);
        let hero = lambda.lambda_nm()[0];
        let bsdf = fixture.bsdf(prism, &context(), &mut lambda).unwrap();
        assert!(lambda.secondary_terminated());
        let BsdfKind::Dielectric(glass) = bsdf.kind() else { panic!("not glass") };
        assert!((glass.eta - crown(hero)).abs() < 2e-3, "{} at {hero}", glass.eta);
        let wo = context().wo;
        let sample =
            bsdf.sample(wo, 0.5, Point2::new(0.5, 0.5), TransportMode::Radiance, Lobes::TRANSMIT).unwrap();
        deviations.push((hero, (-wo).angle_between(sample.wi)));
    }
    deviations.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert!(deviations[0].1 > deviations[1].1 && deviations[1].1 > deviations[2].1, "{deviations:?}");

    let plain_glass = fixture.build_clean(&plain("dielectric").with("eta", floats(1.7)));
    let mut lambda = Wavelengths::sample_visible(0.5);
    let _ = fixture.bsdf(plain_glass, &context(), &mut lambda);
    assert!(!lambda.secondary_terminated());
}

/// Glass with a name has its measured index.
#[test]
fn named_glass() {
    let mut fixture = Fixture::default();
    let BsdfKind::Dielectric(glass) =
        fixture.kind(&plain("dielectric").with("eta", named_spectrum("glass-BK7")))
    else {
        panic!("not glass")
    };
    assert!((1.50..1.54).contains(&glass.eta), "{}", glass.eta);
}

/// Anisotropy follows the first tangent, also when the frame is turned.
#[test]
fn grooves_follow_the_tangent() {
    let mut fixture = Fixture::default();
    let entity = plain("conductor").with("uroughness", floats(0.01)).with("vroughness", floats(0.25));
    let material = fixture.build_clean(&entity);
    let ctx = MaterialContext { shading_dpdu: Vector3::new(0.0, 5.0, 0.0), ..context() };
    let mut lambda = Wavelengths::sample_visible(0.5);
    let bsdf = fixture.bsdf(material, &ctx, &mut lambda).unwrap();
    assert!((bsdf.frame().x - Vector3::new(0.0, 1.0, 0.0)).length() < 1e-6);
    let wo = Vector3::new(0.0, 0.0, 1.0);
    let at = |x: f32, y: f32| {
        bsdf.eval(wo, Vector3::new(x, y, 1.0).normalized(), TransportMode::Radiance, Lobes::ALL)[0]
    };
    assert!(at(0.4, 0.0) > 10.0 * at(0.0, 0.4));
}

/// A spectrum that ends before the path's wavelength must not make light vanish: it counts as no interface.
#[test]
fn a_missing_index_is_one() {
    let fixture = Fixture::default();
    let index = RefractiveIndex(Spectrum::Constant(0.0));
    let mut lambda = Wavelengths::sample_visible(0.5);
    assert_eq!(index.of_hero(&fixture.textures, &mut lambda), 1.0);
}
