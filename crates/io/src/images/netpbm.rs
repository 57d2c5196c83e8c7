//! Portable pixmaps: P3 (decimal text) and P6 (bytes), and the header that PFM shares with them.
//!
//! A header is a signature and numbers divided by white space, with comments from `#` to the end of a line; one
//! white-space byte ends it. Values go from 0 to a stated maximum and are encoded as sRGB by convention.

use std::io::{self, BufRead, Read, Write};

use etendue_image::{TexelData, Texels};

use super::{ImageErrorCause, Opened, Outcome, check_size};

/// Longest word of a header; any number that makes sense is shorter.
const MAX_WORD: usize = 32;

/// Reads a P3 or P6 file as bytes, or as 16-bit integers where its maximum exceeds 255.
pub(super) fn read(file: &mut Opened) -> Outcome<Texels> {
    let file_bytes = file.n_bytes;
    let reader = &mut file.reader;
    let is_text = read_word(reader)? == "P3";
    let (width, height, max) = (read_size(reader)?, read_size(reader)?, read_size(reader)?);
    if max == 0 || max > 65535 {
        return Err(ImageErrorCause::Malformed(format!("a maximum of {max} instead of 1 to 65535")));
    }
    check_size(file_bytes, [width, height], 3)?;
    let n_values = 3 * (width * height) as usize;
    let bytes_per_value = if is_text || max < 256 { 1 } else { 2 };
    let missing = format!("{width} x {height} pixels do not fit into {file_bytes} bytes");
    if (n_values * bytes_per_value) as u64 > file_bytes {
        return Err(ImageErrorCause::Truncated(missing));
    }
    let values = if is_text { read_text(reader, n_values)? } else { read_bytes(reader, n_values, max)? };
    if values.iter().any(|&value| u64::from(value) > max) {
        return Err(ImageErrorCause::Malformed(format!("a value above the stated maximum of {max}")));
    }
    let data = if max == 255 {
        TexelData::U8(values.into_iter().map(|value| value as u8).collect())
    } else {
        let scaled = |value: u16| ((u64::from(value) * 65535 + max / 2) / max) as u16;
        TexelData::U16(values.into_iter().map(scaled).collect())
    };
    Ok(Texels::new(width as usize, height as usize, 3, data))
}

fn read_text(reader: &mut impl BufRead, n_values: usize) -> Outcome<Vec<u16>> {
    let value = |_| {
        let word = read_word(reader)?;
        word.parse().map_err(|_| ImageErrorCause::Malformed(format!("`{word}` is not a pixel value")))
    };
    (0..n_values).map(value).collect()
}

fn read_bytes(reader: &mut impl Read, n_values: usize, max: u64) -> Outcome<Vec<u16>> {
    let mut bytes = vec![0; if max < 256 { n_values } else { 2 * n_values }];
    reader.read_exact(&mut bytes)?;
    if max < 256 {
        return Ok(bytes.into_iter().map(u16::from).collect());
    }
    Ok(bytes.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]])).collect())
}

/// A width or another whole number of a header.
pub(super) fn read_size(reader: &mut impl BufRead) -> Outcome<u64> {
    let word = read_word(reader)?;
    word.parse().map_err(|_| ImageErrorCause::Malformed(format!("`{word}` is not a size")))
}

/// Next word of a header with the one white-space byte after it.
pub(super) fn read_word(reader: &mut impl BufRead) -> Outcome<String> {
    let mut word = String::new();
    while let Some(byte) = read_byte(reader)? {
        match byte {
            b'#' if word.is_empty() => skip_line(reader)?,
            byte if !byte.is_ascii_whitespace() => word.push(char::from(byte)),
            _ if word.is_empty() => {}
            _ => return Ok(word),
        }
        if word.len() > MAX_WORD {
            return Err(ImageErrorCause::Malformed(format!("the header has the word `{word}...`")));
        }
    }
    if word.is_empty() {
        return Err(ImageErrorCause::Truncated("the header is incomplete".to_owned()));
    }
    Ok(word)
}

fn read_byte(reader: &mut impl BufRead) -> io::Result<Option<u8>> {
    let byte = reader.fill_buf()?.first().copied();
    reader.consume(usize::from(byte.is_some()));
    Ok(byte)
}

fn skip_line(reader: &mut impl BufRead) -> io::Result<()> {
    while !matches!(read_byte(reader)?, None | Some(b'\n')) {}
    Ok(())
}

/// Writes a P6 file: header `P6\nwidth height\n255\n`, then three bytes per pixel.
pub(super) fn write_binary(
    out: &mut impl Write,
    [width, height]: [usize; 2],
    pixels: &[[u8; 3]],
) -> io::Result<()> {
    write!(out, "P6\n{width} {height}\n255\n")?;
    out.write_all(pixels.as_flattened())
}

/// Writes a P3 file: header `P3\nwidth height\n255\n`, then one pixel per line.
pub(super) fn write_text(
    out: &mut impl Write,
    [width, height]: [usize; 2],
    pixels: &[[u8; 3]],
) -> io::Result<()> {
    write!(out, "P3\n{width} {height}\n255\n")?;
    for [r, g, b] in pixels {
        writeln!(out, "{r} {g} {b}")?;
    }
    Ok(())
}
