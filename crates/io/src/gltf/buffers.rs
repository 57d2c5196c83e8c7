//! Buffers and the views into them.

use std::cell::{Cell, OnceCell, RefCell};
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use super::FREE_ELEMENTS;
use super::container::{data_uri, file_of_uri};
use super::file::File;
use crate::file::read_file;
use crate::json::Json;

/// The bytes of a file's buffers, read when first asked for.
#[derive(Debug)]
pub(super) struct Buffers {
    base: PathBuf,
    /// The binary chunk of a GLB.
    binary: Option<Arc<[u8]>>,
    loaded: Vec<OnceCell<Option<Arc<[u8]>>>>,
    /// Files that several buffers may name.
    files: RefCell<HashMap<PathBuf, Option<Arc<[u8]>>>>,
    /// Bytes read so far, those of each file once.
    n_bytes: Cell<u64>,
    /// Elements that sparse accessors gave so far.
    n_sparse: Cell<u64>,
}

/// Part of a buffer.
#[derive(Clone, Copy, Debug)]
pub(super) struct View<'b> {
    pub(super) bytes: &'b [u8],
    /// Bytes from one element to the next; `None` if they follow each other closely.
    pub(super) stride: Option<usize>,
}

impl Buffers {
    pub(super) fn new(file: &File<'_>, base: PathBuf, binary: Option<Vec<u8>>) -> Self {
        let n_buffers = file.array(file.root, "buffers").len();
        Self {
            base,
            binary: binary.map(Arc::from),
            loaded: vec![OnceCell::new(); n_buffers],
            files: RefCell::default(),
            n_bytes: Cell::new(0),
            n_sparse: Cell::new(0),
        }
    }

    /// The bytes of a buffer, of which `at` speaks.
    fn buffer<'b>(&'b self, file: &File<'_>, at: &Json, index: usize) -> Option<&'b [u8]> {
        let buffer = file.item(at, "buffers", index)?;
        self.loaded[index].get_or_init(|| self.load(file, buffer, index)).as_deref()
    }

    fn load(&self, file: &File<'_>, buffer: &Json, index: usize) -> Option<Arc<[u8]>> {
        let bytes = match (file.string(buffer, "uri"), &self.binary) {
            (Some(uri), _) => self.uri(file, buffer.get("uri")?, uri)?,
            (None, Some(binary)) if index == 0 => {
                self.count(binary);
                Arc::clone(binary)
            }
            (None, _) => {
                file.error(buffer, "\"uri\" is missing, and the file has no binary chunk for this buffer");
                return None;
            }
        };
        let length = file.size(buffer, "byteLength", bytes.len());
        if length > bytes.len() {
            let n = bytes.len();
            file.error(buffer, format!("the buffer should have {length} bytes, but there are only {n}"));
            return None;
        }
        Some(bytes)
    }

    fn uri(&self, file: &File<'_>, at: &Json, uri: &str) -> Option<Arc<[u8]>> {
        if let Some(content) = data_uri(uri) {
            let bytes: Arc<[u8]> = content.map(Arc::from).map_err(|why| file.error(at, why)).ok()?;
            self.count(&bytes);
            return Some(bytes);
        }
        let name = file_of_uri(uri).map_err(|why| file.error(at, why)).ok()?;
        let path = self.base.join(&name);
        // Several names of a file are one.
        let key = path.canonicalize().unwrap_or_else(|_| path.clone());
        let mut files = self.files.borrow_mut();
        let read = || {
            let bytes: Arc<[u8]> = match read_file(&path) {
                Ok(bytes) => Arc::from(bytes),
                Err(error) => {
                    file.error(at, error.to_string());
                    return None;
                }
            };
            self.count(&bytes);
            Some(bytes)
        };
        files.entry(key).or_insert_with(read).clone()
    }

    fn count(&self, bytes: &[u8]) {
        self.n_bytes.set(self.n_bytes.get() + bytes.len() as u64);
    }

    /// Bytes that have been read for buffers; a file that several of them name counts once.
    pub(super) const fn n_bytes(&self) -> u64 {
        self.n_bytes.get()
    }

    /// Takes elements of a sparse accessor from those that the file may have; false if there are too many.
    pub(super) fn charge_sparse(&self, count: usize) -> bool {
        let spent = self.n_sparse.get().saturating_add(count as u64);
        let is_left = spent <= self.n_bytes() + FREE_ELEMENTS;
        if is_left {
            self.n_sparse.set(spent);
        }
        is_left
    }

    /// The buffer view that the member `name` of `object` refers to.
    pub(super) fn view<'b>(&'b self, file: &File<'_>, object: &Json, name: &str) -> Option<View<'b>> {
        let at = object.get(name)?;
        let view = file.item(at, "bufferViews", file.as_size(at)?)?;
        if view.get("extensions").and_then(|e| e.get("EXT_meshopt_compression")).is_some()
            || view.get("extensions").and_then(|e| e.get("KHR_meshopt_compression")).is_some()
        {
            file.error_with_help(
                view,
                "the view is compressed by meshopt, which cannot be read",
                "export without compression, or decompress with: gltfpack -noq -i IN -o OUT",
            );
            return None;
        }
        let buffer = file.required(view, "buffer")?;
        let bytes = self.buffer(file, buffer, file.as_size(buffer)?)?;
        let start = file.size(view, "byteOffset", 0);
        let length = file.as_size(file.required(view, "byteLength")?)?;
        let Some(part) = start.checked_add(length).and_then(|end| bytes.get(start..end)) else {
            let n = bytes.len();
            file.error(
                view,
                format!("bytes {start} to {start} + {length} are beyond the buffer of {n} bytes"),
            );
            return None;
        };
        let stride = file.size_opt(view, "byteStride").filter(|stride| *stride > 0);
        Some(View { bytes: part, stride })
    }
}
