//! Pictures on disk: reading into texels or planes, and writing whole files or none.
//!
//! | format | read | written | numbers |
//! |---|---|---|---|
//! | OpenEXR | all layers and channels, all compressions of the `exr` crate | every channel, ZIP, rows or tiles | half, float, integer |
//! | PFM | both byte orders, gray and colour | `R G B` or `Y` | float |
//! | Radiance HDR | yes | `R G B` | shared exponent |
//! | PNG | 8 and 16 bit | 8 bit sRGB and Display P3, 16 bit PQ | encoded integers |
//! | PPM | P3 and P6, 8 and 16 bit | P6, or P3 by its own function | encoded integers |
//! | JPEG, TGA, QOI | yes | no | encoded integers |
//!
//! The format is told by the first bytes of the file; only TGA, which has no signature, is told by its extension.
//! Nothing in a file is trusted: sizes are checked against limits and against the length of the file before memory
//! is taken, and a failure inside a decoder, even a panic, becomes an [`ImageError`] with the file's name.

mod atomic;
mod display_png;
mod error;
mod exif;
mod netpbm;
mod openexr;
mod pfm;
mod raster;
mod write;

use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Read, Seek, SeekFrom};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;

use etendue_image::{Encoding, Image, Texels};
use image::ImageFormat;

pub use atomic::{check_writable, write_atomically};
pub use display_png::DisplayPng;
pub use error::{ImageError, ImageErrorCause};
pub use exif::exposure_of_photograph;
pub use openexr::{ExrBlocks, ExrChannel, ExrInfo, ExrNumbers, ExrPart, ExrSettings};
pub use write::{
    png_bytes, write_display_png, write_exr, write_image, write_png, write_ppm, write_ppm_ascii,
};

/// Most pixels of a picture that is read.
const MAX_PIXELS: u64 = 1 << 31;
/// Most bytes of a picture's uncompressed pixels.
const MAX_BYTES: u64 = 16 << 30;
/// Most bytes of pixels that one byte of a file may claim to stand for. No format here packs better: DEFLATE ends at
/// 1032. Claims below [`UNSUSPICIOUS_BYTES`] are not checked.
const MAX_COMPRESSION: u64 = 4096;
const UNSUSPICIOUS_BYTES: u64 = 64 << 20;

/// Reads a picture to look up: channels interleaved, numbers in the width of the file, top row first.
///
/// From an OpenEXR file the channels `R G B` (and `A`), else `Y`, else the only channel are taken.
///
/// # Errors
/// When the file cannot be read, is of no known format, or its contents contradict themselves.
pub fn read_texels(path: impl AsRef<Path>) -> Result<Texels, ImageError> {
    let path = path.as_ref();
    with_path(path, || texels_of(Opened::new(path)?))
}

/// The same from the bytes of a file; `name` stands for it in errors.
///
/// # Errors
/// When the bytes are of no known format, or contradict themselves.
pub fn read_texels_from(name: &str, bytes: Arc<[u8]>) -> Result<Texels, ImageError> {
    let path = Path::new(name);
    with_path(path, || {
        let n_bytes = bytes.len() as u64;
        texels_of(Opened::of(Box::new(Cursor::new(bytes)), n_bytes, &extension(path))?)
    })
}

fn texels_of(mut file: Opened) -> Outcome<Texels> {
    guarded(|| match file.format {
        Format::OpenExr => openexr::read_texels(&mut file),
        Format::Pfm => pfm::read(&mut file),
        Format::Netpbm => netpbm::read(&mut file),
        Format::Raster(format) => raster::read(&mut file, format),
    })
}

/// Reads a picture as planes of linear `f32`, top row first; encoded integers are taken to be sRGB, but for PNG that states
/// otherwise in code points (`cICP`).
///
/// From an OpenEXR file come all channels of all layers, named `layer.channel`, and its text and number attributes
/// as metadata.
///
/// # Errors
/// When the file cannot be read, is of no known format, or its contents contradict themselves.
pub fn read_image(path: impl AsRef<Path>) -> Result<Image, ImageError> {
    let path = path.as_ref();
    with_path(path, || {
        let mut file = Opened::new(path)?;
        guarded(|| match file.format {
            Format::OpenExr => openexr::read_image(&mut file),
            Format::Pfm => Ok(pfm::read(&mut file)?.to_image(Encoding::Linear)),
            Format::Netpbm => Ok(netpbm::read(&mut file)?.to_image(Encoding::Srgb)),
            Format::Raster(ImageFormat::Png) => display_png::read(&mut file),
            Format::Raster(format) => Ok(raster::read(&mut file, format)?.to_image(Encoding::Srgb)),
        })
    })
}

