//! Curves: from parameters to shapes, with neighbours of the same attributes in one.

use etendue_geometry::{Curve, CurveBasis, CurveKind, CurveSet, bezier_segments};
use etendue_math::Normal3;

use crate::controls::SHAPE_CONTROLS;
use crate::document::{ShapeEntity, Value};
use crate::parameters::{ParameterSpec, Parameters, spec};

use super::emitters::parameter;
use super::shapes::ALPHA;

/// Parameters of `curve`.
pub(super) const CURVE: &[ParameterSpec] = &[
    spec("P", "point3", "", "m", "control points"),
    spec("type", "string", "flat", "", "flat or cylinder, which face the ray, or ribbon, which faces N"),
    spec("basis", "string", "bezier", "", "bezier or bspline"),
    spec("degree", "integer", "3", "", "2 or 3"),
    spec("width", "float", "1", "m", "width from end to end"),
    spec("width0", "float", "width", "m", "width at the start"),
    spec("width1", "float", "width", "m", "width at the end"),
    spec("N", "normal", "", "", "of ribbons: a normal for each end of a segment"),
    spec(
        "splitdepth",
        "integer",
        "3",
        "",
        "the hierarchy holds 2 to this power pieces of each segment; at most 6",
    ),
    ALPHA,
];

/// True if two shapes are curves that one geometry can hold.
pub(super) fn belong_together(a: &ShapeEntity, b: &ShapeEntity) -> bool {
    let is_plain = |shape: &ShapeEntity| shape.entity.type_name == "curve" && shape.area_light.is_none();
    is_plain(a)
        && is_plain(b)
        && a.material == b.material
        && a.world_from_object == b.world_from_object
        && a.reverse_orientation == b.reverse_orientation
        && SHAPE_CONTROLS.iter().all(|control| have_same_control(a, b, control.name))
}

/// True if two shapes say the same of a switch. Problems of values are left to where one is read: such shapes stay apart.
fn have_same_control(a: &ShapeEntity, b: &ShapeEntity, name: &str) -> bool {
    match (parameter(a, name), parameter(b, name)) {
        (None, None) => true,
        (Some(Value::Bools(a)), Some(Value::Bools(b))) => a == b,
        (Some(Value::Strings(a)), Some(Value::Strings(b))) => a == b,
        _ => false,
    }
}

pub(super) fn read_curves(p: &mut Parameters<'_, '_>) -> Option<CurveSet> {
    let kinds = [("flat", CurveKind::Flat), ("cylinder", CurveKind::Cylinder), ("ribbon", CurveKind::Ribbon)];
    let kind = p.choice("type", "flat", &kinds);
    let basis =
        p.choice("basis", "bezier", &[("bezier", CurveBasis::Bezier), ("bspline", CurveBasis::BSpline)]);
    let degree = p.integer("degree", 3);
    let width = p.float("width", 1.0);
    let widths = [p.float("width0", width), p.float("width1", width)];
    let split_depth = p.count_within("splitdepth", 3, 0, CurveSet::MAX_SPLIT_DEPTH);
    let normals = p.normals3("N").unwrap_or_default();
    let points = p.points3("P").unwrap_or_default();
    if points.is_empty() {
        p.missing("P", "a curve needs control points \"P\"");
        return None;
    }
    if !(2..=3).contains(&degree) {
        let span = p.span_of("degree");
        p.diagnostics().error(span, format!("\"degree\" must be 2 or 3, not {degree}"));
        return None;
    }
    if widths.iter().any(|w| !(*w >= 0.0 && w.is_finite())) {
        let name = ["width0", "width1", "width"].into_iter().find(|name| p.has(name)).unwrap_or("width");
        let span = p.span_of(name);
        p.diagnostics().error(span, "the width of a curve must be a number that is not negative");
        return None;
    }
    let Some(segments) = bezier_segments(points, degree as usize, basis) else {
        let span = p.span_of("P");
        let rule = match basis {
            CurveBasis::Bezier => format!("{} and a multiple of {degree} more are needed", degree + 1),
            CurveBasis::BSpline => format!("{} or more are needed", degree + 1),
        };
        let message = format!("{} control points make no curve of degree {degree}", points.len());
        p.diagnostics().error(span, message).with_help(rule);
        return None;
    };
    let normals = read_normals(p, kind, normals, segments.len())?;
    let n = segments.len() as f32;
    let width_at = |i: usize| widths[0] + (widths[1] - widths[0]) * (i as f32 / n);
    let curves = segments.into_iter().enumerate().map(|(i, controls)| Curve {
        controls,
        widths: [width_at(i), width_at(i + 1)],
        normals: if kind == CurveKind::Ribbon { [normals[i], normals[i + 1]] } else { Default::default() },
    });
    let set = CurveSet { curves: curves.collect(), kind, split_depth };
    if let Err(error) = set.validate() {
        let span = p.span_of("P");
        p.diagnostics().error(span, error.to_string());
        return None;
    }
    Some(set)
}

/// The normals of a ribbon: one more than segments. Other curves need none.
fn read_normals<'n>(
    p: &mut Parameters<'_, '_>,
    kind: CurveKind,
    normals: &'n [Normal3],
    n_segments: usize,
) -> Option<&'n [Normal3]> {
    let is_ribbon = kind == CurveKind::Ribbon;
    let is_wrong = if is_ribbon { normals.len() != n_segments + 1 } else { !normals.is_empty() };
    if is_wrong {
        let span = p.span_of("N");
        let found = normals.len();
        if is_ribbon {
            let message = format!(
                "a ribbon of {n_segments} segments needs {} normals \"N\", not {found}",
                n_segments + 1
            );
            p.diagnostics().error(span, message);
            return None;
        }
        p.diagnostics()
            .warning(span, "only curves of the type \"ribbon\" have normals \"N\"; they are ignored");
    }
    Some(normals)
}
