//! Surroundings that are seen only through a rectangular opening, such as the sky in a window
//! (Bitterli, Novák and Jarosz 2015, "Portal-Masked Environment Map Sampling").
//!
//! The picture is resampled so that the edges of the opening become horizontal and vertical: in the frame of the
//! opening, (u, v) are the angles atan(x / z) and atan(y / z). From any point the opening is then a rectangle in
//! (u, v), inside which directions are sampled by a summed-area table. dw = pi^2 (1 - x^2)(1 - y^2) / z du dv.
//!
//! Light passes from the side of +z of the frame (the first edge is +y, the last +x) to the other side only.

use std::f32::consts::{FRAC_PI_2, PI};

use etendue_geometry::Reference;
use etendue_math::{
    Bounds2, Frame, Normal3, PiecewiseConstant2, Point2, Point3, Ray, Transform, Vector3,
    WindowedPiecewiseConstant2, warp,
};
use etendue_spectrum::{Sampled, Spectrum, Wavelengths};

use super::build::{self, Picture};
use super::context::infinite_sample;
use super::image::{sampling_weights, weighted_mean};
use super::{
    EmittedRay, LightBounds, LightContext, LightImage, LightImageId, LightPower, LightSample, LightTables,
};
use crate::parameters::Parameters;

/// Index of an environment behind a portal in [`LightTables`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct InfinitePortalLightId(pub u32);

/// Why four points are no portal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PortalError {
    /// Opposite edges are not parallel.
    NotParallel,
    /// Neighbouring edges are not perpendicular.
    NotPerpendicular,
    /// An edge has length 0.
    Degenerate,
}

impl std::fmt::Display for PortalError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::NotParallel => "opposite edges are not parallel",
            Self::NotPerpendicular => "neighbouring edges are not perpendicular",
            Self::Degenerate => "an edge has length 0",
        })
    }
}

/// An environment behind a portal.
#[derive(Clone, Debug)]
pub struct InfinitePortalLight {
    corners: [Point3; 4],
    frame: Frame,
    image: LightImageId,
    /// Radiance where the picture is 1, relative to the illuminant of the picture.
    scale: f32,
    /// Spectrum of the radiance integrated over the projected hemisphere, before `scale`.
    exitance: Spectrum,
    distribution: WindowedPiecewiseConstant2,
    /// Of what the opening emits, where the cosine counts as well.
    emission: PiecewiseConstant2,
}

/// The frame of a rectangle.
fn portal_frame(corners: &[Point3; 4]) -> Result<Frame, PortalError> {
    let edge = |a: usize, b: usize| (corners[b] - corners[a]).try_normalized().ok_or(PortalError::Degenerate);
    let (e01, e12, e32, e03) = (edge(0, 1)?, edge(1, 2)?, edge(3, 2)?, edge(0, 3)?);
    if (e01.dot(e32) - 1.0).abs() > 1e-3 || (e12.dot(e03) - 1.0).abs() > 1e-3 {
        return Err(PortalError::NotParallel);
    }
    if e01.dot(e12).abs() > 1e-3 || e32.dot(e03).abs() > 1e-3 {
        return Err(PortalError::NotPerpendicular);
    }
    let z = e03.cross(e01).normalized();
    Ok(Frame { x: e03, y: z.cross(e03), z })
}

/// Direction of the portal's frame at `uv`, and dw / du dv there.
fn direction_at(uv: Point2) -> (Vector3, f32) {
    let tangent = |t: f32| (-FRAC_PI_2 + t * PI).tan();
    let w = Vector3::new(tangent(uv.x), tangent(uv.y), 1.0).normalized();
    if !w.is_finite() {
        return (Vector3::new(0.0, 0.0, 1.0), 0.0);
    }
    (w, jacobian(w))
}

/// dw / du dv in a direction of the portal's frame, where z > 0.
fn jacobian(w: Vector3) -> f32 {
    PI * PI * (1.0 - w.x * w.x) * (1.0 - w.y * w.y) / w.z
}

