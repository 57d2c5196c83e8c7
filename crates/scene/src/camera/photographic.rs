//! A lens in the units that photographers use (SPEC CAM-3): focal length and sensor in millimetres, f-number.
//!
//! A thin lens of focal length f that is focused at the distance d has its film at `v = f d / (d - f)`, so that a sensor of
//! width s sees the angle `2 atan(s / (2 v))`: focusing near narrows the view. The aperture's diameter is f / N. Where the
//! field of view is given in place of f, `f = v d / (v + d)` with the v that gives this view.

use super::Lens;

/// Width of the sensor where none is given: that of a frame of 35 mm film, in millimetres.
pub(super) const DEFAULT_SENSOR_WIDTH_MM: f32 = 36.0;

/// A lens before its film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Photographic {
    /// Focal length in metres.
    pub focal_length_m: f32,
    /// Width of the film in metres.
    pub sensor_width_m: f32,
    /// Distance from the lens to what is sharp, in metres, above the focal length.
    pub focal_distance: f32,
}

impl Photographic {
    /// The lens with which a film of that width sees, across its width, twice the angle of this tangent.
    #[must_use]
    pub fn from_view(tan_half_width: f32, sensor_width_m: f32, focal_distance: f32) -> Self {
        let film_distance = sensor_width_m / (2.0 * tan_half_width);
        let focal_length_m = film_distance / (1.0 + film_distance / focal_distance);
        Self { focal_length_m, sensor_width_m, focal_distance }
    }

    /// Tangent of half the angle across the width of the film.
    #[must_use]
    pub fn tan_half_width(&self) -> f32 {
        let film_distance = self.focal_length_m / (1.0 - self.focal_length_m / self.focal_distance);
        self.sensor_width_m / (2.0 * film_distance)
    }

    /// The thin lens at an f-number, with a round aperture.
    #[must_use]
    pub fn lens(&self, f_number: f32) -> Lens {
        Lens::from_f_number(self.focal_length_m, f_number, self.focal_distance)
    }
}
