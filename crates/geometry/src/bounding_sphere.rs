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
