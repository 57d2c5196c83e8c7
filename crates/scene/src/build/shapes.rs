//! Shapes: from entities to geometry, with the attributes that geometry does not know.

use std::collections::HashMap;

use etendue_geometry::{
    BilinearMesh, GeometryBuilder, GeometryId, ObjectId, Shape, TriangleMesh, loop_subdivide,
};
use etendue_math::{Normal3, Point2, Vector3};

use crate::assets::LoadedMesh;
use crate::diagnostics::Span;
use crate::document::{MaterialReference, ShapeEntity};
use crate::material::MaterialId;
use crate::parameters::{ParameterSpec, Parameters};
use crate::scene::ShapeAttributes;
use crate::texture::FloatTexture;

use super::materials::DEFAULT_MATERIAL;
use super::{Builder, known_names, unknown_name};

/// Shape types with their parameters.
pub const SHAPES: &[(&str, &[ParameterSpec])] = &[
    ("sphere", SPHERE),
    ("disk", DISK),
    ("cylinder", CYLINDER),
    ("trianglemesh", TRIANGLE_MESH),
    ("plymesh", PLY_MESH),
    ("bilinearmesh", BILINEAR_MESH),
    ("loopsubdiv", LOOP_SUBDIVISION),
];

/// Shapes of pbrt-v4 that are left out with a warning.
const MISSING_SHAPES: &[&str] = &["curve"];

macro_rules! spec {
    ($name:literal, $kind:literal, $default:literal, $unit:literal, $doc:literal) => {
        ParameterSpec { name: $name, kind: $kind, default: $default, unit: $unit, doc: $doc }
    };
}

const ALPHA: ParameterSpec = spec!("alpha", "float texture", "1", "", "share of rays that meet the surface");
const PHI_MAX: ParameterSpec = spec!("phimax", "float", "360", "degrees", "largest azimuth");
const SPHERE: &[ParameterSpec] = &[
    spec!("radius", "float", "1", "m", "radius"),
    spec!("zmin", "float", "-radius", "m", "lower cut"),
    spec!("zmax", "float", "radius", "m", "upper cut"),
    PHI_MAX,
    ALPHA,
];
const DISK: &[ParameterSpec] = &[
    spec!("height", "float", "0", "m", "z of the disk"),
    spec!("radius", "float", "1", "m", "outer radius"),
    spec!("innerradius", "float", "0", "m", "radius of the hole"),
    PHI_MAX,
    ALPHA,
];
const CYLINDER: &[ParameterSpec] = &[
    spec!("radius", "float", "1", "m", "radius"),
    spec!("zmin", "float", "-1", "m", "lower end"),
    spec!("zmax", "float", "1", "m", "upper end"),
    PHI_MAX,
    ALPHA,
];
const TRIANGLE_MESH: &[ParameterSpec] = &[
    spec!("P", "point3", "", "m", "vertex positions"),
    spec!("indices", "integer", "0 1 2", "", "three vertices for each triangle"),
    spec!("N", "normal", "", "", "vertex normals"),
    spec!("S", "vector", "", "", "vertex tangents"),
    spec!("uv", "point2", "", "", "vertex texture coordinates"),
    spec!("faceIndices", "integer", "", "", "a number for each face"),
    ALPHA,
];
const PLY_MESH: &[ParameterSpec] = &[
    spec!("filename", "string", "", "", "PLY file, plain or gzipped; quadrilaterals become bilinear patches"),
    ALPHA,
];
const BILINEAR_MESH: &[ParameterSpec] = &[
    spec!("P", "point3", "", "m", "vertex positions"),
    spec!("indices", "integer", "0 1 2 3", "", "four vertices for each patch: (0,0) (1,0) (0,1) (1,1)"),
    spec!("N", "normal", "", "", "vertex normals"),
    spec!("uv", "point2", "", "", "vertex texture coordinates"),
    spec!("faceIndices", "integer", "", "", "a number for each patch"),
    ALPHA,
];
const LOOP_SUBDIVISION: &[ParameterSpec] = &[
    spec!("P", "point3", "", "m", "vertices of the control mesh"),
    spec!("indices", "integer", "", "", "three vertices for each face"),
    spec!("levels", "integer", "3", "", "subdivision steps, at most 10"),
    ALPHA,
];

/// Loop subdivision multiplies faces by four at each step; more than this exhausts memory.
const MAX_SUBDIVISION_LEVELS: i32 = 10;

/// Where the shapes of an entity go.
#[derive(Clone, Copy, Debug)]
pub(super) enum Target {
    /// The world.
    World,
    /// An object that instances repeat.
    Object(ObjectId),
}

/// A geometry that emits, to be made a light once the geometry is built.
#[derive(Clone, Copy, Debug)]
pub(super) struct Emitter {
    pub(super) geometry: GeometryId,
    /// Index into the document's area lights.
    pub(super) area_light: usize,
}

