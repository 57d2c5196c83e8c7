//! Pictures of one scene by several exposures: radiance from them (Debevec and Malik 1997, "Recovering High Dynamic Range
//! Radiance Maps from Photographs"; SPEC TONE-9), and one picture of their best parts without radiance (Mertens, Kautz and Van
//! Reeth 2007, "Exposure Fusion"; SPEC TONE-10).
//!
//! All take what cameras store: encoded values in [0, 1], the same number of pixels in each picture.

mod fusion;
mod merge;
mod response;

pub use fusion::{Fusion, fuse};
pub use merge::{Exposure, merge};
pub use response::Response;

use std::fmt;

/// Why exposures cannot be combined.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ExposureError {
    /// There are too few of them.
    TooFew,
    /// Their sizes differ: index of the first that does.
    Size(usize),
    /// A time is not a positive number: index of the exposure.
    Time(usize),
    /// All have the same time, which tells nothing of the camera.
    SameTimes,
    /// All pixels of all exposures are black or white, which tells nothing of radiance.
    Clipped,
}

impl fmt::Display for ExposureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFew => write!(f, "at least two exposures are needed"),
            Self::Size(index) => write!(f, "picture {} has another size than the first", index + 1),
            Self::Time(index) => write!(f, "the time of exposure {} is not a positive number", index + 1),
            Self::SameTimes => write!(f, "all exposures have the same time"),
            Self::Clipped => {
                write!(f, "no pixel of any exposure is between black and white: expose longer or shorter")
            }
        }
    }
}

impl std::error::Error for ExposureError {}

#[cfg(test)]
mod tests;
