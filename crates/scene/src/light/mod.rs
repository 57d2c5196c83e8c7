//! Lights: what emits, how a point samples the light that reaches it, and how light leaves towards the scene.
//!
//! Direct light at a point x is an integral over directions (or, for point-like lights, a sum),
//!
//! ```text
//!   L_o(x, wo) = integral f(wo, wi) L_e(y -> x) V(x, y) |cos| dwi,
//! ```
//!
//! of which [`Light::sample_li`] draws one term: a direction `wi`, the radiance that arrives along it if nothing is
//! in the way, and the density per steradian. Visibility V is the caller's. For lights that are a delta function in
//! direction, the integral is already done: `le` is irradiance per unit cosine (I/r^2, or E for distant lights) and
//! `pdf_w` is 1. No other technique finds them (`is_delta`), nor surfaces that let all rays pass.
//!
//! **Units.** Radiance inside the renderer is K_m = 683 lm/W times W/(m^2 sr nm), so that its integral against
//! y-bar is luminance in cd/m^2 (see [`emission`]). Lights follow pbrt-v4 (Pharr, Jakob and Humphreys 2023,
//! "Physically Based Rendering", 4th ed., chapter 12) in names, geometry and scaling.
//!
//! Surfaces that emit may move ([`MovingAreaLight`]); other lights stand still, where their transform starts.
//!
//! # To add a light
//! 1. Write its file with a plain struct, the inherent methods of its neighbours (`sample_li`, `pdf_li`, `power`,
//!    `bounds`, `sample_le`, `pdf_le`), `PARAMETERS` and a `build` from [`Parameters`](crate::parameters::Parameters).
//! 2. Add a variant to [`Light`]; a struct of more than about 56 bytes goes to an arena of [`LightTables`] and the
//!    variant holds its id, since emissive meshes make many lights.
//! 3. Follow the compiler through the matches below, and add the name to [`LightKind`].
//! 4. Add a line to the tables in `tests/`: chi-square, integral of the density, power.

mod context;
pub mod emission;
mod image;
mod photometry;
mod photons;
mod profile;

mod directions;

mod area;
mod distant;
mod goniometric;
mod ies;
mod infinite_constant;
mod infinite_image;
mod infinite_portal;
mod point;
mod projection;
pub mod sky;
mod spot;

mod bounds;
mod sampler;
mod tree;

mod measure;

mod build;

pub(crate) use area::placed_area;
pub use area::{
    AreaEmission, AreaEmissionId, AreaLight, LightMotionId, LuminousProfile, LuminousProfileId,
    MovingAreaLight,
};
pub use bounds::LightBounds;
pub use build::LightKind;
pub use context::{EmittedRay, LightContext, LightPoint, LightSample, LightTables, SceneBox, SceneSphere};
pub use directions::Directions;
pub use distant::DistantLight;
pub use emission::{LightPower, LightUnits};
pub use goniometric::{GoniometricLight, GoniometricLightId};
pub use ies::{IesLight, IesLightId};
pub use image::{LightImage, LightImageId};
pub use infinite_constant::InfiniteConstantLight;
pub use infinite_image::{InfiniteImageLight, InfiniteImageLightId};
pub use infinite_portal::{InfinitePortalLight, InfinitePortalLightId, PortalError};
pub use measure::LightMeasure;
pub use photometry::{PhotometricWeb, Photometry};
pub use photons::{sample_sphere_by_rejection, share_photons};
pub use point::PointLight;
pub use profile::{Profile, sample_by_rejection};
pub use projection::{ProjectionLight, ProjectionLightId};
pub use sampler::{LightSampler, LightSamplerKind};
pub use sky::{SkyLight, SkyLightId, SunLight};
pub use spot::SpotLight;
pub use tree::LightTree;

use etendue_geometry::Reference;
use etendue_math::{Normal3, Point2, Point3, Ray, Vector3};
use etendue_spectrum::{Sampled, Wavelengths};

#[cfg(test)]
mod tests;

/// Index of a light of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LightId(pub u32);

