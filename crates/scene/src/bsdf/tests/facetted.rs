//! Facets other than those of GGX: their geometry, and all bounces among them.

use super::*;
use crate::bsdf::facetted::{AnyFacets, CompensatedDielectric, FacetShape, Facets, FresnelForm};
use crate::bsdf::fresnel::fresnel_schlick;

fn beckmann(alpha_x: f32, alpha_y: f32) -> AnyFacets {
    let alphas = Microfacets::new(alpha_x, alpha_y);
    AnyFacets { alphas, shape: FacetShape::Beckmann, fresnel: FresnelForm::Exact }
}

/// Beckmann's facets cover the surface once, and those visible fill it as seen from any side: `∫ D cos = 1`,
/// `∫ D_visible = 1`.
#[test]
fn beckmanns_facets_cover_the_surface() {
    for (x, y) in [(0.2, 0.2), (0.9, 0.9), (0.2, 0.7)] {
        let facets = beckmann(x, y);
        let area = integrate_sphere(|w| if w.z > 0.0 { f64::from(facets.d(w) * w.z) } else { 0.0 }, 1e-3);
        assert!((area - 1.0).abs() < 2e-3, "alpha {x} {y}: {area}");
        for angle in [0.0, 45.0, 80.0, 89.0] {
            let wo = direction(angle, 0.8);
            let seen = |wm: Vector3| {
                let is_visible = wm.z > 0.0 && wo.dot(wm) > 0.0;
                if is_visible { f64::from(facets.visible_normal_pdf(wo, wm)) } else { 0.0 }
            };
            let area = integrate_sphere(seen, 1e-3);
            assert!((area - 1.0).abs() < 3e-3, "alpha {x} {y}, {angle}°: {area}");
        }
    }
}

/// Beckmann's facets visible from a direction come as often as their density says.
#[test]
fn beckmanns_visible_normals_have_their_density() {
    for (i, (x, y)) in [(0.1, 0.1), (0.7, 0.7), (0.1, 0.6)].into_iter().enumerate() {
        let facets = beckmann(x, y);
        for angle in [0.0, 50.0, 88.0, 120.0] {
            let wo = direction(angle, 2.5);
            let up = if wo.z < 0.0 { -wo } else { wo };
            sphere_chi_square(
                20_000,
                seed("Beckmann's normals", i),
                |rng| Some(facets.sample_visible_normal(wo, Point2::new(rng.next_f32(), rng.next_f32()))),
                |wm| if wm.z > 0.0 && wm.dot(up) > 0.0 { facets.visible_normal_pdf(wo, wm) } else { 0.0 },
                significance(),
            )
            .unwrap_or_else(|e| panic!("alpha {x} {y}, {angle}°: {e}"));
        }
    }
}

/// Smith's function of Beckmann's facets as it is usually printed, in double precision.
#[test]
fn beckmanns_masking_by_its_formula() {
    let facets = beckmann(0.3, 0.7);
    let lambda = |w: Vector3| {
        let tan = (0.09 * w.x * w.x + 0.49 * w.y * w.y).sqrt() / w.z.abs();
        let a = f64::from(1.0 / tan);
        let bell = (-a * a).exp() / (a * std::f64::consts::PI.sqrt());
        (0.5 * (etendue_math::statistics::erf(a) - 1.0 + bell)) as f32 // [Heitz 2014 (81)]
    };
    let mut rng = Rng::new(seed("Beckmann's G", 0), 0);
    for _ in 0..500 {
        let (a, b) = (uniform_sphere(&mut rng), uniform_sphere(&mut rng));
        let g = 1.0 / (1.0 + lambda(a) + lambda(b));
        assert!(is_near(facets.g_over_cosines(a, b) * (a.z * b.z).abs(), g, 1e-3, 1e-6));
        assert!(is_near(facets.g_over_g1(a, b), g * (1.0 + lambda(a)), 1e-3, 1e-6));
    }
}

