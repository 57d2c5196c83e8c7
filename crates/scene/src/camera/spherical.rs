//! The spherical camera, in camera space: one image of all directions around a point, +y up.
//!
//! The equal-area map (Clarberg 2008, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD") gives every pixel the
//! same solid angle; the equirectangular one has longitude along x and the angle from +y along y.

use etendue_math::{Point2, Point3, Ray, Vector3, safe_sqrt, warp};

/// How the image covers the sphere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SphericalMapping {
    /// Equal solid angles for equal areas.
    #[default]
    EqualArea,
    /// Longitude and latitude.
    Equirectangular,
}

/// A camera that sees all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spherical {
    /// Width and height of the whole film in pixels.
    pub resolution: [f32; 2],
    /// How the image covers the sphere.
    pub mapping: SphericalMapping,
}

/// Exchanges y and z: maps have their pole at +z, the camera's is at +y.
#[inline]
fn swap_y_z(v: Vector3) -> Vector3 {
    Vector3::new(v.x, v.z, v.y)
}

impl Spherical {
    /// The unit direction that a raster position stands for.
    #[inline]
    #[must_use]
    pub fn direction(&self, p_film: Point2) -> Vector3 {
        let uv = Point2::new(p_film.x / self.resolution[0], p_film.y / self.resolution[1]);
        let d = match self.mapping {
            SphericalMapping::EqualArea => {
                warp::equal_area_square_to_sphere(warp::wrap_equal_area_square(uv))
            }
            SphericalMapping::Equirectangular => {
                let (sin_theta, cos_theta) = (std::f32::consts::PI * uv.y).sin_cos();
                let (sin_phi, cos_phi) = (std::f32::consts::TAU * uv.x).sin_cos();
                Vector3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta)
            }
        };
        swap_y_z(d)
    }

    /// The raster position of a unit direction.
    #[inline]
    #[must_use]
    pub fn raster_from_direction(&self, d: Vector3) -> Point2 {
        let d = swap_y_z(d);
        let uv = match self.mapping {
            SphericalMapping::EqualArea => warp::equal_area_sphere_to_square(d),
            SphericalMapping::Equirectangular => {
                let phi = d.y.atan2(d.x);
                let theta = (d.x * d.x + d.y * d.y).sqrt().atan2(d.z);
                let turns = phi / std::f32::consts::TAU;
                Point2::new(if turns < 0.0 { turns + 1.0 } else { turns }, theta / std::f32::consts::PI)
            }
        };
        Point2::new(uv.x * self.resolution[0], uv.y * self.resolution[1])
    }

    /// All raster positions around the film that show the same as this one on it: panoramas go on beyond their border.
    pub(super) fn places(&self, p_film: Point2) -> impl Iterator<Item = Point2> {
        let [width, height] = self.resolution;
        let (u, v) = (p_film.x / width, p_film.y / height);
        let is_folded = self.mapping == SphericalMapping::EqualArea;
        // Across the poles, then across the sides.
        let rows = [v, -v, 2.0 - v].into_iter().enumerate().map(move |(i, row)| match (i, is_folded) {
            (0, _) => (u, row),
            (_, true) => (1.0 - u, row),
            (_, false) => ((u + 0.5).fract(), row),
        });
        let columns = move |(u, v): (f32, f32)| match is_folded {
            true => [(u, v), (-u, 1.0 - v), (2.0 - u, 1.0 - v)],
            false => [(u, v), (u - 1.0, v), (u + 1.0, v)],
        };
        rows.flat_map(columns).map(move |(u, v)| Point2::new(u * width, v * height))
    }

    /// Density per steradian of directions when raster positions are uniform over the film.
    #[inline]
    #[must_use]
    pub fn direction_pdf(&self, d: Vector3) -> f32 {
        match self.mapping {
            SphericalMapping::EqualArea => 0.25 / std::f32::consts::PI,
            SphericalMapping::Equirectangular => {
                let sin_theta = safe_sqrt(1.0 - d.y * d.y);
                if sin_theta <= 0.0 {
                    return 0.0;
                }
                1.0 / (2.0 * std::f32::consts::PI * std::f32::consts::PI * sin_theta)
            }
        }
    }

    /// The ray of a raster position.
    #[inline]
    #[must_use]
    pub(super) fn ray(&self, p_film: Point2) -> Ray {
        Ray::new(Point3::ORIGIN, self.direction(p_film))
    }
}
