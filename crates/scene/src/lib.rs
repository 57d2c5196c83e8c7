//! Étendue's scene crate.
