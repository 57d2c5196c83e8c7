//! Named configurations of all models, for tests and for `etendue brdf --all`.
//!
//! Each states the laws that it breaks by its nature; tests hold it to all others, and show that those stated are broken.

use std::sync::{Arc, LazyLock};

use etendue_math::Vector3;
use etendue_spectrum::{Sampled, Wavelengths};

use super::facetted::{
    AnyFacets, CompensatedConductor, CompensatedDielectric, FacetShape, Facetted, FresnelForm, Principled,
};
use super::hair::{Hair, HairRoughness};
use super::laws::Law;
use super::measured::{Measured, MeasuredBrdf, MeasuredGrid, MeasuredTable};
use super::microfacet::Microfacets;
use super::tabulated::{BrdfGrid, BrdfTable, TableSampling, Tabulated};
use super::{
    Base, BsdfKind, Conductor, Dielectric, Diffuse, DiffuseTransmission, Layered, Lobes, ThinDielectric,
    TransportMode, classic, facetted,
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

    /// With a parameter that is a word.
    pub(super) fn named(mut self, name: &'static str, word: &str) -> Self {
        self.parameters.push((name, word.to_owned()));
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
    rows.extend(facetted_rows());
    rows.extend(facetted::configurations());
    rows.extend(classic::configurations());
    rows.extend(tabulated_rows());
    rows.extend(hair_rows());
    rows.extend(measured_rows());
    rows
}

fn facetted_rows() -> Vec<Configuration> {
    use FacetShape::{Beckmann, Ggx};
    use FresnelForm::{Exact, Schlick};
    vec![
        other_metal("copper, Beckmann 0.1", copper(0.1, 0.1), Beckmann, Exact),
        other_metal("copper, Beckmann 0.6", copper(0.6, 0.6), Beckmann, Exact),
        other_metal("copper, Beckmann, brushed", copper(0.1, 0.5), Beckmann, Schlick),
        other_metal("copper, Schlick", copper(0.3, 0.3), Ggx, Schlick),
        all_bounces("silver, all bounces, alpha 0.1", silver(0.1), Ggx).lossless(),
        all_bounces("silver, all bounces, alpha 0.5", silver(0.5), Ggx).lossless(),
        all_bounces("silver, all bounces, alpha 1", silver(1.0), Ggx).lossless(),
        all_bounces("silver, all bounces, Beckmann 0.6", silver(0.6), Beckmann).lossless(),
        all_bounces("copper, all bounces, brushed", copper(0.2, 0.6), Ggx),
        all_bounces("copper mirror, all bounces", copper(0.0, 0.0), Ggx),
        principled("principled, plastic", [0.1, 0.2, 0.4, 0.5], 0.0, 0.3),
        principled("principled, metal", [0.9, 0.7, 0.4, 0.3], 1.0, 0.5),
        principled("principled, between", [0.9, 0.7, 0.4, 0.3], 0.4, 0.8),
        principled("principled, smooth", [0.5; 4], 0.0, 0.1),
        principled("principled, white", [1.0; 4], 0.0, 0.5).lossless(),
        principled("principled, white, rough", [1.0; 4], 0.5, 1.0).lossless(),
        other_glass("glass, Beckmann 0.2", glass(0.2, 0.2, 1.5), Beckmann, Exact),
        other_glass("glass, Beckmann, brushed", glass(0.6, 0.2, 1.5), Beckmann, Exact),
        other_glass("glass, Schlick", glass(0.3, 0.3, 1.5), Ggx, Schlick),
        other_glass("smooth glass, Schlick", glass(0.0, 0.0, 1.5), Ggx, Schlick).breaking(&[]),
        unlost("glass, all bounces, alpha 0.1", glass(0.1, 0.1, 1.5), Ggx),
        unlost("glass, all bounces, alpha 0.5", glass(0.5, 0.5, 1.5), Ggx),
        unlost("glass, all bounces, alpha 1", glass(1.0, 1.0, 1.5), Ggx),
        unlost("diamond, all bounces, alpha 0.3", glass(0.3, 0.3, 2.4), Ggx),
        unlost("air in water, all bounces, alpha 0.3", glass(0.3, 0.3, 1.0 / 1.33), Ggx),
        unlost("glass, all bounces, Beckmann 0.4", glass(0.4, 0.4, 1.5), Beckmann),
        unlost("glass, all bounces, brushed", glass(0.6, 0.2, 1.5), Ggx).breaking(&[Law::Furnace]),
        unlost("smooth glass, all bounces", glass(0.0, 0.0, 1.5), Ggx),
    ]
}

/// Measurements of other models. Their interpolation does not know that light may take every way backwards.
fn measured_rows() -> Vec<Configuration> {
    static BRDFS: LazyLock<[Arc<MeasuredBrdf>; 2]> = LazyLock::new(|| {
        [(copper(0.3, 0.3), 1), (copper(0.3, 0.5), 9)].map(|(metal, n)| Arc::new(measurement(metal, n)))
    });
    let row = |name, brdf| {
        let model = Measured { table: MeasuredTable::of(brdf), lambda: Wavelengths::sample_visible(0.3) };
        Configuration::new(name, "measured", BsdfKind::Measured(model)).breaking(&[Law::Reciprocity])
    };
    vec![row("measured copper", &BRDFS[0]), row("measured copper, brushed", &BRDFS[1])]
}

/// A measurement of metal, redder than it is.
fn measurement(metal: Conductor, n_phi: usize) -> MeasuredBrdf {
    let wavelengths = vec![400.0, 700.0];
    let grid = MeasuredGrid { n_phi, n_theta: 12, n_facets: [24, 24], n_spectra: 20, wavelengths };
    let f = |wo, wi, nm: f32| BsdfKind::Conductor(metal).radiance(wo, wi) * nm / 700.0;
    MeasuredBrdf::of_model(&grid, |m| metal.microfacets.d(m), f)
        .expect("the models of the catalogue are sound")
}

/// Fibres, whose offset belongs to the direction in which they are seen.
fn hair_rows() -> Vec<Configuration> {
    const BROWN: [f32; 4] = [1.78, 0.91, 0.62, 0.5];
    let rows = [
        hair("hair, brown", 0.4, [0.3, 0.3, 2.0], BROWN),
        hair("hair, sleek", -0.7, [0.15, 0.2, 3.0], BROWN),
        hair("hair, white", 0.3, [0.3, 0.3, 2.0], [0.0; 4]).lossless(),
        hair("hair, white, rough, at its edge", 1.0, [1.0, 1.0, 10.0], [0.0; 4]).lossless(),
    ];
    rows.map(|row| row.breaking(&[Law::Reciprocity])).into()
}

fn hair(name: &'static str, h: f32, [beta_m, beta_n, alpha]: [f32; 3], sigma_a: [f32; 4]) -> Configuration {
    let roughness = HairRoughness { beta_m, beta_n, alpha_rad: alpha.to_radians() };
    let fibre = Hair::new(h, roughness, 1.55, Sampled::from_array(sigma_a));
    Configuration::new(name, "hair", BsdfKind::Hair(fibre))
        .with("h", &[h])
        .with("beta_m", &[beta_m])
        .with("beta_n", &[beta_n])
        .with("alpha", &[alpha])
        .with("sigma_a", &sigma_a)
        .with("eta", &[1.55])
}

/// Tables of other models, and of one that throws light back to where it came from.
fn tabulated_rows() -> Vec<Configuration> {
    static GRIDS: LazyLock<[BrdfGrid; 4]> = LazyLock::new(|| {
        let highlight = classic::Phong {
            kd: Sampled::splat(0.3),
            ks: Sampled::splat(0.5),
            exponent: 30.0,
            form: classic::PhongForm::Lewis,
        };
        [
            table_of([2, 2, 1], [1.0; 3], |_, _| std::f32::consts::FRAC_1_PI),
            table_of([32, 32, 16], [1.0, 0.8, 0.4], |wo, wi| {
                BsdfKind::Classic(classic::Classic::Phong(highlight)).radiance(wo, wi)
            }),
            table_of([32, 64, 8], [0.9, 0.8, 0.6], |wo, wi| {
                BsdfKind::Conductor(copper(0.5, 0.5)).radiance(wo, wi)
            }),
            table_of([16, 32, 8], [0.2, 0.4, 0.6], |wo, wi| 0.02 + wo.dot(wi).max(0.0).powi(16)),
        ]
    });
    let [matte, highlight, metal, reflector] = &*GRIDS;
    vec![
        tabulated("table of white", matte).lossless(),
        tabulated("table of Lewis's Phong", highlight),
        tabulated("table of copper", metal),
        tabulated("table of a reflector", reflector),
        rejected("table of a reflector, by rejection", reflector),
    ]
}

impl BsdfKind {
    /// f of all lobes at the third wavelength.
    fn radiance(&self, wo: Vector3, wi: Vector3) -> f32 {
        self.eval(wo, wi, TransportMode::Radiance, Lobes::ALL)[2]
    }
}

fn table_of(resolution: [usize; 3], color: [f32; 3], f: impl Fn(Vector3, Vector3) -> f32) -> BrdfGrid {
    let values = |wo, wi| color.map(|c| c * f(wo, wi));
    BrdfGrid::tabulate(resolution, values).expect("the models of the catalogue have sound values")
}

fn tabulated(name: &'static str, grid: &BrdfGrid) -> Configuration {
    let lambda = Wavelengths::sample_visible(0.3);
    let model = Tabulated { table: BrdfTable::of(grid), lambda, sampling: TableSampling::Cells };
    Configuration::new(name, "tabulated", BsdfKind::Tabulated(model))
}

fn rejected(name: &'static str, grid: &BrdfGrid) -> Configuration {
    let lambda = Wavelengths::sample_visible(0.3);
    let model = Tabulated { table: BrdfTable::of(grid), lambda, sampling: TableSampling::Rejection };
    Configuration::new(name, "tabulated", BsdfKind::Tabulated(model)).named("sampling", "rejection")
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

impl FacetShape {
    const fn name(self) -> &'static str {
        match self {
            Self::Ggx => "ggx",
            Self::Beckmann => "beckmann",
        }
    }
}

impl FresnelForm {
    const fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Schlick => "schlick",
        }
    }
}

