//! Points in the order of a bucket tree, and nothing but their positions: half a byte each beside 12 for coordinates.
//!
//! Leaves are buckets of points whose coordinates lie side by side, so that one loop over arrays measures all
//! distances; above them the tree halves the number of buckets along the longest side of what a node holds (Bentley
//! 1975, "Multidimensional Binary Search Trees Used for Associative Searching"). Nodes are ranges of buckets and need no
//! pointers: one of `l` buckets is cut after the first `ceil(l/2)`, and the cut after bucket `i` is number `i` of the
//! list. All buckets but the last are full, so that the place of a point in the order says where it is. What lies behind a
//! cut is searched only if its cell, not merely its plane, is near enough (Arya and Mount 1993, "Algorithms for Fast Vector
//! Quantization").

use std::fmt;

use etendue_math::Point3;

use super::found::{Neighbour, Neighbours, square_of_radius};
use super::item::{Item, finite_items, longest_axis};
use crate::bvh::vec_in_large_pages;

/// Points of a bucket. With 8 questions take 1.15 times as long, and memory is much the same.
const BUCKET: usize = 16;

/// Buckets that one thread puts together.
const BUCKETS_PER_TASK: usize = 1 << 10;

/// Entries of the stack: one for each level, of which there are at most 32, since places have 32 bits.
const STACK_SIZE: usize = 32;

/// Positions in the order of a tree. What belongs to a point, the owner keeps in the same order.
#[derive(Clone, Debug, Default)]
pub struct PackedPoints {
    n_points: u32,
    splits: Vec<Split>,
    buckets: Vec<Bucket>,
}

/// Where a node is cut in two.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Split {
    at: f32,
    axis: u32,
}

/// Points side by side; missing ones are NaN, which is near to nothing.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Bucket([[f32; BUCKET]; 3]);

/// Points that were said to be in the order of a tree are not, or not all of them are finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotInOrder;

impl fmt::Display for NotInOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the points are not in the order of a tree, or not finite")
    }
}

impl std::error::Error for NotInOrder {}

/// What a search looks for.
pub(super) trait Search {
    /// Farther points are of no interest; NaN if none is.
    fn limit_squared(&self) -> f32;

    /// Takes a point that is no farther than that.
    fn offer(&mut self, distance_squared: f32, place: u32);
}

/// The nearest points, called by names of their own.
pub(super) struct Nearest<'a, F> {
    pub(super) found: &'a mut Neighbours,
    pub(super) name: F,
}

impl<F: Fn(u32) -> u32> Search for Nearest<'_, F> {
    #[inline(always)]
    fn limit_squared(&self) -> f32 {
        self.found.limit_squared()
    }

    #[inline(always)]
    fn offer(&mut self, distance_squared: f32, place: u32) {
        self.found.offer(distance_squared, (self.name)(place));
    }
}

/// All points within a radius.
pub(super) struct Within<F> {
    pub(super) limit_squared: f32,
    pub(super) visit: F,
}

impl<F: FnMut(Neighbour)> Search for Within<F> {
    #[inline(always)]
    fn limit_squared(&self) -> f32 {
        self.limit_squared
    }

    #[inline(always)]
    fn offer(&mut self, distance_squared: f32, place: u32) {
        (self.visit)(Neighbour { index: place, distance_squared });
    }
}

/// The nearest point of those that are accepted.
pub(super) struct NearestOf<F> {
    pub(super) found: Option<Neighbour>,
    pub(super) limit_squared: f32,
    pub(super) accepts: F,
}

impl<F: FnMut(Neighbour) -> bool> Search for NearestOf<F> {
    #[inline(always)]
    fn limit_squared(&self) -> f32 {
        self.limit_squared
    }

    #[inline(always)]
    fn offer(&mut self, distance_squared: f32, place: u32) {
        let point = Neighbour { index: place, distance_squared };
        // Of equally near ones that of lower place, in whatever order they are met.
        let is_behind = |found: Neighbour| distance_squared == found.distance_squared && found.index < place;
        if !self.found.is_some_and(is_behind) && (self.accepts)(point) {
            self.found = Some(point);
            self.limit_squared = distance_squared;
        }
    }
}

impl PackedPoints {
    /// The points in order of a tree, built in parallel on the current rayon pool, and for each place the index of the point
    /// that is there. Points that are not finite are left out.
    ///
    /// # Panics
    /// If there are 2^32 points or more.
    #[must_use]
    pub fn new(points: &[Point3]) -> (Self, Vec<u32>) {
        let mut items = finite_items(points);
        let n_buckets = items.len().div_ceil(BUCKET);
        let mut splits = vec![Split::default(); n_buckets.saturating_sub(1)];
        let mut buckets = vec_in_large_pages(n_buckets);
        buckets.resize(n_buckets, Bucket::EMPTY);
        build(&mut items, &mut splits, &mut buckets);
        let order = items.iter().map(|item| item.index).collect();
        (Self { n_points: items.len() as u32, splits, buckets }, order)
    }

