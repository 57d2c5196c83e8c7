//! Direct and reflected light with closed forms: lamps, spheres, rectangles, the sky, shadows, the lamp in a sphere.
//!
//! A diffuse floor of albedo rho under irradiance E sends out the radiance rho E / pi, which the camera reads.

use std::f64::consts::PI;

use etendue_math::statistics::Moments;
use etendue_scene::Film;

use crate::support::{Setup, expect_mean, flat, lit, luminance, pixel_moments};

const RHO: f64 = 0.5;

/// The floor z = 0, wide enough for all that the camera sees.
fn floor() -> String {
    format!(
        "AttributeBegin Material \"diffuse\" {}
        Shape \"bilinearmesh\" \"point3 P\" [-20 -20 0  20 -20 0  -20 20 0  20 20 0] AttributeEnd\n",
        flat("reflectance", RHO)
    )
}

/// Looks down on [-1, 1]^2 of the floor from just above it; the mirror image puts +x to the right.
pub(crate) const DOWN: &str = "Scale -1 1 1 LookAt 0 0 0.05  0 0 0  0 1 0
    Camera \"orthographic\" \"float screenwindow\" [-1 1 -1 1]";

/// Spread evenly over wavelengths and the pixel: noise far below that of independent samples, pixels still independent.
const SOBOL: &str = "\"sobol\" \"integer pixelsamples\" 256";

/// For each pixel of an image of [-1, 1]^2, its value over the mean of `expected` at 8 by 8 places in it.
pub(crate) fn floor_ratios(film: &Film, expected: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    floor_means(film, expected).iter().zip(luminance(film)).map(|(mean, value)| value / mean).collect()
}

/// The mean over each pixel of an image of [-1, 1]^2, top row first.
pub(crate) fn floor_means(film: &Film, f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let [width, height] = film.settings().resolution;
    let pixel_mean = |pixel: [u32; 2]| {
        let place =
            |i: u32, n: u32, k: u32| 2.0 * (f64::from(i) + (f64::from(k) + 0.5) / 8.0) / f64::from(n) - 1.0;
        let mut sum = 0.0;
        for ky in 0..8 {
            for kx in 0..8 {
                sum += f(place(pixel[0], width, kx), -place(pixel[1], height, ky));
            }
        }
        sum / 64.0
    };
    film.settings().crop.pixels().map(pixel_mean).collect()
}

/// The image is rho E / pi, in each quarter.
#[track_caller]
fn check_floor(name: &str, film: &Film, resolution: f64, irradiance: impl Fn(f64, f64) -> f64) {
    let ratios = floor_ratios(film, |x, y| RHO / PI * irradiance(x, y));
    let [width, height] = film.settings().resolution.map(|n| n as usize);
    let mut quarters = [Moments::new(); 4];
    for (index, ratio) in ratios.iter().enumerate() {
        let (x, y) = (index % width, index / width);
        quarters[2 * (2 * y / height) + 2 * x / width].push(*ratio);
    }
    for (quarter, moments) in quarters.iter().enumerate() {
        expect_mean(&format!("{name}, quarter {quarter}"), moments, 1.0, resolution);
    }
}

fn render_floor(name: &str, light: &str, lights: &str, n_passes: u64) -> Film {
    let world = floor() + light;
    let integrator = format!("\"integer maxdepth\" 1 \"string lights\" \"{lights}\"");
    let setup = Setup {
        size: [16, 16],
        sampler: SOBOL,
        integrator: &integrator,
        camera: DOWN,
        world: &world,
        ..Setup::default()
    };
    setup.film(name, n_passes)
}

/// EMI-1, BRDF-11: a lamp of flux Phi makes E = Phi cos / (4 pi r^2), everywhere on the floor.
#[test]
fn lamp_over_floor() {
    let (flux, at) = (30.0, [0.4, -0.3, 0.7]);
    let light = format!(
        "LightSource \"point\" {} \"float power\" {flux} \"point3 from\" [{} {} {}]",
        lit("I", 1.0),
        at[0],
        at[1],
        at[2]
    );
    let film = render_floor("lamp", &light, "both", 64);
    check_floor("lamp", &film, 0.01, |x, y| {
        let squared = (x - at[0]).powi(2) + (y - at[1]).powi(2) + at[2] * at[2];
        flux * (at[2] / squared.sqrt()) / (4.0 * PI * squared)
    });
}

