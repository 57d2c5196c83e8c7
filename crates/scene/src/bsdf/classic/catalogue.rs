//! Configurations of these models; see [`crate::bsdf::catalogue`].

use etendue_spectrum::Sampled;

use super::*;
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
        v_groove("Torrance-Sparrow, 0.02", COPPER, 0.02, FacetDistribution::Gaussian),
        v_groove("Torrance-Sparrow, 0.1", COPPER, 0.1, FacetDistribution::Gaussian),
        v_groove("Torrance-Sparrow, 0.5", COPPER, 0.5, FacetDistribution::Gaussian),
        v_groove("Cook-Torrance, 0.005", COPPER, 0.005, FacetDistribution::Beckmann),
        v_groove("Cook-Torrance, 0.05", COPPER, 0.05, FacetDistribution::Beckmann),
        v_groove("Cook-Torrance, 0.3", COPPER, 0.3, FacetDistribution::Beckmann),
        v_groove("Cook-Torrance, Schlick", FacetFresnel::Schlick(KS), 0.3, FacetDistribution::Beckmann),
        v_groove(
            "Cook-Torrance, white",
            FacetFresnel::Schlick(Sampled::ONE),
            1.0,
            FacetDistribution::Beckmann,
        ),
        cylinders("cylinders that touch", 50.0, 2.0, 1.0),
        cylinders("cylinders apart", 400.0, 4.0, 0.6),
        cylinders("cylinders that overlap", 10.0, 1.0, 0.5),
        cylinders("no cylinders", 30.0, 2.0, 0.0),
        ward("Ward 1992", 0.2, 0.2, WardForm::Original),
        ward("Ward 1992, brushed", 0.1, 0.6, WardForm::Original),
        ward("Ward 2010", 0.2, 0.2, WardForm::Bounded),
        ward("Ward 2010, brushed", 0.02, 0.6, WardForm::Bounded),
        schlick("Schlick 1993, mirror", 0.0, 1.0, SchlickForm::Conserving),
        schlick("Schlick 1993, satin", 0.05, 1.0, SchlickForm::Conserving),
        schlick("Schlick 1993, scratched", 0.3, 0.2, SchlickForm::Conserving),
        schlick("Schlick 1993, dull", 0.8, 1.0, SchlickForm::Conserving),
        schlick("Schlick 1993, matte", 1.0, 1.0, SchlickForm::Conserving),
        schlick("Schlick 1993 as printed", 0.5, 1.0, SchlickForm::Printed).breaking(&[Energy]),
        oren_nayar("Oren-Nayar, smooth", KD, 0.0, OrenNayarForm::Full),
        oren_nayar("Oren-Nayar", KD, 0.35, OrenNayarForm::Full),
        oren_nayar("Oren-Nayar, dark", KD * 0.1, 1.5, OrenNayarForm::Full),
        oren_nayar("Oren-Nayar, qualitative", KD, 0.35, OrenNayarForm::Qualitative),
        oren_nayar("Oren-Nayar, white", Sampled::ONE, 0.2, OrenNayarForm::Full).breaking(&[Energy]),
        oren_nayar("Oren-Nayar, white, qualitative", Sampled::ONE, 0.2, OrenNayarForm::Qualitative)
            .breaking(&[Energy]),
        lafortune("Lafortune, Phong's lobe", [[-1.0, -1.0, 1.0, 20.0], NONE, NONE]),
        lafortune(
            "Lafortune, three lobes",
            [[-0.95, -0.9, 0.8, 30.0], [0.7, 0.7, 0.7, 3.0], [-1.0, -1.0, 1.0075, 400.0]],
        ),
        ashikhmin_shirley("Ashikhmin-Shirley", 100.0, 100.0),
        ashikhmin_shirley("Ashikhmin-Shirley, brushed", 10.0, 1000.0),
        ashikhmin_shirley("Ashikhmin-Shirley, broad", 0.0, 0.0),
        smooth_coat("smooth coat", KD, 1.5),
        smooth_coat("smooth coat, white", Sampled::ONE, 1.5).lossless(),
        smooth_coat("no coat, white", Sampled::ONE, 1.0).lossless(),
    ]
}

const NONE: [f32; 4] = [0.0; 4];

