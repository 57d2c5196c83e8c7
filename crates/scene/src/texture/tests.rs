//! Tests of textures.
