//! Configurations of these models; see [`crate::bsdf::catalogue`].

use etendue_spectrum::Sampled;

use super::{BlinnPhong, Classic, Phong, PhongForm};
use crate::bsdf::BsdfKind;
use crate::bsdf::catalogue::Configuration;
use crate::bsdf::laws::Law;

const KD: Sampled = Sampled::from_array([0.1, 0.2, 0.4, 0.5]);
const KS: Sampled = Sampled::from_array([0.5, 0.4, 0.4, 0.3]);

/// All configurations: a new one is one line.
pub(in crate::bsdf) fn configurations() -> Vec<Configuration> {
    use Law::{Energy, Reciprocity};
    use PhongForm::{Illumination, Lewis};
    vec![
        phong("Lewis's Phong, 0", Lewis, 0.0),
        phong("Lewis's Phong, 30", Lewis, 30.0),
        phong("Lewis's Phong, 5000", Lewis, 5000.0),
        phong("Phong's equation, 0", Illumination, 0.0).breaking(&[Reciprocity, Energy]),
        phong("Phong's equation, 10", Illumination, 10.0).breaking(&[Reciprocity]),
        blinn_phong("Blinn, 0", 0.0),
        blinn_phong("Blinn, 30", 30.0),
        blinn_phong("Blinn, 5000", 5000.0),
    ]
}

/// A configuration with both colours.
fn colored(name: &'static str, model: &'static str, classic: Classic) -> Configuration {
    Configuration::new(name, model, BsdfKind::Classic(classic))
        .with("kd", &KD.to_array())
        .with("ks", &KS.to_array())
}

fn phong(name: &'static str, form: PhongForm, exponent: f32) -> Configuration {
    let form_name = match form {
        PhongForm::Lewis => "lewis",
        PhongForm::Illumination => "illumination",
    };
    colored(name, "phong", Classic::Phong(Phong { kd: KD, ks: KS, exponent, form }))
        .with("exponent", &[exponent])
        .named("form", form_name)
}

fn blinn_phong(name: &'static str, exponent: f32) -> Configuration {
    colored(name, "blinnphong", Classic::BlinnPhong(BlinnPhong { kd: KD, ks: KS, exponent }))
        .with("exponent", &[exponent])
}

impl Configuration {
    /// With a parameter that is a word.
    fn named(mut self, name: &'static str, word: &str) -> Self {
        self.parameters.push((name, word.to_owned()));
        self
    }
}