/// Meshes from files, moved out at their last use and copied before.
#[derive(Debug, Default)]
pub(super) struct MeshStore {
    meshes: HashMap<String, (LoadedMesh, usize)>,
}

impl MeshStore {
    pub(super) fn new<'d>(
        mut loaded: HashMap<String, LoadedMesh>,
        shapes: impl Iterator<Item = &'d ShapeEntity>,
    ) -> Self {
        let mut meshes: HashMap<String, (LoadedMesh, usize)> = HashMap::new();
        for shape in shapes {
            let Some(name) = mesh_file(shape) else { continue };
            if let Some(entry) = meshes.get_mut(name) {
                entry.1 += 1;
            } else if let Some(mesh) = loaded.remove(name) {
                meshes.insert(name.to_owned(), (mesh, 1));
            }
        }
        Self { meshes }
    }

    fn take(&mut self, name: &str) -> Option<LoadedMesh> {
        let entry = self.meshes.get_mut(name)?;
        entry.1 -= 1;
        if entry.1 > 0 {
            return Some(entry.0.clone());
        }
        self.meshes.remove(name).map(|(mesh, _)| mesh)
    }
}

fn mesh_file(shape: &ShapeEntity) -> Option<&str> {
    let parameter = shape.entity.parameters.iter().find(|p| p.name == "filename")?;
    match &parameter.value {
        crate::document::Value::Strings(names) if shape.entity.type_name == "plymesh" => {
            names.first().map(String::as_str)
        }
        _ => None,
    }
}

impl Builder<'_, '_> {
    /// Adds the shapes of an entity to the geometry, with their attributes.
    pub(super) fn add_shape(
        &mut self,
        entity: &ShapeEntity,
        target: Target,
        geometry: &mut GeometryBuilder,
        meshes: &mut MeshStore,
    ) {
        let mut p = Parameters::new(&entity.entity, &mut self.context);
        let alpha = p.float_texture("alpha", 1.0);
        let shapes = read_shapes(&mut p, meshes);
        p.finish();
        if shapes.is_empty() {
            return;
        }
        let material = self.material(&entity.material);
        let emits = self.check_emission(entity, target);
        for shape in shapes {
            let id = match target {
                Target::World => geometry.add(shape, &entity.world_from_object, entity.reverse_orientation),
                Target::Object(object) => {
                    let transform = entity.world_from_object.start;
                    geometry.add_to_object(object, shape, &transform, entity.reverse_orientation)
                }
            };
            debug_assert_eq!(id.0 as usize, self.attributes.len());
            let alpha = (alpha != FloatTexture::Constant(1.0)).then_some(alpha);
            self.attributes.push(ShapeAttributes { material, alpha, first_light: None });
            if let Some(area_light) = emits {
                self.emitters.push(Emitter { geometry: id, area_light });
            }
        }
    }

    fn material(&mut self, reference: &MaterialReference) -> MaterialId {
        match reference {
            MaterialReference::Index(index) => self.material_ids[*index],
            MaterialReference::Name(name, span) => {
                if let Some(id) = self.named_materials.get(name) {
                    return *id;
                }
                let names: Vec<String> = self.named_materials.keys().cloned().collect();
                unknown_name(
                    &mut self.context.diagnostics,
                    *span,
                    "material",
                    name,
                    names.iter().map(String::as_str),
                );
                DEFAULT_MATERIAL
            }
        }
    }

    fn check_emission(&mut self, entity: &ShapeEntity, target: Target) -> Option<usize> {
        let area_light = entity.area_light?;
        let span = entity.entity.span;
        if matches!(target, Target::Object(_)) {
            self.context
                .diagnostics
                .warning(span, "shapes of an object cannot be lights; the area light is ignored here")
                .with_help("place the emitting shape outside of ObjectBegin and ObjectEnd");
            return None;
        }
        if entity.world_from_object.is_animated() {
            self.context
                .diagnostics
                .warning(span, "a moving shape cannot be a light; the area light is ignored here");
            return None;
        }
        Some(area_light)
    }
}

fn read_shapes(p: &mut Parameters<'_, '_>, meshes: &mut MeshStore) -> Vec<Shape> {
    match p.entity().type_name.as_str() {
        "sphere" => vec![read_sphere(p)],
        "disk" => vec![read_disk(p)],
        "cylinder" => vec![read_cylinder(p)],
        "trianglemesh" => read_triangle_mesh(p).map(Shape::Triangles).into_iter().collect(),
        "plymesh" => read_ply_mesh(p, meshes),
        "bilinearmesh" => read_bilinear_mesh(p).map(Shape::Bilinear).into_iter().collect(),
        "loopsubdiv" => read_loop_subdivision(p).into_iter().collect(),
        missing if MISSING_SHAPES.contains(&missing) => {
            let message = format!("the shape \"{missing}\" is not available yet; it is left out");
            let span = p.span();
            p.diagnostics().warning(span, message);
            p.accept_all();
            Vec::new()
        }
        unknown => {
            let span = p.span();
            unknown_name(p.diagnostics(), span, "shape", unknown, known_names(SHAPES));
            p.accept_all();
            Vec::new()
        }
    }
}

