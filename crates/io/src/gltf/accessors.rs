//! Accessors: arrays of numbers in buffers, plain, strided, normalised or sparse (glTF 2.0, section 3.6.2).
//!
//! Elements are read one by one, so that an accessor costs no memory of its own, however often meshes share it.

use std::borrow::Cow;

use super::buffers::{Buffers, View};
use super::file::File;
use crate::json::Json;

/// Elements of accessors that have no bytes: all of them are zero, so that a few letters may claim any number.
const MAX_ZEROS: usize = 1 << 24;

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of_code(code: usize) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    const fn n_bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// True if it can number vertices.
    const fn is_unsigned(self) -> bool {
        matches!(self, Self::U8 | Self::U16 | Self::U32)
    }

    /// The number at the start of the bytes, which are enough.
    fn number(self, bytes: &[u8], is_normalized: bool) -> f32 {
        let value = match self {
            Self::I8 => f32::from(bytes[0] as i8),
            Self::U8 => f32::from(bytes[0]),
            Self::I16 => f32::from(i16::from_le_bytes([bytes[0], bytes[1]])),
            Self::U16 => f32::from(u16::from_le_bytes([bytes[0], bytes[1]])),
            Self::U32 => u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]) as f32,
            Self::F32 => f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
        };
        match self.largest() {
            1.0 => value,
            largest if is_normalized => (value / largest).max(-1.0),
            _ => value,
        }
    }

    /// The same for numbers of vertices.
    fn index(self, bytes: &[u8]) -> u32 {
        match self {
            Self::I8 | Self::U8 => u32::from(bytes[0]),
            Self::I16 | Self::U16 => u32::from(u16::from_le_bytes([bytes[0], bytes[1]])),
            Self::U32 => u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
            Self::F32 => f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]) as u32,
        }
    }

    /// What stands for 1 in normalised integers.
    const fn largest(self) -> f32 {
        match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32767.0,
            Self::U16 => 65535.0,
            Self::U32 | Self::F32 => 1.0,
        }
    }
}

/// What stands for 1 in the numbers of an accessor: 1 unless they are normalised integers.
pub(super) fn unit(file: &File<'_>, accessor: &Json) -> f32 {
    let component = file.size_opt(accessor, "componentType").and_then(Component::of_code);
    let is_normalized = file.bool(accessor, "normalized");
    component.filter(|_| is_normalized).map_or(1.0, Component::largest)
}

/// Elements that differ from the others.
#[derive(Clone, Debug)]
struct Sparse<'b> {
    /// Ascending.
    indices: Vec<u32>,
    /// An element for each index, one after the other.
    values: &'b [u8],
}

/// An array of vectors, matrices or numbers.
#[derive(Clone, Debug)]
pub(super) struct Accessor<'b> {
    /// Number of elements.
    pub(super) count: usize,
    /// Numbers of an element.
    pub(super) n_components: usize,
    component: Component,
    is_normalized: bool,
    /// From the first element on; `None` if all are zero.
    bytes: Option<Cow<'b, [u8]>>,
    stride: usize,
    sparse: Option<Sparse<'b>>,
}

impl<'b> Accessor<'b> {
    /// Accessor `index`, where `at` says so. All that it says of itself is held against its buffer.
    pub(super) fn read(file: &File<'_>, buffers: &'b Buffers, at: &Json, index: usize) -> Option<Self> {
        let json = file.item(at, "accessors", index)?;
        let code = file.required(json, "componentType")?;
        let Some(component) = Component::of_code(file.as_size(code)?) else {
            file.error(code, "no component type: there are 5120 to 5123, 5125 and 5126");
            return None;
        };
        let n_components = n_components(file, json)?;
        let count = file.as_size(file.required(json, "count")?)?;
        if count > u32::MAX as usize {
            file.error(json, format!("{count} elements are too many"));
            return None;
        }
        let element = n_components * component.n_bytes();
        let is_normalized = file.bool(json, "normalized");
        let mut accessor = Self {
            count,
            n_components,
            component,
            is_normalized,
            bytes: None,
            stride: element,
            sparse: None,
        };
        if json.get("bufferView").is_some() {
            let view = buffers.view(file, json, "bufferView")?;
            accessor.stride = view.stride.unwrap_or(element);
            let offset = file.size(json, "byteOffset", 0);
            let bytes = elements(file, json, view.bytes, offset, [count, element, accessor.stride])?;
            accessor.bytes = Some(Cow::Borrowed(bytes));
        } else if count > MAX_ZEROS {
            file.error(json, format!("{count} elements without a bufferView are too many"));
            return None;
        }
        if let Some(sparse) = file.object(json, "sparse") {
            accessor.sparse = Some(accessor.read_sparse(file, buffers, sparse)?);
        }
        Some(accessor)
    }

