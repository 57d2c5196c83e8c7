//! A binary tree over lights with places; lights at infinity stand apart
//! (Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting").
//!
//! From the root, a child is taken with probability in proportion to its importance for the point to be lit. The
//! path to each light is kept as a bit trail, so that the probability of a given light is a walk down the same path.
//! Built top-down: of 12 buckets along each axis, the split with the least sum of
//! intensity x solid angle of emission x surface of the box is taken.

use std::f32::consts::{FRAC_PI_2, PI};

use etendue_geometry::Reference;
use etendue_math::{Bounds3, ONE_MINUS_EPSILON, safe_acos};

use super::{Light, LightBounds, LightContext, LightId};

const N_BUCKETS: usize = 12;
/// From this depth on, groups are halved by count, so that bit trails end before 64.
const MAX_COSTED_DEPTH: u32 = 30;
/// Neither child of two that both matter is taken less often.
const MIN_PROBABILITY: f32 = 1e-6;

#[derive(Clone, Copy, Debug)]
enum Link {
    /// A light.
    Leaf(LightId),
    /// Index of the second child; the first follows its parent.
    Second(u32),
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: LightBounds,
    link: Link,
}

/// Where the tree has a light.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    /// At infinity.
    Infinite,
    /// At the end of this path from the root: the lowest bit is the first turn, 1 for second children.
    Trail(u64),
    /// Nowhere: it emits nothing.
    Dark,
}

/// A tree over lights.
#[derive(Clone, Debug)]
pub struct LightTree {
    nodes: Vec<Node>,
    infinite: Vec<LightId>,
    places: Vec<Place>,
}

impl LightTree {
    /// Builds the tree; lights that emit nothing are left out.
    #[must_use]
    pub fn new(lights: &[Light], context: &LightContext) -> Self {
        let mut places = vec![Place::Dark; lights.len()];
        let (mut infinite, mut finite) = (Vec::new(), Vec::new());
        for (index, light) in lights.iter().enumerate() {
            let id = LightId(index as u32);
            match light.bounds(context) {
                Some(bounds) if bounds.intensity > 0.0 && !bounds.bounds.is_empty() => {
                    finite.push((id, bounds))
                }
                Some(_) => {}
                None if light.power(context).weight > 0.0 => {
                    places[index] = Place::Infinite;
                    infinite.push(id);
                }
                None => {}
            }
        }
        let mut builder = Builder { nodes: Vec::with_capacity(2 * finite.len()), places };
        if !finite.is_empty() {
            builder.build(&mut finite, 0, 0);
        }
        Self { nodes: builder.nodes, infinite, places: builder.places }
    }

    /// Probability to take a light at infinity.
    fn infinite_probability(&self) -> f32 {
        let finite = if self.nodes.is_empty() { 0 } else { 1 };
        self.infinite.len() as f32 / (self.infinite.len() + finite).max(1) as f32
    }

    /// A light for the point `reference`, with its probability.
    #[must_use]
    pub fn sample(&self, reference: &Reference, u: f32) -> Option<(LightId, f32)> {
        let p_infinite = self.infinite_probability();
        if u < p_infinite {
            let n = self.infinite.len();
            let index = ((u / p_infinite * n as f32) as usize).min(n - 1);
            return Some((self.infinite[index], p_infinite / n as f32));
        }
        if self.nodes.is_empty() || self.nodes[0].bounds.importance(reference) <= 0.0 {
            return None;
        }
        let mut u = ((u - p_infinite) / (1.0 - p_infinite)).clamp(0.0, ONE_MINUS_EPSILON);
        let mut pmf = 1.0 - p_infinite;
        let mut index = 0;
        loop {
            let second = match self.nodes[index].link {
                Link::Leaf(id) => return (pmf > 0.0).then_some((id, pmf)),
                Link::Second(second) => second as usize,
            };
            let p_second = self.second_probability(index, second, reference)?;
            let p_first = 1.0 - p_second;
            if u < p_first {
                index += 1;
                pmf *= p_first;
                u = (u / p_first).min(ONE_MINUS_EPSILON);
            } else {
                index = second;
                pmf *= p_second;
                u = ((u - p_first) / p_second).clamp(0.0, ONE_MINUS_EPSILON);
            }
        }
    }

    /// Probability of turning to the second child; `None` if neither matters.
    fn second_probability(&self, index: usize, second: usize, reference: &Reference) -> Option<f32> {
        let a = self.nodes[index + 1].bounds.importance(reference);
        let b = self.nodes[second].bounds.importance(reference);
        if a <= 0.0 && b <= 0.0 {
            return None;
        }
        if a <= 0.0 {
            return Some(1.0);
        }
        if b <= 0.0 {
            return Some(0.0);
        }
        Some((b / (a + b)).clamp(MIN_PROBABILITY, 1.0 - MIN_PROBABILITY))
    }

    /// Probability with which [`sample`](Self::sample) takes `light`.
    #[must_use]
    pub fn pmf(&self, reference: &Reference, light: LightId) -> f32 {
        let mut trail = match self.places[light.0 as usize] {
            Place::Dark => return 0.0,
            Place::Infinite => return self.infinite_probability() / self.infinite.len() as f32,
            Place::Trail(trail) => trail,
        };
        if self.nodes[0].bounds.importance(reference) <= 0.0 {
            return 0.0;
        }
        let mut pmf = 1.0 - self.infinite_probability();
        let mut index = 0;
        while let Link::Second(second) = self.nodes[index].link {
            let Some(p_second) = self.second_probability(index, second as usize, reference) else {
                return 0.0;
            };
            if trail & 1 == 0 {
                index += 1;
                pmf *= 1.0 - p_second;
            } else {
                index = second as usize;
                pmf *= p_second;
            }
            trail >>= 1;
        }
        pmf
    }
}

