//! Shapes: from entities to geometry, with the attributes that geometry does not know.

use etendue_geometry::{CurveSet, GeometryBuilder, GeometryId, ObjectId, Shape};
use etendue_math::Motion;

use crate::controls::SHAPE_CONTROLS;
use crate::document::{Document, MaterialReference, ShapeEntity, Value};
use crate::material::MaterialId;
use crate::parameters::{ParameterSpec, Parameters, spec};
use crate::scene::ShapeAttributes;
use crate::texture::{FloatTexture, MeshAttributes};

use super::curves::{CURVE, belong_together, read_curves};
use super::expressions;
use super::formulas;
use super::heights::{
    DISPLACEMENT, EDGE_LENGTH, FRACTAL, HEIGHT_FIELD, read_displacement, read_fractal, read_height_field,
};
use super::materials::DEFAULT_MATERIAL;
use super::meshes::{
    MeshStore, read_bilinear_mesh, read_loop_subdivision, read_ply_mesh, read_triangle_mesh,
};
use super::motion::{FILENAME_1, N1, P1, moved};
use super::point_cloud::{POINTS, read_points};
use super::revolution::{REVOLUTION, read_revolution};
use super::{Builder, known_names};

/// Shape types with their parameters.
pub const SHAPES: &[(&str, &[ParameterSpec])] = &[
    ("sphere", SPHERE),
    ("disk", DISK),
    ("cylinder", CYLINDER),
    ("cone", formulas::CONE),
    ("paraboloid", formulas::PARABOLOID),
    ("hyperboloid", formulas::HYPERBOLOID),
    ("torus", formulas::TORUS),
    ("plane", formulas::PLANE),
    ("implicit", expressions::IMPLICIT),
    ("parametric", expressions::PARAMETRIC),
    ("trianglemesh", TRIANGLE_MESH),
    ("plymesh", PLY_MESH),
    ("bilinearmesh", BILINEAR_MESH),
    ("loopsubdiv", LOOP_SUBDIVISION),
    ("revolution", REVOLUTION),
    ("heightfield", HEIGHT_FIELD),
    ("fractal", FRACTAL),
    ("curve", CURVE),
    ("points", POINTS),
];

pub(super) const ALPHA: ParameterSpec = spec(
    "alpha",
    "float texture",
    "1",
    "",
    "share of rays that meet the surface; 0 makes an emissive surface an invisible light",
);
pub(super) const PHI_MAX: ParameterSpec = spec("phimax", "float", "360", "degrees", "largest azimuth");
const SPHERE: &[ParameterSpec] = &[
    spec("radius", "float", "1", "m", "radius"),
    spec("zmin", "float", "-radius", "m", "lower cut"),
    spec("zmax", "float", "radius", "m", "upper cut"),
    PHI_MAX,
    ALPHA,
];
const DISK: &[ParameterSpec] = &[
    spec("height", "float", "0", "m", "z of the disk"),
    spec("radius", "float", "1", "m", "outer radius"),
    spec("innerradius", "float", "0", "m", "radius of the hole"),
    PHI_MAX,
    ALPHA,
];
const CYLINDER: &[ParameterSpec] = &[
    spec("radius", "float", "1", "m", "radius"),
    spec("zmin", "float", "-1", "m", "lower end"),
    spec("zmax", "float", "1", "m", "upper end"),
    PHI_MAX,
    ALPHA,
];
const TRIANGLE_MESH: &[ParameterSpec] = &[
    spec("P", "point3", "", "m", "vertex positions"),
    spec("indices", "integer", "0 1 2", "", "three vertices for each triangle"),
    spec("N", "normal", "", "", "vertex normals"),
    spec("S", "vector", "", "", "vertex tangents"),
    spec("uv", "point2", "", "", "vertex texture coordinates"),
    spec("faceIndices", "integer", "", "", "a number for each face"),
    P1,
    N1,
    DISPLACEMENT,
    EDGE_LENGTH,
    ALPHA,
];
const PLY_MESH: &[ParameterSpec] = &[
    spec("filename", "string", "", "", "PLY file, plain or gzipped; quadrilaterals become bilinear patches"),
    FILENAME_1,
    DISPLACEMENT,
    EDGE_LENGTH,
    ALPHA,
];
const BILINEAR_MESH: &[ParameterSpec] = &[
    spec("P", "point3", "", "m", "vertex positions"),
    spec("indices", "integer", "0 1 2 3", "", "four vertices for each patch: (0,0) (1,0) (0,1) (1,1)"),
    spec("N", "normal", "", "", "vertex normals"),
    spec("uv", "point2", "", "", "vertex texture coordinates"),
    spec("faceIndices", "integer", "", "", "a number for each patch"),
    ALPHA,
];
const LOOP_SUBDIVISION: &[ParameterSpec] = &[
    spec("P", "point3", "", "m", "vertices of the control mesh"),
    spec("indices", "integer", "", "", "three vertices for each face"),
    spec("levels", "integer", "3", "", "subdivision steps, at most 10"),
    ALPHA,
];

