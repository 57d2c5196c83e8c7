//! Materials from parameters to scattering: defaults, meanings and reports.

mod principled;

use std::collections::HashMap;
use std::sync::Arc;

use etendue_image::Texels;
use etendue_math::{Normal3, Point2, Point3, Rng, Transform, Vector3};
use etendue_spectrum::{Sampled, Spectrum, Wavelengths};

use super::*;
use crate::assets::Assets;
use crate::bsdf::fresnel::fresnel_conductor;
use crate::bsdf::measured::{MeasuredBrdf, MeasuredGrid};
use crate::bsdf::tabulated::BrdfGrid;
use crate::bsdf::{Base, BsdfKind, Classic, Lobes, TransportMode, classic};
use crate::diagnostics::{Diagnostics, Severity};
use crate::document::{Entity, Value};
use crate::parameters::{BuildContext, Parameters, SpectrumRole};
use crate::texture::{Bilerp, FloatTexture, FloatTextureNode, Mapping2, TextureContext};

/// What a build needs and makes.
#[derive(Default)]
struct Fixture {
    assets: Assets,
    textures: Textures,
    materials: Materials,
    named: HashMap<String, MaterialId>,
    float_textures: HashMap<String, FloatTexture>,
}

impl Fixture {
    fn build(&mut self, entity: &Entity) -> (Option<MaterialId>, Diagnostics) {
        let mut context = BuildContext::new(&self.assets);
        context.spectra = self.textures.spectra.clone();
        context.float_textures = self.float_textures.clone();
        let material = self.materials.build(Parameters::new(entity, &mut context), &self.named);
        self.textures.spectra = context.spectra;
        (material, context.diagnostics)
    }

    #[track_caller]
    fn build_clean(&mut self, entity: &Entity) -> MaterialId {
        let (material, diagnostics) = self.build(entity);
        assert!(diagnostics.list().is_empty(), "{:?}", diagnostics.list());
        material.expect("no problem was reported")
    }

    #[track_caller]
    fn kind(&mut self, entity: &Entity) -> BsdfKind {
        let material = self.build_clean(entity);
        let mut lambda = Wavelengths::sample_visible(0.3);
        *self.bsdf(material, &context(), &mut lambda).expect("a material that scatters").kind()
    }

    fn bsdf(&self, material: MaterialId, ctx: &MaterialContext, lambda: &mut Wavelengths) -> Option<Bsdf> {
        self.materials.bsdf(material, &self.textures, ctx, lambda)
    }

    /// Gives a name to the default material.
    fn name_default(&mut self, name: &str) {
        let id = self.materials.add(Material::default());
        self.named.insert(name.to_owned(), id);
    }

    /// A height that grows by `slope` per unit of u.
    fn ramp(&mut self, slope: f32) -> FloatTexture {
        let mapping = Mapping2::Uv { su: 1.0, sv: 1.0, du: 0.0, dv: 0.0 };
        self.textures
            .add_float(FloatTextureNode::Bilerp(Bilerp { mapping, corners: [0.0, 0.0, slope, slope] }))
    }
}

/// A point on the plane z = 0, where a unit of u is 2 m along x and a unit of v 3 m along y.
fn context() -> MaterialContext {
    let n = Normal3::new(0.0, 0.0, 1.0);
    MaterialContext {
        texture: TextureContext {
            p: Point3::new(0.3, 0.2, 0.0),
            n,
            uv: Point2::new(0.4, 0.6),
            ..TextureContext::default()
        },
        wo: Vector3::new(0.0, 0.6, 0.8),
        ng: n,
        ns: n,
        dpdv: Vector3::new(0.0, 3.0, 0.0),
        shading_dpdu: Vector3::new(2.0, 0.0, 0.0),
        shading_dpdv: Vector3::new(0.0, 3.0, 0.0),
        dndu: Vector3::splat(0.0),
        dndv: Vector3::splat(0.0),
    }
}

fn floats(value: f32) -> Value {
    Value::Floats(vec![value])
}

fn strings(value: &str) -> Value {
    Value::Strings(vec![value.to_owned()])
}

fn named_spectrum(name: &str) -> Value {
    Value::SpectrumNames(vec![name.to_owned()])
}

fn plain(name: &str) -> Entity {
    Entity::new(name)
}

