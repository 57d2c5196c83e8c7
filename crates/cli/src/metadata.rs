//! What image files say of themselves, and how it is read back.

use std::collections::BTreeMap;
use std::ops::Range;

use etendue::image::Image;
use etendue::scene::document::Value;
use etendue::scene::film::PixelBounds;
use etendue::scene::{Film, Scene};
use etendue::spectrum::{ColorSpace, ColorSpaceName};
use etendue::transport::method_name;

/// Keys of the metadata.
pub(crate) const FINGERPRINT: &str = "etendue.fingerprint";
/// Seed of the sampler.
pub(crate) const SEED: &str = "etendue.seed";
/// Passes in the image, as `0..8 16..24`.
pub(crate) const PASSES: &str = "etendue.passes";
/// Samples per pixel.
pub(crate) const SPP: &str = "etendue.spp";
/// Rendered pixels: x0 x1 y0 y1 of the full image.
pub(crate) const PIXELS: &str = "etendue.pixels";
/// Luminance of unit red, green and blue.
pub(crate) const LUMINANCE: &str = "etendue.luminance";
/// Name of the colour space of the colour channels.
pub(crate) const COLOR_SPACE: &str = "etendue.colorspace";
/// Their primaries and white, as files of OpenEXR tell them: x and y of red, green, blue and white.
pub(crate) const CHROMATICITIES: &str = "chromaticities";
/// Luminance of the colour (1, 1, 1) in cd/m², as files of OpenEXR tell it.
pub(crate) const WHITE_LUMINANCE: &str = "whiteLuminance";

/// Describes a render.
#[must_use]
pub(crate) fn describe(
    scene: &Scene,
    film: &Film,
    fingerprint: u64,
    scene_name: &str,
) -> BTreeMap<String, String> {
    let mut metadata = BTreeMap::new();
    let mut set = |key: &str, value: String| metadata.insert(key.to_owned(), value);
    set("software", format!("etendue {}", env!("CARGO_PKG_VERSION")));
    set("etendue.scene", scene_name.to_owned());
    set(FINGERPRINT, format!("{fingerprint:016x}"));
    set(SEED, scene.sampler.seed.to_string());
    set(PASSES, format_passes(film.passes()));
    set(SPP, film.n_passes().to_string());
    set("etendue.integrator", describe_integrator(scene));
    set("etendue.unit", "cd/m^2 times exposure time in s times ISO / 100".to_owned());
    set(COLOR_SPACE, film.settings().color_space.name().to_owned());
    if film.settings().color_space != ColorSpaceName::Srgb {
        let space = ColorSpace::get(film.settings().color_space);
        let points = space.primaries_xy.iter().chain([&space.white_xy]).flatten();
        set(CHROMATICITIES, points.map(ToString::to_string).collect::<Vec<_>>().join(" "));
    }
    let crop = film.settings().crop;
    set(PIXELS, format!("{} {} {} {}", crop.min[0], crop.max[0], crop.min[1], crop.max[1]));
    set("etendue.resolution", format!("{} {}", film.settings().resolution[0], film.settings().resolution[1]));
    set(LUMINANCE, film.settings().luminance_weights().map(|w| w.to_string()).join(" "));
    set(WHITE_LUMINANCE, film.settings().sensor.settings().imaging_ratio().recip().to_string());
    let resolution = film.settings().resolution;
    if [crop.min, crop.max] != [[0, 0], resolution] {
        set("dataWindow", format!("{} {}", crop.min[0], crop.min[1]));
        set("displayWindow", format!("0 0 {} {}", resolution[0], resolution[1]));
    }
    let (world_to_camera, world_to_ndc) = scene.camera.projection_matrices(resolution);
    set("worldToCamera", join(&world_to_camera));
    if let Some(matrix) = world_to_ndc {
        set("worldToNDC", join(&matrix));
    }
    let camera = scene.camera.world_from_camera().start;
    let rows: Vec<String> = camera.rows().iter().flatten().map(ToString::to_string).collect();
    set("etendue.world_from_camera", rows.join(" "));
    metadata
}

/// Rows of a matrix for column vectors as one of row vectors, as files of OpenEXR have them.
fn join(matrix: &[[f32; 4]; 4]) -> String {
    let transposed = (0..4).flat_map(|column| (0..4).map(move |row| matrix[row][column].to_string()));
    transposed.collect::<Vec<_>>().join(" ")
}

fn describe_integrator(scene: &Scene) -> String {
    let name = method_name(&scene.integrator.type_name);
    let parameters = scene.integrator.parameters.iter();
    let list: Vec<String> =
        parameters.filter_map(|p| Some(format!("{}={}", p.name, text(&p.value)?))).collect();
    if list.is_empty() { name.to_owned() } else { format!("{name}:{}", list.join(",")) }
}

/// A single value as the command line takes it.
fn text(value: &Value) -> Option<String> {
    match value {
        Value::Integers(values) => values.first().map(ToString::to_string),
        Value::Floats(values) => values.first().map(ToString::to_string),
        Value::Bools(values) => values.first().map(ToString::to_string),
        Value::Strings(values) => values.first().cloned(),
        _ => None,
    }
}

fn format_passes(passes: &[Range<u64>]) -> String {
    passes.iter().map(|r| format!("{}..{}", r.start, r.end)).collect::<Vec<_>>().join(" ")
}

/// Passes of an image.
#[must_use]
pub(crate) fn passes(image: &Image) -> Option<Vec<Range<u64>>> {
    let text = image.metadata.get(PASSES)?;
    let ranges = text.split_whitespace().map(|range| {
        let (start, end) = range.split_once("..")?;
        Some(start.parse().ok()?..end.parse().ok()?)
    });
    ranges.collect()
}

/// Numbers of a metadata entry.
#[must_use]
pub(crate) fn numbers<T: std::str::FromStr, const N: usize>(image: &Image, key: &str) -> Option<[T; N]> {
    let values: Vec<T> =
        image.metadata.get(key)?.split_whitespace().map(|n| n.parse().ok()).collect::<Option<_>>()?;
    values.try_into().ok()
}

/// Pixels of the full image that an image holds.
#[must_use]
pub(crate) fn pixels(image: &Image) -> Option<PixelBounds> {
    let [x0, x1, y0, y1] = numbers(image, PIXELS)?;
    Some(PixelBounds { min: [x0, y0], max: [x1, y1] })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Passes survive the way through text.
    #[test]
    fn passes_round_trip() {
        let ranges = vec![0..8, 12..13];
        let mut image = Image::new(1, 1);
        image.metadata.insert(PASSES.to_owned(), format_passes(&ranges));
        assert_eq!(passes(&image), Some(ranges));
        image.metadata.insert(PASSES.to_owned(), "nonsense".to_owned());
        assert_eq!(passes(&image), None);
    }
}
