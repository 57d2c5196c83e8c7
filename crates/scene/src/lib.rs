//! What is there: materials, textures, lights, cameras and film. An untyped [`Document`] with its assets becomes an
//! immutable [`Scene`]. Knows neither methods of light transport nor files.

pub mod diagnostics;
pub mod document;

pub mod assets;
pub mod parameters;

pub mod texture;

pub mod bsdf;
pub mod material;
pub mod medium;

pub mod controls;
pub mod light;

pub mod camera;
pub mod film;
pub mod filter;

pub mod build;
pub mod scene;

pub use assets::{Assets, AttributeDomain, LoadedMesh, MeshAttribute};
pub use diagnostics::{Diagnostic, Diagnostics, Severity, Sources, Span};
pub use document::Document;
pub use film::Film;
pub use scene::{Scene, Surface};