/// A material without parameters is what pbrt-v4 makes of it.
#[test]
fn defaults() {
    let mut fixture = Fixture::default();
    let BsdfKind::Diffuse(diffuse) = fixture.kind(&plain("diffuse")) else { panic!("not diffuse") };
    assert_eq!(diffuse.reflectance, Sampled::splat(0.5));

    let BsdfKind::DiffuseTransmission(sheet) = fixture.kind(&plain("diffusetransmission")) else {
        panic!("not a sheet")
    };
    assert_eq!((sheet.reflectance, sheet.transmittance), (Sampled::splat(0.25), Sampled::splat(0.25)));

    let BsdfKind::Dielectric(glass) = fixture.kind(&plain("dielectric")) else { panic!("not glass") };
    assert!(glass.eta == 1.5 && glass.microfacets.is_smooth());

    let BsdfKind::ThinDielectric(pane) = fixture.kind(&plain("thindielectric")) else { panic!("not a pane") };
    assert_eq!(pane.eta, 1.5);

    let BsdfKind::Conductor(copper) = fixture.kind(&plain("conductor")) else { panic!("not metal") };
    assert!(copper.microfacets.is_smooth() && copper.k.min_value() > 1.5, "{copper:?}");

    let BsdfKind::Layered(plastic) = fixture.kind(&plain("coateddiffuse")) else { panic!("not coated") };
    assert!(plastic.coat.eta == 1.5 && plastic.coat.microfacets.is_smooth());
    assert_eq!((plastic.thickness, plastic.g, plastic.albedo), (0.01, 0.0, Sampled::ZERO));
    assert_eq!((plastic.max_depth, plastic.n_samples), (10, 1));

    // The coat is what the metal sees: its indices are divided by that of the coat.
    let BsdfKind::Layered(lacquer) = fixture.kind(&plain("coatedconductor")) else { panic!("not coated") };
    let Base::Conductor(base) = lacquer.base else { panic!("not metal") };
    assert!((base.eta[0] * 1.5 - copper.eta[0]).abs() < 1e-5 && (base.k[0] * 1.5 - copper.k[0]).abs() < 1e-5);

    let interface = fixture.build_clean(&plain("interface"));
    let mut lambda = Wavelengths::sample_visible(0.3);
    assert!(fixture.materials.is_interface(interface));
    assert!(fixture.bsdf(interface, &context(), &mut lambda).is_none());
    let diffuse = fixture.build_clean(&plain("diffuse"));
    assert_eq!(*fixture.materials.get(diffuse), Material::default());
}

/// Every parameter in the documentation is one that the builder knows, and no other is.
#[test]
fn documented_parameters_are_the_known_ones() {
    for spec in MATERIALS {
        let mut fixture = Fixture::default();
        fixture.name_default("a");
        let grid = BrdfGrid::tabulate([2, 2, 1], |_, _| [0.1; 3]).unwrap();
        fixture.assets.brdfs.insert("a".to_owned(), grid);
        fixture.assets.measured.insert("a".to_owned(), even_measurement());
        let mut entity = plain(spec.name);
        for parameter in spec.parameters {
            let value = match parameter.kind {
                "string" if parameter.name == "materials" => Value::Strings(vec!["a".to_owned(); 2]),
                "string" if parameter.name == "filename" => Value::Strings(vec!["a".to_owned()]),
                "string" => continue,
                "bool" => Value::Bools(vec![true]),
                "integer" => Value::Integers(vec![3]),
                "float[]" => Value::Floats(vec![-1.0, -1.0, 1.0, 20.0]),
                _ if parameter.name == "strength" => floats(0.5),
                _ if matches!(
                    (spec.name, parameter.name),
                    ("smoothcoat" | "hair", "eta") | (_, "ior" | "iridescenceior")
                ) =>
                {
                    floats(1.4)
                }
                // In place of others that are given.
                "spectrum texture" if parameter.default.is_empty() => continue,
                _ => floats(0.3),
            };
            entity = entity.with(parameter.name, value);
        }
        fixture.build_clean(&entity);
        for name in ["unheardof", "etaa", "nosuchroughness"] {
            let (_, diagnostics) = fixture.build(&entity.clone().with(name, floats(1.0)));
            assert_eq!(diagnostics.list().len(), 1, "{}: {name}: {:?}", spec.name, diagnostics.list());
        }
        for parameter in spec.parameters {
            assert!(!parameter.doc.is_empty() && parameter.doc.ends_with('.'), "{}", parameter.name);
        }
    }
}

