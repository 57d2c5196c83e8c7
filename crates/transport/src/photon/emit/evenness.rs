//! Photons of equal power from lights of any profile (SPEC EMI-8).
//!
//! A light turns two points of the unit square, of place and of direction, into a ray. Where the flux of rays differs, as for lamps with
//! pictures, skies, or surroundings of a scene that is flatter from one side, a coarse table of the mean flux over each square
//! draws the points: rays of much flux become frequent in place of strong. What the tables leave uneven, flux makes up for,
//! which is divided by their density; no part of the square has less than a tenth of its share.

use etendue_math::{Bounds2, PiecewiseConstant2, Point2, Rng};

/// Cells along the side of a table.
const SIDE: usize = 32;

/// Looks at each cell, in each of which the other point lies in one of as many strata, 4 by 4.
const LOOKS_SIDE: usize = 4;

/// The part of the density that is the same everywhere.
const FLOOR: f32 = 0.1;

/// Relative deviation of flux below which a table does not pay.
const EVEN_ENOUGH: f64 = 0.02;

/// Densities of the points that a light is asked with.
#[derive(Clone, Debug, Default)]
pub(super) struct Evenness {
    position: Option<PiecewiseConstant2>,
    direction: Option<PiecewiseConstant2>,
}

impl Evenness {
    /// Looks at the flux that a pair of points gives, 0 for none.
    pub(super) fn measure(flux: &dyn Fn([Point2; 2]) -> f32) -> Self {
        let position = table(&|u, other| flux([u, other]), 1);
        let direction = table(&|u, other| flux([other, u]), 2);
        let both = Self { position, direction };
        if both.position.is_none() && both.direction.is_none() {
            return both;
        }
        let one = |position: bool| Self {
            position: both.position.clone().filter(|_| position),
            direction: both.direction.clone().filter(|_| !position),
        };
        let ways = [Self::default(), one(true), one(false), both.clone()];
        let deviations = ways.each_ref().map(|way| way.deviation(flux));
        let best = (0..ways.len()).min_by(|a, b| deviations[*a].total_cmp(&deviations[*b])).unwrap_or(0);
        ways.into_iter().nth(best).unwrap_or_default()
    }

    /// The points to ask with, and the density that their flux is divided by.
    pub(super) fn draw(&self, [position, direction]: [Point2; 2]) -> ([Point2; 2], f32) {
        let through = |table: &Option<PiecewiseConstant2>, u: Point2| {
            table.as_ref().map_or((u, 1.0), |table| table.sample(u))
        };
        let ((position, p), (direction, q)) =
            (through(&self.position, position), through(&self.direction, direction));
        ([position, direction], p * q)
    }

    /// Relative standard deviation of the flux of photons.
    pub(super) fn deviation(&self, flux: &dyn Fn([Point2; 2]) -> f32) -> f64 {
        let mut rng = Rng::new(0x0e5e, 3);
        let (mut sum, mut squares, n) = (0.0, 0.0, 4096);
        for _ in 0..n {
            let (points, density) = self.draw([rng.next_point2(), rng.next_point2()]);
            let value = f64::from(flux(points)) / f64::from(density);
            sum += value;
            squares += value * value;
        }
        let mean = sum / f64::from(n);
        if mean > 0.0 { (squares / f64::from(n) / (mean * mean) - 1.0).max(0.0).sqrt() } else { 0.0 }
    }
}

