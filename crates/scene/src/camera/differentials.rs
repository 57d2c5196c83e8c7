//! How far apart the surface points of neighbouring pixels are, estimated from a surface point alone.
//!
//! Any path vertex needs this for the filtering of textures, also after reflections, where rays of neighbouring
//! pixels are not tracked. As in pbrt-v4 (Pharr, Jakob and Humphreys 2023, section 10.1.3) the smallest spacing of
//! rays found over the film is sent from the camera to the point, as if nothing lay between, and intersected with
//! the tangent plane. The estimate is small rather than large: textures alias rather than blur.

use etendue_math::{Frame, Normal3, Point2, Point3, Vector3};

use super::{Camera, CameraRay, Projection};

/// The smallest change of camera rays per pixel, along x and y, in the frame of the ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct MinimumDifferentials {
    origin: [Vector3; 2],
    direction: [Vector3; 2],
}

/// The frame of a ray: z along it, x towards the camera's x.
fn ray_frame(direction: Vector3) -> Frame {
    Frame::from_zx(direction, Vector3::new(1.0, 0.0, 0.0))
}

impl MinimumDifferentials {
    /// Searches along the diagonal of the film.
    pub(super) fn new(projection: &Projection, resolution: [u32; 2]) -> Self {
        const N_POSITIONS: u32 = 512;
        const STEP: f32 = 0.05;
        let centre = Point2::new(0.5, 0.5);
        let mut result =
            Self { origin: [Vector3::splat(f32::MAX); 2], direction: [Vector3::splat(f32::MAX); 2] };
        let keep_shorter = |best: &mut Vector3, v: Vector3| {
            if v.is_finite() && v.length() < best.length() {
                *best = v;
            }
        };
        for i in 0..N_POSITIONS {
            let t = (i as f32 + 0.5) / N_POSITIONS as f32;
            let p = Point2::new(t * resolution[0] as f32, t * resolution[1] as f32);
            let Some(CameraRay { ray, .. }) = projection.ray(p, centre) else { continue };
            let frame = ray_frame(ray.direction);
            for axis in 0..2 {
                let mut shifted = p;
                shifted[axis] += STEP;
                let Some(CameraRay { ray: other, .. }) = projection.ray(shifted, centre) else { continue };
                keep_shorter(&mut result.origin[axis], frame.to_local(other.origin - ray.origin) / STEP);
                let mut change = frame.to_local(other.direction - ray.direction) / STEP;
                change.z = 0.0;
                keep_shorter(&mut result.direction[axis], change);
            }
        }
        if result.direction.contains(&Vector3::splat(f32::MAX)) {
            // No ray met a neighbour: textures are not filtered.
            return Self { origin: [Vector3::default(); 2], direction: [Vector3::default(); 2] };
        }
        result
    }

    /// Change along the tangent plane with normal `n` at distance `distance` along the ray, per pixel.
    fn on_plane(&self, axis: usize, distance: f32, n: Vector3) -> Vector3 {
        let direction = Vector3::new(0.0, 0.0, 1.0) + self.direction[axis];
        let offset = Vector3::new(0.0, 0.0, distance) - self.origin[axis];
        let t = n.dot(offset) / n.dot(direction);
        let change = direction * t - offset;
        if change.is_finite() { change } else { Vector3::splat(0.0) }
    }
}

impl Camera {
    /// Approximate change of the surface point `p` with geometric normal `n` from a pixel to its right neighbour and
    /// to the one below, in metres. With many samples per pixel the change per sample is smaller, which sharpens
    /// textures: it is scaled by `max(1/8, 1/sqrt(samples_per_pixel))`.
    #[must_use]
    pub fn dpdx_dpdy(&self, p: Point3, n: Normal3, time: f32, samples_per_pixel: u32) -> (Vector3, Vector3) {
        let world_from_camera = self.transform_at(time);
        let camera_from_world = world_from_camera.inverse();
        let p_camera = camera_from_world.point(p).as_vector();
        let is_parallel = matches!(self.projection, Projection::Orthographic(_));
        let (axis, distance) = if is_parallel {
            (Vector3::new(0.0, 0.0, 1.0), p_camera.z)
        } else {
            (p_camera, p_camera.length())
        };
        let Some(axis) = axis.try_normalized() else {
            return (Vector3::default(), Vector3::default());
        };
        let frame = ray_frame(axis);
        let n_local = frame.to_local(camera_from_world.normal(n).as_vector());
        let scale = (1.0 / (samples_per_pixel.max(1) as f32).sqrt()).max(0.125);
        let change = |axis: usize| {
            let local = self.differentials.on_plane(axis, distance, n_local);
            world_from_camera.vector(frame.to_world(local)) * scale
        };
        (change(0), change(1))
    }
}
