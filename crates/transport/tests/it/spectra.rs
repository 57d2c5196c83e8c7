//! Wavelengths: one or four per path, dispersion, and the spectral film (SPEC SPD-2, FRES-10).

use etendue_math::Vector3;
use etendue_math::statistics::Moments;
use etendue_scene::bsdf::fresnel::refract;
use etendue_spectrum::cie::{x_bar, y_bar, z_bar};
use etendue_spectrum::named_spectrum;

use crate::support::{Setup, channel, expect_agreement, expect_mean, lit, render_passes};

/// Moments over passes of the means of R, G and B.
pub(crate) fn color_moments(setup: &Setup<'_>, name: &str, n_passes: u64) -> [Moments; 3] {
    let scene = setup.scene(name);
    let mut moments = [Moments::new(); 3];
    for pass in 0..n_passes {
        let image = render_passes(&scene, pass..pass + 1).develop();
        for (moments, c) in moments.iter_mut().zip(["R", "G", "B"]) {
            let values = channel(&image, c);
            moments.push(values.iter().sum::<f64>() / values.len() as f64);
        }
    }
    moments
}

#[track_caller]
fn check_modes(what: &str, setup: &Setup<'_>) {
    let hero = Setup { integrator: "\"integer maxdepth\" 8 \"string wavelengths\" \"hero\"", ..*setup };
    let single = Setup { integrator: "\"integer maxdepth\" 8 \"string wavelengths\" \"single\"", ..*setup };
    let hero = color_moments(&hero, &format!("{what}, hero"), 400);
    let single = color_moments(&single, &format!("{what}, single"), 1200);
    for ((hero, single), c) in hero.iter().zip(&single).zip(["red", "green", "blue"]) {
        expect_agreement(&format!("{what}, {c}"), hero, single, 0.08);
        assert!(hero.variance() < single.variance(), "{what}, {c}: four wavelengths are better than one");
    }
}

/// SPD-2: one uniformly chosen wavelength per path and four by importance have the same mean in each colour, and the four
/// less noise.
#[test]
fn single_wavelength_and_hero_agree() {
    let world = "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0.8 0.4 0.1]
        Shape \"bilinearmesh\" \"point3 P\" [-3 -1 -3  3 -1 -3  -3 -1 3  3 -1 3] AttributeEnd
        AttributeBegin Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\" \"float roughness\" 0.1
        Shape \"sphere\" AttributeEnd
        LightSource \"infinite\" \"rgb L\" [0.3 0.5 0.9]
        LightSource \"point\" \"blackbody I\" 2800 \"point3 from\" [2 2 -2] \"float scale\" 4";
    let camera = "LookAt 0 1 -4  0 -0.3 0  0 1 0 Camera \"perspective\" \"float fov\" 50";
    check_modes("colours", &Setup { size: [16, 16], camera, world, ..Setup::default() });
}

/// Dispersion makes a path follow its first wavelength. Behind glass the means of both ways agree still, in each colour:
/// light that was gathered before the path met the glass too.
#[test]
fn dispersion_keeps_the_mean() {
    let world = "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0.7 0.6 0.4]
        Shape \"bilinearmesh\" \"point3 P\" [-3 -1 -3  3 -1 -3  -3 -1 3  3 -1 3] AttributeEnd
        AttributeBegin Material \"dielectric\" \"spectrum eta\" \"glass-SF11\" Shape \"sphere\" AttributeEnd
        LightSource \"infinite\" \"rgb L\" [0.3 0.5 0.9]
        AttributeBegin AreaLightSource \"diffuse\" \"blackbody L\" 3500 \"float scale\" 5 \"bool twosided\" true
        Shape \"bilinearmesh\" \"point3 P\" [-1 3 -1  1 3 -1  -1 3 1  1 3 1] AttributeEnd";
    let camera = "LookAt 0 1 -4  0 -0.3 0  0 1 0 Camera \"perspective\" \"float fov\" 50";
    check_modes("dispersion", &Setup { size: [16, 16], camera, world, ..Setup::default() });
}

