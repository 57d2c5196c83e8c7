//! Film and sampler: from entities to settings.

use etendue_math::{SamplerKind, SamplerSettings};
use etendue_spectrum::{CAMERA_SENSORS, Sensor, SensorSettings};

use crate::document::{Document, Entity, Value};
use crate::film::{AovSpace, FilmKind, FilmSettings, PixelBounds};
use crate::parameters::{ParameterSpec, Parameters, spec};

use super::{BuildContext, known_names};

const RGB: &[ParameterSpec] = &[
    spec("xresolution", "integer", "1280", "pixels", "width of the full image"),
    spec("yresolution", "integer", "720", "pixels", "height of the full image"),
    spec("cropwindow", "float", "0 1 0 1", "", "part to render: x0 x1 y0 y1 as shares of the image"),
    spec("pixelbounds", "integer", "", "pixels", "part to render: x0 x1 y0 y1"),
    spec("filename", "string", "pbrt.exr", "", "output file"),
    spec("sensor", "string", "cie1931", "", "response of the sensor"),
    spec("iso", "float", "100", "", "sensitivity"),
    spec("exposuretime", "float", "1", "s", "exposure"),
    spec("whitebalance", "float", "0", "K", "temperature of the light that becomes white; 0 for none"),
    spec("maxcomponentvalue", "float", "inf", "", "samples are scaled down to this largest component"),
    spec("diagonal", "float", "35", "mm", "diagonal of the sensor, for lens files"),
    spec(
        "features",
        "bool",
        "false",
        "",
        "record what a denoiser needs: features, variances, two halves of the samples",
    ),
    spec("savefp16", "bool", "true", "", "accepted; channels are always written as 32-bit floats"),
];
const GBUFFER: &[ParameterSpec] =
    &[spec("coordinatesystem", "string", "camera", "", "space of positions and normals: camera or world")];
const SPECTRAL: &[ParameterSpec] = &[
    spec("nbuckets", "integer", "16", "", "number of wavelength bands"),
    spec("lambdamin", "float", "360", "nm", "lower end of the bands"),
    spec("lambdamax", "float", "830", "nm", "upper end of the bands"),
];

/// Largest diagonal of a film: a kilometre.
const MOST_DIAGONAL_MM: f32 = 1e6;

/// Film types with their own parameters; `gbuffer` and `spectral` take those of `rgb` too.
pub const FILMS: &[(&str, &[ParameterSpec])] = &[("rgb", RGB), ("gbuffer", GBUFFER), ("spectral", SPECTRAL)];

const PIXEL_SAMPLES: ParameterSpec = spec("pixelsamples", "integer", "16", "", "samples per pixel");
const SEED: ParameterSpec = spec("seed", "integer", "0", "", "random seed");
const PLAIN_SAMPLER: &[ParameterSpec] = &[PIXEL_SAMPLES, SEED];
const STRATIFIED: &[ParameterSpec] = &[
    spec("xsamples", "integer", "4", "", "strata across"),
    spec("ysamples", "integer", "4", "", "strata down"),
    spec("jitter", "bool", "true", "", "random position within the stratum"),
    SEED,
];

/// Sampler types with their parameters.
pub const SAMPLERS: &[(&str, &[ParameterSpec])] = &[
    ("sobol", PLAIN_SAMPLER),
    ("zsobol", PLAIN_SAMPLER),
    ("paddedsobol", PLAIN_SAMPLER),
    ("pmj02bn", PLAIN_SAMPLER),
    ("halton", PLAIN_SAMPLER),
    ("independent", PLAIN_SAMPLER),
    ("stratified", STRATIFIED),
];

/// The largest image: beyond it sums alone would need hundreds of gigabytes.
const MAX_PIXELS: u64 = 1 << 30;

