//! Surfaces that emit on one or both sides: the same radiance L in all directions, Phi = pi A L for one side (SPEC RAD-9,
//! EMI-5, EMI-6), or less away from the normal, by a [`Profile`] (EMI-8). Each primitive of an emissive shape is a light; what it emits is shared.
//!
//! As in pbrt-v4, a picture is looked up with the shape's (u, v), v upwards. Power is split between the primitives by
//! area: `power` of a mesh is that of the whole shape (pbrt-v4 gives that power to every triangle).
//!
//! **Alpha.** Rays meet a surface of alpha a with probability a, and then find the radiance L; a sample of the light
//! therefore returns the mean, a L. Constant alpha 0 is the exception, as in pbrt-v4: it makes an invisible light, whose
//! surface no ray meets, but which is sampled with the whole of L. Sampling is then the only technique that finds it, so
//! that it counts as a delta light in multiple importance sampling.

mod emission;
mod luminous;
mod moving;

use etendue_geometry::{FlatLamp, Geometry, GeometryId, Lamp, Reference, ShapeSample};
use etendue_math::{Normal3, Point2, Point3, Ray, Vector3};
use etendue_spectrum::{Sampled, Wavelengths};

use super::{Directions, EmittedRay, LightBounds, LightContext, LightPower, LightSample, LightTables};

pub use emission::{AreaEmission, AreaEmissionId};
pub use luminous::{LuminousProfile, LuminousProfileId};
pub(crate) use moving::placed_area;
pub use moving::{LightMotionId, MovingAreaLight};

/// One primitive of an emissive shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaLight {
    /// The shape.
    pub geometry: GeometryId,
    /// Triangle or patch of the shape; 0 for quadrics and for two triangles that are one lamp.
    pub primitive: u32,
    /// What it emits.
    pub emission: AreaEmissionId,
    is_visible: bool,
    /// For the usual lamp a short way to its points.
    lamp: Option<Lamp>,
}

impl AreaLight {
    /// A primitive of the shape `id` of `geometry` with an emission of `tables`.
    #[must_use]
    pub fn new(
        geometry: &Geometry,
        id: GeometryId,
        primitive: u32,
        emission: AreaEmissionId,
        tables: &LightTables,
    ) -> Self {
        let emitted = &tables.emissions[emission.0 as usize];
        let lamp = geometry.lamp(id, primitive).filter(|lamp| !emitted.varies() || lamp.has_places());
        Self { geometry: id, primitive, emission, is_visible: emitted.is_visible(), lamp }
    }

    /// The whole of a shape as one light, if it is a parallelogram of two triangles that emits the same everywhere.
    #[must_use]
    pub fn joined(
        geometry: &Geometry,
        id: GeometryId,
        emission: AreaEmissionId,
        tables: &LightTables,
    ) -> Option<Self> {
        let lamp = geometry.joined_lamp(id)?;
        let emitted = &tables.emissions[emission.0 as usize];
        let is_visible = emitted.is_visible();
        (!emitted.varies()).then_some(Self {
            geometry: id,
            primitive: 0,
            emission,
            is_visible,
            lamp: Some(lamp),
        })
    }

    /// The lamp, if it is flat, which may be more than the primitive.
    fn flat_lamp(&self) -> Option<&FlatLamp> {
        self.lamp.as_ref().and_then(Lamp::flat)
    }

    fn area(&self, context: &LightContext) -> f32 {
        let of_primitive = || context.geometry.area(self.geometry, self.primitive);
        self.flat_lamp().map_or_else(of_primitive, FlatLamp::area)
    }

    /// A point as seen from `reference`, with its density per steradian; with texture coordinates if `varies`.
    #[inline(always)]
    fn sample_point(
        &self,
        context: &LightContext,
        reference: &Reference,
        u: Point2,
        varies: bool,
    ) -> Option<(ShapeSample, f32)> {
        let Some(lamp) = &self.lamp else {
            return context.geometry.sample_from(self.geometry, self.primitive, reference, u);
        };
        let (mut sample, pdf_w, place) = lamp.sample_from(reference, u)?;
        if varies {
            sample.uv = context.geometry.texture_coordinates(self.geometry, self.primitive, place);
        }
        Some((sample, pdf_w))
    }

    /// Radiance along the normal, the mean over the shape.
    #[must_use]
    pub fn mean_radiance(&self, context: &LightContext) -> LightPower {
        self.emission(context).mean_radiance(context)
    }

    /// False if no ray meets its surface.
    #[must_use]
    pub const fn is_visible(&self) -> bool {
        self.is_visible
    }

