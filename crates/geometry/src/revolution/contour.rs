//! What may be revolved, and the smooth curve through its points.
//!
//! Between neighbouring points both coordinates are cubic in the length of the polygon, with Steffen's slopes (1990, "A Simple
//! Method for Monotonic Interpolation in One Dimension", Astronomy and Astrophysics 239): the curve has a continuous
//! tangent and stays within the box of each pair of points, so that it never overshoots and its radius never becomes
//! negative. At creases it is cut; on the axis it continues as its mirror image.

use std::fmt;

use etendue_math::Point2;
use glam::DVec2;

/// More points are refused: looking for crossings takes quadratic time.
pub const MAX_CONTOUR_POINTS: usize = 10_000;

/// Why a contour cannot be revolved.
#[derive(Clone, Debug, PartialEq)]
pub enum ContourError {
    /// Fewer than two different points.
    TooFew,
    /// More than [`MAX_CONTOUR_POINTS`].
    TooMany {
        /// Number of points.
        found: usize,
    },
    /// A point that is NaN or infinite.
    NotFinite {
        /// Its index.
        point: usize,
    },
    /// A point on the wrong side of the axis.
    NegativeRadius {
        /// Its index.
        point: usize,
        /// Its radius.
        radius: f32,
    },
    /// Two sides of the polygon meet where they should not.
    Crosses {
        /// Index of the first point of one side.
        first: usize,
        /// Index of the first point of the other.
        second: usize,
    },
    /// The tolerance asks for too many triangles.
    TooFine {
        /// How many, in all.
        n_triangles: f64,
    },
}

impl fmt::Display for ContourError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFew => {
                write!(f, "the contour needs at least two different points that are not all on the axis")
            }
            Self::TooMany { found } => {
                write!(f, "the contour has {found} points; at most {MAX_CONTOUR_POINTS} are possible")
            }
            Self::NotFinite { point } => write!(f, "point {point} of the contour is not finite"),
            Self::NegativeRadius { point, radius } => {
                write!(f, "point {point} of the contour has the negative radius {radius}")
            }
            Self::Crosses { first, second } => write!(
                f,
                "the contour meets itself: the side from point {first} to {} and the one from point {second} to {}",
                first + 1,
                second + 1
            ),
            Self::TooFine { n_triangles } => {
                write!(f, "the tolerance asks for {n_triangles:.0} triangles, which are too many")
            }
        }
    }
}

impl std::error::Error for ContourError {}

/// A smooth part of the curve: knots with tangents per length.
#[derive(Clone, Debug, Default)]
pub(super) struct Piece {
    knots: Vec<Knot>,
}

/// A point of the contour, as (height, radius).
#[derive(Clone, Copy, Debug)]
struct Knot {
    p: DVec2,
    /// Length of the polygon up to here.
    s: f64,
    tangent: DVec2,
}

/// A point of the curve as it is revolved.
#[derive(Clone, Copy, Debug)]
pub(super) struct CurvePoint {
    /// (height, radius).
    pub(super) p: DVec2,
    /// Direction of the curve, of any length.
    pub(super) tangent: DVec2,
    /// Length of the polygon up to here.
    pub(super) s: f64,
}

