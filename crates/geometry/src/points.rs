//! Points in a kd-tree that finds the nearest of them: the look-ups of photon maps (SPEC KD-1, KD-8).
//!
//! Leaves are buckets of points whose coordinates lie side by side, so that one loop over arrays measures all
//! distances; above them the tree halves the number of buckets along the longest side of what a node holds (Bentley
//! 1975, "Multidimensional Binary Search Trees Used for Associative Searching"). Nodes are ranges of buckets and need no
//! pointers: one of `l` buckets is cut after the first `ceil(l/2)`, and the cut after bucket `i` is number `i` of the
//! list. All buckets but the last are full. A question keeps its candidates in a max-heap, which is made when the
//! first `k` have been found. What lies behind a cut is searched only if its cell, not merely its plane, is near enough
//! (Arya and Mount 1993, "Algorithms for Fast Vector Quantization").
//!
//! The answer is that of a search through all points: the `k` least by distance, then by index. It does not depend on
//! the tree, nor on the number of threads that built it.

#[cfg(test)]
mod tests;

use etendue_math::Point3;

/// Points of a bucket. With 8 questions take 1.15 times as long, and memory is much the same.
const BUCKET: usize = 16;

/// Buckets that one thread puts together.
const BUCKETS_PER_TASK: usize = 1 << 10;

/// Entries of the stack: one for each level, of which there are at most 32, since indices have 32 bits.
const STACK_SIZE: usize = 32;

/// Points that wait for questions.
#[derive(Clone, Debug, Default)]
pub struct PointTree {
    splits: Vec<Split>,
    buckets: Vec<Bucket>,
}

/// Where a node is cut in two.
#[derive(Clone, Copy, Debug, Default)]
struct Split {
    at: f32,
    axis: u32,
}

/// Points side by side; missing ones are NaN, which is near to nothing.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
struct Bucket {
    coordinates: [[f32; BUCKET]; 3],
    indices: [u32; BUCKET],
}

/// A point that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbour {
    /// Its index in the list that the tree was made of.
    pub index: u32,
    /// Square of its distance from the place asked for.
    pub distance_squared: f32,
}

/// The answer to a question. Use it again for the next, so that nothing is allocated.
#[derive(Clone, Debug, Default)]
pub struct Neighbours {
    /// Bits of the squared distance above the index: ordered like the pair. A max-heap once there are `k`.
    keys: Vec<u64>,
    k: usize,
    /// Farther points are of no interest.
    limit_squared: f32,
}

/// A point to be put into a bucket.
#[derive(Clone, Copy, Debug)]
struct Item {
    p: [f32; 3],
    index: u32,
}

impl PointTree {
    /// A tree of points, built in parallel on the current rayon pool. Points that are not finite are never found.
    ///
    /// # Panics
    /// If there are 2^32 points or more.
    #[must_use]
    pub fn new(points: &[Point3]) -> Self {
        assert!(u32::try_from(points.len()).is_ok(), "indices have 32 bits");
        let is_finite = |(_, p): &(u32, &Point3)| p.is_finite();
        let item = |(index, p): (u32, &Point3)| Item { p: [p.x, p.y, p.z], index };
        let mut items: Vec<Item> = (0..).zip(points).filter(is_finite).map(item).collect();
        let n_buckets = items.len().div_ceil(BUCKET);
        let mut splits = vec![Split::default(); n_buckets.saturating_sub(1)];
        let mut buckets = vec![Bucket::EMPTY; n_buckets];
        build(&mut items, &mut splits, &mut buckets);
        Self { splits, buckets }
    }