pub(super) fn build_film(document: &Document, context: &mut BuildContext<'_>) -> FilmSettings {
    let fallback = Entity::new("rgb");
    let entity = document.film.as_ref().unwrap_or(&fallback);
    let mut p = Parameters::new(entity, context);
    let resolution = read_resolution(&mut p);
    let crop = read_crop(&mut p, resolution);
    let kind = read_kind(&mut p, document);
    let guides = p.bool("features", false);
    let sensor = read_sensor(&mut p, document);
    let max_component = p.float("maxcomponentvalue", f32::INFINITY);
    let filename = p.string("filename", "pbrt.exr");
    let mut diagonal_mm = p.float("diagonal", 35.0);
    if !(diagonal_mm > 0.0 && diagonal_mm < MOST_DIAGONAL_MM) {
        let span = p.span_of("diagonal");
        let message =
            format!("\"diagonal\" must be positive and below {MOST_DIAGONAL_MM} mm, not {diagonal_mm}");
        p.diagnostics().error(span, message);
        diagonal_mm = 35.0;
    }
    p.ignore("savefp16");
    p.finish();
    FilmSettings {
        resolution,
        crop,
        kind,
        guides,
        sensor,
        color_space: document.film_color_space,
        max_component,
        filename,
        diagonal_mm,
    }
}

fn read_resolution(p: &mut Parameters<'_, '_>) -> [u32; 2] {
    let resolution = [p.integer("xresolution", 1280), p.integer("yresolution", 720)];
    let pixels = i64::from(resolution[0]).saturating_mul(i64::from(resolution[1]));
    if resolution.iter().all(|r| *r > 0) && pixels as u64 <= MAX_PIXELS {
        return resolution.map(|r| r as u32);
    }
    let name = if resolution[0] > 0 { "yresolution" } else { "xresolution" };
    let span = p.span_of(name);
    let [x, y] = resolution;
    p.diagnostics()
        .error(span, format!("a film of {x} x {y} pixels cannot be rendered"))
        .with_help("both resolutions must be positive, with at most 2^30 pixels together");
    [1, 1]
}

fn read_crop(p: &mut Parameters<'_, '_>, resolution: [u32; 2]) -> PixelBounds {
    let full = PixelBounds { min: [0, 0], max: resolution };
    let window = p.floats("cropwindow");
    let bounds = p.integers("pixelbounds");
    let (crop, name) = match (window, bounds) {
        (_, Some(&[x0, x1, y0, y1])) => {
            let pixel = |v: i32, axis: usize| v.clamp(0, resolution[axis] as i32) as u32;
            (
                PixelBounds { min: [pixel(x0, 0), pixel(y0, 1)], max: [pixel(x1, 0), pixel(y1, 1)] },
                "pixelbounds",
            )
        }
        (Some(&[x0, x1, y0, y1]), None) => {
            let pixel = |v: f32, axis: usize| (v.clamp(0.0, 1.0) * resolution[axis] as f32).ceil() as u32;
            (
                PixelBounds { min: [pixel(x0, 0), pixel(y0, 1)], max: [pixel(x1, 0), pixel(y1, 1)] },
                "cropwindow",
            )
        }
        (None, None) => return full,
        (_, Some(_)) => return wrong_crop(p, "pixelbounds", full),
        (Some(_), None) => return wrong_crop(p, "cropwindow", full),
    };
    if crop.n_pixels() == 0 { wrong_crop(p, name, full) } else { crop }
}

fn wrong_crop(p: &mut Parameters<'_, '_>, name: &'static str, full: PixelBounds) -> PixelBounds {
    let span = p.span_of(name);
    p.diagnostics().error(span, format!("\"{name}\" must be x0 x1 y0 y1 and hold at least one pixel"));
    full
}

fn read_kind(p: &mut Parameters<'_, '_>, document: &Document) -> FilmKind {
    match p.entity().type_name.as_str() {
        "rgb" => FilmKind::Rgb,
        "gbuffer" => {
            let choices = [("camera", AovSpace::Camera), ("world", AovSpace::World)];
            FilmKind::GBuffer(p.choice("coordinatesystem", "camera", &choices))
        }
        "spectral" => {
            warn_of_bands(p, document);
            read_spectral(p)
        }
        unknown => {
            let span = p.span();
            p.diagnostics().unknown_name(span, "film", unknown, known_names(FILMS));
            p.accept_all();
            FilmKind::Rgb
        }
    }
}

