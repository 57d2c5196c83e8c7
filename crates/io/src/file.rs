//! Bytes of a file, decompressed if it is a gzip stream.

use std::borrow::Cow;
use std::io::{ErrorKind, Read};
use std::path::Path;

use flate2::bufread::MultiGzDecoder;

use crate::error::FileError;

/// Spans count bytes in 32 bits.
const MAX_BYTES: u64 = u32::MAX as u64;

/// The bytes of the file, decompressed if they begin with gzip's mark.
///
/// # Errors
/// If the file is missing, a folder, unreadable, damaged or larger than 4 GiB.
pub fn read_file(path: &Path) -> Result<Vec<u8>, FileError> {
    let failed = |error: std::io::Error| match error.kind() {
        ErrorKind::NotFound => FileError::NotFound(path.to_owned()),
        ErrorKind::IsADirectory => FileError::Folder(path.to_owned()),
        _ => FileError::Unreadable(path.to_owned(), error.to_string()),
    };
    let metadata = std::fs::metadata(path).map_err(failed)?;
    if metadata.is_dir() {
        return Err(FileError::Folder(path.to_owned()));
    }
    if metadata.len() > MAX_BYTES {
        return Err(FileError::TooLarge(path.to_owned()));
    }
    let bytes = std::fs::read(path).map_err(failed)?;
    if !is_gzip(&bytes) {
        return Ok(bytes);
    }
    let content = gunzip(&bytes).map_err(|why| FileError::Gzip(path.to_owned(), why))?;
    if content.len() as u64 > MAX_BYTES {
        return Err(FileError::TooLarge(path.to_owned()));
    }
    Ok(content)
}

/// The bytes themselves, or what they decompress to if they are a gzip stream.
///
/// # Errors
/// If the stream is damaged: the reason.
pub(crate) fn decompressed(bytes: &[u8]) -> Result<Cow<'_, [u8]>, String> {
    if is_gzip(bytes) { gunzip(bytes).map(Cow::Owned) } else { Ok(Cow::Borrowed(bytes)) }
}

fn is_gzip(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b])
}

/// At most one byte more than is allowed, so that a small stream cannot fill the memory.
fn gunzip(bytes: &[u8]) -> Result<Vec<u8>, String> {
    let mut content = Vec::new();
    MultiGzDecoder::new(bytes)
        .take(MAX_BYTES + 1)
        .read_to_end(&mut content)
        .map_err(|error| error.to_string())?;
    Ok(content)
}
