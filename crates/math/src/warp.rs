//! Warps: maps of uniform random numbers to a wanted density, by inversion of its distribution function (SPEC MC-7).
//!
//! Each comes in three: `sample_x` takes numbers in [0, 1), `x_pdf` gives the density of its result, `invert_x`
//! gives the numbers back. Directions are in a frame whose +z is the axis; their densities are per steradian.

mod disk;
mod equal_area;
mod hemisphere;
mod interval;
mod rectangle;
mod sphere;
mod square;
mod triangle;

pub use disk::{
    concentric_disk_pdf, invert_concentric_disk, invert_polar_disk, polar_disk_pdf, sample_concentric_disk,
    sample_polar_disk,
};
pub use equal_area::{equal_area_sphere_to_square, equal_area_square_to_sphere, wrap_equal_area_square};
pub use hemisphere::{
    cosine_hemisphere_pdf, cosine_power_pdf, invert_cosine_hemisphere, invert_cosine_power,
    invert_uniform_hemisphere, sample_cosine_hemisphere, sample_cosine_power, sample_uniform_hemisphere,
    uniform_hemisphere_pdf,
};
pub use interval::{
    exponential_pdf, invert_exponential, invert_linear, invert_normal, invert_tent, linear_pdf, normal_pdf,
    sample_discrete, sample_exponential, sample_linear, sample_normal, sample_tent, tent_pdf,
};
pub use rectangle::{Rectangle, SphericalRectangle, sample_spherical_rectangle};
pub use sphere::{
    invert_narrow_cone, invert_uniform_cone, invert_uniform_sphere, narrow_cone_pdf, sample_narrow_cone,
    sample_uniform_cone, sample_uniform_sphere, uniform_cone_pdf, uniform_sphere_pdf,
};
pub use square::{bilinear_pdf, invert_bilinear, sample_bilinear};
pub use triangle::{
    SphericalTriangle, invert_spherical_triangle, invert_uniform_triangle, sample_spherical_triangle,
    sample_uniform_triangle, spherical_triangle_solid_angle, uniform_triangle_pdf,
};

#[cfg(test)]
mod tests;
