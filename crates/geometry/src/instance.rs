//! Instances: a group of shapes placed in the world, still or moving (SPEC GEO-10).
//!
//! Rays are carried to the space of the group in double precision and rounded once, hits are carried back.
//! Directions are not normalised, so that t keeps its meaning.

#[cfg(test)]
mod tests;

use etendue_math::{AnimatedTransform, Bounds3, Motion, Normal3, Ray, Vector3};
use glam::{DAffine3, DMat3, DVec3, Vec4};

use crate::bvh::WideRay;
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
    group_from_world: Columns,
}

impl Maps {
    fn new(world_from_group: DAffine3) -> Self {
        Self { world_from_group, group_from_world: Columns::new(&world_from_group.inverse()) }
    }

    #[inline(never)]
    fn at(motion: &Motion, time: f32) -> Self {
        Self::new(double::affine(&motion.at(time)))
    }
}

impl Instance {
    /// Places a group.
    pub(crate) fn new(group: u32, world_from_object: &AnimatedTransform) -> Self {
        let motion = world_from_object.is_animated().then(|| Box::new(world_from_object.motion()));
        Self { group, maps: Maps::new(double::affine(&world_from_object.start)), motion }
    }

    /// True if its place depends on time.
    pub(crate) const fn is_moving(&self) -> bool {
        self.motion.is_some()
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
        self.motion.as_ref().map_or(self.maps, |motion| Maps::at(motion, time))
    }

    /// The ray in the space of the group.
    pub(crate) fn group_ray(&self, ray: &Ray) -> Ray {
        self.carried(ray).at(ray.time)
    }

    /// The same, ready for the hierarchy.
    #[inline(always)]
    pub(crate) fn carried(&self, ray: &Ray) -> WideRay {
        let moved;
        let columns = if let Some(motion) = &self.motion {
            moved = Maps::at(motion, ray.time).group_from_world;
            &moved
        } else {
            &self.maps.group_from_world
        };
        columns.carry(ray)
    }

    /// Carries a point, also given before rounding, to the world.
    pub(crate) fn world_point(&self, p: DVec3, point: &SurfacePoint, time: f32) -> SurfacePoint {
        let maps = self.maps(time);
        let map = &maps.world_from_group;
        let normals = NormalMap::new(&maps.group_from_world.linear());
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
        let normals = NormalMap::new(&maps.group_from_world.linear());
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

/// An affine map by its columns, each in four lanes of which the last holds 0: rays enter instances often.
#[derive(Clone, Copy, Debug)]
struct Columns([[f64; 4]; 4]);

impl Columns {
    fn new(map: &DAffine3) -> Self {
        let m = &map.matrix3;
        Self([m.x_axis, m.y_axis, m.z_axis, map.translation].map(|c| [c.x, c.y, c.z, 0.0]))
    }

    fn linear(&self) -> DMat3 {
        let [x, y, z, _] = self.0.map(|c| DVec3::new(c[0], c[1], c[2]));
        DMat3::from_cols(x, y, z)
    }

    /// The ray after the map, rounded once.
    #[inline(always)]
    fn carry(&self, ray: &Ray) -> WideRay {
        let [x, y, z, translation] = &self.0;
        let [px, py, pz] = [ray.origin.x, ray.origin.y, ray.origin.z].map(f64::from);
        let [dx, dy, dz] = [ray.direction.x, ray.direction.y, ray.direction.z].map(f64::from);
        let p = std::array::from_fn(|i| (x[i] * px + y[i] * py + z[i] * pz + translation[i]) as f32);
        let d = std::array::from_fn(|i| (x[i] * dx + y[i] * dy + z[i] * dz) as f32);
        WideRay { origin: Vec4::from_array(p), direction: Vec4::from_array(d) }
    }
}

/// The error in the world of a ray that starts at the point and has its origin rounded in the space of the group.
fn world_error(map: &DAffine3, p_error: Vector3) -> Vector3 {
    let m = map.matrix3;
    let error = double::vector(p_error);
    let carried = m.x_axis.abs() * error.x + m.y_axis.abs() * error.y + m.z_axis.abs() * error.z;
    double::to_vector(carried)
}