/// Roughness is the square of alpha, or alpha itself, along each tangent.
#[test]
fn roughness_becomes_alpha() {
    let mut fixture = Fixture::default();
    let mut alpha = |entity: Entity| match fixture.kind(&entity) {
        BsdfKind::Conductor(metal) => metal.microfacets.alpha(),
        other => panic!("{other:?}"),
    };
    assert_eq!(alpha(plain("conductor").with("roughness", floats(0.25))), (0.5, 0.5));
    let linear = plain("conductor").with("remaproughness", Value::Bools(vec![false]));
    assert_eq!(alpha(linear.clone().with("roughness", floats(0.25))), (0.25, 0.25));
    let brushed = linear.with("roughness", floats(0.25)).with("vroughness", floats(0.125));
    assert_eq!(alpha(brushed), (0.25, 0.125));
}

/// A metal given by its colour reflects that colour along the normal.
#[test]
fn metals_by_reflectance() {
    let mut fixture = Fixture::default();
    for r in [0.0, 0.04, 0.5, 0.9, 0.99] {
        let entity = plain("conductor").with("reflectance", named_spectrum("r"));
        fixture.assets.spectra.insert("r".to_owned(), vec![[300.0, r], [900.0, r]]);
        let BsdfKind::Conductor(metal) = fixture.kind(&entity) else { panic!("not metal") };
        let reflected = fresnel_conductor(1.0, metal.eta, metal.k)[1];
        assert!((reflected - r).abs() < 1e-4, "{reflected} is not {r}");
    }
    let both = plain("conductor").with("reflectance", floats(0.5)).with("k", floats(2.0));
    let (_, diagnostics) = fixture.build(&both);
    assert!(diagnostics.has_errors());
}

/// SPEC FRES-10: glass whose index falls with the wavelength turns violet light more than red light, and then a
/// path follows one wavelength; glass with one index keeps them all.
#[test]
fn dispersion_gives_up_wavelengths() {
    let mut fixture = Fixture::default();
    let crown = |nm: f32| 1.5 + 0.0042 / (nm * 1e-3).powi(2); // Cauchy's formula, nm to µm.
    let samples: Vec<[f32; 2]> = (36..=83).map(|i| [i as f32 * 10.0, crown(i as f32 * 10.0)]).collect();
    let prism = fixture.build_clean(&plain("dielectric").with("eta", Value::SpectrumSamples(samples)));
    let mut deviations = Vec::new();
    for u in [0.02, 0.5, 0.98] {
        let mut lambda = Wavelengths::sample_visible(u);
        let hero = lambda.lambda_nm()[0];
        let bsdf = fixture.bsdf(prism, &context(), &mut lambda).unwrap();
        assert!(lambda.secondary_terminated());
        let BsdfKind::Dielectric(glass) = bsdf.kind() else { panic!("not glass") };
        assert!((glass.eta - crown(hero)).abs() < 2e-3, "{} at {hero}", glass.eta);
        let wo = context().wo;
        let sample =
            bsdf.sample(wo, 0.5, Point2::new(0.5, 0.5), TransportMode::Radiance, Lobes::TRANSMIT).unwrap();
        deviations.push((hero, (-wo).angle_between(sample.wi)));
    }
    deviations.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert!(deviations[0].1 > deviations[1].1 && deviations[1].1 > deviations[2].1, "{deviations:?}");

    let plain_glass = fixture.build_clean(&plain("dielectric").with("eta", floats(1.7)));
    let mut lambda = Wavelengths::sample_visible(0.5);
    let _ = fixture.bsdf(plain_glass, &context(), &mut lambda);
    assert!(!lambda.secondary_terminated());
}

/// Glass with a name has its measured index.
#[test]
fn named_glass() {
    let mut fixture = Fixture::default();
    let BsdfKind::Dielectric(glass) =
        fixture.kind(&plain("dielectric").with("eta", named_spectrum("glass-BK7")))
    else {
        panic!("not glass")
    };
    assert!((1.50..1.54).contains(&glass.eta), "{}", glass.eta);
}

