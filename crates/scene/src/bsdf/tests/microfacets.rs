//! The GGX distribution and what rough surfaces do with it.

use super::*;

/// Facets cover the surface once: ∫ D(wm) cos dwm = 1 (SPEC BRDF-17 for GGX).
#[test]
fn facets_cover_the_surface() {
    for (x, y) in [(0.1, 0.1), (0.5, 0.5), (1.0, 1.0), (0.1, 0.6)] {
        let facets = Microfacets::new(x, y);
        let area = integrate_sphere(|w| if w.z > 0.0 { f64::from(facets.d(w) * w.z) } else { 0.0 }, 1e-3);
        assert!((area - 1.0).abs() < 2e-3, "alpha {x} {y}: {area}");
    }
}

/// The visible facets fill the surface as seen from any side: ∫ G1 max(0, wo·wm) D dwm = cos_o [Heitz 2014 (14)].
#[test]
fn visible_facets_fill_the_projected_surface() {
    for (x, y) in [(0.2, 0.2), (0.8, 0.8), (0.2, 0.7)] {
        let facets = Microfacets::new(x, y);
        for angle in [0.0, 45.0, 80.0] {
            let wo = direction(angle, 0.8);
            let seen = |wm: Vector3| {
                if wm.z <= 0.0 { 0.0 } else { f64::from(facets.g1(wo) * wo.dot(wm).max(0.0) * facets.d(wm)) }
            };
            let area = integrate_sphere(seen, 1e-3);
            assert!((area - f64::from(wo.z)).abs() < 3e-3, "alpha {x} {y}, {angle}°: {area} {}", wo.z);
        }
    }
}

/// Facets visible from a direction come as often as their density says.
#[test]
fn visible_normals_have_their_density() {
    for (i, (x, y)) in [(0.1, 0.1), (0.7, 0.7), (0.1, 0.6)].into_iter().enumerate() {
        let facets = Microfacets::new(x, y);
        for angle in [0.0, 50.0, 88.0] {
            let wo = direction(angle, 2.5);
            sphere_chi_square(
                20_000,
                seed("visible normals", i),
                |rng| Some(facets.sample_visible_normal(wo, Point2::new(rng.next_f32(), rng.next_f32()))),
                |wm| if wm.z > 0.0 && wm.dot(wo) > 0.0 { facets.visible_normal_pdf(wo, wm) } else { 0.0 },
                significance(),
            )
            .unwrap_or_else(|e| panic!("alpha {x} {y}, {angle}°: {e}"));
        }
    }
}

/// The forms of G that avoid division are G, and lie between 0 and G1.
#[test]
fn shadowing_functions_agree() {
    let facets = Microfacets::new(0.3, 0.7);
    let lambda = |w: Vector3| {
        let slope2 = (0.09 * w.x * w.x + 0.49 * w.y * w.y) / (w.z * w.z);
        0.5 * ((1.0 + slope2).sqrt() - 1.0) // [Heitz 2014 (72)]
    };
    let mut rng = Rng::new(seed("G", 0), 0);
    for _ in 0..500 {
        let (a, b) = (uniform_sphere(&mut rng), uniform_sphere(&mut rng));
        let g = 1.0 / (1.0 + lambda(a) + lambda(b));
        assert!(is_near(facets.g1(a), 1.0 / (1.0 + lambda(a)), 1e-4, 1e-6));
        assert!(is_near(facets.g(a, b), g, 1e-4, 1e-6));
        assert!(is_near(facets.g_over_g1(a, b), g * (1.0 + lambda(a)), 1e-4, 1e-6));
        assert!(facets.g(a, b) <= facets.g1(a).min(facets.g1(b)) * 1.0001);
    }
}

/// Part of the light that should bounce several times among facets is lost: of a lossless metal's flux the stated
/// fraction remains, at normal incidence and at 60°. It is 1 - ln 2 for alpha 1 at normal incidence, where the integral has
/// a closed form. Asserted because the model lacks it, not because it is right.
#[test]
fn single_scattering_loses_energy() {
    for (alpha, normal, oblique) in
        [(0.1, 0.987, 0.968), (0.5, 0.687, 0.698), (1.0, 1.0 - 2.0_f64.ln(), 0.451)]
    {
        for (angle, expected) in [(0.0, normal), (60.0, oblique)] {
            let (metal, wo) = (silver(alpha), direction(angle, 0.0));
            let mut rng = Rng::new(seed("loss", angle as usize), 0);
            let mut kept = Moments::default();
            for _ in 0..50_000 {
                let u = Point2::new(rng.next_f32(), rng.next_f32());
                kept.push(metal.sample(wo, u, Lobes::ALL).map_or(0.0, |s| f64::from(s.weight[0])));
            }
            assert!((kept.mean() - expected).abs() < 0.008, "alpha {alpha}, {angle}°: {}", kept.mean());
        }
    }
}

/// SPEC BRDF-16: a rough metal lit at 70 to 80° is brightest beyond the mirror angle.
#[test]
fn highlights_are_off_specular() {
    let metal = copper(0.3, 0.3);
    for angle in [70.0, 75.0, 80.0] {
        let wi = direction(angle, 0.0);
        let brightness = |theta: f32| metal.eval(direction(theta, std::f32::consts::PI), wi, Lobes::ALL)[0];
        let peak = (0..900)
            .map(|i| i as f32 * 0.1)
            .max_by(|a, b| brightness(*a).total_cmp(&brightness(*b)))
            .unwrap();
        assert!(peak > angle + 1.0, "lit at {angle}°, the peak is at {peak}°");
    }
    // At normal incidence it is where a mirror would show it.
    let wi = direction(0.0, 0.0);
    let on_axis = metal.eval(direction(0.0, 0.0), wi, Lobes::ALL)[0];
    assert!(on_axis >= metal.eval(direction(5.0, 0.0), wi, Lobes::ALL)[0]);
}

/// A brushed metal spreads light across its grooves.
#[test]
fn brushed_metal_spreads_across_the_grooves() {
    let metal = copper(0.05, 0.4);
    let wo = direction(0.0, 0.0);
    let along = metal.eval(wo, direction(20.0, 0.0), Lobes::ALL)[0];
    let across = metal.eval(wo, direction(20.0, std::f32::consts::FRAC_PI_2), Lobes::ALL)[0];
    assert!(across > 10.0 * along, "{across} {along}");
}

/// As roughness vanishes, rough glass sends light where smooth glass does.
#[test]
fn rough_glass_tends_to_smooth_glass() {
    let wo = direction(40.0, 0.3);
    for lobes in [Lobes::REFLECT, Lobes::TRANSMIT] {
        let u = Point2::new(0.3, 0.7);
        let smooth = glass(0.0, 0.0, 1.5).sample(wo, 0.5, u, TransportMode::Radiance, lobes).unwrap();
        let rough = glass(0.002, 0.002, 1.5).sample(wo, 0.5, u, TransportMode::Radiance, lobes).unwrap();
        assert!((smooth.wi - rough.wi).length() < 0.02);
        assert!(is_near(smooth.weight[0], rough.weight[0], 0.02, 0.0));
        assert!(smooth.is_specular() && !rough.is_specular());
    }
}

/// Roughness 0.25 is alpha 0.5; below alpha 0.001 a surface is a mirror.
#[test]
fn roughness_scale() {
    assert_eq!(Microfacets::alpha_from_roughness(0.25), 0.5);
    assert!(Microfacets::new(9e-4, 9e-4).is_smooth());
    assert!(!Microfacets::new(0.0, 2e-3).is_smooth());
}