/// The same as an intensity, E = I cos / r^2. The size of the spectrum counts for nothing: lights are normalised to
/// luminance 1 before they are scaled.
#[test]
fn lamp_by_intensity() {
    let light = format!("LightSource \"point\" {} \"float scale\" 3 \"point3 from\" [0 0 2]", flat("I", 2.0));
    let film = render_floor("lamp by intensity", &light, "both", 64);
    check_floor("lamp by intensity", &film, 0.01, |x, y| 3.0 * 2.0 / (x * x + y * y + 4.0).powf(1.5));
}

/// EMI-12: below a uniform sky E = pi L, by every technique.
#[test]
fn floor_under_uniform_sky() {
    for lights in ["both", "lights", "scattering"] {
        let light = format!("LightSource \"infinite\" {}", lit("L", 2.0));
        let film = render_floor(&format!("sky by {lights}"), &light, lights, 64);
        check_floor(&format!("sky by {lights}"), &film, 0.02, |_, _| 2.0 * PI);
    }
}

/// EMI-7: parallel light of illuminance E_0 gives E_0 cos, however large the scene is.
#[test]
fn parallel_light() {
    for size in [1.0, 1000.0] {
        let light = format!(
            "LightSource \"distant\" {} \"float illuminance\" 2 \"point3 from\" [1 2 3] \"point3 to\" [0 0 0]
            AttributeBegin Translate -{size} 0 -{size} Shape \"sphere\" \"float radius\" 0.1 AttributeEnd",
            lit("L", 1.0)
        );
        let film = render_floor(&format!("distant light in a scene of {size}"), &light, "both", 64);
        let cosine = 3.0 / 14.0_f64.sqrt();
        check_floor("distant light", &film, 0.01, |_, _| 2.0 * cosine);
    }
}

/// EMI-5: a sphere wholly above the horizon makes E = pi L (R / d)^2 cos, near or far. Its flux is 4 pi^2 R^2 L.
#[test]
fn sphere_light_over_floor() {
    for (radius, height) in [(0.1, 1.5), (0.6, 0.8)] {
        for lights in ["both", "lights", "scattering"] {
            // Scattering rarely meets the small sphere.
            if lights == "scattering" && radius < 0.5 {
                continue;
            }
            let light = format!(
                "AttributeBegin Translate 0.2 -0.1 {height} Material \"diffuse\" AreaLightSource \"diffuse\" {}
                Shape \"sphere\" \"float radius\" {radius} AttributeEnd",
                lit("L", 3.0)
            );
            let name = format!("sphere of {radius} by {lights}");
            let film = render_floor(&name, &light, lights, if lights == "scattering" { 512 } else { 64 });
            check_floor(&name, &film, 0.05, |x, y| {
                let squared = (x - 0.2_f64).powi(2) + (y + 0.1_f64).powi(2) + height * height;
                3.0 * PI * radius * radius / squared * (height / squared.sqrt())
            });
        }
    }
}

/// Irradiance at (x, y) on the floor, over L, of a polygon above it: `1/2 sum of angle_i (n · normal_i)` over its edges
/// (Lambert 1760).
pub(crate) fn polygon_irradiance(x: f64, y: f64, corners: &[[f64; 3]]) -> f64 {
    let unit = |c: &[f64; 3]| {
        let v = [c[0] - x, c[1] - y, c[2]];
        let length = v.iter().map(|v| v * v).sum::<f64>().sqrt();
        v.map(|v| v / length)
    };
    let edge = |i: usize| {
        let (a, b) = (unit(&corners[i]), unit(&corners[(i + 1) % corners.len()]));
        let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        let sine = cross.iter().map(|v| v * v).sum::<f64>().sqrt();
        let cosine: f64 = (0..3).map(|k| a[k] * b[k]).sum();
        sine.atan2(cosine) * cross[2] / sine
    };
    0.5 * (0..corners.len()).map(edge).sum::<f64>().abs()
}

