//! Named configurations of all models, for tests and for `etendue brdf --all`.
//!
//! Each states the laws that it breaks by its nature; tests hold it to all others, and show that those stated are broken.

use etendue_spectrum::Sampled;

use super::laws::Law;
use super::microfacet::Microfacets;
use super::{
    Base, BsdfKind, Conductor, Dielectric, Diffuse, DiffuseTransmission, Layered, ThinDielectric, classic,
};

/// A BSDF with a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration {
    /// What tells it from others of its model.
    pub name: &'static str,
    /// Name of the model, that of its material where there is one.
    pub model: &'static str,
    /// Names and values of the model's parameters.
    pub parameters: Vec<(&'static str, String)>,
    /// The model itself.
    pub kind: BsdfKind,
    /// True if nothing in it absorbs, so that a white furnace should stay white.
    pub is_lossless: bool,
    /// The laws that it breaks.
    pub breaks: &'static [Law],
}

impl Configuration {
    pub(super) fn new(name: &'static str, model: &'static str, kind: BsdfKind) -> Self {
        Self { name, model, parameters: Vec::new(), kind, is_lossless: false, breaks: &[] }
    }

    pub(super) fn with(mut self, name: &'static str, values: &[f32]) -> Self {
        let values: Vec<String> = values.iter().map(f32::to_string).collect();
        self.parameters.push((name, values.join(" ")));
        self
    }

    pub(super) fn lossless(self) -> Self {
        Self { is_lossless: true, ..self }
    }

    pub(super) fn breaking(self, breaks: &'static [Law]) -> Self {
        Self { breaks, ..self }
    }
}

/// All configurations: a new one is one line.
///
/// Rough conductors and dielectrics lack the light that bounces several times among their facets, so that those without
/// absorption break the law of the furnace.
#[must_use]
pub fn catalogue() -> Vec<Configuration> {
    let (smooth, rough) = (glass(0.0, 0.0, 1.5), glass(0.3, 0.3, 1.5));
    let mirror = Base::Conductor(copper(0.0, 0.0));
    let mut rows = vec![
        diffuse("diffuse", [0.1, 0.4, 0.6, 0.9]),
        diffuse("diffuse, white", [1.0; 4]).lossless(),
        sheet("sheet", [0.1, 0.2, 0.3, 0.4], [0.5, 0.4, 0.2, 0.1]),
        sheet("sheet, white", [0.3; 4], [0.7; 4]).lossless(),
        metal("copper mirror", copper(0.0, 0.0)),
        metal("copper, alpha 0.01", copper(0.01, 0.01)),
        metal("copper, alpha 0.05", copper(0.05, 0.05)),
        metal("copper, alpha 0.4", copper(0.4, 0.4)),
        metal("copper, alpha 1", copper(1.0, 1.0)),
        metal("copper, brushed", copper(0.1, 0.5)),
        metal("silver mirror", silver(0.0)).lossless(),
        metal("silver, alpha 0.5", silver(0.5)).lossless().breaking(&[Law::Furnace]),
        transparent("glass", smooth).lossless(),
        transparent("air in water", glass(0.0, 0.0, 1.0 / 1.33)).lossless(),
        transparent("no interface", glass(0.3, 0.3, 1.0)).lossless(),
        transparent("glass, alpha 0.1", glass(0.1, 0.1, 1.5)).lossless().breaking(&[Law::Furnace]),
        transparent("glass, alpha 0.5", glass(0.5, 0.5, 1.5)).lossless().breaking(&[Law::Furnace]),
        transparent("glass, brushed", glass(0.6, 0.2, 1.5)).lossless().breaking(&[Law::Furnace]),
        transparent("diamond, alpha 0.3", glass(0.3, 0.3, 2.4)).lossless().breaking(&[Law::Furnace]),
        transparent("rough air in water", glass(0.3, 0.3, 1.0 / 1.33)).lossless().breaking(&[Law::Furnace]),
        pane("pane", 1.5).lossless(),
        layered("plastic", coated(smooth, grey_base())),
        layered("rough plastic", coated(rough, grey_base())),
        layered("milky plastic", milky(coated(glass(0.2, 0.2, 1.5), grey_base()))),
        layered("mirror in lacquer", coated(smooth, mirror)),
        layered("rough lacquer", coated(rough, mirror)),
        layered("metal in lacquer", coated(smooth, Base::Conductor(copper(0.3, 0.3)))),
        layered("rough both", coated(glass(0.2, 0.1, 1.5), Base::Conductor(copper(0.2, 0.4)))),
        layered("milky lacquer", milky(coated(smooth, mirror))),
    ];
    rows.extend(classic::configurations());
    rows
}