    fn read_sparse(&self, file: &File<'_>, buffers: &'b Buffers, json: &Json) -> Option<Sparse<'b>> {
        let count = file.as_size(file.required(json, "count")?)?;
        let part = |name: &str, element: usize| -> Option<(&Json, &'b [u8])> {
            let part = file.required(json, name)?;
            file.required(part, "bufferView")?;
            let View { bytes, .. } = buffers.view(file, part, "bufferView")?;
            let offset = file.size(part, "byteOffset", 0);
            Some((part, elements(file, part, bytes, offset, [count, element, element])?))
        };
        let numbers = file.required(json, "indices")?;
        let code = file.required(numbers, "componentType")?;
        let Some(kind) = Component::of_code(file.as_size(code)?).filter(|kind| kind.is_unsigned()) else {
            file.error(code, "indices have the component type 5121, 5123 or 5125");
            return None;
        };
        let (at, bytes) = part("indices", kind.n_bytes())?;
        let (_, values) = part("values", self.n_components * self.component.n_bytes())?;
        if !buffers.charge_sparse(count) {
            file.error(at, "the file uses sparse data too often");
            return None;
        }
        let indices: Vec<u32> =
            bytes.chunks_exact(kind.n_bytes()).take(count).map(|b| kind.index(b)).collect();
        let ascend = indices.windows(2).all(|pair| pair[0] < pair[1]);
        if !ascend || indices.last().is_some_and(|last| *last as usize >= self.count) {
            file.error(at, format!("indices must ascend and stay below {}", self.count));
            return None;
        }
        Some(Sparse { indices, values })
    }

    /// Numbers that are at hand, of `n_components` for each element.
    pub(super) fn of_floats(values: &[f32], n_components: usize) -> Self {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        Self::of_bytes(bytes, Component::F32, n_components)
    }

    /// Numbers of vertices that are at hand.
    pub(super) fn of_indices(values: impl Iterator<Item = u32>) -> Self {
        Self::of_bytes(values.flat_map(u32::to_le_bytes).collect(), Component::U32, 1)
    }

    fn of_bytes(bytes: Vec<u8>, component: Component, n_components: usize) -> Self {
        let stride = n_components * component.n_bytes();
        let (count, bytes) = (bytes.len() / stride, Some(Cow::Owned(bytes)));
        Self { count, n_components, component, is_normalized: false, bytes, stride, sparse: None }
    }

    /// The bytes of an element, of which there are enough; `None` if it is zero.
    fn element(&self, index: usize) -> Option<&[u8]> {
        if let Some(sparse) = &self.sparse
            && let Ok(place) = sparse.indices.binary_search(&(index as u32))
        {
            let n_bytes = self.n_components * self.component.n_bytes();
            return Some(&sparse.values[place * n_bytes..]);
        }
        Some(&self.bytes.as_deref()?[index * self.stride..])
    }

    /// The first N numbers of an element; those that it does not have are zero.
    pub(super) fn floats<const N: usize>(&self, index: usize) -> [f32; N] {
        let Some(bytes) = self.element(index) else { return [0.0; N] };
        let size = self.component.n_bytes();
        std::array::from_fn(|i| {
            if i < self.n_components {
                self.component.number(&bytes[i * size..], self.is_normalized)
            } else {
                0.0
            }
        })
    }

    /// The first N numbers of an element as whole numbers, if the accessor holds such.
    pub(super) fn integers<const N: usize>(&self, index: usize) -> [u32; N] {
        let Some(bytes) = self.element(index) else { return [0; N] };
        let size = self.component.n_bytes();
        std::array::from_fn(
            |i| if i < self.n_components { self.component.index(&bytes[i * size..]) } else { 0 },
        )
    }

    /// Whether its numbers are unsigned integers.
    pub(super) const fn holds_integers(&self) -> bool {
        self.component.is_unsigned()
    }
}

fn n_components(file: &File<'_>, json: &Json) -> Option<usize> {
    file.required(json, "type")?;
    let name = file.string(json, "type")?;
    let known =
        [("SCALAR", 1), ("VEC2", 2), ("VEC3", 3), ("VEC4", 4), ("MAT2", 4), ("MAT3", 9), ("MAT4", 16)];
    let found = known.iter().find(|(known, _)| *known == name);
    if found.is_none() {
        file.error(json, format!("\"{name}\" is no type: there are SCALAR, VEC2 to VEC4, MAT2 to MAT4"));
    }
    found.map(|(_, n)| *n)
}

/// The bytes from `offset` on, if they hold `[count, element, stride]` elements of that size, a stride apart.
fn elements<'b>(
    file: &File<'_>,
    at: &Json,
    bytes: &'b [u8],
    offset: usize,
    [count, element, stride]: [usize; 3],
) -> Option<&'b [u8]> {
    if stride < element {
        file.error(at, format!("elements of {element} bytes overlap: \"byteStride\" is {stride}"));
        return None;
    }
    let needed = match count {
        0 => Some(0),
        _ => (count - 1).checked_mul(stride).and_then(|n| n.checked_add(element)),
    };
    let rest = bytes.get(offset..).unwrap_or_default();
    if needed.is_none_or(|needed| needed > rest.len()) {
        let message = format!(
            "{count} elements of {element} bytes, {stride} apart from byte {offset}, are beyond the view of {} bytes",
            bytes.len()
        );
        file.error(at, message);
        return None;
    }
    Some(rest)
}
