//! glTF's material with its extensions.

use super::*;
use crate::bsdf::facetted::{ExtendedPrincipled, PrincipledParameters, ThinFilm};
use crate::bsdf::fresnel::fresnel_dielectric;
use crate::bsdf::laws::{fault, reciprocity_error, sample_errors};

/// KHR_materials_iridescence: a film without thickness is Fresnel's surface of the index that glTF infers, one of half a
/// wavelength of path shows it too, and one of a quarter is a coat against reflection if its index is the root of that below.
#[test]
fn films_interfere() {
    let f0 = Sampled::splat(0.04);
    let reflected = |ior: f32, thickness_nm: f32, cos: f32| {
        ThinFilm { share: 1.0, ior, thickness_nm }.reflectance(cos, f0, [400.0, 500.0, 600.0, 700.0])
    };
    for cos in [1.0_f32, 0.7, 0.2] {
        let expected = fresnel_dielectric(cos, 1.5);
        assert!(is_near(reflected(1.3, 0.0, cos)[2], expected, 1e-4, 1e-6));
        let half_wave = 600.0 / (2.0 * 1.3 * (1.0 - (1.0 - cos * cos) / 1.69).sqrt());
        assert!(is_near(reflected(1.3, half_wave, cos)[2], expected, 1e-3, 1e-5));
        assert!(!is_near(reflected(1.3, half_wave, cos)[0], expected, 0.1, 1e-3));
    }
    let root = 1.5_f32.sqrt();
    assert!(reflected(root, 500.0 / (4.0 * root), 1.0)[1] < 1e-6);
}

/// KHR_materials_sheen, as printed, makes light where the roughness is low; here it does not.
#[test]
fn sheen_makes_no_light() {
    let white = PrincipledParameters {
        sheen_color: Sampled::ONE,
        base_color: Sampled::ZERO,
        specular: 0.0,
        ..Default::default()
    };
    for (sheen_roughness, least) in [(0.1, 0.9), (0.3, 0.6), (1.0, 0.6)] {
        let kind = BsdfKind::Facetted(Facetted::Extended(ExtendedPrincipled::new(&PrincipledParameters {
            sheen_roughness,
            ..white
        })));
        let wo = direction(88.0, 0.4);
        let albedo = integrate_sphere(
            |wi| f64::from(kind.eval(wo, wi, TransportMode::Radiance, Lobes::ALL)[0] * wi.z.abs()),
            1e-3,
        );
        assert!(albedo > least && albedo < 1.001, "{sheen_roughness}: {albedo}");
    }
}

/// Any combination of parameters at their limits scatters light soundly.
#[test]
fn limits_are_sound() {
    let mut rng = Rng::new(seed("limits", 0), 0);
    for _ in 0..30 {
        let mut of = |values: &[f32]| values[(rng.next_f32() * values.len() as f32) as usize];
        let share = [0.0, 0.0, 1.0, 0.5];
        let p = PrincipledParameters {
            base_color: Sampled::from_array([0.0, of(&share), 1.0, of(&share)]),
            metallic: of(&share),
            roughness: of(&[0.0, 0.04, 0.2, 1.0]),
            ior: of(&[0.0, 1.0, 1.019, 1.02, 1.5, 4.0]),
            specular: of(&share),
            specular_color: Sampled::splat(of(&[0.0, 1.0, 100.0])),
            anisotropy: of(&share),
            transmission: of(&share),
            is_solid: of(&share) > 0.0,
            clearcoat: of(&share),
            clearcoat_roughness: of(&share),
            clearcoat_normal: Vector3::new(of(&[0.0, 0.9]), 0.0, 1.0),
            sheen_color: Sampled::splat(of(&share)),
            sheen_roughness: of(&share),
            film: ThinFilm {
                share: of(&share),
                ior: of(&[1.0, 1.5, 4.0]),
                thickness_nm: of(&[0.0, 300.0, 1e4]),
            },
            ..Default::default()
        };
        let kind = BsdfKind::Facetted(Facetted::Extended(ExtendedPrincipled::new(&p)));
        for kind in [kind, kind.regularized()] {
            assert_eq!(fault(&kind), None, "{p:?}");
            let errors = sample_errors(&kind);
            assert!(errors.density < 2e-2 && errors.weight < 5e-3, "{errors:?} {p:?}");
            // Narrow facets refract light from near the critical angle at the edge of single precision.
            let error = reciprocity_error(&kind).value;
            assert!(error < 5e-2, "{error} {p:?}");
        }
    }
}
