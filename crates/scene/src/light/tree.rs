//! A tree over lights with places, four children to a node; lights at infinity stand apart, and so do all where they are few
//! (Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting").
//!
//! From the root, a child is taken with probability in proportion to its importance for the point to be lit; the
//! importance of all children of a node is computed at once. The path to each light is kept as a trail of turns, so that
//! the probability of a given light is a walk down the same path. Built top-down: of 12 buckets along each axis, the split
//! with the least sum of intensity x solid angle of emission x surface of the box is taken, until a node has four parts.

use std::f32::consts::{FRAC_PI_2, PI};

use etendue_geometry::Reference;
use etendue_math::{Bounds3, Lanes4, ONE_MINUS_EPSILON, safe_acos};

use super::bounds::{BoundsOfFour, N_CHILDREN};
use super::{Light, LightBounds, LightContext, LightId};

const N_BUCKETS: usize = 12;
/// From this depth on, groups are halved by count, so that trails end before 64 bits.
const MAX_COSTED_DEPTH: u32 = 12;
/// No child that matters is taken less often than this.
const MIN_PROBABILITY: f32 = 1e-6;
/// So few lights are all asked, rather than one of them chosen: what a surface makes of the samples tells more than where
/// lights are.
const MOST_OF_FEW: usize = 4;
/// Bits of a trail per turn.
const BITS_PER_TURN: u32 = N_CHILDREN.ilog2();

#[derive(Clone, Copy, Debug)]
enum Child {
    /// Nothing.
    None,
    /// A light.
    Light(LightId),
    /// Another node.
    Node(u32),
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: BoundsOfFour,
    children: [Child; N_CHILDREN],
}

impl Node {
    /// Weight of each child for the point to be lit, and their sum; all 0 if none matters.
    #[inline]
    fn weights(&self, reference: &Reference) -> ([f32; N_CHILDREN], f32) {
        let importance = self.bounds.importance(reference);
        let least = Lanes4::splat(MIN_PROBABILITY * importance.sum());
        let zero = Lanes4::splat(0.0);
        let weights = importance.select_above(zero, importance.max(least), zero);
        (weights.0, weights.sum())
    }
}

/// Where the tree has a light.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    /// At infinity.
    Infinite,
    /// At the end of this path from the root: the lowest bits tell the first turn.
    Trail(u64),
    /// Nowhere: it emits nothing.
    Dark,
}

/// A tree over lights.
#[derive(Clone, Debug)]
pub struct LightTree {
    /// The root first; none if no light has a place.
    nodes: Vec<Node>,
    /// The lights that have a place, if they are so few that each is asked: then there is nothing to choose.
    few: Vec<LightId>,
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
        let is_few = finite.len() <= MOST_OF_FEW;
        let few = if is_few { finite.iter().map(|(id, _)| *id).collect() } else { Vec::new() };
        let mut builder = Builder { nodes: Vec::with_capacity(finite.len().div_ceil(2)), places };
        if !finite.is_empty() {
            builder.build(&mut finite, 0, 0);
        }
        Self { nodes: builder.nodes, few, infinite, places: builder.places }
    }

    /// Groups of lights that are sampled apart: the tree, or each of its lights if they are few, and each light at infinity.
    #[inline]
    #[must_use]
    pub fn n_groups(&self) -> usize {
        self.infinite.len() + if self.has_choice() { 1 } else { self.few.len() }
    }

    /// True if there are lights to choose between.
    #[inline]
    pub(super) fn has_choice(&self) -> bool {
        self.few.is_empty() && !self.nodes.is_empty()
    }

    /// A light of a group for the point `reference`, with its probability within the group.
    #[inline]
    #[must_use]
    pub fn sample(&self, group: usize, reference: &Reference, u: f32) -> Option<(LightId, f32)> {
        if let Some(id) = self.infinite.get(group) {
            return Some((*id, 1.0));
        }
        if self.has_choice() {
            return self.descend(reference, u);
        }
        self.few.get(group - self.infinite.len()).map(|id| (*id, 1.0))
    }

    fn descend(&self, reference: &Reference, mut u: f32) -> Option<(LightId, f32)> {
        let mut pmf = 1.0;
        let mut node = self.nodes.first()?;
        loop {
            let (weights, sum) = node.weights(reference);
            if sum <= 0.0 {
                return None;
            }
            let (turn, rest) = choose(&weights, u * sum);
            u = (rest / weights[turn]).clamp(0.0, ONE_MINUS_EPSILON);
            pmf *= weights[turn] / sum;
            match node.children[turn] {
                Child::None => return None,
                Child::Light(id) => return (pmf > 0.0).then_some((id, pmf)),
                Child::Node(index) => node = &self.nodes[index as usize],
            }
        }
    }

    /// Probability with which [`sample`](Self::sample) takes `light` of its group.
    #[inline]
    #[must_use]
    pub fn pmf(&self, reference: &Reference, light: LightId) -> f32 {
        match self.places[light.0 as usize] {
            Place::Dark => 0.0,
            Place::Infinite => 1.0,
            Place::Trail(_) if !self.few.is_empty() => 1.0,
            Place::Trail(trail) => self.pmf_along(trail, reference),
        }
    }

    fn pmf_along(&self, mut trail: u64, reference: &Reference) -> f32 {
        let mut pmf = 1.0;
        let mut node = &self.nodes[0];
        loop {
            let (weights, sum) = node.weights(reference);
            let turn = trail as usize % N_CHILDREN;
            if weights[turn] <= 0.0 {
                return 0.0;
            }
            pmf *= weights[turn] / sum;
            match node.children[turn] {
                Child::Node(index) => node = &self.nodes[index as usize],
                Child::Light(_) | Child::None => return pmf,
            }
            trail >>= BITS_PER_TURN;
        }
    }
}

