//! Surfaces given by three formulas of u and v (SPEC GEO-7), as triangles that deviate by no more than a stated distance.
//!
//! The rectangle of (u, v) is divided into cells, each of which is divided in four while its two triangles lie further from the
//! surface than the tolerance, measured along the normal at a grid of places within the cell: at few, among which are those of the
//! largest distance where the surface varies quadratically, and at many before it is taken. A cell beside smaller ones takes in their
//! corners on its edges, so that no cracks open. Where the formula closes on itself (a seam) or shrinks to a point (a pole), the
//! vertices are the same to the last bit. Normals are du × dv, exact.

#[cfg(test)]
mod tests;

use std::collections::{HashMap, HashSet};

use etendue_math::expression::Expression;
use etendue_math::{Normal3, Point2};
use glam::DVec3;
use rayon::prelude::*;

use crate::double;
use crate::mesh::TriangleMesh;

/// Cells along each side at first: fewer might all miss a bump.
const FIRST_LEVEL: u32 = 3;
/// Finest division of each side: 2^12 cells.
const LAST_LEVEL: u32 = 12;
/// Share of the tolerance that may be seen: the rest is for what lies between the places looked at.
const CAUTION: f64 = 0.75;
/// Places along each side of a cell where a coarse one is found out.
const FEW_PLACES: u32 = 2;
/// Places along each side where one is looked at before it is taken.
const MANY_PLACES: u32 = 8;
/// Steps of formulas for each vertex times triangles at most, some minutes of one processor.
const MAX_WORK: usize = 1 << 28;
/// Grid points along each side.
const N: u32 = 1 << LAST_LEVEL;
/// The same as a number: where u and v end, in units of the grid.
const END: f64 = N as f64;

/// A surface (x, y, z) of (u, v), in metres.
#[derive(Clone, Debug)]
pub struct ParametricSurface {
    /// x, y and z, each in the variables u and v.
    pub position: [Expression; 3],
    /// Where u begins and ends.
    pub u: [f64; 2],
    /// Where v begins and ends.
    pub v: [f64; 2],
    /// Largest distance of a triangle from the surface, in metres; `None` for 1/2000 of the diagonal of the box around it.
    pub tolerance: Option<f64>,
    /// Most triangles, even if the tolerance is not met; fewer if the formulas have many steps.
    pub max_triangles: usize,
}

impl ParametricSurface {
    /// Most triangles, such that the work is bounded too.
    fn most_triangles(&self) -> usize {
        let n_steps: usize = self.position.iter().map(Expression::n_steps).sum();
        self.max_triangles.min(MAX_WORK / n_steps.max(1))
    }
}

/// The triangles of a surface.
#[derive(Clone, Debug)]
pub struct Tessellation {
    /// Triangles with normals and texture coordinates from 0 to 1; none where the formulas are not defined.
    pub mesh: TriangleMesh,
    /// The tolerance that was asked for, in metres.
    pub tolerance: f64,
    /// The largest distance found, in metres.
    pub error: f64,
}

/// A square of the grid.
#[derive(Clone, Copy, Debug)]
struct Cell {
    corner: [u32; 2],
    level: u32,
}

impl Cell {
    const fn side(&self) -> u32 {
        N >> self.level
    }

    /// Corners in turn.
    fn corners(&self) -> [[u32; 2]; 4] {
        let ([i, j], s) = (self.corner, self.side());
        [[i, j], [i + s, j], [i + s, j + s], [i, j + s]]
    }

    fn quarters(&self) -> [Self; 4] {
        let ([i, j], h, level) = (self.corner, self.side() / 2, self.level + 1);
        [[i, j], [i + h, j], [i, j + h], [i + h, j + h]].map(|corner| Self { corner, level })
    }
}

/// Makes the triangles.
#[must_use]
pub fn tessellate(surface: &ParametricSurface) -> Tessellation {
    let grid = Grid::new(surface);
    let tolerance = surface.tolerance.unwrap_or(grid.size / 2000.0);
    let (cells, error) = grid.divide(CAUTION * tolerance, surface.most_triangles());
    let mut mesh = grid.triangles(&cells);
    mend(&mut mesh);
    Tessellation { mesh, tolerance, error }
}

