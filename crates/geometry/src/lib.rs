//! Étendue's geometry crate.
