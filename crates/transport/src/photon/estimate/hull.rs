//! The convex hull of photons in the tangent plane: the area that they really come from where a wall cuts the disc (SPEC EST-7).
//!
//! Jensen divides by the area of the hull in place of that of the disc. The hull of `n` points lies within the area that they
//! come from, and lacks about `3.4 n^(-2/3)` of a disc (Rényi and Sulanke 1963), a quarter for 50 points: all surfaces come out
//! too bright. But given the hull of a Poisson process in a convex window, the points in its *inside* are such a process again:
//! they know nothing of the hull. So their number over the hull's area is an unbiased estimate of the density
//!
//! ```text
//! E[(n - v) / A_hull] = density        v: corners of the hull
//! ```
//!
//! (Baldin and Reiß 2016, "Unbiased estimation of the volume of a convex body"). As this holds for each density, it holds for
//! each number `n >= 4` of uniform points by itself: the coefficients of the power series in the density agree. The corners define
//! the area and do not count, as the farthest photon defines the radius and does not count. In corners of rooms the estimate is
//! then exact, where discs darken to a quarter.

use etendue_math::Point2;

use super::filter::Filter;
use super::volume::Volume;

/// A photon in the tangent plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PlanePhoton {
    /// Place relative to the point of the estimate, in metres.
    pub(super) p: Point2,
    /// Its index in the map.
    pub(super) index: u32,
    /// Squared distance by the measure of the volume.
    pub(super) distance_squared: f32,
    pub(super) is_corner: bool,
}

/// Twice the signed area of the triangle `o a b`.
fn cross(o: Point2, a: Point2, b: Point2) -> f32 {
    (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x)
}

/// Sorts the photons, marks the corners of their hull, and leaves the corners' indices in `hull`, counterclockwise (Andrew 1979,
/// "Another efficient algorithm for convex hulls in two dimensions").
pub(super) fn mark_corners(photons: &mut [PlanePhoton], hull: &mut Vec<u32>) {
    hull.clear();
    photons.sort_unstable_by(|a, b| {
        a.p.x.total_cmp(&b.p.x).then(a.p.y.total_cmp(&b.p.y)).then(a.index.cmp(&b.index))
    });
    let n = photons.len() as u32;
    extend(photons, hull, 0..n);
    hull.pop();
    extend(photons, hull, (0..n).rev());
    hull.pop();
    for corner in &*hull {
        photons[*corner as usize].is_corner = true;
    }
}

/// Adds the half of the hull that turns left along these photons.
fn extend(photons: &[PlanePhoton], hull: &mut Vec<u32>, order: impl Iterator<Item = u32>) {
    let start = hull.len();
    for next in order {
        while let [.., a, b] = hull[start..] {
            let [a, b, c] = [a, b, next].map(|i| photons[i as usize].p);
            if cross(a, b, c) > 0.0 {
                break;
            }
            hull.pop();
        }
        hull.push(next);
    }
}

/// Integral of the filter over the hull, in square metres; for a constant filter its area. Each edge makes a triangle with the
/// middle of the filter, whose integral is that of the mean over discs: `∫ (a x b)/2 mean(|p(s)|^2 / r^2) ds` along the edge, where
/// the length of `p` is by the measure of the volume.
pub(super) fn integral(
    photons: &[PlanePhoton],
    hull: &[u32],
    (filter, volume): (Filter, Volume),
    radius_squared: f32,
) -> f32 {
    /// Gauss's rule with three points on [0, 1].
    const RULE: [(f32, f32); 3] = [(0.112_701_67, 5.0 / 18.0), (0.5, 4.0 / 9.0), (0.887_298_35, 5.0 / 18.0)];
    let corner = |i: usize| photons[hull[i % hull.len()] as usize].p;
    let edge = |i: usize| {
        let (a, b) = (corner(i), corner(i + 1));
        let mean_at = |s: f32| {
            let (x, y) = (a.x + s * (b.x - a.x), a.y + s * (b.y - a.y));
            filter.mean(volume.plane_distance_squared(x, y) / radius_squared)
        };
        let mean: f32 = match filter {
            Filter::Constant => 1.0,
            _ => RULE.iter().map(|(s, weight)| weight * mean_at(*s)).sum(),
        };
        0.5 * (a.x * b.y - a.y * b.x) * mean
    };
    (0..hull.len()).map(edge).sum()
}