/// With facets of GGX and Fresnel's equations, the general metal and glass are the plain ones, bit for bit.
#[test]
fn general_facets_contain_the_plain_ones() {
    let mut rng = Rng::new(seed("general", 0), 0);
    let general = |alphas| AnyFacets { alphas, shape: FacetShape::Ggx, fresnel: FresnelForm::Exact };
    let (metal, pane) = (copper(0.2, 0.4), glass(0.3, 0.1, 1.5));
    let any_metal = Conductor { microfacets: general(metal.microfacets), eta: metal.eta, k: metal.k };
    let any_glass = Dielectric { microfacets: general(pane.microfacets), eta: pane.eta };
    let pairs = [
        (BsdfKind::Conductor(metal), BsdfKind::Facetted(Facetted::Conductor(any_metal))),
        (BsdfKind::Dielectric(pane), BsdfKind::Facetted(Facetted::Dielectric(any_glass))),
    ];
    for (plain, any) in pairs {
        for _ in 0..500 {
            let (a, b) = (uniform_sphere(&mut rng), uniform_sphere(&mut rng));
            let mode = TransportMode::Radiance;
            assert_eq!(plain.eval(a, b, mode, Lobes::ALL), any.eval(a, b, mode, Lobes::ALL));
            assert_eq!(plain.pdf(a, b, Lobes::ALL), any.pdf(a, b, Lobes::ALL));
            let u = Point2::new(rng.next_f32(), rng.next_f32());
            assert_eq!(plain.sample(a, 0.3, u, mode, Lobes::ALL), any.sample(a, 0.3, u, mode, Lobes::ALL));
        }
    }
}

/// SPEC FRES-4: Schlick's fit is what smooth glass and metal reflect if asked for.
#[test]
fn schlicks_fit_may_be_chosen() {
    let microfacets = AnyFacets {
        alphas: Microfacets::new(0.0, 0.0),
        shape: FacetShape::Ggx,
        fresnel: FresnelForm::Schlick,
    };
    let pane = BsdfKind::Facetted(Facetted::Dielectric(Dielectric { microfacets, eta: 1.5 }));
    let metal = copper(0.0, 0.0);
    let metal = Conductor { microfacets, eta: metal.eta, k: metal.k };
    let mirror = BsdfKind::Facetted(Facetted::Conductor(metal));
    let f0 = crate::bsdf::fresnel::fresnel_conductor(1.0, metal.eta, metal.k);
    for angle in [0.0_f32, 60.0, 85.0] {
        let wo = direction(angle, 0.3);
        let reflected = |kind: &BsdfKind| {
            let u = Point2::new(0.5, 0.5);
            kind.sample(wo, 0.0, u, TransportMode::Radiance, Lobes::ALL).map(|s| s.weight * s.pmf).unwrap()
        };
        assert!(is_near(reflected(&pane)[0], fresnel_schlick(wo.z, 1.5), 1e-5, 0.0));
        let expected = f0[2] + (1.0 - f0[2]) * (1.0 - wo.z).powi(5);
        assert!(is_near(reflected(&mirror)[2], expected, 1e-4, 0.0));
    }
}