/// Where the shapes of an entity go.
#[derive(Clone, Copy, Debug)]
pub(super) enum Target {
    /// The world.
    World,
    /// An object that instances repeat.
    Object(ObjectId),
    /// An object that is used once, by the moving instance of that index.
    Moving(ObjectId, usize),
}

/// A geometry that emits, to be made a light once the geometry is built.
#[derive(Clone, Debug)]
pub(super) struct Emitter {
    pub(super) geometry: GeometryId,
    /// Index into the document's area lights.
    pub(super) area_light: usize,
    /// From the space of the geometry to the world, if it moves.
    pub(super) motion: Option<Box<Motion>>,
}

impl Builder<'_, '_> {
    /// Adds the shapes of entities to the geometry, with their attributes.
    pub(super) fn add_shapes(
        &mut self,
        entities: &[ShapeEntity],
        target: Target,
        geometry: &mut GeometryBuilder,
        meshes: &mut MeshStore,
    ) {
        // Files with hair have a shape for each strand.
        for run in entities.chunk_by(belong_together) {
            let mut joined: Option<(Option<FloatTexture>, CurveSet)> = None;
            for entity in run {
                let (alpha, shapes) = self.read_shape(entity, meshes);
                for shape in shapes {
                    match (&mut joined, shape) {
                        (Some((first, all)), Shape::Curves(set)) if all.accepts(&set) && *first == alpha => {
                            all.curves.extend(set.curves);
                        }
                        (_, Shape::Curves(set)) if run.len() > 1 => {
                            if let Some((alpha, all)) = joined.replace((alpha, set)) {
                                self.place(entity, alpha, Shape::Curves(all), target, geometry, meshes);
                            }
                        }
                        (_, shape) => self.place(entity, alpha, shape, target, geometry, meshes),
                    }
                }
            }
            if let Some((alpha, all)) = joined {
                self.place(&run[0], alpha, Shape::Curves(all), target, geometry, meshes);
            }
        }
    }

    /// What an entity says; the attributes of its vertices are left in the store.
    fn read_shape(
        &mut self,
        entity: &ShapeEntity,
        meshes: &mut MeshStore,
    ) -> (Option<FloatTexture>, Vec<Shape>) {
        let mut p = Parameters::new(&entity.entity, &mut self.context);
        let alpha = p.float_texture_opt("alpha").filter(|alpha| *alpha != FloatTexture::Constant(1.0));
        meshes.attributes.clear();
        SHAPE_CONTROLS.iter().for_each(|control| p.ignore(control.name));
        let mut shapes = read_shapes(&mut p, meshes, &self.textures.mesh_attributes);
        if matches!(entity.entity.type_name.as_str(), "trianglemesh" | "plymesh") {
            let place = &entity.world_from_object;
            shapes = moved(&mut p, shapes, meshes, [place.start_time, place.end_time]);
            if let Some(displacement) = read_displacement(&mut p, edge_scale(self.document)) {
                meshes.attributes.clear();
                shapes = displacement.apply(&mut p, shapes, &self.textures, &place.start);
            }
        }
        p.finish();
        (alpha, shapes)
    }

    /// Adds a shape of an entity to the geometry.
    fn place(
        &mut self,
        entity: &ShapeEntity,
        alpha: Option<FloatTexture>,
        shape: Shape,
        target: Target,
        geometry: &mut GeometryBuilder,
        meshes: &mut MeshStore,
    ) {
        let material = self.material(&entity.material);
        let emits = self.check_emission(entity, target, material, shape.can_emit());
        self.check_motion(entity, target);
        let id = match target {
            Target::World => geometry.add(shape, &entity.world_from_object, entity.reverse_orientation),
            Target::Object(object) | Target::Moving(object, _) => {
                let transform = entity.world_from_object.start;
                geometry.add_to_object(object, shape, &transform, entity.reverse_orientation)
            }
        };
        debug_assert_eq!(id.0 as usize, self.attributes.len());
        if !meshes.attributes.is_empty() {
            self.textures.mesh_attributes.attach(id.0, meshes.attributes.remove(0));
        }
        let controls = self.controls.read(&mut Parameters::new(&entity.entity, &mut self.context));
        self.controls.add_shape(controls);
        self.attributes.push(ShapeAttributes { material, alpha, lights: None });
        if let Some(area_light) = emits {
            let place = match target {
                Target::Moving(_, instance) => &self.document.instances[instance].world_from_instance,
                Target::World | Target::Object(_) => &entity.world_from_object,
            };
            let motion = place.is_animated().then(|| Box::new(place.motion()));
            self.emitters.push(Emitter { geometry: id, area_light, motion });
        }
    }

    fn material(&mut self, reference: &MaterialReference) -> MaterialId {
        match reference {
            MaterialReference::Index(index) => self.material_ids[*index],
            MaterialReference::Name(name, span) => {
                if let Some(id) = self.named_materials.get(name) {
                    return *id;
                }
                let known = self.named_materials.keys().map(String::as_str);
                self.context.diagnostics.unknown_name(*span, "material", name, known);
                DEFAULT_MATERIAL
            }
        }
    }