/// A dispersive ball before a uniform sky is invisible like any glass.
#[test]
fn dispersive_glass_in_a_furnace() {
    let world = format!(
        "LightSource \"infinite\" {} Material \"dielectric\" \"spectrum eta\" \"glass-SF11\" Shape \"sphere\"",
        lit("L", 1.0)
    );
    let camera = "LookAt 0 0 -3  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 20";
    let integrator = "\"integer maxdepth\" 100";
    let setup = Setup { size: [16, 16], integrator, camera, world: &world, ..Setup::default() };
    let scene = setup.scene("dispersive furnace");
    let film = render_passes(&scene, 0..256);
    expect_mean("dispersive furnace", &crate::support::pixel_moments(&film), 1.0, 0.03);
}

/// A spectral film under light of equal energy: every band has the same radiance.
#[test]
fn spectral_film_of_flat_light() {
    let film = "\"spectral\" \"integer nbuckets\" 8 \"float lambdamin\" 400 \"float lambdamax\" 720";
    let world = format!("LightSource \"infinite\" {}", lit("L", 1.0));
    let setup = Setup { size: [16, 16], film, world: &world, ..Setup::default() };
    let scene = setup.scene("flat spectrum");
    let film = render_passes(&scene, 0..512);
    let image = film.develop();
    // Radiance whose luminance integral with CIE y is 1.
    let expected = 1.0 / 106.856_895;
    for bucket in 0..8 {
        let name = scene.film.bucket_name(bucket);
        let moments: Moments = channel(&image, &name).into_iter().collect();
        expect_mean(&name, &moments, expected, 0.03);
    }
}

/// The index of flint glass SF11 (Schott) at a wavelength, as the renderer knows it.
fn sf11(nm: f32) -> f32 {
    let samples = etendue_spectrum::named_spectrum("glass-SF11").expect("a named glass").samples;
    let after = samples.iter().position(|s| s[0] >= nm).expect("within the visible");
    let (a, b) = (samples[after.max(1) - 1], samples[after.max(1)]);
    a[1] + (b[1] - a[1]) * ((nm - a[0]) / (b[0] - a[0])).clamp(0.0, 1.0)
}

/// Apex of the prism, its thickness where the camera's axis passes, and the place of the slit behind it.
const APEX: f64 = 20.0 * std::f64::consts::PI / 180.0;
const THICKNESS: f64 = 1.0;
const SLIT_Z: f64 = 10.0;

/// The tangent of the angle by which the prism turns a ray that meets its first face squarely.
fn deviation(eta: f32) -> f64 {
    let normal = Vector3::new(APEX.sin() as f32, 0.0, APEX.cos() as f32);
    let inside = Vector3::new(0.0, 0.0, 1.0);
    let out = refract(-inside, -normal, 1.0 / eta).expect("no total reflection").wt;
    f64::from(-out.x / out.z)
}

/// FRES-10: a prism turns violet more than red, by the angles of Snell's law at the glass's indices. A slit of light behind it
/// appears at a place of its own in each band of a spectral film.
#[test]
fn prism_spreads_colours() {
    assert!(sf11(420.0) > sf11(550.0) && sf11(550.0) > sf11(680.0));
    assert!(deviation(sf11(420.0)) > deviation(sf11(680.0)) + 0.02);
    // The second face is z = 1 - x tan(apex). A ray at x meets the slit's plane at x - (10 - 1 + x tan(apex)) tan(deviation).
    let slope = APEX.tan();
    let center = -(SLIT_Z - THICKNESS) * deviation(sf11(550.0));
    let seen_at = |nm: f32| {
        let turn = deviation(sf11(nm));
        (center + (SLIT_Z - THICKNESS) * turn) / (1.0 - slope * turn)
    };
    let (thick, thin) = (THICKNESS + slope, THICKNESS - slope);
    let (left, right) = (center - 0.03, center + 0.03);
    let world = format!(
        "AttributeBegin Material \"dielectric\" \"spectrum eta\" \"glass-SF11\"
        Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0  -1 1 0  1 -1 0  1 1 0]
        Shape \"bilinearmesh\" \"point3 P\" [-1 -1 {thick}  1 -1 {thin}  -1 1 {thick}  1 1 {thin}] AttributeEnd
        AttributeBegin AreaLightSource \"diffuse\" {} \"bool twosided\" true Translate 0 0 {SLIT_Z}
        Shape \"bilinearmesh\" \"point3 P\" [{left} -1 0  {right} -1 0  {left} 1 0  {right} 1 0] AttributeEnd",
        lit("L", 1.0)
    );
    let setup = Setup {
        size: [60, 4],
        film: "\"spectral\" \"integer nbuckets\" 6 \"float lambdamin\" 420 \"float lambdamax\" 690",
        sampler: "\"sobol\"",
        integrator: "\"integer maxdepth\" 2",
        camera: "LookAt 0 0 -1  0 0 0  0 1 0 Camera \"orthographic\" \"float screenwindow\" [-0.6 0.6 -0.05 0.05]",
        world: &world,
        ..Setup::default()
    };
    let scene = setup.scene("prism");
    let image = render_passes(&scene, 0..1024).develop();
    let mut last = f64::INFINITY;
    for bucket in 0..6 {
        let (mut weight, mut sum) = (0.0, 0.0);
        for (index, value) in channel(&image, &scene.film.bucket_name(bucket)).iter().enumerate() {
            weight += value;
            sum += value * (((index % 60) as f64 + 0.5) / 60.0 * 1.2 - 0.6);
        }
        let place = sum / weight;
        let band = (0..45).map(|i| seen_at(420.5 + (45 * bucket + i) as f32));
        let expected = band.sum::<f64>() / 45.0;
        // A quarter of a pixel; neighbouring bands are one to eight pixels apart.
        assert!((place - expected).abs() < 0.005, "band {bucket}: {place} instead of {expected}");
        assert!(place < last, "longer waves are turned less");
        last = place;
    }
}