fn positive_radius(p: &mut Parameters<'_, '_>) -> f32 {
    let radius = p.float("radius", 1.0);
    if radius > 0.0 && radius.is_finite() {
        return radius;
    }
    let span = p.span_of("radius");
    p.diagnostics().error(span, format!("\"radius\" must be positive, not {radius}"));
    1.0
}

fn phi_max(p: &mut Parameters<'_, '_>) -> f32 {
    p.float("phimax", 360.0).clamp(0.0, 360.0).to_radians()
}

fn read_sphere(p: &mut Parameters<'_, '_>) -> Shape {
    let radius = positive_radius(p);
    let z_min = p.float("zmin", -radius);
    let z_max = p.float("zmax", radius);
    Shape::Sphere { radius, z_min: z_min.min(z_max), z_max: z_max.max(z_min), phi_max_rad: phi_max(p) }
}

fn read_disk(p: &mut Parameters<'_, '_>) -> Shape {
    let radius = positive_radius(p);
    let height = p.float("height", 0.0);
    let inner_radius = p.float("innerradius", 0.0);
    Shape::Disk { height, radius, inner_radius, phi_max_rad: phi_max(p) }
}

fn read_cylinder(p: &mut Parameters<'_, '_>) -> Shape {
    let radius = positive_radius(p);
    let z_min = p.float("zmin", -1.0);
    let z_max = p.float("zmax", 1.0);
    Shape::Cylinder { radius, z_min: z_min.min(z_max), z_max: z_max.max(z_min), phi_max_rad: phi_max(p) }
}

/// Integers of a parameter as groups of N vertex numbers; a remainder or a negative number is reported.
fn read_indices<const N: usize>(p: &mut Parameters<'_, '_>, default: [u32; N]) -> Option<Vec<[u32; N]>> {
    let Some(values) = p.integers("indices") else {
        return Some(vec![default]);
    };
    let span = p.span_of("indices");
    let (groups, rest) = values.as_chunks::<N>();
    if !rest.is_empty() {
        let message = format!("\"indices\" has {} numbers, not a multiple of {N}", values.len());
        p.diagnostics().error(span, message);
        return None;
    }
    if let Some(negative) = values.iter().find(|v| **v < 0) {
        p.diagnostics().error(span, format!("\"indices\" has the negative number {negative}"));
        return None;
    }
    Some(groups.iter().map(|group| group.map(|v| v as u32)).collect())
}

/// An optional vertex attribute; a count that differs from that of the vertices is reported and drops it.
fn per_vertex<T: Clone>(
    p: &mut Parameters<'_, '_>,
    name: &'static str,
    values: Option<&[T]>,
    n_vertices: usize,
) -> Vec<T> {
    let values = values.unwrap_or_default();
    if values.is_empty() || values.len() == n_vertices {
        return values.to_vec();
    }
    let span = p.span_of(name);
    let message = format!("\"{name}\" has {} values for {n_vertices} vertices; it is ignored", values.len());
    p.diagnostics().warning(span, message);
    Vec::new()
}

/// Texture coordinates, as points or as plain floats in pairs.
fn read_uvs(p: &mut Parameters<'_, '_>, n_vertices: usize) -> Vec<Point2> {
    let name = if p.has("st") && !p.has("uv") { "st" } else { "uv" };
    let pairs: Option<Vec<Point2>> = match p.find(name).map(|parameter| &parameter.value) {
        Some(crate::document::Value::Floats(values)) => {
            Some(values.as_chunks::<2>().0.iter().map(|[u, v]| Point2::new(*u, *v)).collect())
        }
        _ => p.points2(name).map(<[Point2]>::to_vec),
    };
    per_vertex(p, name, pairs.as_deref(), n_vertices)
}

fn read_face_indices(p: &mut Parameters<'_, '_>) -> Vec<i32> {
    p.integers("faceIndices").unwrap_or_default().to_vec()
}

fn report_mesh<E: std::fmt::Display>(
    p: &mut Parameters<'_, '_>,
    span: Option<Span>,
    result: Result<(), E>,
) -> Option<()> {
    match result {
        Ok(()) => Some(()),
        Err(error) => {
            p.diagnostics().error(span, error.to_string());
            None
        }
    }
}

