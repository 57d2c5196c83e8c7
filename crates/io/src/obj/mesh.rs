//! From the faces of a file to meshes with one index for each vertex.

use std::collections::HashMap;

use etendue_math::{Point3, Vector3};
use etendue_scene::LoadedMesh;

use super::parse::{Corner, Face, NONE, ObjFile};
use super::polygon::triangulate;

/// Which normal a corner has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum NormalKey {
    /// None: the facet's own.
    Flat,
    /// That of the file.
    Given(u32),
    /// The mean over the smoothing group.
    Smooth(u32),
    /// That of the face, in a mesh where others have normals.
    Face(u32),
}

/// A mesh for each material of the file, empty for those without faces.
pub(super) fn meshes_by_material(obj: &ObjFile) -> Vec<LoadedMesh> {
    let mut faces: Vec<Vec<u32>> = vec![Vec::new(); obj.materials.len()];
    for (index, face) in obj.faces.iter().enumerate() {
        faces[face.material as usize].push(index as u32);
    }
    let smooth = smooth_normals(obj);
    let mut weld = Weld::new(obj.positions.len());
    faces.iter().map(|faces| mesh(obj, faces, &smooth, &mut weld)).collect()
}

/// One mesh of all faces.
pub(super) fn whole_mesh(obj: &ObjFile) -> LoadedMesh {
    let faces: Vec<u32> = (0..obj.faces.len() as u32).collect();
    mesh(obj, &faces, &smooth_normals(obj), &mut Weld::new(obj.positions.len()))
}

/// A vertex of the mesh that stands for a position of the file.
struct Welded {
    uv: u32,
    normal: NormalKey,
    /// The next vertex of the same position.
    next: u32,
}

/// Vertices in the chain of a position; more are found by hashing, since to walk a long chain takes too long.
const MAX_CHAIN: usize = 16;

/// Vertices of a mesh by the positions of the file: a chain for each, so that ordinary files need no hashing.
struct Weld {
    /// The first vertex of each position.
    first: Vec<u32>,
    vertices: Vec<Welded>,
    /// Positions that have vertices.
    touched: Vec<u32>,
    /// What no chain has room for, by position, texture coordinate and normal.
    further: HashMap<(u32, u32, NormalKey), u32>,
}

impl Weld {
    fn new(n_positions: usize) -> Self {
        Self {
            first: vec![NONE; n_positions],
            vertices: Vec::new(),
            touched: Vec::new(),
            further: HashMap::new(),
        }
    }

    fn clear(&mut self) {
        for position in self.touched.drain(..) {
            self.first[position as usize] = NONE;
        }
        self.vertices.clear();
        self.further.clear();
    }

    /// The vertex of that kind, and whether it is new. The normal of a face is its own and needs no search.
    fn vertex(&mut self, corner: &Corner, normal: NormalKey) -> (u32, bool) {
        let new = self.vertices.len() as u32;
        let head = self.first[corner.position as usize];
        self.vertices.push(Welded { uv: corner.uv, normal, next: head });
        if matches!(normal, NormalKey::Face(_)) {
            return (new, true);
        }
        let (mut at, mut n_steps) = (head, 0);
        while at != NONE {
            let known = &self.vertices[at as usize];
            if known.uv == corner.uv && known.normal == normal {
                self.vertices.pop();
                return (at, false);
            }
            (at, n_steps) = (known.next, n_steps + 1);
        }
        if n_steps == MAX_CHAIN {
            let found = *self.further.entry((corner.position, corner.uv, normal)).or_insert(new);
            if found != new {
                self.vertices.pop();
            }
            return (found, found == new);
        }
        self.first[corner.position as usize] = new;
        if head == NONE {
            self.touched.push(corner.position);
        }
        (new, true)
    }
}

/// Sums of the normals of faces in a smoothing group, by position and group.
type SmoothNormals = HashMap<(u32, u32), Vector3>;

/// Sums over the faces of a group at each vertex, weighted by angles, of faces that have no normals.
fn smooth_normals(obj: &ObjFile) -> SmoothNormals {
    let mut sums = SmoothNormals::new();
    for (index, face) in obj.faces.iter().enumerate() {
        let corners = obj.corners_of(index);
        if face.group == 0 || corners.iter().all(|corner| corner.normal != NONE) {
            continue;
        }
        let at = |i: usize| obj.positions[corners[i % corners.len()].position as usize];
        let Some(normal) = face_normal(obj, corners) else { continue };
        for (i, corner) in corners.iter().enumerate() {
            let to = |j: usize| (at(i + j) - at(i)).try_normalized();
            let (Some(a), Some(b)) = (to(1), to(corners.len() - 1)) else { continue };
            let sum = sums.entry((corner.position, face.group)).or_default();
            *sum += normal * a.angle_between(b);
        }
    }
    sums
}

/// The unit normal of a polygon by Newell's sum.
fn face_normal(obj: &ObjFile, corners: &[Corner]) -> Option<Vector3> {
    let from_first =
        |i: usize| obj.positions[corners[i].position as usize] - obj.positions[corners[0].position as usize];
    let areas = (1..corners.len() - 1).map(|i| from_first(i).cross(from_first(i + 1)));
    areas.fold(Vector3::default(), |sum, area| sum + area).try_normalized()
}

fn mesh(obj: &ObjFile, faces: &[u32], smooth: &SmoothNormals, weld: &mut Weld) -> LoadedMesh {
    weld.clear();
    let corners = || faces.iter().flat_map(|face| obj.corners_of(*face as usize));
    let has_groups = faces.iter().any(|face| obj.faces[*face as usize].group != 0);
    let has_normals = has_groups || corners().any(|corner| corner.normal != NONE);
    let has_uvs = corners().any(|corner| corner.uv != NONE);
    let mut made = LoadedMesh::default();
    let mut points: Vec<Point3> = Vec::new();
    let mut vertices: Vec<u32> = Vec::new();
    for index in faces {
        let (face, corners) = (obj.faces[*index as usize], obj.corners_of(*index as usize));
        vertices.clear();
        for corner in corners {
            let key = if has_normals { normal_key(corner, face, *index) } else { NormalKey::Flat };
            let (vertex, is_new) = weld.vertex(corner, key);
            vertices.push(vertex);
            if !is_new {
                continue;
            }
            made.positions.push(obj.positions[corner.position as usize]);
            if has_uvs {
                made.uvs.push(obj.uvs.get(corner.uv as usize).copied().unwrap_or_default());
            }
            if has_normals {
                let normal = match key {
                    NormalKey::Given(index) => Some(obj.normals[index as usize].as_vector()),
                    NormalKey::Smooth(group) => {
                        smooth.get(&(corner.position, group)).and_then(|sum| sum.try_normalized())
                    }
                    _ => face_normal(obj, corners),
                };
                made.normals.push(normal.unwrap_or(Vector3::new(0.0, 0.0, 1.0)).as_normal());
            }
        }
        if let [a, b, c] = vertices[..] {
            made.triangles.push([a, b, c]);
        } else {
            points.clear();
            points.extend(corners.iter().map(|corner| obj.positions[corner.position as usize]));
            made.triangles
                .extend(triangulate(&points).into_iter().map(|triangle| triangle.map(|i| vertices[i])));
        }
    }
    made
}

fn normal_key(corner: &Corner, face: Face, index: u32) -> NormalKey {
    match (corner.normal, face.group) {
        (NONE, 0) => NormalKey::Face(index),
        (NONE, group) => NormalKey::Smooth(group),
        (normal, _) => NormalKey::Given(normal),
    }
}
