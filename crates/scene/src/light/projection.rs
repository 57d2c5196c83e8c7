//! A point that projects a picture, like a slide projector: intensity in the direction of a texel is its value,
//! without loss towards the corners. The full angle `fov` spans the shorter side of the picture; its top is +y.
//!
//! Sampled on the image plane z = 1, where dw = cos^3 dA.

use etendue_geometry::Reference;
use etendue_math::{Bounds2, Bounds3, Normal3, PiecewiseConstant2, Point2, Point3, Ray, Transform, Vector3};
use etendue_spectrum::{Sampled, Spectrum, Wavelengths};

use super::build::{self, Picture, spec};
use super::context::point_sample;
use super::image::{sampling_weights, weighted_mean};
use super::{
    EmittedRay, LightBounds, LightContext, LightImage, LightImageId, LightPower, LightSample, LightTables,
};
use crate::parameters::{ParameterSpec, Parameters};

/// Index of a projector in [`LightTables`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ProjectionLightId(pub u32);

/// Directions below this cosine to the axis are dark.
const MIN_COSINE: f32 = 1e-3;

/// Least number of cells of the density along the longer side of a picture.
const N_CELLS: usize = 128;

/// A projector.
#[derive(Clone, Debug)]
pub struct ProjectionLight {
    p: Point3,
    world_from_light: Transform,
    light_from_world: Transform,
    image: LightImageId,
    /// Intensity where the picture is 1, relative to the illuminant of the picture.
    scale: f32,
    /// The picture's rectangle on the plane at distance 1.
    screen: Bounds2,
    /// Spectrum of the intensity integrated over solid angle, before `scale`.
    flux: Spectrum,
    mean_intensity: Spectrum,
    distribution: PiecewiseConstant2,
}

/// Solid angle of a rectangle on the plane z = 1, given its range in x and in y.
fn solid_angle(x: [f64; 2], y: [f64; 2]) -> f64 {
    let corner = |x: f64, y: f64| (x * y / (1.0 + x * x + y * y).sqrt()).atan();
    corner(x[1], y[1]) - corner(x[0], y[1]) - corner(x[1], y[0]) + corner(x[0], y[0])
}

impl ProjectionLight {
    /// Parameters in scene files.
    pub const PARAMETERS: &[ParameterSpec] = &[
        spec("filename", "string", "", "", "picture of intensity; required"),
        spec("fov", "float", "90", "degree", "full angle that the shorter side of the picture spans"),
        build::SCALE,
        build::POWER,
        super::LightUnits::PARAMETER,
    ];

    /// A projector of the linear RGB picture. `scale` is in internal units: multiples of the picture's illuminant.
    #[must_use]
    pub(super) fn new(
        tables: &mut LightTables,
        world_from_light: &Transform,
        picture: &Picture,
        fov_rad: f32,
        scale: f32,
    ) -> Self {
        let flip_y = Transform::scale(1.0, -1.0, 1.0).expect("a flip has an inverse");
        let world_from_light = *world_from_light * flip_y;
        let (nx, ny) = (picture.width, picture.height);
        let aspect = nx as f32 / ny as f32;
        let opposite = (fov_rad / 2.0).tan();
        let half = if aspect > 1.0 {
            Point2::new(opposite * aspect, opposite)
        } else {
            Point2::new(opposite, opposite / aspect)
        };
        let screen = Bounds2 { min: Point2::new(-half.x, -half.y), max: half };
        let half_extent = [f64::from(half.x), f64::from(half.y)];
        let solid_angles: Vec<f64> = (0..nx * ny)
            .map(|i| {
                let edge = |t: usize, n: usize, half: f64| half * (2.0 * t as f64 / n as f64 - 1.0);
                let (x, y) = (i % nx, i / nx);
                solid_angle(
                    [edge(x, nx, half_extent[0]), edge(x + 1, nx, half_extent[0])],
                    [edge(y, ny, half_extent[1]), edge(y + 1, ny, half_extent[1])],
                )
            })
            .collect();
        // Cells small enough that a place within them makes no difference to the flux of a photon.
        let n_parts = N_CELLS.div_ceil(nx.max(ny));
        let (n_columns, n_rows) = (nx * n_parts, ny * n_parts);
        let values = sampling_weights(&picture.rgb);
        let weights: Vec<f32> = (0..n_columns * n_rows)
            .map(|i| {
                let (column, row) = (i % n_columns, i / n_columns);
                let middle = |t: usize, n: usize, half: f64| half * ((2 * t + 1) as f64 / n as f64 - 1.0);
                let x = middle(column, n_columns, half_extent[0]);
                let y = middle(row, n_rows, half_extent[1]);
                let cosine = 1.0 / (1.0 + x * x + y * y).sqrt();
                values[row / n_parts * nx + column / n_parts] * cosine.powi(3) as f32
            })
            .collect();
        let brightness = picture.rgb.iter().copied().zip(solid_angles.iter().copied());
        let mean_intensity = weighted_mean(brightness, picture.space, picture.white);
        Self {
            p: world_from_light.point(Point3::ORIGIN),
            world_from_light,
            light_from_world: world_from_light.inverse(),
            image: tables.add_image(LightImage::new(nx, ny, &picture.rgb, picture.space, picture.white)),
            scale,
            screen,
            flux: mean_intensity.scaled(solid_angles.iter().sum::<f64>() as f32),
            mean_intensity,
            distribution: PiecewiseConstant2::new(&weights, n_columns, n_rows, screen),
        }
    }

