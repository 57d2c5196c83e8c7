//! Étendue's io crate.

pub mod images;