type Item = (LightId, LightBounds);

struct Builder {
    nodes: Vec<Node>,
    places: Vec<Place>,
}

impl Builder {
    /// Appends the tree over `items` and returns its bounds.
    fn build(&mut self, items: &mut [Item], trail: u64, depth: u32) -> LightBounds {
        let index = self.nodes.len();
        if let [(id, bounds)] = items {
            self.nodes.push(Node { bounds: *bounds, link: Link::Leaf(*id) });
            self.places[id.0 as usize] = Place::Trail(trail);
            return *bounds;
        }
        let middle = split(items, depth);
        self.nodes.push(Node { bounds: LightBounds::EMPTY, link: Link::Second(0) });
        let (left, right) = items.split_at_mut(middle);
        let first_bounds = self.build(left, trail, depth + 1);
        let second = self.nodes.len();
        let second_bounds = self.build(right, trail | 1 << depth, depth + 1);
        let bounds = first_bounds.union(&second_bounds);
        self.nodes[index] = Node { bounds, link: Link::Second(second as u32) };
        bounds
    }
}

/// Orders `items` so that the two children are those before and from the returned index, neither empty.
fn split(items: &mut [Item], depth: u32) -> usize {
    let centroids = Bounds3::from_points(items.iter().map(|(_, b)| b.centroid()));
    let extent = centroids.diagonal();
    let by_count = |items: &mut [Item]| {
        let middle = items.len() / 2;
        let axis = extent.max_dimension();
        items.select_nth_unstable_by(middle, |a, b| {
            a.1.centroid()[axis].total_cmp(&b.1.centroid()[axis]).then(a.0.cmp(&b.0))
        });
        middle
    };
    if depth >= MAX_COSTED_DEPTH {
        return by_count(items);
    }
    let Some((axis, bucket)) = cheapest_split(items, &centroids) else { return by_count(items) };
    let mut middle = 0;
    for i in 0..items.len() {
        if bucket_of(&items[i].1, &centroids, axis) <= bucket {
            items.swap(i, middle);
            middle += 1;
        }
    }
    if middle == 0 || middle == items.len() { by_count(items) } else { middle }
}

/// Bucket along an axis; the extent of the centroids there must not be 0.
fn bucket_of(bounds: &LightBounds, centroids: &Bounds3, axis: usize) -> usize {
    let t = (bounds.centroid()[axis] - centroids.min[axis]) / (centroids.max[axis] - centroids.min[axis]);
    ((t * N_BUCKETS as f32) as usize).min(N_BUCKETS - 1)
}

/// Axis and last bucket of the first child for the split of least cost; `None` if all centroids coincide.
fn cheapest_split(items: &[Item], centroids: &Bounds3) -> Option<(usize, usize)> {
    let all = items.iter().fold(Bounds3::EMPTY, |sum, (_, b)| sum.union(b.bounds));
    let mut best: Option<(f32, usize, usize)> = None;
    for axis in 0..3 {
        if centroids.max[axis] <= centroids.min[axis] {
            continue;
        }
        let mut buckets = [LightBounds::EMPTY; N_BUCKETS];
        for (_, bounds) in items {
            let bucket = &mut buckets[bucket_of(bounds, centroids, axis)];
            *bucket = bucket.union(bounds);
        }
        let mut after = [LightBounds::EMPTY; N_BUCKETS];
        for i in (0..N_BUCKETS - 1).rev() {
            after[i] = after[i + 1].union(&buckets[i + 1]);
        }
        let mut before = LightBounds::EMPTY;
        for i in 0..N_BUCKETS - 1 {
            before = before.union(&buckets[i]);
            if before.bounds.is_empty() || after[i].bounds.is_empty() {
                continue;
            }
            let cost = cost(&before, &all, axis) + cost(&after[i], &all, axis);
            if best.is_none_or(|(least, _, _)| cost < least) {
                best = Some((cost, axis, i));
            }
        }
    }
    best.map(|(_, axis, bucket)| (axis, bucket))
}

/// Orientation-aware surface cost of a group within `all`; thin boxes along `axis` are favoured.
fn cost(group: &LightBounds, all: &Bounds3, axis: usize) -> f32 {
    let theta_o = safe_acos(group.cos_theta_o);
    let theta_e = safe_acos(group.cos_theta_e);
    let theta_w = (theta_o + theta_e).min(PI);
    let sin_o = theta_o.sin();
    let solid_angle = 2.0 * PI * (1.0 - group.cos_theta_o)
        + FRAC_PI_2
            * (2.0 * theta_w * sin_o - (theta_o - 2.0 * theta_w).cos() - 2.0 * theta_o * sin_o
                + group.cos_theta_o);
    let diagonal = all.diagonal();
    let regularity = diagonal.max_element() / diagonal[axis].max(f32::MIN_POSITIVE);
    // Groups of points on a line have no surface, but a long line is still worse than a short one.
    let size = group.bounds.surface_area() + 1e-3 * group.bounds.diagonal().length_squared();
    group.intensity * solid_angle.max(1e-3) * regularity * size
}
