//! Meshes of files as Mitsuba takes them: smooth where the file has no normals and `face_normals` is off, triangles for
//! quadrilaterals, and v as all our textures expect it.

use std::collections::BTreeMap;

use etendue_scene::document::EmbeddedFile;
use etendue_scene::{LoadedMesh, Span};
use rayon::prelude::*;

use super::reader::Reader;
use super::serialized::read_serialized;
use crate::file::read_file;
use crate::mesh::{compute_normals, split_quads};
use crate::obj::read_obj_mesh;
use crate::ply::read_ply;

/// The format of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Format {
    Obj,
    Ply,
    /// Mitsuba's own, with the index of the mesh.
    Serialized(usize),
}

/// A mesh that shapes refer to.
#[derive(Clone, Debug)]
pub(super) struct MeshRequest {
    /// Relative to the folder of the scene.
    pub(super) file: String,
    pub(super) format: Format,
    pub(super) face_normals: bool,
    /// Turn v round.
    pub(super) flip_v: bool,
    pub(super) span: Span,
}

impl MeshRequest {
    /// What tells it from other meshes of the scene.
    pub(super) fn part(&self) -> String {
        let mut name = self.file.clone();
        if let Format::Serialized(index) = self.format {
            name += &format!(" #{index}");
        }
        name += if self.face_normals { " (facetted" } else { " (smooth" };
        name + if self.flip_v { ", v turned)" } else { ")" }
    }
}

impl Reader<'_> {
    /// Reads all meshes into the document, each once.
    pub(super) fn read_meshes(&mut self) {
        let mut wanted: BTreeMap<String, MeshRequest> = BTreeMap::new();
        for (name, request) in std::mem::take(&mut self.meshes) {
            wanted.entry(name).or_insert(request);
        }
        let folder = self.files.base_directory.clone();
        let read = |(name, request): (String, MeshRequest)| {
            let path = folder.join(&request.file);
            let result = read_file(&path).map_err(|error| error.to_string()).and_then(|bytes| {
                read_mesh(&bytes, &request).map_err(|why| format!("`{}`: {why}", path.display()))
            });
            (name, request, result)
        };
        let wanted: Vec<_> = wanted.into_iter().collect();
        let read: Vec<_> = wanted.into_par_iter().with_max_len(1).map(read).collect();
        for (name, request, result) in read {
            match result {
                Ok((mesh, warnings)) => {
                    for warning in warnings {
                        self.diagnostics
                            .warning(request.span, format!("mesh \"{}\": {warning}", request.file));
                    }
                    self.document.embedded.insert(name, EmbeddedFile::Mesh(mesh.into()));
                }
                Err(why) => {
                    self.diagnostics.error(request.span, why);
                }
            }
        }
    }
}

fn read_mesh(bytes: &[u8], request: &MeshRequest) -> Result<(LoadedMesh, Vec<String>), String> {
    let (mut mesh, warnings) = match request.format {
        Format::Ply => {
            let ply = read_ply(bytes).map_err(|error| error.to_string())?;
            (ply.mesh, ply.warnings)
        }
        Format::Obj => read_obj_mesh(bytes).map_err(|error| error.to_string())?,
        Format::Serialized(index) => (read_serialized(bytes, index)?, Vec::new()),
    };
    split_quads(&mut mesh);
    if request.face_normals {
        mesh.normals.clear();
    } else if mesh.normals.is_empty() {
        compute_normals(&mut mesh);
    }
    if request.flip_v {
        for uv in &mut mesh.uvs {
            uv.y = 1.0 - uv.y;
        }
    }
    Ok((mesh, warnings))
}