const COPPER: FacetFresnel = FacetFresnel::Exact {
    eta: Sampled::from_array([1.25, 1.1, 0.5, 0.25]),
    k: Sampled::from_array([2.2, 2.5, 2.7, 3.6]),
};

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

fn v_groove(
    name: &'static str,
    fresnel: FacetFresnel,
    m: f32,
    distribution: FacetDistribution,
) -> Configuration {
    let model = match distribution {
        FacetDistribution::Gaussian => "torrancesparrow",
        FacetDistribution::Beckmann => "cooktorrance",
    };
    let groove = VGroove { kd: Sampled::ZERO, fresnel, strength: 1.0, m, distribution };
    let configuration = Configuration::new(name, model, BsdfKind::Classic(Classic::VGroove(groove)));
    match fresnel {
        FacetFresnel::Exact { eta, k } => {
            configuration.with("eta", &eta.to_array()).with("k", &k.to_array()).named("fresnel", "exact")
        }
        FacetFresnel::Schlick(f0) => {
            configuration.with("reflectance", &f0.to_array()).named("fresnel", "schlick")
        }
    }
    .with("roughness", &[m])
}

fn cylinders(name: &'static str, exponent: f32, spacing: f32, height: f32) -> Configuration {
    let model = PoulinFournier { kd: KD, ks: KS, exponent, spacing, height };
    colored(name, "poulinfournier", Classic::PoulinFournier(model))
        .with("exponent", &[exponent])
        .with("spacing", &[spacing])
        .with("height", &[height])
}

fn ward(name: &'static str, alpha_x: f32, alpha_y: f32, form: WardForm) -> Configuration {
    let form_name = match form {
        WardForm::Original => "original",
        WardForm::Bounded => "bounded",
    };
    colored(name, "ward", Classic::Ward(Ward { kd: KD, ks: KS, alpha_x, alpha_y, form }))
        .with("roughness", &[alpha_x, alpha_y])
        .named("form", form_name)
}

fn schlick(name: &'static str, roughness: f32, isotropy: f32, form: SchlickForm) -> Configuration {
    let form_name = match form {
        SchlickForm::Conserving => "conserving",
        SchlickForm::Printed => "printed",
    };
    let model = Schlick { reflectance: KS, roughness, isotropy, form };
    Configuration::new(name, "schlick", BsdfKind::Classic(Classic::Schlick(model)))
        .with("reflectance", &KS.to_array())
        .with("roughness", &[roughness])
        .with("isotropy", &[isotropy])
        .named("form", form_name)
}

fn oren_nayar(
    name: &'static str,
    reflectance: Sampled,
    sigma_rad: f32,
    form: OrenNayarForm,
) -> Configuration {
    let form_name = match form {
        OrenNayarForm::Full => "full",
        OrenNayarForm::Qualitative => "qualitative",
    };
    let model = OrenNayar { reflectance, sigma_rad, form };
    Configuration::new(name, "orennayar", BsdfKind::Classic(Classic::OrenNayar(model)))
        .with("reflectance", &reflectance.to_array())
        .with("sigma", &[sigma_rad.to_degrees()])
        .named("form", form_name)
}

fn lafortune(name: &'static str, lobes: [[f32; 4]; 3]) -> Configuration {
    let model = Lafortune {
        kd: KD,
        ks: KS,
        lobes: lobes.map(|[cx, cy, cz, exponent]| LafortuneLobe { cx, cy, cz, exponent }),
    };
    colored(name, "lafortune", Classic::Lafortune(model)).with("lobes", lobes.as_flattened())
}

fn ashikhmin_shirley(name: &'static str, exponent_u: f32, exponent_v: f32) -> Configuration {
    let model = AshikhminShirley { kd: KD, ks: KS, exponent_u, exponent_v };
    colored(name, "ashikhminshirley", Classic::AshikhminShirley(model))
        .with("uexponent", &[exponent_u])
        .with("vexponent", &[exponent_v])
}

fn smooth_coat(name: &'static str, reflectance: Sampled, eta: f32) -> Configuration {
    let kind = BsdfKind::Classic(Classic::SmoothCoat(SmoothCoat::new(reflectance, eta)));
    Configuration::new(name, "smoothcoat", kind)
        .with("reflectance", &reflectance.to_array())
        .with("eta", &[eta])
}
