//! Étendue as a library: the crates of the renderer under one name.

pub use etendue_geometry as geometry;
pub use etendue_image as image;
pub use etendue_io as io;
pub use etendue_lab as lab;
pub use etendue_math as math;
pub use etendue_scene as scene;
pub use etendue_spectrum as spectrum;
pub use etendue_transport as transport;
