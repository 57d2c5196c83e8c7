//! Studies: experiments with the renderer that anyone can rerun, each with its table and its figure.
//!
//! A study is a function from settings to a result that knows its CSV text and its SVG picture. It depends on its seed
//! alone, never on the number of threads. Front ends write the files.

pub mod estimator;
pub mod reference;
pub mod scenes;

pub mod accelerators;
pub mod brdf;
pub mod contest;
pub mod convergence;
pub mod estimates;
pub mod light_size;
pub mod neighbours;
pub mod photon_emission;
pub mod pixel;
pub mod scene_size;
pub mod speed;

pub mod generate;
pub mod photons;

pub mod fit;
pub mod plot;

pub use accelerators::{AcceleratorSettings, AcceleratorStudy, accelerators};
pub use brdf::{Exploration, Subject, explore, law_table};
pub use convergence::{Convergence, ConvergenceSettings, convergence};
pub use estimator::{Estimator, SamplerChoice};
pub use light_size::{LightSize, LightSizeSettings, light_size};
pub use neighbours::{NeighbourSettings, NeighbourStudy, neighbours};
pub use photon_emission::{EmissionStudy, EmissionStudySettings, photon_emission};
pub use pixel::{PixelSettings, PixelStudy, pixel};
pub use reference::ReferenceSettings;
pub use scene_size::{SceneSize, SceneSizeSettings, scene_size};
pub use scenes::StudyScene;

#[cfg(test)]
mod tests;
