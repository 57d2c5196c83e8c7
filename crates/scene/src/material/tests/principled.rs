//! glTF's extensions, from parameters to scattering.

use super::*;
use crate::bsdf::Facetted;

/// `principled` is the quick model unless an extension is named.
#[test]
fn extensions_are_there_if_named() {
    let mut fixture = Fixture::default();
    let plain_model = fixture.kind(&plain("principled"));
    assert!(matches!(plain_model, BsdfKind::Facetted(Facetted::Principled(_))));
    let coated = fixture.kind(&plain("principled").with("clearcoat", floats(1.0)));
    assert!(matches!(coated, BsdfKind::Facetted(Facetted::Extended(_))));
    // Extensions at their defaults change nothing that can be seen.
    let idle = fixture.kind(&plain("principled").with("clearcoat", floats(0.0)));
    let (wo, wi) = (Vector3::new(0.6, 0.0, 0.8), Vector3::new(-0.48, 0.36, 0.8));
    let [a, b] = [plain_model, idle].map(|kind| kind.eval(wo, wi, TransportMode::Radiance, Lobes::ALL)[0]);
    assert!((a - b).abs() < 2e-3 * a, "{a} {b}");
}

/// Glass with a thickness is a solid with a medium inside; a sheet and what is opaque have no inside.
#[test]
fn thickness_makes_solids() {
    let mut fixture = Fixture::default();
    let glass = plain("principled").with("transmission", floats(1.0)).with("roughness", floats(0.0));
    let amber = |entity: Entity| {
        let color = Value::Rgb(vec![[0.9, 0.5, 0.1]]);
        entity
            .with("thickness", floats(1.0))
            .with("attenuationcolor", color)
            .with("attenuationdistance", floats(0.02))
    };
    let sheet = fixture.build_clean(&glass);
    assert_eq!(fixture.materials.interface(sheet), None);
    let solid = fixture.build_clean(&amber(glass.clone()));
    let inside = fixture.materials.interface(solid).and_then(|sides| sides.towards(-1.0)).expect("amber");
    // After twice the distance the square of the colour is left.
    let lambda = Wavelengths::sample_visible(0.5);
    let spectra = &fixture.textures.spectra;
    let after = |d: f32| fixture.materials.media().transmittance(inside, d, spectra, &lambda);
    assert!((after(0.04) - after(0.02) * after(0.02)).abs().max_value() < 1e-5);
    // Solids bend light, sheets do not.
    let wo = Vector3::new(0.6, 0.0, 0.8);
    let passed = |material| {
        let mut lambda = Wavelengths::sample_visible(0.3);
        let bsdf = fixture.bsdf(material, &context(), &mut lambda).unwrap();
        let u = Point2::new(0.5, 0.5);
        bsdf.sample(wo, 0.5, u, TransportMode::Radiance, Lobes::TRANSMIT).unwrap()
    };
    assert!((passed(sheet).wi + wo).length() < 1e-5);
    assert!((passed(solid).wi.x + 0.4).abs() < 1e-5, "sin 0.6 / 1.5");
    // Colour without a solid does nothing, and says so.
    let (_, diagnostics) = fixture.build(&amber(plain("principled")));
    assert!(diagnostics.list()[0].message.contains("has no effect"), "{:?}", diagnostics.list());
}

/// `KHR_materials_dispersion`: Abbe's number is `(n_d - 1)/(n_F - n_C)`, and the path keeps one wavelength.
#[test]
fn solids_disperse_by_abbes_number() {
    let mut fixture = Fixture::default();
    let entity = plain("principled")
        .with("transmission", floats(1.0))
        .with("roughness", floats(0.0))
        .with("thickness", floats(1.0))
        .with("dispersion", floats(0.5));
    let flint = fixture.build_clean(&entity);
    let index = |nm: f32| {
        let mut lambda = Wavelengths::from_parts([nm; 4], [1.0; 4]);
        let bsdf = fixture.bsdf(flint, &context(), &mut lambda).unwrap();
        assert!(lambda.secondary_terminated());
        let up = Vector3::new(0.0, 0.0, 1.0);
        bsdf.sample(up, 0.5, Point2::new(0.5, 0.5), TransportMode::Radiance, Lobes::TRANSMIT).unwrap().eta
    };
    let [d, f, c] = [587.6, 486.1, 656.3].map(index);
    assert!((d - 1.5).abs() < 1e-4 && ((d - 1.0) / (f - c) - 40.0).abs() < 0.1, "{d} {f} {c}");
}

/// `KHR_materials_anisotropy` smears highlights along the first tangent, or along what it is turned to.
#[test]
fn brushing_turns() {
    let mut fixture = Fixture::default();
    let brushed = plain("principled").with("anisotropy", floats(0.8)).with("roughness", floats(0.3));
    let smear = |entity: &Entity, fixture: &mut Fixture| {
        let material = fixture.build_clean(entity);
        let bsdf = fixture.bsdf(material, &context(), &mut Wavelengths::sample_visible(0.5)).unwrap();
        let wo = Vector3::new(0.0, 0.0, 1.0);
        let at = |x: f32, y: f32| {
            let wi = Vector3::new(x, y, 1.0).normalized();
            bsdf.eval(wo, wi, TransportMode::Radiance, Lobes::GLOSSY_REFLECT)[0]
        };
        at(0.6, 0.0) / at(0.0, 0.6)
    };
    assert!(smear(&brushed, &mut fixture) > 5.0);
    assert!(smear(&brushed.with("anisotropyrotation", floats(90.0)), &mut fixture) < 0.2);
}

/// The coat does not follow the relief of what it covers.
#[test]
fn coats_have_their_own_normal() {
    let tilted = Vector3::new(0.6, 0.0, 0.8);
    let encoded = [tilted.x, tilted.y, tilted.z].map(|x| 0.5 * (x + 1.0));
    let mut fixture = Fixture::default();
    let texels = Texels::from_fn(2, 2, 3, |_, _, c| encoded[c]);
    fixture.assets.images.insert("n.png".to_owned(), Arc::new(texels));
    let coated = plain("principled").with("clearcoat", floats(1.0)).with("specular", floats(0.0));
    let brightest = |entity: Entity, fixture: &mut Fixture| {
        let material = fixture.build_clean(&entity);
        let bsdf = fixture.bsdf(material, &context(), &mut Wavelengths::sample_visible(0.5)).unwrap();
        let back = |w| bsdf.eval(w, w, TransportMode::Radiance, Lobes::GLOSSY_REFLECT)[0];
        [back(Vector3::new(0.0, 0.0, 1.0)), back(tilted)]
    };
    let [up, aside] = brightest(coated.clone().with("normalmap", strings("n.png")), &mut fixture);
    assert!(up > 100.0 * aside, "{up} {aside}");
    let [up, aside] = brightest(coated.with("clearcoatnormalmap", strings("n.png")), &mut fixture);
    assert!(aside > 100.0 * up, "{up} {aside}");
}
