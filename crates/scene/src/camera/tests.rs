//! Tests of cameras.
