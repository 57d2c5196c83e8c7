//! Mathematics of rendering: vectors, frames, transforms, rays, warps with their densities and inverses,
//! samplers, tabulated distributions and the statistics that tests use. Knows nothing of light.
//!
//! Conventions: right-handed or left-handed is the caller's choice (pbrt files are left-handed); angles are in
//! radians; points, vectors and normals are different types because transforms treat them differently.

mod vector;

mod bounds;
mod frame;
mod numeric;
mod ray;
mod transform;

pub use bounds::{Bounds2, Bounds3};
pub use frame::Frame;
pub use numeric::{clamp_cosine, lerp, next_float_down, next_float_up, safe_acos, safe_sqrt, sqr};
pub use ray::{Ray, offset_ray_origin};
pub use transform::{AnimatedTransform, Transform};
pub use vector::{Normal3, Point2, Point3, Vector2, Vector3};