/// The form factor of a rectangle parallel to the floor, seen from below its corner: Lambert's sum against the textbook's
/// formula.
#[test]
fn lambert_agrees_with_the_form_factor() {
    let (a, b, h): (f64, f64, f64) = (1.3, 0.6, 0.9);
    let (p, q) = (a / h, b / h);
    let (p1, q1) = ((1.0 + p * p).sqrt(), (1.0 + q * q).sqrt());
    let form_factor = (p / p1 * (q / p1).atan() + q / q1 * (p / q1).atan()) / (2.0 * PI);
    let corners = [[0.0, 0.0, h], [a, 0.0, h], [a, b, h], [0.0, b, h]];
    assert!((polygon_irradiance(0.0, 0.0, &corners) / PI - form_factor).abs() < 1e-12);
}

/// EMI-6, EMI-13, EQ-2: rectangles, level and tilted, as patch and as triangles, by all techniques.
#[test]
fn rectangle_light_over_floor() {
    let level = [[-0.5, -0.3, 1.0], [0.7, -0.3, 1.0], [0.7, 0.4, 1.0], [-0.5, 0.4, 1.0]];
    let tilted = [[-0.2, -0.5, 0.3], [-0.2, 0.5, 0.3], [0.7, 0.5, 1.2], [0.7, -0.5, 1.2]];
    for (place, corners) in [("level", level), ("tilted", tilted)] {
        let point = |c: [f64; 3]| format!("{} {} {} ", c[0], c[1], c[2]);
        let [a, b, c, d] = corners.map(point);
        let shapes = [
            ("patch", format!("Shape \"bilinearmesh\" \"point3 P\" [{a}{b}{d}{c}]")),
            (
                "triangles",
                format!(
                    "Shape \"trianglemesh\" \"point3 P\" [{a}{b}{c}{d}] \"integer indices\" [0 1 2 0 2 3]"
                ),
            ),
        ];
        for (kind, shape) in shapes {
            let light = format!(
                "AttributeBegin Material \"diffuse\" {} AreaLightSource \"diffuse\" {} \"bool twosided\" true {shape}
                AttributeEnd",
                flat("reflectance", 0.0),
                lit("L", 1.0)
            );
            for (lights, n_passes, resolution) in
                [("both", 128, 0.06), ("lights", 128, 0.06), ("scattering", 512, 0.2)]
            {
                let name = format!("{place} {kind} by {lights}");
                let film = render_floor(&name, &light, lights, n_passes);
                check_floor(&name, &film, resolution, |x, y| polygon_irradiance(x, y, &corners));
            }
        }
    }
}

/// EMI-13: penumbra of a long strip light behind an edge. By similar triangles a point x of the floor sees the part of the
/// strip beyond x (1 - H / h); what it sees is again a rectangle.
#[test]
fn penumbra_of_a_strip() {
    for lights in ["both", "lights", "scattering"] {
        let world = floor() + &strip_light_and_edge();
        let integrator = format!("\"integer maxdepth\" 1 \"string lights\" \"{lights}\"");
        let setup = Setup {
            size: [32, 8],
            sampler: SOBOL,
            integrator: &integrator,
            camera: DOWN,
            world: &world,
            ..Setup::default()
        };
        let n_passes = if lights == "scattering" { 1024 } else { 128 };
        let name = format!("penumbra by {lights}");
        let film = setup.film(&name, n_passes);
        let expected = floor_means(&film, |x, y| RHO / PI * strip_irradiance(x, y));
        // Rows of equal x tell whether the profile is right, column by column.
        let values = luminance(&film);
        let full = expected[31];
        for column in 0..32 {
            let moments: Moments = (0..8)
                .map(|row| (values[32 * row + column] - expected[32 * row + column]) / full + 1.0)
                .collect();
            expect_mean(&format!("{name}, column {column}"), &moments, 1.0, 0.2);
        }
        let difference: Moments = values.iter().zip(&expected).map(|(v, e)| (v - e) / full + 1.0).collect();
        expect_mean(&name, &difference, 1.0, 0.02);
        // Umbra to the left, full light to the right.
        assert_eq!(values[0], 0.0);
        let unshadowed = floor_means(&film, |x, y| RHO / PI * polygon_irradiance(x, y, &STRIP));
        assert!(expected[31] > 0.999 * unshadowed[31] && expected[17] < 0.9 * unshadowed[17]);
    }
}

const STRIP: [[f64; 3]; 4] = [[-0.3, -2.0, 1.2], [0.3, -2.0, 1.2], [0.3, 2.0, 1.2], [-0.3, 2.0, 1.2]];
const EDGE_HEIGHT: f64 = 0.4;

