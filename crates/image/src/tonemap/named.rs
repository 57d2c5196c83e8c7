//! Operators by name, for command lines and lists.

use super::{
    Bilateral, DisplayCurve, Gradient, HistogramAdjustment, Logarithmic, Operator, Reinhard, ReinhardLocal,
};

/// What documentation says of an operator.
#[derive(Copy, Clone, Debug)]
pub struct OperatorSpec {
    /// Its name.
    pub name: &'static str,
    /// One line.
    pub doc: &'static str,
    /// Names, defaults and meanings of its parameters.
    pub parameters: &'static [[&'static str; 3]],
}

/// All operators.
pub const OPERATORS: &[OperatorSpec] = &[
    OperatorSpec { name: "clamp", doc: "clip to [0, 1]", parameters: &[] },
    OperatorSpec { name: "maximum", doc: "divide by the largest value", parameters: &[] },
    OperatorSpec { name: "exponential", doc: "1 - exp(-L / mean)", parameters: &[] },
    OperatorSpec {
        name: "logarithmic",
        doc: "adaptive logarithm of Drago et al. 2003",
        parameters: &[
            ["bias", "0.85", "less is brighter in the middle tones, in (0, 1)"],
            [
                "display",
                "100",
                "largest luminance of the display in cd/m^2; 100 makes the largest luminance white",
            ],
        ],
    },
    OperatorSpec {
        name: "reinhard",
        doc: "photographic operator of Reinhard et al. 2002, global",
        parameters: &[KEY, ["white", "infinity", "scaled luminance that becomes white"]],
    },
    OperatorSpec {
        name: "reinhard-local",
        doc: "the same with dodging and burning",
        parameters: &[
            KEY,
            [
                "sharpness",
                "1",
                "how much contrast small surroundings may have where it is not bright; 8 in the paper",
            ],
            ["threshold", "0.12", "contrast that ends a surrounding; 0.05 in the paper"],
            ["scales", "8", "sizes of surroundings, each 1.6 times the last"],
        ],
    },
    OperatorSpec {
        name: "bilateral",
        doc: "compressed base, kept detail; Durand and Dorsey 2002",
        parameters: &[
            ["contrast", "50", "ratio of the brightest to the darkest base that is shown, above 1"],
            ["space", "0.02", "reach of the filter as a share of the longer side"],
            ["range", "0.4", "reach of the filter in decades of luminance"],
        ],
    },
    OperatorSpec {
        name: "gradient",
        doc: "compressed gradients; Fattal et al. 2002",
        parameters: &[
            ["threshold", "0.1", "gradients of this share of the mean one stay"],
            ["exponent", "0.85", "less compresses steep gradients more, in (0, 1]"],
            ["saturation", "0.6", "power of the ratio of channels to luminance"],
        ],
    },
    OperatorSpec {
        name: "histogram",
        doc: "histogram adjustment of Larson et al. 1997",
        parameters: &[
            ["contrast", "100", "ratio of the display's white to its black, above 1"],
            ["glances", "60", "degrees of view across the picture"],
        ],
    },
    OperatorSpec { name: "filmic", doc: "curve of film of Hable 2010", parameters: &[] },
    OperatorSpec { name: "aces", doc: "ACES for sRGB as fitted by Hill 2016", parameters: &[] },
    OperatorSpec { name: "agx", doc: "AgX as fitted by Wrensch 2023", parameters: &[] },
];

const KEY: [&str; 3] = ["key", "0.18", "scaled luminance of the log-average"];

impl Operator {
    /// The operator of that name with these parameters, the others at their defaults.
    ///
    /// # Errors
    /// A sentence for people, for names that are unknown and values out of their range.
    pub fn named(name: &str, parameters: &[(&str, f32)]) -> Result<Self, String> {
        let Some(spec) = OPERATORS.iter().find(|spec| spec.name == name) else {
            let names: Vec<&str> = OPERATORS.iter().map(|spec| spec.name).collect();
            return Err(format!("no operator is called '{name}'; there are {}", names.join(", ")));
        };
        let mut operator = Self::with_defaults(name);
        for (parameter, value) in parameters {
            if !spec.parameters.iter().any(|[known, ..]| known == parameter) {
                let known: Vec<&str> = spec.parameters.iter().map(|[known, ..]| *known).collect();
                let known = if known.is_empty() {
                    "it has none".to_owned()
                } else {
                    format!("it has {}", known.join(", "))
                };
                return Err(format!("'{name}' has no parameter '{parameter}'; {known}"));
            }
            let (bound, most) = (operator.lower_bound(parameter), operator.largest(parameter));
            if !(*value > bound && *value <= most) {
                return Err(format!(
                    "'{parameter}' of '{name}' must be above {bound} and at most {most}, not {value}"
                ));
            }
            operator.set(parameter, *value);
        }
        Ok(operator)
    }