/// The child in whose share of the line of all weights `position` lies, and how far into it; never one of weight 0
/// while another has some.
#[inline]
fn choose(weights: &[f32; N_CHILDREN], position: f32) -> (usize, f32) {
    let [a, b, c, _] = *weights;
    let ends = [a, a + b, (a + b) + c];
    let turn = ends.iter().map(|end| usize::from(position >= *end)).sum();
    if weights[turn] > 0.0 {
        let start = if turn == 0 { 0.0 } else { ends[turn - 1] };
        return (turn, position - start);
    }
    // Rounding led past the last share.
    (weights.iter().rposition(|weight| *weight > 0.0).unwrap_or(0), 0.0)
}

type Item = (LightId, LightBounds);

struct Builder {
    nodes: Vec<Node>,
    places: Vec<Place>,
}

impl Builder {
    /// Appends the tree over `items`, of which there is at least one, and returns the index of its root.
    fn build(&mut self, items: &mut [Item], trail: u64, depth: u32) -> u32 {
        let index = self.nodes.len();
        let mut node = Node { bounds: BoundsOfFour::EMPTY, children: [Child::None; N_CHILDREN] };
        self.nodes.push(node);
        for (turn, part) in split_in_four(items, depth).into_iter().enumerate() {
            let bounds = part.iter().fold(LightBounds::EMPTY, |sum, (_, bounds)| sum.union(bounds));
            node.bounds.set(turn, &bounds);
            let trail = trail | (turn as u64) << (BITS_PER_TURN * depth);
            node.children[turn] = if let [(id, _)] = part {
                self.places[id.0 as usize] = Place::Trail(trail);
                Child::Light(*id)
            } else {
                Child::Node(self.build(part, trail, depth + 1))
            };
        }
        self.nodes[index] = node;
        index as u32
    }
}

/// Cuts `items` in up to four parts, none empty: the largest part is split until there are four.
fn split_in_four(items: &mut [Item], depth: u32) -> Vec<&mut [Item]> {
    let mut parts = vec![items];
    while parts.len() < N_CHILDREN {
        let Some(largest) = (0..parts.len()).filter(|i| parts[*i].len() > 1).max_by_key(|i| parts[*i].len())
        else {
            break;
        };
        let part = std::mem::take(&mut parts[largest]);
        let middle = split(part, depth);
        let (left, right) = part.split_at_mut(middle);
        parts[largest] = left;
        parts.insert(largest + 1, right);
    }
    parts
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
