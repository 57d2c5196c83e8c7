//! How fast the renderer is: built-in models and work whose time a front end takes.
//!
//! Nothing here reads a clock. [`Model`] is something for rays to hit, [`ray_sets`] the rays of four kinds that a path
//! tracer sends: coherent ones from a camera, scattered ones, shadow rays, and rays from anywhere to anywhere.
//! [`tasks`] are pieces of work that together tell how fast a machine is.

mod model;
mod rays;
mod tasks;

pub use model::{Lamp, Model};
pub use rays::{RayKind, RaySet, ray_sets};
pub use tasks::{Task, TaskSize, tasks};

#[cfg(test)]
mod tests;
