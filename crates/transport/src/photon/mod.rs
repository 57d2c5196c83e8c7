//! Light from its source: photons, their emission, and their walk through the scene (Jensen 2001, "Realistic Image Synthesis
//! Using Photon Mapping", chapters 4 and 5; SPEC PM-1, PM-2).
//!
//! A photon is a packet of flux. Those of a pass share the flux of all lights: a photon's [`flux`](walk::PhotonVertex::flux) is
//! what it would carry alone, to be divided by how many were emitted. All methods that follow light, from light tracing to
//! photon maps, share [`emit`] and [`walk`].

pub mod direct_view;
pub mod emit;
pub mod estimate;
mod lack;
pub mod map;
pub mod mapping;
pub mod pattern;
pub mod progressive;
pub mod settings;
pub mod switches;
pub mod trail;
pub mod walk;

pub use emit::{EmissionSettings, EmittedPhoton, MapScheme, PhotonEmitter, Target};
pub use map::{Photon, PhotonMap, PhotonMapBuilder, StoredPhoton};
pub use pattern::PhotonPattern;
pub use settings::PhotonSettings;
pub use switches::Switches;
pub use trail::Trail;
pub use walk::{Absorption, Onward, PhotonVertex, PhotonWalk, trace_photon_parts, trace_photons};
