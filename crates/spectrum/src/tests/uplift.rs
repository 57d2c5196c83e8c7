//! From RGB to reflectance and back.

use super::{assert_near, distance, rgb_of, rng_of};
use crate::{
    ColorSpace, ColorSpaceName, RgbToSpectrum, SigmoidPolynomial, Spectrum, SpectrumTables, Wavelengths,
    spectrum_to_xyz, uplift_srgb,
};

fn srgb() -> &'static ColorSpace {
    ColorSpace::get(ColorSpaceName::Srgb)
}

/// Colours on a grid over the RGB cube, including its surface.
fn cube(n: usize) -> impl Iterator<Item = [f32; 3]> {
    let step = move |i: usize| i as f32 / (n - 1) as f32;
    (0..n * n * n).map(move |i| [step(i % n), step(i / n % n), step(i / (n * n))])
}

#[test]
fn every_srgb_colour_is_met_exactly() {
    // Under D65 the fitted reflectance looks as asked, over the whole cube.
    for rgb in cube(9) {
        let back = rgb_of(srgb(), &srgb().fit_albedo(rgb));
        assert!(distance(rgb, back) < 5e-5, "{rgb:?} became {back:?}");
    }
}

#[test]
fn colours_within_srgb_are_met_exactly_in_wider_spaces() {
    // A colour stays the colour it is, whichever space names it.
    for name in [ColorSpaceName::DciP3, ColorSpaceName::Rec2020] {
        let space = ColorSpace::get(name);
        for inside in cube(6) {
            let rgb = space.to_rgb(srgb().to_xyz(inside));
            let (exact, fast) = (rgb_of(space, &space.fit_albedo(rgb)), rgb_of(space, &space.uplift(rgb)));
            assert!(distance(rgb, exact) < 3e-4, "{name:?} {rgb:?} became {exact:?}");
            assert!(distance(rgb, fast) < 4e-3, "{name:?} {rgb:?} became {fast:?}");
        }
    }
}

#[test]
fn muted_colours_are_met_exactly_in_aces() {
    // The space is so wide that many of its colours are no reflectance at all; muted ones are.
    let space = ColorSpace::get(ColorSpaceName::Aces2065_1);
    for rgb in cube(5).map(|rgb| rgb.map(|c| 0.3 + 0.25 * c)) {
        let back = rgb_of(space, &space.fit_albedo(rgb));
        assert!(distance(rgb, back) < 3e-4, "{rgb:?} became {back:?}");
    }
}

#[test]
fn impossible_colours_keep_their_luminance() {
    // No surface reflects all light of a narrow band only; such colours are desaturated, not darkened.
    for name in [ColorSpaceName::Rec2020, ColorSpaceName::Aces2065_1] {
        let space = ColorSpace::get(name);
        for rgb in cube(4) {
            // Colours beyond the spectrum may be darker than black or, by a hair, brighter than white.
            let luminance = space.luminance(rgb).clamp(0.0, 1.0);
            let reflectance = space.fit_albedo(rgb);
            let back = rgb_of(space, &reflectance);
            assert!((space.luminance(back) - luminance).abs() < 1e-3, "{name:?} {rgb:?} became {back:?}");
            assert!(reflectance.coefficients.iter().all(|c| c.is_finite()));
        }
    }
}

#[test]
fn greys_are_constant() {
    // A grey surface has no colour: its reflectance is the same at all wavelengths, black and white included.
    for i in 0..=100 {
        let v = i as f32 / 100.0;
        for reflectance in [srgb().fit_albedo([v; 3]), uplift_srgb([v; 3])] {
            assert!(reflectance.is_constant());
            for nm in [360.0, 500.0, 830.0] {
                assert!((reflectance.at(nm) - v).abs() < 1e-6, "{v}: {}", reflectance.at(nm));
            }
        }
    }
    assert_eq!(SigmoidPolynomial::constant(0.0).at(500.0), 0.0);
    assert_eq!(SigmoidPolynomial::constant(1.0).at(500.0), 1.0);
}

