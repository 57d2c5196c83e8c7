//! Shapes and their instances.

use etendue_math::{AnimatedTransform, Point2, Point3, Transform, Vector3};
use etendue_scene::document::{
    EmbeddedFile, Entity, InstanceEntity, MaterialReference, ObjectEntity, ShapeEntity, Value,
};
use etendue_scene::{LoadedMesh, Span};

use super::element::Element;
use super::meshes::{Format, MeshRequest};
use super::reader::{Reader, entity, parameter};
use super::values::vector;

const KNOWN: &[&str] = &[
    "obj",
    "ply",
    "serialized",
    "sphere",
    "cube",
    "rectangle",
    "disk",
    "cylinder",
    "instance",
    "shapegroup",
    "merge",
];
const MISSING: &[&str] = &[
    "hair",
    "heightfield",
    "linearcurve",
    "bsplinecurve",
    "sdfgrid",
    "deformable",
    "blender",
    "gaussians",
    "ellipsoids",
    "ellipsoidsmesh",
];

/// Elements that merged shapes may have beyond one for each of the scene: more come from references alone.
const MAX_REPEATED: usize = 1 << 20;

/// Faces of the cube [-1, 1]^3: corner at u = v = 0, then what u and v add, counter-clockwise from outside.
const CUBE: [[[f32; 3]; 3]; 6] = [
    [[-1.0, -1.0, 1.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]],
    [[1.0, -1.0, -1.0], [-2.0, 0.0, 0.0], [0.0, 2.0, 0.0]],
    [[1.0, -1.0, 1.0], [0.0, 0.0, -2.0], [0.0, 2.0, 0.0]],
    [[-1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [0.0, 2.0, 0.0]],
    [[-1.0, 1.0, 1.0], [2.0, 0.0, 0.0], [0.0, 0.0, -2.0]],
    [[-1.0, -1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0]],
];

impl<'e> Reader<'e> {
    /// The shapes of an element, in the world.
    pub(super) fn shape(&mut self, shape: &'e Element) {
        match shape.plugin() {
            "instance" => self.instance(shape),
            "shapegroup" => self.shape_group(shape),
            "merge" => {
                self.guarded(shape, |reader| {
                    for inner in reader.nested(shape, "shape") {
                        if reader.may_merge(inner) {
                            reader.shape(inner);
                        }
                    }
                    reader.finish(shape);
                    Some(())
                });
            }
            _ => {
                if let Some(shape) = self.single_shape(shape) {
                    self.document.shapes.push(shape);
                }
            }
        }
    }

    /// Whether a merged shape may be read: since merges can refer to merges, a few lines could stand for any number.
    fn may_merge(&mut self, inner: &'e Element) -> bool {
        let most = self.files.n_elements + MAX_REPEATED;
        let was_over = self.n_merged > most;
        self.n_merged = self.n_merged.saturating_add(inner.n_elements());
        let is_over = self.n_merged > most;
        if is_over && !was_over {
            let message = "the references of merged shapes lead to too many shapes; the rest is left out";
            self.diagnostics.error(inner.plugin_span(), message);
        }
        !is_over
    }

    fn single_shape(&mut self, shape: &'e Element) -> Option<ShapeEntity> {
        let to_world = self.transform(shape, "to_world");
        let (entity, local) = self.geometry(shape)?;
        let (material, alpha) = match self.nested(shape, "bsdf").first().copied() {
            Some(bsdf) => self.material(bsdf),
            None => (MaterialReference::Index(0), None),
        };
        let [inside_medium, outside_medium] =
            ["interior", "exterior"].map(|name| self.medium_name(shape, name));
        let mut made = ShapeEntity {
            entity,
            world_from_object: AnimatedTransform {
                start: to_world.start * local,
                end: to_world.end * local,
                ..to_world
            },
            reverse_orientation: self.boolean(shape, "flip_normals", false),
            material,
            area_light: None,
            has_medium_interface: !inside_medium.is_empty() || !outside_medium.is_empty(),
            inside_medium,
            outside_medium,
        };
        if let Some(alpha) = alpha {
            made.entity.parameters.push(parameter("alpha", alpha, shape.span));
        }
        if let Some(emitter) = self.nested(shape, "emitter").first().copied() {
            made.area_light = self.area_light(emitter);
        }
        self.finish(shape);
        Some(made)
    }

    /// The name of the medium on a side, empty for none.
    fn medium_name(&mut self, shape: &'e Element, side: &'static str) -> String {
        let Some(property) = self.property(shape, side) else { return String::new() };
        match self.resolved(property) {
            Some(medium) if medium.tag == "medium" => self.medium(medium),
            Some(_) => {
                self.diagnostics.error(property.span, format!("`{side}` is not a medium"));
                String::new()
            }
            None => String::new(),
        }
    }

    /// The entity of a shape, and the transform to the shape's own space.
    fn geometry(&mut self, shape: &'e Element) -> Option<(Entity, Transform)> {
        Some(match shape.plugin() {
            "sphere" => self.sphere(shape)?,
            "disk" => (entity("disk", shape), Transform::IDENTITY),
            "cylinder" => self.cylinder(shape)?,
            "rectangle" => {
                (quads(shape, &[[[-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]]]), Transform::IDENTITY)
            }
            "cube" => (quads(shape, &CUBE), Transform::IDENTITY),
            "obj" => (self.mesh(shape, Format::Obj)?, Transform::IDENTITY),
            "ply" => (self.mesh(shape, Format::Ply)?, Transform::IDENTITY),
            "serialized" => {
                let index = self.integer(shape, "shape_index", 0);
                (self.mesh(shape, Format::Serialized(index.max(0) as usize))?, Transform::IDENTITY)
            }
            _ => {
                self.unknown_plugin(shape, MISSING, KNOWN, "it is left out");
                return None;
            }
        })
    }

    /// Mirrored along z, so that v runs as it does on all our shapes.
    fn sphere(&mut self, shape: &'e Element) -> Option<(Entity, Transform)> {
        let center = self.triple(shape, "center", [0.0; 3]);
        let (radius, span) = self.positive(shape, "radius", 1.0);
        let mirror = Transform::scale(1.0, 1.0, -1.0)?;
        let mut sphere = entity("sphere", shape);
        sphere.parameters.push(parameter("radius", Value::Floats(vec![radius]), span));
        Some((sphere, Transform::translate(vector(center)) * mirror))
    }

    /// From `p0` to `p1`, mirrored for the same reason.
    fn cylinder(&mut self, shape: &'e Element) -> Option<(Entity, Transform)> {
        let [p0, p1] = [("p0", [0.0; 3]), ("p1", [0.0, 0.0, 1.0])]
            .map(|(name, default)| vector(self.triple(shape, name, default)));
        let (radius, span) = self.positive(shape, "radius", 1.0);
        let axis = p1 - p0;
        let Some(z) = axis.try_normalized() else {
            self.diagnostics.error(shape.plugin_span(), "`p0` and `p1` of a cylinder must differ");
            return None;
        };
        let other = if z.x.abs() < 0.9 { Vector3::new(1.0, 0.0, 0.0) } else { Vector3::new(0.0, 1.0, 0.0) };
        // Without any need to turn, x stays x.
        let y = z.cross(other).normalized();
        let x = y.cross(z);
        let origin = p1;
        let placed = Transform::from_rows([
            [x.x, y.x, -z.x, origin.x],
            [x.y, y.y, -z.y, origin.y],
            [x.z, y.z, -z.z, origin.z],
            [0.0, 0.0, 0.0, 1.0],
        ])?;
        let mut cylinder = entity("cylinder", shape);
        cylinder.parameters.push(parameter("radius", Value::Floats(vec![radius]), span));
        let cylinder =
            cylinder.with("zmin", Value::Floats(vec![0.0])).with("zmax", Value::Floats(vec![axis.length()]));
        Some((cylinder, placed))
    }

    fn positive(&mut self, shape: &'e Element, name: &'static str, default: f32) -> (f32, Span) {
        let span =
            shape.children.iter().find(|child| child.name == name).map_or(shape.span, |child| child.span);
        (self.float(shape, name, default), span)
    }

    /// A mesh of a file, which is read once all elements are known.
    fn mesh(&mut self, shape: &'e Element, format: Format) -> Option<Entity> {
        let Some((file, span)) = self.string(shape, "filename") else {
            let message = format!("the shape `{}` needs a `filename`", shape.plugin());
            self.diagnostics.error(shape.plugin_span(), message);
            return None;
        };
        let is_obj = format == Format::Obj;
        let request = MeshRequest {
            file: self.files.resolved(file),
            format,
            face_normals: self.boolean(shape, "face_normals", false),
            flip_v: !self.boolean(shape, "flip_tex_coords", is_obj),
            span,
        };
        self.accept(shape, &["shape_name", "max_smooth_angle", "collapse", "srgb", "bvh_mode"]);
        let mut mesh = entity("plymesh", shape);
        // An empty mesh holds the place until the file is read.
        let name = self.document.embed(&request.part(), EmbeddedFile::Mesh(LoadedMesh::default().into()));
        mesh.parameters.push(parameter("filename", Value::Strings(vec![name.clone()]), span));
        self.meshes.push((name, request));
        Some(mesh)
    }

    fn shape_group(&mut self, group: &'e Element) {
        let name = Self::name_of(group);
        let mut shapes = Vec::new();
        for inner in self.nested(group, "shape") {
            let Some(shape) = self.single_shape(inner) else { continue };
            shapes.push(shape);
        }
        self.finish(group);
        self.document.objects.push(ObjectEntity { name, span: Some(group.span), shapes });
    }

    fn instance(&mut self, instance: &'e Element) {
        let world_from_instance = self.transform(instance, "to_world");
        let groups = self.nested(instance, "shape");
        let [group] = groups.as_slice() else {
            self.diagnostics
                .error(instance.plugin_span(), "an `instance` needs one reference to a `shapegroup`");
            self.finish(instance);
            return;
        };
        self.finish(instance);
        if group.plugin() != "shapegroup" {
            self.diagnostics.error(instance.plugin_span(), "an `instance` can only repeat a `shapegroup`");
            return;
        }
        self.document.instances.push(InstanceEntity {
            object: Self::name_of(group),
            span: Some(instance.span),
            world_from_instance,
        });
    }
}

/// Parallelograms as a mesh, with u and v in [0, 1] on each.
fn quads(shape: &Element, faces: &[[[f32; 3]; 3]]) -> Entity {
    let (mut positions, mut uvs, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for (face, [corner, along_u, along_v]) in faces.iter().enumerate() {
        for (u, v) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
            let at = |axis: usize| corner[axis] + u * along_u[axis] + v * along_v[axis];
            positions.push(Point3::new(at(0), at(1), at(2)));
            uvs.push(Point2::new(u, 1.0 - v));
        }
        let first = 4 * face as i32;
        indices.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
    }
    entity("trianglemesh", shape)
        .with("P", Value::Points3(positions))
        .with("indices", Value::Integers(indices))
        .with("uv", Value::Points2(uvs))
}
