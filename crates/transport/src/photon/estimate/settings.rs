//! What scene files say of the estimate.

use etendue_scene::parameters::{ParameterSpec, Parameters};

use super::{DensityEstimate, DifferentialChecking, Farthest, Filter, Volume};

/// Names of filters.
#[derive(Clone, Copy)]
enum FilterName {
    Constant,
    Cone,
    Gaussian,
    BookGaussian,
}

/// Names of volumes.
#[derive(Clone, Copy)]
enum VolumeName {
    Sphere,
    Disc,
    Cylinder,
    Cube,
}

const fn spec(
    name: &'static str,
    kind: &'static str,
    default: &'static str,
    doc: &'static str,
) -> ParameterSpec {
    ParameterSpec { name, kind, default, unit: "", doc }
}

impl DensityEstimate {
    /// Parameters in scene files, for the tables of methods.
    pub const PARAMETERS: [ParameterSpec; 10] = [
        spec(
            "filter",
            "string",
            "none",
            "weights of photons: none, cone, gaussian or bookgaussian (ends in a step)",
        ),
        spec(
            "conek",
            "float",
            "1.1",
            "of the cone: distance over radius at which weights meet 0, at least 1",
        ),
        spec("gaussianbeta", "float", "1.953", "of the Gaussian: its decay at the rim"),
        spec("volume", "string", "sphere", "where photons are taken from: sphere, disc, cylinder or cube"),
        spec("flatness", "float", "0.1", "of disc and cylinder: height over radius, at most 1"),
        spec(
            "hull",
            "bool",
            "false",
            "divide by what the photons' convex hull covers: exact beside straight walls",
        ),
        spec(
            "farthest",
            "string",
            "leaveout",
            "the farthest photon: leaveout, scale, or count (as in the book; too bright by k / (k - 1))",
        ),
        spec(
            "checkrun",
            "integer",
            "0",
            "changes in one direction at which the estimate stops taking photons; 0: never",
        ),
        spec("checkmin", "integer", "8", "of that: photons that are always taken"),
        spec("minphotons", "integer", "0", "where fewer photons count it is dark; darkens in the mean"),
    ];

    /// Reads the parameters of an integrator entity.
    pub fn from_parameters(p: &mut Parameters<'_, '_>) -> Self {
        let names = [
            ("none", FilterName::Constant),
            ("cone", FilterName::Cone),
            ("gaussian", FilterName::Gaussian),
            ("bookgaussian", FilterName::BookGaussian),
        ];
        let filter = p.choice("filter", "none", &names);
        let k = number(p, "conek", Filter::CONE_K, [1.0, f32::MAX]);
        // Below the least decay weights differ from constant ones by rounding alone, above the greatest they are all at one point.
        let beta = number(p, "gaussianbeta", Filter::BETA, [0.01, 80.0]);
        let names = [
            ("sphere", VolumeName::Sphere),
            ("disc", VolumeName::Disc),
            ("cylinder", VolumeName::Cylinder),
            ("cube", VolumeName::Cube),
        ];
        let volume = p.choice("volume", "sphere", &names);
        let flatness = number(p, "flatness", Volume::FLATNESS, [1e-4, 1.0]);
        let names =
            [("leaveout", Farthest::LeaveOut), ("scale", Farthest::Scale), ("count", Farthest::Count)];
        let farthest = p.choice("farthest", "leaveout", &names);
        let (run, min_photons) = (p.count("checkrun", 0), p.count("checkmin", 8));
        Self {
            filter: match filter {
                FilterName::Constant => Filter::Constant,
                FilterName::Cone => Filter::Cone { k },
                FilterName::Gaussian => Filter::Gaussian { beta, inner: beta },
                FilterName::BookGaussian => Filter::Gaussian { beta, inner: beta / 2.0 },
            },
            volume: match volume {
                VolumeName::Sphere => Volume::Sphere,
                VolumeName::Disc => Volume::Disc { flatness },
                VolumeName::Cylinder => Volume::Cylinder { flatness },
                VolumeName::Cube => Volume::Cube,
            },
            farthest,
            uses_hull: p.bool("hull", false),
            checking: (run > 0).then_some(DifferentialChecking { min_photons, run }),
            min_photons: p.count("minphotons", 0),
        }
    }
}

/// A number within limits; others are errors.
fn number(p: &mut Parameters<'_, '_>, name: &'static str, default: f32, [least, most]: [f32; 2]) -> f32 {
    let value = p.float(name, default);
    if (least..=most).contains(&value) {
        return value;
    }
    let span = p.span_of(name);
    let range =
        if most == f32::MAX { format!("at least {least}") } else { format!("from {least} to {most}") };
    p.diagnostics().error(span, format!("\"{name}\" must be {range}, not {value}"));
    default
}