/// All bounces: a white metal keeps everything within 1 % at any roughness and angle; a brushed one within 3 %.
/// Copper gains what its colour leaves of the later bounces, more in red than in blue.
#[test]
fn all_bounces_fill_the_furnace() {
    let albedo = |metal: Conductor, shape, angle: f32, i: usize| {
        let microfacets = AnyFacets { alphas: metal.microfacets, shape, fresnel: FresnelForm::Exact };
        let once = Conductor { microfacets, eta: metal.eta, k: metal.k };
        let all = crate::bsdf::facetted::CompensatedConductor::new(once);
        let kind = BsdfKind::Facetted(Facetted::CompensatedConductor(all));
        let wo = direction(angle, 0.6);
        crate::bsdf::laws::albedo(&kind, wo, TransportMode::Radiance, Lobes::ALL)[i].value
    };
    let mut worst = (0.0_f64, String::new());
    for shape in [FacetShape::Ggx, FacetShape::Beckmann] {
        for alpha in [0.03, 0.2, 0.45, 0.7, 1.0] {
            for angle in [0.0, 40.0, 70.0, 85.0] {
                let kept = albedo(silver(alpha), shape, angle, 0);
                if (kept - 1.0).abs() > worst.0 {
                    worst = ((kept - 1.0).abs(), format!("{shape:?}, alpha {alpha}, {angle}°: {kept}"));
                }
            }
        }
    }
    assert!(worst.0 < 0.01, "{}", worst.1);
    let mut kept = Vec::new();
    for (x, y) in [(0.1, 0.5), (0.2, 0.4)] {
        for angle in [0.0, 40.0, 70.0, 85.0] {
            let brushed = Conductor { microfacets: Microfacets::new(x, y), ..silver(0.1) };
            kept.push(albedo(brushed, FacetShape::Ggx, angle, 0));
        }
    }
    assert!(kept.iter().all(|kept| (kept - 1.0).abs() < 0.03), "{kept:?}");
    let gain = |i: usize| {
        let once = crate::bsdf::laws::albedo(
            &BsdfKind::Conductor(copper(0.8, 0.8)),
            direction(30.0, 0.6),
            TransportMode::Radiance,
            Lobes::ALL,
        );
        albedo(copper(0.8, 0.8), FacetShape::Ggx, 30.0, i) / once[i].value
    };
    assert!(gain(3) > gain(0) && gain(0) > 1.0, "{} {}", gain(3), gain(0));
}

/// All bounces of glass: nothing is lost within 1 % from either side and in both modes, at any roughness and angle, for
/// indices between those of the tables too.
#[test]
fn all_bounces_fill_the_furnace_of_glass() {
    use crate::bsdf::laws::albedo;
    let kind = |shape, fresnel, alpha, eta| {
        let microfacets = AnyFacets { alphas: Microfacets::new(alpha, alpha), shape, fresnel };
        let once = Dielectric { microfacets, eta };
        BsdfKind::Facetted(Facetted::CompensatedDielectric(CompensatedDielectric::new(once)))
    };
    let cases = [
        (FacetShape::Ggx, FresnelForm::Exact, 1.05),
        (FacetShape::Ggx, FresnelForm::Exact, 1.4),
        (FacetShape::Ggx, FresnelForm::Schlick, 1.0 / 2.4),
        (FacetShape::Beckmann, FresnelForm::Exact, 1.6),
    ];
    for (shape, fresnel, eta) in cases {
        for alpha in [0.05, 0.25, 0.6, 1.0] {
            for angle in [0.0, 60.0, 85.0, 91.0, 110.0, 140.0] {
                let (kind, wo) = (kind(shape, fresnel, alpha, eta), direction(angle, 0.6));
                for mode in [TransportMode::Radiance, TransportMode::Importance] {
                    let kept = albedo(&kind, wo, mode, Lobes::ALL)[0];
                    assert!(
                        kept.is_near(1.0, 0.01),
                        "{shape:?}, {fresnel:?}, index {eta}, alpha {alpha}, {angle}°, {mode:?}: {kept:?}"
                    );
                }
            }
        }
    }
}

/// Later bounces leave on both sides, and none is added where a surface is smooth or has equal indices on both sides.
#[test]
fn later_bounces_of_glass() {
    let kind = |alpha, eta| {
        let microfacets = AnyFacets { alphas: Microfacets::new(alpha, alpha), ..beckmann(0.0, 0.0) };
        CompensatedDielectric::new(Dielectric { microfacets, eta })
    };
    let up = direction(0.0, 0.0);
    for (alpha, eta) in [(0.0, 1.5), (0.5, 1.0)] {
        let flat = kind(alpha, eta);
        assert!(flat.lobes().is_specular());
        assert_eq!(flat.eval(up, -up, TransportMode::Radiance, Lobes::ALL), Sampled::ZERO);
        assert_eq!(flat.pdf(up, up, Lobes::ALL), 0.0);
    }
    let rough = kind(1.0, 1.5);
    let f = |wi| rough.eval(up, wi, TransportMode::Radiance, Lobes::ALL)[0];
    // Towards the horizon one bounce sends next to nothing.
    assert!(f(direction(89.0, 1.0)) > 0.0 && f(direction(91.0, 1.0)) > 0.0);
}
