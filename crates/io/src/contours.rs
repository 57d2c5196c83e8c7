//! Contours of surfaces of revolution as CSV: a line `interface,height,radius`, then such lines, in the order in which the
//! contour of each interface runs; after `#` a comment.

use std::fmt;

use etendue_math::Point2;
use etendue_scene::assets::Contours;

/// Why a text is not such a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ContoursError {
    /// The first line is not `interface,height,radius`.
    Header,
    /// The line, from 1, is not a name and two finite numbers.
    Line(usize),
    /// There are no points.
    Empty,
}

impl fmt::Display for ContoursError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Header => write!(f, "the first line should be `interface,height,radius`"),
            Self::Line(line) => {
                write!(f, "line {line} should be a name, a height and a radius, with commas between")
            }
            Self::Empty => write!(f, "the file has no points"),
        }
    }
}

impl std::error::Error for ContoursError {}

/// The contours of all interfaces, in the order in which these first appear.
///
/// # Errors
/// If the text is no such table.
pub fn read_contours(bytes: &[u8]) -> Result<Contours, ContoursError> {
    let text = String::from_utf8_lossy(bytes);
    let fields = |line: &str| -> Vec<String> {
        let content = line.split('#').next().unwrap_or_default().trim();
        let is_empty = content.is_empty();
        content.split(',').filter(|_| !is_empty).map(|field| field.trim().to_owned()).collect()
    };
    let mut lines = (1..).zip(text.trim_start_matches('\u{feff}').lines()).map(|(i, line)| (i, fields(line)));
    let mut lines = lines.by_ref().filter(|(_, fields)| !fields.is_empty());
    if lines.next().is_none_or(|(_, fields)| fields != ["interface", "height", "radius"]) {
        return Err(ContoursError::Header);
    }
    let mut contours: Vec<(String, Vec<Point2>)> = Vec::new();
    for (line, fields) in lines {
        let number = |i: usize| fields.get(i)?.parse::<f32>().ok().filter(|x| x.is_finite());
        let (Some(height), Some(radius), 3, false) =
            (number(1), number(2), fields.len(), fields[0].is_empty())
        else {
            return Err(ContoursError::Line(line));
        };
        let point = Point2::new(height, radius);
        // Lines of an interface mostly stand together: the last one is looked at first.
        match contours.iter().rposition(|(name, _)| *name == fields[0]) {
            Some(index) => contours[index].1.push(point),
            None if contours.len() < MAX_INTERFACES => contours.push((fields[0].clone(), vec![point])),
            None => return Err(ContoursError::Line(line)),
        }
    }
    if contours.is_empty() { Err(ContoursError::Empty) } else { Ok(Contours(contours)) }
}

/// More interfaces in a file are refused: they are looked up one by one.
const MAX_INTERFACES: usize = 1000;

#[cfg(test)]
mod tests {
    use super::*;

    /// Interfaces are told apart by name; comments and spaces do not matter.
    #[test]
    fn contours_are_read_in_order() {
        let text = "interface,height,radius\n# a comment\na-b, 1,0\nb-c,3,4 # here\n\na-b,2.5,1e1\n";
        let Contours(contours) = read_contours(text.as_bytes()).expect("a table");
        let a = vec![Point2::new(1.0, 0.0), Point2::new(2.5, 10.0)];
        assert_eq!(contours, [("a-b".to_owned(), a), ("b-c".to_owned(), vec![Point2::new(3.0, 4.0)])]);
    }

    /// Errors name the line.
    #[test]
    fn other_texts_are_refused() {
        let error = |text: &[u8]| read_contours(text).expect_err("no table");
        assert_eq!(error(b""), ContoursError::Header);
        assert_eq!(error(b"a,1,2\n"), ContoursError::Header);
        assert_eq!(error(b"interface,height,radius\n"), ContoursError::Empty);
        for line in ["a,1", "a,1,2,3", "a,x,2", "a,1,inf", ",1,2", "a,1,nan", "\u{1},,"] {
            let text = format!("interface,height,radius\na,0,1\n{line}\n");
            assert_eq!(error(text.as_bytes()), ContoursError::Line(3), "{line}");
        }
        assert_eq!(error(&[0xff; 100]), ContoursError::Header);
    }
}
