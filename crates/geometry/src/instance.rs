//! Instances: a group of shapes placed in the world, still or moving (SPEC GEO-10).
//!
//! Rays are carried to the space of the group in double precision and rounded once, hits are carried back.
//! Directions are not normalised, so that t keeps its meaning.

#[cfg(test)]
mod tests;

use etendue_math::{AnimatedTransform, Bounds3, Motion, Normal3, Ray, Vector3};
use glam::{DAffine3, DVec3};

use crate::double::{self, NormalMap};
use crate::hit::{SurfaceDerivatives, SurfacePoint};
use crate::shape::LocalSurface;

/// A placed group.
#[derive(Clone, Debug)]
pub(crate) struct Instance {
    /// Index of its hierarchy.
    pub(crate) group: u32,
    /// Where it is; for a moving one, at the beginning.
    maps: Maps,
    motion: Option<Box<Motion>>,
}

/// Both directions of a map.
#[derive(Clone, Copy, Debug)]
struct Maps {
    world_from_group: DAffine3,
    group_from_world: DAffine3,
}

impl Maps {
    fn new(world_from_group: DAffine3) -> Self {
        Self { world_from_group, group_from_world: world_from_group.inverse() }
    }
}

impl Instance {
    /// Places a group.
    pub(crate) fn new(group: u32, world_from_object: &AnimatedTransform) -> Self {
        let motion = world_from_object.is_animated().then(|| Box::new(world_from_object.motion()));
        Self { group, maps: Maps::new(double::affine(&world_from_object.start)), motion }
    }

    /// The box of the group at all times, with room for rounding; `None` if there is nothing to hit.
    pub(crate) fn world_bounds(&self, bounds: Bounds3) -> Option<Bounds3> {
        if bounds.is_empty() {
            return None;
        }
        let bounds = match &self.motion {
            None => {
                let map = &self.maps.world_from_group;
                let place = |p| double::to_point(map.transform_point3(double::point(p)));
                Bounds3::from_points(bounds.corners().map(place))
            }
            Some(motion) => motion.ends().motion_bounds(bounds),
        };
        let largest = bounds.min.abs().max(bounds.max.abs());
        let margin = largest.as_vector() * (4.0 * f32::EPSILON) + Vector3::splat(f32::MIN_POSITIVE);
        let bounds = Bounds3 { min: bounds.min - margin, max: bounds.max + margin };
        (bounds.min.is_finite() && bounds.max.is_finite()).then_some(bounds)
    }

    fn maps(&self, time: f32) -> Maps {
        self.motion.as_ref().map_or(self.maps, |motion| Maps::new(double::affine(&motion.at(time))))
    }

    /// The ray in the space of the group.
    #[inline]
    pub(crate) fn group_ray(&self, ray: &Ray) -> Ray {
        if self.motion.is_some() {
            return carried(&self.maps(ray.time).group_from_world, ray);
        }
        carried(&self.maps.group_from_world, ray)
    }

    /// Carries a point, also given before rounding, to the world.
    pub(crate) fn world_point(&self, p: DVec3, point: &SurfacePoint, time: f32) -> SurfacePoint {
        let maps = self.maps(time);
        let map = &maps.world_from_group;
        let normals = NormalMap::new(&maps.group_from_world);
        let normal = |n: Normal3| double::to_normal(normals.apply(double::normal(n), [DVec3::ZERO; 2]).0);
        let p = double::to_point(map.transform_point3(p));
        SurfacePoint {
            p,
            p_error: double::rounding_error(p) + world_error(map, point.p_error),
            ng: normal(point.ng),
            ns: normal(point.ns),
            ..*point
        }
    }

    /// Carries derivatives to the world.
    pub(crate) fn world_derivatives(&self, local: &LocalSurface, time: f32) -> SurfaceDerivatives {
        let maps = self.maps(time);
        let vector =
            |v: Vector3| double::to_vector(maps.world_from_group.transform_vector3(double::vector(v)));
        let d = &local.derivatives;
        let normals = NormalMap::new(&maps.group_from_world);
        let (_, dn) = normals.apply(double::normal(local.point.ns), [d.dndu, d.dndv].map(double::vector));
        SurfaceDerivatives {
            dpdu: vector(d.dpdu),
            dpdv: vector(d.dpdv),
            shading_dpdu: vector(d.shading_dpdu),
            shading_dpdv: vector(d.shading_dpdv),
            dndu: double::to_vector(dn[0]),
            dndv: double::to_vector(dn[1]),
        }
    }

    /// Bytes on the heap.
    pub(crate) const fn memory_bytes(&self) -> usize {
        if self.motion.is_some() { size_of::<Motion>() } else { 0 }
    }
}

/// The ray after a map, rounded once.
#[inline(always)]
fn carried(map: &DAffine3, ray: &Ray) -> Ray {
    let origin = map.transform_point3(double::point(ray.origin));
    let direction = map.transform_vector3(double::vector(ray.direction));
    Ray { origin: double::to_point(origin), direction: double::to_vector(direction), time: ray.time }
}

/// The error in the world of a ray that starts at the point and has its origin rounded in the space of the group.
fn world_error(map: &DAffine3, p_error: Vector3) -> Vector3 {
    let m = map.matrix3;
    let error = double::vector(p_error);
    let carried = m.x_axis.abs() * error.x + m.y_axis.abs() * error.y + m.z_axis.abs() * error.z;
    double::to_vector(carried)
}
