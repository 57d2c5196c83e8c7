//! Pairs of triangles that share an edge.
//!
//! The hierarchy holds pairs where it can: they halve the primitives of a build, need the memory of four corners
//! instead of six, and their box is hardly larger than that of one of them. Meshes mostly name neighbours one after
//! the other, so that partners are sought among the next few triangles alone.

use std::ops::Range;

use super::PrimitiveRef;
use super::build::BuildPrimitive;

/// One triangle, or two of one mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pair {
    pub(super) first: PrimitiveRef,
    /// How far behind the first one the second one stands in the mesh; 0 if there is none.
    pub(super) distance: u32,
}

impl Pair {
    /// The greatest distance.
    pub(super) const MAX_DISTANCE: u32 = 7;

    /// The second triangle, if there is one.
    pub(super) const fn second(self) -> Option<PrimitiveRef> {
        if self.distance == 0 {
            return None;
        }
        Some(PrimitiveRef { primitive: self.first.primitive + self.distance, ..self.first })
    }
}

/// The edge that two triangles of equal winding share: it runs from corner i to i + 1 of the first and from corner
/// j to j + 1 of the second, there in the opposite sense. Gives i and j.
pub(super) fn common_edge(a: &[[f32; 3]; 3], b: &[[f32; 3]; 3]) -> Option<(usize, usize)> {
    (0..9).map(|k| (k / 3, k % 3)).find(|&(i, j)| a[i] == b[(j + 1) % 3] && a[(i + 1) % 3] == b[j])
}

/// Pairs up a range of triangles of a mesh, each with the first that follows it and suits it. `corners` is `None`
/// for triangles to leave out.
///
/// Two suit each other where a visit of their common box is no dearer than visits of both boxes: where its area is
/// at most the sum of theirs.
pub(crate) fn pair_up(
    geometry: u32,
    range: Range<u32>,
    corners: impl Fn(u32) -> Option<[[f32; 3]; 3]>,
) -> Vec<BuildPrimitive> {
    let read = |primitive: u32| {
        let corners = corners(primitive)?;
        Some((corners, BuildPrimitive::triangle(PrimitiveRef { geometry, primitive }, &corners)))
    };
    let mut result = Vec::with_capacity(range.len());
    // Bit d stands for the triangle at distance d: true if it is the second of a pair.
    let mut taken = 0_u32;
    for primitive in range.clone() {
        let is_taken = taken & 1 != 0;
        taken >>= 1;
        if is_taken {
            continue;
        }
        let Some((own_corners, own)) = read(primitive) else { continue };
        let join = |distance: u32| {
            let (other_corners, other) = read(primitive + distance)?;
            common_edge(&own_corners, &other_corners)?;
            let pair = own.paired(&other, distance);
            (pair.half_area() <= own.half_area() + other.half_area()).then_some((pair, distance))
        };
        let farthest = Pair::MAX_DISTANCE.min(range.end - primitive - 1);
        let joined = (1..=farthest).filter(|d| taken >> (d - 1) & 1 == 0).find_map(join);
        if let Some((pair, distance)) = joined {
            taken |= 1 << (distance - 1);
            result.push(pair);
        } else {
            result.push(own);
        }
    }
    result
}
