//! Bilinear interpolation between the four corners of the (s, t) unit square, continued linearly beyond it.

use crate::parameters::ParameterSpec;

use super::{Mapping2, TextureContext};

/// Interpolates between four constants; `v01` is the value at s = 0, t = 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bilerp<T> {
    /// Texture coordinates.
    pub mapping: Mapping2,
    /// Values at (s, t) = 00, 01, 10, 11.
    pub corners: [T; 4],
}

impl<T> Bilerp<T> {
    /// Weights of the corners.
    #[must_use]
    pub fn weights(&self, ctx: &TextureContext) -> [f32; 4] {
        let st = self.mapping.map(ctx).st;
        [(1.0 - st.x) * (1.0 - st.y), (1.0 - st.x) * st.y, st.x * (1.0 - st.y), st.x * st.y]
    }
}

/// Parameters of the texture `bilerp`, besides those of its mapping.
pub(super) const PARAMETERS: &[ParameterSpec] = &[
    ParameterSpec {
        name: "v00",
        kind: "float or spectrum",
        default: "0",
        unit: "",
        doc: "value at s = 0, t = 0",
    },
    ParameterSpec {
        name: "v01",
        kind: "float or spectrum",
        default: "1",
        unit: "",
        doc: "value at s = 0, t = 1",
    },
    ParameterSpec {
        name: "v10",
        kind: "float or spectrum",
        default: "0",
        unit: "",
        doc: "value at s = 1, t = 0",
    },
    ParameterSpec {
        name: "v11",
        kind: "float or spectrum",
        default: "1",
        unit: "",
        doc: "value at s = 1, t = 1",
    },
];
