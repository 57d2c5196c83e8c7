//! What is there: materials, textures, lights, cameras and film. An untyped [`Document`] with its assets becomes an
//! immutable [`Scene`]. Knows neither methods of light transport nor files.

pub mod assets;
pub mod bsdf;
pub mod camera;
pub mod diagnostics;
pub mod document;
pub mod film;
pub mod filter;
pub mod light;
pub mod material;
pub mod parameters;
pub mod texture;

pub use assets::{Assets, LoadedMesh};
pub use diagnostics::{Diagnostic, Diagnostics, Severity, Sources, Span};
pub use document::Document;
pub use film::Film;
