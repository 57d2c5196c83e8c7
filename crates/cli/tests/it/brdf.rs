//! `brdf`.

use crate::support::{Folder, is_slow, scene};

/// What is written has the form that its name says, and JSON is one object.
#[test]
fn every_form_is_written() {
    let folder = Folder::new();
    let arguments = ["brdf", "conductor", "--param", "float roughness 0.3", "--samples", "1", "--json"];
    let outputs = ["-o", "a.html", "-o", "a.svg", "-o", "a.png", "-o", "a.csv"];
    let run = folder.run_with(&[&arguments[..], &outputs[..]].concat()).expect(0);
    let json = run.json();
    assert_eq!(json["model"], "conductor");
    assert_eq!(json["parameters"]["roughness"], "0.3");
    assert!(json["albedo_max"].as_f64().expect("a number") < 1.0);
    assert_eq!(json["laws_broken"].as_array().map(Vec::len), Some(0));
    assert_eq!(folder.files(), ["a.csv", "a.html", "a.png", "a.svg"]);
    let text = |name| String::from_utf8(folder.read(name)).expect("text");
    assert!(text("a.html").starts_with("<!DOCTYPE html>") && text("a.html").trim_end().ends_with("</html>"));
    assert!(text("a.svg").starts_with("<svg") && text("a.svg").trim_end().ends_with("</svg>"));
    assert!(text("a.csv").starts_with("plot,curve,angle_deg,value\n"));
    assert!(folder.image("a.png").width > 1000);
}

/// A material of a scene is found by its name or number; one that is not there is refused with what is.
#[test]
fn materials_of_scenes() {
    let gold = "MakeNamedMaterial \"gold\" \"string type\" \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \
                \"spectrum k\" \"metal-Au-k\"\nMaterial \"diffuse\" \"rgb reflectance\" [ 0.2 0.4 0.6 ]";
    let folder = Folder::with_scene(&scene("", gold));
    let look = |name: &str| folder.run(&format!("brdf --scene scene.pbrt --samples 1 --material {name}"));
    let run = look("gold").expect(0);
    assert!(run.stdout.starts_with("gold (conductor): eta = \"metal-Au-eta\""), "{}", run.stdout);
    assert!(run.stdout.contains("reciprocity"));
    let run = look("2").expect(0);
    assert!(run.stdout.starts_with("diffuse: reflectance = 0.2 0.4 0.6"), "{}", run.stdout);
    look("golt").expect(2).says("did you mean \"gold\"?");
    look("9").expect(2).says("from 1 to 2");
    folder.run("brdf --scene nothing.pbrt --material gold").expect(2).says("nothing.pbrt");
    assert_eq!(folder.files(), ["scene.pbrt"]);
}

/// Slips are refused with what may have been meant, and leave no file.
#[test]
fn slips_are_refused() {
    let folder = Folder::new();
    folder.run("brdf conducter -o a.html").expect(2).says("did you mean \"conductor\"?");
    let parameter = |text| folder.run_with(&["brdf", "conductor", "--param", text, "-o", "a.svg"]).expect(2);
    parameter("float roughnes 0.1").says("did you mean \"roughness\"?");
    parameter("float roughness wide").says("should be a number");
    parameter("string roughness wide").says("roughness");
    parameter("texture roughness wood").says("wood");
    folder.run("brdf conductor -o a.jpg").expect(2).says(".html, .svg, .png, .csv");
    folder.run("brdf conductor -o missing/a.svg").expect(2).says("missing");
    folder.run("brdf interface").expect(2).says("scatters no light");
    folder.run("brdf").expect(2);
    folder.run("brdf conductor --all").expect(2);
    assert!(folder.files().is_empty(), "{:?}", folder.files());
}

/// SPEC EXP-44: the table of laws names every model, and breaks none but what is stated.
#[test]
fn the_table_of_laws() {
    if !is_slow() {
        return;
    }
    let folder = Folder::new();
    let run = folder.run("brdf --all --json").expect(0);
    assert_eq!(run.stderr, "");
    let rows: Vec<serde_json::Value> = serde_json::from_str(&run.stdout).expect("an array");
    for model in ["diffuse", "conductor", "dielectric", "coateddiffuse"] {
        assert!(rows.iter().any(|row| row["model"] == model), "{model}");
    }
    for row in &rows {
        for number in ["reciprocity_error", "albedo_max", "furnace", "chi2_p"] {
            assert!(row[number].as_f64().is_some_and(|x| x >= 0.0), "{number} of {row}");
        }
        assert!(row["parameters"].is_object() && row["laws_broken"].is_array(), "{row}");
    }
    let text = folder.run("brdf --all").expect(0).stdout;
    assert_eq!(text.lines().count(), rows.len() + 1);
}
