//! The command as a user runs it: the real program in temporary folders.

mod accelerators;
mod arguments;
mod bad_files;
mod bad_scenes;
mod brdf;
mod checkpoint;
mod degenerate;
<<<<<<< HEAD
mod lights;
=======
mod formats;
>>>>>>> 9ed5a41 (io: suns and skies of Mitsuba, creases of bare meshes, tests of both readers)
mod listing;
mod outputs;
mod parts;
mod real_scenes;
mod references;
mod stand_ins;
mod statistics;
mod support;
mod tools;
