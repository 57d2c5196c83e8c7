//! Tests of pixel filters.