/// Checks a contour of (height, radius) and cuts it at creases, where it turns by more than `crease_rad`.
pub(super) fn smooth_pieces(contour: &[Point2], crease_rad: f64) -> Result<Vec<Piece>, ContourError> {
    check(contour)?;
    let mut points: Vec<DVec2> = contour.iter().map(|p| DVec2::new(p.x.into(), p.y.into())).collect();
    points.dedup();
    if points.len() < 2 || points.iter().all(|p| p.y == 0.0) {
        return Err(ContourError::TooFew);
    }
    let is_closed = points.len() > 3 && points.first() == points.last();
    let last = points.len() - 1;
    // The point before the first and after the last one: around a closed contour, or mirrored in the axis.
    let mirrored = |on_axis: DVec2, next: DVec2| (on_axis.y == 0.0).then(|| DVec2::new(next.x, -next.y));
    let (before, after) = if is_closed && points[0].y > 0.0 {
        (Some(points[last - 1]), Some(points[1]))
    } else {
        (mirrored(points[0], points[1]), mirrored(points[last], points[last - 1]))
    };
    let neighbour = |i: usize, step: isize| match i.checked_add_signed(step) {
        Some(j) if j <= last => Some(points[j]),
        Some(_) => after,
        None => before,
    };
    let is_smooth = |i: usize| {
        let (Some(a), Some(b)) = (neighbour(i, -1), neighbour(i, 1)) else { return false };
        let inner = 0 < i && i < last;
        (points[i] - a).angle_to(b - points[i]).abs() <= crease_rad && (points[i].y > 0.0 || !inner)
    };
    let mut pieces = Vec::new();
    let mut piece = Piece::default();
    let mut s = 0.0;
    for i in 0..=last {
        let smooth = is_smooth(i);
        if i > 0 {
            let step = points[i].distance(points[i - 1]);
            s += step;
            let came = slope(points[i - 1], points[i]);
            let ahead = neighbour(i, 1).filter(|_| smooth).map(|b| slope(points[i], b));
            let tangent = match ahead {
                Some(ahead) => inner_tangent(came, ahead),
                None => end_tangent(came, (i > 1).then(|| slope(points[i - 2], points[i - 1])), &piece),
            };
            piece.knots.push(Knot { p: points[i], s, tangent });
            // A side that lies on the axis has no surface.
            let is_on_axis = points[i].y == 0.0 && points[i - 1].y == 0.0;
            if is_on_axis {
                piece.knots.clear();
            }
        }
        if i < last && (piece.knots.is_empty() || !smooth) {
            finish(&mut pieces, &mut piece);
            let leaves = slope(points[i], points[i + 1]);
            let came = neighbour(i, -1).filter(|_| smooth).map(|a| slope(a, points[i]));
            let tangent = match came {
                Some(came) => inner_tangent(came, leaves),
                None => start_tangent(leaves, neighbour(i, 2).filter(|_| is_smooth(i + 1)), points[i + 1]),
            };
            piece.knots.push(Knot { p: points[i], s, tangent });
        }
    }
    finish(&mut pieces, &mut piece);
    Ok(pieces)
}

fn finish(pieces: &mut Vec<Piece>, piece: &mut Piece) {
    let piece = std::mem::take(piece);
    if piece.knots.len() > 1 {
        pieces.push(piece);
    }
}

/// A side of the polygon: its length, and the slopes of both coordinates along it.
fn slope(a: DVec2, b: DVec2) -> (f64, DVec2) {
    let length = a.distance(b);
    (length, (b - a) / length)
}

/// Steffen's slopes at a point between two sides. (equation 11 of Steffen 1990)
fn inner_tangent((h0, d0): (f64, DVec2), (h1, d1): (f64, DVec2)) -> DVec2 {
    let parabola = (d0 * h1 + d1 * h0) / (h0 + h1);
    let one = |d0: f64, d1: f64, p: f64| {
        if d0 * d1 <= 0.0 { 0.0 } else { 2.0 * d0.signum() * d0.abs().min(d1.abs()).min(0.5 * p.abs()) }
    };
    let tangent = DVec2::new(one(d0.x, d1.x, parabola.x), one(d0.y, d1.y, parabola.y));
    // Where both coordinates turn back, the curve is sharp whatever its slopes.
    if tangent == DVec2::ZERO { (d0 + d1) * 1e-6 } else { tangent }
}

/// Steffen's slopes at an end: of the parabola through three points, kept within what does not overshoot.
fn outer_tangent((h, d): (f64, DVec2), (h1, d1): (f64, DVec2)) -> DVec2 {
    let parabola = d * (1.0 + h / (h + h1)) - d1 * (h / (h + h1));
    let one = |p: f64, d: f64| {
        if p * d <= 0.0 {
            0.0
        } else if p.abs() > 2.0 * d.abs() {
            2.0 * d
        } else {
            p
        }
    };
    let tangent = DVec2::new(one(parabola.x, d.x), one(parabola.y, d.y));
    if tangent == DVec2::ZERO { d * 1e-6 } else { tangent }
}

fn start_tangent(side: (f64, DVec2), next: Option<DVec2>, end: DVec2) -> DVec2 {
    next.filter(|next| *next != end).map_or(side.1, |next| outer_tangent(side, slope(end, next)))
}

fn end_tangent(side: (f64, DVec2), previous: Option<(f64, DVec2)>, piece: &Piece) -> DVec2 {
    previous.filter(|_| piece.knots.len() > 1).map_or(side.1, |previous| outer_tangent(side, previous))
}

