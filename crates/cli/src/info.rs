//! `etendue info`: what a scene holds.

use etendue::math::Vector3;
use etendue::scene::light::{Light, LightMeasure, LightPower};
use etendue::scene::{Scene, Severity};
use etendue::transport::lpe::PathExpressions;
use etendue::transport::method_name;
use serde_json::{Value, json};

use crate::args::InfoArguments;
use crate::failure::Result;
use crate::list::print;
use crate::load::{LoadedScene, Overrides, load};
use crate::{image, photon_file};

/// Runs the command.
pub(crate) fn run(arguments: &InfoArguments) -> Result<()> {
    if photon_file::is_map(&arguments.scene) {
        let description = photon_file::describe(&arguments.scene)?;
        if arguments.json {
            print(&description.to_string());
        } else {
            print_lines("", &description);
        }
        return Ok(());
    }
    if image::is_picture(&arguments.scene) {
        return image::info(&arguments.scene, arguments.json);
    }
    let loaded = load(&arguments.scene, &Overrides::default(), PathExpressions::default(), arguments.json)?;
    let description = describe(&loaded);
    if arguments.json {
        print(&description.to_string());
    } else {
        // The warnings are on standard error already.
        let mut facts = description;
        facts.as_object_mut().map(|object| object.remove("warnings"));
        print_lines("", &facts);
    }
    Ok(())
}

fn describe(loaded: &LoadedScene) -> Value {
    let scene = &loaded.scene;
    let counts = scene.geometry.counts();
    let bounds = scene.bounds();
    let point = |p: etendue::math::Point3| json!([p.x, p.y, p.z]);
    let size: Vector3 = if bounds.is_empty() { Vector3::splat(0.0) } else { bounds.diagonal() };
    let warnings: Vec<Value> = loaded
        .diagnostics
        .list()
        .iter()
        .filter(|d| d.severity == Severity::Warning)
        .map(|d| {
            let place = d.span.map(|span| loaded.document.sources.locate(span).to_string());
            json!({"message": d.message, "place": place})
        })
        .collect();
    json!({
        "geometry": {
            "shapes": counts.n_geometries,
            "triangles": counts.n_triangles,
            "patches": counts.n_patches,
            "quadrics": counts.n_quadrics,
            "curves": counts.n_curves,
            "points": counts.n_points,
            "objects": counts.n_objects,
            "instances": counts.n_instances,
            "memory_bytes": scene.geometry.memory_bytes(),
        },
        "bounds": {
            "min": point(bounds.min),
            "max": point(bounds.max),
            "size_m": [size.x, size.y, size.z],
        },
        "materials": scene.materials.len(),
        "lights": lights(scene),
        "total_light": total_power(scene),
        "film": {
            "resolution": scene.film.resolution,
            "filename": scene.film.filename,
            "colorspace": scene.film.color_space.name(),
        },
        "sampler": {
            "kind": format!("{:?}", scene.sampler.kind),
            "samples_per_pixel": scene.sampler.samples_per_pixel,
        },
        "integrator": method_name(&scene.integrator.type_name),
        "warnings": warnings,
    })
}

/// Lights of one kind; the primitives of emissive shapes count as one kind together.
struct KindOfLight {
    name: &'static str,
    count: usize,
    power: LightPower,
    /// Least and greatest of what they are known by.
    measures: Option<[LightMeasure; 2]>,
}

/// Lights by kind with their flux and what they are known by: intensity, irradiance or radiance.
fn lights(scene: &Scene) -> Value {
    let context = scene.light_context();
    let mut kinds: Vec<KindOfLight> = Vec::new();
    for light in &scene.lights {
        let (name, power, measure) = (kind_name(light), light.power(&context), light.measure(&context));
        let Some(kind) = kinds.iter_mut().find(|kind| kind.name == name) else {
            kinds.push(KindOfLight { name, count: 1, power, measures: measure.map(|m| [m, m]) });
            continue;
        };
        kind.count += 1;
        kind.power = kind.power + power;
        if let (Some([least, most]), Some(measure)) = (&mut kind.measures, measure) {
            if measure.value.lumens < least.value.lumens {
                *least = measure;
            }
            if measure.value.lumens > most.value.lumens {
                *most = measure;
            }
        }
    }
    kinds.iter().map(KindOfLight::to_json).collect()
}

impl KindOfLight {
    fn to_json(&self) -> Value {
        let mut json = json!({
            "kind": self.name,
            "count": self.count,
            "power_w": self.power.watts,
            "flux_lm": self.power.lumens,
        });
        if let Some([least, most]) = &self.measures {
            let range = |a: f64, b: f64| if a == b { json!(a) } else { json!([a, b]) };
            let [radiant, luminous] = least.units;
            json["measure"] = json!({
                "name": least.name,
                radiant: range(least.value.watts, most.value.watts),
                luminous: range(least.value.lumens, most.value.lumens),
            });
        }
        json
    }
}

/// Flux of all lamps, and of all surroundings through the sphere around the scene.
fn total_power(scene: &Scene) -> Value {
    let context = scene.light_context();
    let total = |is_infinite: bool| {
        let lights = scene.lights.iter().filter(|light| light.is_infinite() == is_infinite);
        let power = lights.fold(LightPower::default(), |sum, light| sum + light.power(&context));
        json!({"power_w": power.watts, "flux_lm": power.lumens})
    };
    json!({"lamps": total(false), "surroundings": total(true)})
}

const fn kind_name(light: &Light) -> &'static str {
    match light {
        Light::Point(_) => "point",
        Light::Spot(_) => "spot",
        Light::Distant(_) => "distant",
        Light::Goniometric(_) => "goniometric",
        Light::Ies(_) => "ies",
        Light::Projection(_) => "projection",
        Light::InfiniteConstant(_) => "infinite",
        Light::InfiniteImage(_) => "infinite image",
        Light::InfinitePortal(_) => "infinite portal",
        Light::Sky(_) => "sky",
        Light::Sun(_) => "sun",
        Light::Area(_) => "area",
        Light::MovingArea(_) => "moving area",
    }
}

/// A value for people: a line for each value, with the path to it.
pub(crate) fn print_lines(prefix: &str, value: &Value) {
    match value {
        Value::Object(map) => {
            for (key, value) in map {
                let path = if prefix.is_empty() { key.clone() } else { format!("{prefix}.{key}") };
                print_lines(&path, value);
            }
        }
        Value::Array(list) if list.iter().any(Value::is_object) => {
            for (index, value) in list.iter().enumerate() {
                print_lines(&format!("{prefix}[{index}]"), value);
            }
        }
        other => print(&format!("{prefix}: {other}")),
    }
}
