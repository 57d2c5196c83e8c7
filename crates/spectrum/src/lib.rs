//! Étendue's spectrum crate.