/// A surface on a grid of (u, v), and how it closes.
struct Grid<'a> {
    surface: &'a ParametricSurface,
    /// Diagonal of the box around some of its points.
    size: f64,
    /// True if the end of u, or of v, is its beginning.
    closes: [bool; 2],
    /// True if the surface is a point at the beginning and at the end of u, and of v.
    poles: [[bool; 2]; 2],
}

impl<'a> Grid<'a> {
    fn new(surface: &'a ParametricSurface) -> Self {
        const STEPS: u32 = 32;
        let mut grid = Self { surface, size: 0.0, closes: [false; 2], poles: [[false; 2]; 2] };
        let at = |i: u32, j: u32| grid.raw_position([i, j].map(|k| f64::from(k * (N / STEPS))));
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for p in (0..=STEPS).flat_map(|i| (0..=STEPS).map(move |j| (i, j))).map(|(i, j)| at(i, j)) {
            if p.is_finite() {
                min = min.min(p);
                max = max.max(p);
            }
        }
        let size = (max - min).length();
        let size = if size.is_finite() { size } else { 0.0 };
        let near = |a: DVec3, b: DVec3| (a - b).length() <= 1e-6 * size;
        let all = |test: &dyn Fn(u32) -> bool| (0..=STEPS).all(test);
        let closes = [all(&|k| near(at(0, k), at(STEPS, k))), all(&|k| near(at(k, 0), at(k, STEPS)))];
        let poles = [
            [0, STEPS].map(|end| all(&|k| near(at(end, k), at(end, 0)))),
            [0, STEPS].map(|end| all(&|k| near(at(k, end), at(0, end)))),
        ];
        (grid.size, grid.closes, grid.poles) = (size, closes, poles);
        grid
    }

    /// (u, v) at a place in units of the grid.
    fn parameters(&self, [i, j]: [f64; 2]) -> [f64; 2] {
        let mix = |[a, b]: [f64; 2], k: f64| if k == END { b } else { a + (b - a) * k / END };
        [mix(self.surface.u, i), mix(self.surface.v, j)]
    }

    fn raw_position(&self, point: [f64; 2]) -> DVec3 {
        let [u, v] = self.parameters(point);
        DVec3::from_array(std::array::from_fn(|axis| self.surface.position[axis].value([u, v, 0.0])))
    }

    /// The grid point that stands for all at the same place.
    fn representative(&self, [mut i, mut j]: [f64; 2]) -> [f64; 2] {
        if self.closes[0] && i == END {
            i = 0.0;
        }
        if self.closes[1] && j == END {
            j = 0.0;
        }
        if i == 0.0 && self.poles[0][0] || i == END && self.poles[0][1] {
            j = 0.0;
        }
        if j == 0.0 && self.poles[1][0] || j == END && self.poles[1][1] {
            i = 0.0;
        }
        [i, j]
    }

    /// The surface at a place in units of the grid.
    fn position_at(&self, place: [f64; 2]) -> DVec3 {
        self.raw_position(self.representative(place))
    }

    fn position(&self, point: [u32; 2]) -> DVec3 {
        self.position_at(point.map(f64::from))
    }

    /// du × dv, of length 1, if there is such a direction.
    fn normal_at(&self, [u, v]: [f64; 2]) -> Option<DVec3> {
        let gradients: [[f64; 3]; 3] =
            std::array::from_fn(|axis| self.surface.position[axis].gradient([u, v, 0.0]).1);
        let [du, dv] = [0, 1].map(|i| DVec3::from_array(gradients.map(|gradient| gradient[i])));
        let cross = du.cross(dv);
        let is_direction = cross.length() > 1e-9 * du.length() * dv.length();
        is_direction.then(|| cross.normalize()).filter(|n| n.is_finite())
    }

