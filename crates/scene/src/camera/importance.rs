//! Importance that the camera emits, for paths that begin at lights (Pharr, Jakob and Humphreys 2016, "Physically Based
//! Rendering", 3rd ed., section 16.1).
//!
//! `we` is the factor between radiance that arrives along a ray and its part in the film:
//! `mean over the film = integral of we L cos dA dw` over lens and directions. It is normalised over the *whole* film;
//! what arrives beyond the reach of the rendered pixels counts nothing. Each projection yields `we`, the density `pdf_a` of lens points and
//! `pdf_w` of directions that [`Camera::sample_ray`](super::Camera::sample_ray) has for uniform raster positions, so
//! that `we cos = pdf_a pdf_w`. Where a position or a direction is fixed, its density is discrete and counts as 1.

use etendue_math::{Point2, Point3, Ray, Transform, Vector3};

use super::{Camera, Fisheye, Orthographic, Perspective, Projection, Spherical};

/// What the film receives along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmImportance {
    /// Importance in 1/(m^2 sr), or with discrete parts left out.
    pub we: f32,
    /// Where on the film, in pixels.
    pub p_film: Point2,
    /// Density of the ray's origin on the lens, per square metre; 1 for a pinhole.
    pub pdf_a: f32,
    /// Density of its direction, per steradian; 1 for parallel rays.
    pub pdf_w: f32,
}

/// A direction from a point to the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraWiSample {
    /// Unit direction to the camera.
    pub wi: Vector3,
    /// Importance that arrives along it.
    pub we: f32,
    /// Density of `wi` per steradian; where lens or direction are discrete, the factor that takes their place.
    pub pdf_w: f32,
    /// Where on the film, in pixels; of panoramas maybe only [one of the places](Camera::for_each_place) where it is seen.
    pub p_film: Point2,
    /// The point of the lens or image plane.
    pub p_lens: Point3,
    /// The density over the lens, per square metre, that `sample_ray` has for this point; 1 for a pinhole.
    pub pdf_a: f32,
    /// The density per steradian that `sample_ray` has for the opposite direction, 1 for parallel rays.
    pub pdf_camera_w: f32,
    /// Distance to the camera in metres.
    pub distance: f32,
}

/// A point of the lens in camera space for a given point of the scene.
struct LensPoint {
    p_lens: Point3,
    pdf_w: f32,
}

impl Perspective {
    fn film_importance(&self, ray: &Ray) -> Option<FilmImportance> {
        let cos_theta = ray.direction.z;
        let p_film = self.raster_from_ray(ray)?;
        let pdf_w = 1.0 / (self.plane_area() * cos_theta.powi(3));
        Some(FilmImportance { we: self.importance(cos_theta), p_film, pdf_a: 1.0 / self.lens.area(), pdf_w })
    }

    fn sample_lens(&self, p: Point3, u: Point2) -> Option<LensPoint> {
        let p_lens = self.lens.sample(u);
        let p_lens = Point3::new(p_lens.x, p_lens.y, 0.0);
        let to_lens = p_lens - p;
        let distance_squared = to_lens.length_squared();
        let cos_theta = p.z / distance_squared.sqrt();
        (cos_theta > 0.0)
            .then(|| LensPoint { p_lens, pdf_w: distance_squared / (cos_theta * self.lens.area()) })
    }
}

impl Orthographic {
    fn film_importance(&self, ray: &Ray) -> Option<FilmImportance> {
        let cos_theta = ray.direction.z;
        let p_film = self.raster_from_ray(ray)?;
        let (pdf_a, pdf_w) = (1.0 / self.screen.window.area(), self.direction_pdf(cos_theta));
        Some(FilmImportance { we: pdf_a * pdf_w / cos_theta, p_film, pdf_a, pdf_w })
    }

    /// As `film_importance` for a ray known to be one of the camera's.
    fn film_importance_at(&self, p_image: Point2, cos_theta: f32) -> FilmImportance {
        let (pdf_a, pdf_w) = (1.0 / self.screen.window.area(), self.direction_pdf(cos_theta));
        let p_film = self.screen.raster_from_screen(p_image);
        FilmImportance { we: pdf_a * pdf_w / cos_theta, p_film, pdf_a, pdf_w }
    }