/// A light. Small and without pointers: what is large lies in [`LightTables`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// A point that emits equally in all directions.
    Point(PointLight),
    /// A point that emits into a cone.
    Spot(SpotLight),
    /// Parallel light.
    Distant(DistantLight),
    /// A point with a picture of intensity over the sphere.
    Goniometric(GoniometricLightId),
    /// A point with measured intensity.
    Ies(IesLightId),
    /// A point that projects a picture.
    Projection(ProjectionLightId),
    /// The same radiance from all directions.
    InfiniteConstant(InfiniteConstantLight),
    /// A picture of radiance over the sphere of directions.
    InfiniteImage(InfiniteImageLightId),
    /// A picture of radiance seen through a rectangular opening.
    InfinitePortal(InfinitePortalLightId),
    /// The sky of a clear day, and the ground.
    Sky(SkyLightId),
    /// The sun's disc.
    Sun(SunLight),
    /// One primitive of an emissive shape.
    Area(AreaLight),
    /// One primitive of an emissive shape that moves.
    MovingArea(MovingAreaLight),
}

/// Calls the same method on whatever a light is, looked up in the tables where only an id is held.
macro_rules! dispatch {
    ($light:expr, $context:expr, $it:ident => $call:expr) => {
        match $light {
            Light::Point($it) => $call,
            Light::Spot($it) => $call,
            Light::Distant($it) => $call,
            Light::Goniometric(id) => {
                let $it = &$context.tables.goniometric[id.0 as usize];
                $call
            }
            Light::Ies(id) => {
                let $it = &$context.tables.luminaires[id.0 as usize];
                $call
            }
            Light::Projection(id) => {
                let $it = &$context.tables.projections[id.0 as usize];
                $call
            }
            Light::InfiniteConstant($it) => $call,
            Light::InfiniteImage(id) => {
                let $it = &$context.tables.environments[id.0 as usize];
                $call
            }
            Light::InfinitePortal(id) => {
                let $it = &$context.tables.portals[id.0 as usize];
                $call
            }
            Light::Sky(id) => {
                let $it = &$context.tables.skies[id.0 as usize];
                $call
            }
            Light::Sun($it) => $call,
            Light::Area($it) => $call,
            Light::MovingArea($it) => $call,
        }
    };
}

impl Light {
    /// A direction from `reference` to this light, with the radiance that arrives from there if nothing occludes it.
    #[inline]
    #[must_use]
    pub fn sample_li(
        &self,
        context: &LightContext,
        reference: &Reference,
        u: Point2,
        lambda: &Wavelengths,
    ) -> Option<LightSample> {
        dispatch!(self, context, light => light.sample_li(context, reference, u, lambda))
    }

    /// Density per steradian with which [`sample_li`](Self::sample_li) chooses the unit direction `wi`; 0 for delta
    /// lights. For area lights prefer [`pdf_li_at`](Self::pdf_li_at), which needs no intersection.
    #[must_use]
    pub fn pdf_li(&self, context: &LightContext, reference: &Reference, wi: Vector3) -> f32 {
        dispatch!(self, context, light => light.pdf_li(context, reference, wi))
    }

    /// The same density where the point of the light in direction `wi` is known: `p` with geometric normal `ng`.
    #[inline]
    #[must_use]
    pub fn pdf_li_at(
        &self,
        context: &LightContext,
        reference: &Reference,
        wi: Vector3,
        p: Point3,
        ng: Normal3,
    ) -> f32 {
        match self {
            Self::Area(light) => light.pdf_li_at(context, reference, p, ng),
            Self::MovingArea(light) => light.pdf_li_at(context, reference, p, ng),
            _ => self.pdf_li(context, reference, wi),
        }
    }

    /// Radiance along a ray that leaves the scene from `origin` in the unit direction `direction`; zero for lights
    /// that are not infinite and for distant lights.
    #[must_use]
    pub fn le_infinite(
        &self,
        context: &LightContext,
        origin: Point3,
        direction: Vector3,
        lambda: &Wavelengths,
    ) -> Sampled {
        match self {
            Self::InfiniteConstant(light) => light.le(context, lambda),
            Self::InfiniteImage(id) => {
                context.tables.environments[id.0 as usize].le(context, direction, lambda)
            }
            Self::InfinitePortal(id) => {
                context.tables.portals[id.0 as usize].le(context, origin, direction, lambda)
            }
            Self::Sky(id) => context.tables.skies[id.0 as usize].le(context, direction, lambda),
            Self::Sun(light) => light.le(context, direction, lambda),
            _ => Sampled::ZERO,
        }
    }