fn read_triangle_mesh(p: &mut Parameters<'_, '_>) -> Option<TriangleMesh> {
    let positions = p.points3("P").unwrap_or_default().to_vec();
    if positions.is_empty() {
        let span = p.span();
        p.diagnostics().error(span, "a triangle mesh needs vertex positions \"P\"");
        return None;
    }
    if !p.has("indices") && positions.len() != 3 {
        let span = p.span();
        p.diagnostics().error(span, "a triangle mesh of more than one triangle needs \"indices\"");
        return None;
    }
    let n = positions.len();
    let indices = read_indices::<3>(p, [0, 1, 2]);
    let normals: Option<&[Normal3]> = p.normals3("N");
    let normals = per_vertex(p, "N", normals, n);
    let tangents: Option<&[Vector3]> = p.vectors3("S");
    let tangents = per_vertex(p, "S", tangents, n);
    let uvs = read_uvs(p, n);
    let face_indices = read_face_indices(p);
    let mesh = TriangleMesh { positions, indices: indices?, normals, tangents, uvs, face_indices };
    let span = p.span();
    report_mesh(p, span, mesh.validate())?;
    Some(mesh)
}

fn read_bilinear_mesh(p: &mut Parameters<'_, '_>) -> Option<BilinearMesh> {
    let positions = p.points3("P").unwrap_or_default().to_vec();
    if positions.is_empty() {
        let span = p.span();
        p.diagnostics().error(span, "a bilinear mesh needs vertex positions \"P\"");
        return None;
    }
    let n = positions.len();
    let indices = read_indices::<4>(p, [0, 1, 2, 3]);
    let normals: Option<&[Normal3]> = p.normals3("N");
    let normals = per_vertex(p, "N", normals, n);
    let uvs = read_uvs(p, n);
    let face_indices = read_face_indices(p);
    if p.has("emissionfilename") {
        p.ignore("emissionfilename");
        let span = p.span_of("emissionfilename");
        p.diagnostics().warning(span, "\"emissionfilename\" only guides sampling; it is not used");
    }
    let mesh = BilinearMesh { positions, indices: indices?, normals, uvs, face_indices };
    let span = p.span();
    report_mesh(p, span, mesh.validate())?;
    Some(mesh)
}

fn read_loop_subdivision(p: &mut Parameters<'_, '_>) -> Option<Shape> {
    let levels = p.integer("levels", 3);
    p.ignore("scheme");
    let mesh = read_triangle_mesh(p)?;
    if !(0..=MAX_SUBDIVISION_LEVELS).contains(&levels) {
        let span = p.span_of("levels");
        p.diagnostics()
            .error(span, format!("\"levels\" must lie in 0..{MAX_SUBDIVISION_LEVELS}, not {levels}"));
        return None;
    }
    Some(Shape::Triangles(loop_subdivide(&mesh, levels as u32)))
}

fn read_ply_mesh(p: &mut Parameters<'_, '_>, meshes: &mut MeshStore) -> Vec<Shape> {
    for (name, what) in [("displacement", "displacement is not available yet"), ("edgelength", "")] {
        if p.has(name) {
            p.ignore(name);
            let span = p.span_of(name);
            if !what.is_empty() {
                p.diagnostics().warning(span, format!("{what}; \"{name}\" is ignored"));
            }
        }
    }
    let Some(name) = p.string_opt("filename") else {
        let span = p.span();
        p.diagnostics().error(span, "a \"plymesh\" needs a \"filename\"");
        return Vec::new();
    };
    // A file that could not be read was reported when it was loaded.
    let Some(mesh) = meshes.take(&name) else {
        return Vec::new();
    };
    split_loaded_mesh(p, mesh)
}

/// Triangles and quadrilaterals of a file as separate shapes.
fn split_loaded_mesh(p: &mut Parameters<'_, '_>, mesh: LoadedMesh) -> Vec<Shape> {
    let LoadedMesh { triangles, quads, positions, normals, uvs, mut face_indices } = mesh;
    let quad_faces = if face_indices.len() > triangles.len() {
        face_indices.split_off(triangles.len())
    } else {
        Vec::new()
    };
    let span = p.span_of("filename");
    let mut shapes = Vec::new();
    if !quads.is_empty() {
        let patches = BilinearMesh {
            positions: positions.clone(),
            indices: quads,
            normals: normals.clone(),
            uvs: uvs.clone(),
            face_indices: quad_faces,
        };
        if report_mesh(p, span, patches.validate()).is_some() {
            shapes.push(Shape::Bilinear(patches));
        }
    }
    if !triangles.is_empty() {
        let mesh =
            TriangleMesh { positions, indices: triangles, normals, tangents: Vec::new(), uvs, face_indices };
        if report_mesh(p, span, mesh.validate()).is_some() {
            shapes.push(Shape::Triangles(mesh));
        }
    }
    shapes
}