    /// The same at a place in units of the grid; at a pole, that of a point beside it.
    fn normal(&self, place: [f64; 2]) -> Option<DVec3> {
        let [u, v] = self.parameters(place);
        let beside = |share: f64| {
            let middle = self.parameters([END / 2.0; 2]);
            self.normal_at([u + share * (middle[0] - u), v + share * (middle[1] - v)])
        };
        self.normal_at([u, v]).or_else(|| beside(1e-5)).or_else(|| beside(1e-2))
    }

    /// Divides cells until they meet the tolerance or are too many; gives them and the largest distance.
    fn divide(&self, tolerance: f64, max_triangles: usize) -> (Vec<Cell>, f64) {
        let first = N >> FIRST_LEVEL;
        let corner = |k: u32| [k % (1 << FIRST_LEVEL) * first, (k >> FIRST_LEVEL) * first];
        let mut active: Vec<Cell> =
            (0..1 << (2 * FIRST_LEVEL)).map(|k| Cell { corner: corner(k), level: FIRST_LEVEL }).collect();
        let (mut done, mut largest) = (Vec::new(), 0.0_f64);
        while !active.is_empty() {
            let errors: Vec<f64> = active.par_iter().map(|cell| self.error(*cell, tolerance)).collect();
            let mut coarse: Vec<(f64, Cell)> = Vec::new();
            let n_cells = done.len() + active.len();
            for (cell, error) in active.into_iter().zip(errors) {
                if error > tolerance && cell.level < LAST_LEVEL {
                    coarse.push((error, cell));
                } else {
                    largest = largest.max(error);
                    done.push(cell);
                }
            }
            // Four triangles for each cell leave room for corners on its edges.
            let room = (max_triangles / 4).saturating_sub(n_cells) / 3;
            if coarse.len() > room {
                coarse.sort_by(|a, b| b.0.total_cmp(&a.0));
                for (error, cell) in coarse.drain(room..) {
                    largest = largest.max(error);
                    done.push(cell);
                }
            }
            active = coarse.iter().flat_map(|(_, cell)| cell.quarters()).collect();
        }
        (done, largest)
    }

    /// Largest distance of the two triangles of a cell from the surface, looked at in many places if few tell of none beyond
    /// the tolerance.
    fn error(&self, cell: Cell, tolerance: f64) -> f64 {
        let few = self.error_among(cell, FEW_PLACES);
        if few > tolerance { few } else { few.max(self.error_among(cell, MANY_PLACES)) }
    }

    /// The largest distance at the places that divide the sides in `n`; 0 where the surface is not defined.
    fn error_among(&self, cell: Cell, n: u32) -> f64 {
        let [p00, p10, p11, p01] = cell.corners().map(|point| self.position(point));
        let [i, j] = cell.corner.map(f64::from);
        let side = f64::from(cell.side());
        let mut largest = 0.0_f64;
        for (a, b) in (0..=n).flat_map(|a| (0..=n).map(move |b| (a, b))) {
            // Corners lie on the surface, and of many some were among few.
            let is_corner = a % n == 0 && b % n == 0;
            let again = n / FEW_PLACES;
            let was_seen = again > 1 && a % again == 0 && b % again == 0;
            if is_corner || was_seen {
                continue;
            }
            let (x, y) = (f64::from(a) / f64::from(n), f64::from(b) / f64::from(n));
            // The triangles lie on both sides of the diagonal from the first corner.
            let flat = if x >= y {
                p00 + (p10 - p00) * x + (p11 - p10) * y
            } else {
                p00 + (p11 - p01) * x + (p01 - p00) * y
            };
            let place = [i + x * side, j + y * side];
            let offset = self.position_at(place) - flat;
            let is_border = place.iter().any(|k| *k == 0.0 || *k == END);
            // Sideways the surface may slip in its own plane, but not at its border.
            let distance = match self.normal(place) {
                Some(n) if !is_border => offset.dot(n).abs(),
                _ => offset.length(),
            };
            if distance.is_finite() {
                largest = largest.max(distance);
            } else {
                // At the edge of the domain the finest cells are wanted.
                largest = largest.max(if self.is_partly_defined(cell) { f64::MAX } else { 0.0 });
            }
        }
        largest
    }