    fn with_defaults(name: &str) -> Self {
        match name {
            "maximum" => Self::DivideByMaximum,
            "exponential" => Self::Exponential,
            "logarithmic" => Self::Logarithmic(Logarithmic::default()),
            "reinhard" => Self::Reinhard(Reinhard::default()),
            "reinhard-local" => Self::ReinhardLocal(ReinhardLocal::default()),
            "bilateral" => Self::Bilateral(Bilateral::default()),
            "gradient" => Self::Gradient(Gradient::default()),
            "histogram" => Self::Histogram(HistogramAdjustment::default()),
            "filmic" => Self::Display(DisplayCurve::Filmic),
            "aces" => Self::Display(DisplayCurve::Aces),
            "agx" => Self::Display(DisplayCurve::Agx),
            _ => Self::Clamp,
        }
    }

    /// What a parameter must be above: a display without contrast shows nothing.
    fn lower_bound(self, parameter: &str) -> f32 {
        match (self, parameter) {
            (Self::Bilateral(_) | Self::Histogram(_), "contrast") => 1.0,
            _ => 0.0,
        }
    }

    /// The largest value of a parameter that makes sense and bounds the work.
    fn largest(self, parameter: &str) -> f32 {
        match (self, parameter) {
            (Self::Logarithmic(_), "bias") => 0.99,
            (Self::ReinhardLocal(_), "scales") => 12.0,
            (Self::ReinhardLocal(_), "sharpness") => 30.0,
            (Self::Bilateral(_), "space") | (Self::Gradient(_), "exponent") => 1.0,
            (Self::Histogram(_), "glances") => 100_000.0,
            (Self::Reinhard(_), "white") => f32::INFINITY,
            _ => 1e6,
        }
    }

    fn set(&mut self, parameter: &str, value: f32) {
        match (self, parameter) {
            (Self::Logarithmic(o), "bias") => o.bias = value,
            (Self::Logarithmic(o), "display") => o.display = value,
            (Self::Reinhard(o), "key") => o.key = value,
            (Self::Reinhard(o), "white") => o.white = value.is_finite().then_some(value),
            (Self::ReinhardLocal(o), "key") => o.key = value,
            (Self::ReinhardLocal(o), "sharpness") => o.sharpness = value,
            (Self::ReinhardLocal(o), "threshold") => o.threshold = value,
            (Self::ReinhardLocal(o), "scales") => o.n_scales = value as u32,
            (Self::Bilateral(o), "contrast") => o.contrast = value,
            (Self::Bilateral(o), "space") => o.space = value.max(5e-3),
            (Self::Bilateral(o), "range") => o.range = value.max(0.05),
            (Self::Gradient(o), "threshold") => o.threshold = value,
            (Self::Gradient(o), "exponent") => o.exponent = value,
            (Self::Gradient(o), "saturation") => o.saturation = value,
            (Self::Histogram(o), "contrast") => o.contrast = value,
            (Self::Histogram(o), "glances") => o.glances = (value as u32).max(1),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the table says of each parameter is what it does.
    #[test]
    fn the_table_is_what_there_is() {
        for spec in OPERATORS {
            let default = Operator::named(spec.name, &[]).expect("an operator");
            for [parameter, written, _] in spec.parameters {
                if let Ok(value) = written.parse() {
                    assert_eq!(
                        Operator::named(spec.name, &[(parameter, value)]),
                        Ok(default),
                        "{} {parameter}",
                        spec.name
                    );
                }
                assert_ne!(
                    Operator::named(spec.name, &[(parameter, 0.5)]),
                    Ok(default),
                    "{} {parameter}",
                    spec.name
                );
                assert!(Operator::named(spec.name, &[(parameter, -1.0)]).is_err());
                assert!(Operator::named(spec.name, &[(parameter, f32::NAN)]).is_err());
            }
            let error = Operator::named(spec.name, &[("kye", 1.0)]).expect_err("no parameter is called so");
            assert!(error.contains("kye"), "{error}");
        }
        for name in ["bilateral", "histogram"] {
            for contrast in [0.5, 1.0] {
                let error = Operator::named(name, &[("contrast", contrast)]).expect_err("no contrast");
                assert!(error.contains("above 1 and"), "{error}");
            }
            assert!(Operator::named(name, &[("contrast", 1.1)]).is_ok());
        }
        assert!(Operator::named("rheinhard", &[]).expect_err("no such").contains("reinhard-local"));
    }
}