    /// The point of the image plane whose ray meets `p`, with what the film receives there. The lens point, not the
    /// image point, is drawn: the bundle of `p_image` passes `p_image + lens (1 - z / f)` at depth z.
    fn sample_lens(&self, p: Point3, u: Point2) -> Option<(LensPoint, FilmImportance)> {
        if p.z <= 0.0 {
            return None;
        }
        let lens = self.lens.sample(u);
        let shrink = if self.lens.has_area() { 1.0 - p.z / self.lens.focal_distance } else { 0.0 };
        let p_image = Point2::new(p.x - lens.x * shrink, p.y - lens.y * shrink);
        let p_lens = Point3::new(p_image.x + lens.x, p_image.y + lens.y, 0.0);
        let cos_theta = p.z / p_lens.distance(p);
        let pdf_w = self.direction_pdf(cos_theta);
        Some((LensPoint { p_lens, pdf_w }, self.film_importance_at(p_image, cos_theta)))
    }
}

impl Spherical {
    fn film_importance(&self, ray: &Ray) -> FilmImportance {
        let pdf_w = self.direction_pdf(ray.direction);
        FilmImportance { we: pdf_w, p_film: self.raster_from_direction(ray.direction), pdf_a: 1.0, pdf_w }
    }
}

impl Fisheye {
    fn film_importance(&self, ray: &Ray) -> Option<FilmImportance> {
        let pdf_w = self.direction_pdf(ray.direction);
        Some(FilmImportance {
            we: pdf_w,
            p_film: self.raster_from_direction(ray.direction)?,
            pdf_a: 1.0,
            pdf_w,
        })
    }
}

/// The ray from the middle of a camera that is a point to `p`, and that middle.
fn towards(p: Point3) -> Option<(Ray, LensPoint)> {
    let to_p = p.as_vector();
    let ray = Ray::new(Point3::ORIGIN, to_p.try_normalized()?);
    Some((ray, LensPoint { p_lens: Point3::ORIGIN, pdf_w: to_p.length_squared() }))
}

/// What the importance of camera space is multiplied by in the world, for a unit direction of camera space: a transform M spreads
/// what a pixel sees over `|det M| / |M d|` times the area across the ray. 1 unless the camera is scaled.
fn spread(world_from_camera: &Transform, direction: Vector3) -> f32 {
    let [x, y, z] = [Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.0, 1.0, 0.0), Vector3::new(0.0, 0.0, 1.0)]
        .map(|axis| world_from_camera.vector(axis));
    let volume = x.cross(y).dot(z).abs();
    world_from_camera.vector(direction).length() / volume
}

impl FilmImportance {
    /// In the world.
    fn spread(self, world_from_camera: &Transform, direction: Vector3) -> Self {
        let scale = spread(world_from_camera, direction);
        Self { we: self.we * scale, pdf_a: self.pdf_a * scale, ..self }
    }
}

impl Camera {
    /// What the film receives along a ray that starts on the lens and has unit direction; `None` where it reaches no pixel.
    /// Rays of a parallel bundle without a lens cannot be met by chance, and which way leads through a real lens is not known:
    /// `None`.
    #[must_use]
    pub fn we(&self, ray: &Ray) -> Option<FilmImportance> {
        let world_from_camera = self.transform_at(ray.time);
        let mut ray_camera = world_from_camera.inverse().ray(ray);
        ray_camera.direction = ray_camera.direction.try_normalized()?;
        let result = match &self.projection {
            Projection::Perspective(camera) => camera.film_importance(&ray_camera),
            Projection::Orthographic(camera) => camera.film_importance(&ray_camera),
            Projection::Spherical(camera) => Some(camera.film_importance(&ray_camera)),
            Projection::Fisheye(camera) => camera.film_importance(&ray_camera),
            Projection::Realistic(_) => None,
        };
        let result = result.filter(|result| self.is_seen(result.p_film))?;
        Some(result.spread(&world_from_camera, ray_camera.direction))
    }

