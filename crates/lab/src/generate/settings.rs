//! Parameters of generated scenes: what there is, and what was asked for.

use etendue_scene::diagnostics::nearest_name;
use etendue_scene::parameters::ParameterSpec;

use super::Generator;

/// A parameter of a generator.
#[derive(Clone, Copy, Debug)]
pub struct Knob {
    /// Name, type (`integer`, `float` or `string`), default and meaning.
    pub spec: ParameterSpec,
    /// What its values may be.
    pub domain: Domain,
}

/// The values of a parameter.
#[derive(Clone, Copy, Debug)]
pub enum Domain {
    /// Numbers from the first to the second.
    Range(f64, f64),
    /// One of these words.
    Words(&'static [&'static str]),
}

/// A whole number.
pub(super) const fn count(
    name: &'static str,
    default: &'static str,
    [min, max]: [u32; 2],
    doc: &'static str,
) -> Knob {
    let spec = ParameterSpec { name, kind: "integer", default, unit: "", doc };
    Knob { spec, domain: Domain::Range(min as f64, max as f64) }
}

/// A number with a unit.
pub(super) const fn number(
    name: &'static str,
    default: &'static str,
    [min, max]: [f64; 2],
    unit: &'static str,
    doc: &'static str,
) -> Knob {
    Knob { spec: ParameterSpec { name, kind: "float", default, unit, doc }, domain: Domain::Range(min, max) }
}

/// A word.
pub(super) const fn choice(
    name: &'static str,
    default: &'static str,
    words: &'static [&'static str],
    doc: &'static str,
) -> Knob {
    Knob {
        spec: ParameterSpec { name, kind: "string", default, unit: "", doc },
        domain: Domain::Words(words),
    }
}

/// The seed of what is random in a scene.
pub(super) const SEED: Knob = count("seed", "1", [0, i32::MAX as u32], "random seed");

/// Why parameters are refused: a sentence for whom typed them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SettingError(pub String);

impl std::fmt::Display for SettingError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for SettingError {}

/// The value of each parameter of a generator, in the order of its table.
#[derive(Clone, Debug)]
pub struct Settings {
    generator: &'static Generator,
    values: Vec<String>,
}

impl Settings {
    /// The defaults, changed as asked for.
    ///
    /// # Errors
    /// For names that the generator does not have and values that are no numbers, out of range or unknown words.
    pub fn new<'a>(
        generator: &'static Generator,
        changes: impl IntoIterator<Item = (&'a str, &'a str)>,
    ) -> Result<Self, SettingError> {
        let values = generator.parameters.iter().map(|knob| knob.spec.default.to_owned()).collect();
        let mut settings = Self { generator, values };
        for (name, value) in changes {
            let index = settings.index(name)?;
            check(&generator.parameters[index], value)?;
            settings.values[index] = value.to_owned();
        }
        Ok(settings)
    }

    fn index(&self, name: &str) -> Result<usize, SettingError> {
        let scene = self.generator.name;
        let knobs = self.generator.parameters;
        let names = || knobs.iter().map(|knob| knob.spec.name);
        names().position(|known| known == name).ok_or_else(|| {
            SettingError(match nearest_name(name, names()) {
                Some(near) => format!("the scene \"{scene}\" has no parameter {name}; did you mean {near}?"),
                None if knobs.is_empty() => format!("the scene \"{scene}\" has no parameters"),
                None => {
                    let known: Vec<&str> = names().collect();
                    format!("the scene \"{scene}\" has no parameter {name}; it has {}", known.join(", "))
                }
            })
        })
    }

    /// The value of a parameter of the table.
    ///
    /// # Panics
    /// If the table lacks it, which is our bug.
    fn value(&self, name: &str) -> &str {
        match self.generator.parameters.iter().position(|knob| knob.spec.name == name) {
            Some(index) => &self.values[index],
            None => panic!("the scene \"{}\" asks for {name}, which its table lacks", self.generator.name),
        }
    }

    /// The value of a number.
    pub(super) fn number(&self, name: &str) -> f32 {
        self.value(name).parse().unwrap_or_else(|_| panic!("{name} was checked"))
    }

    /// The value of a whole number.
    pub(super) fn count(&self, name: &str) -> u32 {
        self.value(name).parse().unwrap_or_else(|_| panic!("{name} was checked"))
    }

    /// The value of a word.
    pub(super) fn word(&self, name: &str) -> &str {
        self.value(name)
    }
}

fn check(knob: &Knob, value: &str) -> Result<(), SettingError> {
    let ParameterSpec { name, kind, .. } = knob.spec;
    match knob.domain {
        Domain::Range(min, max) => {
            let is_integer = kind == "integer";
            let number =
                if is_integer { value.parse::<u32>().map(f64::from).ok() } else { value.parse::<f64>().ok() };
            match number {
                Some(number) if (min..=max).contains(&number) => Ok(()),
                Some(_) => Err(SettingError(format!("{name} must be from {min} to {max}, and is {value}"))),
                None => {
                    let what = if is_integer { "a whole number" } else { "a number" };
                    Err(SettingError(format!("{name} must be {what} from {min} to {max}; '{value}' is not")))
                }
            }
        }
        Domain::Words(words) if words.contains(&value) => Ok(()),
        Domain::Words(words) => {
            let hint = match nearest_name(value, words.iter().copied()) {
                Some(near) => format!("did you mean {near}?"),
                None => format!("it is one of {}", words.join(", ")),
            };
            Err(SettingError(format!("'{value}' is no value of {name}; {hint}")))
        }
    }
}
