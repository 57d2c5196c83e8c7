//! Spheres around what is there: each object, clusters of them, and the scene (SPEC GEO-13).
//!
//! Lights that look for what they might illuminate (projection maps, photon shooting) ask for cones of directions; a sphere gives
//! one with a cosine and no corners. They are those around boxes, moved outwards by rounding, so that whatever a ray can meet
//! at any time lies within.

#[cfg(test)]
mod tests;

use etendue_math::{Bounds3, Point3, Vector3};

use crate::geometry::Geometry;
use crate::hit::GeometryId;
use crate::instance::Instance;
use crate::shape::entity::Entity;

/// A ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingSphere {
    /// Its centre.
    pub centre: Point3,
    /// Its radius in metres.
    pub radius: f32,
}

impl BoundingSphere {
    /// The ball around a box; `None` around nothing.
    #[must_use]
    pub fn around(bounds: Bounds3) -> Option<Self> {
        if bounds.is_empty() {
            return None;
        }
        let centre = bounds.min.lerp(bounds.max, 0.5);
        let reach = (bounds.max - centre).abs().max((centre - bounds.min).abs());
        let rounding = centre.as_vector().abs().max_element() * f32::EPSILON;
        let radius = reach.length() * (1.0 + 4.0 * f32::EPSILON) + rounding;
        Some(Self { centre, radius })
    }

    /// The smallest ball around two.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        let way = other.centre - self.centre;
        let distance = way.length();
        if distance + other.radius <= self.radius {
            return self;
        }
        if distance + self.radius <= other.radius {
            return other;
        }
        let radius = 0.5 * (distance + self.radius + other.radius);
        let centre = self.centre + way * ((radius - self.radius) / distance);
        let rounding = centre.as_vector().abs().max_element() * f32::EPSILON;
        Self { centre, radius: radius * (1.0 + 8.0 * f32::EPSILON) + 2.0 * rounding }
    }

    /// True if a point lies within.
    #[must_use]
    pub fn contains(&self, p: Point3) -> bool {
        p.distance(self.centre) <= self.radius
    }

    /// Axis and cosine of the half angle of the cone of directions from `p` that may meet the ball; all directions from within.
    #[must_use]
    pub fn cone_from(&self, p: Point3) -> (Vector3, f32) {
        let way = self.centre - p;
        let distance = way.length();
        if distance <= self.radius {
            return (Vector3::new(0.0, 0.0, 1.0), -1.0);
        }
        let sine = self.radius / distance;
        (way / distance, (1.0 - sine * sine).max(0.0).sqrt())
    }
}

/// An object of the scene: a shape that stands in the world, or an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ObjectReference {
    /// A shape entity of the world.
    Shape(GeometryId),
    /// The instance of that index.
    Instance(u32),
}

impl Geometry {
    /// The ball around everything, at all times.
    #[must_use]
    pub fn bounding_sphere(&self) -> Option<BoundingSphere> {
        BoundingSphere::around(self.bounds())
    }

    /// Each object of the world that can be hit, with the ball around it at all times: first shapes, then instances.
    #[must_use]
    pub fn object_spheres(&self) -> Vec<(ObjectReference, BoundingSphere)> {
        let shapes = (0..self.entities.len() as u32).filter_map(|index| {
            let is_in_world = self.entity_groups[index as usize] == crate::builder::WORLD;
            let bounds = is_in_world.then(|| self.entities[index as usize].whole_bounds())?;
            Some((ObjectReference::Shape(GeometryId(index)), BoundingSphere::around(bounds)?))
        });
        let instances = (0..self.instances.len() as u32).filter_map(|index| {
            let instance = &self.instances[index as usize];
            let bounds = instance.world_bounds(self.groups[instance.group as usize].bounds())?;
            Some((ObjectReference::Instance(index), BoundingSphere::around(bounds)?))
        });
        shapes.chain(instances).collect()
    }

