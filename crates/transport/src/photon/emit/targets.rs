//! What photons are aimed at: balls around shapes.

use etendue_geometry::{BoundingSphere, GeometryId};
use etendue_math::{Bounds3, Point3, Vector3};
use etendue_scene::Scene;

use super::chart::Chart;

/// Most balls for lights at infinity, which look at each of them for each photon.
const MAX_DISCS: usize = 64;

/// Half angles of cones around all targets, in radians: directions of `f32` are some 1e-7 apart, and wide cones are no better than all
/// directions.
const LEAST_ANGLE: f32 = 2e-6;
const WIDEST_ANGLE: f32 = 0.5;

/// What photons are aimed at.
#[derive(Debug)]
pub(super) struct Targets {
    /// Up to 256.
    pub(super) spheres: Vec<BoundingSphere>,
    /// Fewer, for lights that look at each of them for each photon.
    pub(super) few_spheres: Vec<BoundingSphere>,
}

impl Targets {
    /// Balls around the wanted shapes.
    pub(super) fn new(scene: &Scene, wanted: &dyn Fn(GeometryId) -> bool) -> Self {
        let cover = |n| scene.geometry.covering_spheres(n, wanted);
        Self { spheres: cover(256), few_spheres: cover(MAX_DISCS / 2) }
    }

    /// The chart of a narrow cone that holds all directions from within a ball to them.
    pub(super) fn cone_from(&self, place: BoundingSphere) -> Option<Chart> {
        let corner = |ball: &BoundingSphere, sign: f32| ball.centre + Vector3::splat(sign * ball.radius);
        let first = self.spheres.first()?;
        let bounds = Bounds3 { min: corner(first, -1.0), max: corner(first, 1.0) };
        let bounds = self.spheres.iter().fold(bounds, |bounds, ball| Bounds3 {
            min: bounds.min.min(corner(ball, -1.0)),
            max: bounds.max.max(corner(ball, 1.0)),
        });
        let middle = bounds.min + (bounds.max - bounds.min) * 0.5;
        let reach = |ball: &BoundingSphere| (ball.centre - middle).length() + ball.radius;
        let radius = self.spheres.iter().map(reach).fold(0.0, f32::max);
        let way = middle - place.centre;
        let sine = (radius + place.radius + rounding(place.centre, middle)) / way.length();
        let angle = (sine < WIDEST_ANGLE.sin()).then(|| sine.asin())?;
        Some(Chart::cone(way.try_normalized()?, (1.001 * angle).max(LEAST_ANGLE)))
    }

    /// True if there are none.
    pub(super) const fn is_empty(&self) -> bool {
        self.spheres.is_empty()
    }
}

/// What rays from one point to another may miss it by.
pub(super) fn rounding(from: Point3, to: Point3) -> f32 {
    1e-5 * (from.as_vector().abs().max_element() + to.as_vector().abs().max_element())
}
