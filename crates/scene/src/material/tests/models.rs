//! Models of the literature, tables, hair and measurements.

use super::*;

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
