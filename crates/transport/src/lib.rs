//! How light is computed: one file or folder for each method, and the pass loop that runs them.
//!
//! Knows neither files nor terminals, clocks or thread pools; nothing here can fail.

pub mod ambient_occlusion;
pub mod integrator;
pub mod light_tracing;
pub mod lpe;
pub mod method;
pub mod path;
pub mod path_tracing;
pub mod photon;
pub mod probe;
pub mod render;
pub mod whitted;

pub use integrator::{Control, Integrator, PassEnd, Passes, RayCounts, ReportEntry};
pub use method::{INTEGRATORS, method, method_name, with_own_layers};
pub use render::{Flow, Observer, Outcome, Stop, Unobserved, render};

#[cfg(test)]
mod tests;