/// A strip light along y at height 1.2, and below it a dark sheet over x < 0 at height 0.4.
pub(crate) fn strip_light_and_edge() -> String {
    format!(
        "AttributeBegin Material \"diffuse\" {black} AreaLightSource \"diffuse\" {} \"bool twosided\" true
        Shape \"bilinearmesh\" \"point3 P\" [-0.3 -2 1.2  0.3 -2 1.2  -0.3 2 1.2  0.3 2 1.2] AttributeEnd
        AttributeBegin Material \"diffuse\" {black}
        Shape \"bilinearmesh\" \"point3 P\" [-20 -20 {h}  0 -20 {h}  -20 20 {h}  0 20 {h}] AttributeEnd\n",
        lit("L", 1.0),
        black = flat("reflectance", 0.0),
        h = EDGE_HEIGHT,
    )
}

/// Irradiance of the floor by that strip, over L.
pub(crate) fn strip_irradiance(x: f64, y: f64) -> f64 {
    let (height, half) = (STRIP[0][2], STRIP[1][0]);
    let from = (x * (1.0 - height / EDGE_HEIGHT)).clamp(-half, half);
    if from >= half {
        return 0.0;
    }
    let visible = STRIP.map(|[px, py, pz]| [px.max(from), py, pz]);
    polygon_irradiance(x, y, &visible)
}

/// RAD-7, RAD-8: a uniform emitter has the same pixel value near and far, from the front and aslant.
#[test]
fn radiance_is_invariant() {
    let world = format!(
        "AreaLightSource \"diffuse\" {}
        Shape \"disk\" \"float radius\" 3",
        lit("L", 7.0)
    );
    for (distance, angle) in [(1.0_f64, 0.0_f64), (10.0, 0.0), (10.0, 60.0), (10.0, 80.0), (100.0, 0.0)] {
        let angle = angle.to_radians();
        let (x, z) = (distance * angle.sin(), distance * angle.cos());
        let camera = format!("LookAt {x} 0 {z}  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 2");
        let setup = Setup { sampler: SOBOL, camera: &camera, world: &world, ..Setup::default() };
        let name = format!("disk from {distance} at {angle}");
        expect_mean(&name, &pixel_moments(&setup.film(&name, 64)), 7.0, 0.02);
    }
}

/// A lamp in a diffuse sphere: direct light falls as Phi cos / (4 pi r^2), and all further bounces are the same everywhere:
/// `E = E_direct + rho / (1 - rho) Phi / (4 pi R^2)`, since a point of a sphere sees all others equally.
#[test]
fn lamp_in_a_sphere() {
    let (rho, flux, offset): (f64, f64, f64) = (0.6, 40.0, 0.4);
    let world = format!(
        "Material \"diffuse\" {} ReverseOrientation Shape \"sphere\" \"float radius\" 1
        LightSource \"point\" {} \"float power\" {flux} \"point3 from\" [0 0 {offset}]",
        flat("reflectance", rho),
        lit("I", 1.0)
    );
    // Looks along x from the centre with a narrow view, then along z towards the lamp and away from it.
    for (direction, up) in
        [([1.0_f64, 0.0, 0.0], "0 1 0"), ([0.0, 0.0, -1.0], "0 1 0"), ([0.6, 0.0, 0.8], "0 1 0")]
    {
        let [x, y, z] = direction;
        let camera = format!("LookAt 0 0 0  {x} {y} {z}  {up} Camera \"perspective\" \"float fov\" 1");
        let integrator = "\"integer maxdepth\" 100 \"integer roulettedepth\" 6";
        let setup = Setup {
            size: [16, 16],
            sampler: SOBOL,
            integrator,
            camera: &camera,
            world: &world,
            ..Setup::default()
        };
        let name = format!("lamp in a sphere towards {x} {y} {z}");
        let squared = x * x + y * y + (z - offset).powi(2);
        let cosine = (x * x + y * y + z * (z - offset)) / squared.sqrt();
        let direct = flux * cosine / (4.0 * PI * squared);
        let expected = rho / PI * (direct + rho / (1.0 - rho) * flux / (4.0 * PI));
        expect_mean(&name, &pixel_moments(&setup.film(&name, 64)), expected, 0.02);
    }
}
