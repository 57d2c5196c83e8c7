//! Charts of directions, for projection maps: one or two unit squares, of which equal areas are equal shares of the sphere or, for
//! flat lamps, of its cosine-weighted half.
//!
//! A square is mapped to a disk by concentric squares (Shirley and Chiu 1997), and the disk to a cap of the sphere by Lambert's
//! equal-area projection, `1 - cos = k r^2`, or by the orthographic one, `sin = s r` (Nusselt). Cells are then patches between two
//! angles to the axis and two azimuths, and a cone that surely holds a patch has a short formula.

use etendue_math::{Frame, ONE_MINUS_EPSILON, Point2, Vector3, warp};
use etendue_scene::light::Directions;
use std::f32::consts::PI;

/// A chart.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chart {
    frame: Frame,
    projection: Projection,
    /// True if there is a second square for the other half of the sphere.
    has_other_half: bool,
}

#[derive(Clone, Copy, Debug)]
enum Projection {
    /// `1 - cos = k r^2`, with k at most 1.
    EqualArea { k: f32 },
    /// `sin = s r`.
    Cosine { sin_max: f32 },
}

impl Chart {
    /// The chart of a light's directions, if they do not depend on the place.
    pub(super) fn of(directions: Directions) -> Option<Self> {
        match directions {
            Directions::Cone { axis, cos_max } if cos_max >= 0.0 => Some(Self {
                frame: Frame::from_z(axis),
                projection: Projection::EqualArea { k: (1.0 - cos_max).max(1e-7) },
                has_other_half: false,
            }),
            Directions::Sphere | Directions::Cone { .. } => Some(Self::SPHERE),
            Directions::Cosine { axis, cos_max, two_sided } => Some(Self {
                frame: Frame::from_z(axis),
                projection: Projection::Cosine { sin_max: (1.0 - cos_max * cos_max).max(0.0).sqrt() },
                has_other_half: two_sided,
            }),
            Directions::Parallel(_) | Directions::Varied => None,
        }
    }

    /// All directions.
    pub(super) const SPHERE: Self = Self {
        frame: Frame {
            x: Vector3::new(1.0, 0.0, 0.0),
            y: Vector3::new(0.0, 1.0, 0.0),
            z: Vector3::new(0.0, 0.0, 1.0),
        },
        projection: Projection::EqualArea { k: 1.0 },
        has_other_half: true,
    };

    /// The directions within an angle of an axis, at most a right one.
    pub(super) fn cone(axis: Vector3, angle: f32) -> Self {
        let sine = (0.5 * angle).sin();
        let projection = Projection::EqualArea { k: 2.0 * sine * sine };
        Self { frame: Frame::from_z(axis), projection, has_other_half: false }
    }

    /// Unit squares, side by side along x.
    pub(super) const fn n_squares(&self) -> usize {
        if self.has_other_half { 2 } else { 1 }
    }

    /// The direction at a place.
    pub(super) fn direction(&self, place: Point2) -> Vector3 {
        let is_other = place.x >= 1.0 && self.has_other_half;
        let x = if is_other { place.x - 1.0 } else { place.x };
        let d = warp::sample_concentric_disk(Point2::new(x, place.y));
        let r2 = d.x * d.x + d.y * d.y;
        let (scale, z) = match self.projection {
            Projection::EqualArea { k } => ((k * (2.0 - k * r2)).max(0.0).sqrt(), 1.0 - k * r2),
            Projection::Cosine { sin_max } => (sin_max, (1.0 - sin_max * sin_max * r2).max(0.0).sqrt()),
        };
        self.frame.to_world(Vector3::new(d.x * scale, d.y * scale, if is_other { -z } else { z }))
    }

    /// The place of a unit direction; `None` beyond the chart.
    pub(super) fn place(&self, w: Vector3) -> Option<Point2> {
        let local = self.frame.to_local(w);
        let is_other = local.z < 0.0;
        let sine2 = local.x * local.x + local.y * local.y;
        let r2 = match self.projection {
            Projection::EqualArea { k } => sine2 / (1.0 + local.z.abs()) / k,
            Projection::Cosine { sin_max } => sine2 / (sin_max * sin_max),
        };
        if is_other && !self.has_other_half || r2 > 1.0 + 1e-5 {
            return None;
        }
        let scale = if sine2 > 0.0 { (r2.min(1.0) / sine2).sqrt() } else { 0.0 };
        let place = warp::invert_concentric_disk(Point2::new(local.x * scale, local.y * scale));
        Some(Point2::new(if is_other { 1.0 + place.x } else { place.x }, place.y))
    }

    /// Area of the chart per steradian at a direction.
    pub(super) fn density(&self, w: Vector3) -> f32 {
        match self.projection {
            Projection::EqualArea { k } => 1.0 / (2.0 * PI * k),
            Projection::Cosine { sin_max } => w.dot(self.frame.z).abs() / (PI * sin_max * sin_max),
        }
    }