    /// Balls that together hold all that the wanted shapes of the world and of instances are made of, at all times: each shape
    /// of many primitives has some for its parts, and what is flat is covered by small ones. About at most `n_balls`.
    #[must_use]
    pub fn covering_spheres(
        &self,
        n_balls: usize,
        wanted: &dyn Fn(GeometryId) -> bool,
    ) -> Vec<BoundingSphere> {
        let ids = (0..self.entities.len() as u32).filter(|index| wanted(GeometryId(*index)));
        let (in_world, in_objects): (Vec<u32>, Vec<u32>) =
            ids.partition(|index| self.entity_groups[*index as usize] == crate::builder::WORLD);
        let mut boxes = Vec::new();
        let mut spheres = Vec::new();
        for index in in_world {
            match &self.entities[index as usize] {
                Entity::Sphere(sphere) if 2 * spheres.len() < n_balls => spheres.push(sphere.globe().ball()),
                entity => boxes.extend(parts(entity)),
            }
        }
        boxes.extend(self.instance_boxes(&in_objects));
        let n_left = n_balls - spheres.len().min(n_balls);
        let boxes = joined(boxes, n_left);
        let n_pieces = (n_left / boxes.len().max(1)).clamp(1, MAX_PIECES);
        let pieces = boxes.into_iter().flat_map(|bounds| cut(bounds, n_pieces));
        spheres.extend(pieces.filter_map(BoundingSphere::around));
        spheres
    }

    /// Boxes in the world around parts of all instances of these shapes of objects: the more instances there are, the fewer
    /// for each, so that at most [`MAX_INSTANCE_BOXES`], or one for each instance, need memory.
    fn instance_boxes(&self, shapes: &[u32]) -> Vec<Bounds3> {
        let mut of_groups = vec![Vec::new(); self.groups.len()];
        for index in shapes {
            let group = self.entity_groups[*index as usize] as usize;
            of_groups[group].extend(parts(&self.entities[*index as usize]));
        }
        let is_wanted = |instance: &&Instance| !of_groups[instance.group as usize].is_empty();
        let n_each = MAX_INSTANCE_BOXES / self.instances.iter().filter(is_wanted).count().max(1);
        let of_groups: Vec<Vec<Bounds3>> = of_groups.into_iter().map(|boxes| joined(boxes, n_each)).collect();
        let placed = |instance: &Instance| -> Vec<Bounds3> {
            let own = &of_groups[instance.group as usize];
            own.iter().filter_map(|bounds| instance.world_bounds(*bounds)).collect()
        };
        self.instances.iter().flat_map(placed).collect()
    }

    /// The same in at most `n_clusters` groups of neighbours, each with a ball around all of its objects: ranges of objects in order
    /// along the longest side of what they fill, cut in halves.
    #[must_use]
    pub fn object_clusters(&self, n_clusters: usize) -> Vec<(Vec<ObjectReference>, BoundingSphere)> {
        let mut clusters = vec![self.object_spheres()];
        while clusters.len() < n_clusters {
            let largest = (0..clusters.len()).max_by_key(|&i| (clusters[i].len(), std::cmp::Reverse(i)));
            let Some(largest) = largest.filter(|&i| clusters[i].len() > 1) else { break };
            let mut first = std::mem::take(&mut clusters[largest]);
            let centres = Bounds3::from_points(first.iter().map(|(_, sphere)| sphere.centre));
            let axis = (centres.max - centres.min).max_dimension();
            first.sort_by(|(_, a), (_, b)| a.centre.as_vector()[axis].total_cmp(&b.centre.as_vector()[axis]));
            let second = first.split_off(first.len() / 2);
            clusters[largest] = first;
            clusters.push(second);
        }
        let joined = |cluster: Vec<(ObjectReference, BoundingSphere)>| {
            let sphere = cluster.iter().map(|(_, sphere)| *sphere).reduce(BoundingSphere::union)?;
            Some((cluster.into_iter().map(|(object, _)| object).collect(), sphere))
        };
        clusters.into_iter().filter_map(joined).collect()
    }
}

/// Most boxes around parts of instances, unless there are more instances: 1.5 MB.
const MAX_INSTANCE_BOXES: usize = 1 << 16;

/// Most cells that the primitives of a shape are cut by, as a power of two.
const LOG2_PARTS: u32 = 6;

/// Most pieces of a flat or long box.
const MAX_PIECES: usize = 16;

/// Boxes around parts of a shape: of what lies in each cell of a grid. No more than primitives.
fn parts(entity: &Entity) -> Vec<Bounds3> {
    let whole = entity.whole_bounds();
    let Some(log2_parts) = entity.n_primitives().checked_ilog2().filter(|_| !whole.is_empty()) else {
        return Vec::new();
    };
    let grid = Grid::new(whole, log2_parts.min(LOG2_PARTS));
    let mut cells = vec![Bounds3::EMPTY; grid.n.iter().product()];
    for bounds in (0..entity.n_primitives()).map(|primitive| entity.bounds(primitive)) {
        if !bounds.is_empty() && bounds.min.is_finite() && bounds.max.is_finite() {
            grid.add(bounds, &mut cells);
        }
    }
    cells.retain(|cell| !cell.is_empty());
    cells
}

