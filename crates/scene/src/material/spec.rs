//! Descriptions of parameters that several materials share.

use crate::parameters::ParameterSpec;

pub(super) const fn spec(
    name: &'static str,
    kind: &'static str,
    default: &'static str,
    doc: &'static str,
) -> ParameterSpec {
    ParameterSpec { name, kind, default, unit: "", doc }
}

pub(super) const ROUGHNESS: ParameterSpec =
    spec("roughness", "float texture", "0", "Roughness along both tangents; 0 is smooth.");
pub(super) const U_ROUGHNESS: ParameterSpec =
    spec("uroughness", "float texture", "roughness", "Roughness along the first tangent.");
pub(super) const V_ROUGHNESS: ParameterSpec =
    spec("vroughness", "float texture", "roughness", "Roughness along the second tangent.");
pub(super) const REMAP_ROUGHNESS: ParameterSpec = spec(
    "remaproughness",
    "bool",
    "true",
    "True: alpha is the square root of roughness. False: it is roughness itself.",
);
pub(super) const ETA: ParameterSpec = spec(
    "eta",
    "float or spectrum",
    "1.5",
    "Index of refraction inside relative to outside; spectra disperse light.",
);
pub(super) const ETA_EXTERIOR: ParameterSpec = spec(
    "eta_exterior",
    "float or spectrum",
    "1",
    "Index of refraction outside, by which eta is divided: of glass, where liquid touches it.",
);
pub(super) const ABSORPTION: ParameterSpec = ParameterSpec {
    unit: "1/m",
    ..spec(
        "absorption",
        "float or spectrum",
        "0",
        "Absorption coefficient inside: exp(-absorption d) gets through.",
    )
};
pub(super) const ABSORPTION_EXTERIOR: ParameterSpec =
    ParameterSpec { name: "absorption_exterior", doc: "Absorption coefficient outside.", ..ABSORPTION };
pub(super) const DISPLACEMENT: ParameterSpec = ParameterSpec {
    unit: "m",
    ..spec("displacement", "float texture", "", "Height whose slope bends the shading normal (bump mapping).")
};
pub(super) const NORMAL_MAP: ParameterSpec =
    spec("normalmap", "string", "", "Image file of tangent-space normals; overrides displacement.");
pub(super) const THICKNESS: ParameterSpec =
    spec("thickness", "float texture", "0.01", "Optical depth of the medium below the coat.");
pub(super) const G: ParameterSpec =
    spec("g", "float texture", "0", "Mean cosine of scattering in the medium below the coat, in (-1, 1).");
pub(super) const ALBEDO: ParameterSpec =
    spec("albedo", "spectrum texture", "0", "Albedo of the medium below the coat; 0 does not scatter.");
pub(super) const MAX_DEPTH: ParameterSpec =
    spec("maxdepth", "integer", "10", "Largest number of events of a walk between coat and base.");
pub(super) const N_SAMPLES: ParameterSpec = spec("nsamples", "integer", "1", "Walks per evaluation.");
pub(super) const EXPONENT: ParameterSpec =
    spec("exponent", "float texture", "30", "Exponent of the highlight, 0 to 1e6; larger is narrower.");
pub(super) const EXPONENT_100: ParameterSpec = ParameterSpec { default: "100", ..EXPONENT };
pub(super) const REFLECTANCE: ParameterSpec =
    spec("reflectance", "spectrum texture", "0.5", "Fraction of light reflected, in [0, 1].");
pub(super) const METAL_ETA: ParameterSpec =
    spec("eta", "spectrum texture", "metal-Cu-eta", "Real part of the index of refraction.");
pub(super) const METAL_K: ParameterSpec =
    spec("k", "spectrum texture", "metal-Cu-k", "Imaginary part of the index of refraction (absorption).");
pub(super) const METAL_REFLECTANCE: ParameterSpec =
    spec("reflectance", "spectrum texture", "", "Reflectance at normal incidence, in place of eta and k.");
