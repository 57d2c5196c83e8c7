//! A kd-tree by the surface area heuristic (SPEC ACC-3, ACC-5).
//!
//! A plane divides a cell of area A into parts of areas A1 and A2 that hold n1 and n2 primitives. A ray that meets the cell
//! meets each part with probability Ai / A, so that it costs about
//!
//! C = C_traversal + C_intersect (A1 n1 + A2 n2) / A
//!
//! against `C_intersect n` for a leaf (MacDonald and Booth 1990, "Heuristics for Ray Tracing Using Space Subdivision"). The
//! cost is least at a side of a box, cut off at the cell: all of them are tried, O(n log n) for each cell by sorting
//! them (Wald and Havran 2006, "On Building Fast kd-Trees for Ray Tracing, and on Doing that in O(N log N)"). Parameters are
//! those of pbrt-v4, whose bonus for empty sides makes trees that cut off empty space early.

use super::plane_tree::{Cell, Plane, PlaneTree};
use super::{Build, DivisionSettings, KdTreeSettings};

pub(super) fn build(build: &Build<'_>, settings: &KdTreeSettings) -> PlaneTree {
    let n = build.boxes.len().max(1) as f32;
    let depth = settings.max_depth.unwrap_or((8.0 + 1.3 * n.log2()).round() as u32);
    let depth = depth.min(DivisionSettings::MAX_DEPTH);
    PlaneTree::build(build, &|cell| {
        let is_small = cell.primitives.len() <= settings.max_primitives as usize;
        if is_small || cell.depth >= depth { None } else { best_plane(build, cell, settings) }
    })
}

/// The plane of least cost, if that is less than the cost of a leaf.
fn best_plane(build: &Build<'_>, cell: &Cell, settings: &KdTreeSettings) -> Option<Plane> {
    let n = cell.primitives.len();
    let whole = cell.bounds.half_area();
    let mut best_cost = settings.intersect_cost * n as f32;
    let mut best = None;
    let mut sides = [Vec::with_capacity(n), Vec::with_capacity(n)];
    for axis in 0..3 {
        let extent = [cell.bounds.min[axis], cell.bounds.max[axis]];
        sort_sides(build, &cell.primitives, axis, extent, &mut sides);
        sweep(&sides, extent, |position, n_lower, n_upper| {
            let (mut lower, mut upper) = (cell.bounds, cell.bounds);
            lower.max[axis] = position;
            upper.min[axis] = position;
            let tests = (lower.half_area() * n_lower as f32 + upper.half_area() * n_upper as f32) / whole;
            let is_bonus = n_lower == 0 || n_upper == 0;
            let factor = if is_bonus { 1.0 - settings.empty_bonus } else { 1.0 };
            let cost = settings.traversal_cost + settings.intersect_cost * factor * tests;
            // False for NaN, where a cell is so small that it has no area.
            if cost < best_cost {
                best_cost = cost;
                best = Some(Plane { axis, position });
            }
        });
    }
    best
}

/// Lower and upper sides of the boxes, in order. Flat ones count as a little below: they belong to the lower part.
fn sort_sides(
    build: &Build<'_>,
    primitives: &[u32],
    axis: usize,
    [min, max]: [f32; 2],
    [lower, upper]: &mut [Vec<f32>; 2],
) {
    lower.clear();
    upper.clear();
    for primitive in primitives {
        let bounds = &build.boxes[*primitive as usize];
        let (low, high) = (bounds.min[axis], bounds.max[axis]);
        lower.push(if low < high { low } else { low.next_down() }.max(min));
        upper.push(high.min(max));
    }
    lower.sort_unstable_by(f32::total_cmp);
    upper.sort_unstable_by(f32::total_cmp);
}

/// Visits every side of a box within the extent with the numbers of primitives that a plane there would leave below and above.
fn sweep([lower, upper]: &[Vec<f32>; 2], [min, max]: [f32; 2], mut visit: impl FnMut(f32, usize, usize)) {
    let n = lower.len();
    // Boxes that begin below the position, and boxes that end at it or below.
    let (mut n_begun, mut n_ended) = (0, 0);
    loop {
        let next = match (lower.get(n_begun), upper.get(n_ended)) {
            (Some(a), Some(b)) => a.min(*b),
            (None, Some(b)) => *b,
            _ => return,
        };
        while n_ended < n && upper[n_ended] <= next {
            n_ended += 1;
        }
        if min < next && next < max {
            visit(next, n_begun, n - n_ended);
        }
        while n_begun < n && lower[n_begun] <= next {
            n_begun += 1;
        }
    }
}