    /// Bytes on the heap.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        crate::mesh::heap(&self.splits) + crate::mesh::heap(&self.buckets)
    }

    /// Finds the `k` points nearest to `p` among those no farther than `max_radius`; of equally near ones those of
    /// lower index.
    pub fn nearest(&self, p: Point3, k: usize, max_radius: f32, found: &mut Neighbours) {
        found.start(k, max_radius);
        if k == 0 || self.buckets.is_empty() {
            return;
        }
        let p = [p.x, p.y, p.z];
        let mut node = Node { first: 0, n_buckets: self.buckets.len() as u32, offset: [0.0; 3] };
        let mut stack = [(node, 0.0); STACK_SIZE];
        let mut n_stacked = 0;
        loop {
            while node.n_buckets > 1 {
                let split = self.splits[node.split()];
                let (near, far) = node.halves(split, p);
                let distance_squared = far.distance_squared();
                if distance_squared <= found.limit_squared {
                    stack[n_stacked & (STACK_SIZE - 1)] = (far, distance_squared);
                    n_stacked += 1;
                }
                node = near;
            }
            self.buckets[node.first as usize].visit(p, found);
            node = loop {
                if n_stacked == 0 {
                    return;
                }
                n_stacked -= 1;
                let (node, distance_squared) = stack[n_stacked & (STACK_SIZE - 1)];
                if distance_squared <= found.limit_squared {
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
    const EMPTY: Self = Self { coordinates: [[f32::NAN; BUCKET]; 3], indices: [0; BUCKET] };

    fn new(items: &[Item]) -> Self {
        let mut bucket = Self::EMPTY;
        for (lane, item) in items.iter().enumerate() {
            for axis in 0..3 {
                bucket.coordinates[axis][lane] = item.p[axis];
            }
            bucket.indices[lane] = item.index;
        }
        bucket
    }

    #[inline(always)]
    fn visit(&self, p: [f32; 3], found: &mut Neighbours) {
        let [xs, ys, zs] = &self.coordinates;
        let mut distances = [0.0; BUCKET];
        let mut is_near = 0_u32;
        for lane in 0..BUCKET {
            let (x, y, z) = (xs[lane] - p[0], ys[lane] - p[1], zs[lane] - p[2]);
            distances[lane] = x * x + y * y + z * z;
        }
        for (lane, distance) in distances.iter().enumerate() {
            is_near |= u32::from(*distance <= found.limit_squared) << lane;
        }
        while is_near != 0 {
            let lane = is_near.trailing_zeros() as usize % BUCKET;
            is_near &= is_near - 1;
            found.offer(distances[lane], self.indices[lane]);
        }
    }
}

impl Neighbours {
    /// No answer yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// What was found, in no particular order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Neighbour> + '_ {
        self.keys.iter().map(|key| Neighbour { index: *key as u32, distance_squared: distance_squared(*key) })
    }

    /// Square of the radius within which no point is missing: the distance of the farthest of `k` points, or the
    /// greatest radius that was asked for if there were fewer.
    #[must_use]
    pub const fn limit_squared(&self) -> f32 {
        self.limit_squared
    }

    fn start(&mut self, k: usize, max_radius: f32) {
        self.keys.clear();
        self.k = k;
        self.limit_squared = max_radius * max_radius;
    }

    /// Takes a point that is no farther than the limit.
    #[inline(always)]
    fn offer(&mut self, distance_squared: f32, index: u32) {
        let key = u64::from(distance_squared.to_bits()) << 32 | u64::from(index);
        if self.keys.len() < self.k {
            self.keys.push(key);
            if self.keys.len() < self.k {
                return;
            }
            for parent in (0..self.k / 2).rev() {
                self.sift(parent, self.keys[parent]);
            }
        } else if key < self.keys[0] {
            self.sift(0, key);
        } else {
            return;
        }
        self.limit_squared = self::distance_squared(self.keys[0]);
    }

    /// Puts `key` into the heap in place of what is at `place`, which is greater, or was not yet in order.
    #[inline(always)]
    fn sift(&mut self, mut place: usize, key: u64) {
        let keys = self.keys.as_mut_slice();
        loop {
            let mut child = 2 * place + 1;
            if child >= keys.len() {
                break;
            }
            if child + 1 < keys.len() && keys[child + 1] > keys[child] {
                child += 1;
            }
            if keys[child] <= key {
                break;
            }
            keys[place] = keys[child];
            place = child;
        }
        keys[place] = key;
    }
}

const fn distance_squared(key: u64) -> f32 {
    f32::from_bits((key >> 32) as u32)
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

fn longest_axis(items: &[Item]) -> usize {
    let (mut min, mut max) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for item in items {
        for axis in 0..3 {
            min[axis] = min[axis].min(item.p[axis]);
            max[axis] = max[axis].max(item.p[axis]);
        }
    }
    let extent = |axis: usize| max[axis] - min[axis];
    (1..3).fold(0, |longest, axis| if extent(axis) > extent(longest) { axis } else { longest })
}
