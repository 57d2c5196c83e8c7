//! Étendue's image crate.