    /// Radiance that leaves a point of this light's surface, with geometric normal `ng` and texture coordinates `uv`,
    /// in the unit direction `wo`; zero for lights without a surface.
    #[must_use]
    pub fn le(
        &self,
        context: &LightContext,
        ng: Normal3,
        uv: Point2,
        wo: Vector3,
        lambda: &Wavelengths,
    ) -> Sampled {
        match self {
            Self::Area(light) => light.le(context, ng, uv, wo, lambda),
            Self::MovingArea(light) => light.le(context, ng, uv, wo, lambda),
            _ => Sampled::ZERO,
        }
    }

    /// A ray that carries light into the scene. `u_position` chooses where it starts, `u_direction` where it goes.
    #[must_use]
    pub fn sample_le(
        &self,
        context: &LightContext,
        u_position: Point2,
        u_direction: Point2,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        dispatch!(self, context, light => light.sample_le(context, u_position, u_direction, lambda))
    }

    /// A ray that leaves the light in the unit direction `w`, which is given: `pdf_w` is 1. `None` where it sends nothing, and
    /// for lights at infinity.
    #[must_use]
    pub fn emit_towards(
        &self,
        context: &LightContext,
        u_position: Point2,
        w: Vector3,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        let tables = context.tables;
        match self {
            Self::Point(light) => light.emit_towards(context, w, lambda),
            Self::Spot(light) => light.emit_towards(context, w, lambda),
            Self::Goniometric(id) => tables.goniometric[id.0 as usize].emit_towards(context, w, lambda),
            Self::Ies(id) => tables.luminaires[id.0 as usize].emit_towards(context, w, lambda),
            Self::Projection(id) => tables.projections[id.0 as usize].emit_towards(context, w, lambda),
            Self::Area(light) => light.emit_towards(context, u_position, w, lambda),
            Self::MovingArea(light) => light.emit_towards(context, u_position, w, lambda),
            Self::Distant(_)
            | Self::InfiniteConstant(_)
            | Self::InfiniteImage(_)
            | Self::InfinitePortal(_)
            | Self::Sky(_)
            | Self::Sun(_) => None,
        }
    }

    /// Densities (`pdf_a` per square metre, `pdf_w` per steradian) with which [`sample_le`](Self::sample_le) emits
    /// along `ray`; `ng` is the geometric normal at its origin for area lights. A delta factor counts as 0.
    #[must_use]
    pub fn pdf_le(&self, context: &LightContext, ray: &Ray, ng: Option<Normal3>) -> (f32, f32) {
        dispatch!(self, context, light => light.pdf_le(context, ray, ng))
    }

    /// Emitted flux. For infinite lights: that which passes through the sphere around the scene.
    #[must_use]
    pub fn power(&self, context: &LightContext) -> LightPower {
        dispatch!(self, context, light => light.power(context))
    }

    /// Where and in which directions light leaves; `None` for lights at infinity.
    #[must_use]
    pub fn bounds(&self, context: &LightContext) -> Option<LightBounds> {
        dispatch!(self, context, light => light.bounds(context))
    }

    /// True if no ray can meet the light by chance: its emission is a delta function of position or direction, or rays
    /// pass its surface.
    #[must_use]
    pub const fn is_delta(&self) -> bool {
        match self {
            Self::Point(_)
            | Self::Spot(_)
            | Self::Distant(_)
            | Self::Goniometric(_)
            | Self::Ies(_)
            | Self::Projection(_) => true,
            Self::InfiniteConstant(_)
            | Self::InfiniteImage(_)
            | Self::InfinitePortal(_)
            | Self::Sky(_)
            | Self::Sun(_) => false,
            Self::Area(light) => !light.is_visible(),
            Self::MovingArea(light) => !light.is_visible(),
        }
    }

    /// True if light comes from beyond the scene, so that it has no place (environments and distant lights).
    #[must_use]
    pub const fn is_infinite(&self) -> bool {
        matches!(
            self,
            Self::Distant(_)
                | Self::InfiniteConstant(_)
                | Self::InfiniteImage(_)
                | Self::InfinitePortal(_)
                | Self::Sky(_)
                | Self::Sun(_)
        )
    }

    /// True if rays that leave the scene see this light ([`le_infinite`](Self::le_infinite) may be non-zero).
    #[must_use]
    pub const fn is_environment(&self) -> bool {
        self.is_infinite() && !self.is_delta()
    }
}
