//! Portable float maps: `PF` (colour) or `Pf` (gray), width, height, scale, then `f32` rows from the bottom up.
//!
//! A negative scale says little-endian; its size is a factor on the values. Written files are little-endian with
//! scale -1.

use std::io::{Read, Write};

use etendue_image::{Image, TexelData, Texels};

use super::netpbm::{read_size, read_word};
use super::{ImageErrorCause, Opened, Outcome, check_size};

/// Reads floats of one or three channels.
pub(super) fn read(file: &mut Opened) -> Outcome<Texels> {
    let file_bytes = file.n_bytes;
    let reader = &mut file.reader;
    let n_channels = if read_word(reader)? == "PF" { 3 } else { 1 };
    let (width, height) = (read_size(reader)?, read_size(reader)?);
    let word = read_word(reader)?;
    let scale = word.parse::<f32>().ok().filter(|scale| scale.is_finite() && *scale != 0.0);
    let scale = scale.ok_or_else(|| ImageErrorCause::Malformed(format!("`{word}` is not a scale")))?;
    check_size(file_bytes, [width, height], 4 * n_channels)?;
    let n_bytes = 4 * n_channels * width * height;
    if n_bytes > file_bytes {
        let missing = format!("{width} x {height} pixels do not fit into {file_bytes} bytes");
        return Err(ImageErrorCause::Truncated(missing));
    }
    let row_bytes = (4 * n_channels * width) as usize;
    let mut bytes = vec![0; n_bytes as usize];
    reader.read_exact(&mut bytes)?;
    let decode = if scale < 0.0 { f32::from_le_bytes } else { f32::from_be_bytes };
    let value = |word: &[u8]| decode([word[0], word[1], word[2], word[3]]) * scale.abs();
    let rows = bytes.chunks_exact(row_bytes).rev();
    let values = rows.flat_map(|row| row.chunks_exact(4).map(value)).collect();
    Ok(Texels::new(width as usize, height as usize, n_channels as usize, TexelData::F32(values)))
}

/// Writes the channels `R G B`, or `Y` if the picture is gray.
pub(super) fn write(out: &mut impl Write, image: &Image) -> Outcome<()> {
    let planes: Vec<&[f32]> = match ["R", "G", "B"].map(|name| image.channel(name)) {
        [Some(r), Some(g), Some(b)] => vec![&r.values, &g.values, &b.values],
        _ => image
            .channel("Y")
            .map(|y| vec![y.values.as_slice()])
            .ok_or_else(|| super::write::no_color(image))?,
    };
    let signature = if planes.len() == 3 { "PF" } else { "Pf" };
    write!(out, "{signature}\n{} {}\n-1.0\n", image.width, image.height)?;
    for y in (0..image.height).rev() {
        for index in y * image.width..(y + 1) * image.width {
            for plane in &planes {
                out.write_all(&plane[index].to_le_bytes())?;
            }
        }
    }
    Ok(())
}
