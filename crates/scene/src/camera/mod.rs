//! Cameras (SPEC CAM-1 to CAM-4): from a place on the film, on the lens and in time to a ray, and back.
//!
//! Camera space has +z ahead and +y up. Raster coordinates count pixels, x to the right and y down, with pixel centres
//! at +0.5. A camera's importance `we` is normalised to an integral of 1 over the whole film: a path from the lights
//! that reaches the camera at raster position p adds `n_pixels * f |cos| we / pdf_w` to the mean of the pixel there.

mod build;
mod differentials;
mod fisheye;
mod importance;
mod lens;
mod matrices;
mod orthographic;
mod perspective;
mod photographic;
mod realistic;

mod screen;
mod spherical;
#[cfg(test)]
mod tests;

use etendue_math::{AnimatedTransform, Bounds2, Motion, Point2, Ray, Transform, lerp};

use differentials::MinimumDifferentials;

pub use build::CAMERAS;
pub use fisheye::{Fisheye, FisheyeMapping};
pub use importance::{CameraWiSample, FilmImportance};
pub use lens::{Blades, Lens, circle_of_confusion, field_of_view};
pub use orthographic::Orthographic;
pub use perspective::Perspective;
pub use photographic::Photographic;
pub use realistic::{
    LensFault, LensPrescription, LensSettings, LensSurface, Paraxial, Realistic, StopPicture, StopShape,
};
pub use screen::{Screen, ScreenWindow};
pub use spherical::{Spherical, SphericalMapping};

/// How rays leave the camera, in camera space.
///
/// To add one: a file with a plain struct that turns raster and lens positions into rays, a variant here, its arm in
/// `Projection::ray`, in `importance.rs` and in `build.rs`, its parameters there, a line in the tests.
#[derive(Clone, Debug, PartialEq)]
pub enum Projection {
    /// Pinhole or thin lens.
    Perspective(Perspective),
    /// Parallel rays.
    Orthographic(Orthographic),
    /// All directions from a point.
    Spherical(Spherical),
    /// A cone of directions from a point, however wide.
    Fisheye(Fisheye),
    /// A film behind a lens of glass.
    Realistic(Box<Realistic>),
}

impl Projection {
    /// The ray in camera space, of unit direction, at time 0, with its weight; `None` where the film stays black.
    #[inline]
    fn ray(&self, p_film: Point2, u_lens: Point2) -> Option<CameraRay> {
        let ray = match self {
            Self::Perspective(camera) => camera.ray(p_film, u_lens),
            Self::Orthographic(camera) => camera.ray(p_film, u_lens),
            Self::Spherical(camera) => camera.ray(p_film),
            Self::Fisheye(camera) => camera.ray(p_film)?,
            Self::Realistic(camera) => return camera.ray(p_film, u_lens),
        };
        Some(CameraRay { ray, weight: 1.0 })
    }
}

/// A ray from the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraRay {
    /// In the world, of unit direction, with its time.
    pub ray: Ray,
    /// Factor of the radiance along it.
    pub weight: f32,
}

/// When the film is exposed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shutter {
    /// Opens, in seconds.
    pub open: f32,
    /// Closes, in seconds.
    pub close: f32,
}

impl Default for Shutter {
    fn default() -> Self {
        Self { open: 0.0, close: 1.0 }
    }
}

/// A camera in the world.
#[derive(Clone, Debug)]
pub struct Camera {
    projection: Projection,
    world_from_camera: AnimatedTransform,
    /// The same, where it changes, ready to be interpolated.
    motion: Option<Box<Motion>>,
    shutter: Shutter,
    /// The part of the raster from where light enters the image, in pixels: elsewhere the camera takes none.
    lit: Bounds2,
    differentials: MinimumDifferentials,
}

impl Camera {
    /// A camera. `resolution` is that of the whole film in pixels; `lit` is the part that is rendered, with what the pixel filter
    /// reaches beside it.
    #[must_use]
    pub fn new(
        projection: Projection,
        world_from_camera: AnimatedTransform,
        shutter: Shutter,
        resolution: [u32; 2],
        lit: Bounds2,
    ) -> Self {
        let differentials = MinimumDifferentials::new(&projection, resolution);
        let motion = world_from_camera.is_animated().then(|| Box::new(world_from_camera.motion()));
        Self { projection, world_from_camera, motion, shutter, lit, differentials }
    }

    /// The projection.
    #[must_use]
    pub const fn projection(&self) -> &Projection {
        &self.projection
    }

    /// Placement in the world over time.
    #[must_use]
    pub const fn world_from_camera(&self) -> &AnimatedTransform {
        &self.world_from_camera
    }

    /// When the film is exposed.
    #[must_use]
    pub const fn shutter(&self) -> Shutter {
        self.shutter
    }

    /// The time in seconds that a random number in [0, 1) stands for.
    #[inline]
    #[must_use]
    pub fn sample_time(&self, u: f32) -> f32 {
        lerp(u, self.shutter.open, self.shutter.close)
    }

    /// Placement at a time in seconds.
    #[inline]
    pub fn transform_at(&self, time: f32) -> Transform {
        match &self.motion {
            Some(motion) => motion.at(time),
            None => self.world_from_camera.start,
        }
    }

    /// The ray through raster position `p_film` (pixels) for a random point of the lens and a random time; `None` where no
    /// light gets there.
    #[inline]
    #[must_use]
    pub fn sample_ray(&self, p_film: Point2, u_lens: Point2, u_time: f32) -> Option<CameraRay> {
        let time = self.sample_time(u_time);
        let CameraRay { ray, weight } = self.projection.ray(p_film, u_lens)?;
        let mut ray = match &self.motion {
            Some(motion) => motion.at(time).ray(&ray),
            None => self.world_from_camera.start.ray(&ray),
        };
        ray.direction = ray.direction.try_normalized()?;
        ray.time = time;
        Some(CameraRay { ray, weight })
    }
}
