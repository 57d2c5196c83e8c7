//! Why a picture could not be read or written.

use std::fmt;
use std::io;
use std::path::PathBuf;

/// A failure with the file that it concerns.
#[derive(Debug)]
pub struct ImageError {
    /// The file as it was named by the caller.
    pub path: PathBuf,
    /// What went wrong.
    pub cause: ImageErrorCause,
}

/// Kinds of failure.
#[derive(Debug)]
#[non_exhaustive]
pub enum ImageErrorCause {
    /// There is no such file, or no such folder to write into.
    NotFound,
    /// The name is that of a folder.
    IsDirectory,
    /// Reading or writing failed in the file system.
    Io(io::Error),
    /// Neither the contents nor the extension tell a supported format.
    UnknownFormat {
        /// The extension in lower case, without dot.
        extension: String,
    },
    /// The contents do not start as the extension promises, nor as any other supported format does.
    WrongSignature {
        /// The extension in lower case, without dot.
        extension: String,
    },
    /// The format is known but this use of it is not supported.
    Unsupported(String),
    /// The file ends before its contents do.
    Truncated(String),
    /// The contents contradict themselves or the format.
    Malformed(String),
    /// More pixels than any picture here may have.
    TooLarge {
        /// Pixels in a row as stated.
        width: u64,
        /// Rows as stated.
        height: u64,
    },
    /// A picture without pixels or channels.
    Empty,
    /// No channels that make a colour or a gray value.
    NoColor {
        /// The channels that there are.
        channels: Vec<String>,
    },
}

impl fmt::Display for ImageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path.display(), self.cause)
    }
}

impl fmt::Display for ImageErrorCause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        use ImageErrorCause as Cause;
        match self {
            Cause::NotFound => write!(f, "no such file or folder"),
            Cause::IsDirectory => write!(f, "this is a folder, not a picture"),
            Cause::Io(error) => write!(f, "{error}"),
            Cause::UnknownFormat { extension } if extension.is_empty() => {
                write!(f, "no known picture format (the name has no extension)")
            }
            Cause::UnknownFormat { extension } => {
                write!(f, "no known picture format (extension `{extension}`)")
            }
            Cause::WrongSignature { extension } => {
                write!(f, "the contents are not those of a `{extension}` file")
            }
            Cause::Unsupported(what) => write!(f, "not supported: {what}"),
            Cause::Truncated(what) => write!(f, "the file ends too early: {what}"),
            Cause::Malformed(what) => write!(f, "malformed picture: {what}"),
            Cause::TooLarge { width, height } => {
                write!(f, "{width} x {height} pixels are more than supported")
            }
            Cause::Empty => write!(f, "a picture without pixels"),
            Cause::NoColor { channels } => {
                write!(f, "no channels R, G, B or Y among [{}]", channels.join(", "))
            }
        }
    }
}

impl std::error::Error for ImageError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &self.cause {
            ImageErrorCause::Io(error) => Some(error),
            _ => None,
        }
    }
}

impl From<io::Error> for ImageErrorCause {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::NotFound => ImageErrorCause::NotFound,
            io::ErrorKind::IsADirectory => ImageErrorCause::IsDirectory,
            io::ErrorKind::UnexpectedEof => ImageErrorCause::Truncated("bytes are missing".to_owned()),
            _ => ImageErrorCause::Io(error),
        }
    }
}

impl From<exr::error::Error> for ImageErrorCause {
    fn from(error: exr::error::Error) -> Self {
        use exr::error::Error;
        match error {
            Error::Aborted => ImageErrorCause::Malformed("reading was aborted".to_owned()),
            Error::NotSupported(what) => ImageErrorCause::Unsupported(what.into_owned()),
            // The crate reports the end of a file as this message.
            Error::Invalid(what) if what == "reference to missing bytes" => {
                ImageErrorCause::Truncated(what.into_owned())
            }
            Error::Invalid(what) => ImageErrorCause::Malformed(what.into_owned()),
            Error::Io(error) => error.into(),
        }
    }
}

impl From<image::ImageError> for ImageErrorCause {
    fn from(error: image::ImageError) -> Self {
        use image::ImageError as Error;
        match error {
            Error::IoError(error) => error.into(),
            Error::Unsupported(error) => ImageErrorCause::Unsupported(error.to_string()),
            Error::Limits(error) => ImageErrorCause::Unsupported(error.to_string()),
            error if ends_early(&error) => ImageErrorCause::Truncated(error.to_string()),
            error => ImageErrorCause::Malformed(error.to_string()),
        }
    }
}

/// Whether a missing end is behind a decoder's error.
fn ends_early(error: &(dyn std::error::Error + 'static)) -> bool {
    let mut next = Some(error);
    while let Some(error) = next {
        if let Some(error) = error.downcast_ref::<io::Error>()
            && error.kind() == io::ErrorKind::UnexpectedEof
        {
            return true;
        }
        next = error.source();
    }
    false
}
