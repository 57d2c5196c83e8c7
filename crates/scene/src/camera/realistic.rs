//! The realistic camera (Kolb, Mitchell and Hanrahan 1995, "A Realistic Camera Model for Computer Graphics",
//! https://doi.org/10.1145/218380.218463): rays are traced through the glass of a real lens.
//!
//! Film at z = 0 of camera space, the scene at +z, the lens between. A point x of the film receives, through the points of
//! the rear surface at distance Z that see the scene,
//!
//! ```text
//! E(x) = integral over the exit pupil of L cos^4(theta) / Z^2 dA
//! ```
//!
//! where theta is the angle between axis and ray on the film's side. The pupil's bounds are found beforehand for 64 distances
//! from the axis (`pupil.rs`), a point is drawn within them and traced (`trace.rs`); rays that a rim or the stop catches weigh
//! nothing. So vignetting, distortion, field curvature and all monochromatic aberrations are there; dispersion, reflections in
//! the lens and diffraction are not. As in pbrt-v4 a pixel is the irradiance of the film, which falls with the aperture, and
//! not the radiance of what it shows, unless the camera is told to normalise it.
//!
//! There is no importance: from the scene one cannot tell which way leads through the glass, so that `we` and `sample_wi`
//! answer `None`, and methods that start at lights do not reach this camera.

mod paraxial;
mod prescription;
mod pupil;
mod stop;
mod trace;

use etendue_math::{Point2, Point3, Ray};

use super::CameraRay;

pub use paraxial::Paraxial;
pub use prescription::{LensFault, LensPrescription, LensSurface};
pub use stop::{StopPicture, StopShape};

use pupil::ExitPupils;
use trace::Barrel;

/// How a lens is set.
#[derive(Clone, Debug, PartialEq)]
pub struct LensSettings {
    /// Diameter of the stop in metres.
    pub stop_diameter_m: f32,
    /// Form of the stop.
    pub stop_shape: StopShape,
    /// Distance from the film to what is sharp, in metres.
    pub focus_distance: f32,
    /// Divides by the irradiance that radiance 1 causes in the middle of the film.
    pub is_normalized: bool,
}

/// A film behind a real lens.
#[derive(Clone, Debug, PartialEq)]
pub struct Realistic {
    resolution: [f32; 2],
    /// Width and height of the film in metres.
    film_size_m: [f32; 2],
    barrel: Barrel,
    pupils: ExitPupils,
    weight: f32,
}

impl Realistic {
    /// A film of that diagonal behind a lens; `None` if the lens cannot focus at this distance.
    #[must_use]
    pub fn new(
        prescription: &LensPrescription,
        settings: LensSettings,
        resolution: [f32; 2],
        diagonal_m: f32,
    ) -> Option<Self> {
        let film_distance = Paraxial::new(prescription).film_distance(settings.focus_distance)?;
        let scale = diagonal_m / resolution[0].hypot(resolution[1]);
        let film_size_m = resolution.map(|pixels| pixels * scale);
        let barrel = Barrel::new(prescription, &settings, film_distance);
        let pupils = ExitPupils::new(&barrel, diagonal_m / 2.0);
        let weight = if settings.is_normalized {
            let axial = pupils.axial_irradiance(&barrel);
            if axial > 0.0 { 1.0 / axial } else { 0.0 }
        } else {
            1.0
        };
        Some(Self { resolution, film_size_m, barrel, pupils, weight })
    }

    /// True if some light gets from the scene to some point of the film.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.pupils.is_open() && self.barrel.has_opening()
    }

    /// Width and height of the film in metres.
    #[must_use]
    pub const fn film_size_m(&self) -> [f32; 2] {
        self.film_size_m
    }

    /// Distance between film and rear vertex in metres.
    #[must_use]
    pub fn film_distance(&self) -> f32 {
        self.barrel.rear_z()
    }

    /// The point of the film in metres that a raster position stands for. The image in a lens is upside down.
    fn film_point(&self, p_film: Point2) -> Point3 {
        let x = (0.5 - p_film.x / self.resolution[0]) * self.film_size_m[0];
        let y = (p_film.y / self.resolution[1] - 0.5) * self.film_size_m[1];
        Point3::new(x, y, 0.0)
    }

    /// The ray of a raster position through a point of the exit pupil; `None` if the lens lets nothing pass there.
    pub(super) fn ray(&self, p_film: Point2, u_lens: Point2) -> Option<CameraRay> {
        let film = self.film_point(p_film);
        let (p_rear, area) = self.pupils.sample(film, self.barrel.rear_z(), u_lens)?;
        let inside = Ray::new(film, (p_rear - film).try_normalized()?);
        let (ray, open) = self.barrel.trace(inside)?;
        let irradiance = area * irradiance_per_area(inside.direction.z, self.barrel.rear_z());
        let weight = open * irradiance * self.weight;
        (weight > 0.0).then_some(CameraRay { ray, weight })
    }
}

/// Irradiance of the film by radiance 1 through a unit of area of the rear plane, at a cosine to the axis.
fn irradiance_per_area(cos_theta: f32, rear_z: f32) -> f32 {
    cos_theta.powi(4) / (rear_z * rear_z)
}
