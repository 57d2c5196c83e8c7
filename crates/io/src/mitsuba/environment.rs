//! Pictures of the surroundings by longitude and latitude as the square equal-area ones that our lights have (Clarberg 2008,
//! "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD").

use std::f32::consts::PI;

use etendue_image::{DecodeTable, Encoding, TexelData, Texels};
use etendue_math::{Point2, Vector3, warp};
use rayon::prelude::*;

/// Longitude and latitude in [0, 1] of a direction in Mitsuba's `envmap`: +y is up, the middle of the picture is +z.
pub(super) fn y_is_up(w: Vector3) -> Point2 {
    let u = w.x.atan2(-w.z) / (2.0 * PI);
    Point2::new(if u < 0.0 { u + 1.0 } else { u }, w.y.clamp(-1.0, 1.0).acos() / PI)
}

/// A picture by longitude and latitude as a square of equal areas of about as many texels, each the mean of 4 x 4 samples
/// by bilinear interpolation. `place` says where a direction is found, from the upper left corner.
pub(super) fn equal_area_of_latitude_longitude(
    texels: &Texels,
    place: &(impl Fn(Vector3) -> Point2 + Sync),
) -> Texels {
    const SAMPLES: usize = 4;
    const MAX_SIDE: usize = 8192;
    let (width, height) = (texels.width(), texels.height());
    let side = (((width * height) as f64).sqrt().ceil() as usize).clamp(1, MAX_SIDE);
    let decode = DecodeTable::new(Encoding::Srgb);
    let at = |x: isize, y: isize| {
        let (x, y) = (x.rem_euclid(width as isize) as usize, y.clamp(0, height as isize - 1) as usize);
        texels.linear_rgb(x, y, &decode)
    };
    let bilinear = |p: Point2| -> [f32; 3] {
        let (x, y) = (p.x * width as f32 - 0.5, p.y * height as f32 - 0.5);
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let (x, y) = (x.floor() as isize, y.floor() as isize);
        let corners = [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)];
        let weights = [(1.0 - fx) * (1.0 - fy), fx * (1.0 - fy), (1.0 - fx) * fy, fx * fy];
        std::array::from_fn(|c| corners.iter().zip(weights).map(|(corner, weight)| weight * corner[c]).sum())
    };
    let mut values = vec![0.0; side * side * 3];
    values.par_chunks_mut(side * 3).enumerate().for_each(|(row, line)| {
        for (column, texel) in line.chunks_mut(3).enumerate() {
            for sample in 0..SAMPLES * SAMPLES {
                let inside = |i: usize| (i as f32 + 0.5) / SAMPLES as f32;
                let u = (column as f32 + inside(sample % SAMPLES)) / side as f32;
                let v = (row as f32 + inside(sample / SAMPLES)) / side as f32;
                let rgb = bilinear(place(warp::equal_area_square_to_sphere(Point2::new(u, v))));
                for (value, c) in texel.iter_mut().zip(rgb) {
                    *value += c / (SAMPLES * SAMPLES) as f32;
                }
            }
        }
    });
    let mut square = Texels::new(side, side, 3, TexelData::F32(values));
    square.color_space = texels.color_space;
    square
}
