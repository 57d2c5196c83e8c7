//! Measurements of models: what they give back, and how well they are sampled.

use std::sync::Arc;

use etendue_spectrum::Wavelengths;

use super::*;
use crate::bsdf::laws::albedo;
use crate::bsdf::measured::{Measured, MeasuredBrdf, MeasuredGrid, MeasuredParts, MeasuredTable};

fn grid(n_phi: usize, [n_theta, n_facets, n_spectra]: [usize; 3]) -> MeasuredGrid {
    MeasuredGrid { n_phi, n_theta, n_facets: [n_facets; 2], n_spectra, wavelengths: vec![400.0, 600.0] }
}

fn radiance(kind: &BsdfKind, wo: Vector3, wi: Vector3) -> f32 {
    kind.eval(wo, wi, TransportMode::Radiance, Lobes::ALL)[2]
}

/// A measurement of grey metal.
fn measured(metal: Conductor, grid: &MeasuredGrid) -> MeasuredBrdf {
    let f = |wo, wi, _nm| radiance(&BsdfKind::Conductor(metal), wo, wi);
    MeasuredBrdf::of_model(grid, |m| metal.microfacets.d(m), f).unwrap()
}

fn small() -> MeasuredParts {
    measured(copper(0.5, 0.5), &grid(1, [4, 8, 8])).parts().clone()
}

fn kind_at(brdf: MeasuredBrdf, lambda: Wavelengths) -> BsdfKind {
    BsdfKind::Measured(Measured { table: MeasuredTable::of(&Arc::new(brdf)), lambda })
}

fn kind_of(brdf: MeasuredBrdf) -> BsdfKind {
    kind_at(brdf, Wavelengths::sample_visible(0.3))
}

/// Mean difference of a model and its measurement relative to the model, for views up to 80° and what the model reflects.
fn mean_error(metal: Conductor, kind: &BsdfKind) -> f64 {
    let model = BsdfKind::Conductor(metal);
    let mut rng = Rng::new(seed("measured", 0), 0);
    let mut error = Moments::default();
    for _ in 0..4000 {
        let wo = direction(80.0 * rng.next_f32(), TAU as f32 * rng.next_f32());
        let sample = draw(&model, wo, TransportMode::Radiance, Lobes::ALL, &mut rng);
        if let Some(sample) = sample.filter(|sample| sample.wi.z > 0.1) {
            let (f, found) = (radiance(&model, wo, sample.wi), radiance(kind, wo, sample.wi));
            error.push(f64::from((found / f - 1.0).abs()));
        }
    }
    error.mean()
}

/// A measurement of a model is that model but for interpolation, whose error falls with the distance of nodes, and
/// reflects as much within 1 %.
#[test]
fn a_measurement_gives_its_model_back() {
    for (metal, n_phi, bound) in [(copper(0.3, 0.3), 1, 0.02), (copper(0.3, 0.5), 9, 0.03)] {
        let coarse = kind_of(measured(metal, &grid(n_phi, [6, 12, 10])));
        let fine = kind_of(measured(metal, &grid(n_phi, [12, 24, 20])));
        let errors = [&coarse, &fine].map(|kind| mean_error(metal, kind));
        assert!(errors[1] < bound && errors[1] < 0.6 * errors[0], "{errors:?}");
        for theta in [0.1, 30.0, 60.0, 70.0] {
            let of =
                |kind: &BsdfKind| albedo(kind, direction(theta, 0.7), TransportMode::Radiance, Lobes::ALL)[2];
            let (model, found) = (of(&BsdfKind::Conductor(metal)), of(&fine));
            assert!(found.is_near(model.value, 0.01 * model.value), "{theta}: {model:?} {found:?}");
        }
    }
}

/// Between wavelengths values are linear, beyond them constant; in bands a spectrum without colour has none.
#[test]
fn spectra_are_interpolated() {
    let metal = copper(0.4, 0.4);
    let f = |wo, wi, nm: f32| radiance(&BsdfKind::Conductor(metal), wo, wi) * nm / 600.0;
    let brdf = MeasuredBrdf::of_model(&grid(1, [4, 8, 8]), |m| metal.microfacets.d(m), f).unwrap();
    let lambda = Wavelengths::from_parts([380.0, 450.0, 600.0, 700.0], [1.0; 4]);
    let kind = kind_at(brdf, lambda);
    let (wo, wi) = (direction(20.0, 0.0), direction(10.0, 2.0));
    let f = kind.eval(wo, wi, TransportMode::Radiance, Lobes::ALL);
    let expected = [400.0, 450.0, 600.0, 600.0].map(|nm| f[2] * nm / 600.0);
    assert!((0..4).all(|i| is_near(f[i], expected[i], 1e-5, 0.0)), "{f:?}");

    let grey = MeasuredBrdf::new(small()).unwrap();
    let [spectral, bands] = [Wavelengths::sample_visible(0.3), Wavelengths::bands(0.3)]
        .map(|lambda| kind_at(grey.clone(), lambda).eval(wo, wi, TransportMode::Radiance, Lobes::ALL));
    assert!((0..3).all(|i| is_near(spectral[i], bands[i], 1e-5, 0.0)), "{spectral:?} {bands:?}");
}