/// Warns if the integrator computes with red, green and blue, which leaves a spectral film black but for its colour.
fn warn_of_bands(p: &mut Parameters<'_, '_>, document: &Document) {
    let choice = document.integrator.iter().flat_map(|entity| &entity.parameters);
    let is_bands = |value: &Value| matches!(value, Value::Strings(words) if words[..] == ["bands"]);
    if choice.filter(|parameter| parameter.name == "wavelengths").any(|parameter| is_bands(&parameter.value))
    {
        let span = p.span();
        let message = "the integrator's wavelengths are \"bands\", which tell nothing of the spectrum: \
                       the film's spectral channels stay black";
        p.diagnostics().warning(span, message);
    }
}

fn read_spectral(p: &mut Parameters<'_, '_>) -> FilmKind {
    let n_buckets = p.integer("nbuckets", 16);
    let min_nm = p.float("lambdamin", 360.0);
    let max_nm = p.float("lambdamax", 830.0);
    if !(1..=1024).contains(&n_buckets) || min_nm >= max_nm {
        let span = p.span();
        p.diagnostics().error(
            span,
            "a spectral film needs 1 to 1024 \"nbuckets\" between \"lambdamin\" and \"lambdamax\"",
        );
        return FilmKind::Rgb;
    }
    FilmKind::Spectral { n_buckets: n_buckets as usize, min_nm, max_nm }
}

fn read_sensor(p: &mut Parameters<'_, '_>, document: &Document) -> Sensor {
    let name = p.string("sensor", "cie1931");
    let span = p.span_of("sensor");
    if CAMERA_SENSORS.contains(&name.as_str()) {
        let message = format!("the sensor \"{name}\" is not available yet; \"cie1931\" stands in for it");
        p.diagnostics().warning(span, message);
    } else if name != "cie1931" {
        let known = CAMERA_SENSORS.iter().copied().chain(["cie1931"]);
        p.diagnostics().unknown_name(span, "sensor", &name, known);
    }
    let white_balance = p.float("whitebalance", 0.0);
    Sensor::cie1931(&SensorSettings {
        exposure_time_s: p.float("exposuretime", 1.0),
        iso: p.float("iso", 100.0),
        white_balance_kelvin: (white_balance > 0.0).then_some(white_balance),
        color_space: document.film_color_space,
    })
}

pub(super) fn build_sampler(document: &Document, context: &mut BuildContext<'_>) -> SamplerSettings {
    let fallback = Entity::new("sobol");
    let entity = document.sampler.as_ref().unwrap_or(&fallback);
    let option_seed = document.options.iter().find(|o| o.name == "seed").and_then(|o| match &o.value {
        Value::Integers(values) => values.first().copied(),
        _ => None,
    });
    let mut p = Parameters::new(entity, context);
    let seed = p.integer("seed", option_seed.unwrap_or(0)) as u32;
    let (kind, samples) = match entity.type_name.as_str() {
        "independent" => (SamplerKind::Independent, p.integer("pixelsamples", 16)),
        "halton" => (SamplerKind::Halton, p.integer("pixelsamples", 16)),
        "stratified" => {
            let (x, y) = (p.integer("xsamples", 4).max(1), p.integer("ysamples", 4).max(1));
            let jitter = p.bool("jitter", true);
            (SamplerKind::Stratified { x: x as u32, y: y as u32, jitter }, x.saturating_mul(y))
        }
        "sobol" | "paddedsobol" | "pmj02bn" => (SamplerKind::Sobol, p.integer("pixelsamples", 16)),
        "zsobol" => (SamplerKind::ZSobol, p.integer("pixelsamples", 16)),
        unknown => {
            let span = p.span();
            p.diagnostics().unknown_name(span, "sampler", unknown, known_names(SAMPLERS));
            p.accept_all();
            (SamplerKind::Sobol, 16)
        }
    };
    // Every sampler here scrambles as Owen 1995 does; pbrt's weaker choices are accepted.
    p.ignore("randomization");
    if samples < 1 {
        let span = p.span_of("pixelsamples");
        p.diagnostics().error(span, format!("\"pixelsamples\" must be at least 1, not {samples}"));
    }
    p.finish();
    SamplerSettings { kind, seed: u64::from(seed), samples_per_pixel: samples.max(1) as u32 }
}
