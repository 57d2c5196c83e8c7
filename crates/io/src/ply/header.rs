//! The header of a PLY file: encoding, elements and their properties.

use super::PlyError;

/// How the data is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn of_name(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes in binary files.
    pub(super) const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    const fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

/// One number or a list of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PropertyKind {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

/// A property of an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: PropertyKind,
}

/// A table of the file, for example that of the vertices.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Element {
    pub(super) name: String,
    /// Rows that the header declares.
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// Column of the property of that name that is a single number.
    pub(super) fn scalar(&self, name: &str) -> Option<usize> {
        self.properties.iter().position(|p| p.name == name && matches!(p.kind, PropertyKind::Scalar(_)))
    }
}

/// All that stands before the data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// First byte of the data.
    pub(super) data_start: usize,
}

impl Header {
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, PlyError> {
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        let mut start = 0;
        for line_number in 1.. {
            let fail = |why: String| Err(PlyError::Header(line_number, why));
            let Some(length) = bytes[start..].iter().position(|b| *b == b'\n') else {
                return fail(
                    if line_number == 1 {
                        "the file does not begin with `ply`"
                    } else {
                        "there is no `end_header`"
                    }
                    .into(),
                );
            };
            let line = String::from_utf8_lossy(&bytes[start..start + length]);
            start += length + 1;
            let words: Vec<&str> = line.split_ascii_whitespace().collect();
            match words.as_slice() {
                ["ply"] if line_number == 1 => {}
                _ if line_number == 1 => return fail("the file does not begin with `ply`".into()),
                [] | ["comment" | "obj_info", ..] => {}
                ["format", name, _version] => match encoding_of_name(name) {
                    Some(found) => encoding = Some(found),
                    None => return fail(format!("there is no format `{name}`")),
                },
                ["element", name, count] => match count.parse() {
                    Ok(count) => {
                        elements.push(Element { name: (*name).to_owned(), count, properties: Vec::new() });
                    }
                    Err(_) => return fail(format!("`{count}` is no number of elements")),
                },
                ["property", words @ ..] => match (property(words), elements.last_mut()) {
                    (Ok(property), Some(element)) => element.properties.push(property),
                    (Ok(_), None) => return fail("a property stands before all elements".into()),
                    (Err(why), _) => return fail(why),
                },
                ["end_header"] => {
                    let Some(encoding) = encoding else { return Err(PlyError::Missing("line `format`")) };
                    return Ok(Self { encoding, elements, data_start: start });
                }
                [word, ..] => return fail(format!("`{word}` is not part of the format")),
            }
        }
        unreachable!("the header ends or the bytes do");
    }
}

fn encoding_of_name(name: &str) -> Option<Encoding> {
    Some(match name {
        "ascii" => Encoding::Ascii,
        "binary_little_endian" => Encoding::LittleEndian,
        "binary_big_endian" => Encoding::BigEndian,
        _ => return None,
    })
}

fn property(words: &[&str]) -> Result<Property, String> {
    let scalar = |name: &str| Scalar::of_name(name).ok_or_else(|| format!("there is no type `{name}`"));
    match words {
        ["list", count, item, name] => {
            let (count, item) = (scalar(count)?, scalar(item)?);
            if !count.is_integer() {
                return Err(format!("the length of the list `{name}` must be an integer"));
            }
            Ok(Property { name: (*name).to_owned(), kind: PropertyKind::List { count, item } })
        }
        [kind, name] => Ok(Property { name: (*name).to_owned(), kind: PropertyKind::Scalar(scalar(kind)?) }),
        _ => Err("a property has a type and a name".to_owned()),
    }
}