    /// Points that are in the order of a tree already, as [`Self::new`] left them; `axis` tells the axis of the cut before a
    /// place, as [`Self::cuts`] does.
    ///
    /// # Errors
    /// If they are not in that order, or not finite.
    pub fn from_ordered(points: &[Point3], axis: impl Fn(u32) -> u8) -> Result<Self, NotInOrder> {
        let n_buckets = points.len().div_ceil(BUCKET);
        let mut splits: Vec<Split> =
            (1..n_buckets).map(|i| Split { at: 0.0, axis: u32::from(axis((i * BUCKET) as u32)) }).collect();
        let is_sound = points.iter().all(|p| p.is_finite())
            && u32::try_from(points.len()).is_ok()
            && splits.iter().all(|split| split.axis < 3);
        if !is_sound {
            return Err(NotInOrder);
        }
        let items: Vec<Item> = points.iter().map(|p| Item { p: [p.x, p.y, p.z], index: 0 }).collect();
        cut_ordered(&items, &mut splits, n_buckets)?;
        let mut buckets = vec_in_large_pages(n_buckets);
        buckets.extend(items.chunks(BUCKET).map(Bucket::new));
        Ok(Self { n_points: points.len() as u32, splits, buckets })
    }

    /// The place behind each cut of the tree, and the axis of the cut, 0 to 2.
    pub fn cuts(&self) -> impl ExactSizeIterator<Item = (u32, u8)> + '_ {
        let first = |i: usize| ((i + 1) * BUCKET) as u32;
        self.splits.iter().enumerate().map(move |(i, split)| (first(i), split.axis as u8))
    }

    /// Number of points.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.n_points as usize
    }

    /// Whether there are none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.n_points == 0
    }

    /// Bytes on the heap.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        crate::mesh::heap(&self.splits) + crate::mesh::heap(&self.buckets)
    }

    /// The point at a place, below [`Self::len`].
    ///
    /// # Panics
    /// If there is no such place.
    #[inline]
    #[must_use]
    pub fn point(&self, place: u32) -> Point3 {
        let [xs, ys, zs] = &self.buckets[place as usize / BUCKET].0;
        let lane = place as usize % BUCKET;
        Point3::new(xs[lane], ys[lane], zs[lane])
    }

    /// Finds the `k` points nearest to `p` among those no farther than `max_radius`, by their places; of equally near ones
    /// those of lower place.
    pub fn nearest(&self, p: Point3, k: usize, max_radius: f32, found: &mut Neighbours) {
        found.start(k, max_radius);
        if k > 0 {
            self.search(p, &mut Nearest { found, name: |place| place });
        }
    }

    /// The nearest to `p` of the points that are accepted and no farther than `max_radius`; of equally near ones that of lower
    /// place. Points that are farther than one that was accepted are not asked about.
    #[must_use]
    pub fn nearest_of(
        &self,
        p: Point3,
        max_radius: f32,
        accepts: impl FnMut(Neighbour) -> bool,
    ) -> Option<Neighbour> {
        let mut search = NearestOf { found: None, limit_squared: square_of_radius(max_radius), accepts };
        self.search(p, &mut search);
        search.found
    }

    /// Shows all points no farther than `radius` from `p`, by their places, in no particular order (but always in the same).
    pub fn within(&self, p: Point3, radius: f32, visit: impl FnMut(Neighbour)) {
        self.search(p, &mut Within { limit_squared: square_of_radius(radius), visit });
    }

    /// Shows the search what is near enough.
    #[inline]
    pub(super) fn search(&self, p: Point3, search: &mut impl Search) {
        let p = [p.x, p.y, p.z];
        if self.buckets.is_empty() {
            return;
        }
        let mut node = Node { first: 0, n_buckets: self.buckets.len() as u32, offset: [0.0; 3] };
        let mut stack = [(node, 0.0); STACK_SIZE];
        let mut n_stacked = 0;
        loop {
            while node.n_buckets > 1 {
                let split = self.splits[node.split()];
                let (near, far) = node.halves(split, p);
                let distance_squared = far.distance_squared();
                if distance_squared <= search.limit_squared() {
                    stack[n_stacked & (STACK_SIZE - 1)] = (far, distance_squared);
                    n_stacked += 1;
                }
                node = near;
            }
            let mut distances = [0.0; BUCKET];
            let bucket = &self.buckets[node.first as usize];
            let mut is_near = bucket.measure(p, search.limit_squared(), &mut distances);
            while is_near != 0 {
                let lane = is_near.trailing_zeros() as usize % BUCKET;
                is_near &= is_near - 1;
                if distances[lane] <= search.limit_squared() {
                    search.offer(distances[lane], node.first * BUCKET as u32 + lane as u32);
                }
            }
            node = loop {
                if n_stacked == 0 {
                    return;
                }
                n_stacked -= 1;
                let (node, distance_squared) = stack[n_stacked & (STACK_SIZE - 1)];
                if distance_squared <= search.limit_squared() {
                    break node;
                }
            };
        }
    }
}

