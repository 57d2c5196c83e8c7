//! A texture times a number that may itself vary.

use crate::parameters::ParameterSpec;

use super::FloatTexture;

/// `scale * texture`; `T` is the handle of either kind of texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale<T> {
    /// What is scaled.
    pub texture: T,
    /// The factor.
    pub scale: FloatTexture,
}

/// Parameters of the texture `scale`.
pub(super) const PARAMETERS: &[ParameterSpec] = &[
    ParameterSpec { name: "tex", kind: "texture", default: "1", unit: "", doc: "what is scaled" },
    ParameterSpec { name: "scale", kind: "float texture", default: "1", unit: "", doc: "the factor" },
];
