//! Surfaces that emit and move (SPEC CAM-4): at the time of the path they are where its rays meet them.
//!
//! The shape lies in a space of its own, which a motion places in the world. Points are sampled uniformly by area in that
//! space, whatever is lit. A map M of the time carries them and their density over: with unit vectors s, t along the surface,
//! its area grows by |M s x M t|. Cones of directions and spherical triangles are for lamps that stand still.

use etendue_geometry::{Geometry, GeometryId, Reference, ShapeSample, solid_angle_density};
use etendue_math::{Frame, Motion, Normal3, Point2, Point3, Ray, Transform, Vector3};
use etendue_spectrum::{Sampled, Wavelengths};

use super::{AreaEmission, AreaEmissionId};
use crate::light::{EmittedRay, LightBounds, LightContext, LightPower, LightSample, LightTables};

/// Times at which the area of a lamp that moves is looked at.
const N_TIMES: u32 = 8;

/// Index of a motion in [`LightTables`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LightMotionId(pub u32);

/// One primitive of an emissive shape that moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingAreaLight {
    /// The shape.
    pub geometry: GeometryId,
    /// Triangle or patch of the shape; 0 for quadrics.
    pub primitive: u32,
    /// What it emits.
    pub emission: AreaEmissionId,
    is_visible: bool,
    motion: LightMotionId,
}

impl MovingAreaLight {
    /// A primitive of a shape, with an emission and a motion of `tables`.
    #[must_use]
    pub fn new(
        geometry: GeometryId,
        primitive: u32,
        emission: AreaEmissionId,
        motion: LightMotionId,
        tables: &LightTables,
    ) -> Self {
        let is_visible = tables.emissions[emission.0 as usize].is_visible();
        Self { geometry, primitive, emission, is_visible, motion }
    }

    /// False if no ray meets its surface.
    #[must_use]
    pub const fn is_visible(&self) -> bool {
        self.is_visible
    }

    /// Radiance along the normal, the mean over the shape.
    #[must_use]
    pub fn mean_radiance(&self, context: &LightContext) -> LightPower {
        self.emission(context).mean_radiance(context)
    }