impl Piece {
    /// Points of the curve with chords no farther from it than `tolerance`, in order; only its beginning if those are more
    /// than `most`, but more than that then.
    pub(super) fn flattened(&self, tolerance: f64, most: usize) -> Vec<CurvePoint> {
        let point = |knot: &Knot| CurvePoint { p: knot.p, tangent: knot.tangent, s: knot.s };
        let mut points: Vec<CurvePoint> = self.knots.first().map(point).into_iter().collect();
        for pair in self.knots.windows(2) {
            if points.len() > most {
                break;
            }
            let third = (pair[1].s - pair[0].s) / 3.0;
            let [a, d] = [pair[0].p, pair[1].p];
            let controls = [a, a + pair[0].tangent * third, d - pair[1].tangent * third, d];
            // Without this, rounding may leave a point of the axis beside it.
            flatten(controls, [pair[0].s, pair[1].s], tolerance, (12, most), &mut points);
            if let Some(end) = points.last_mut() {
                *end = point(&pair[1]);
            }
        }
        points
    }
}

/// Appends the end of a Bézier curve, after those of its halves where it is not flat.
/// Ends early once there are more than `most`.
fn flatten(
    controls: [DVec2; 4],
    [s0, s1]: [f64; 2],
    tolerance: f64,
    (depth, most): (u32, usize),
    out: &mut Vec<CurvePoint>,
) {
    if out.len() > most {
        return;
    }
    let [a, b, c, d] = controls;
    let chord = d - a;
    let length = chord.length();
    let distance = |p: DVec2| if length > 0.0 { chord.perp_dot(p - a).abs() / length } else { p.distance(a) };
    // A cubic is no farther from its chord than 3/4 of its farther inner control point.
    if depth == 0 || 0.75 * distance(b).max(distance(c)) <= tolerance {
        let tangent = if d == c { d - b } else { d - c };
        out.push(CurvePoint { p: d, tangent, s: s1 });
        return;
    }
    let middle = |p: DVec2, q: DVec2| (p + q) * 0.5;
    let (ab, bc, cd) = (middle(a, b), middle(b, c), middle(c, d));
    let (abc, bcd) = (middle(ab, bc), middle(bc, cd));
    let m = middle(abc, bcd);
    let s = 0.5 * (s0 + s1);
    flatten([a, ab, abc, m], [s0, s], tolerance, (depth - 1, most), out);
    flatten([m, bcd, cd, d], [s, s1], tolerance, (depth - 1, most), out);
}

fn check(contour: &[Point2]) -> Result<(), ContourError> {
    if contour.len() > MAX_CONTOUR_POINTS {
        return Err(ContourError::TooMany { found: contour.len() });
    }
    if let Some(point) = contour.iter().position(|p| !p.is_finite()) {
        return Err(ContourError::NotFinite { point });
    }
    if let Some(point) = contour.iter().position(|p| p.y < 0.0) {
        return Err(ContourError::NegativeRadius { point, radius: contour[point].y });
    }
    match crossing(contour) {
        Some((first, second)) => Err(ContourError::Crosses { first, second }),
        None => Ok(()),
    }
}

/// Two sides of the polygon that have a point in common which is no corner of both.
fn crossing(contour: &[Point2]) -> Option<(usize, usize)> {
    let points: Vec<DVec2> = contour.iter().map(|p| DVec2::new(p.x.into(), p.y.into())).collect();
    let sides: Vec<usize> =
        (0..points.len().saturating_sub(1)).filter(|&i| points[i] != points[i + 1]).collect();
    for (k, &i) in sides.iter().enumerate() {
        let (a, b) = (points[i], points[i + 1]);
        let (lower, upper) = (a.min(b), a.max(b));
        for &j in &sides[k + 1..] {
            let (c, d) = (points[j], points[j + 1]);
            let apart = c.min(d).cmpgt(upper).any() || c.max(d).cmplt(lower).any();
            if !apart && meet([a, b], [c, d]) {
                return Some((i, j));
            }
        }
    }
    None
}

/// True if two segments have a point in common; a common end counts only where they run along each other.
fn meet([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let side = |p: DVec2| (b - a).perp_dot(p - a);
    let other = |p: DVec2| (d - c).perp_dot(p - c);
    if b == c || a == d || a == c || b == d {
        let (shared, p, q) = if b == c {
            (b, a, d)
        } else if a == d {
            (a, b, c)
        } else if a == c {
            (a, b, d)
        } else {
            (b, a, c)
        };
        return (p - shared).perp_dot(q - shared) == 0.0 && (p - shared).dot(q - shared) > 0.0;
    }
    let (c1, d1, a1, b1) = (side(c), side(d), other(a), other(b));
    if c1 == 0.0 && d1 == 0.0 {
        // On one line, and their boxes meet.
        return true;
    }
    c1 * d1 <= 0.0 && a1 * b1 <= 0.0
}
