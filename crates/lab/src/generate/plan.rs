//! A drawing of points in the plane: the cells of their kd-tree beside those of Voronoi, as a scene and as SVG (SPEC SCENE-39,
//! KD-2).

use std::fmt::Write;

use etendue_math::Rng;

use super::settings::{SEED, choice, count};
use super::text::{Frame, numbers};
use super::{Files, Generator, Settings};
use crate::neighbours::Distribution;

/// The drawing.
pub(super) const GENERATOR: Generator = Generator {
    name: "voronoi",
    id: "SCENE-39",
    doc: "the kd-tree and the Voronoi diagram of the same points of the plane",
    parameters: &[
        count("points", "60", [1, 2000], "number of points"),
        choice("photons", "even", &["even", "caustic"], "where points are: anywhere, or as photons in a cup"),
        SEED,
    ],
    generate,
};

type Point = [f32; 2];

fn generate(settings: &Settings) -> Files {
    let seed = u64::from(settings.count("seed"));
    let mut rng = Rng::new(seed, 0);
    let n = settings.count("points");
    let points: Vec<Point> = if settings.word("photons") == "caustic" {
        let photons = Distribution::Caustic.photons(n as usize, seed);
        photons.into_iter().map(|p| [p.x, p.z].map(|at| 0.5 + 0.96 * at)).collect()
    } else {
        (0..n).map(|_| [0, 1].map(|_| 0.02 + 0.96 * rng.next_f32())).collect()
    };
    let frame = Frame { name: "voronoi", resolution: [800, 400], exposure_s: 1.0, samples: 64, max_depth: 2 };
    let mut world = String::new();
    let mut lines = Vec::new();
    kd_tree(&mut points.clone(), [[0.0, 0.0], [1.0, 1.0]], &mut lines);
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    lines.extend((0..4).map(|k| [corners[k], corners[(k + 1) % 4]]));
    let cells: Vec<Vec<Point>> = (0..points.len()).map(|index| voronoi_cell(index, &points)).collect();
    for [a, b] in &lines {
        line(&mut world, shift(*a, -1.05), shift(*b, -1.05));
    }
    for (point, polygon) in points.iter().zip(&cells) {
        cell(&mut world, polygon, &mut rng);
        for x in [-1.05, 0.05] {
            dot(&mut world, shift(*point, x));
        }
    }
    let text = format!(
        r#"# The kd-tree of {n} points of the plane (left) and the cells of Voronoi of the same points (right) (SPEC SCENE-39).
#
# A drawing: flat pieces above each other under an even light, seen along z. x grows to the right, y upwards.

Scale -1 1 1
LookAt 0 0 5   0 0 0   0 1 0
Camera "orthographic" "float screenwindow" [ -1.12 1.12 -0.06 1.06 ]
{frame}
WorldBegin

LightSource "infinite"

Material "diffuse" "rgb reflectance" [ 0.95 0.95 0.95 ]
Shape "bilinearmesh" "point3 P" [ -9 -9 0  9 -9 0  -9 9 0  9 9 0 ]
{world}"#,
        frame = frame.text(),
    );
    Files::of_text("voronoi", text).with_bytes("voronoi.svg", svg(&points, &lines, &cells).into_bytes())
}

/// The same drawing in lines.
fn svg(points: &[Point], lines: &[[Point; 2]], cells: &[Vec<Point>]) -> String {
    let mut text = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-1.1 -1.05 2.2 1.1\" width=\"880\" height=\"440\">\n\
         <rect x=\"-1.1\" y=\"-1.05\" width=\"2.2\" height=\"1.1\" fill=\"white\"/>\n\
         <g fill=\"none\" stroke=\"#888\" stroke-width=\"0.002\">\n",
    );
    for [a, b] in lines {
        let [a, b] = [a, b].map(|p| shift(*p, -1.05));
        let _ = writeln!(text, "<path d=\"M{:.4} {:.4}L{:.4} {:.4}\"/>", a[0], -a[1], b[0], -b[1]);
    }
    for cell in cells {
        let corners: Vec<String> = cell.iter().map(|[x, y]| format!("{:.4},{:.4}", x + 0.05, -y)).collect();
        let _ = writeln!(text, "<polygon points=\"{}\"/>", corners.join(" "));
    }
    text += "</g>\n<g fill=\"#d55e00\">\n";
    for [x, y] in points {
        for by in [-1.05, 0.05] {
            let _ = writeln!(text, "<circle cx=\"{:.4}\" cy=\"{:.4}\" r=\"0.005\"/>", x + by, -y);
        }
    }
    text + "</g>\n</svg>\n"
}

fn shift([x, y]: Point, by: f32) -> Point {
    [x + by, y]
}

/// The lines of a kd-tree: it splits the longer side of its box at the median.
fn kd_tree(points: &mut [Point], [min, max]: [Point; 2], lines: &mut Vec<[Point; 2]>) {
    let size = [max[0] - min[0], max[1] - min[1]];
    if points.is_empty() {
        return;
    }
    let axis = usize::from(size[1] > size[0]);
    let middle = points.len() / 2;
    points.sort_by(|a, b| a[axis].total_cmp(&b[axis]));
    let at = points[middle][axis];
    let (mut lower_max, mut upper_min) = (max, min);
    lower_max[axis] = at;
    upper_min[axis] = at;
    lines.push([upper_min, lower_max]);
    kd_tree(&mut points[..middle], [min, lower_max], lines);
    kd_tree(&mut points[middle + 1..], [upper_min, max], lines);
}