/// Linear colour of an equal-area picture in a direction, interpolated across its octahedral border.
fn interpolate(picture: &Picture, w: Vector3) -> [f32; 3] {
    let n = picture.width as i64;
    let uv = warp::equal_area_sphere_to_square(w);
    let (x, y) = (uv.x * n as f32 - 0.5, uv.y * n as f32 - 0.5);
    let (x0, y0) = (x.floor(), y.floor());
    let (dx, dy) = (x - x0, y - y0);
    let wrap = |mut x: i64, mut y: i64| {
        if x < 0 || x >= n {
            x = if x < 0 { -x - 1 } else { 2 * n - 1 - x };
            y = n - 1 - y;
        }
        if y < 0 || y >= n {
            y = if y < 0 { -y - 1 } else { 2 * n - 1 - y };
            x = n - 1 - x;
        }
        (y.clamp(0, n - 1) * n + x.clamp(0, n - 1)) as usize
    };
    let at = |i: i64, j: i64| picture.rgb[wrap(x0 as i64 + i, y0 as i64 + j)];
    let (c00, c10, c01, c11) = (at(0, 0), at(1, 0), at(0, 1), at(1, 1));
    std::array::from_fn(|c| {
        (c00[c] * (1.0 - dx) + c10[c] * dx) * (1.0 - dy) + (c01[c] * (1.0 - dx) + c11[c] * dx) * dy
    })
}

impl InfinitePortalLight {
    /// An environment from a square linear RGB picture behind the rectangle `corners` (world space, in order around).
    /// `scale` is in multiples of the picture's illuminant.
    pub(super) fn new(
        tables: &mut LightTables,
        world_from_light: &Transform,
        picture: &Picture,
        corners: [Point3; 4],
        scale: f32,
    ) -> Result<Self, PortalError> {
        assert_eq!(picture.width, picture.height, "an equal-area picture is square");
        let frame = portal_frame(&corners)?;
        let light_from_world = world_from_light.inverse();
        let size = picture.width.max(32); // A tiny picture still needs the shape of the Jacobian.
        let n_texels = size * size;
        let mut rgb = Vec::with_capacity(n_texels);
        let mut jacobians = Vec::with_capacity(n_texels);
        let mut projected = Vec::with_capacity(n_texels);
        let mut exitance_factor = 0.0_f64;
        for i in 0..n_texels {
            let center = |t: usize| (t as f32 + 0.5) / size as f32;
            let (w, jacobian) = direction_at(Point2::new(center(i % size), center(i / size)));
            let w_light = light_from_world.vector(frame.to_world(w)).normalized();
            rgb.push(interpolate(picture, w_light));
            jacobians.push(jacobian);
            projected.push(f64::from(jacobian * w.z));
            exitance_factor += f64::from(jacobian * w.z) / n_texels as f64;
        }
        let weights: Vec<f32> = sampling_weights(&rgb).iter().zip(&jacobians).map(|(v, j)| v * j).collect();
        let emitted: Vec<f32> =
            sampling_weights(&rgb).iter().zip(&projected).map(|(v, p)| v * *p as f32).collect();
        let mean = weighted_mean(rgb.iter().copied().zip(projected), picture.space, picture.white);
        let domain = Bounds2::new(Point2::splat(0.0), Point2::splat(1.0));
        Ok(Self {
            corners,
            frame,
            image: tables.add_image(LightImage::new(size, size, &rgb, picture.space, picture.white)),
            scale,
            exitance: mean.scaled(exitance_factor as f32),
            distribution: WindowedPiecewiseConstant2::new(&weights, size, size, domain),
            emission: PiecewiseConstant2::new(&emitted, size, size, domain),
        })
    }

    pub(super) fn build(
        p: &mut Parameters,
        world_from_light: &Transform,
        tables: &mut LightTables,
        corners: &[Point3],
    ) -> Option<Self> {
        let size = build::PictureScale::read(p);
        let illuminance = p.float("illuminance", -1.0);
        let picture =
            if p.has("filename") { build::read_square_picture(p)? } else { build::constant_picture(p) };
        let scale = size.factor(p, &picture, illuminance, picture.upper_irradiance(), 1.0);
        let Ok(corners) = <[Point3; 4]>::try_from(corners) else {
            let span = p.span_of("portal");
            let text = format!("\"portal\" takes four points, not {}", corners.len());
            p.diagnostics().error(span, text);
            return None;
        };
        match Self::new(tables, world_from_light, &picture, corners, scale) {
            Ok(light) => Some(light),
            Err(error) => {
                let span = p.span_of("portal");
                p.diagnostics()
                    .error(span, format!("\"portal\" is no rectangle: {error}"))
                    .with_help("give the four corners of a rectangle in order around it");
                None
            }
        }
    }

    /// Picture coordinates of a world direction, with dw / du dv; `None` on the dark side.
    fn square_from_world(&self, w: Vector3) -> Option<(Point2, f32)> {
        let w = self.frame.to_local(w);
        if w.z <= 0.0 {
            return None;
        }
        let coordinate = |t: f32| ((t.atan2(w.z) + FRAC_PI_2) / PI).clamp(0.0, 1.0);
        Some((Point2::new(coordinate(w.x), coordinate(w.y)), jacobian(w)))
    }

