//! Tables of BRDFs as text: `brdf 1`, the numbers of nodes over theta_h, theta_d and phi_d, then red, green and blue
//! for each node, the last angle changing quickest. A line holds the three numbers of one node; after `#` comes a
//! comment.

use std::fmt;

use etendue_scene::bsdf::tabulated::BrdfGrid;

/// Most nodes that a table may have.
const MAX_NODES: usize = 1 << 24;

/// Why a text is not such a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BrdfTableError {
    /// The first line is not `brdf 1`.
    Format,
    /// The line, from 1, should give the numbers of nodes: at least 2, 2 and 1, together at most 2²⁴.
    Resolution(usize),
    /// The line, from 1, should be three finite numbers that are not negative.
    Line(usize),
    /// There is a value too many on that line, from 1.
    TooMany(usize),
    /// The text ends after so many of so many values.
    TooFew(usize, usize),
}

impl fmt::Display for BrdfTableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Format => write!(f, "a table begins with a line `brdf 1`"),
            Self::Resolution(line) => write!(
                f,
                "line {line} should be the numbers of nodes over theta_h, theta_d and phi_d: at least 2, 2 and 1, \
                 together at most {MAX_NODES}"
            ),
            Self::Line(line) => {
                write!(f, "line {line} should be red, green and blue, finite and not negative")
            }
            Self::TooMany(line) => write!(f, "line {line} is one more than there are nodes"),
            Self::TooFew(found, wanted) => write!(f, "the file ends after {found} of {wanted} nodes"),
        }
    }
}

impl std::error::Error for BrdfTableError {}

/// A BRDF on a grid of angles.
///
/// # Errors
/// If the text is no such table. Bytes that are not UTF-8 may stand in comments only.
pub fn read_brdf_table(bytes: &[u8]) -> Result<BrdfGrid, BrdfTableError> {
    use BrdfTableError::{Format, Line, Resolution, TooFew, TooMany};
    let text = String::from_utf8_lossy(bytes);
    let mut lines = text
        .trim_start_matches('\u{feff}')
        .lines()
        .enumerate()
        .map(|(index, line)| (index + 1, words(line)))
        .filter(|(_, words)| !words.is_empty());
    if lines.next().is_none_or(|(_, words)| words != ["brdf", "1"]) {
        return Err(Format);
    }
    let (line, words) = lines.next().ok_or(TooFew(0, 0))?;
    let resolution = resolution(&words).ok_or(Resolution(line))?;
    let n_nodes = resolution.iter().product();
    let mut rgb = Vec::new();
    for (line, words) in lines {
        if rgb.len() == n_nodes {
            return Err(TooMany(line));
        }
        rgb.push(color(&words).ok_or(Line(line))?);
    }
    let n_found = rgb.len();
    BrdfGrid::new(resolution, rgb).ok_or(TooFew(n_found, n_nodes))
}

fn words(line: &str) -> Vec<&str> {
    let content = line.split('#').next().unwrap_or_default();
    content.split([' ', '\t', ',', ';']).map(str::trim).filter(|word| !word.is_empty()).collect()
}

fn resolution(words: &[&str]) -> Option<[usize; 3]> {
    let &[n, m, l] = words else { return None };
    let numbers = [n.parse::<usize>().ok()?, m.parse().ok()?, l.parse().ok()?];
    let n_nodes = numbers[0].checked_mul(numbers[1])?.checked_mul(numbers[2])?;
    (numbers[0] >= 2 && numbers[1] >= 2 && numbers[2] >= 1 && n_nodes <= MAX_NODES).then_some(numbers)
}

fn color(words: &[&str]) -> Option<[f32; 3]> {
    let &[r, g, b] = words else { return None };
    let number = |word: &str| word.parse::<f32>().ok().filter(|number| number.is_finite() && *number >= 0.0);
    Some([number(r)?, number(g)?, number(b)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(text: &str, expected: BrdfTableError) {
        assert_eq!(read_brdf_table(text.as_bytes()), Err(expected));
    }

    /// Values are read in order, whatever parts them.
    #[test]
    fn tables_are_read() {
        let text = "# paint\nbrdf 1\n2, 2, 1 # nodes\n1 2 3\n4;5;6\n\n7\t8 9\r\n0 0.5 1e2\n";
        let values = vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0], [0.0, 0.5, 100.0]];
        assert_eq!(read_brdf_table(text.as_bytes()), Ok(BrdfGrid::new([2, 2, 1], values).unwrap()));
    }

    /// Whatever is wrong is told with its line.
    #[test]
    fn damage_is_located() {
        use BrdfTableError::*;
        check("", Format);
        check("brdf 2\n", Format);
        check("brdf 1\n", TooFew(0, 0));
        check("brdf 1\n2 2\n", Resolution(2));
        check("brdf 1\n1 2 1\n", Resolution(2));
        check("brdf 1\n99999999999 99999999999 9\n", Resolution(2));
        check("brdf 1\n4096 4096 2\n", Resolution(2));
        check("brdf 1\n2 2 1\n1 1 1\n", TooFew(1, 4));
        check("brdf 1\n2 2 1\n1 1 1\n1 1\n", Line(4));
        check("brdf 1\n2 2 1\n1 -1 1\n", Line(3));
        check("brdf 1\n2 2 1\n1 nan 1\n", Line(3));
        check("brdf 1\n2 2 1\n1 inf 1\n", Line(3));
        check("brdf 1\n2 2 1\n1 1 1\n1 1 1\n1 1 1\n1 1 1\n1 1 1\n", TooMany(7));
    }
}