fn diffuse(name: &'static str, reflectance: [f32; 4]) -> Configuration {
    let kind = BsdfKind::Diffuse(Diffuse { reflectance: Sampled::from_array(reflectance) });
    Configuration::new(name, "diffuse", kind).with("reflectance", &reflectance)
}

fn sheet(name: &'static str, reflectance: [f32; 4], transmittance: [f32; 4]) -> Configuration {
    let kind = BsdfKind::DiffuseTransmission(DiffuseTransmission {
        reflectance: Sampled::from_array(reflectance),
        transmittance: Sampled::from_array(transmittance),
    });
    Configuration::new(name, "diffusetransmission", kind)
        .with("reflectance", &reflectance)
        .with("transmittance", &transmittance)
}

fn metal(name: &'static str, conductor: Conductor) -> Configuration {
    Configuration::new(name, "conductor", BsdfKind::Conductor(conductor))
        .with("eta", &conductor.eta.to_array())
        .with("k", &conductor.k.to_array())
        .with_alpha("alpha", conductor.microfacets)
}

fn transparent(name: &'static str, dielectric: Dielectric) -> Configuration {
    Configuration::new(name, "dielectric", BsdfKind::Dielectric(dielectric))
        .with("eta", &[dielectric.eta])
        .with_alpha("alpha", dielectric.microfacets)
}

fn pane(name: &'static str, eta: f32) -> Configuration {
    let kind = BsdfKind::ThinDielectric(ThinDielectric { eta });
    Configuration::new(name, "thindielectric", kind).with("eta", &[eta])
}

fn layered(name: &'static str, layered: Layered) -> Configuration {
    let kind = BsdfKind::Layered(layered);
    let configuration = match layered.base {
        Base::Diffuse(base) => {
            Configuration::new(name, "coateddiffuse", kind).with("reflectance", &base.reflectance.to_array())
        }
        Base::Conductor(base) => Configuration::new(name, "coatedconductor", kind)
            .with("conductor.eta", &base.eta.to_array())
            .with("conductor.k", &base.k.to_array())
            .with_alpha("conductor.alpha", base.microfacets),
    };
    configuration
        .with("interface.eta", &[layered.coat.eta])
        .with_alpha("interface.alpha", layered.coat.microfacets)
        .with("thickness", &[layered.thickness])
        .with("albedo", &layered.albedo.to_array())
        .with("g", &[layered.g])
}

impl Configuration {
    fn with_alpha(self, name: &'static str, microfacets: Microfacets) -> Self {
        let (x, y) = microfacets.alpha();
        if x == y { self.with(name, &[x]) } else { self.with(name, &[x, y]) }
    }
}

pub(super) fn copper(alpha_x: f32, alpha_y: f32) -> Conductor {
    Conductor {
        microfacets: Microfacets::new(alpha_x, alpha_y),
        eta: Sampled::from_array([1.25, 1.1, 0.5, 0.25]),
        k: Sampled::from_array([2.2, 2.5, 2.7, 3.6]),
    }
}

/// A metal that reflects everything.
pub(super) fn silver(alpha: f32) -> Conductor {
    Conductor {
        microfacets: Microfacets::new(alpha, alpha),
        eta: Sampled::splat(1e-3),
        k: Sampled::splat(1e4),
    }
}

pub(super) fn glass(alpha_x: f32, alpha_y: f32, eta: f32) -> Dielectric {
    Dielectric { microfacets: Microfacets::new(alpha_x, alpha_y), eta }
}

pub(super) const fn coated(coat: Dielectric, base: Base) -> Layered {
    Layered { coat, base, thickness: 0.01, g: 0.0, albedo: Sampled::ZERO, max_depth: 10, n_samples: 1 }
}

/// Deep walks: where they are cut, samples and estimates of f stop at slightly different events.
const fn milky(layered: Layered) -> Layered {
    Layered { albedo: Sampled::splat(0.9), thickness: 0.5, g: 0.4, max_depth: 100, ..layered }
}

pub(super) const fn grey_base() -> Base {
    Base::Diffuse(Diffuse { reflectance: Sampled::from_array([0.2, 0.4, 0.6, 0.8]) })
}
