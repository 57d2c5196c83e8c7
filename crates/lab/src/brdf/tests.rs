//! That the curves are those of known lobes, and that figures and pages are whole.

use super::*;

fn subject(model: &str, parameters: &[&str]) -> Subject {
    let parameters: Vec<String> = parameters.iter().map(|&text| text.to_owned()).collect();
    Subject::of_model(model, &parameters).expect("the material is right").0
}

fn message(model: &str, parameters: &[&str]) -> String {
    let parameters: Vec<String> = parameters.iter().map(|&text| text.to_owned()).collect();
    match Subject::of_model(model, &parameters) {
        Err(SubjectError::Request(message)) => message,
        Err(SubjectError::Scene(diagnostics, _)) => diagnostics.list()[0].message.clone(),
        Ok(_) => panic!("{model} is accepted"),
    }
}

fn at(curve: &Curve, angle: f64) -> f64 {
    let point = curve.points.iter().find(|p| (p[0] - angle).abs() < 1e-9);
    point.unwrap_or_else(|| panic!("{} has no point at {angle}", curve.name))[1]
}

fn fresnel_of(model: &str, parameters: &[&str]) -> Vec<Curve> {
    fresnel_curves(&subject(model, parameters).kind).remove(0).curves
}

/// SPEC BRDF-31: in the plane of incidence, Lambert's f cos is a circle through the point, wherever light arrives.
#[test]
fn the_lobe_of_lambert_is_a_circle() {
    for lobe in lobes(&subject("diffuse", &["float reflectance 0.5"]).kind) {
        assert!(lobe.spikes.is_empty());
        for [angle, f_cos] in lobe.points {
            let expected = 0.5 / std::f64::consts::PI * angle.to_radians().cos();
            assert!((f_cos - expected).abs() < 1e-6, "{angle}: {f_cos}");
        }
    }
}

/// SPEC FRES-1, FRES-5: smooth glass sends light to the mirror direction and, by Snell's law, below.
#[test]
fn spikes_of_glass_obey_snell() {
    for lobe in lobes(&subject("dielectric", &["float eta 1.5"]).kind) {
        let [reflected, refracted] = lobe.spikes[..] else { panic!("{:?}", lobe.spikes) };
        let incidence = f64::from(lobe.incidence_deg);
        assert!((reflected[0] - incidence).abs() < 1e-3);
        let inside = (incidence.to_radians().sin() / 1.5).asin().to_degrees();
        assert!((refracted[0].abs() - (180.0 - inside)).abs() < 1e-3, "{refracted:?}");
        assert!((reflected[1] + refracted[1] - 1.0).abs() < 1e-5);
    }
}

/// SPEC EXP-22: air to glass reflects 4.00 % at normal incidence and 8.9 % at 60°, where Schlick's fit says 7.0 %; from
/// inside all is reflected beyond 41.8°, which the bare formula does not know; and it reflects where there is no interface.
#[test]
fn schlicks_fit_beside_fresnels_equations() {
    let curves = fresnel_of("dielectric", &["float eta 1.5"]);
    let [outside, fit, inside, fit_inside, bare] = &curves[..] else { panic!("five curves") };
    assert!((at(outside, 0.0) - 0.04).abs() < 1e-5 && (at(outside, 60.0) - 0.0892).abs() < 1e-4);
    assert!((at(fit, 60.0) - 0.07).abs() < 1e-3);
    for curve in [inside, fit_inside] {
        assert!(at(curve, 41.5) < 1.0 && at(curve, 42.0) == 1.0, "{}", curve.name);
    }
    assert!(at(bare, 42.0) < 0.05);
    let nothing = fresnel_of("dielectric", &["float eta 1"]);
    assert!(at(&nothing[0], 89.0) < 1e-6 && at(&nothing[1], 89.0) == 0.0 && at(&nothing[4], 89.0) > 0.9);
}

/// SPEC EXP-22: coats show what they reflect, and the metal below; models that know a fit alone have one that starts there.
#[test]
fn coats_have_fresnel_curves() {
    let bare = fresnel_of("dielectric", &["float eta 1.4"]);
    for coat in ["smoothcoat", "coateddiffuse", "coatedconductor"] {
        let parameters = if coat == "smoothcoat" { ["float eta 1.4"] } else { ["float interface.eta 1.4"] };
        let parameters = if coat == "coateddiffuse" { ["float eta 1.4"] } else { parameters };
        assert_eq!(fresnel_of(coat, &parameters), bare, "{coat}");
    }
    let [_, metal] = &fresnel_curves(&subject("coatedconductor", &[]).kind)[..] else {
        panic!("two interfaces")
    };
    assert!(metal.is_metal && at(&metal.curves[6], 0.0) > 0.8, "copper is bright in red");
    for (model, f0) in
        [("schlick", "reflectance"), ("ashikhminshirley", "ks"), ("cooktorrance", "reflectance")]
    {
        let text = format!("float {f0} 0.3");
        let fit: &[&str] =
            if model == "cooktorrance" { &[&text, "string fresnel schlick"] } else { &[&text] };
        let curves = fresnel_of(model, fit);
        assert!(
            (at(&curves[0], 0.0) - 0.3).abs() < 1e-3 && (at(&curves[1], 0.0) - 0.3).abs() < 1e-3,
            "{model}"
        );
        assert!(at(&curves[0], 90.0) > 0.99 && at(&curves[1], 90.0) > 0.99, "{model}");
    }
    let coated = fresnel_of("principled", &["float clearcoat 1"]);
    let plastic = fresnel_of("principled", &["float metallic 0", "float ior 1.5"]);
    for curves in [coated, plastic] {
        assert!((at(&curves[0], 0.0) - 0.04).abs() < 1e-4 && (at(&curves[0], 60.0) - 0.0892).abs() < 1e-3);
    }
    for bounces in ["conductor", "dielectric"] {
        let bounces = subject(bounces, &["float roughness 0.3", "bool multiplescattering true"]);
        assert_eq!(fresnel_curves(&bounces.kind).len(), 1);
    }
    assert!(fresnel_curves(&subject("diffuse", &[]).kind).is_empty());
}