/// What the headers of an OpenEXR file say; `None` for other formats.
///
/// # Errors
/// When the file cannot be read, is of no known format, or its headers contradict themselves.
pub fn read_exr_info(path: impl AsRef<Path>) -> Result<Option<ExrInfo>, ImageError> {
    let path = path.as_ref();
    with_path(path, || {
        let mut file = Opened::new(path)?;
        guarded(|| match file.format {
            Format::OpenExr => openexr::read_info(&mut file).map(Some),
            _ => Ok(None),
        })
    })
}

/// Result of reading or writing the inside of a file whose name the caller adds.
type Outcome<T> = Result<T, ImageErrorCause>;

/// Names the file in an error.
fn with_path<T>(path: &Path, work: impl FnOnce() -> Outcome<T>) -> Result<T, ImageError> {
    work().map_err(|cause| ImageError { path: path.to_owned(), cause })
}

/// Decoders of other crates may panic on files made to break them; here that is one more malformed file.
fn guarded<T>(decode: impl FnOnce() -> Outcome<T>) -> Outcome<T> {
    catch_unwind(AssertUnwindSafe(decode))
        .unwrap_or_else(|_| Err(ImageErrorCause::Malformed("the decoder gave up on its contents".to_owned())))
}

/// What decides how a file is read.
#[derive(Copy, Clone, Debug, PartialEq)]
enum Format {
    OpenExr,
    Pfm,
    Netpbm,
    Raster(ImageFormat),
}

/// What decoders read from: a file, or bytes in memory.
trait Source: BufRead + Seek {}

impl<T: BufRead + Seek> Source for T {}

/// A file of known format and length, at its beginning.
struct Opened {
    reader: Box<dyn Source>,
    format: Format,
    n_bytes: u64,
}

impl Opened {
    fn new(path: &Path) -> Outcome<Opened> {
        let file = File::open(path)?;
        let metadata = file.metadata()?;
        if metadata.is_dir() {
            return Err(ImageErrorCause::IsDirectory);
        }
        Self::of(Box::new(BufReader::new(file)), metadata.len(), &extension(path))
    }

    fn of(mut reader: Box<dyn Source>, n_bytes: u64, extension: &str) -> Outcome<Opened> {
        let mut start = Vec::new();
        reader.by_ref().take(16).read_to_end(&mut start)?;
        reader.seek(SeekFrom::Start(0))?;
        if start.is_empty() {
            return Err(ImageErrorCause::Truncated("the file is empty".to_owned()));
        }
        let format = sniff(&start, extension)?;
        Ok(Opened { reader, format, n_bytes })
    }
}

/// Refuses a claimed width and height that is empty, beyond the limits, or more than a file of this length can hold.
fn check_size(file_bytes: u64, [width, height]: [u64; 2], bytes_per_pixel: u64) -> Outcome<()> {
    if width == 0 || height == 0 {
        return Err(ImageErrorCause::Empty);
    }
    let n_pixels = width.saturating_mul(height);
    let n_bytes = n_pixels.saturating_mul(bytes_per_pixel);
    if n_pixels > MAX_PIXELS || n_bytes > MAX_BYTES {
        return Err(ImageErrorCause::TooLarge { width, height });
    }
    if n_bytes > UNSUSPICIOUS_BYTES && n_bytes / MAX_COMPRESSION > file_bytes {
        let claim = format!("{width} x {height} pixels cannot be in a file of {file_bytes} bytes");
        return Err(ImageErrorCause::Malformed(claim));
    }
    Ok(())
}

/// Lower-case extension, empty if there is none.
fn extension(path: &Path) -> String {
    path.extension().map(|extension| extension.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// The format of a file that starts with these bytes.
fn sniff(start: &[u8], extension: &str) -> Outcome<Format> {
    match start {
        [0x76, 0x2f, 0x31, 0x01, ..] => return Ok(Format::OpenExr),
        [b'P', b'F' | b'f', space, ..] if space.is_ascii_whitespace() => return Ok(Format::Pfm),
        [b'P', b'3' | b'6', space, ..] if space.is_ascii_whitespace() => return Ok(Format::Netpbm),
        _ => {}
    }
    if let Ok(format) = image::guess_format(start)
        && raster::READABLE.contains(&format)
    {
        return Ok(Format::Raster(format));
    }
    match extension {
        "tga" => Ok(Format::Raster(ImageFormat::Tga)),
        "exr" | "pfm" | "ppm" | "png" | "jpg" | "jpeg" | "hdr" | "pic" | "qoi" => {
            Err(ImageErrorCause::WrongSignature { extension: extension.to_owned() })
        }
        _ => Err(ImageErrorCause::UnknownFormat { extension: extension.to_owned() }),
    }
}

#[cfg(test)]
mod tests;
