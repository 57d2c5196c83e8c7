//! Prescriptions of lenses as text, as pbrt has them: for each surface, from the front to the rear, its radius of curvature,
//! the distance to the next surface, the index of refraction between these, and the diameter of what is clear; lengths in
//! millimetres. A radius of 0 is the aperture stop. After `#` comes a comment.

use std::fmt;

use etendue_scene::camera::{LensFault, LensPrescription, LensSurface};

/// Numbers of a surface.
const N_NUMBERS: usize = 4;
/// Most numbers that are read.
const MOST_NUMBERS: usize = 10_000;

/// Why a text is not a lens.
#[derive(Clone, Debug, PartialEq)]
pub enum LensError {
    /// The word on that line, from 1, is no number.
    Word(usize, String),
    /// The file ends amid the numbers of the surface that begins on that line, from 1.
    Incomplete(usize),
    /// No lens has the surface on that line, from 1.
    Surface(usize, LensFault),
    /// No lens has these surfaces.
    Lens(LensFault),
}

impl fmt::Display for LensError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Word(line, word) => write!(f, "line {line}: \"{word}\" should be a number"),
            Self::Incomplete(line) => write!(
                f,
                "line {line}: a surface needs four numbers: radius, distance to the next, index, diameter"
            ),
            Self::Surface(line, fault) => write!(f, "line {line}: {fault}"),
            Self::Lens(fault) => fault.fmt(f),
        }
    }
}

impl std::error::Error for LensError {}

/// Reads a lens.
///
/// # Errors
/// If the text is no such table, or no lens has such surfaces. Bytes that are not UTF-8 may stand in comments only.
pub fn read_lens(bytes: &[u8]) -> Result<LensPrescription, LensError> {
    let text = String::from_utf8_lossy(bytes);
    let mut numbers: Vec<(usize, f32)> = Vec::new();
    for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        for word in line.split('#').next().unwrap_or_default().split_whitespace() {
            let number = word.parse().map_err(|_| LensError::Word(index + 1, excerpt(word)))?;
            numbers.push((index + 1, number));
        }
        if numbers.len() > MOST_NUMBERS {
            return Err(LensError::Lens(LensFault::Many));
        }
    }
    let (surfaces, rest) = numbers.as_chunks::<N_NUMBERS>();
    if let Some((line, _)) = rest.first() {
        return Err(LensError::Incomplete(*line));
    }
    let metres = |mm: f32| mm / 1000.0;
    let read = |&[radius, thickness, eta, diameter]: &[(usize, f32); N_NUMBERS]| LensSurface {
        radius_m: metres(radius.1),
        thickness_m: metres(thickness.1),
        eta: eta.1,
        diameter_m: metres(diameter.1),
    };
    LensPrescription::new(surfaces.iter().map(read).collect()).map_err(|fault| match fault.surface() {
        Some(index) => LensError::Surface(surfaces[index][0].0, fault),
        None => LensError::Lens(fault),
    })
}

fn excerpt(word: &str) -> String {
    word.chars().take(20).flat_map(char::escape_debug).collect()
}

#[cfg(test)]
mod tests;
