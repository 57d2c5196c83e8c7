//! Étendue's transport crate.