/// Linear interpolation between samples [nm, value].
fn at(samples: &[[f32; 2]], nm: f64) -> f64 {
    let next = samples.partition_point(|[x, _]| f64::from(*x) <= nm).clamp(1, samples.len() - 1);
    let [[x0, y0], [x1, y1]] = [samples[next - 1], samples[next]].map(|sample| sample.map(f64::from));
    y0 + (y1 - y0) * ((nm - x0) / (x1 - x0)).clamp(0.0, 1.0)
}

/// CIE L*a*b* of XYZ where white is that of D65 with Y = 1.
fn lab([x, y, z]: [f64; 3]) -> [f64; 3] {
    let f = |t: f64| if t > 216.0 / 24389.0 { t.cbrt() } else { (24389.0 / 27.0 * t + 16.0) / 116.0 };
    let [x, y, z] = [x / 0.950_47, y, z / 1.088_83].map(f);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// BRDF-16, FRES-3: gold, silver and copper under daylight have the colours that follow from their n and k by an integral of
/// Fresnel's equations at normal incidence.
#[test]
fn metals_have_their_colours() {
    let samples = |name: &str| named_spectrum(name).expect("a known name").samples;
    let daylight = samples("stdillum-D65");
    for metal in ["Au", "Ag", "Cu"] {
        let (n, k) = (samples(&format!("metal-{metal}-eta")), samples(&format!("metal-{metal}-k")));
        let mut expected = [0.0; 3];
        let mut white = 0.0;
        for nm in (360..=830).map(f64::from) {
            let (n, k) = (at(&n, nm), at(&k, nm));
            let reflectance = ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k);
            let light = at(&daylight, nm);
            for (sum, observer) in expected.iter_mut().zip([x_bar, y_bar, z_bar]) {
                *sum += light * reflectance * f64::from(observer(nm as f32));
            }
            white += light * f64::from(y_bar(nm as f32));
        }
        let expected = lab(expected.map(|sum| sum / white));
        let world = format!(
            "LightSource \"infinite\" \"spectrum L\" \"stdillum-D65\"
            Material \"conductor\" \"spectrum eta\" \"metal-{metal}-eta\" \"spectrum k\" \"metal-{metal}-k\" Shape \"disk\""
        );
        let camera =
            "LookAt 0 0 2  0 0 0  0 1 0 Camera \"orthographic\" \"float screenwindow\" [-0.1 0.1 -0.1 0.1]";
        let setup = Setup { size: [16, 16], sampler: "\"sobol\"", camera, world: &world, ..Setup::default() };
        let [r, g, b] = color_moments(&setup, metal, 64).map(|moments| moments.mean());
        let seen = lab([
            0.412_456 * r + 0.357_576 * g + 0.180_437 * b,
            0.212_673 * r + 0.715_152 * g + 0.072_175 * b,
            0.019_334 * r + 0.119_192 * g + 0.950_304 * b,
        ]);
        let difference = (0..3).map(|i| (seen[i] - expected[i]).powi(2)).sum::<f64>().sqrt();
        assert!(difference < 1.0, "{metal}: {seen:?} instead of {expected:?}");
    }
}