    #[inline]
    fn emission<'a>(&self, context: &LightContext<'a>) -> &'a AreaEmission {
        &context.tables.emissions[self.emission.0 as usize]
    }

    #[inline]
    pub(super) fn le(
        &self,
        context: &LightContext,
        ng: Normal3,
        uv: Point2,
        wo: Vector3,
        lambda: &Wavelengths,
    ) -> Sampled {
        self.emission(context).le(context, ng, uv, wo, lambda)
    }

    #[inline(always)]
    pub(super) fn sample_li(
        &self,
        context: &LightContext,
        reference: &Reference,
        u: Point2,
        lambda: &Wavelengths,
    ) -> Option<LightSample> {
        let emission = self.emission(context);
        let (s, pdf_w) = self.sample_point(context, reference, u, emission.varies())?;
        let sample = emission.towards(context, &s, pdf_w, reference, lambda)?;
        Some(LightSample { is_delta: !self.is_visible, ..sample })
    }

    pub(super) fn pdf_li(&self, context: &LightContext, reference: &Reference, wi: Vector3) -> f32 {
        if !self.is_visible {
            return 0.0;
        }
        match self.flat_lamp() {
            Some(lamp) => {
                let hit = lamp.intersect(&Ray::new(reference.p, wi));
                hit.map_or(0.0, |p| lamp.pdf_from(reference, p))
            }
            None => context.geometry.pdf_from(self.geometry, self.primitive, reference, wi),
        }
    }

    #[inline]
    pub(super) fn pdf_li_at(
        &self,
        context: &LightContext,
        reference: &Reference,
        p: Point3,
        ng: Normal3,
    ) -> f32 {
        if !self.is_visible {
            return 0.0;
        }
        match &self.lamp {
            Some(lamp) => lamp.pdf_from(reference, p),
            None => context.geometry.pdf_from_point(self.geometry, self.primitive, reference, p, ng),
        }
    }

    pub(super) fn sample_le(
        &self,
        context: &LightContext,
        u_position: Point2,
        u_direction: Point2,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        let emission = self.emission(context);
        let s = match self.flat_lamp() {
            Some(lamp) if !emission.varies() => lamp.sample_area(u_position),
            _ => context.geometry.sample_area(self.geometry, self.primitive, u_position)?,
        };
        emission.leaving(context, &s, u_direction, lambda)
    }

    /// A ray in the direction `w`: from a place of the lamp that is uniform in area, on spheres in proportion to its cosine.
    pub(super) fn emit_towards(
        &self,
        context: &LightContext,
        u_position: Point2,
        w: Vector3,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        let emission = self.emission(context);
        let s = match &self.lamp {
            Some(Lamp::Sphere(globe)) if !emission.two_sided() => globe.sample_facing(w, u_position),
            Some(Lamp::Flat(lamp)) if !emission.varies() => lamp.sample_area(u_position),
            _ => context.geometry.sample_area(self.geometry, self.primitive, u_position)?,
        };
        emission.leaving_towards(context, &s, w, lambda)
    }

    /// In which directions it sends flux.
    pub(super) fn directions(&self, context: &LightContext) -> Directions {
        let emission = self.emission(context);
        if let Some(Lamp::Sphere(_)) = self.lamp
            && !emission.two_sided()
            && emission.is_matte()
        {
            return Directions::Sphere;
        }
        let (axis, cos_normals) = context.geometry.emission_cone(self.geometry, self.primitive);
        if cos_normals < 1.0 - 1e-6 || emission.is_tabulated() {
            return Directions::Varied;
        }
        Directions::Cosine { axis, cos_max: emission.cos_max(), two_sided: emission.two_sided() }
    }

    /// True if all rays that it sends carry the same flux.
    pub(super) fn is_even(&self, context: &LightContext) -> bool {
        self.emission(context).is_even()
    }

    pub(super) fn pdf_le(&self, context: &LightContext, ray: &Ray, ng: Option<Normal3>) -> (f32, f32) {
        let Some(ng) = ng else { return (0.0, 0.0) };
        let cosine = ng.dot_vector(ray.direction);
        (1.0 / self.area(context), self.emission(context).leaving_pdf(context, cosine))
    }

    pub(super) fn power(&self, context: &LightContext) -> LightPower {
        let area = self.area(context);
        self.emission(context).exitance() * f64::from(area)
    }

    pub(super) fn bounds(&self, context: &LightContext) -> Option<LightBounds> {
        let emission = self.emission(context);
        let of_primitive = || context.geometry.primitive_bounds(self.geometry, self.primitive);
        let (w, cos_theta_o) = context.geometry.emission_cone(self.geometry, self.primitive);
        let area = self.area(context);
        Some(LightBounds {
            bounds: self.flat_lamp().map_or_else(of_primitive, FlatLamp::bounds),
            w,
            cos_theta_o,
            cos_theta_e: emission.cos_max(),
            intensity: (emission.peak_intensity(context) * f64::from(area)) as f32,
            two_sided: emission.two_sided(),
        })
    }
}