/// What was measured for a quarter or a half of all azimuths holds for the others; whatever the numbers, samples have
/// their density.
#[test]
fn azimuths_are_completed() {
    let mut rng = Rng::new(seed("azimuths", 0), 0);
    let mut parts = measured(copper(0.3, 0.6), &grid(5, [3, 8, 6])).parts().clone();
    for maps in [&mut parts.luminance, &mut parts.spectra] {
        maps.values.iter_mut().for_each(|value| *value = rng.next_f32());
    }
    let flips: [[f32; 2]; 3] = [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0]];
    for (n_symmetries, arc) in [(3, 0.25), (1, 0.5), (0, 1.0)] {
        parts.phi_i = (0..5).map(|i| (TAU * (arc * f64::from(i) / 4.0 - 0.5)) as f32).collect();
        let kind = kind_of(MeasuredBrdf::new(parts.clone()).unwrap());
        let (wo, wi) = (direction(40.0, 2.0), direction(20.0, -1.0));
        let f = radiance(&kind, wo, wi);
        for (i, [x, y]) in flips.into_iter().enumerate() {
            let flip = |w: Vector3| Vector3::new(x * w.x, y * w.y, w.z);
            let is_same = is_near(radiance(&kind, flip(wo), flip(wi)), f, 1e-3, 0.0);
            assert_eq!(is_same, i < n_symmetries, "{arc} {i}");
        }
        // Along the first tangent it is as next to it.
        let along = |y| radiance(&kind, Vector3::new(-0.6, y, 0.8), wi);
        assert!(is_near(along(0.0), along(1e-4), 1e-2, 0.0), "{arc}: {} {}", along(0.0), along(1e-4));
        let p_value = density_p(&kind, wo, Lobes::ALL, N_SAMPLES, 7, |_| 1.0);
        assert!(p_value > significance(), "{arc}: {p_value}");
    }
}

/// Without `jacobian` the spectra are f cos themselves.
#[test]
fn spectra_may_be_absolute() {
    let mut parts = small();
    parts.jacobian = false;
    parts.spectra.values.fill(0.25);
    let kind = kind_of(MeasuredBrdf::new(parts).unwrap());
    let wi = direction(60.0, 1.0);
    assert!(is_near(radiance(&kind, direction(30.0, 0.0), wi), 0.25 / wi.z, 1e-4, 0.0));
}

/// Whatever does not fit is told by its name.
#[test]
fn measurements_are_examined() {
    let check = |change: fn(&mut MeasuredParts), field: &str| {
        let mut parts = small();
        change(&mut parts);
        assert_eq!(MeasuredBrdf::new(parts).map_err(|fault| fault.field), Err(field));
    };
    assert!(MeasuredBrdf::new(small()).is_ok());
    check(|parts| parts.phi_i.clear(), "phi_i");
    check(|parts| parts.phi_i = vec![0.0, 1.0, 2.0], "phi_i");
    check(|parts| parts.theta_i.reverse(), "theta_i");
    check(|parts| parts.theta_i[1] = f32::NAN, "theta_i");
    check(|parts| parts.wavelengths[0] = 700.0, "wavelengths");
    check(|parts| parts.ndf.values[3] = -1.0, "ndf");
    check(|parts| parts.sigma.size = [1, parts.sigma.values.len()], "sigma");
    check(|parts| parts.vndf.values[0] = f32::INFINITY, "vndf");
    check(|parts| parts.luminance.values.truncate(7), "luminance");
    check(|parts| parts.spectra.size = [usize::MAX, usize::MAX], "spectra");
    let empty = grid(1, [4, 1, 8]);
    assert!(MeasuredBrdf::of_model(&empty, |_| 1.0, |_, _, _| 1.0).is_err());
}

/// Maps of nothing are sampled evenly, and reflect nothing; equal measurements share a table.
#[test]
fn measurements_may_be_black() {
    let mut parts = small();
    for maps in [&mut parts.luminance, &mut parts.spectra, &mut parts.vndf] {
        maps.values.fill(0.0);
    }
    let brdf = Arc::new(MeasuredBrdf::new(parts).unwrap());
    let table = MeasuredTable::of(&brdf);
    assert!(std::ptr::eq(table, MeasuredTable::of(&Arc::new((*brdf).clone()))));
    let kind = kind_of((*brdf).clone());
    let measures = Measures::of(&kind);
    assert_eq!((measures.albedo_max.value, measures.fault), (0.0, None));
}
