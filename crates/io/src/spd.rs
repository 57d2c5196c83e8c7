//! Measured spectra as text: on each line a wavelength in nanometres and a value, after `#` a comment.

use std::fmt;

/// Why a text is not a spectrum.
#[derive(Clone, Debug, PartialEq)]
pub enum SpdError {
    /// The line, from 1, is not made of two finite numbers.
    Line(usize),
    /// The wavelength on that line, from 1, is not above the one before.
    Order(usize),
    /// There are no numbers.
    Empty,
}

impl fmt::Display for SpdError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line} should be a wavelength and a value"),
            Self::Order(line) => write!(f, "the wavelength on line {line} is not above the one before"),
            Self::Empty => write!(f, "the file has no samples"),
        }
    }
}

impl std::error::Error for SpdError {}

/// Wavelengths in nanometres, ascending, with their values.
///
/// # Errors
/// If the text is no such table. Bytes that are not UTF-8 may stand in comments only.
pub fn read_spd(bytes: &[u8]) -> Result<Vec<[f32; 2]>, SpdError> {
    let text = String::from_utf8_lossy(bytes);
    let mut samples: Vec<[f32; 2]> = Vec::new();
    for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let content = line.split('#').next().unwrap_or_default();
        let mut numbers = [0.0; 2];
        let mut n = 0;
        for word in content.split([' ', '\t', ',', ';']).filter(|word| !word.trim().is_empty()) {
            let number = word.trim().parse::<f32>().ok().filter(|number| number.is_finite());
            let slot = numbers.get_mut(n).ok_or(SpdError::Line(index + 1))?;
            *slot = number.ok_or(SpdError::Line(index + 1))?;
            n += 1;
        }
        match n {
            0 => continue,
            1 => return Err(SpdError::Line(index + 1)),
            _ => {}
        }
        if samples.last().is_some_and(|last| last[0] >= numbers[0]) {
            return Err(SpdError::Order(index + 1));
        }
        samples.push(numbers);
    }
    if samples.is_empty() { Err(SpdError::Empty) } else { Ok(samples) }
}

#[cfg(test)]
mod tests;
