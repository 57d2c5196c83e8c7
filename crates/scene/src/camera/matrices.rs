//! Matrices by which other programs find where points of the world are in the picture.

use etendue_math::{Point2, Point3};

use super::{Camera, Projection};

/// By rows, for column vectors.
type Matrix4 = [[f32; 4]; 4];

/// Depth that becomes 0 in normalised device coordinates, in metres; infinity becomes 1.
const NEAR: f32 = 0.01;

impl Camera {
    /// From the world to the camera (x right, y up, z forward, metres), and on to normalised device coordinates: x from -1 at the left
    /// to 1 at the right edge of the whole film, y from -1 at the bottom to 1 at the top. Where the camera moves, when the shutter
    /// opens. Cameras without such a matrix (fisheyes, panoramas, lenses) give `None`.
    #[must_use]
    pub fn projection_matrices(&self, resolution: [u32; 2]) -> ([[f32; 4]; 4], Option<[[f32; 4]; 4]>) {
        let world_to_camera = *self.world_from_camera().start.inverse().rows();
        let world_to_ndc = self.ndc_from_camera(resolution).map(|matrix| multiply(&matrix, &world_to_camera));
        (world_to_camera, world_to_ndc)
    }

    /// By the rays through two opposite corners: both projections are linear in between.
    fn ndc_from_camera(&self, resolution: [u32; 2]) -> Option<Matrix4> {
        let is_perspective = match self.projection() {
            Projection::Perspective(_) => true,
            Projection::Orthographic(_) => false,
            _ => return None,
        };
        // The middle of the lens.
        let lens = Point2::new(0.5, 0.5);
        let place = |x: f32, y: f32| {
            let ray = self.projection().ray(Point2::new(x, y), lens)?.ray;
            let Point3 { x, y, .. } = ray.origin;
            let d = ray.direction;
            Some(if is_perspective { [d.x / d.z, d.y / d.z] } else { [x, y] })
        };
        let [width, height] = resolution.map(|n| n as f32);
        let (left_bottom, right_top) = (place(0.0, height)?, place(width, 0.0)?);
        let scale = [0, 1].map(|i| 2.0 / (right_top[i] - left_bottom[i]));
        let offset = [0, 1].map(|i| -(right_top[i] + left_bottom[i]) / (right_top[i] - left_bottom[i]));
        Some(if is_perspective {
            [
                [scale[0], 0.0, offset[0], 0.0],
                [0.0, scale[1], offset[1], 0.0],
                [0.0, 0.0, 1.0, -NEAR],
                [0.0, 0.0, 1.0, 0.0],
            ]
        } else {
            [
                [scale[0], 0.0, 0.0, offset[0]],
                [0.0, scale[1], 0.0, offset[1]],
                [0.0, 0.0, 1.0, 0.0],
                [0.0, 0.0, 0.0, 1.0],
            ]
        })
    }
}

fn multiply(a: &Matrix4, b: &Matrix4) -> Matrix4 {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..4).map(|k| a[i][k] * b[k][j]).sum()))
}
