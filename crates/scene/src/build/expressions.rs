//! Shapes that bring their formula along: implicit and parametric surfaces.

use etendue_geometry::{ImplicitSurface, ParametricSurface, Shape, tessellate};
use etendue_math::expression::Expression;
use etendue_math::{Bounds3, Point3};

use crate::diagnostics::nearest_name;
use crate::parameters::{ParameterSpec, Parameters, spec};

use super::shapes::{ALPHA, positive};

/// More triangles than this no formula may make.
const MAX_TRIANGLES: u32 = 1 << 24;

pub(super) const IMPLICIT: &[ParameterSpec] = &[
    spec(
        "function",
        "string",
        "",
        "",
        "formula in x, y and z; the surface is where it is 0, the inside where it is negative",
    ),
    spec(
        "bounds",
        "point3",
        "-1 -1 -1  1 1 1",
        "m",
        "two opposite corners of the box where the surface is looked for",
    ),
    spec(
        "radius",
        "float",
        "",
        "m",
        "the surface ends at this distance from the origin; without bounds, their half side too",
    ),
    spec("sdf", "bool", "false", "", "the formula is a distance with a sign: its slope is bounded"),
    spec("lipschitz", "float", "1", "", "largest slope of such a formula"),
    ALPHA,
];
pub(super) const PARAMETRIC: &[ParameterSpec] = &[
    spec("x", "string", "", "m", "formula of x in u and v"),
    spec("y", "string", "", "m", "formula of y"),
    spec("z", "string", "", "m", "formula of z"),
    spec("urange", "float", "0 1", "", "where u begins and ends"),
    spec("vrange", "float", "0 1", "", "where v begins and ends"),
    spec(
        "tolerance",
        "float",
        "1/2000 of the size",
        "m",
        "largest distance of the triangles from the surface",
    ),
    spec("maxtriangles", "integer", "1000000", "", "most triangles, at most 16777216"),
    ALPHA,
];

/// A formula of a shape. Names that it does not know may be numbers among the parameters of the shape.
fn read_formula(p: &mut Parameters<'_, '_>, name: &'static str, variables: &[&str]) -> Option<Expression> {
    let Some(text) = p.string_opt(name) else {
        let message = format!("\"{}\" needs a formula: \"string {name}\"", p.entity().type_name);
        p.missing(name, message);
        return None;
    };
    let result = Expression::parse(&text, variables, &mut |word| p.named_number(word).map(f64::from));
    let error = match result {
        Ok(expression) => return Some(expression),
        Err(error) => error,
    };
    let span = p.span_of(name);
    let numbers = p.number_names();
    let problem = p.diagnostics().error(span, format!("\"{name}\", {error}"));
    if let Some(unknown) = &error.unknown {
        let known = error.known.iter().map(String::as_str).chain(numbers.iter().map(String::as_str));
        problem.with_help(match nearest_name(unknown, known) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None => format!("known are: {}; or give \"float {unknown}\"", error.known.join(", ")),
        });
    }
    p.accept_all();
    None
}

/// The box in which an implicit surface is looked for, and how far from the origin it ends.
fn read_bounds(p: &mut Parameters<'_, '_>) -> Option<(Bounds3, Option<f32>)> {
    let radius = p.has("radius").then(|| positive(p, "radius", 1.0));
    let half = radius.unwrap_or(1.0);
    let whole = Bounds3 { min: Point3::splat(-half), max: Point3::splat(half) };
    let Some(corners) = p.points3("bounds") else { return Some((whole, radius)) };
    let span = p.span_of("bounds");
    let &[a, b] = corners else {
        p.diagnostics().error(span, format!("\"bounds\" are two points, not {}", corners.len()));
        return None;
    };
    let size = b - a;
    if !(a.is_finite() && b.is_finite() && size.x > 0.0 && size.y > 0.0 && size.z > 0.0) {
        let message =
            "\"bounds\" must be two corners of a box, the second greater than the first in x, y and z";
        p.diagnostics().error(span, message);
        return None;
    }
    Some((Bounds3 { min: a, max: b }, radius))
}

/// The zeros of a formula (SPEC GEO-5).
pub(super) fn read_implicit(p: &mut Parameters<'_, '_>) -> Option<Shape> {
    let is_distance = p.bool("sdf", false);
    let lipschitz = positive(p, "lipschitz", 1.0);
    let bounds = read_bounds(p);
    let function = read_formula(p, "function", &["x", "y", "z"])?;
    let (bounds, radius) = bounds?;
    let span = p.span_of("function");
    if let Some(value) = function.constant() {
        let message = format!("\"function\" is {value} everywhere: it needs x, y or z");
        p.diagnostics().error(span, message);
        return None;
    }
    let surface = ImplicitSurface::new(function, bounds, radius, is_distance.then_some(lipschitz));
    if surface.is_empty() {
        let message = "\"function\" is zero nowhere within the bounds; nothing is there";
        p.diagnostics()
            .warning(span, message)
            .with_help("look at \"bounds\", and whether the formula is defined there");
    }
    Some(Shape::Implicit(surface))
}

/// A range of u or v.
fn read_range(p: &mut Parameters<'_, '_>, name: &'static str) -> [f64; 2] {
    let values = p.floats(name).unwrap_or(&[0.0, 1.0]);
    match *values {
        [a, b] if a != b && a.is_finite() && b.is_finite() => [a.into(), b.into()],
        _ => {
            let span = p.span_of(name);
            p.diagnostics().error(span, format!("\"{name}\" must be two different numbers"));
            [0.0, 1.0]
        }
    }
}

/// A surface of u and v, as triangles (SPEC GEO-7).
pub(super) fn read_parametric(p: &mut Parameters<'_, '_>) -> Option<Shape> {
    let (u, v) = (read_range(p, "urange"), read_range(p, "vrange"));
    let tolerance = p.has("tolerance").then(|| f64::from(positive(p, "tolerance", 1.0)));
    let max_triangles = p.count_within("maxtriangles", 1_000_000, 128, MAX_TRIANGLES) as usize;
    let formulas = ["x", "y", "z"].map(|name| read_formula(p, name, &["u", "v"]));
    let [Some(x), Some(y), Some(z)] = formulas else { return None };
    let surface = ParametricSurface { position: [x, y, z], u, v, tolerance, max_triangles };
    let made = tessellate(&surface);
    let span = p.span_of("x");
    if made.mesh.indices.is_empty() {
        let message = "the formulas have no area, or are not defined; nothing is there";
        p.diagnostics().warning(span, message);
        return None;
    }
    if made.error > made.tolerance {
        let message = format!(
            "{} triangles deviate from the surface by {:.2e} m, more than the tolerance of {:.2e} m",
            made.mesh.indices.len(),
            made.error,
            made.tolerance
        );
        let help = "raise \"tolerance\", or \"maxtriangles\" where the surface is smooth";
        p.diagnostics().warning(span, message).with_help(help);
    }
    Some(Shape::Triangles(made.mesh))
}