    /// Axis and half angle of a cone that holds the directions of a cell of a square that is cut into `n` by `n`, n even.
    pub(super) fn cell_cone(&self, [column, row]: [usize; 2], n: usize) -> (Vector3, f32) {
        let (is_other, column) = (column >= n, column % n);
        // Coordinates from the middle of the square, of which the nearer end of a cell comes first.
        let ends = |i: usize| {
            let [a, b] = [i, i + 1].map(|i| 2.0 * i as f32 / n as f32 - 1.0);
            if a.abs() < b.abs() { [a, b] } else { [b, a] }
        };
        let (x, y) = (ends(column), ends(row));
        let angle_at = |r: f32| match self.projection {
            Projection::EqualArea { k } => 2.0 * ((0.5 * k).sqrt() * r).min(1.0).asin(),
            Projection::Cosine { sin_max } => (sin_max * r).min(1.0).asin(),
        };
        let near = angle_at(x[0].abs().max(y[0].abs()));
        let far = angle_at(x[1].abs().max(y[1].abs()));
        // The azimuth is extreme where one coordinate is nearest and the other farthest.
        let azimuth = |x: f32, y: f32| {
            let unit = |t: f32| (0.5 * (t + 1.0)).clamp(0.0, ONE_MINUS_EPSILON);
            let d = warp::sample_concentric_disk(Point2::new(unit(x), unit(y)));
            d.y.atan2(d.x)
        };
        let first = azimuth(x[1], y[0]);
        let mut turn = azimuth(x[0], y[1]) - first;
        if turn.abs() > PI {
            turn -= turn.signum() * 2.0 * PI;
        }
        let (theta, phi) = (0.5 * (near + far), first + 0.5 * turn);
        let ((sin, cos), (y, x)) = (theta.sin_cos(), phi.sin_cos());
        let axis = Vector3::new(sin * x, sin * y, if is_other { -cos } else { cos });
        // Along the meridian, then along a circle no larger than the largest.
        let largest = if far > 0.5 * PI { 1.0 } else { far.sin() };
        let radius = 0.5 * (far - near) + 0.5 * turn.abs() * largest;
        (self.frame.to_world(axis), radius * 1.0001 + 1e-5)
    }
}

#[cfg(test)]
mod tests {
    use etendue_math::Rng;

    use super::*;

    fn charts() -> Vec<Chart> {
        let axis = Vector3::new(0.3, -0.5, 0.8).normalized();
        [
            Directions::Sphere,
            Directions::Cone { axis, cos_max: 0.999 },
            Directions::Cone { axis, cos_max: 0.3 },
            Directions::Cone { axis, cos_max: -0.4 },
            Directions::Cosine { axis, cos_max: 0.0, two_sided: false },
            Directions::Cosine { axis, cos_max: 0.5, two_sided: true },
        ]
        .map(|directions| Chart::of(directions).expect("they do not depend on the place"))
        .into_iter()
        .chain([Chart::cone(axis, 0.4)])
        .collect()
    }

    /// Places and directions belong to each other, and areas of the chart are shares of the sphere by the stated density.
    #[test]
    fn charts_are_inverted() {
        for chart in charts() {
            let (mut rng, mut solid_angle) = (Rng::new(1, 7), 0.0);
            let n = 20_000;
            for _ in 0..n {
                let place = Point2::new(rng.next_f32() * chart.n_squares() as f32, rng.next_f32());
                let w = chart.direction(place);
                assert!((w.length() - 1.0).abs() < 1e-5);
                let found = chart.place(w).expect("it is on the chart");
                assert!(
                    (found.x - place.x).abs() < 2e-3 && (found.y - place.y).abs() < 2e-3,
                    "{place:?} {found:?}"
                );
                solid_angle += f64::from(chart.n_squares() as f32 * chart.density(w).powi(-1)) / f64::from(n);
            }
            if let Projection::EqualArea { k } = chart.projection {
                let expected = 2.0 * f64::from(PI * k) * chart.n_squares() as f64;
                assert!((solid_angle / expected - 1.0).abs() < 1e-4);
            }
        }
    }

    /// No direction of a cell lies outside of its cone, and cones are not much larger than cells.
    #[test]
    fn cones_hold_their_cells() {
        let n = 16;
        for chart in charts() {
            let mut rng = Rng::new(2, 7);
            for column in 0..n * chart.n_squares() {
                for row in 0..n {
                    let (axis, angle) = chart.cell_cone([column, row], n);
                    for i in 0..40 {
                        let (x, y) = match i {
                            0..4 => ((i % 2) as f32 * 0.9999, (i / 2) as f32 * 0.9999),
                            _ => (rng.next_f32(), rng.next_f32()),
                        };
                        let place = Point2::new((column as f32 + x) / n as f32, (row as f32 + y) / n as f32);
                        let off = chart.direction(place).angle_between(axis);
                        assert!(off <= angle, "{off} beyond {angle} in cell {column} {row} of {chart:?}");
                    }
                    assert!(angle < 0.6, "{angle} at {column} {row} of {chart:?}");
                }
            }
        }
    }
}