    /// The opening as seen from `p`, in picture coordinates.
    fn window_from(&self, p: Point3) -> Option<Bounds2> {
        let corner = |i: usize| self.square_from_world((self.corners[i] - p).try_normalized()?);
        Some(Bounds2::new(corner(0)?.0, corner(2)?.0))
    }

    fn radiance(&self, context: &LightContext, uv: Point2, lambda: &Wavelengths) -> Sampled {
        context.tables.image(self.image).nearest(uv, context.spectra, lambda) * self.scale
    }

    pub(super) fn le(
        &self,
        context: &LightContext,
        origin: Point3,
        direction: Vector3,
        lambda: &Wavelengths,
    ) -> Sampled {
        let (Some((uv, _)), Some(window)) = (self.square_from_world(direction), self.window_from(origin))
        else {
            return Sampled::ZERO;
        };
        if contains(&window, uv) { self.radiance(context, uv, lambda) } else { Sampled::ZERO }
    }

    pub(super) fn sample_li(
        &self,
        context: &LightContext,
        reference: &Reference,
        u: Point2,
        lambda: &Wavelengths,
    ) -> Option<LightSample> {
        let (uv, pdf_uv) = self.distribution.sample(u, self.window_from(reference.p)?)?;
        let (w, jacobian) = direction_at(uv);
        if jacobian <= 0.0 {
            return None;
        }
        infinite_sample(self.frame.to_world(w), self.radiance(context, uv, lambda), pdf_uv / jacobian)
    }

    pub(super) fn pdf_li(&self, _: &LightContext, reference: &Reference, wi: Vector3) -> f32 {
        let (Some((uv, jacobian)), Some(window)) =
            (self.square_from_world(wi), self.window_from(reference.p))
        else {
            return 0.0;
        };
        if jacobian <= 0.0 || !contains(&window, uv) {
            return 0.0;
        }
        self.distribution.pdf(uv, window) / jacobian
    }

    pub(super) fn sample_le(
        &self,
        context: &LightContext,
        u_position: Point2,
        u_direction: Point2,
        lambda: &Wavelengths,
    ) -> Option<EmittedRay> {
        let (uv, pdf_uv) = self.emission.sample(u_direction);
        let (w_out, jacobian) = direction_at(uv);
        if jacobian <= 0.0 || pdf_uv <= 0.0 {
            return None;
        }
        let (along_y, along_x) = self.edges();
        let p = self.corners[0] + along_x * u_position.x + along_y * u_position.y;
        let cosine = w_out.z;
        let w = -self.frame.to_world(w_out);
        Some(EmittedRay {
            // From where the light comes, since what stands before the opening is in its way.
            ray: Ray::new(p - w * self.way_out(context, p), w),
            p_error: Vector3::splat(0.0),
            n: None,
            uv: Point2::splat(0.0),
            le: self.radiance(context, uv, lambda),
            cosine: 1.0,
            pdf_a: 1.0 / (self.area() * cosine), // per square metre across the ray
            pdf_w: pdf_uv / jacobian,
        })
    }

    pub(super) fn pdf_le(&self, _: &LightContext, ray: &Ray, _: Option<Normal3>) -> (f32, f32) {
        let Some((uv, jacobian)) = self.square_from_world(-ray.direction) else { return (0.0, 0.0) };
        let cosine = -ray.direction.dot(self.frame.z);
        if jacobian <= 0.0 {
            return (0.0, 0.0);
        }
        (1.0 / (self.area() * cosine), self.emission.pdf(uv) / jacobian)
    }

    /// A distance from a point in any direction at which all of the scene lies behind.
    fn way_out(&self, context: &LightContext, p: Point3) -> f32 {
        let sphere = &context.tables.scene_sphere;
        p.distance(sphere.center) + sphere.radius
    }

    /// The first and the last edge.
    fn edges(&self) -> (Vector3, Vector3) {
        (self.corners[1] - self.corners[0], self.corners[3] - self.corners[0])
    }

    fn area(&self) -> f32 {
        let (a, b) = self.edges();
        a.cross(b).length()
    }

    pub(super) fn power(&self, context: &LightContext) -> LightPower {
        LightPower::of(&self.exitance, context.spectra) * f64::from(self.scale * self.area())
    }

    pub(super) const fn bounds(&self, _: &LightContext) -> Option<LightBounds> {
        None
    }
}

fn contains(window: &Bounds2, uv: Point2) -> bool {
    uv.x >= window.min.x && uv.x <= window.max.x && uv.y >= window.min.y && uv.y <= window.max.y
}
