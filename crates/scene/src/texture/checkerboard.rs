//! Checks in the plane or in space, antialiased.
//!
//! With the square wave w(x) = +1 on even and -1 on odd unit intervals, the board is `(1 - w(s) w(t)) / 2`. Each factor is
//! averaged with a tent filter of half width r in closed form: a tent is the second difference of the second integral D of w,
//! `(D(x + r) - 2 D(x) + D(x - r)) / r^2`. The product of averages is exact for a filter aligned with s and t.

use crate::parameters::ParameterSpec;

use super::{Mapping2, Mapping3, TextureContext};

/// The space that the checks fill.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CheckMapping {
    /// Squares.
    Plane(Mapping2),
    /// Cubes.
    Space(Mapping3),
}

/// Two textures in alternate cells of unit size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkerboard<T> {
    /// Squares or cubes, and where.
    pub mapping: CheckMapping,
    /// In the cell at the origin.
    pub a: T,
    /// In its neighbours.
    pub b: T,
}

/// The second integral of the square wave, of period 2.
fn second_integral(x: f64) -> f64 {
    let y = x / 2.0 - (x / 2.0).floor() - 0.5;
    y * (1.0 - 2.0 * y.abs())
}

/// The square wave averaged with a tent of half width `r`.
fn filtered_wave(x: f32, r: f32) -> f32 {
    if (x - r).floor() == (x + r).floor() {
        return if x.floor().rem_euclid(2.0) == 0.0 { 1.0 } else { -1.0 };
    }
    // Double precision: the second difference of a narrow tent cancels.
    let (x, r) = (f64::from(x), f64::from(r));
    ((second_integral(x + r) - 2.0 * second_integral(x) + second_integral(x - r)) / (r * r)) as f32
}

impl<T> Checkerboard<T> {
    /// The share of `b`.
    #[must_use]
    pub fn amount(&self, ctx: &TextureContext) -> f32 {
        const WIDTH: f32 = 1.5;
        let radius = |a: f32, b: f32| WIDTH * a.abs().max(b.abs());
        let product = match &self.mapping {
            CheckMapping::Plane(mapping) => {
                let c = mapping.map(ctx);
                filtered_wave(c.st.x, radius(c.dsdx, c.dsdy)) * filtered_wave(c.st.y, radius(c.dtdx, c.dtdy))
            }
            CheckMapping::Space(mapping) => {
                let c = mapping.map(ctx);
                (0..3).map(|axis| filtered_wave(c.p[axis], radius(c.dpdx[axis], c.dpdy[axis]))).product()
            }
        };
        0.5 - 0.5 * product
    }
}

/// Parameters of the texture `checkerboard`, besides those of its mapping.
pub(super) const PARAMETERS: &[ParameterSpec] = &[
    ParameterSpec { name: "dimension", kind: "integer", default: "2", unit: "", doc: "2: squares; 3: cubes" },
    ParameterSpec { name: "tex1", kind: "texture", default: "1", unit: "", doc: "in the cell at the origin" },
    ParameterSpec { name: "tex2", kind: "texture", default: "0", unit: "", doc: "in its neighbours" },
];