fn other_facets(alphas: Microfacets, shape: FacetShape, fresnel: FresnelForm) -> AnyFacets {
    AnyFacets { alphas, shape, fresnel }
}

/// Metal with facets of some shape.
fn facetted_metal(metal: Conductor, shape: FacetShape, fresnel: FresnelForm) -> Conductor<AnyFacets> {
    let microfacets = other_facets(metal.microfacets, shape, fresnel);
    Conductor { microfacets, eta: metal.eta, k: metal.k }
}

fn other_metal(
    name: &'static str,
    plain: Conductor,
    shape: FacetShape,
    fresnel: FresnelForm,
) -> Configuration {
    let kind = BsdfKind::Facetted(Facetted::Conductor(facetted_metal(plain, shape, fresnel)));
    Configuration { kind, ..metal(name, plain) }
        .named("distribution", shape.name())
        .named("fresnel", fresnel.name())
}

fn all_bounces(name: &'static str, plain: Conductor, shape: FacetShape) -> Configuration {
    let once = facetted_metal(plain, shape, FresnelForm::Exact);
    let kind = BsdfKind::Facetted(Facetted::CompensatedConductor(CompensatedConductor::new(once)));
    Configuration { kind, ..metal(name, plain) }
        .named("distribution", shape.name())
        .named("multiplescattering", "true")
}

