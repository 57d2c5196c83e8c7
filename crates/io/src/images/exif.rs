//! How long a photograph was exposed.

use std::fs::File;
use std::io::BufReader;
use std::panic::catch_unwind;
use std::path::Path;

use exif::{In, Tag};

/// Seconds that a photograph was exposed, at f/1 and ISO 100: the time, times the gain, over the square of the f-number. `None`
/// if its Exif data does not say the time, or cannot be read; what else is missing counts as 1.
#[must_use]
pub fn exposure_of_photograph(path: impl AsRef<Path>) -> Option<f32> {
    let mut file = BufReader::new(File::open(path).ok()?);
    // No panic of a decoder ends the process.
    catch_unwind(move || {
        let data = exif::Reader::new().read_from_container(&mut file).ok()?;
        let number = |tag: Tag| match &data.get_field(tag, In::PRIMARY)?.value {
            exif::Value::Rational(values) => values.first().map(exif::Rational::to_f64),
            other => other.get_uint(0).map(f64::from),
        };
        let seconds = number(Tag::ExposureTime)?;
        let gain = number(Tag::PhotographicSensitivity).map_or(1.0, |iso| iso / 100.0);
        let aperture = number(Tag::FNumber).map_or(1.0, |n| n * n);
        let exposure = (seconds * gain / aperture) as f32;
        (exposure > 0.0 && exposure.is_finite()).then_some(exposure)
    })
    .ok()
    .flatten()
}
