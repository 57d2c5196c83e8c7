//! What red, green and blue of a picture are, and the same light told by others.

use std::borrow::Cow;

use etendue::image::Image;
use etendue::spectrum::{ColorSpaceName, Primaries};

use crate::metadata::{self, CHROMATICITIES, COLOR_SPACE, LUMINANCE};

/// The primaries that a picture states, else those of sRGB.
fn stated(image: &Image) -> Primaries {
    let space = image.metadata.get(COLOR_SPACE).and_then(|name| ColorSpaceName::from_name(name));
    let by_numbers = || {
        let [rx, ry, gx, gy, bx, by, wx, wy] = metadata::numbers(image, CHROMATICITIES)?;
        Primaries::new([[rx, ry], [gx, gy], [bx, by]], [wx, wy])
    };
    space.map(Primaries::of).or_else(by_numbers).unwrap_or_else(|| Primaries::of(ColorSpaceName::Srgb))
}

/// Luminance of unit red, green and blue of a picture.
pub(crate) fn luminance_weights(image: &Image) -> [f32; 3] {
    metadata::numbers(image, LUMINANCE).unwrap_or_else(|| stated(image).luminance_weights())
}

/// Takes the colour of a picture to the primaries of a space from those that it states; the white stays the same light. It states
/// none any more.
pub(crate) fn convert(image: &mut Image, to: ColorSpaceName) {
    let from = stated(image);
    for key in [COLOR_SPACE, CHROMATICITIES] {
        image.metadata.remove(key);
    }
    if from != Primaries::of(to) {
        image.metadata.remove(LUMINANCE);
        convert_from(image, from, to);
    }
}

/// Takes the colour of a picture from some primaries to those of a space.
pub(crate) fn convert_from(image: &mut Image, from: Primaries, to: ColorSpaceName) {
    if image.channel("R").is_some() {
        map_pixels(image, from.converter(&Primaries::of(to)));
    }
}

/// Changes the colour of each pixel; gray becomes colour.
pub(crate) fn map_pixels(image: &mut Image, f: impl Fn([f32; 3]) -> [f32; 3]) {
    let Some(pixels) = image.rgb_pixels() else { return };
    let pixels: Vec<[f32; 3]> = pixels.into_iter().map(f).collect();
    image.set_rgb("", &pixels);
}

/// The picture for a format that states no primaries: its colour is that of sRGB.
pub(crate) fn for_untold(image: &Image) -> Cow<'_, Image> {
    if stated(image) == Primaries::of(ColorSpaceName::Srgb) {
        return Cow::Borrowed(image);
    }
    let mut converted = image.clone();
    convert(&mut converted, ColorSpaceName::Srgb);
    Cow::Owned(converted)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn green(key: &str, value: &str) -> Image {
        let mut image = Image::rgb(1, 1, vec![[0.0, 1.0, 0.0]]);
        image.metadata.insert(key.to_owned(), value.to_owned());
        image
    }

    /// The standard attribute says as much as our own.
    #[test]
    fn primaries_are_those_that_files_state() {
        let rec2020 = "0.708 0.292 0.170 0.797 0.131 0.046 0.3127 0.3290";
        for mut image in [green(COLOR_SPACE, "rec2020"), green(CHROMATICITIES, rec2020)] {
            assert!((luminance_weights(&image)[1] - 0.678).abs() < 1e-3);
            convert(&mut image, ColorSpaceName::Srgb);
            let [r, g, b] = image.rgb_pixels().expect("colour")[0];
            // Rec. ITU-R BT.2087, the inverse of its matrix.
            assert!((r + 0.5876).abs() < 2e-3 && (g - 1.1329).abs() < 2e-3 && (b + 0.1006).abs() < 2e-3);
            assert!(image.metadata.is_empty());
        }
        let plain = Image::rgb(1, 1, vec![[0.0, 1.0, 0.0]]);
        assert!(matches!(for_untold(&plain), Cow::Borrowed(_)));
        assert!(matches!(for_untold(&green(CHROMATICITIES, "nonsense")), Cow::Borrowed(_)));
        assert!(matches!(for_untold(&green(CHROMATICITIES, rec2020)), Cow::Owned(_)));
    }

    /// Gray has no primaries.
    #[test]
    fn gray_stays_as_it_is() {
        let mut image = Image::gray(2, 1, vec![1.0, 3.0]);
        image.metadata.insert(COLOR_SPACE.to_owned(), "rec2020".to_owned());
        convert(&mut image, ColorSpaceName::Srgb);
        assert_eq!(image.channels[0].values, [1.0, 3.0]);
        assert_eq!(image.channels.len(), 1);
    }
}