fn principled(name: &'static str, base: [f32; 4], metallic: f32, roughness: f32) -> Configuration {
    let model = Principled::new(Sampled::from_array(base), metallic, roughness, 1.5);
    Configuration::new(name, "principled", BsdfKind::Facetted(Facetted::Principled(model)))
        .with("basecolor", &base)
        .with("metallic", &[metallic])
        .with("roughness", &[roughness])
        .with("ior", &[1.5])
}

fn other_glass(
    name: &'static str,
    plain: Dielectric,
    shape: FacetShape,
    fresnel: FresnelForm,
) -> Configuration {
    let microfacets = other_facets(plain.microfacets, shape, fresnel);
    let kind = BsdfKind::Facetted(Facetted::Dielectric(Dielectric { microfacets, eta: plain.eta }));
    Configuration { kind, ..transparent(name, plain) }
        .named("distribution", shape.name())
        .named("fresnel", fresnel.name())
        .lossless()
        .breaking(&[Law::Furnace])
}

/// Glass with all bounces.
fn unlost(name: &'static str, plain: Dielectric, shape: FacetShape) -> Configuration {
    let microfacets = other_facets(plain.microfacets, shape, FresnelForm::Exact);
    let model = CompensatedDielectric::new(Dielectric { microfacets, eta: plain.eta });
    let kind = BsdfKind::Facetted(Facetted::CompensatedDielectric(model));
    Configuration { kind, ..transparent(name, plain) }
        .named("distribution", shape.name())
        .named("multiplescattering", "true")
        .lossless()
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
