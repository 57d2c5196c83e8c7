//! Mathematics of rendering: vectors, frames, transforms, rays, warps with their densities and inverses,
//! samplers, tabulated distributions and the statistics that tests use. Knows nothing of light.
//!
//! Conventions: right-handed or left-handed is the caller's choice (pbrt files are left-handed); angles are in
//! radians; points, vectors and normals are different types because transforms treat them differently.

mod vector;

pub mod approx;
mod bounds;
pub mod expression;
mod frame;
mod lanes;
mod numeric;
mod ray;
mod transform;

mod alias;
pub mod low_discrepancy;
mod piecewise;
pub mod polynomial;
mod rng;
mod sampler;
pub mod statistics;
pub mod warp;

pub use alias::AliasTable;
pub use bounds::{Bounds2, Bounds3};
pub use frame::Frame;
pub use lanes::Lanes4;
pub use numeric::{clamp_cosine, lerp, next_float_down, next_float_up, safe_acos, safe_sqrt, sqr};
pub use piecewise::{PiecewiseConstant1, PiecewiseConstant2, WindowedPiecewiseConstant2};
pub use ray::{Ray, offset_ray_origin};
pub use rng::{ONE_MINUS_EPSILON, Rng, hash64, mix64, unit_f32, unit_f64};
pub use sampler::{Sampler, SamplerKind, SamplerSettings};
pub use transform::{AnimatedTransform, Motion, Transform};
pub use vector::{Normal3, Point2, Point3, Vector2, Vector3};