/// Albedos above 1 would make light; they are clamped, and so are scaled ones.
#[test]
fn albedos_are_clamped() {
    let mut fixture = Fixture::default();
    let sheet = plain("diffusetransmission").with("reflectance", floats(0.4)).with("scale", floats(3.0));
    let BsdfKind::DiffuseTransmission(sheet) = fixture.kind(&sheet) else { panic!("not a sheet") };
    assert_eq!((sheet.reflectance, sheet.transmittance), (Sampled::ONE, Sampled::splat(0.75)));
}

/// The models of the literature have safe defaults.
#[test]
fn classic_defaults() {
    let mut fixture = Fixture::default();
    let mut classic = |name| match fixture.kind(&plain(name)) {
        BsdfKind::Classic(classic) => classic,
        other => panic!("{other:?}"),
    };
    let (kd, ks) = (Sampled::splat(0.5), Sampled::splat(0.2));
    assert_eq!(
        classic("phong"),
        Classic::Phong(classic::Phong { kd, ks, exponent: 30.0, form: classic::PhongForm::Lewis })
    );
    assert_eq!(classic("blinnphong"), Classic::BlinnPhong(classic::BlinnPhong { kd, ks, exponent: 30.0 }));
    for (name, distribution) in [
        ("torrancesparrow", classic::FacetDistribution::Gaussian),
        ("cooktorrance", classic::FacetDistribution::Beckmann),
    ] {
        let Classic::VGroove(groove) = classic(name) else { panic!("{name}") };
        assert!(matches!(groove.fresnel, classic::FacetFresnel::Exact { .. }));
        assert_eq!((groove.kd, groove.strength, groove.m), (Sampled::ZERO, 1.0, 0.2));
        assert_eq!(groove.distribution, distribution);
    }
    let cylinders = classic::PoulinFournier { kd, ks, exponent: 100.0, spacing: 2.0, height: 1.0 };
    assert_eq!(classic("poulinfournier"), Classic::PoulinFournier(cylinders));
    let form = classic::WardForm::Bounded;
    assert_eq!(classic("ward"), Classic::Ward(classic::Ward { kd, ks, alpha_x: 0.15, alpha_y: 0.15, form }));
    let form = classic::SchlickForm::Conserving;
    let schlick = classic::Schlick { reflectance: kd, roughness: 0.5, isotropy: 1.0, form };
    assert_eq!(classic("schlick"), Classic::Schlick(schlick));
    let form = classic::OrenNayarForm::Full;
    let clay = classic::OrenNayar { reflectance: kd, sigma_rad: 20.0_f32.to_radians(), form };
    assert_eq!(classic("orennayar"), Classic::OrenNayar(clay));
    let Classic::Lafortune(lafortune) = classic("lafortune") else { panic!("not Lafortune's") };
    assert_eq!(lafortune.lobes[0].exponent, 20.0);
    assert_eq!(lafortune.lobes[1], classic::LafortuneLobe::default());
    let Classic::AshikhminShirley(coat) = classic("ashikhminshirley") else { panic!("no coat") };
    assert_eq!((coat.exponent_u, coat.exponent_v, coat.ks), (100.0, 100.0, Sampled::splat(0.05)));
}

/// Numbers outside their range are reported, with what is taken in their place.
#[test]
fn bad_parameters_are_reported() {
    let mut fixture = Fixture::default();
    let mut complaint = |entity: Entity| {
        let (material, diagnostics) = fixture.build(&entity);
        let [problem] = diagnostics.list() else { panic!("{:?}", diagnostics.list()) };
        assert!(material.is_some());
        (problem.severity, problem.message.clone())
    };
    let (severity, message) = complaint(plain("phong").with("exponent", floats(-2.0)));
    assert!(severity == Severity::Warning && message.contains("is taken as 0"), "{message}");
    let (severity, message) = complaint(plain("blinnphong").with("kd", floats(0.9)).with("ks", floats(0.3)));
    assert!(severity == Severity::Warning && message.contains("sum to 1.2"), "{message}");
    let (severity, message) = complaint(plain("phong").with("kd", floats(1.5)).with("ks", floats(0.0)));
    assert!(severity == Severity::Warning && message.contains("clamped to 1"), "{message}");
    let (severity, message) = complaint(plain("phong").with("ks", floats(-0.5)));
    assert!(severity == Severity::Error && message.contains("negative"), "{message}");
    let BsdfKind::Classic(Classic::Phong(phong)) =
        kind_despite_warnings(&mut fixture, &plain("phong").with("kd", floats(0.9)).with("ks", floats(0.3)))
    else {
        panic!("not Phong")
    };
    assert!((phong.kd[0] - 0.75).abs() < 1e-6 && (phong.ks[0] - 0.25).abs() < 1e-6);
}

