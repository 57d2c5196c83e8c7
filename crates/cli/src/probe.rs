//! `etendue probe`: illuminance and luminance at points, measured by the renderer (SPEC RAD-13).

use std::fmt::Write as _;
use std::path::Path;

use etendue::image::Image;
use etendue::io::images::{write_atomically, write_image};
use etendue::math::{Point3, Vector3};
use etendue::transport::lpe::PathExpressions;
use etendue::transport::probe::{ProbePoint, ProbeSettings, Reading, probe};
use serde_json::{Value, json};

use crate::args::ProbeArguments;
use crate::failure::{Failure, Result};
use crate::falsecolor::{LUX, UNIT};
use crate::list::print;
use crate::load::{Overrides, load};
use crate::{outputs, report};

/// Most points.
const MOST_POINTS: usize = 1 << 20;

/// Runs the command.
pub(crate) fn run(arguments: &ProbeArguments) -> Result<()> {
    let points = points(arguments)?;
    for path in &arguments.outputs {
        if is_table(path) {
            outputs::check_file(path)?;
        } else if arguments.grid.is_none() {
            let message = format!("{}: points are written as .csv; pictures need a --grid", path.display());
            return Err(Failure::Usage(message));
        } else {
            outputs::check_images(std::slice::from_ref(path))?;
        }
    }
    outputs::check_distinct(std::iter::once(&arguments.scene).chain(&arguments.outputs))?;
    let mut loaded =
        load(&arguments.scene, &Overrides::default(), PathExpressions::default(), arguments.json)?;
    if loaded.scene.controls.take().is_some() {
        report::warning("switches of artists are for pictures: light is measured without them");
    }
    let &ProbeArguments { samples, max_depth, seed, .. } = arguments;
    let readings = probe(&loaded.scene, &points, &ProbeSettings { samples, max_depth, seed });
    let n_invalid: u32 = readings.iter().map(|reading| reading.n_invalid).sum();
    if n_invalid > 0 {
        report::warning(&format!("{n_invalid} samples were NaN, infinite or negative; they count as black"));
    }
    // All are tried before failures are reported.
    let failures: Vec<String> = arguments
        .outputs
        .iter()
        .filter_map(|path| write(path, arguments, &points, &readings).err())
        .collect();
    if !failures.is_empty() {
        return Err(Failure::Running(failures.join("\n")));
    }
    if arguments.json {
        print(&json!({ "points": to_json(&points, &readings) }).to_string());
    } else if arguments.outputs.is_empty() {
        print(table(&points, &readings).trim_end());
    }
    Ok(())
}

fn is_table(path: &Path) -> bool {
    outputs::extension(path) == "csv"
}

/// Points of the command line, or the middles of the fields of a grid, those along the first side first.
fn points(arguments: &ProbeArguments) -> Result<Vec<ProbePoint>> {
    let refuse = |message: &str| Err(Failure::Usage(message.to_owned()));
    let mut normals = Vec::new();
    for [x, y, z] in &arguments.normal {
        let n = Vector3::new(*x, *y, *z);
        let length = n.length();
        if !(length > 0.0 && length.is_finite()) {
            return refuse("--normal: a direction has a length above 0");
        }
        normals.push((n / length).as_normal());
    }
    let (Some([n, m]), Some(u), Some(v)) = (arguments.grid, arguments.u, arguments.v) else {
        if normals.len() != 1 && normals.len() != arguments.at.len() {
            return refuse("give one --normal for all points, or one for each --at");
        }
        let normal = |index: usize| normals[index.min(normals.len() - 1)];
        let point = |(index, &[x, y, z]): (usize, &[f32; 3])| ProbePoint {
            p: Point3::new(x, y, z),
            n: normal(index),
        };
        return Ok(arguments.at.iter().enumerate().map(point).collect());
    };
    if arguments.at.len() != 1 || normals.len() != 1 {
        return refuse("a grid has one --at, its corner, and one --normal");
    }
    if n as usize * m as usize > MOST_POINTS {
        return refuse("a grid has at most 1048576 fields");
    }
    let [side, up] = [u, v].map(|[x, y, z]| Vector3::new(x, y, z));
    let across = side.cross(up).length();
    if !(across > 0.0 && across.is_finite()) {
        return refuse("--u and --v are the sides of the grid: neither is 0, nor are they parallel");
    }
    let corner = arguments.at[0];
    let point = |i: i32, j: i32| {
        let (s, t) = ((i as f32 + 0.5) / n as f32, (j as f32 + 0.5) / m as f32);
        let [x, y, z] = std::array::from_fn(|c| corner[c] + s * u[c] + t * v[c]);
        ProbePoint { p: Point3::new(x, y, z), n: normals[0] }
    };
    Ok((0..m).flat_map(|j| (0..n).map(move |i| point(i, j))).collect())
}

