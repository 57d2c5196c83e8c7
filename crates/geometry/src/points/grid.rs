//! Points by the cell of a uniform grid that they lie in; cells are kept in a hash table, so that empty ones cost nothing
//! (Teschner et al. 2003, "Optimized Spatial Hashing for Collision Detection of Deformable Objects"; SPEC KD-2). For questions
//! of one radius, about the side of a cell; for the nearest `k` the radius is doubled until there are as many.

use std::cmp::Ordering;

use etendue_math::{Point3, hash64};

use super::found::{Neighbour, Neighbours, square_of_radius};
use super::item::{Item, bounds, finite_items};

/// A hash grid: 20 to 24 bytes a point.
#[derive(Clone, Debug)]
pub struct HashGrid {
    cell_size: f32,
    /// In order of the hash of their cells.
    items: Vec<Item>,
    /// Where the points of each hash begin; the end last.
    starts: Vec<u32>,
    /// Least and greatest coordinates.
    bounds: ([f32; 3], [f32; 3]),
}

/// Rounding of coordinates, relative: a point on the rim must not be lost to it.
const SLACK: f32 = 4e-7;

impl HashGrid {
    /// A grid with cells of this size, positive and finite. Points that are not finite are left out.
    ///
    /// # Panics
    /// If there are 2^32 points or more, or the size is not positive and finite.
    #[must_use]
    pub fn new(points: &[Point3], cell_size: f32) -> Self {
        assert!(cell_size > 0.0 && cell_size.is_finite(), "cells have a size");
        let unsorted = finite_items(points);
        let n_hashes = unsorted.len().next_power_of_two();
        let mut grid = Self {
            cell_size,
            items: unsorted.clone(),
            starts: vec![0; n_hashes + 1],
            bounds: bounds(&unsorted),
        };
        let hashes: Vec<usize> = unsorted.iter().map(|item| grid.hash(grid.cell(item.p))).collect();
        for hash in &hashes {
            grid.starts[hash + 1] += 1;
        }
        for hash in 0..n_hashes {
            grid.starts[hash + 1] += grid.starts[hash];
        }
        let mut next = grid.starts.clone();
        for (item, hash) in unsorted.iter().zip(hashes) {
            grid.items[next[hash] as usize] = *item;
            next[hash] += 1;
        }
        grid
    }

    /// Bytes on the heap.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        crate::mesh::heap(&self.items) + crate::mesh::heap(&self.starts)
    }

    /// As [`PointTree::nearest`](super::PointTree::nearest).
    pub fn nearest(&self, p: Point3, k: usize, max_radius: f32, found: &mut Neighbours) {
        let mut radius = self.cell_size;
        loop {
            let is_last = !radius.partial_cmp(&max_radius).is_some_and(Ordering::is_lt)
                || self.is_all_within(p, radius);
            found.start(k, if is_last { max_radius } else { radius });
            let searched = if is_last { max_radius } else { radius };
            if k > 0 {
                self.search(p, searched, |item, distance_squared| {
                    if distance_squared <= found.limit_squared() {
                        found.offer(distance_squared, item.index);
                    }
                });
            }
            if is_last || found.iter().len() == k {
                return;
            }
            radius *= 2.0;
        }
    }

    /// As [`PointTree::within`](super::PointTree::within).
    pub fn within(&self, p: Point3, radius: f32, mut visit: impl FnMut(Neighbour)) {
        let limit_squared = square_of_radius(radius);
        self.search(p, radius, |item, distance_squared| {
            if distance_squared <= limit_squared {
                visit(Neighbour { index: item.index, distance_squared });
            }
        });
    }

    /// Visits all points that may be within the radius, and others.
    fn search(&self, p: Point3, radius: f32, mut visit: impl FnMut(&Item, f32)) {
        let p = [p.x, p.y, p.z];
        let reach = |axis: usize| radius + SLACK * (radius + p[axis].abs());
        let first = self.cell([0, 1, 2].map(|axis| (p[axis] - reach(axis)).max(self.bounds.0[axis])));
        let last = self.cell([0, 1, 2].map(|axis| (p[axis] + reach(axis)).min(self.bounds.1[axis])));
        let n_along = |axis: usize| (i64::from(last[axis]) - i64::from(first[axis]) + 1).max(0) as f64;
        if n_along(0) * n_along(1) * n_along(2) >= self.items.len() as f64 {
            self.items.iter().for_each(|item| visit(item, item.square_of_distance(p)));
            return;
        }
        for z in first[2]..=last[2] {
            for y in first[1]..=last[1] {
                for x in first[0]..=last[0] {
                    self.visit_cell([x, y, z], |item| visit(item, item.square_of_distance(p)));
                }
            }
        }
    }

    /// Visits the points of a cell, and not those of other cells of the same hash.
    fn visit_cell(&self, cell: [i32; 3], mut visit: impl FnMut(&Item)) {
        let hash = self.hash(cell);
        let range = self.starts[hash] as usize..self.starts[hash + 1] as usize;
        self.items[range].iter().filter(|item| self.cell(item.p) == cell).for_each(&mut visit);
    }

    /// Whether all points are certain to be within the radius.
    fn is_all_within(&self, p: Point3, radius: f32) -> bool {
        let (min, max) = self.bounds;
        let reach = |axis: usize, p: f32| (p - min[axis]).abs().max((max[axis] - p).abs());
        let (x, y, z) = (reach(0, p.x), reach(1, p.y), reach(2, p.z));
        // Also where nothing is near to anything.
        let farthest = (x * x + y * y + z * z).sqrt();
        !farthest.partial_cmp(&(radius * (1.0 - 4.0 * SLACK))).is_some_and(Ordering::is_gt)
    }

    /// The cell of a place. Beyond the range of integers all lie in the last.
    fn cell(&self, p: [f32; 3]) -> [i32; 3] {
        p.map(|v| (v / self.cell_size).floor() as i32)
    }

    fn hash(&self, cell: [i32; 3]) -> usize {
        let [x, y, z] = cell.map(|v| u64::from(v as u32));
        (hash64(&[x << 32 | y, z]) as usize) & (self.starts.len() - 2)
    }
}
