//! Dots of radius 0.35 in about two fifths of the unit cells of (s, t), shifted at random within their cell.

use etendue_math::{Point2, Point3};

use crate::parameters::ParameterSpec;

use super::noise::noise;
use super::{Mapping2, TextureContext};

/// Random dots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dots<T> {
    /// Texture coordinates.
    pub mapping: Mapping2,
    /// Within dots.
    pub inside: T,
    /// Between dots.
    pub outside: T,
}

/// True if the point lies in a dot.
fn is_inside(st: Point2) -> bool {
    const RADIUS: f32 = 0.35;
    let (s, t) = ((st.x + 0.5).floor(), (st.y + 0.5).floor());
    let noise2 = |s: f32, t: f32| noise(Point3::new(s, t, 0.5));
    if noise2(s + 0.5, t + 0.5) <= 0.0 {
        return false;
    }
    let max_shift = 0.5 - RADIUS;
    let centre =
        Point2::new(s + max_shift * noise2(s + 1.5, t + 2.8), t + max_shift * noise2(s + 4.5, t + 9.8));
    (st - centre).length_squared() < RADIUS * RADIUS
}

impl<T: Copy> Dots<T> {
    /// The texture that applies.
    #[must_use]
    pub fn select(&self, ctx: &TextureContext) -> T {
        if is_inside(self.mapping.map(ctx).st) { self.inside } else { self.outside }
    }
}

/// Parameters of the texture `dots`, besides those of its mapping.
pub(super) const PARAMETERS: &[ParameterSpec] = &[
    ParameterSpec { name: "inside", kind: "texture", default: "1", unit: "", doc: "within dots" },
    ParameterSpec { name: "outside", kind: "texture", default: "0", unit: "", doc: "between dots" },
];