    fn emission<'a>(&self, context: &LightContext<'a>) -> &'a AreaEmission {
        &context.tables.emissions[self.emission.0 as usize]
    }

    fn motion<'a>(&self, context: &LightContext<'a>) -> &'a Motion {
        &context.tables.motions[self.motion.0 as usize]
    }

    /// A point in the world at the time of the context, uniform by area in the space of the shape.
    fn sample_point(&self, context: &LightContext, u: Point2) -> Option<ShapeSample> {
        let own = context.geometry.sample_area(self.geometry, self.primitive, u)?;
        let map = self.motion(context).at(context.time);
        Some(ShapeSample {
            p: map.point(own.p),
            p_error: map.point_error(own.p, own.p_error),
            n: unit(map.normal(own.n))?,
            pdf_a: own.pdf_a / stretch(&map, own.n),
            ..own
        })
    }

    /// Density per square metre of [`sample_point`](Self::sample_point) at a point of the world with unit normal `ng`.
    fn area_pdf(&self, context: &LightContext, p: Point3, ng: Normal3) -> f32 {
        let map = self.motion(context).at(context.time);
        let back = map.inverse();
        let Some(n) = unit(back.normal(ng)) else { return 0.0 };
        context.geometry.area_pdf(self.geometry, self.primitive, back.point(p), n) / stretch(&map, n)
    }

    pub(in crate::light) fn le(
        &self,
        context: &LightContext,
        ng: Normal3,
        uv: Point2,
        wo: Vector3,
        lambda: &Wavelengths,
    ) -> Sampled {
        self.emission(context).le(context, ng, uv, wo, lambda)
    }

    pub(in crate::light) fn sample_li(
        &self,
        context: &LightContext,
        reference: &Reference,
        u: Point2,
        lambda: &Wavelengths,
    ) -> Option<LightSample> {
        let point = self.sample_point(context, u)?;
        let pdf_w = solid_angle_density(point.pdf_a, point.p - reference.p, point.n);
        let sample = self.emission(context).towards(context, &point, pdf_w, reference, lambda)?;
        Some(LightSample { is_delta: !self.is_visible, ..sample })
    }

    pub(in crate::light) fn pdf_li(&self, context: &LightContext, reference: &Reference, wi: Vector3) -> f32 {
        let map = self.motion(context).at(context.time);
        let ray = map.inverse().ray(&Ray::new(reference.p, wi));
        let Some((t, n)) = context.geometry.meet(self.geometry, self.primitive, &ray) else { return 0.0 };
        let Some(ng) = unit(map.normal(n)) else { return 0.0 };
        self.pdf_li_at(context, reference, reference.p + wi * t, ng)
    }

    pub(in crate::light) fn pdf_li_at(
        &self,
        context: &LightContext,
        reference: &Reference,
        p: Point3,
        ng: Normal3,
    ) -> f32 {
        if !self.is_visible {
            return 0.0;
        }
        solid_angle_density(self.area_pdf(context, p, ng), p - reference.p, ng)
    }

    pub(in crate::light) fn sample_le(
        &self,
        context: &LightContext,
        u_position: Point2,
        u_direction: Point2,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        let point = self.sample_point(context, u_position)?;
        let mut emitted = self.emission(context).leaving(context, &point, u_direction, lambda)?;
        emitted.ray.time = context.time;
        Some(emitted)
    }

    pub(in crate::light) fn emit_towards(
        &self,
        context: &LightContext,
        u_position: Point2,
        w: Vector3,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        let point = self.sample_point(context, u_position)?;
        let mut emitted = self.emission(context).leaving_towards(context, &point, w, lambda)?;
        emitted.ray.time = context.time;
        Some(emitted)
    }

    pub(in crate::light) fn pdf_le(
        &self,
        context: &LightContext,
        ray: &Ray,
        ng: Option<Normal3>,
    ) -> (f32, f32) {
        let Some(ng) = ng else { return (0.0, 0.0) };
        let pdf_a = self.area_pdf(context, ray.origin, ng);
        (pdf_a, self.emission(context).leaving_pdf(context, ng.dot_vector(ray.direction)))
    }

    pub(in crate::light) fn power(&self, context: &LightContext) -> LightPower {
        self.emission(context).exitance() * f64::from(self.area(context))
    }

    /// Area in the world, the mean over the motion: a lamp that grows is chosen by what it will be, too.
    fn area(&self, context: &LightContext) -> f32 {
        let motion = self.motion(context);
        let ends = motion.ends();
        let area_at = |i: u32| {
            let share = (i as f32 + 0.5) / N_TIMES as f32;
            let map = motion.at(ends.start_time + share * (ends.end_time - ends.start_time));
            placed_area(context.geometry, self.geometry, self.primitive, &map)
        };
        (0..N_TIMES).map(area_at).sum::<f32>() / N_TIMES as f32
    }

    /// Wherever it comes by, and all directions: it may turn.
    pub(in crate::light) fn bounds(&self, context: &LightContext) -> Option<LightBounds> {
        let emission = self.emission(context);
        let own = context.geometry.primitive_bounds(self.geometry, self.primitive);
        let bounds = self.motion(context).ends().motion_bounds(own);
        let intensity = emission.peak_intensity(context) * f64::from(self.area(context));
        Some(LightBounds::point(bounds, intensity))
    }
}

/// Area of a primitive that a map places in the world, by what becomes of the surface in its middle: exact for flat ones, and
/// for others under maps that stretch all directions alike.
pub(crate) fn placed_area(
    geometry: &Geometry,
    id: GeometryId,
    primitive: u32,
    world_from_shape: &Transform,
) -> f32 {
    let middle = geometry.sample_area(id, primitive, Point2::splat(0.5));
    middle.map_or(0.0, |point| geometry.area(id, primitive) * stretch(world_from_shape, point.n))
}

/// The factor by which a map enlarges a surface with unit normal `n`.
fn stretch(map: &Transform, n: Normal3) -> f32 {
    let frame = Frame::from_z(n.as_vector());
    map.vector(frame.x).cross(map.vector(frame.y)).length()
}

fn unit(n: Normal3) -> Option<Normal3> {
    n.as_vector().try_normalized().map(|v| Normal3::new(v.x, v.y, v.z))
}
