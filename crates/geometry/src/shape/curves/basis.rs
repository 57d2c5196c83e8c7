//! From control points in several bases to cubic Bézier curves.

use etendue_math::Point3;

/// How control points make a curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CurveBasis {
    /// Bézier curves that share their ends.
    #[default]
    Bezier,
    /// A uniform B-spline.
    BSpline,
}

/// The cubic Bézier curves of a polygon of control points of degree 2 or 3; `None` if their number does not fit.
#[must_use]
pub fn bezier_segments(points: &[Point3], degree: usize, basis: CurveBasis) -> Option<Vec<[Point3; 4]>> {
    if !(2..=3).contains(&degree) || points.len() <= degree {
        return None;
    }
    let step = match basis {
        CurveBasis::Bezier if !(points.len() - 1).is_multiple_of(degree) => return None,
        CurveBasis::Bezier => degree,
        CurveBasis::BSpline => 1,
    };
    let starts = (0..points.len() - degree).step_by(step);
    Some(starts.map(|start| cubic(&points[start..=start + degree], basis)).collect())
}

fn cubic(points: &[Point3], basis: CurveBasis) -> [Point3; 4] {
    match (basis, points) {
        (CurveBasis::Bezier, &[a, b, c]) => raised([a, b, c]),
        (CurveBasis::BSpline, &[a, b, c]) => raised([a.lerp(b, 0.5), b, b.lerp(c, 0.5)]),
        (CurveBasis::BSpline, &[a, b, c, d]) => {
            let (ab, bc, cd) =
                (a.lerp(b, 2.0 / 3.0), [b.lerp(c, 1.0 / 3.0), b.lerp(c, 2.0 / 3.0)], c.lerp(d, 1.0 / 3.0));
            [ab.lerp(bc[0], 0.5), bc[0], bc[1], bc[1].lerp(cd, 0.5)]
        }
        _ => std::array::from_fn(|k| points[k.min(points.len() - 1)]),
    }
}

/// The cubic that is this quadratic.
fn raised([a, b, c]: [Point3; 3]) -> [Point3; 4] {
    [a, a.lerp(b, 2.0 / 3.0), c.lerp(b, 2.0 / 3.0), c]
}
