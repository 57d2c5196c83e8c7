//! Étendue's io crate.