/// Tables need a file, and say if they make light.
#[test]
fn tables_are_examined() {
    let mut fixture = Fixture::default();
    let bright = BrdfGrid::tabulate([2, 2, 1], |_, _| [0.1, 0.5, 0.2]).unwrap();
    fixture.assets.brdfs.insert("bright".to_owned(), bright);
    fixture.assets.failed.insert("bad".to_owned());
    let mut complaints = |file: Option<&str>| {
        let name = |file: &str| Value::Strings(vec![file.to_owned()]);
        let entity = file.map_or(plain("tabulated"), |file| plain("tabulated").with("filename", name(file)));
        let (_, diagnostics) = fixture.build(&entity);
        diagnostics
            .list()
            .iter()
            .map(|problem| (problem.severity, problem.message.clone()))
            .collect::<Vec<_>>()
    };
    let warning = "the table \"bright\" reflects 1.57 times what arrives".to_owned();
    assert_eq!(complaints(Some("bright")), [(Severity::Warning, warning)]);
    assert_eq!(complaints(Some("bad")), []);
    assert_eq!(complaints(None)[0].0, Severity::Error);
    assert_eq!(complaints(Some("none"))[0].0, Severity::Error);
}

/// Hair is brown unless told otherwise, by one of three ways; v is where across a fibre it is seen.
#[test]
fn hair_is_colored_in_one_way() {
    let mut fixture = Fixture::default();
    let mut albedo = |entity: &Entity| {
        let BsdfKind::Hair(hair) = kind_despite_warnings(&mut fixture, entity) else { panic!("no hair") };
        hair.albedo(Vector3::new(0.0, 0.6, 0.8))[1]
    };
    let hair = || plain("hair");
    let brown = albedo(&hair());
    assert_eq!(brown, albedo(&hair().with("eumelanin", floats(1.3))));
    assert!(albedo(&hair().with("pheomelanin", floats(0.3))) > brown);
    assert!((albedo(&hair().with("sigma_a", floats(0.0))) - 1.0).abs() < 1e-5);
    assert!((albedo(&hair().with("reflectance", floats(1.0))) - 1.0).abs() < 1e-5);
    let grey = albedo(&hair().with("color", floats(0.3)));
    assert!(brown < grey && grey < 1.0, "{brown} {grey}");
    assert_eq!(grey, albedo(&hair().with("reflectance", floats(0.3)).with("eumelanin", floats(9.0))));

    let mut complaints = |entity: Entity| {
        let (_, diagnostics) = fixture.build(&entity);
        diagnostics.list().iter().map(|problem| problem.message.clone()).collect::<Vec<_>>()
    };
    let both = hair().with("eumelanin", floats(1.0)).with("pheomelanin", floats(1.0));
    assert_eq!(complaints(both), [""; 0]);
    let twice = hair().with("sigma_a", floats(0.1)).with("color", floats(0.3));
    assert_eq!(complaints(twice), ["\"color\" is ignored, as \"sigma_a\" is given"]);
    assert!(complaints(hair().with("beta_m", floats(0.0)))[0].contains("taken as 0.01"));
    assert!(complaints(hair().with("eta", floats(0.0)))[0].contains("taken as 1"));
}

/// Even facets that reflect half of the light of each.
fn even_measurement() -> Arc<MeasuredBrdf> {
    let wavelengths = vec![500.0];
    let grid = MeasuredGrid { n_phi: 1, n_theta: 2, n_facets: [4, 4], n_spectra: 4, wavelengths };
    Arc::new(MeasuredBrdf::of_model(&grid, |_| 1.0, |_, _, _| 0.1).expect("the model is sound"))
}

