//! Bytes to values and back: scene files, meshes, images, measured spectra and tables. The only crate below the front ends
//! that opens files.
//!
//! Reading a scene has two steps: [`read_scene`] makes a [`Document`](etendue_scene::Document), which names files, and
//! [`load_assets`] reads these.

pub mod assets;
pub mod brdf_table;
pub mod checkpoint;
pub mod contours;
pub mod error;
pub mod gltf;
pub mod ies;
pub mod images;
pub mod lens;
pub mod measured;
pub mod mesh;
pub mod mitsuba;
pub mod obj;
pub mod pbrt;
pub mod ply;
pub mod scene_file;
pub mod spd;
pub mod stage;
pub mod tensor;

mod exact;
mod file;
mod json;
#[cfg(test)]
mod test_support;

pub use assets::load_assets;
pub use brdf_table::read_brdf_table;
pub use contours::read_contours;
pub use error::FileError;
pub use file::read_file;
pub use gltf::read_gltf;
pub use images::{ImageError, read_image, read_texels, read_texels_from, write_image};
pub use lens::read_lens;
pub use measured::{measured_bytes, read_measured};
pub use mitsuba::read_mitsuba;
pub use obj::read_obj;
pub use pbrt::{read_pbrt, read_pbrt_str, write_pbrt};
pub use ply::{read_ply, write_ply};
pub use scene_file::read_scene;
