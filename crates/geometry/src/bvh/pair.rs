//! Pairs of triangles that share an edge.
//!
//! The hierarchy holds pairs where it can: they halve the primitives of a build, need the memory of four corners
//! instead of six, and their box is hardly larger than that of one of them. Partners are found as the mesh is read:
//! each triangle joins the one among its earlier neighbours with which its box grows least, or waits for later ones.

use super::PrimitiveRef;
use super::build::BuildPrimitive;

/// One triangle, or two of one mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pair {
    pub(crate) first: PrimitiveRef,
    /// The second triangle of the mesh, if there is one.
    pub(crate) second: Option<u32>,
}

/// No triangle, no primitive.
const NONE: u32 = u32::MAX;

/// The edge that two triangles of equal winding share: it runs from corner i to i + 1 of the first and from corner
/// j to j + 1 of the second, there in the opposite sense. Gives i and j.
pub(super) fn common_edge(a: &[[f32; 3]; 3], b: &[[f32; 3]; 3]) -> Option<(usize, usize)> {
    (0..9).map(|k| (k / 3, k % 3)).find(|&(i, j)| a[i] == b[(j + 1) % 3] && a[(i + 1) % 3] == b[j])
}

/// Appends the triangles of a mesh, in pairs where they suit each other: where a visit of their common box is no
/// dearer than visits of both boxes, that is, where its area is at most the sum of theirs.
///
/// `corners` is `None` for triangles to leave out. Returns the second triangle of each that is the first of a pair.
pub(crate) fn append_pairs(
    geometry: u32,
    indices: &[[u32; 3]],
    n_vertices: usize,
    corners: impl Fn(u32) -> Option<[[f32; 3]; 3]>,
    primitives: &mut Vec<BuildPrimitive>,
) -> Vec<u32> {
    // Where hardly any vertex is shared, edges are compared by position.
    let is_welded = n_vertices < indices.len() * 5 / 2;
    let mut waiting = if is_welded { OpenEdges::new(n_vertices) } else { OpenEdges::new(0) };
    let mut seconds = vec![NONE; indices.len()];
    let start = primitives.len();
    primitives.reserve(indices.len() * 5 / 8);
    for (primitive, vertices) in (0..).zip(indices) {
        let Some(own_corners) = corners(primitive) else { continue };
        let own = BuildPrimitive::triangle(PrimitiveRef { geometry, primitive }, &own_corners);
        let mut best = Partner { growth: 0.0, primitive: NONE };
        if is_welded {
            waiting.neighbours(vertices, |candidate| best.consider(candidate, &own, primitives));
        } else {
            let recent = primitives.len().saturating_sub(2).max(start)..primitives.len();
            for candidate in recent.map(|candidate| candidate as u32) {
                let other = corners(primitives[candidate as usize].first_triangle());
                if other.is_some_and(|other| common_edge(&other, &own_corners).is_some()) {
                    best.consider(candidate, &own, primitives);
                }
            }
        }
        if best.primitive == NONE {
            if is_welded {
                waiting.insert(vertices, primitives.len() as u32, primitives);
            }
            primitives.push(own);
        } else {
            let first = &mut primitives[best.primitive as usize];
            seconds[first.first_triangle() as usize] = primitive;
            *first = first.paired(&own);
        }
    }
    seconds
}

/// The best partner so far, and by how much the area of the common box exceeds the sum of both.
struct Partner {
    growth: f32,
    primitive: u32,
}

impl Partner {
    fn consider(&mut self, candidate: u32, own: &BuildPrimitive, primitives: &[BuildPrimitive]) {
        let other = &primitives[candidate as usize];
        let growth = own.union_growth(other);
        if !other.is_pair() && (growth < self.growth || (growth <= 0.0 && self.primitive == NONE)) {
            *self = Self { growth, primitive: candidate };
        }
    }
}

/// The second triangle that [`append_pairs`] found for a first one.
pub(crate) fn second_of(seconds: &[u32], first: u32) -> Option<u32> {
    seconds.get(first as usize).copied().filter(|second| *second != NONE)
}

/// Edges of triangles without partner, found by the vertex where they end. Of many at one vertex some are forgotten.
struct OpenEdges {
    /// Where an edge begins, and its primitive.
    by_end: Vec<[(u32, u32); 4]>,
}

impl OpenEdges {
    fn new(n_vertices: usize) -> Self {
        Self { by_end: vec![[(NONE, NONE); 4]; n_vertices] }
    }

    /// Primitives that have an edge of a triangle in the opposite sense.
    #[inline]
    fn neighbours(&self, vertices: &[u32; 3], mut visit: impl FnMut(u32)) {
        for i in 0..3 {
            let (from, to) = (vertices[i], vertices[(i + 1) % 3]);
            for (start, primitive) in self.by_end[from as usize] {
                if start == to && primitive != NONE {
                    visit(primitive);
                }
            }
        }
    }

    /// Adds the edges of a triangle, in place of those that no longer wait.
    fn insert(&mut self, vertices: &[u32; 3], primitive: u32, primitives: &[BuildPrimitive]) {
        let is_free = |&(_, p): &(u32, u32)| {
            p == NONE || primitives.get(p as usize).is_none_or(BuildPrimitive::is_pair)
        };
        for i in 0..3 {
            let (from, to) = (vertices[i], vertices[(i + 1) % 3]);
            let slots = &mut self.by_end[to as usize];
            let slot = slots.iter().position(is_free).unwrap_or(primitive as usize & 3);
            slots[slot] = (from, primitive);
        }
    }
}
