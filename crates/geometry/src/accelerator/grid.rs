//! Grids: equal cells, which a ray passes one after the other (Fujimoto, Tanaka and Iwata 1986, "ARTS: Accelerated
//! Ray-Tracing System"), and grids in the crowded cells of grids (Jevans and Wyvill 1989, "Adaptive Voxel Subdivision for Ray
//! Tracing"; Klimaszewski and Sederberg 1997, "Faster Ray Tracing Using Adaptive Grids"; SPEC ACC-4).
//!
//! A ray is cut into slices by the planes across the axis along which it passes most cells. In each slice it meets at most two
//! cells across either of the other axes, which are found from where the slice begins and ends. Amanatides and Woo (1987, "A
//! Fast Voxel Traversal Algorithm for Ray Tracing") step from cell to cell instead and visit about a quarter fewer, but adding
//! up steps lets rays slip between cells by rounding; a slice can be made a little too wide on each side, and is.

use std::ops::{ControlFlow, Range};

use super::slab::{Span, clip, crossing, runs_down};
use super::{Build, GridSettings, Probe, share};
use crate::bvh::{Box3, TraversalRay};
use crate::mesh::heap;

/// Cells along an axis at most.
const MAX_RESOLUTION: f32 = 2048.0;
/// Grids within each other at most, whatever the settings say.
const MAX_LEVELS: u32 = 8;
/// Value of [`Cell::n`] for a cell with a grid of its own.
const NESTED: u32 = u32::MAX;

#[derive(Clone, Copy, Debug, Default)]
struct Cell {
    /// First reference, or number of the grid inside.
    first: u32,
    /// Number of references, or [`NESTED`].
    n: u32,
}

/// See the module.
#[derive(Debug)]
pub(super) struct Grid {
    lattice: Lattice,
    cells: Vec<Cell>,
    references: Vec<u32>,
    nested: Vec<Self>,
}

impl Grid {
    pub(super) fn build(build: &Build<'_>, settings: &GridSettings) -> Self {
        Self::over(build, *build.bounds, &build.all(), build.budget(), settings)
    }

    /// A grid over a cell, which may hold `budget` references.
    fn over(
        build: &Build<'_>,
        bounds: Box3,
        primitives: &[u32],
        budget: usize,
        settings: &GridSettings,
    ) -> Self {
        let boxes = || primitives.iter().map(|primitive| &build.boxes[*primitive as usize]);
        let mut n_cells = settings.density.max(0.0) * primitives.len() as f32;
        let (lattice, n_references) = loop {
            let lattice = Lattice::new(bounds, n_cells);
            let n_references: usize = boxes().map(|own| lattice.n_overlapped(own)).sum();
            if n_references <= budget || lattice.n_cells() == 1 {
                break (lattice, n_references);
            }
            n_cells = 0.25 * n_cells.min(lattice.n_cells() as f32);
        };
        let mut cells = vec![Cell::default(); lattice.n_cells()];
        for own in boxes() {
            lattice.overlapped(own, |cell| cells[cell].n += 1);
        }
        let mut next = 0;
        for cell in &mut cells {
            *cell = Cell { first: next + cell.n, n: cell.n };
            next = cell.first;
        }
        // Filled from the back, after which `first` is where it should be.
        let mut references = vec![0; n_references];
        for (primitive, own) in primitives.iter().zip(boxes()).rev() {
            lattice.overlapped(own, |cell| {
                cells[cell].first -= 1;
                references[cells[cell].first as usize] = *primitive;
            });
        }
        let mut grid = Self { lattice, cells, references, nested: Vec::new() };
        if settings.max_levels.min(MAX_LEVELS) > 1 && grid.cells.len() > 1 {
            grid.divide_cells(build, budget, settings);
        }
        grid
    }