#[test]
fn the_table_errs_as_little_as_its_documentation_says() {
    // Textures may be off by less than the step of an 8-bit picture.
    let mut rng = rng_of("the_table_errs_as_little_as_its_documentation_says");
    let random: Vec<[f32; 3]> = (0..5000).map(|_| [0; 3].map(|_| rng.next_f32())).collect();
    let (mut worst, mut squares, mut count) = (0.0_f32, 0.0_f64, 0);
    for rgb in cube(15).chain(random) {
        let error = distance(rgb, rgb_of(srgb(), &uplift_srgb(rgb)));
        assert!(error.is_finite(), "{rgb:?}");
        worst = worst.max(error);
        squares += f64::from(error).powi(2);
        count += 1;
    }
    let rms = (squares / f64::from(count)).sqrt();
    assert!(worst < 2.6e-3, "largest error {worst}");
    assert!(rms < 9e-4, "root mean square {rms}");
}

#[test]
fn dark_colours_stay_right_in_the_table() {
    // Shadows of photographs are dark and coloured; their hue must survive.
    for (size, tolerance) in [(0.1, 0.01), (0.01, 0.03), (0.001, 0.1)] {
        for rgb in cube(7).map(|rgb| rgb.map(|c| size * c)) {
            let error = distance(rgb, rgb_of(srgb(), &uplift_srgb(rgb)));
            assert!(error < tolerance * size, "{rgb:?}: {error}");
        }
    }
}

#[test]
fn the_committed_table_is_what_the_generator_makes() {
    // The fit and the binary file must not drift apart; a few hundred grid points tell.
    let [low, high] = RgbToSpectrum::LIMITS;
    let colors = RgbToSpectrum::node_colors();
    for rgb in colors.iter().step_by(337).map(|rgb| rgb.map(|c| c.clamp(low, high))) {
        let (table, fit) = (rgb_of(srgb(), &uplift_srgb(rgb)), rgb_of(srgb(), &srgb().fit_albedo(rgb)));
        assert!(distance(table, fit) < 2e-5, "{rgb:?}: {table:?} and {fit:?}");
    }
}

#[test]
fn lights_and_large_values_keep_their_size() {
    // Twice the RGB is twice the light; equal components give the white of the space.
    let mut tables = SpectrumTables::new();
    for rgb in [[1.0, 1.0, 1.0], [3.0, 2.0, 0.5], [0.01, 0.3, 0.2], [100.0, 0.0, 0.0]] {
        let light = srgb().rgb_illuminant(&mut tables, rgb);
        let back = srgb().to_rgb(spectrum_to_xyz(&light, &tables));
        let size = rgb.into_iter().fold(0.0, f32::max);
        assert!(distance(rgb, back) < 1e-4 * size, "{rgb:?} became {back:?}");

        let Spectrum::Unbounded { scale, polynomial, .. } = srgb().rgb_unbounded(rgb) else {
            panic!("an unbounded spectrum");
        };
        let back = rgb_of(srgb(), &polynomial).map(|c| c * scale);
        assert!(distance(rgb, back) < 1e-4 * size, "{rgb:?} became {back:?}");
        let (fast_scale, shape) = srgb().uplift_unbounded(rgb);
        let back = rgb_of(srgb(), &shape).map(|c| c * fast_scale);
        assert!(distance(rgb, back) < 4e-3 * size, "{rgb:?} became {back:?}");
    }
    let black = srgb().rgb_unbounded([0.0; 3]);
    assert_eq!(black.max_value(&tables), 0.0);
}

#[test]
fn maximum_of_a_polynomial_is_found() {
    // A bound on albedo decides about energy conservation.
    for rgb in cube(4) {
        let reflectance = srgb().fit_albedo(rgb);
        let largest = (3600..=8300).map(|i| reflectance.at(i as f32 / 10.0)).fold(0.0, f32::max);
        assert_near(f64::from(reflectance.max_value()), f64::from(largest), 1e-3);
        let sampled = reflectance.sample(&Wavelengths::sample_uniform(0.1));
        assert!(sampled.max_value() <= reflectance.max_value() + 1e-6);
    }
}
