//! Tensor files: named arrays of numbers in one file, little-endian (the container of RGL's material database and of
//! Mitsuba 2).
//!
//! `tensor_file\0`, two bytes of version (1, 0), the number of fields in 32 bits, then for each field: 16 bits of length and the
//! name, 16 bits of number of dimensions, 8 bits of type, 64 bits of place of the data in the file, and the dimensions in 64
//! bits each, the last of which is contiguous.

use std::fmt;

const MAGIC: &[u8] = b"tensor_file\0";
const VERSION: [u8; 2] = [1, 0];
/// Most fields of a file and dimensions of a field.
const MAX_FIELDS: u32 = 1024;
const MAX_DIMENSIONS: u16 = 8;

/// Bytes of each type, by its number: none for 0, then unsigned and signed integers of 8 to 64 bits, and floating point of 16
/// to 64 bits.
const TYPE_BYTES: [usize; 12] = [0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8];
/// Numbers of the types that are read.
const UINT8: u8 = 1;
const FLOAT32: u8 = 10;

/// Why bytes are not such a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TensorError {
    /// They begin otherwise.
    Format,
    /// The version is another.
    Version(u8, u8),
    /// There are so many fields.
    TooManyFields(u32),
    /// The file ends within the description of the field of that number, from 1.
    Header(u32),
    /// There is no field of that name.
    Missing(&'static str),
    /// The field is not as it should be.
    Field(String, String),
}

impl fmt::Display for TensorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Format => write!(f, "a tensor file begins with `tensor_file`"),
            Self::Version(major, minor) => write!(f, "the version is {major}.{minor}, not 1.0"),
            Self::TooManyFields(n) => write!(f, "there are {n} fields, more than {MAX_FIELDS}"),
            Self::Header(n) => write!(f, "the file ends within the description of field {n}"),
            Self::Missing(name) => write!(f, "there is no field `{name}`"),
            Self::Field(name, why) => write!(f, "the field `{name}` {why}"),
        }
    }
}

impl std::error::Error for TensorError {}

/// An array of numbers in a file.
#[derive(Clone, Debug)]
pub struct Field<'a> {
    name: String,
    kind: u8,
    shape: Vec<usize>,
    data: &'a [u8],
}

/// The fields of a file. All lie within it.
#[derive(Clone, Debug)]
pub struct TensorFile<'a>(Vec<Field<'a>>);

impl<'a> TensorFile<'a> {
    /// The fields in the bytes of a file.
    ///
    /// # Errors
    /// If a description is damaged or a field lies beyond the end.
    pub fn read(bytes: &'a [u8]) -> Result<Self, TensorError> {
        let mut rest = bytes.strip_prefix(MAGIC).ok_or(TensorError::Format)?;
        let version: [u8; 2] = take(&mut rest).ok_or(TensorError::Format)?;
        if version != VERSION {
            return Err(TensorError::Version(version[0], version[1]));
        }
        let n = take(&mut rest).map(u32::from_le_bytes).ok_or(TensorError::Format)?;
        if n > MAX_FIELDS {
            return Err(TensorError::TooManyFields(n));
        }
        let field = |i| read_field(bytes, &mut rest).ok_or(TensorError::Header(i)).flatten();
        (1..=n).map(field).collect::<Result<_, _>>().map(Self)
    }

    /// The field of a name, which must have so many dimensions.
    ///
    /// # Errors
    /// If there is none, or it has others.
    pub fn field(&self, name: &'static str, n_dimensions: usize) -> Result<&Field<'a>, TensorError> {
        let field = self.0.iter().find(|field| field.name == name).ok_or(TensorError::Missing(name))?;
        if field.shape.len() == n_dimensions {
            return Ok(field);
        }
        Err(field.fault(format!("should have {n_dimensions} dimensions, not {}", field.shape.len())))
    }
}

impl Field<'_> {
    /// The dimensions, the last of which is contiguous.
    #[must_use]
    pub fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// An error of this field.
    #[must_use]
    pub fn fault(&self, why: impl Into<String>) -> TensorError {
        TensorError::Field(self.name.clone(), why.into())
    }