    pub(super) fn build(
        p: &mut Parameters,
        world_from_light: &Transform,
        tables: &mut LightTables,
    ) -> Option<Self> {
        let fov = p.float("fov", 90.0).clamp(1e-2, 179.0).to_radians();
        let power = p.float("power", -1.0);
        let size = build::PictureScale::read(p);
        let picture = build::read_picture(p)?;
        let mut light = Self::new(tables, world_from_light, &picture, fov, 1.0);
        light.scale = size.factor(p, &picture, power, light.flux, 1.0);
        Some(light)
    }

    /// Position on the image plane of a direction of the light's space.
    fn screen_point(&self, w_light: Vector3) -> Option<Point2> {
        if w_light.z < MIN_COSINE {
            return None;
        }
        let q = Point2::new(w_light.x / w_light.z, w_light.y / w_light.z);
        let inside = q.x >= self.screen.min.x
            && q.x <= self.screen.max.x
            && q.y >= self.screen.min.y
            && q.y <= self.screen.max.y;
        inside.then_some(q)
    }

    fn intensity_at(&self, context: &LightContext, q: Point2, lambda: &Wavelengths) -> Sampled {
        let extent = self.screen.max - self.screen.min;
        let uv = Point2::new((q.x - self.screen.min.x) / extent.x, (q.y - self.screen.min.y) / extent.y);
        context.tables.image(self.image).nearest(uv, context.spectra, lambda) * self.scale
    }

    pub(super) fn sample_li(
        &self,
        context: &LightContext,
        reference: &Reference,
        _u: Point2,
        lambda: &Wavelengths,
    ) -> Option<LightSample> {
        let w = self.light_from_world.vector(reference.p - self.p).try_normalized()?;
        let q = self.screen_point(w)?;
        point_sample(self.p, reference, self.intensity_at(context, q, lambda))
    }

    pub(super) const fn pdf_li(&self, _: &LightContext, _: &Reference, _: Vector3) -> f32 {
        0.0
    }

    pub(super) fn sample_le(
        &self,
        context: &LightContext,
        _u_position: Point2,
        u_direction: Point2,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        let (q, pdf_q) = self.distribution.sample(u_direction);
        let w_light = Vector3::new(q.x, q.y, 1.0).normalized();
        let w = self.world_from_light.vector(w_light).try_normalized()?;
        let pdf_w = pdf_q / (w_light.z * w_light.z * w_light.z); // dw = cos^3 dA
        EmittedRay::from_point(self.p, w, self.intensity_at(context, q, lambda), pdf_w)
    }

    pub(super) fn emit_towards(
        &self,
        context: &LightContext,
        w: Vector3,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        let q = self.screen_point(self.light_from_world.vector(w).try_normalized()?)?;
        EmittedRay::from_point(self.p, w, self.intensity_at(context, q, lambda), 1.0)
    }

    pub(super) fn pdf_le(&self, _: &LightContext, ray: &Ray, _: Option<Normal3>) -> (f32, f32) {
        let w = self.light_from_world.vector(ray.direction).try_normalized();
        let pdf_w = w.and_then(|w| Some(self.distribution.pdf(self.screen_point(w)?) / (w.z * w.z * w.z)));
        (0.0, pdf_w.unwrap_or(0.0))
    }

    pub(super) fn power(&self, context: &LightContext) -> LightPower {
        LightPower::of(&self.flux, context.spectra) * f64::from(self.scale)
    }

    pub(super) fn bounds(&self, context: &LightContext) -> Option<LightBounds> {
        let corner = Vector3::new(self.screen.max.x, self.screen.max.y, 1.0).normalized();
        let axis = self.world_from_light.vector(Vector3::new(0.0, 0.0, 1.0)).try_normalized()?;
        let mean = LightPower::of(&self.mean_intensity, context.spectra).weight;
        Some(LightBounds {
            bounds: Bounds3::new(self.p, self.p),
            w: axis,
            cos_theta_o: corner.z,
            cos_theta_e: 1.0,
            intensity: (mean * f64::from(self.scale)) as f32,
            two_sided: false,
        })
    }
}
