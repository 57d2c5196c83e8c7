//! Contents of the files that a document names: meshes, images, measured spectra, tables and measurements of BRDFs.
//!
//! The scene is built from a [`Document`](crate::Document) and its `Assets`, so that building opens no file.
//! Everything is keyed by the file name exactly as the parameter wrote it.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use etendue_image::Texels;
use etendue_math::{Normal3, Point2, Point3, Vector3};

use crate::bsdf::measured::MeasuredBrdf;
use crate::bsdf::tabulated::BrdfGrid;
use crate::camera::LensPrescription;

/// What a value of a mesh belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AttributeDomain {
    /// The vertices.
    Vertex,
    /// The faces: triangles, then quads.
    Face,
}

/// Values of a mesh beyond its shape, for the texture `meshattribute`.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshAttribute {
    /// `vertex_color` or `face_weight`: the domain, then the name.
    pub name: String,
    /// What the values belong to.
    pub domain: AttributeDomain,
    /// Numbers of a value; of more than three the first three count.
    pub n_components: usize,
    /// All numbers, value after value. Colours are linear, in sRGB's primaries.
    pub values: Vec<f32>,
}
use crate::light::Photometry;

/// A mesh read from a file, in object space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadedMesh {
    /// Vertices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Vertices of each bilinear patch in pbrt's order `p00 p10 p01 p11`: a quadrilateral `a b c d` of the file is
    /// `[a, b, d, c]` here.
    pub quads: Vec<[u32; 4]>,
    /// Vertex positions.
    pub positions: Vec<Point3>,
    /// Vertex normals, not necessarily of unit length; empty if the file has none.
    pub normals: Vec<Normal3>,
    /// Tangents of vertices along u, not necessarily of unit length; empty if the file has none.
    pub tangents: Vec<Vector3>,
    /// Vertex texture coordinates; empty if the file has none.
    pub uvs: Vec<Point2>,
    /// Face index of each triangle, then of each quad; empty if the file has none.
    pub face_indices: Vec<i32>,
    /// Further values of vertices and faces.
    pub attributes: Vec<MeshAttribute>,
}

/// Contours of interfaces in the order of their file, each with its name: points (height, radius).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contours(pub Vec<(String, Vec<Point2>)>);

/// Parameters of integrators that name files: the integrator's name, then the parameter's.
pub const INTEGRATOR_FILES: &[(&str, &str)] =
    &[("photonmap", "globalmap"), ("photonmap", "causticmap"), ("photons", "map")];

/// Everything that was loaded for a document.
#[derive(Clone, Debug, Default)]
pub struct Assets {
    /// Meshes by file name; shared with the document if that brought them along.
    pub meshes: HashMap<String, Arc<LoadedMesh>>,
    /// Pictures by file name, shared with the scene's textures and lights.
    pub images: HashMap<String, Arc<Texels>>,
    /// Measured spectra by file name: wavelengths in nanometres, ascending, with their values.
    pub spectra: HashMap<String, Vec<[f32; 2]>>,
    /// Tables of BRDFs by file name.
    pub brdfs: HashMap<String, BrdfGrid>,
    /// Measured BRDFs by file name.
    pub measured: HashMap<String, Arc<MeasuredBrdf>>,
    /// Lenses by file name.
    pub lenses: HashMap<String, Arc<LensPrescription>>,
    /// Measured luminaires by file name.
    pub luminaires: HashMap<String, Arc<Photometry>>,
    /// Contours of surfaces of revolution by file name.
    pub contours: HashMap<String, Contours>,
    /// Files of the method, as they are, by file name: methods know what they hold.
    pub of_integrator: HashMap<String, Arc<[u8]>>,
    /// Names of files that could not be read. Whoever tried has said why, so that the scene builder need not.
    pub failed: HashSet<String>,
}