/// Measurements need a file; what a file holds is what is seen.
#[test]
fn measurements_need_a_file() {
    let mut fixture = Fixture::default();
    fixture.assets.measured.insert("a".to_owned(), even_measurement());
    fixture.assets.failed.insert("bad".to_owned());
    let of = |file: &str| plain("measured").with("filename", Value::Strings(vec![file.to_owned()]));
    assert!(matches!(fixture.kind(&of("a")), BsdfKind::Measured(_)));
    let mut complaints = |entity| {
        let (_, diagnostics) = fixture.build(&entity);
        diagnostics.list().iter().map(|problem| problem.message.clone()).collect::<Vec<_>>()
    };
    assert_eq!(complaints(of("bad")), [""; 0]);
    assert_eq!(complaints(of("none")), ["the table \"none\" was not loaded"]);
    assert_eq!(complaints(plain("measured")), ["a measured material needs a \"filename\""]);
}

fn kind_despite_warnings(fixture: &mut Fixture, entity: &Entity) -> BsdfKind {
    let material = fixture.build(entity).0.expect("warnings alone");
    let mut lambda = Wavelengths::sample_visible(0.3);
    *fixture.bsdf(material, &context(), &mut lambda).expect("a material that scatters").kind()
}

/// A mixture shows its second material on as large a share of points as was asked, always the same at one point.
#[test]
fn mixtures_have_their_share() {
    let mut fixture = Fixture::default();
    fixture.name_default("matte");
    let glass = fixture.build_clean(&plain("dielectric"));
    fixture.named.insert("glass".to_owned(), glass);
    let names = Value::Strings(vec!["matte".to_owned(), "glass".to_owned()]);
    let share = |fixture: &Fixture, material: MaterialId| {
        let mut rng = Rng::new(7, 0);
        let n = 20_000;
        let count = (0..n)
            .filter(|_| {
                let mut ctx = context();
                ctx.texture.p.x = rng.next_f32();
                let chosen = fixture.materials.resolve(material, &fixture.textures, &ctx);
                assert_eq!(chosen, fixture.materials.resolve(material, &fixture.textures, &ctx));
                matches!(chosen, Material::Dielectric(_))
            })
            .count();
        count as f32 / n as f32
    };
    // 4.5 standard deviations of the worst case.
    let tolerance = (0.25_f32 / 20_000.0).sqrt() * 4.5;
    for amount in [0.0, 0.2, 0.5, 1.0] {
        let entity = plain("mix").with("materials", names.clone()).with("amount", floats(amount));
        let mix = fixture.build_clean(&entity);
        let found = share(&fixture, mix);
        assert!(
            (found - amount).abs() <= tolerance * f32::from(amount > 0.0 && amount < 1.0),
            "{found} {amount}"
        );
    }
    // A mixture of a mixture chooses anew: a quarter, not a half or nothing.
    let half = fixture.build_clean(&plain("mix").with("materials", names));
    fixture.named.insert("half".to_owned(), half);
    let nested = Value::Strings(vec!["matte".to_owned(), "half".to_owned()]);
    let nested = fixture.build_clean(&plain("mix").with("materials", nested));
    let found = share(&fixture, nested);
    assert!((found - 0.25).abs() < tolerance, "{found}");
}

/// Names that do not exist are reported, with the nearest that does.
#[test]
fn unknown_names_are_reported() {
    let mut fixture = Fixture::default();
    let help = |diagnostics: &Diagnostics| diagnostics.list()[0].help.clone().unwrap_or_default();
    let (material, diagnostics) = fixture.build(&plain("difuse"));
    assert!(material.is_none() && diagnostics.has_errors() && help(&diagnostics).contains("\"diffuse\""));

    fixture.name_default("chrome");
    let names = Value::Strings(vec!["chrome".to_owned(), "crome".to_owned()]);
    let (material, diagnostics) = fixture.build(&plain("mix").with("materials", names));
    assert!(material.is_none() && diagnostics.has_errors() && help(&diagnostics).contains("\"chrome\""));

    let (_, diagnostics) = fixture.build(&plain("coateddiffuse").with("maxdepth", Value::Integers(vec![0])));
    assert!(diagnostics.has_errors());
}

