//! Pictures for the eye to compare.

use crate::Image;

/// Luminance of the lines that part pictures; white of a display.
const LINE: [f32; 3] = [1.0; 3];

/// Pictures beside each other, parted by a white line. They have the height of the tallest; what is missing is black.
///
/// `None` if there is a picture without colour, or none at all.
#[must_use]
pub fn side_by_side(pictures: &[&Image]) -> Option<Image> {
    let height = pictures.iter().map(|picture| picture.height).max()?;
    let pixels: Vec<Vec<[f32; 3]>> =
        pictures.iter().map(|picture| picture.rgb_pixels()).collect::<Option<_>>()?;
    let mut rows = Vec::new();
    for y in 0..height {
        for (index, (picture, pixels)) in pictures.iter().zip(&pixels).enumerate() {
            if index > 0 {
                rows.push(LINE);
            }
            match pixels.get(y * picture.width..(y + 1) * picture.width) {
                Some(row) => rows.extend_from_slice(row),
                None => rows.extend(std::iter::repeat_n([0.0; 3], picture.width)),
            }
        }
    }
    let width = pictures.iter().map(|picture| picture.width).sum::<usize>() + pictures.len() - 1;
    Some(Image::rgb(width, height, rows))
}

/// One picture: its left half of the first, its right half of the second, parted by a white line.
///
/// `None` if a picture has no colour, or the sizes differ.
#[must_use]
pub fn split(left: &Image, right: &Image) -> Option<Image> {
    if [left.width, left.height] != [right.width, right.height] {
        return None;
    }
    let (a, b) = (left.rgb_pixels()?, right.rgb_pixels()?);
    let middle = left.width / 2;
    Some(Image::from_fn(left.width, left.height, |x, y| match x.cmp(&middle) {
        std::cmp::Ordering::Less => a[y * left.width + x],
        std::cmp::Ordering::Equal => LINE,
        std::cmp::Ordering::Greater => b[y * left.width + x],
    }))
}
