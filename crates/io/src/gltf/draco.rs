//! Meshes that are compressed by Draco: `KHR_draco_mesh_compression`, decoded by the crate `draco-core`.

use std::panic::{AssertUnwindSafe, catch_unwind};

use draco_core::{DecodeLimits, DecoderBuffer, FaceIndex, Mesh, MeshDecoder};

use super::Reader;
use super::accessors::{Accessor, unit};
use crate::json::Json;

/// What a compressed primitive holds.
pub(super) struct Compressed<'a> {
    mesh: Mesh,
    /// Numbers of attributes in the compressed data, by name.
    names: &'a Json,
}

impl<'a> Reader<'a> {
    /// Decodes the data of the extension, unless there is more than the file may have.
    pub(super) fn decompress(&self, extension: &'a Json) -> Option<Compressed<'a>> {
        let file = &self.file;
        file.required(extension, "bufferView")?;
        let view = self.buffers.view(file, extension, "bufferView")?;
        let names = file.required(extension, "attributes")?;
        let limits = DecodeLimits::default().with_max_points(self.left()).with_max_faces(self.left());
        let decode = || {
            let mut mesh = Mesh::new();
            let mut buffer = DecoderBuffer::new(view.bytes).with_limits(limits);
            MeshDecoder::new()
                .decode(&mut buffer, &mut mesh)
                .map(|()| mesh)
                .map_err(|error| format!("{error:?}"))
        };
        // As with pictures, a panic of a decoder is one more damaged file.
        let decoded =
            catch_unwind(AssertUnwindSafe(decode)).unwrap_or_else(|_| Err("the decoder gave up".to_owned()));
        match decoded {
            Ok(mesh) => {
                self.charge(extension, mesh.num_points().saturating_add(mesh.num_faces()))?;
                Some(Compressed { mesh, names })
            }
            Err(why) => {
                file.error(extension, format!("the data of Draco are damaged or too large: {why}"));
                None
            }
        }
    }

    /// An attribute of the compressed data; the accessor of that name, at `at`, says what its numbers mean. `None` if it
    /// is not compressed.
    pub(super) fn decompressed_attribute(
        &self,
        compressed: &Compressed<'a>,
        name: &str,
        at: &'a Json,
    ) -> Option<Accessor<'a>> {
        let id = self.file.size_opt(compressed.names, name)?;
        let attribute = compressed.mesh.attribute_by_unique_id(u32::try_from(id).ok()?)?;
        let accessor = self.file.item(at, "accessors", self.file.as_size(at)?)?;
        let n_components = usize::from(attribute.num_components()).max(1);
        let mut values = attribute.read_f32s(compressed.mesh.num_points(), n_components);
        let unit = unit(&self.file, accessor);
        if unit != 1.0 {
            values.iter_mut().for_each(|value| *value = (*value / unit).max(-1.0));
        }
        Some(Accessor::of_floats(&values, n_components))
    }
}

impl Compressed<'_> {
    /// The vertices of all triangles.
    pub(super) fn indices<'b>(&self) -> Accessor<'b> {
        let faces = (0..self.mesh.num_faces()).map(|face| self.mesh.face(FaceIndex(face as u32)));
        Accessor::of_indices(faces.flatten().map(|point| point.0))
    }
}
