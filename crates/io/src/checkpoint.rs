//! Checkpoints: the exact state of a render between two passes.
//!
//! Layout, little-endian: the magic `ETENDUE` with a version byte; the length of the header in 8 bytes; the header
//! ([`postcard`]); the sums of the film; a 64-bit hash of everything before it. A file appears whole or not at all.

use std::fmt;
use std::io::Write;
use std::ops::Range;
use std::path::Path;

use etendue_math::hash64;
use serde::{Deserialize, Serialize};

use crate::images::write_atomically;

const MAGIC: [u8; 8] = *b"ETENDUE\x01";

/// The state of a render between two passes.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// Hash of everything that determines the image but for the seed and the number of passes.
    pub fingerprint: u64,
    /// Seed of the sampler.
    pub seed: u64,
    /// Passes that the sums hold.
    pub passes: Vec<Range<u64>>,
    /// State of the integrator.
    pub state: Vec<u8>,
    /// Sums of the film.
    pub sums: Vec<u8>,
}

#[derive(Serialize, Deserialize)]
struct Header {
    fingerprint: u64,
    seed: u64,
    passes: Vec<(u64, u64)>,
    state: Vec<u8>,
}

/// Why a checkpoint could not be read or written.
#[derive(Debug)]
pub enum CheckpointError {
    /// The file system refused.
    Io(std::io::Error),
    /// The file is no checkpoint of this version.
    Format,
    /// The file is damaged.
    Damaged,
}

impl fmt::Display for CheckpointError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => write!(f, "{error}"),
            Self::Format => write!(f, "it is not a checkpoint of this version of etendue"),
            Self::Damaged => write!(f, "the file is damaged or cut short"),
        }
    }
}

impl std::error::Error for CheckpointError {}

impl From<std::io::Error> for CheckpointError {
    fn from(error: std::io::Error) -> Self {
        Self::Io(error)
    }
}

/// Hash of bytes, the same on every machine.
#[must_use]
pub fn hash_bytes(bytes: &[u8]) -> u64 {
    let (words, rest) = bytes.as_chunks::<8>();
    let mut tail = [0; 8];
    tail[..rest.len()].copy_from_slice(rest);
    let last = [u64::from_le_bytes(tail), bytes.len() as u64];
    words
        .chunks(512)
        .map(|chunk| hash64(&chunk.iter().map(|w| u64::from_le_bytes(*w)).collect::<Vec<_>>()))
        .fold(hash64(&last), |hash, chunk| hash64(&[hash, chunk]))
}

/// Writes a checkpoint; an older one of that name is replaced only when the new one is complete.
///
/// # Errors
/// Where the file system refuses.
pub fn write_checkpoint(path: &Path, checkpoint: &Checkpoint) -> Result<(), CheckpointError> {
    let header = Header {
        fingerprint: checkpoint.fingerprint,
        seed: checkpoint.seed,
        passes: checkpoint.passes.iter().map(|r| (r.start, r.end)).collect(),
        state: checkpoint.state.clone(),
    };
    let header = postcard::to_allocvec(&header).map_err(|_| CheckpointError::Damaged)?;
    let mut bytes = Vec::with_capacity(MAGIC.len() + 16 + header.len() + checkpoint.sums.len());
    bytes.extend_from_slice(&MAGIC);
    bytes.extend_from_slice(&(header.len() as u64).to_le_bytes());
    bytes.extend_from_slice(&header);
    bytes.extend_from_slice(&checkpoint.sums);
    let hash = hash_bytes(&bytes);
    bytes.extend_from_slice(&hash.to_le_bytes());
    write_atomically(path, |out| out.write_all(&bytes).map_err(CheckpointError::Io))
}

/// Reads a checkpoint.
///
/// # Errors
/// Where the file cannot be read, is something else, or is damaged.
pub fn read_checkpoint(path: &Path) -> Result<Checkpoint, CheckpointError> {
    let bytes = std::fs::read(path)?;
    if !bytes.starts_with(&MAGIC) {
        return Err(CheckpointError::Format);
    }
    let Some((content, hash)) = bytes.split_last_chunk::<8>() else {
        return Err(CheckpointError::Damaged);
    };
    if hash_bytes(content) != u64::from_le_bytes(*hash) {
        return Err(CheckpointError::Damaged);
    }
    let Some((length, rest)) = content[MAGIC.len()..].split_first_chunk::<8>() else {
        return Err(CheckpointError::Damaged);
    };
    let length = u64::from_le_bytes(*length) as usize;
    let header = rest.get(..length).ok_or(CheckpointError::Damaged)?;
    let header: Header = postcard::from_bytes(header).map_err(|_| CheckpointError::Damaged)?;
    Ok(Checkpoint {
        fingerprint: header.fingerprint,
        seed: header.seed,
        passes: header.passes.into_iter().map(|(start, end)| start..end).collect(),
        state: header.state,
        sums: rest[length..].to_vec(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Checkpoint {
        Checkpoint {
            fingerprint: 7,
            seed: 9,
            passes: vec![0..8, 12..13],
            state: vec![1, 2, 3],
            sums: (0..1600).map(|i| (i % 251) as u8).collect(),
        }
    }

    /// What was written comes back.
    #[test]
    fn round_trip() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.checkpoint");
        write_checkpoint(&path, &example()).expect("written");
        assert_eq!(read_checkpoint(&path).expect("read"), example());
    }

    /// A changed bit, a cut and a foreign file are told apart and refused.
    #[test]
    fn damage_is_found() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.checkpoint");
        write_checkpoint(&path, &example()).expect("written");
        let good = std::fs::read(&path).expect("bytes");
        for position in [8, 20, good.len() / 2, good.len() - 1] {
            let mut bad = good.clone();
            bad[position] ^= 1;
            std::fs::write(&path, &bad).expect("written");
            assert!(matches!(read_checkpoint(&path), Err(CheckpointError::Damaged)), "byte {position}");
        }
        std::fs::write(&path, &good[..good.len() / 2]).expect("written");
        assert!(matches!(read_checkpoint(&path), Err(CheckpointError::Damaged)));
        std::fs::write(&path, b"not a checkpoint").expect("written");
        assert!(matches!(read_checkpoint(&path), Err(CheckpointError::Format)));
    }
}
