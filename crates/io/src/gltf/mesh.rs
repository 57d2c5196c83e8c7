//! Primitives of meshes: triangles from any mode, with morph targets and skins at rest applied.

use etendue_math::{Normal3, Point2, Point3, Vector3};
use etendue_scene::LoadedMesh;
use etendue_scene::assets::{AttributeDomain, MeshAttribute};

use super::Reader;
use super::accessors::Accessor;
use super::draco::Compressed;
use super::material::VERTEX_COLOR;
use super::matrix::Matrix;
use crate::json::Json;

/// What of a primitive is wanted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted<'w> {
    /// Set of texture coordinates.
    pub(super) texcoord: usize,
    /// Whether tangents of vertices matter.
    pub(super) tangents: bool,
    /// Factor of the colours of vertices, if they matter.
    pub(super) vertex_color: Option<[f32; 3]>,
    /// Weights of morph targets.
    pub(super) weights: &'w [f32],
    /// Maps of the joints of a skin, from the mesh at rest to the world.
    pub(super) joints: Option<&'w [Matrix]>,
}

/// Attributes of a primitive or of a morph target, with the data that replaces their accessors if it is compressed.
struct Attributes<'a> {
    json: &'a Json,
    compressed: Option<Compressed<'a>>,
}

/// Numbers of vertices in the accessors, and the triangles between them.
struct Topology {
    /// The vertex of the accessors for each one that is kept.
    vertices: Vec<u32>,
    triangles: Vec<[u32; 3]>,
}