/// A height that rises by s per metre turns the normal by atan s against the slope.
#[test]
fn bumps_tilt_the_normal() {
    let mut fixture = Fixture::default();
    let ramp = fixture.ramp(0.5);
    fixture.float_textures.insert("ramp".to_owned(), ramp);
    let entity = plain("diffuse").with("displacement", Value::Texture("ramp".to_owned()));
    let material = fixture.build_clean(&entity);
    let mut lambda = Wavelengths::sample_visible(0.5);
    let bsdf = fixture.bsdf(material, &context(), &mut lambda).unwrap();
    // 0.5 m per unit of u, which is 2 m long.
    let expected = Vector3::new(-0.25, 0.0, 1.0).normalized();
    assert!((bsdf.ns().as_vector() - expected).length() < 1e-3, "{:?}", bsdf.ns());
    assert_eq!(bsdf.ng(), Normal3::new(0.0, 0.0, 1.0));
    // The same with the step of a pixel.
    let mut ctx = context();
    ctx.texture.dudx = 0.02;
    let bsdf = fixture.bsdf(material, &ctx, &mut lambda).unwrap();
    assert!((bsdf.ns().as_vector() - expected).length() < 1e-3, "{:?}", bsdf.ns());
    // Seen from a flipped surface the normal stays on the side of the geometric one.
    let down = Normal3::new(0.0, 0.0, -1.0);
    let flipped = MaterialContext { ng: down, ns: down, ..ctx };
    let bsdf = fixture.bsdf(material, &flipped, &mut lambda).unwrap();
    assert!(bsdf.ns().z < 0.0);
}

/// Without slope, on a curved surface, a constant height keeps the normal.
#[test]
fn a_constant_height_keeps_the_normal() {
    let mut fixture = Fixture::default();
    let material = fixture.build_clean(&plain("diffuse").with("displacement", floats(0.1)));
    let ctx =
        MaterialContext { dndu: Vector3::new(1.0, 0.0, 0.0), dndv: Vector3::new(0.0, 0.5, 0.0), ..context() };
    let mut lambda = Wavelengths::sample_visible(0.5);
    let bsdf = fixture.bsdf(material, &ctx, &mut lambda).unwrap();
    assert!((bsdf.ns().as_vector() - Vector3::new(0.0, 0.0, 1.0)).length() < 1e-6);
}

/// A normal map's blue is the normal, red the first tangent, green the second; its top row is v = 1.
#[test]
fn normal_maps_turn_the_normal() {
    let encode = |n: Vector3| [0.5 * (n.x + 1.0), 0.5 * (n.y + 1.0), 0.5 * (n.z + 1.0)];
    let tilted = Vector3::new(0.6, 0.0, 0.8);
    let flat = Vector3::new(0.0, 0.0, 1.0);
    let texels = Texels::from_fn(4, 4, 3, |_, y, c| encode(if y < 2 { tilted } else { flat })[c]);
    let mut fixture = Fixture::default();
    fixture.assets.images.insert("n.png".to_owned(), Arc::new(texels));
    let entity = plain("diffuse").with("normalmap", strings("n.png"));
    let material = fixture.build_clean(&entity);
    let mut lambda = Wavelengths::sample_visible(0.5);
    let mut normal_at = |v: f32| {
        let mut ctx = context();
        ctx.texture.uv = Point2::new(0.3, v);
        fixture.bsdf(material, &ctx, &mut lambda).unwrap().ns().as_vector()
    };
    assert!((normal_at(0.75) - tilted).length() < 1e-5);
    assert!((normal_at(0.25) - flat).length() < 1e-5);
    // It repeats, and between rows it interpolates.
    assert!((normal_at(-0.25) - tilted).length() < 1e-5);
    assert!((normal_at(0.5) - (tilted + flat).normalized()).length() < 1e-4);
    // An image is held once, however many materials use it.
    let other = fixture.build_clean(&plain("conductor").with("normalmap", strings("n.png")));
    let perturbation = |id| fixture.materials.get(id).perturbation().copied();
    assert_eq!(perturbation(material), perturbation(other));
    // A grey image is no normal map.
    fixture.assets.images.insert("n.png".to_owned(), Arc::new(Texels::from_fn(1, 1, 1, |_, _, _| 0.5)));
    assert!(fixture.build(&entity).1.has_errors());
}