/// The table over the first point; `None` if that makes no difference.
fn table(flux: &dyn Fn(Point2, Point2) -> f32, stream: u64) -> Option<PiecewiseConstant2> {
    let mut rng = Rng::new(0x0e5e, stream);
    let cells: Vec<f32> = (0..SIDE * SIDE)
        .map(|cell| {
            let within = |t: f32, i: usize| (i as f32 + t) / SIDE as f32;
            let stratum = |t: f32, i: usize| (i as f32 + t) / LOOKS_SIDE as f32;
            let mut look = |i: usize| {
                let (place, other) = (rng.next_point2(), rng.next_point2());
                let u = Point2::new(within(place.x, cell % SIDE), within(place.y, cell / SIDE));
                flux(u, Point2::new(stratum(other.x, i % LOOKS_SIDE), stratum(other.y, i / LOOKS_SIDE)))
            };
            let n_looks = LOOKS_SIDE * LOOKS_SIDE;
            (0..n_looks).map(&mut look).sum::<f32>() / n_looks as f32
        })
        .collect();
    let n = cells.len() as f64;
    let mean = cells.iter().map(|cell| f64::from(*cell)).sum::<f64>() / n;
    let variance = cells.iter().map(|cell| (f64::from(*cell) - mean).powi(2)).sum::<f64>() / n;
    let is_uneven = mean.is_finite() && mean > 0.0 && variance.sqrt() > EVEN_ENOUGH * mean;
    let mixed: Vec<f32> = cells.iter().map(|cell| cell / mean as f32 * (1.0 - FLOOR) + FLOOR).collect();
    let domain = Bounds2::new(Point2::splat(0.0), Point2::splat(1.0));
    is_uneven.then(|| PiecewiseConstant2::new(&mixed, SIDE, SIDE, domain))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flux that varies by both points becomes nearly even, and its mean stays; an even one is left alone.
    ///
    /// What is left has the variance 0.01 of the noise of the first table (4 of 16 looks lie in the stratum where the flux falls), 0.02
    /// of the row of the second one's cells where it falls, 0.015 of the floor: 0.05 in all, of 1.5.
    #[test]
    fn flux_becomes_even() {
        let varied = |[p, d]: [Point2; 2]| (1.0 + 9.0 * p.x) * if d.y < 0.3 { 4.0 } else { 0.5 };
        let even = Evenness::measure(&varied);
        assert!(even.position.is_some() && even.direction.is_some());
        let before = Evenness::default().deviation(&varied);
        assert!(
            before > 0.8 && even.deviation(&varied) < 0.2 * before,
            "{before} {}",
            even.deviation(&varied)
        );
        let (mut rng, mut sum, n) = (Rng::new(3, 9), 0.0, 20_000);
        for _ in 0..n {
            let (points, density) = even.draw([rng.next_point2(), rng.next_point2()]);
            sum += f64::from(varied(points) / density) / f64::from(n);
        }
        let expected = 5.5 * (0.3 * 4.0 + 0.7 * 0.5);
        let error = 5.0 * expected * even.deviation(&varied) / f64::from(n).sqrt();
        assert!((sum - expected).abs() < error, "{sum} instead of {expected} +- {error}");
        let same = Evenness::measure(&|_| 3.0);
        assert!(same.position.is_none() && same.direction.is_none());
        assert!(Evenness::measure(&|_| 0.0).direction.is_none());
        assert!(Evenness::measure(&|_| f32::NAN).direction.is_none());
    }

    /// A feature that no look finds still has its share.
    #[test]
    fn nothing_is_lost() {
        let spot = |[_, d]: [Point2; 2]| if (d.x - 0.51).abs() < 1e-3 { 1000.0 } else { 1.0 };
        let even = Evenness::measure(&spot);
        let (mut rng, mut sum, n) = (Rng::new(3, 8), 0.0, 400_000);
        for _ in 0..n {
            let (points, density) = even.draw([rng.next_point2(), rng.next_point2()]);
            assert!(density >= FLOOR * FLOOR);
            sum += f64::from(spot(points) / density) / f64::from(n);
        }
        let expected = 1.0 + 999.0 * 2e-3;
        let error = 5.0 * expected * even.deviation(&spot).max(1.0) / f64::from(n).sqrt();
        assert!((sum - expected).abs() < 2.0 * error, "{sum} instead of {expected} +- {error}");
    }
}
