//! The `k` nearest of the points that are offered one by one (SPEC KD-8).
//!
//! Candidates are listed until there are `k`, and then made into a max-heap, whose root is the one to go next.

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

    /// Forgets the last answer. A radius below 0 or NaN leaves nothing to find.
    pub(super) fn start(&mut self, k: usize, max_radius: f32) {
        self.keys.clear();
        self.k = k;
        self.limit_squared = square_of_radius(max_radius);
    }

    /// Takes a point that is no farther than the limit.
    #[inline(always)]
    pub(super) fn offer(&mut self, distance_squared: f32, index: u32) {
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

/// The square of a radius; NaN, to which nothing is near, unless it is at least 0.
pub(super) fn square_of_radius(radius: f32) -> f32 {
    if radius >= 0.0 { radius * radius } else { f32::NAN }
}
