//! The steps that methods share: weights, roulette, direct light, and passes over the pixels of a camera.

pub mod adaptive;
pub mod camera_pass;
pub mod direct;
pub mod features;
pub mod medium;
pub mod mis;
pub mod roulette;
