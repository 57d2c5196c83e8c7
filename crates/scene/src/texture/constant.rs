//! The same value everywhere; needs no node, since the handles hold constants.

use crate::parameters::ParameterSpec;

/// Parameters of the texture `constant`.
pub(super) const PARAMETERS: &[ParameterSpec] =
    &[ParameterSpec { name: "value", kind: "float or spectrum", default: "1", unit: "", doc: "the value" }];