/// The albedo of Lambert is its reflectance at each wavelength; reflected and transmitted shares add up.
#[test]
fn albedo_against_angle() {
    let curves = albedo_curves(&subject("diffuse", &["float reflectance 0.3"]).kind);
    assert_eq!(curves.len(), 1);
    assert!(curves[0].points.iter().all(|p| (p[1] - 0.3).abs() < 1e-5));
    let [all, reflected, transmitted] = &albedo_curves(&subject("dielectric", &[]).kind)[..] else {
        panic!("three curves")
    };
    for [angle, share] in &all.points {
        assert!((share - 1.0).abs() < 1e-4);
        // The parts are means of 8192 samples of variance at most 1/4.
        let sum = at(reflected, *angle) + at(transmitted, *angle);
        assert!((sum - share).abs() < 1e-4, "{angle}: {sum}");
    }
}

/// Samples fall as often as their density says: each bar within five standard deviations of a count.
#[test]
fn histograms_follow_the_density() {
    let all = histograms(&subject("conductor", &["float roughness 0.2"]).kind);
    assert_eq!(all.len(), 2);
    for Histogram { angle, samples, pdf } in &all {
        let width = samples.points[1][0] - samples.points[0][0];
        for ([x, share], [_, expected]) in samples.points.iter().zip(&pdf.points) {
            let sigma = (expected * width / 400_000.0).sqrt() / width;
            assert!((share - expected).abs() < 5.0 * sigma + 2e-5, "{angle} {x}: {share} {expected}");
        }
    }
    assert!(histograms(&subject("conductor", &[]).kind).is_empty());
}

/// Parameters are written as in scene files, with or without quotes and brackets.
#[test]
fn parameters_may_lack_quotes() {
    let plain = subject(
        "conductor",
        &["float roughness 0.3", "spectrum eta metal-Ag-eta", "bool remaproughness false"],
    );
    let full = subject(
        "conductor",
        &[
            "\"float roughness\" [ 0.3 ]",
            "\"spectrum eta\" \"metal-Ag-eta\"",
            "\"bool remaproughness\" false",
        ],
    );
    assert_eq!(plain.kind, full.kind);
    assert_eq!(plain.parameters, full.parameters);
    assert_ne!(plain.kind, subject("conductor", &["float roughness 0.3"]).kind);
}

/// What does not exist is refused with what may have been meant.
#[test]
fn unknown_names_are_refused() {
    assert!(message("conducter", &[]).contains("did you mean \"conductor\""));
    assert!(message("conductor", &["float roughnes 0.1"]).contains("did you mean \"roughness\""));
    assert!(message("interface", &[]).contains("scatters no light"));
    assert!(message("conductor", &["roughness"]).len() > 5);
    assert!(message("con\"ductor", &[]).contains("no material"));
}

/// SPEC EXP-44: figure, table and page of a material are whole.
#[test]
fn an_exploration_is_shown_in_full() {
    let exploration = explore(&subject("cooktorrance", &["float roughness 0.2"]), 1);
    let svg = exploration.svg();
    let document = roxmltree::Document::parse(&svg).expect("the figure is XML");
    let texts: Vec<&str> = document.descendants().filter_map(|node| node.text()).map(str::trim).collect();
    for title in ["albedo", "ball under a lamp", "samples"] {
        assert!(texts.contains(&title), "{title} is missing");
    }
    assert_eq!(document.descendants().filter(|node| node.has_tag_name("image")).count(), 1);
    let html = exploration.html();
    assert!(html.contains("roughness = 0.2") && html.contains("reciprocity"));
    assert!(!html.contains("src=\"http") && !html.contains("<script"));
    let image = exploration.image();
    assert_eq!(image.width % 3, 0);
    let pixels = image.rgb_pixels().expect("a picture has colour");
    assert!(pixels.iter().flatten().all(|c| (0.0..=1.0).contains(c)));
    assert!(pixels.iter().any(|p| p[0] < 0.1), "something is drawn");
    let csv = exploration.csv();
    assert!(csv.lines().count() > 1000 && csv.lines().all(|line| line.split(',').count() == 4));
}
