//! Blends of two textures: by an amount that may vary, or by the direction of the surface normal.

use etendue_math::Vector3;

use crate::parameters::ParameterSpec;

use super::{FloatTexture, TextureContext};

/// `(1 - amount) a + amount b`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mix<T> {
    /// Where the amount is 0.
    pub a: T,
    /// Where the amount is 1.
    pub b: T,
    /// The share of `b`.
    pub amount: FloatTexture,
}

/// `m a + (1 - m) b` with `m = |n . direction|`: `a` where the surface faces along the direction or against it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionMix<T> {
    /// Where the normal is along the direction.
    pub a: T,
    /// Where the normal is across.
    pub b: T,
    /// Unit vector in the world.
    pub direction: Vector3,
}

impl<T> DirectionMix<T> {
    /// The share of `b`.
    #[must_use]
    pub fn amount(&self, ctx: &TextureContext) -> f32 {
        1.0 - ctx.n.abs_dot_vector(self.direction)
    }
}

/// Parameters of the texture `mix`.
pub(super) const PARAMETERS: &[ParameterSpec] = &[
    ParameterSpec { name: "tex1", kind: "texture", default: "0", unit: "", doc: "where the amount is 0" },
    ParameterSpec { name: "tex2", kind: "texture", default: "1", unit: "", doc: "where the amount is 1" },
    ParameterSpec {
        name: "amount",
        kind: "float texture",
        default: "0.5",
        unit: "",
        doc: "the share of tex2",
    },
];

/// Parameters of the texture `directionmix`.
pub(super) const DIRECTION_PARAMETERS: &[ParameterSpec] = &[
    ParameterSpec {
        name: "tex1",
        kind: "texture",
        default: "0",
        unit: "",
        doc: "where the normal is along dir",
    },
    ParameterSpec {
        name: "tex2",
        kind: "texture",
        default: "1",
        unit: "",
        doc: "where the normal is across dir",
    },
    ParameterSpec {
        name: "dir",
        kind: "vector3",
        default: "0 1 0",
        unit: "",
        doc: "direction in texture space",
    },
];
