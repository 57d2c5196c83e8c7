//! Why a file could not be read, by cause.

use std::fmt;
use std::path::PathBuf;

/// A file that could not be turned into bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileError {
    /// There is no such file.
    NotFound(PathBuf),
    /// The path is a folder.
    Folder(PathBuf),
    /// The operating system refused, with its reason.
    Unreadable(PathBuf, String),
    /// The file is compressed and damaged, with the reason.
    Gzip(PathBuf, String),
    /// The content exceeds 4 GiB.
    TooLarge(PathBuf),
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFound(path) => write!(f, "there is no file `{}`", path.display()),
            Self::Folder(path) => write!(f, "`{}` is a folder, not a file", path.display()),
            Self::Unreadable(path, why) => write!(f, "cannot read `{}`: {why}", path.display()),
            Self::Gzip(path, why) => write!(f, "cannot decompress `{}`: {why}", path.display()),
            Self::TooLarge(path) => write!(f, "`{}` holds more than 4 GiB", path.display()),
        }
    }
}

impl std::error::Error for FileError {}