    /// Makes grids of crowded cells.
    fn divide_cells(&mut self, build: &Build<'_>, budget: usize, settings: &GridSettings) {
        let inner = GridSettings { max_levels: settings.max_levels.min(MAX_LEVELS) - 1, ..*settings };
        let mut kept = Vec::new();
        for index in 0..self.cells.len() {
            let Cell { first, n } = self.cells[index];
            let own = &self.references[first as usize..(first + n) as usize];
            if n > settings.max_primitives {
                let around = own.iter().fold(Box3::EMPTY, |all, p| all.union(&build.boxes[*p as usize]));
                let bounds = intersection(&around, &self.lattice.cell_bounds(index));
                let budget = share(budget, own.len(), self.references.len());
                let grid = Self::over(build, bounds, own, budget, &inner);
                if grid.cells.len() > 1 {
                    self.cells[index] = Cell { first: self.nested.len() as u32, n: NESTED };
                    self.nested.push(grid);
                    continue;
                }
            }
            self.cells[index].first = kept.len() as u32;
            kept.extend_from_slice(own);
        }
        kept.shrink_to_fit();
        self.references = kept;
    }

    pub(super) fn traverse(&self, ray: &TraversalRay, probe: &mut impl Probe) -> ControlFlow<()> {
        let Some(span) = clip(ray, &self.lattice.bounds, probe.end()) else {
            return ControlFlow::Continue(());
        };
        let main = self.lattice.main_axis(ray);
        let [u, v] = [(main + 1) % 3, (main + 2) % 3];
        let slices = self.lattice.range(ray, main, &span);
        let is_down = runs_down(ray, main);
        for step in 0..slices.len() {
            let slice = if is_down { slices.end - 1 - step } else { slices.start + step };
            let planes = &self.lattice.planes[main];
            let [first, last] = if is_down { [slice + 1, slice] } else { [slice, slice + 1] };
            let near = span.near.max(crossing(ray, main, planes[first])[0]);
            let far = span.far.min(crossing(ray, main, planes[last])[1]);
            if near > probe.end() {
                break;
            }
            if near > far {
                continue;
            }
            let part = Span { near, far };
            for j in self.lattice.range(ray, u, &part) {
                for k in self.lattice.range(ray, v, &part) {
                    let mut place = [0; 3];
                    (place[main], place[u], place[v]) = (slice, j, k);
                    self.visit(self.lattice.index(place), ray, probe)?;
                }
            }
        }
        ControlFlow::Continue(())
    }

    fn visit(&self, cell: usize, ray: &TraversalRay, probe: &mut impl Probe) -> ControlFlow<()> {
        probe.note_node();
        let Cell { first, n } = self.cells[cell];
        if n == NESTED {
            return self.nested[first as usize].traverse(ray, probe);
        }
        probe.test_all(&self.references[first as usize..(first + n) as usize])
    }

    pub(super) fn n_nodes(&self) -> usize {
        self.cells.len() + self.nested.iter().map(Self::n_nodes).sum::<usize>()
    }

    pub(super) fn memory_bytes(&self) -> usize {
        let planes: usize = self.lattice.planes.iter().map(heap).sum();
        let nested: usize = self.nested.iter().map(Self::memory_bytes).sum();
        planes + heap(&self.cells) + heap(&self.references) + heap(&self.nested) + nested
    }
}

fn intersection(a: &Box3, b: &Box3) -> Box3 {
    Box3 {
        min: std::array::from_fn(|axis| a.min[axis].max(b.min[axis])),
        max: std::array::from_fn(|axis| a.max[axis].min(b.max[axis])),
    }
}

/// Where the planes between cells are.
#[derive(Debug)]
struct Lattice {
    bounds: Box3,
    /// Planes across each axis, from the lower side of the box to the upper.
    planes: [Vec<f32>; 3],
    /// Cells for each metre.
    density: [f32; 3],
}

impl Lattice {
    /// Nearly cubic cells, at most `n_cells` if that is at least 1.
    fn new(bounds: Box3, n_cells: f32) -> Self {
        let n = resolution(&bounds.diagonal(), n_cells);
        let planes = std::array::from_fn(|axis| {
            let (min, max) = (bounds.min[axis], bounds.max[axis]);
            let between = |i: usize| (min + (max - min) * (i as f32 / n[axis] as f32)).min(max);
            std::iter::once(min).chain((1..n[axis]).map(between)).chain([max]).collect()
        });
        let density = std::array::from_fn(|axis| n[axis] as f32 / (bounds.max[axis] - bounds.min[axis]));
        Self { bounds, planes, density }
    }

