//! What the interfaces of a model reflect against the angle of incidence, exact and by Schlick's fit (SPEC EXP-22).

use etendue_scene::bsdf::classic::{FacetFresnel, VGroove};
use etendue_scene::bsdf::fresnel::{fresnel_conductor, fresnel_dielectric, fresnel_schlick};
use etendue_scene::bsdf::{Base, BsdfKind, Classic, Facetted};
use etendue_spectrum::Sampled;

use super::Curve;
use super::subject::LAMBDA_NM;

/// Reflectance of one interface of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct FresnelCurves {
    /// Where it is: `surface`, `coat` or `metal under the coat`.
    pub place: &'static str,
    /// True if there is a pair of curves for each wavelength; else a pair for each side, and the bare formula.
    pub is_metal: bool,
    /// Exact and fitted in turn.
    pub curves: Vec<Curve>,
}

enum Interface {
    /// Relative index.
    Dielectric(f32),
    /// Relative complex index.
    Conductor(Sampled, Sampled),
    /// A fit alone, from the reflectance along the normal.
    Fit(Sampled),
}

/// The interfaces of a model, from the outside inwards.
fn interfaces(kind: &BsdfKind) -> Vec<(&'static str, Interface)> {
    use Interface::{Conductor, Dielectric, Fit};
    let surface = |interface| vec![("surface", interface)];
    match kind {
        BsdfKind::Conductor(bsdf) => surface(Conductor(bsdf.eta, bsdf.k)),
        BsdfKind::Facetted(Facetted::Conductor(bsdf)) => surface(Conductor(bsdf.eta, bsdf.k)),
        BsdfKind::Facetted(Facetted::CompensatedConductor(bsdf)) => {
            let [eta, k] = bsdf.index();
            surface(Conductor(eta, k))
        }
        BsdfKind::Dielectric(bsdf) => surface(Dielectric(bsdf.eta)),
        BsdfKind::Facetted(Facetted::Dielectric(bsdf)) => surface(Dielectric(bsdf.eta)),
        BsdfKind::Facetted(Facetted::CompensatedDielectric(bsdf)) => surface(Dielectric(bsdf.eta())),
        BsdfKind::Facetted(Facetted::Principled(bsdf)) => surface(Fit(bsdf.f0())),
        BsdfKind::Facetted(Facetted::Extended(bsdf)) if bsdf.clearcoat() > 0.0 => {
            vec![("coat", Dielectric(1.5))]
        }
        BsdfKind::ThinDielectric(bsdf) => surface(Dielectric(bsdf.eta)),
        BsdfKind::Classic(Classic::VGroove(VGroove { fresnel, .. })) => surface(match *fresnel {
            FacetFresnel::Exact { eta, k } => Conductor(eta, k),
            FacetFresnel::Schlick(f0) => Fit(f0),
        }),
        BsdfKind::Classic(Classic::Schlick(bsdf)) => surface(Fit(bsdf.reflectance)),
        BsdfKind::Classic(Classic::AshikhminShirley(bsdf)) => vec![("coat", Fit(bsdf.ks))],
        BsdfKind::Classic(Classic::SmoothCoat(bsdf)) => vec![("coat", Dielectric(bsdf.eta()))],
        BsdfKind::Layered(bsdf) => match bsdf.base {
            Base::Diffuse(_) => vec![("coat", Dielectric(bsdf.coat.eta))],
            Base::Conductor(base) => vec![
                ("coat", Dielectric(bsdf.coat.eta)),
                ("metal under the coat", Conductor(base.eta, base.k)),
            ],
        },
        _ => Vec::new(),
    }
}

/// Fresnel reflectance against the angle of incidence for each interface, exact and by Schlick's fit in turn; empty for
/// models without one. Of a transparent one also from the inside, where the bare fit, with the cosine of the incident
/// light, fails. Where a model knows the fit alone, the exact curve is that of the glass that reflects as much along the
/// normal or, where it reflects more than a fifth or in colour, of the metal of real index 1.
#[must_use]
pub fn fresnel_curves(kind: &BsdfKind) -> Vec<FresnelCurves> {
    let curves_of = |(place, interface)| match interface {
        Interface::Dielectric(eta) => {
            FresnelCurves { place, is_metal: false, curves: dielectric_curves(eta) }
        }
        Interface::Conductor(eta, k) => FresnelCurves { place, is_metal: true, curves: metal_curves(eta, k) },
        Interface::Fit(f0) if f0 == Sampled::splat(f0[0]) && f0[0] < 0.2 => {
            let root = f0[0].max(0.0).sqrt();
            let curves = dielectric_curves((1.0 + root) / (1.0 - root));
            FresnelCurves { place, is_metal: false, curves }
        }
        Interface::Fit(f0) => {
            // F0 = k² / (4 + k²) where the real index is 1.
            let f0 = f0.clamp(0.0, 0.9999);
            let k = f0.sqrt() * 2.0 / (Sampled::ONE - f0).sqrt();
            FresnelCurves { place, is_metal: true, curves: metal_curves(Sampled::ONE, k) }
        }
    };
    interfaces(kind).into_iter().map(curves_of).collect()
}

fn dielectric_curves(eta: f32) -> Vec<Curve> {
    let f0 = ((eta - 1.0) / (eta + 1.0)).powi(2);
    vec![
        against_angle("exact, from outside", |cos| fresnel_dielectric(cos, eta)),
        against_angle("Schlick, from outside", |cos| fresnel_schlick(cos, eta)),
        against_angle("exact, from inside", |cos| fresnel_dielectric(-cos, eta)),
        against_angle("Schlick, from inside", |cos| fresnel_schlick(-cos, eta)),
        against_angle("Schlick's bare formula", |cos| bare_schlick(cos, f0)),
    ]
}

fn metal_curves(eta: Sampled, k: Sampled) -> Vec<Curve> {
    (0..4)
        .flat_map(|i| {
            let exact = move |cos| fresnel_conductor(cos, eta, k)[i];
            let name = format!("{} nm", LAMBDA_NM[i]);
            let fit = format!("Schlick, {name}");
            [against_angle(&name, exact), against_angle(&fit, move |cos| bare_schlick(cos, exact(1.0)))]
        })
        .collect()
}

/// `F0 + (1 - F0) (1 - cos)⁵` as printed, for any cosine.
fn bare_schlick(cos: f32, f0: f32) -> f32 {
    f0 + (1.0 - f0) * (1.0 - cos).powi(5)
}

fn against_angle(name: &str, f: impl Fn(f32) -> f32) -> Curve {
    let at = |i: i32| {
        let angle = f64::from(i) * 0.5;
        [angle, f64::from(f(angle.to_radians().cos() as f32))]
    };
    Curve { name: name.to_owned(), points: (0..=180).map(at).collect() }
}
