//! The surroundings as a picture of radiance over the sphere of directions, in the equal-area layout of Clarberg 2008
//! ("Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD"); directions are sampled in proportion to the texels.
//!
//! Every texel covers the same solid angle, so pdf_w = pdf(u, v) / (4 pi). The transform should keep angles.

use std::f32::consts::PI;

use etendue_geometry::Reference;
use etendue_math::{Bounds2, Normal3, PiecewiseConstant2, Point2, Ray, Transform, Vector3, warp};
use etendue_spectrum::{Sampled, Wavelengths};

use super::build::{self, Picture};
use super::context::infinite_sample;
use super::image::sampling_weights;
use super::{
    EmittedRay, LightBounds, LightContext, LightImage, LightImageId, LightPower, LightSample, LightTables,
};
use crate::parameters::Parameters;

/// Index of a pictured environment in [`LightTables`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct InfiniteImageLightId(pub u32);

/// A pictured environment.
#[derive(Clone, Debug)]
pub struct InfiniteImageLight {
    world_from_light: Transform,
    light_from_world: Transform,
    image: LightImageId,
    /// Radiance where the picture is 1, relative to the illuminant of the picture.
    scale: f32,
    distribution: PiecewiseConstant2,
}

impl InfiniteImageLight {
    /// An environment from a square linear RGB picture. `scale` is in multiples of the picture's illuminant.
    #[must_use]
    pub(super) fn new(
        tables: &mut LightTables,
        world_from_light: &Transform,
        picture: &Picture,
        scale: f32,
    ) -> Self {
        assert_eq!(picture.width, picture.height, "an equal-area picture is square");
        let domain = Bounds2::new(Point2::splat(0.0), Point2::splat(1.0));
        let weights = sampling_weights(&picture.rgb);
        let image =
            LightImage::new(picture.width, picture.height, &picture.rgb, picture.space, picture.white);
        Self {
            world_from_light: *world_from_light,
            light_from_world: world_from_light.inverse(),
            image: tables.add_image(image),
            scale,
            distribution: PiecewiseConstant2::new(&weights, picture.width, picture.height, domain),
        }
    }

    pub(super) fn build(
        p: &mut Parameters,
        world_from_light: &Transform,
        tables: &mut LightTables,
    ) -> Option<Self> {
        let size = build::PictureScale::read(p);
        let illuminance = p.float("illuminance", -1.0);
        let picture = build::read_square_picture(p)?;
        let scale = size.factor(p, &picture, illuminance, picture.upper_irradiance(), 1.0);
        Some(Self::new(tables, world_from_light, &picture, scale))
    }

    fn square_from_world(&self, w: Vector3) -> Option<Point2> {
        let w_light = self.light_from_world.vector(w).try_normalized()?;
        Some(warp::equal_area_sphere_to_square(w_light))
    }

    fn radiance(&self, context: &LightContext, uv: Point2, lambda: &Wavelengths) -> Sampled {
        context.tables.image(self.image).nearest(uv, context.spectra, lambda) * self.scale
    }

    pub(super) fn le(&self, context: &LightContext, direction: Vector3, lambda: &Wavelengths) -> Sampled {
        self.square_from_world(direction).map_or(Sampled::ZERO, |uv| self.radiance(context, uv, lambda))
    }

    /// A direction from the scene, its place in the picture and its density per steradian.
    fn sample_direction(&self, u: Point2) -> Option<(Vector3, Point2, f32)> {
        let (uv, pdf_uv) = self.distribution.sample(u);
        let wi = self.world_from_light.vector(warp::equal_area_square_to_sphere(uv)).try_normalized()?;
        Some((wi, uv, pdf_uv / (4.0 * PI)))
    }

    fn pdf_direction(&self, w: Vector3) -> f32 {
        self.square_from_world(w).map_or(0.0, |uv| self.distribution.pdf(uv) / (4.0 * PI))
    }

    pub(super) fn sample_li(
        &self,
        context: &LightContext,
        _reference: &Reference,
        u: Point2,
        lambda: &Wavelengths,
    ) -> Option<LightSample> {
        let (wi, uv, pdf_w) = self.sample_direction(u)?;
        infinite_sample(wi, self.radiance(context, uv, lambda), pdf_w)
    }

    pub(super) fn pdf_li(&self, _: &LightContext, _: &Reference, wi: Vector3) -> f32 {
        self.pdf_direction(wi)
    }

    pub(super) fn sample_le(
        &self,
        context: &LightContext,
        u_position: Point2,
        u_direction: Point2,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        let (wi, uv, pdf_w) = self.sample_direction(u_direction)?;
        let le = self.radiance(context, uv, lambda);
        EmittedRay::from_infinity(context.tables, -wi, u_position, le, pdf_w)
    }

    pub(super) fn pdf_le(&self, context: &LightContext, ray: &Ray, _: Option<Normal3>) -> (f32, f32) {
        (context.tables.entry_pdf(ray.direction), self.pdf_direction(-ray.direction))
    }

    pub(super) fn power(&self, context: &LightContext) -> LightPower {
        let factor = 4.0 * PI * context.tables.scene_sphere.cross_section() * self.scale;
        LightPower::of(&context.tables.image(self.image).mean(), context.spectra) * f64::from(factor)
    }

    pub(super) const fn bounds(&self, _: &LightContext) -> Option<LightBounds> {
        None
    }
}
