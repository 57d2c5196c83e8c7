//! What `info` says of lights: power and what they are known by, against closed forms.

use etendue::io::ies::read_ies;
use etendue::math::Vector3;
use serde_json::Value;

use crate::real_scenes::shared_scenes;
use crate::support::Folder;

/// The lights of a scene, as `info --json` has them, and the totals.
#[track_caller]
fn info(folder: &Folder, world: &str) -> (Vec<Value>, Value) {
    folder.write("scene.pbrt", format!("WorldBegin\n{world}"));
    let json = folder.run_with(&["info", "scene.pbrt", "--json"]).expect(0).json();
    (json["lights"].as_array().expect("lights are a list").clone(), json["total_light"].clone())
}

#[track_caller]
fn near(value: &Value, expected: f64) {
    let number = value.as_f64().unwrap_or_else(|| panic!("{value} is no number"));
    assert!((number - expected).abs() <= 3e-3 * expected, "{number} instead of {expected}");
}

const PI: f64 = std::f64::consts::PI;
/// Spheres of 1 m at the corners of a cube, so that the sphere around the scene has the radius 1.001 sqrt(3) (1 + 1).
const CUBE: &str = "AttributeBegin Translate -1 -1 -1 Shape \"sphere\" AttributeEnd
    AttributeBegin Translate 1 1 1 Shape \"sphere\" AttributeEnd\n";

#[test]
fn lamps_have_the_flux_of_their_closed_forms() {
    let folder = Folder::new();
    // 100 cd over the sphere; a disk of 2 cd/m^2 with 0.5 m, pi A L; a spreading one, 2 pi A L / (n + 2).
    let (lights, total) = info(
        &folder,
        "LightSource \"point\" \"float scale\" 100
        LightSource \"spot\" \"float scale\" 7
        AreaLightSource \"diffuse\" \"float scale\" 2 Shape \"disk\" \"float radius\" 0.5
        AreaLightSource \"diffuse\" \"float scale\" 2 \"float exponent\" 2 Shape \"disk\" \"float radius\" 0.5",
    );
    near(&lights[0]["flux_lm"], 400.0 * PI);
    near(&lights[0]["measure"]["cd"], 100.0);
    near(&lights[1]["measure"]["cd"], 7.0);
    assert_eq!(lights[2]["count"], 2);
    let disk = 2.0 * PI * 0.25;
    near(&lights[2]["flux_lm"], disk * PI + disk * 2.0 * PI / 4.0);
    near(&lights[2]["measure"]["cd/m^2"], 2.0);
    let lamps: f64 = lights.iter().map(|light| light["flux_lm"].as_f64().unwrap_or_default()).sum();
    near(&total["lamps"]["flux_lm"], lamps);
    // 555 nm and around at 10 W: about 683 lm/W.
    let (lights, _) = info(
        &folder,
        "LightSource \"point\" \"spectrum I\" [ 554 1 556 1 ] \"string units\" \"radiometric\" \"float power\" 10",
    );
    near(&lights[0]["power_w"], 10.0);
    near(&lights[0]["flux_lm"], 6830.0);
    near(&lights[0]["measure"]["W/sr"], 10.0 / (4.0 * PI));
}

#[test]
fn surroundings_shine_on_the_cross_section_of_the_scene() {
    let folder = Folder::new();
    let disc = PI * (1.001 * 2.0 * 3.0_f64.sqrt()).powi(2);
    let (lights, total) = info(
        &folder,
        &format!(
            "{CUBE} LightSource \"distant\" \"float illuminance\" 500\n LightSource \"infinite\" \"float scale\" 3"
        ),
    );
    near(&lights[0]["measure"]["lx"], 500.0);
    near(&lights[0]["flux_lm"], 500.0 * disc);
    near(&lights[1]["measure"]["cd/m^2"], 3.0);
    near(&lights[1]["flux_lm"], 3.0 * 4.0 * PI * disc);
    near(&total["surroundings"]["flux_lm"], (500.0 + 12.0 * PI) * disc);
    let (lights, _) = info(&folder, &format!("{CUBE} LightSource \"sunsky\" \"float elevation\" 60"));
    let lux = |light: &Value| light["measure"]["lx"].as_f64().unwrap_or_default();
    assert!((8e3..25e3).contains(&lux(&lights[0])) && (70e3..110e3).contains(&lux(&lights[1])), "{lights:?}");
    near(&lights[1]["flux_lm"], lux(&lights[1]) * disc);
}

#[test]
fn luminaires_have_the_lumens_of_their_files() {
    let folder = Folder::new();
    folder.write("lamp.ies", "IESNA91\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 50\n0 180\n0\n80 80\n");
    let (lights, _) = info(&folder, "LightSource \"ies\" \"string filename\" \"lamp.ies\"");
    near(&lights[0]["flux_lm"], 320.0 * PI);
    near(&lights[0]["measure"]["cd"], 80.0);
    folder.write("lamp.ies", "IESNA91\nTILT=NONE\n1 -1 1 2 1e9 1 2 0 0 0\n1 1 50\n0 180\n0\n80 80\n");
    folder.write("scene.pbrt", "WorldBegin\nLightSource \"ies\" \"string filename\" \"lamp.ies\"");
    let output = folder.run_with(&["info", "scene.pbrt"]).expect(2);
    assert!(output.stderr.contains("line 3") && output.stderr.contains("more than the file holds"));
}

/// A street lamp of the shared scenes: candela of the file in every direction of its table, and the lumens of their integral.
#[test]
fn a_real_luminaire_shines_as_measured() {
    let Some(root) = shared_scenes() else { return };
    let path = root.join("ies/ASA_15M_R2.ies");
    let text = String::from_utf8_lossy(&std::fs::read(&path).expect("the file is there")).into_owned();
    let numbers = text.split("TILT=NONE").nth(1).expect("it has no tilt").split_whitespace();
    let numbers: Vec<f32> = numbers.map(|word| word.parse().expect("it is a number")).collect();
    let (n_vertical, n_horizontal) = (numbers[3] as usize, numbers[4] as usize);
    let (vertical, rest) = numbers[13..].split_at(n_vertical);
    let (horizontal, candela) = rest.split_at(n_horizontal);
    let photometry = read_ies(text.as_bytes()).expect("it is a photometric file");
    for (j, h) in horizontal.iter().enumerate() {
        for (i, v) in vertical.iter().enumerate().filter(|(_, v)| **v > 0.0) {
            // The table is that of one half.
            for h in [*h, 360.0 - h] {
                let ((sin_v, cos_v), (sin_h, cos_h)) = (v.to_radians().sin_cos(), h.to_radians().sin_cos());
                // Rounding must not lead beyond the horizon, where the table ends.
                let w = Vector3::new(sin_v * cos_h, sin_v * sin_h, -cos_v.max(1e-6)).normalized();
                let expected = candela[j * n_vertical + i];
                let found = photometry.intensity(w);
                assert!(
                    (found - expected).abs() <= 5e-3 * expected + 0.01,
                    "{found} instead of {expected} at {v} {h}"
                );
            }
        }
    }
    let folder = Folder::new();
    let world = format!("LightSource \"ies\" \"string filename\" \"{}\"", path.display());
    let (lights, _) = info(&folder, &world);
    // The sum over bands of 0.1 degree of the table, interpolated linearly.
    near(&lights[0]["flux_lm"], 9560.8);
    near(&lights[0]["measure"]["cd"], 6019.0);
}