    /// Densities `(pdf_a, pdf_w)` of a camera ray for uniform raster positions; zeros if the camera has no such ray.
    #[must_use]
    pub fn pdf_we(&self, ray: &Ray) -> (f32, f32) {
        self.we(ray).map_or((0.0, 0.0), |importance| (importance.pdf_a, importance.pdf_w))
    }

    /// Draws a point of the lens and with it a direction from `p` to the camera; `None` where `p` is not on the film.
    #[must_use]
    pub fn sample_wi(&self, p: Point3, time: f32, u: Point2) -> Option<CameraWiSample> {
        let world_from_camera = self.transform_at(time);
        let p_camera = world_from_camera.inverse().point(p);
        let (lens, film) = match &self.projection {
            Projection::Perspective(camera) => {
                let lens = camera.sample_lens(p_camera, u)?;
                let ray = Ray::new(lens.p_lens, (p_camera - lens.p_lens).try_normalized()?);
                let film = camera.film_importance(&ray)?;
                (lens, film)
            }
            Projection::Orthographic(camera) => camera.sample_lens(p_camera, u)?,
            Projection::Spherical(camera) => {
                let (ray, lens) = towards(p_camera)?;
                (lens, camera.film_importance(&ray))
            }
            Projection::Fisheye(camera) => {
                let (ray, lens) = towards(p_camera)?;
                (lens, camera.film_importance(&ray)?)
            }
            Projection::Realistic(_) => return None,
        };
        if !self.is_seen(film.p_film) {
            return None;
        }
        let film = film.spread(&world_from_camera, (p_camera - lens.p_lens).try_normalized()?);
        let p_lens = world_from_camera.point(lens.p_lens);
        let to_lens = p_lens - p;
        Some(CameraWiSample {
            wi: to_lens.try_normalized()?,
            we: film.we,
            pdf_w: lens.pdf_w,
            p_film: film.p_film,
            p_lens,
            pdf_a: film.pdf_a,
            pdf_camera_w: film.pdf_w,
            distance: to_lens.length(),
        })
    }

    /// Calls `add` with every raster position where light enters the image that arrives at `p_film`: there, and for panoramas
    /// also where they go on beyond their border, as far as the pixel filter reaches.
    #[inline]
    pub fn for_each_place(&self, p_film: Point2, mut add: impl FnMut(Point2)) {
        match &self.projection {
            Projection::Spherical(camera) => {
                camera.places(p_film).filter(|p| self.is_lit(*p)).for_each(add);
            }
            _ => add(p_film),
        }
    }

    /// The raster position at which a point of the world is sharpest seen (through the middle of the lens), or `None`
    /// if it is behind the camera or reaches no pixel.
    #[must_use]
    pub fn project(&self, p: Point3, time: f32) -> Option<Point2> {
        let p = self.transform_at(time).inverse().point(p);
        let p_film = match &self.projection {
            Projection::Perspective(camera) => camera.raster_from_direction(p.as_vector())?,
            Projection::Orthographic(camera) if p.z > 0.0 => {
                camera.screen.raster_from_screen(Point2::new(p.x, p.y))
            }
            Projection::Orthographic(_) => return None,
            Projection::Spherical(camera) => camera.raster_from_direction(p.as_vector().try_normalized()?),
            Projection::Fisheye(camera) => camera.raster_from_direction(p.as_vector().try_normalized()?)?,
            Projection::Realistic(_) => return None,
        };
        self.is_lit(p_film).then_some(p_film)
    }

    /// True if light that arrives at `p_film` enters the image in [some place](Self::for_each_place).
    fn is_seen(&self, p_film: Point2) -> bool {
        match &self.projection {
            Projection::Spherical(camera) => camera.places(p_film).any(|p| self.is_lit(p)),
            _ => self.is_lit(p_film),
        }
    }

    fn is_lit(&self, p: Point2) -> bool {
        let lit = self.lit;
        p.x >= lit.min.x && p.x < lit.max.x && p.y >= lit.min.y && p.y < lit.max.y
    }
}