/// The part of the unit square that is nearer to one point than to all others.
fn voronoi_cell(index: usize, points: &[Point]) -> Vec<Point> {
    let own = points[index];
    let mut cell = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    for (_, other) in points.iter().enumerate().filter(|(other, _)| *other != index) {
        // Positive where a place is nearer to the point than to the other one.
        let square = |p: Point| p[0] * p[0] + p[1] * p[1];
        let nearer = |p: Point| {
            2.0 * ((own[0] - other[0]) * p[0] + (own[1] - other[1]) * p[1]) - square(own) + square(*other)
        };
        cell = clip(&cell, nearer);
    }
    cell
}

/// The part of a convex polygon where a linear function is not negative (Sutherland and Hodgman 1974).
fn clip(polygon: &[Point], value: impl Fn(Point) -> f32) -> Vec<Point> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, a) in polygon.iter().enumerate() {
        let b = polygon[(k + 1) % polygon.len()];
        let (va, vb) = (value(*a), value(b));
        if va >= 0.0 {
            kept.push(*a);
        }
        if (va >= 0.0) != (vb >= 0.0) {
            let t = va / (va - vb);
            kept.push([a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]);
        }
    }
    kept
}

/// A filled cell of a random light colour, with its border.
fn cell(world: &mut String, polygon: &[Point], rng: &mut Rng) {
    if polygon.len() < 3 {
        return;
    }
    let color = [0.35, 0.35, 0.35].map(|least| least + 0.5 * rng.next_f32());
    let corners: Vec<f32> = polygon.iter().flat_map(|[x, y]| [x + 0.05, *y, 0.01]).collect();
    let fan: Vec<String> = (1..polygon.len() - 1).map(|k| format!("0 {k} {}", k + 1)).collect();
    let _ = write!(
        world,
        "Material \"diffuse\" \"rgb reflectance\" [ {} ]\nShape \"trianglemesh\" \"point3 P\" [ {} ]\n  \"integer indices\" [ {} ]\n",
        numbers(&color),
        numbers(&corners),
        fan.join("  ")
    );
    for (k, a) in polygon.iter().enumerate() {
        line(world, shift(*a, 0.05), shift(polygon[(k + 1) % polygon.len()], 0.05));
    }
}

const LINE_WIDTH: f32 = 0.005;

fn line(world: &mut String, a: Point, b: Point) {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let length = dx.hypot(dy);
    if length == 0.0 {
        return;
    }
    let (nx, ny) = (-0.5 * LINE_WIDTH * dy / length, 0.5 * LINE_WIDTH * dx / length);
    let corners = [
        a[0] + nx,
        a[1] + ny,
        0.02,
        b[0] + nx,
        b[1] + ny,
        0.02,
        a[0] - nx,
        a[1] - ny,
        0.02,
        b[0] - nx,
        b[1] - ny,
        0.02,
    ];
    let _ = write!(
        world,
        "Material \"diffuse\" \"rgb reflectance\" [ 0.05 0.05 0.05 ]\nShape \"bilinearmesh\" \"point3 P\" [ {} ]\n",
        numbers(&corners)
    );
}

fn dot(world: &mut String, [x, y]: Point) {
    let _ = write!(
        world,
        "Material \"diffuse\" \"rgb reflectance\" [ 0.5 0.02 0.02 ]\nAttributeBegin\n  Translate {x} {y} 0.03\n  Shape \"disk\" \
         \"float radius\" [ 0.009 ]\nAttributeEnd\n"
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cells of Voronoi are as many as points, each holds its own, and together they fill the square; both drawings have all of it.
    #[test]
    fn cells_fill_the_square() {
        for photons in ["even", "caustic"] {
            let files = GENERATOR.generate([("photons", photons), ("points", "40")]);
            let files = files.unwrap_or_else(|error| panic!("{error}")).0;
            let svg = String::from_utf8_lossy(&files[1].bytes).into_owned();
            assert_eq!(svg.matches("<polygon").count(), 40);
            assert_eq!(svg.matches("<circle").count(), 80);
            assert_eq!(svg.matches("<path").count(), 40 + 4, "a cut for each point, and the border");
            let mut sum = 0.0;
            for polygon in svg.split("points=\"").skip(1) {
                let corners: Vec<Point> =
                    polygon.split('"').next().unwrap_or_default().split(' ').map(point).collect();
                let area = |k: usize| {
                    let ([a, b], [c, d]) = (corners[k], corners[(k + 1) % corners.len()]);
                    0.5 * (a * d - b * c)
                };
                sum += (0..corners.len()).map(area).sum::<f32>().abs();
            }
            // Corners have four digits.
            assert!((sum - 1.0).abs() < 5e-3, "{sum}");
        }
    }

    fn point(text: &str) -> Point {
        let numbers: Vec<f32> = text.split(',').map(|n| n.parse().expect("a number")).collect();
        [numbers[0], numbers[1]]
    }
}
