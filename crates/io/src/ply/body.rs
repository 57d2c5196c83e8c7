//! The data of a PLY file, row by row.

use super::PlyError;
use super::header::{Element, Encoding, PropertyKind, Scalar};

/// What is left of the data.
#[derive(Debug)]
pub(super) struct Body<'a> {
    rest: &'a [u8],
    encoding: Encoding,
}

/// Why a number could not be read.
enum Fault {
    End,
    Word(String),
}

impl Fault {
    fn at(self, element: &Element, index: u64) -> PlyError {
        match self {
            Self::End => PlyError::Truncated(element.name.clone(), index, element.count),
            Self::Word(word) => PlyError::NotANumber(element.name.clone(), index, word),
        }
    }
}

impl<'a> Body<'a> {
    pub(super) const fn new(rest: &'a [u8], encoding: Encoding) -> Self {
        Self { rest, encoding }
    }

    /// Fails if the rest of the file cannot hold the element even if all its lists are empty.
    pub(super) fn check_size(&self, element: &Element) -> Result<(), PlyError> {
        let smallest: usize = match self.encoding {
            // A digit and a blank each.
            Encoding::Ascii => 2 * element.properties.len(),
            _ => {
                let sizes = element.properties.iter().map(|property| match property.kind {
                    PropertyKind::Scalar(scalar) => scalar.size(),
                    PropertyKind::List { count, .. } => count.size(),
                });
                sizes.sum()
            }
        };
        if smallest == 0 {
            return Ok(());
        }
        // The last number of an ASCII file needs no blank.
        let available =
            (self.rest.len() as u64 + u64::from(self.encoding == Encoding::Ascii)) / smallest as u64;
        if element.count > available {
            return Err(PlyError::Truncated(element.name.clone(), available, element.count));
        }
        Ok(())
    }

    /// Skips all rows of an element.
    pub(super) fn skip(&mut self, element: &Element) -> Result<(), PlyError> {
        if element.properties.is_empty() {
            return Ok(());
        }
        let mut row = vec![0.0; element.properties.len()];
        for index in 0..element.count {
            self.scalars(element, index, &mut row)?;
        }
        Ok(())
    }

    /// Reads a row; lists are skipped.
    pub(super) fn scalars(&mut self, element: &Element, index: u64, row: &mut [f64]) -> Result<(), PlyError> {
        self.list_and_scalars(element, index, usize::MAX, &mut Vec::new(), row)
    }

    /// Reads a row: the list in column `list` into `items`, single numbers into `row`; other lists are skipped.
    pub(super) fn list_and_scalars(
        &mut self,
        element: &Element,
        index: u64,
        list: usize,
        items: &mut Vec<i64>,
        row: &mut [f64],
    ) -> Result<(), PlyError> {
        for (column, property) in element.properties.iter().enumerate() {
            let read = match property.kind {
                PropertyKind::Scalar(scalar) => self.number(scalar).map(|value| row[column] = value),
                PropertyKind::List { count, item } if column == list => self.list(count, item, items),
                PropertyKind::List { count, item } => self.skip_list(count, item),
            };
            read.map_err(|fault| fault.at(element, index))?;
        }
        Ok(())
    }

    fn list(&mut self, count: Scalar, item: Scalar, items: &mut Vec<i64>) -> Result<(), Fault> {
        items.clear();
        let n = self.length(count, item)?;
        items.reserve(n);
        for _ in 0..n {
            items.push(self.number(item)? as i64);
        }
        Ok(())
    }

    fn skip_list(&mut self, count: Scalar, item: Scalar) -> Result<(), Fault> {
        for _ in 0..self.length(count, item)? {
            self.number(item)?;
        }
        Ok(())
    }

    /// The length of a list, for which there are bytes enough.
    fn length(&mut self, count: Scalar, item: Scalar) -> Result<usize, Fault> {
        let n = self.number(count)?;
        let item_size = if self.encoding == Encoding::Ascii { 1 } else { item.size() };
        if n * item_size as f64 > self.rest.len() as f64 {
            return Err(Fault::End);
        }
        Ok(n.max(0.0) as usize)
    }

    #[inline]
    fn number(&mut self, scalar: Scalar) -> Result<f64, Fault> {
        if self.encoding == Encoding::Ascii {
            return self.word();
        }
        Ok(match scalar {
            Scalar::I8 => f64::from(i8::from_le_bytes(self.bytes()?)),
            Scalar::U8 => f64::from(u8::from_le_bytes(self.bytes()?)),
            Scalar::I16 => f64::from(i16::from_le_bytes(self.bytes()?)),
            Scalar::U16 => f64::from(u16::from_le_bytes(self.bytes()?)),
            Scalar::I32 => f64::from(i32::from_le_bytes(self.bytes()?)),
            Scalar::U32 => f64::from(u32::from_le_bytes(self.bytes()?)),
            Scalar::F32 => f64::from(f32::from_le_bytes(self.bytes()?)),
            Scalar::F64 => f64::from_le_bytes(self.bytes()?),
        })
    }

    /// The bytes of the next number, the least significant first.
    #[inline]
    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], Fault> {
        let (number, rest) = self.rest.split_first_chunk::<N>().ok_or(Fault::End)?;
        self.rest = rest;
        let mut bytes = *number;
        if self.encoding == Encoding::BigEndian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    fn word(&mut self) -> Result<f64, Fault> {
        let start = self.rest.iter().position(|b| !b.is_ascii_whitespace()).ok_or(Fault::End)?;
        let rest = &self.rest[start..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        let (word, rest) = rest.split_at(end);
        self.rest = rest;
        let parsed = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        parsed.ok_or_else(|| Fault::Word(String::from_utf8_lossy(&word[..word.len().min(40)]).into_owned()))
    }
}
