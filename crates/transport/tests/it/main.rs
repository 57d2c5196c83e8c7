//! The path tracer and the film against closed forms, against themselves and against the laws of estimation.
//!
//! Scenes are short texts. Statistical comparisons use the variance that the renders show; each also demands that it
//! would have seen a small error. With `ETENDUE_SLOW=1` the studies run that need minutes.

mod support;

mod adaptive;
mod ambient_occlusion;
mod bands;
mod branching;
mod classes;
mod controls;
mod convergence;
mod degenerate;
mod determinism;
mod features;
mod furnace;
mod gathering;
mod layers;
mod light_tracing;
mod media;
mod merging;
mod motion;
mod passes;
mod photon_files;
mod photon_mapping;
mod photon_maps;
mod photon_terms;
mod photons;
mod pictures;
mod probe;
mod progressive;
mod radiometry;
mod reuse;
mod scenes;
mod spectra;
mod strategies;
mod surfaces;
mod traced_lights;
mod whitted;