    /// Numbers in single precision.
    ///
    /// # Errors
    /// If they have another type.
    pub fn floats(&self) -> Result<Vec<f32>, TensorError> {
        if self.kind != FLOAT32 {
            return Err(self.fault("should have the type float32"));
        }
        let (numbers, _) = self.data.as_chunks();
        Ok(numbers.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect())
    }

    /// Bytes.
    ///
    /// # Errors
    /// If it has another type.
    pub fn bytes(&self) -> Result<&[u8], TensorError> {
        if self.kind == UINT8 { Ok(self.data) } else { Err(self.fault("should have the type uint8")) }
    }
}

/// The next bytes.
fn take<const N: usize>(rest: &mut &[u8]) -> Option<[u8; N]> {
    let (first, others) = rest.split_first_chunk()?;
    *rest = others;
    Some(*first)
}

/// The next field; `None` if its description is cut short.
fn read_field<'a>(bytes: &'a [u8], rest: &mut &[u8]) -> Option<Result<Field<'a>, TensorError>> {
    let name_length = usize::from(u16::from_le_bytes(take(rest)?));
    let (name, others) = rest.split_at_checked(name_length)?;
    *rest = others;
    let name = String::from_utf8_lossy(name).into_owned();
    let n_dimensions = u16::from_le_bytes(take(rest)?);
    let [kind] = take(rest)?;
    let begin = u64::from_le_bytes(take(rest)?);
    let fault = |why: &str| Some(Err(TensorError::Field(name.clone(), why.to_owned())));
    if n_dimensions > MAX_DIMENSIONS {
        return fault("has more than 8 dimensions");
    }
    let Some(size) = TYPE_BYTES.get(usize::from(kind)).copied().filter(|size| *size > 0) else {
        return fault("has an unknown type");
    };
    let mut shape = Vec::new();
    for _ in 0..n_dimensions {
        shape.push(usize::try_from(u64::from_le_bytes(take(rest)?)).unwrap_or(usize::MAX));
    }
    let length = shape.iter().try_fold(size, |product, n| product.checked_mul(*n));
    let begin = usize::try_from(begin).ok();
    let end = begin.zip(length).and_then(|(begin, length)| begin.checked_add(length));
    match begin.zip(end).and_then(|(begin, end)| bytes.get(begin..end)) {
        Some(data) => Some(Ok(Field { name, kind, shape, data })),
        None => fault("lies beyond the end of the file"),
    }
}

/// A field to write.
#[derive(Clone, Debug)]
pub struct NewField<'a> {
    /// Its name.
    pub name: &'a str,
    /// The dimensions, whose product is the number of numbers.
    pub shape: Vec<usize>,
    /// The numbers.
    pub data: NewData<'a>,
}

/// Numbers to write.
#[derive(Clone, Copy, Debug)]
pub enum NewData<'a> {
    /// Bytes.
    Bytes(&'a [u8]),
    /// Single precision.
    Floats(&'a [f32]),
}

/// The bytes of a file with these fields.
#[must_use]
pub fn tensor_bytes(fields: &[NewField<'_>]) -> Vec<u8> {
    let header_length = |field: &NewField<'_>| 2 + field.name.len() + 2 + 1 + 8 + 8 * field.shape.len();
    let mut begin = MAGIC.len() + 2 + 4 + fields.iter().map(header_length).sum::<usize>();
    let mut bytes = [MAGIC, &VERSION, &(fields.len() as u32).to_le_bytes()].concat();
    let mut content = Vec::new();
    for field in fields {
        let (kind, data) = match field.data {
            NewData::Bytes(data) => (UINT8, data.to_vec()),
            NewData::Floats(data) => (FLOAT32, data.iter().flat_map(|number| number.to_le_bytes()).collect()),
        };
        bytes.extend((field.name.len() as u16).to_le_bytes());
        bytes.extend(field.name.as_bytes());
        bytes.extend((field.shape.len() as u16).to_le_bytes());
        bytes.push(kind);
        bytes.extend((begin as u64).to_le_bytes());
        bytes.extend(field.shape.iter().flat_map(|n| (*n as u64).to_le_bytes()));
        begin += data.len();
        content.extend(data);
    }
    bytes.extend(content);
    bytes
}
