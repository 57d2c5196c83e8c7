//! Primaries of linear RGB, whatever they are: what picture files state of themselves.

use crate::color_space::matrix_to_xyz;
use crate::matrix::{Matrix3, invert, multiply, transform};
use crate::xyz::xyz_of;
use crate::{ColorSpace, ColorSpaceName};

/// Twice the area of a triangle of primaries in the plane of chromaticities that is no triangle; that of sRGB has 0.22.
const LEAST_AREA: f64 = 1e-6;

/// What red, green and blue of a picture are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primaries {
    xyz_from_rgb: Matrix3,
}

impl Primaries {
    /// With chromaticities (x, y) of red, green, blue and white, the luminance of white being 1. `None` if no light is white,
    /// or the primaries lie on a line.
    #[must_use]
    pub fn new(red_green_blue: [[f32; 2]; 3], white: [f32; 2]) -> Option<Self> {
        let [red, green, blue] = red_green_blue.map(|xy| xy.map(f64::from));
        let [u, v] = [green, blue].map(|xy| [xy[0] - red[0], xy[1] - red[1]]);
        let spans_colours = (u[0] * v[1] - u[1] * v[0]).abs() > LEAST_AREA;
        let is_seen = white[1] > 0.0 && [red, green, blue].iter().all(|xy| xy[1] != 0.0);
        if !spans_colours || !is_seen {
            return None;
        }
        let xyz_from_rgb = matrix_to_xyz(&[red, green, blue], xyz_of(white.map(f64::from), 1.0))?;
        xyz_from_rgb.as_flattened().iter().all(|v| v.is_finite()).then_some(Self { xyz_from_rgb })
    }

    /// Those of a colour space.
    #[must_use]
    pub fn of(space: ColorSpaceName) -> Self {
        Self { xyz_from_rgb: ColorSpace::get(space).xyz_from_rgb.map(|row| row.map(f64::from)) }
    }

    /// Luminance of unit red, green and blue.
    #[must_use]
    pub fn luminance_weights(&self) -> [f32; 3] {
        self.xyz_from_rgb[1].map(|weight| weight as f32)
    }

    /// How linear RGB of these primaries is told by others, for the same light.
    pub fn converter(&self, to: &Self) -> impl Fn([f32; 3]) -> [f32; 3] + use<> {
        let matrix = multiply(&invert(&to.xyz_from_rgb), &self.xyz_from_rgb);
        let is_same = self == to;
        move |rgb| if is_same { rgb } else { transform(&matrix, rgb.map(f64::from)).map(|v| v as f32) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Xyz;

    /// Those that a file states of a known space are those of the space.
    #[test]
    fn stated_primaries_are_those_of_spaces() {
        for name in ColorSpaceName::ALL {
            let space = ColorSpace::get(name);
            let stated = Primaries::new(space.primaries_xy, space.white_xy).expect("primaries");
            for (a, b) in stated.luminance_weights().into_iter().zip(space.xyz_from_rgb[1]) {
                assert!((a - b).abs() < 1e-5, "{name:?}: {a} {b}");
            }
        }
    }

    /// The same light in both.
    #[test]
    fn conversion_keeps_the_light() {
        let (from, to) = (ColorSpaceName::Rec2020, ColorSpaceName::Srgb);
        let convert = Primaries::of(from).converter(&Primaries::of(to));
        let rgb = [0.3, 0.5, 0.2];
        let (a, b): (Xyz, Xyz) =
            (ColorSpace::get(from).to_xyz(rgb), ColorSpace::get(to).to_xyz(convert(rgb)));
        assert!(a.to_array().into_iter().zip(b.to_array()).all(|(a, b)| (a - b).abs() < 1e-6), "{a:?} {b:?}");
        let same = Primaries::of(from).converter(&Primaries::of(from));
        assert_eq!(same(rgb), rgb);
    }

    /// Files may state nonsense.
    #[test]
    fn nonsense_is_refused() {
        let [r, g, b, w] = [[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], [0.3127, 0.329]];
        assert!(Primaries::new([r, g, b], w).is_some());
        assert_eq!(Primaries::new([r, r, b], w), None);
        assert_eq!(Primaries::new([r, g, b], [0.3, 0.0]), None);
        assert_eq!(Primaries::new([r, [f32::NAN, 0.6], b], w), None);
        assert_eq!(Primaries::new([r, [0.3, 0.0], b], w), None);
    }
}