/// A texture of normals runs along u and v even where these are mirrored, and its relief may be scaled.
#[test]
fn normal_textures_follow_v() {
    let tilted = Vector3::new(0.0, 0.6, 0.8);
    let encoded = [tilted.x, tilted.y, tilted.z].map(|x| 0.5 * (x + 1.0));
    let mut fixture = Fixture::default();
    fixture
        .assets
        .images
        .insert("n.png".to_owned(), Arc::new(Texels::from_fn(1, 1, 3, |_, _, c| encoded[c])));
    let picture = plain("imagemap").with("filename", strings("n.png")).with("encoding", strings("linear"));
    let mut context_of_build = BuildContext::new(&fixture.assets);
    let texture = fixture.textures.build_spectrum(
        &mut Parameters::new(&picture, &mut context_of_build),
        &Transform::IDENTITY,
        SpectrumRole::Unbounded,
    );
    let mut normal = |scale: f32, mirrored: bool| {
        let entity = plain("principled").with("normaltexture", Value::Texture("n".to_owned()));
        let entity = entity.with("normalscale", floats(scale));
        let mut context_of_build = BuildContext::new(&fixture.assets);
        context_of_build.spectrum_textures.insert(("n".to_owned(), SpectrumRole::Unbounded), texture);
        let parameters = Parameters::new(&entity, &mut context_of_build);
        let material = fixture.materials.build(parameters, &fixture.named).expect("sound");
        assert!(context_of_build.diagnostics.list().is_empty(), "{:?}", context_of_build.diagnostics.list());
        let mut ctx = context();
        if mirrored {
            ctx.dpdv = -ctx.dpdv;
        }
        fixture.bsdf(material, &ctx, &mut Wavelengths::sample_visible(0.5)).unwrap().ns().as_vector()
    };
    let near = |a: Vector3, b: Vector3| assert!((a - b.normalized()).length() < 1e-5, "{a:?} is not {b:?}");
    near(normal(1.0, false), tilted);
    near(normal(1.0, true), Vector3::new(0.0, -0.6, 0.8));
    near(normal(0.5, false), Vector3::new(0.0, 0.3, 0.8));
}

/// Anisotropy follows the first tangent, also when the frame is turned.
#[test]
fn grooves_follow_the_tangent() {
    let mut fixture = Fixture::default();
    let entity = plain("conductor").with("uroughness", floats(0.01)).with("vroughness", floats(0.25));
    let material = fixture.build_clean(&entity);
    let ctx = MaterialContext { shading_dpdu: Vector3::new(0.0, 5.0, 0.0), ..context() };
    let mut lambda = Wavelengths::sample_visible(0.5);
    let bsdf = fixture.bsdf(material, &ctx, &mut lambda).unwrap();
    assert!((bsdf.frame().x - Vector3::new(0.0, 1.0, 0.0)).length() < 1e-6);
    let wo = Vector3::new(0.0, 0.0, 1.0);
    let at = |x: f32, y: f32| {
        bsdf.eval(wo, Vector3::new(x, y, 1.0).normalized(), TransportMode::Radiance, Lobes::ALL)[0]
    };
    assert!(at(0.4, 0.0) > 10.0 * at(0.0, 0.4));
}

/// A spectrum that ends before the path's wavelength must not make light vanish: it counts as no interface.
#[test]
fn a_missing_index_is_one() {
    let fixture = Fixture::default();
    let index = RefractiveIndex(Spectrum::Constant(0.0));
    let mut lambda = Wavelengths::sample_visible(0.5);
    assert_eq!(index.of_hero(&fixture.textures, &mut lambda), 1.0);
}

/// Materials are copied to other memories, so they hold nothing but numbers and ids, and not too many.
#[test]
fn materials_are_plain_data() {
    fn is_copy<T: Copy>() {}
    is_copy::<Material>();
    assert!(size_of::<Material>() <= 256, "{}", size_of::<Material>());
}

/// A mixture that named itself or a later material could lead around in a circle.
#[test]
#[should_panic(expected = "a mixture names a material that is not there")]
fn mixtures_name_materials_before_them() {
    let mut materials = Materials::new();
    let first = materials.add(Material::default());
    let amount = FloatTexture::Constant(0.5);
    materials.add(Material::Mix(MixMaterial { materials: [first, MaterialId(1)], amount }));
}
