//! Bytes of a file, decompressed if it is a gzip stream.

use std::borrow::Cow;
use std::io::{ErrorKind, Read};
use std::path::Path;

use flate2::bufread::MultiGzDecoder;

use crate::error::FileError;

/// Spans count bytes in 32 bits.
const MAX_BYTES: u64 = u32::MAX as u64;

/// The bytes of a file that a scene names, decompressed if they begin with gzip's mark. Devices and pipes are refused, since
/// they may never end.
///
/// # Errors
/// If the file is missing, a folder or a device, unreadable, damaged or larger than 4 GiB.
pub fn read_file(path: &Path) -> Result<Vec<u8>, FileError> {
    check_regular(path)?;
    read_given_file(path)
}

/// The same for a file that the user names, which may be a pipe.
///
/// # Errors
/// If the file is missing, a folder, unreadable, damaged or larger than 4 GiB.
pub(crate) fn read_given_file(path: &Path) -> Result<Vec<u8>, FileError> {
    let failed = |error| failure(path, &error);
    let metadata = std::fs::metadata(path).map_err(failed)?;
    if metadata.is_dir() {
        return Err(FileError::Folder(path.to_owned()));
    }
    if metadata.len() > MAX_BYTES {
        return Err(FileError::TooLarge(path.to_owned()));
    }
    let mut bytes = Vec::with_capacity(metadata.len() as usize);
    let file = std::fs::File::open(path).map_err(failed)?;
    file.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(FileError::TooLarge(path.to_owned()));
    }
    if !is_gzip(&bytes) {
        return Ok(bytes);
    }
    let content = gunzip(&bytes).map_err(|why| FileError::Gzip(path.to_owned(), why))?;
    if content.len() as u64 > MAX_BYTES {
        return Err(FileError::TooLarge(path.to_owned()));
    }
    Ok(content)
}

/// Refuses what is neither a regular file nor a link to one.
///
/// # Errors
/// If it is something else, or not there.
pub(crate) fn check_regular(path: &Path) -> Result<(), FileError> {
    let metadata = std::fs::metadata(path).map_err(|error| failure(path, &error))?;
    if metadata.is_file() {
        Ok(())
    } else if metadata.is_dir() {
        Err(FileError::Folder(path.to_owned()))
    } else {
        Err(FileError::Unreadable(path.to_owned(), "it is a device or a pipe, not a file".to_owned()))
    }
}

fn failure(path: &Path, error: &std::io::Error) -> FileError {
    match error.kind() {
        ErrorKind::NotFound => FileError::NotFound(path.to_owned()),
        ErrorKind::IsADirectory => FileError::Folder(path.to_owned()),
        _ => FileError::Unreadable(path.to_owned(), error.to_string()),
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// What never ends is refused where a scene names it.
    #[cfg(unix)]
    #[test]
    fn devices_are_refused() {
        let error = read_file(Path::new("/dev/zero")).expect_err("a device");
        assert!(error.to_string().contains("device"), "{error}");
        assert!(matches!(read_file(Path::new("/dev")), Err(FileError::Folder(_))));
    }
}
