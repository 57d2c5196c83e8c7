//! Pictures on disk: reading into texels or planes, and writing whole files or none.