/// Comma-separated values, a line for each point.
fn table(points: &[ProbePoint], readings: &[Reading]) -> String {
    let mut text = "x,y,z,nx,ny,nz,illuminance_lx,illuminance_error_lx,direct_lx,direct_error_lx,luminance_cd_m2,luminance_error_cd_m2\n".to_owned();
    for (ProbePoint { p, n }, reading) in points.iter().zip(readings) {
        let place = [p.x, p.y, p.z, n.x, n.y, n.z].map(|v| v.to_string()).join(",");
        let Reading { illuminance_lx, direct_lx, luminance_cd_m2, .. } = reading;
        let values = [illuminance_lx, direct_lx, luminance_cd_m2]
            .map(|e| format!("{:.6e},{:.2e}", e.mean, e.standard_error))
            .join(",");
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{place},{values}");
    }
    text
}

fn to_json(points: &[ProbePoint], readings: &[Reading]) -> Value {
    let point = |(point, reading): (&ProbePoint, &Reading)| {
        let ProbePoint { p, n } = point;
        json!({
            "at": [p.x, p.y, p.z],
            "normal": [n.x, n.y, n.z],
            "illuminance_lx": reading.illuminance_lx.mean,
            "illuminance_error_lx": reading.illuminance_lx.standard_error,
            "direct_lx": reading.direct_lx.mean,
            "direct_error_lx": reading.direct_lx.standard_error,
            "luminance_cd_m2": reading.luminance_cd_m2.mean,
            "luminance_error_cd_m2": reading.luminance_cd_m2.standard_error,
        })
    };
    points.iter().zip(readings).map(point).collect()
}

/// Writes one output, or tells why not.
fn write(
    path: &Path,
    arguments: &ProbeArguments,
    points: &[ProbePoint],
    readings: &[Reading],
) -> std::result::Result<(), String> {
    let failed = |error: &dyn std::fmt::Display| format!("cannot write {error}");
    if is_table(path) {
        let text = table(points, readings);
        let written = write_atomically(path, |out| std::io::Write::write_all(out, text.as_bytes()));
        return written.map_err(|error| failed(&format!("{}: {error}", path.display())));
    }
    let [width, height] = arguments.grid.unwrap_or([1, 1]).map(|n| n as usize);
    write_image(path, &picture(width, height, readings)).map_err(|error| failed(&error))
}

/// Illuminance of a grid as a picture: the first side runs to the right, the second up.
fn picture(width: usize, height: usize, readings: &[Reading]) -> Image {
    let plane = |value: fn(&Reading) -> f64| -> Vec<f32> {
        let rows = readings.chunks(width).rev();
        rows.flatten().map(|reading| value(reading) as f32).collect()
    };
    let mut image = Image::gray(width, height, plane(|reading| reading.illuminance_lx.mean));
    image.set_channel("variance.Y", plane(|reading| reading.illuminance_lx.standard_error.powi(2)));
    image.set_channel("direct.Y", plane(|reading| reading.direct_lx.mean));
    image.set_channel("luminance.Y", plane(|reading| reading.luminance_cd_m2.mean));
    image.metadata.insert(UNIT.to_owned(), LUX.to_owned());
    image.metadata.insert("software".to_owned(), format!("etendue {}", env!("CARGO_PKG_VERSION")));
    image
}