    /// The area light of an entity, if its shapes can be lights.
    fn check_emission(
        &mut self,
        entity: &ShapeEntity,
        target: Target,
        material: MaterialId,
        can_emit: bool,
    ) -> Option<usize> {
        let area_light = entity.area_light?;
        let (problem, help) = if matches!(target, Target::Object(_)) {
            ("shapes of an object cannot be lights", "place the shape outside of ObjectBegin and ObjectEnd")
        } else if !can_emit {
            (
                "implicit surfaces, meshes that deform, curves and points cannot be lights",
                "give the light to another shape; a \"parametric\" surface can have one",
            )
        } else if self.materials.is_interface(material) {
            (
                "the boundary of a medium cannot be a light",
                "give the shape another material than \"interface\"",
            )
        } else {
            return Some(area_light);
        };
        let message = format!("{problem}; the area light is ignored here");
        self.context.diagnostics.warning(entity.entity.span, message).with_help(help);
        None
    }

    fn check_motion(&mut self, entity: &ShapeEntity, target: Target) {
        if !matches!(target, Target::World) && entity.world_from_object.is_animated() {
            let message = "shapes of an object cannot move within it; this one stays where it starts";
            self.context.diagnostics.warning(entity.entity.span, message);
        }
    }
}

/// The option `displacementedgescale`, a factor of all edge lengths.
fn edge_scale(document: &Document) -> f32 {
    let option = document.options.iter().find(|option| option.name == "displacementedgescale");
    match option.map(|option| &option.value) {
        Some(Value::Floats(values)) => values.first().copied().unwrap_or(1.0),
        _ => 1.0,
    }
}

fn read_shapes(
    p: &mut Parameters<'_, '_>,
    meshes: &mut MeshStore,
    attributes: &MeshAttributes,
) -> Vec<Shape> {
    match p.entity().type_name.as_str() {
        "sphere" => vec![read_sphere(p)],
        "disk" => vec![read_disk(p)],
        "cylinder" => vec![read_cylinder(p)],
        "cone" => vec![formulas::read_cone(p)],
        "paraboloid" => vec![formulas::read_paraboloid(p)],
        "hyperboloid" => vec![formulas::read_hyperboloid(p)],
        "torus" => vec![formulas::read_torus(p)],
        "plane" => vec![formulas::read_plane(p)],
        "implicit" => expressions::read_implicit(p).into_iter().collect(),
        "parametric" => expressions::read_parametric(p).into_iter().collect(),
        "trianglemesh" => read_triangle_mesh(p).map(Shape::Triangles).into_iter().collect(),
        "plymesh" => read_ply_mesh(p, meshes, attributes),
        "bilinearmesh" => read_bilinear_mesh(p).map(Shape::Bilinear).into_iter().collect(),
        "loopsubdiv" => read_loop_subdivision(p).into_iter().collect(),
        "revolution" => read_revolution(p).into_iter().collect(),
        "heightfield" => read_height_field(p).into_iter().collect(),
        "fractal" => read_fractal(p, meshes, attributes),
        "curve" => read_curves(p).map(Shape::Curves).into_iter().collect(),
        "points" => read_points(p, meshes).into_iter().collect(),
        unknown => {
            let span = p.span();
            p.diagnostics().unknown_name(span, "shape", unknown, known_names(SHAPES));
            p.accept_all();
            Vec::new()
        }
    }
}

/// A positive number with a default; others are reported.
pub(super) fn positive(p: &mut Parameters<'_, '_>, name: &'static str, default: f32) -> f32 {
    let value = p.float(name, default);
    if value > 0.0 && value.is_finite() {
        return value;
    }
    let span = p.span_of(name);
    p.diagnostics().error(span, format!("\"{name}\" must be positive, not {value}"));
    default
}

pub(super) fn phi_max(p: &mut Parameters<'_, '_>) -> f32 {
    p.float("phimax", 360.0).clamp(0.0, 360.0).to_radians()
}

fn read_sphere(p: &mut Parameters<'_, '_>) -> Shape {
    let radius = positive(p, "radius", 1.0);
    let z_min = p.float("zmin", -radius);
    let z_max = p.float("zmax", radius);
    Shape::Sphere { radius, z_min: z_min.min(z_max), z_max: z_max.max(z_min), phi_max_rad: phi_max(p) }
}

fn read_disk(p: &mut Parameters<'_, '_>) -> Shape {
    let radius = positive(p, "radius", 1.0);
    let height = p.float("height", 0.0);
    let inner_radius = p.float("innerradius", 0.0);
    Shape::Disk { height, radius, inner_radius, phi_max_rad: phi_max(p) }
}

fn read_cylinder(p: &mut Parameters<'_, '_>) -> Shape {
    let radius = positive(p, "radius", 1.0);
    let z_min = p.float("zmin", -1.0);
    let z_max = p.float("zmax", 1.0);
    Shape::Cylinder { radius, z_min: z_min.min(z_max), z_max: z_max.max(z_min), phi_max_rad: phi_max(p) }
}