/// A range of buckets, as a question meets it.
#[derive(Clone, Copy, Debug)]
struct Node {
    first: u32,
    n_buckets: u32,
    /// How far the place asked for is from the cell, along each axis.
    offset: [f32; 3],
}

/// How many of so many buckets are before the cut.
const fn n_before(n_buckets: usize) -> usize {
    n_buckets.div_ceil(2)
}

impl Node {
    #[inline(always)]
    const fn split(&self) -> usize {
        self.first as usize + n_before(self.n_buckets as usize) - 1
    }

    /// The half that holds `p`, and the other.
    #[inline(always)]
    fn halves(self, split: Split, p: [f32; 3]) -> (Self, Self) {
        let axis = split.axis as usize % 3;
        let distance = p[axis] - split.at;
        let n = n_before(self.n_buckets as usize) as u32;
        let before = Self { n_buckets: n, ..self };
        let behind = Self { first: self.first + n, n_buckets: self.n_buckets - n, ..self };
        let (near, mut far) = if distance < 0.0 { (before, behind) } else { (behind, before) };
        far.offset[axis] = distance;
        (near, far)
    }

    #[inline(always)]
    fn distance_squared(&self) -> f32 {
        let [x, y, z] = self.offset;
        x * x + y * y + z * z
    }
}

impl Bucket {
    const EMPTY: Self = Self([[f32::NAN; BUCKET]; 3]);

    fn new(items: &[Item]) -> Self {
        let mut bucket = Self::EMPTY;
        for (lane, item) in items.iter().enumerate() {
            for axis in 0..3 {
                bucket.0[axis][lane] = item.p[axis];
            }
        }
        bucket
    }

    /// Squares of the distances of all points, and a bit for each that is no farther than the limit.
    #[inline(always)]
    fn measure(&self, p: [f32; 3], limit_squared: f32, distances: &mut [f32; BUCKET]) -> u32 {
        let [xs, ys, zs] = &self.0;
        for lane in 0..BUCKET {
            let (x, y, z) = (xs[lane] - p[0], ys[lane] - p[1], zs[lane] - p[2]);
            distances[lane] = x * x + y * y + z * z;
        }
        let bit = |(lane, distance): (usize, &f32)| u32::from(*distance <= limit_squared) << lane;
        distances.iter().enumerate().map(bit).fold(0, |bits, bit| bits | bit)
    }
}

/// Fills the buckets with the items, and cuts between them.
fn build(items: &mut [Item], splits: &mut [Split], buckets: &mut [Bucket]) {
    let n_before = n_before(buckets.len());
    if let [bucket] = buckets {
        *bucket = Bucket::new(items);
    } else if n_before > 0 {
        let axis = longest_axis(items);
        let by_axis = |a: &Item, b: &Item| a.p[axis].total_cmp(&b.p[axis]);
        items.select_nth_unstable_by(n_before * BUCKET, by_axis);
        let (items_before, items_behind) = items.split_at_mut(n_before * BUCKET);
        let (buckets_before, buckets_behind) = buckets.split_at_mut(n_before);
        let (splits_before, rest) = splits.split_at_mut(n_before - 1);
        let [split, splits_behind @ ..] = rest else { return };
        *split = Split { at: items_behind[0].p[axis], axis: axis as u32 };
        let mut before = || build(items_before, splits_before, buckets_before);
        if n_before < BUCKETS_PER_TASK {
            before();
            build(items_behind, splits_behind, buckets_behind);
        } else {
            rayon::join(before, || build(items_behind, splits_behind, buckets_behind));
        }
    }
}

/// Finds where points in order were cut, and checks that they are on their sides.
fn cut_ordered(items: &[Item], splits: &mut [Split], n_buckets: usize) -> Result<(), NotInOrder> {
    if n_buckets < 2 {
        return Ok(());
    }
    let n_before = n_before(n_buckets);
    let (items_before, items_behind) = items.split_at(n_before * BUCKET);
    let (splits_before, rest) = splits.split_at_mut(n_before - 1);
    let [split, splits_behind @ ..] = rest else { return Err(NotInOrder) };
    let along = |item: &Item| item.p[split.axis as usize];
    let at = items_behind.iter().map(along).fold(f32::INFINITY, f32::min);
    if items_before.iter().any(|item| along(item) > at) {
        return Err(NotInOrder);
    }
    split.at = at;
    cut_ordered(items_before, splits_before, n_before)?;
    cut_ordered(items_behind, splits_behind, n_buckets - n_before)
}
