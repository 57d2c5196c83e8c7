//! Materials from parameters to scattering: defaults, meanings and reports.

mod mixtures;
mod models;
mod perturbed;
mod principled;
mod specular;

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

/// Even facets that reflect half of the light of each.
fn even_measurement() -> Arc<MeasuredBrdf> {
    let wavelengths = vec![500.0];
    let grid = MeasuredGrid { n_phi: 1, n_theta: 2, n_facets: [4, 4], n_spectra: 4, wavelengths };
    Arc::new(MeasuredBrdf::of_model(&grid, |_| 1.0, |_, _, _| 0.1).expect("the model is sound"))
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

/// Albedos above 1 would make light; they are clamped, and so are scaled ones.
#[test]
fn albedos_are_clamped() {
    let mut fixture = Fixture::default();
    let sheet = plain("diffusetransmission").with("reflectance", floats(0.4)).with("scale", floats(3.0));
    let BsdfKind::DiffuseTransmission(sheet) = fixture.kind(&sheet) else { panic!("not a sheet") };
    assert_eq!((sheet.reflectance, sheet.transmittance), (Sampled::ONE, Sampled::splat(0.75)));
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

/// Materials are copied to other memories, so they hold nothing but numbers and ids, and not too many.
#[test]
fn materials_are_plain_data() {
    fn is_copy<T: Copy>() {}
    is_copy::<Material>();
    assert!(size_of::<Material>() <= 256, "{}", size_of::<Material>());
}