/// Cells that are about as wide as deep and high.
struct Grid {
    whole: Bounds3,
    n: [usize; 3],
}

impl Grid {
    /// With 2^`log2_cells` cells; with one if the box is infinite.
    fn new(whole: Bounds3, log2_cells: u32) -> Self {
        let mut n = [1; 3];
        let extent = whole.diagonal();
        for _ in 0..if extent.is_finite() { log2_cells } else { 0 } {
            let side = |axis: usize| extent[axis] / n[axis] as f32;
            let longest =
                (1..3).fold(0, |longest, axis| if side(axis) > side(longest) { axis } else { longest });
            n[longest] *= 2;
        }
        Self { whole, n }
    }

    fn cell_at(&self, axis: usize, p: f32) -> usize {
        let place = (p - self.whole.min[axis]) / (self.whole.max[axis] - self.whole.min[axis]);
        // Not a number where it is flat, which is the first cell.
        ((place * self.n[axis] as f32) as usize).min(self.n[axis] - 1)
    }

    /// Unites a box with the cells, each with what it has of the box. Neighbours share an edge, and the outer ones go as far as
    /// the box: nothing falls between them.
    fn add(&self, bounds: Bounds3, cells: &mut [Bounds3]) {
        let [x, y, z] = std::array::from_fn(|axis| {
            (self.cell_at(axis, bounds.min[axis]), self.cell_at(axis, bounds.max[axis]))
        });
        let clip = |part: &mut Bounds3, axis: usize, i: usize, (first, last): (usize, usize)| {
            let edge = |i: usize| {
                let (min, max) = (self.whole.min[axis], self.whole.max[axis]);
                (min + (max - min) * (i as f32 / self.n[axis] as f32))
                    .clamp(bounds.min[axis], bounds.max[axis])
            };
            part.min[axis] = if i > first { edge(i) } else { bounds.min[axis] };
            part.max[axis] = if i < last { edge(i + 1) } else { bounds.max[axis] };
        };
        let mut part = bounds;
        for i in x.0..=x.1 {
            clip(&mut part, 0, i, x);
            for j in y.0..=y.1 {
                clip(&mut part, 1, j, y);
                for k in z.0..=z.1 {
                    clip(&mut part, 2, k, z);
                    let cell = &mut cells[(i * self.n[1] + j) * self.n[2] + k];
                    *cell = cell.union(part);
                }
            }
        }
    }
}

/// At most about `n` boxes that hold these: neighbours along the longest side of what they fill are joined.
fn joined(boxes: Vec<Bounds3>, n: usize) -> Vec<Bounds3> {
    if boxes.len() <= n.max(1) {
        return boxes;
    }
    if n <= 1 {
        return vec![boxes.into_iter().fold(Bounds3::EMPTY, Bounds3::union)];
    }
    let axis = Bounds3::from_points(boxes.iter().map(|b| b.centroid())).diagonal().max_dimension();
    let mut first = boxes;
    first.sort_by(|a, b| a.centroid()[axis].total_cmp(&b.centroid()[axis]));
    let second = first.split_off(first.len() / 2);
    let mut all = joined(first, n / 2);
    all.extend(joined(second, n - n / 2));
    all
}

/// A box in at most `n` pieces: cut in halves across the longest side while that is more than twice the shortest, so that balls
/// around the pieces stay near what is flat or long.
fn cut(bounds: Bounds3, n: usize) -> Vec<Bounds3> {
    let mut pieces = vec![bounds];
    while 2 * pieces.len() <= n {
        let side = pieces[0].diagonal();
        let axis = side.max_dimension();
        if side[axis] <= 2.0 * side[0].min(side[1]).min(side[2]) {
            break;
        }
        pieces = pieces
            .into_iter()
            .flat_map(|piece| {
                let middle = piece.centroid()[axis];
                let (mut low, mut high) = (piece, piece);
                low.max[axis] = middle;
                high.min[axis] = middle;
                [low, high]
            })
            .collect();
    }
    pieces
}
