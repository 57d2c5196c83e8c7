//! The command as a user runs it: the real program in temporary folders.

mod accelerators;
mod arguments;
mod bad_files;
mod bad_scenes;
mod brdf;
mod checkpoint;
mod degenerate;
mod denoise;
mod formats;
mod lights;
mod listing;
mod outputs;
mod parts;
mod pictures;
mod real_scenes;
mod references;
mod scenes;
mod stand_ins;
mod statistics;
mod support;
mod tools;