impl<'a> Reader<'a> {
    /// The mesh of a primitive; `None` if it holds no triangles or is in error, which is reported.
    pub(super) fn primitive(&self, primitive: &'a Json, wanted: &Wanted<'_>) -> Option<LoadedMesh> {
        let file = &self.file;
        let attributes = file.object(primitive, "attributes")?;
        if attributes.get("POSITION").is_none() {
            file.warning(primitive, "a primitive without \"POSITION\" is left out");
            return None;
        }
        let compressed = match file.extension(primitive, "KHR_draco_mesh_compression") {
            Some(extension) => Some(self.decompress(extension)?),
            None => None,
        };
        let attributes = Attributes { json: attributes, compressed };
        let positions = self.attribute(&attributes, "POSITION", &[3], None)?;
        let n = positions.count;
        let topology = self.topology(primitive, &attributes, n)?;
        let morphs = self.morphs(primitive, wanted.weights, n);
        self.charge(primitive, morphs.len().saturating_mul(topology.vertices.len()))?;
        let mut mesh = LoadedMesh { triangles: topology.triangles, ..LoadedMesh::default() };
        let vertices = &topology.vertices;
        let vector = |accessor: &Accessor<'_>, vertex: u32| {
            let [x, y, z] = accessor.floats(vertex as usize);
            Vector3::new(x, y, z)
        };
        let morphed = |base: &Accessor<'_>, kind: usize, vertex: u32| {
            let deltas =
                morphs.iter().filter_map(|(weight, targets)| Some((*weight, targets[kind].as_ref()?)));
            deltas.fold(vector(base, vertex), |sum, (weight, target)| sum + vector(target, vertex) * weight)
        };
        mesh.positions = vertices.iter().map(|v| Point3::ORIGIN + morphed(&positions, 0, *v)).collect();
        if let Some(normals) = self.attribute(&attributes, "NORMAL", &[3], Some(n)) {
            let normal = |v: &u32| morphed(&normals, 1, *v).as_normal();
            mesh.normals = vertices.iter().map(normal).collect();
        }
        if wanted.tangents
            && !mesh.normals.is_empty()
            && let Some(tangents) = self.attribute(&attributes, "TANGENT", &[3, 4], Some(n))
        {
            mesh.tangents = vertices.iter().map(|v| morphed(&tangents, 2, *v)).collect();
        }
        let name = format!("TEXCOORD_{}", wanted.texcoord);
        if let Some(uvs) = self.attribute(&attributes, &name, &[2], Some(n)) {
            let uv = |v: &u32| {
                let [u, v] = uvs.floats(*v as usize);
                Point2::new(u, 1.0 - v)
            };
            mesh.uvs = vertices.iter().map(uv).collect();
        }
        if let Some(factor) = wanted.vertex_color
            && let Some(colors) = self.attribute(&attributes, "COLOR_0", &[3, 4], Some(n))
        {
            let color = |vertex: &u32| -> [f32; 3] {
                let color: [f32; 3] = colors.floats(*vertex as usize);
                std::array::from_fn(|i| (factor[i] * color[i]).clamp(0.0, 1.0))
            };
            mesh.attributes.push(MeshAttribute {
                name: VERTEX_COLOR.to_owned(),
                domain: AttributeDomain::Vertex,
                n_components: 3,
                values: vertices.iter().flat_map(color).collect(),
            });
        }
        if let Some(joints) = wanted.joints {
            self.skin(&attributes, joints, vertices, n, &mut mesh);
        }
        self.check_finite(primitive, vertices, &mut mesh)?;
        Some(mesh)
    }

    /// True if vertices of a primitive have colours other than white.
    pub(super) fn is_tinted(&self, primitive: &'a Json) -> bool {
        let Some(at) = primitive.get("attributes").and_then(|attributes| attributes.get("COLOR_0")) else {
            return false;
        };
        let is_compressed =
            primitive.get("extensions").is_some_and(|e| e.get("KHR_draco_mesh_compression").is_some());
        let Some(index) = self.file.as_size(at) else { return false };
        if is_compressed {
            return true;
        }
        *self.tinted.borrow_mut().entry(index).or_insert_with(|| {
            let colors = Accessor::read(&self.file, &self.buffers, at, index);
            colors.is_some_and(|colors| (0..colors.count).any(|i| colors.floats(i) != [1.0; 3]))
        })
    }

    /// An attribute with one of the given numbers of components and, if `n` says so, n elements.
    fn attribute(
        &self,
        attributes: &Attributes<'a>,
        name: &str,
        n_components: &[usize],
        n: Option<usize>,
    ) -> Option<Accessor<'_>> {
        let at = attributes.json.get(name)?;
        let compressed = attributes.compressed.as_ref();
        let accessor = match compressed.and_then(|data| self.decompressed_attribute(data, name, at)) {
            Some(accessor) => accessor,
            None => Accessor::read(&self.file, &self.buffers, at, self.file.as_size(at)?)?,
        };
        if !n_components.contains(&accessor.n_components) {
            self.file
                .error(at, format!("\"{name}\" cannot have elements of {} numbers", accessor.n_components));
            return None;
        }
        if n.is_some_and(|n| n != accessor.count) {
            let (count, n) = (accessor.count, n.unwrap_or_default());
            self.file.error(at, format!("\"{name}\" has {count} elements for {n} vertices"));
            return None;
        }
        Some(accessor)
    }

    fn topology(&self, primitive: &'a Json, attributes: &Attributes<'a>, n: usize) -> Option<Topology> {
        let file = &self.file;
        let indices = match (&attributes.compressed, primitive.get("indices")) {
            (Some(compressed), _) => Some((primitive, compressed.indices())),
            (None, Some(at)) => {
                let accessor = Accessor::read(file, &self.buffers, at, file.as_size(at)?)?;
                if accessor.n_components != 1 || !accessor.holds_integers() {
                    file.error(at, "indices are unsigned whole numbers: SCALAR of 5121, 5123 or 5125");
                    return None;
                }
                Some((at, accessor))
            }
            (None, None) => None,
        };
        let n_indices = indices.as_ref().map_or(n, |(_, accessor)| accessor.count);
        // What was a strip is decompressed as triangles.
        let mode = if attributes.compressed.is_some() { 4 } else { file.size(primitive, "mode", 4) };
        let n_triangles = match mode {
            4 => n_indices / 3,
            5 | 6 => n_indices.saturating_sub(2),
            0..=3 => {
                let what = if mode == 0 { "points" } else { "lines" };
                file.warning(primitive, format!("{what} have no surface; they are left out"));
                return None;
            }
            _ => {
                file.error(primitive, format!("{mode} is no mode: there are 0 to 6"));
                return None;
            }
        };
        if n_triangles == 0 {
            file.warning(primitive, "a primitive without triangles is left out");
            return None;
        }
        if mode == 4 && n_indices % 3 != 0 {
            file.warning(
                primitive,
                format!("{n_indices} vertices are no multiple of 3; the last are left out"),
            );
        }
        self.charge(primitive, n_triangles + n_indices.min(n))?;
        let corners = |i: usize| match mode {
            4 => [3 * i, 3 * i + 1, 3 * i + 2],
            // Every other triangle of a strip is turned around.
            5 => [i, i + 1 + i % 2, i + 2 - i % 2],
            _ => [i + 1, i + 2, 0],
        };
        let Some((at, accessor)) = indices else {
            let triangles = (0..n_triangles).map(|i| corners(i).map(|corner| corner as u32)).collect();
            return Some(Topology { vertices: (0..n as u32).collect(), triangles });
        };
        // Vertices that this primitive uses, numbered anew; 0 is none yet.
        let (mut numbers, mut vertices) = (vec![0_u32; n], Vec::new());
        let mut triangles = Vec::with_capacity(n_triangles);
        for triangle in 0..n_triangles {
            let mut corner_numbers = [0; 3];
            for (number, corner) in corner_numbers.iter_mut().zip(corners(triangle)) {
                let [vertex] = accessor.integers(corner);
                let Some(known) = numbers.get_mut(vertex as usize) else {
                    file.error(at, format!("index {corner} is {vertex}, but there are {n} vertices"));
                    return None;
                };
                if *known == 0 {
                    vertices.push(vertex);
                    *known = vertices.len() as u32;
                }
                *number = *known - 1;
            }
            triangles.push(corner_numbers);
        }
        Some(Topology { vertices, triangles })
    }

    /// Morph targets that count, with their weights: positions, normals, tangents.
    fn morphs(
        &self,
        primitive: &'a Json,
        weights: &[f32],
        n: usize,
    ) -> Vec<(f32, [Option<Accessor<'_>>; 3])> {
        let targets = self.file.array(primitive, "targets");
        let weighted = targets.iter().zip(weights).filter(|(_, weight)| **weight != 0.0);
        let read = |(target, weight): (&'a Json, &f32)| {
            let target = Attributes { json: target, compressed: None };
            let part = |name| self.attribute(&target, name, &[3], Some(n));
            (*weight, ["POSITION", "NORMAL", "TANGENT"].map(part))
        };
        weighted.map(read).collect()
    }

    /// Moves vertices by the joints that hold them.
    fn skin(
        &self,
        attributes: &Attributes<'a>,
        joints: &[Matrix],
        vertices: &[u32],
        n: usize,
        mesh: &mut LoadedMesh,
    ) {
        let set = |index: usize| {
            let numbers = self.attribute(attributes, &format!("JOINTS_{index}"), &[4], Some(n))?;
            let weights = self.attribute(attributes, &format!("WEIGHTS_{index}"), &[4], Some(n))?;
            Some((numbers, weights))
        };
        let sets: Vec<_> = (0..8).map_while(set).collect();
        if sets.is_empty() {
            self.file.warning(
                attributes.json,
                "a mesh with a skin needs JOINTS_0 and WEIGHTS_0; it stays as it is",
            );
            return;
        }
        for (place, vertex) in vertices.iter().enumerate() {
            let (mut map, mut sum) = (Matrix::ZERO, 0.0);
            for (numbers, weights) in &sets {
                let numbers: [u32; 4] = numbers.integers(*vertex as usize);
                let weights: [f32; 4] = weights.floats(*vertex as usize);
                for (number, weight) in numbers.into_iter().zip(weights).filter(|(_, weight)| *weight > 0.0) {
                    let Some(joint) = joints.get(number as usize) else {
                        let n = joints.len();
                        let message = format!("vertex {vertex} hangs on joint {number}, but there are {n}");
                        self.file.error(attributes.json, message);
                        return;
                    };
                    map.add_scaled(joint, f64::from(weight));
                    sum += f64::from(weight);
                }
            }
            if sum > 0.0 {
                let mut mean = Matrix::ZERO;
                mean.add_scaled(&map, 1.0 / sum);
                mesh.positions[place] = mean.point(mesh.positions[place]);
                if let Some(normal) = mesh.normals.get_mut(place) {
                    *normal = mean.normal(*normal);
                }
                if let Some(tangent) = mesh.tangents.get_mut(place) {
                    *tangent = mean.vector(*tangent);
                }
            }
        }
    }

    /// Refuses positions that are not finite; other attributes are left out then, with a warning.
    fn check_finite(&self, primitive: &'a Json, vertices: &[u32], mesh: &mut LoadedMesh) -> Option<()> {
        if let Some(place) = mesh.positions.iter().position(|p| !p.is_finite()) {
            self.file.error(primitive, format!("the position of vertex {} is not finite", vertices[place]));
            return None;
        }
        let is_finite = |n: &Normal3| n.x.is_finite() && n.y.is_finite() && n.z.is_finite();
        let drop = |name: &str, is_bad: bool| {
            if is_bad {
                self.file.warning(primitive, format!("{name} that are not finite are left out"));
            }
            is_bad
        };
        if drop("normals", !mesh.normals.iter().all(is_finite)) {
            mesh.normals.clear();
        }
        if drop("tangents", !mesh.tangents.iter().all(|t| t.is_finite())) {
            mesh.tangents.clear();
        }
        if drop("texture coordinates", !mesh.uvs.iter().all(|uv| uv.is_finite())) {
            mesh.uvs.clear();
        }
        Some(())
    }
}
