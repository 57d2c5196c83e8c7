//! `etendue info`: what a scene holds.

use etendue::math::Vector3;
use etendue::scene::light::Light;
use etendue::scene::{Scene, Severity};
use etendue::transport::lpe::PathExpressions;
use etendue::transport::method_name;
use serde_json::{Value, json};

use crate::args::InfoArguments;
use crate::failure::Result;
use crate::list::print;
use crate::load::{LoadedScene, Overrides, load};

/// Runs the command.
pub(crate) fn run(arguments: &InfoArguments) -> Result<()> {
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

/// Lights by kind; the primitives of emissive shapes count as one kind together.
fn lights(scene: &Scene) -> Value {
    let context = scene.light_context();
    let mut kinds: Vec<(&str, usize, f64, f64)> = Vec::new();
    for light in &scene.lights {
        let name = kind_name(light);
        let power = light.power(&context);
        match kinds.iter_mut().find(|(known, ..)| *known == name) {
            Some((_, count, watts, lumens)) => {
                *count += 1;
                *watts += power.watts;
                *lumens += power.lumens;
            }
            None => kinds.push((name, 1, power.watts, power.lumens)),
        }
    }
    kinds
        .into_iter()
        .map(|(name, count, watts, lumens)| {
            json!({"kind": name, "count": count, "power_w": watts, "flux_lm": lumens})
        })
        .collect()
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
    }
}

/// A value for people: a line for each value, with the path to it.
fn print_lines(prefix: &str, value: &Value) {
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