    fn is_partly_defined(&self, cell: Cell) -> bool {
        cell.corners().iter().any(|point| self.position(*point).is_finite()) && cell.level < FIRST_LEVEL + 4
    }

    fn triangles(&self, cells: &[Cell]) -> TriangleMesh {
        let mut corners: HashSet<[u32; 2]> = HashSet::new();
        for point in cells.iter().flat_map(Cell::corners) {
            corners.insert(point);
            corners.extend(self.twins(point));
        }
        let mut mesh = TriangleMesh::default();
        let mut vertices: HashMap<[u32; 2], u32> = HashMap::new();
        for cell in cells {
            let mut border = Vec::new();
            let c = cell.corners();
            for side in 0..4 {
                edge(c[side], c[(side + 1) % 4], &corners, &mut border);
            }
            let mut vertex =
                |point: [u32; 2]| *vertices.entry(point).or_insert_with(|| self.add_vertex(point, &mut mesh));
            if border.len() == 4 {
                let [a, b, c, d] = c.map(&mut vertex);
                Self::add_triangle(&mut mesh, [a, b, c]);
                Self::add_triangle(&mut mesh, [a, c, d]);
                continue;
            }
            let half = cell.side() / 2;
            let middle = vertex([cell.corner[0] + half, cell.corner[1] + half]);
            let border: Vec<u32> = border.into_iter().map(vertex).collect();
            for k in 0..border.len() {
                Self::add_triangle(&mut mesh, [middle, border[k], border[(k + 1) % border.len()]]);
            }
        }
        mesh
    }

    /// The same places on the other side of seams.
    fn twins(&self, [i, j]: [u32; 2]) -> impl Iterator<Item = [u32; 2]> + use<> {
        let other = |k: u32, closes: bool| if closes && (k == 0 || k == N) { N - k } else { k };
        let (i2, j2) = (other(i, self.closes[0]), other(j, self.closes[1]));
        [[i2, j], [i, j2], [i2, j2]].into_iter()
    }

    fn add_vertex(&self, point: [u32; 2], mesh: &mut TriangleMesh) -> u32 {
        let p = self.position(point);
        let p = double::to_point(if p.is_finite() { p } else { DVec3::NAN });
        mesh.positions.push(p);
        let n = self.normal(point.map(f64::from)).unwrap_or(DVec3::ZERO);
        mesh.normals.push(double::to_normal(n));
        let [i, j] = point.map(|k| k as f32 / N as f32);
        mesh.uvs.push(Point2::new(i, j));
        (mesh.positions.len() - 1) as u32
    }

    /// Leaves out triangles without area or without a place.
    fn add_triangle(mesh: &mut TriangleMesh, triangle: [u32; 3]) {
        let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex as usize]);
        if [a, b, c].iter().all(|p| p.is_finite()) && a != b && b != c && c != a {
            mesh.indices.push(triangle);
        }
    }
}

/// Appends the corners from `a` to `b`, without `b`.
fn edge(a: [u32; 2], b: [u32; 2], corners: &HashSet<[u32; 2]>, border: &mut Vec<[u32; 2]>) {
    let middle = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
    let is_fine = a[0].abs_diff(b[0]).max(a[1].abs_diff(b[1])) < 2;
    if is_fine || !corners.contains(&middle) {
        border.push(a);
        return;
    }
    edge(a, middle, corners, border);
    edge(middle, b, corners, border);
}

/// Gives vertices a place and a normal that have none, so that all numbers of the mesh are finite: no triangle uses such a place.
fn mend(mesh: &mut TriangleMesh) {
    for (p, n) in mesh.positions.iter_mut().zip(&mut mesh.normals) {
        if !p.is_finite() {
            *p = etendue_math::Point3::ORIGIN;
        }
        if *n == Normal3::default() {
            *n = Normal3::new(0.0, 0.0, 1.0);
        }
    }
}