    fn n(&self, axis: usize) -> usize {
        self.planes[axis].len() - 1
    }

    fn n_cells(&self) -> usize {
        (0..3).map(|axis| self.n(axis)).product()
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.n(1) + y) * self.n(0) + x
    }

    fn cell_bounds(&self, index: usize) -> Box3 {
        let (nx, ny) = (self.n(0), self.n(1));
        let place = [index % nx, index / nx % ny, index / (nx * ny)];
        Box3 {
            min: std::array::from_fn(|axis| self.planes[axis][place[axis]]),
            max: std::array::from_fn(|axis| self.planes[axis][place[axis] + 1]),
        }
    }

    /// The cell along an axis that holds a coordinate, or the one nearest to it. Never falls as the coordinate rises.
    fn place(&self, axis: usize, x: f32) -> usize {
        let planes = &self.planes[axis];
        let last = planes.len() - 2;
        // A first guess, which may be off by one; NaN becomes 0.
        let mut cell = (((x - self.bounds.min[axis]) * self.density[axis]) as usize).min(last);
        while cell > 0 && x < planes[cell] {
            cell -= 1;
        }
        while cell < last && x >= planes[cell + 1] {
            cell += 1;
        }
        cell
    }

    /// Cells that a box overlaps, along each axis.
    fn places(&self, own: &Box3) -> [Range<usize>; 3] {
        std::array::from_fn(|axis| self.place(axis, own.min[axis])..self.place(axis, own.max[axis]) + 1)
    }

    fn n_overlapped(&self, own: &Box3) -> usize {
        self.places(own).iter().map(Range::len).product()
    }

    fn overlapped(&self, own: &Box3, mut visit: impl FnMut(usize)) {
        let [xs, ys, zs] = self.places(own);
        for z in zs {
            for y in ys.clone() {
                for x in xs.clone() {
                    visit(self.index([x, y, z]));
                }
            }
        }
    }

    /// The axis along which a ray passes most cells.
    fn main_axis(&self, ray: &TraversalRay) -> usize {
        let pace =
            |axis: usize| if self.n(axis) > 1 { ray.direction[axis].abs() * self.density[axis] } else { 0.0 };
        (1..3).fold(0, |main, axis| if pace(axis) > pace(main) { axis } else { main })
    }

    /// Cells along an axis that a part of a ray may touch.
    fn range(&self, ray: &TraversalRay, axis: usize, part: &Span) -> Range<usize> {
        let at = |t: f32| ray.direction[axis] * t;
        let (a, b) = (at(part.near), at(part.far));
        // The error of tests, on both sides; sums are rounded by at most as much as a step to the next number.
        let origin = [ray.near_origin[axis], ray.far_origin[axis]];
        let low = (origin[0].min(origin[1]) + a.min(b)).next_down();
        let high = (origin[0].max(origin[1]) + a.max(b)).next_up();
        self.place(axis, low)..self.place(axis, high) + 1
    }
}

/// Numbers of cells along each axis. Axes along which the box is thinner than a cell have one.
fn resolution(diagonal: &[f32; 3], n_cells: f32) -> [usize; 3] {
    let mut is_thin = [false; 3];
    loop {
        let long = || (0..3).filter(|axis| !is_thin[*axis]);
        let n_long = long().count() as f32;
        if n_long == 0.0 {
            return [1; 3];
        }
        // Through logarithms, since products may be too large.
        let log_volume: f32 = long().map(|axis| diagonal[axis].ln()).sum();
        let side = ((log_volume - n_cells.max(1.0).ln()) / n_long).exp();
        let is_long = |d: f32| d >= side && d > 0.0 && d < f32::INFINITY;
        match long().find(|axis| !is_long(diagonal[*axis])) {
            Some(axis) => is_thin[axis] = true,
            None => {
                let n = |axis: usize| (diagonal[axis] / side).clamp(1.0, MAX_RESOLUTION) as usize;
                return std::array::from_fn(|axis| if is_thin[axis] { 1 } else { n(axis) });
            }
        }
    }
}
