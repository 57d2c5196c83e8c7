//! Photometric files of luminaires: IES LM-63 of 1986, 1991, 1995, 2002 and 2019, which differ in their headers alone.
//!
//! After the header, which says nothing that the light needs, a line `TILT=` begins the numbers, separated by blanks, ends
//! of lines or commas. Intensities are multiplied by the file's multiplier, its ballast factor and, where there is one,
//! the ballast-lamp photometric factor. `TILT=INCLUDE` is read, and its factors are passed over, since they belong to
//! luminaires that are mounted at an angle; a file of its own for them is refused.

use std::fmt;

use etendue_scene::light::{PhotometricWeb, Photometry};

#[cfg(test)]
mod tests;

/// Why a text is no photometric file.
#[derive(Clone, Debug, PartialEq)]
pub struct IesError {
    /// The line, from 1.
    pub line: usize,
    /// What is wrong there.
    pub reason: String,
}

impl fmt::Display for IesError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.reason)
    }
}

impl std::error::Error for IesError {}

/// The table of intensities in candela.
///
/// # Errors
/// If the text is no such file. Bytes that are not UTF-8 may stand in the header only.
pub fn read_ies(bytes: &[u8]) -> Result<Photometry, IesError> {
    let text = String::from_utf8_lossy(bytes);
    let (tilt, tilt_line, numbers) = find_tilt(&text)?;
    let mut numbers = Numbers { words: numbers, line: tilt_line + 1 };
    match tilt.trim().trim_matches('"').to_ascii_uppercase().as_str() {
        "NONE" => {}
        "INCLUDE" => skip_tilt(&mut numbers)?,
        _ => {
            let reason =
                format!("the tilt file \"{}\" is not read; write TILT=NONE or TILT=INCLUDE", tilt.trim());
            return Err(IesError { line: tilt_line, reason });
        }
    }
    read_table(&mut numbers)
}

/// What the line `TILT=` says, its number, and what follows it.
fn find_tilt(text: &str) -> Result<(&str, usize, &str), IesError> {
    let (mut rest, mut line) = (text, 0);
    while !rest.is_empty() {
        line += 1;
        let (this, after) = rest.split_once('\n').unwrap_or((rest, ""));
        let this = this.trim();
        if this.get(..5).is_some_and(|start| start.eq_ignore_ascii_case("TILT=")) {
            return Ok((&this[5..], line, after));
        }
        rest = after;
    }
    Err(IesError {
        line: line.max(1),
        reason: "the file ends without a line that begins with TILT=".to_owned(),
    })
}

/// The numbers of a text, with the line that each stands on.
struct Numbers<'a> {
    words: &'a str,
    /// Of the last word, from 1.
    line: usize,
}

impl Numbers<'_> {
    fn fail<T>(&self, reason: impl Into<String>) -> Result<T, IesError> {
        Err(IesError { line: self.line, reason: reason.into() })
    }

    /// The next number, or an error that says what is missing.
    fn next(&mut self, what: &str) -> Result<f64, IesError> {
        let is_gap = |c: char| c.is_whitespace() || c == ',' || c == '\u{1a}';
        let begin = self.words.find(|c| !is_gap(c)).unwrap_or(self.words.len());
        self.line += self.words[..begin].matches('\n').count();
        self.words = &self.words[begin..];
        if self.words.is_empty() {
            return self.fail(format!("the file ends before {what}"));
        }
        let end = self.words.find(is_gap).unwrap_or(self.words.len());
        let (word, rest) = self.words.split_at(end);
        self.words = rest;
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => self.fail(format!(
                "{what} should be a number, not \"{}\"",
                word.chars().take(20).collect::<String>()
            )),
        }
    }

    /// A number of things, at least 1 and no more than the rest of the text can hold.
    fn count(&mut self, what: &str) -> Result<usize, IesError> {
        let number = self.next(what)?;
        if number < 1.0 || number.fract() != 0.0 {
            return self.fail(format!("{what} should be a whole number from 1, not {number}"));
        }
        let room = self.words.len() / 2 + 1;
        if number > room as f64 {
            return self.fail(format!("{what} is {number}, more than the file holds"));
        }
        Ok(number as usize)
    }

    fn many(&mut self, n: usize, what: &str) -> Result<Vec<f64>, IesError> {
        (0..n).map(|_| self.next(what)).collect()
    }

    /// Ascending angles.
    fn angles(&mut self, n: usize, what: &str) -> Result<Vec<f32>, IesError> {
        let mut angles: Vec<f32> = Vec::new();
        for _ in 0..n {
            let angle = self.next(what)? as f32;
            if let Some(last) = angles.last().filter(|last| **last >= angle) {
                return self.fail(format!("{what} {angle} is not above the one before, {last}"));
            }
            angles.push(angle);
        }
        Ok(angles)
    }
}

/// Lamp geometry, and pairs of angles and factors.
fn skip_tilt(numbers: &mut Numbers) -> Result<(), IesError> {
    numbers.next("the lamp-to-luminaire geometry")?;
    let n = numbers.count("the number of tilt angles")?;
    numbers.many(n, "a tilt angle")?;
    numbers.many(n, "a tilt factor").map(|_| ())
}

fn read_table(numbers: &mut Numbers) -> Result<Photometry, IesError> {
    numbers.next("the number of lamps")?;
    numbers.next("the lumens of a lamp")?;
    let multiplier = numbers.next("the multiplier of candela")?;
    let n_vertical = numbers.count("the number of vertical angles")?;
    let n_horizontal = numbers.count("the number of horizontal angles")?;
    let room = numbers.words.len() / 2 + 1;
    if n_vertical.saturating_mul(n_horizontal) > room {
        return numbers.fail(format!(
            "{n_vertical} vertical and {n_horizontal} horizontal angles need more candela values than the file holds"
        ));
    }
    let web = match numbers.next("the photometric type")? {
        1.0 => PhotometricWeb::C,
        2.0 => PhotometricWeb::B,
        3.0 => PhotometricWeb::A,
        other => {
            return numbers
                .fail(format!("the photometric type should be 1 (C), 2 (B) or 3 (A), not {other}"));
        }
    };
    let units = numbers.next("the type of units")?;
    if units != 1.0 && units != 2.0 {
        return numbers.fail(format!("the type of units should be 1 (feet) or 2 (metres), not {units}"));
    }
    numbers.many(3, "a size of the luminous opening")?;
    let ballast = numbers.next("the ballast factor")?;
    let photometric = numbers.next("the ballast-lamp photometric factor")?;
    numbers.next("the input watts")?;
    let factor = multiplier * ballast * photometric;
    if factor < 0.0 {
        return numbers.fail(format!("multiplier and ballast factors give {factor}, which is negative"));
    }
    let vertical = numbers.angles(n_vertical, "a vertical angle")?;
    let horizontal = numbers.angles(n_horizontal, "a horizontal angle")?;
    let angles_end = numbers.line;
    let mut candela = Vec::new();
    for _ in 0..n_vertical * n_horizontal {
        let value = numbers.next("a candela value")? * factor;
        if !(0.0..=f64::from(f32::MAX)).contains(&value) {
            return numbers.fail(format!("a candela value should be at least 0 and in range, not {value:e}"));
        }
        candela.push(value as f32);
    }
    Photometry::new(web, vertical, horizontal, candela)
        .map_err(|reason| IesError { line: angles_end, reason: reason.to_owned() })
}
