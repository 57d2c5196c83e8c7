//! A camera, light and ground for files that bring none, so that any mesh makes a good picture.
//!
//! The camera looks from the right and from above, at a third of the way from the front to the side, and as near as
//! the body fits. A lamp like a large ball far away to the left gives soft shadows, and a pale sky fills them. All sizes
//! follow from the body's. Brightness is such that white in the light comes near 1.

use etendue_math::{AnimatedTransform, Point3, Transform, Vector3};
use etendue_scene::document::{
    CameraEntity, EmbeddedFile, Entity, LightEntity, MaterialEntity, MaterialReference, ShapeEntity, Value,
};
use etendue_scene::{Diagnostics, Document, LoadedMesh};

#[cfg(test)]
mod tests;

/// What the body stands on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ground {
    /// Nothing: scenes have their own.
    None,
    /// A wide grey disk below the lowest point.
    Disk,
}

/// Which way is up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Up {
    /// By convention of the format.
    Y,
    /// +y, or +z if the body says so: see [`up_of`].
    Guessed,
}

/// Faces of bare meshes that meet at a larger angle have an edge between them.
pub const CREASE_DEGREES: f32 = 40.0;

/// Horizontal and vertical angles of the camera's place in degrees: from the front to the right, and upwards.
const CAMERA: [f32; 2] = [30.0, 18.0];
/// The same of the lamp.
const LAMP: [f32; 2] = [-40.0, 50.0];
/// Distance and radius of the lamp in radii of the body: it is 14 degrees wide.
const LAMP_DISTANCE: f32 = 20.0;
const LAMP_RADIUS: f32 = 2.5;
/// Illuminance by the lamp on what faces it, and luminance of the sky.
const LAMP_ILLUMINANCE: f32 = 2.6;
const SKY: [f32; 3] = [0.32, 0.36, 0.42];
/// Full angle of view across the shorter side, in degrees.
const FOV: f32 = 35.0;
/// The body fills this share of the view.
const FILL: f32 = 0.88;
/// Vertices that are looked at.
const MAX_POINTS: usize = 200_000;

/// Gives a document what it lacks of camera and lights, and a ground if it has neither. Bodies without any extent are an
/// error.
pub fn set_stage(document: &mut Document, up: Up, ground: Ground, diagnostics: &mut Diagnostics) {
    let lacks_camera = document.camera.is_none();
    let lacks_light = document.lights.is_empty() && document.area_lights.is_empty();
    if !lacks_camera && !lacks_light {
        return;
    }
    let points = points_of(document);
    let Some(body) = Body::new(&points) else {
        diagnostics.error(None, "there is nothing to look at: the file has no faces of any extent");
        return;
    };
    let up = match up {
        Up::Y => Axes::Y_UP,
        Up::Guessed => up_of(document, &body),
    };
    if lacks_light {
        add_lights(document, &body, up);
        if ground == Ground::Disk {
            add_ground(document, &body, up);
        }
    }
    if lacks_camera {
        add_camera(document, &points, &body, up);
    }
    if document.sampler.is_none() {
        let sampler = Entity::new("sobol").with("pixelsamples", Value::Integers(vec![64]));
        document.sampler = Some(sampler);
    }
}

/// Extents of a body.
#[derive(Clone, Copy, Debug)]
struct Body {
    low: Point3,
    high: Point3,
    center: Point3,
    /// Half the diagonal of the box around it.
    radius: f32,
}

impl Body {
    fn new(points: &[Point3]) -> Option<Self> {
        let first = *points.first()?;
        let (low, high) = points.iter().fold((first, first), |(low, high), p| (low.min(*p), high.max(*p)));
        // Halves first, so that huge coordinates do not overflow.
        let half = (high - low) * 0.5;
        let radius = half.length();
        (radius > 0.0 && radius.is_finite()).then_some(Self { low, high, center: low + half, radius })
    }
}

/// Right, up and front of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Axes {
    right: Vector3,
    up: Vector3,
    front: Vector3,
}

impl Axes {
    const Y_UP: Self = Self {
        right: Vector3::new(1.0, 0.0, 0.0),
        up: Vector3::new(0.0, 1.0, 0.0),
        front: Vector3::new(0.0, 0.0, 1.0),
    };
    const Z_UP: Self = Self {
        right: Vector3::new(1.0, 0.0, 0.0),
        up: Vector3::new(0.0, 0.0, 1.0),
        front: Vector3::new(0.0, -1.0, 0.0),
    };

    /// The unit direction by angles in degrees: from the front to the right, and upwards.
    fn direction(&self, [azimuth, elevation]: [f32; 2]) -> Vector3 {
        let ((sa, ca), (se, ce)) = (azimuth.to_radians().sin_cos(), elevation.to_radians().sin_cos());
        (self.right * sa + self.front * ca) * ce + self.up * se
    }
}

/// Shapes of the world with their transforms, those of instances included.
fn placed_shapes(document: &Document) -> Vec<(&ShapeEntity, Transform)> {
    let mut placed: Vec<_> =
        document.shapes.iter().map(|shape| (shape, shape.world_from_object.start)).collect();
    for instance in &document.instances {
        let Some(object) = document.objects.iter().find(|object| object.name == instance.object) else {
            continue;
        };
        let world = instance.world_from_instance.start;
        placed.extend(object.shapes.iter().map(|shape| (shape, world * shape.world_from_object.start)));
        if placed.len() > MAX_POINTS {
            break;
        }
    }
    placed
}

fn mesh_of<'d>(document: &'d Document, shape: &ShapeEntity) -> Option<&'d LoadedMesh> {
    let parameter = shape.entity.parameters.iter().find(|p| p.name == "filename")?;
    let Value::Strings(names) = &parameter.value else { return None };
    match document.embedded.get(names.first()?)? {
        EmbeddedFile::Mesh(mesh) => Some(mesh),
        _ => None,
    }
}

/// Vertices of faces in the world, evenly thinned out if there are too many.
fn points_of(document: &Document) -> Vec<Point3> {
    let placed = placed_shapes(document);
    let meshes: Vec<_> = placed
        .iter()
        .filter_map(|(shape, world)| Some((mesh_of(document, shape)?, world)))
        .filter(|(mesh, _)| !mesh.triangles.is_empty() || !mesh.quads.is_empty())
        .collect();
    let n_points: usize = meshes.iter().map(|(mesh, _)| mesh.positions.len()).sum();
    let step = n_points.div_ceil(MAX_POINTS).max(1);
    let mut points = Vec::new();
    for (mesh, world) in meshes {
        points.extend(mesh.positions.iter().step_by(step).map(|p| world.point(*p)).filter(|p| p.is_finite()));
        if step > 1 {
            // What the steps miss must not stick out.
            let extremes = extreme_points(&mesh.positions);
            points.extend(extremes.into_iter().map(|p| world.point(p)).filter(|p| p.is_finite()));
        }
    }
    points
}

/// The points that are lowest and highest along each axis.
fn extreme_points(points: &[Point3]) -> Vec<Point3> {
    let keys: [fn(&Point3) -> f32; 3] = [|p| p.x, |p| p.y, |p| p.z];
    let mut found = Vec::new();
    for key in keys {
        found.extend(points.iter().min_by(|a, b| key(a).total_cmp(&key(b))));
        found.extend(points.iter().max_by(|a, b| key(a).total_cmp(&key(b))));
    }
    found
}

/// Which axis of a bare mesh points up. It is +y unless +z is likelier: the body is flat in z (less than a third of both
/// other extents, and y is not), or stands on a flat base in z and on none in y, or on the plane z = 0 and not on y = 0.
fn up_of(document: &Document, body: &Body) -> Axes {
    let size = body.high - body.low;
    let (least_xy, least_xz) = (size.x.min(size.y), size.x.min(size.z));
    if size.z * 3.0 < least_xy {
        return Axes::Z_UP;
    }
    if size.y * 3.0 < least_xz {
        return Axes::Y_UP;
    }
    let base = |axis: usize| base_share(document, body, axis);
    let (y, z) = (base(1), base(2));
    if (z > 0.2) != (y > 0.2) {
        return if z > 0.2 { Axes::Z_UP } else { Axes::Y_UP };
    }
    let stands = |low: f32, extent: f32| low.abs() < 5e-3 * extent;
    let (on_y, on_z) = (stands(body.low.y, size.y), stands(body.low.z, size.z));
    if on_z && !on_y { Axes::Z_UP } else { Axes::Y_UP }
}

/// Area of the faces that lie within a hundredth of the height of the lowest point and face down, as a share of the
/// rectangle below the body.
fn base_share(document: &Document, body: &Body, axis: usize) -> f32 {
    let along = |v: Vector3| [v.x, v.y, v.z][axis];
    let size = body.high - body.low;
    let limit = 0.01 * along(size);
    let mut area = 0.0_f64;
    for (shape, world) in placed_shapes(document) {
        let Some(mesh) = mesh_of(document, shape) else { continue };
        for triangle in &mesh.triangles {
            let at = |i: usize| mesh.positions.get(triangle[i] as usize).map(|p| world.point(*p));
            let (Some(a), Some(b), Some(c)) = (at(0), at(1), at(2)) else { continue };
            if [a, b, c].iter().all(|p| along(*p - body.low) <= limit) {
                area += f64::from(along((b - a).cross(c - a)).abs()) / 2.0;
            }
        }
    }
    let below = size.x * size.y * size.z / along(size);
    if below > 0.0 { (area / f64::from(below)) as f32 } else { 0.0 }
}

fn floats(values: &[f32]) -> Value {
    Value::Floats(values.to_vec())
}

fn shape(
    entity: Entity,
    place: Transform,
    material: MaterialReference,
    area_light: Option<usize>,
) -> ShapeEntity {
    ShapeEntity {
        entity,
        world_from_object: AnimatedTransform::constant(place),
        reverse_orientation: false,
        material,
        area_light,
        inside_medium: String::new(),
        outside_medium: String::new(),
        has_medium_interface: false,
    }
}

/// The lamp and the sky.
fn add_lights(document: &mut Document, body: &Body, axes: Axes) {
    let place = body.center + axes.direction(LAMP) * (LAMP_DISTANCE * body.radius);
    // A sphere of luminance L that is seen under the half angle a gives pi L sin(a)^2.
    let sine = LAMP_RADIUS / LAMP_DISTANCE;
    let luminance = LAMP_ILLUMINANCE / (std::f32::consts::PI * sine * sine);
    let light =
        Entity::new("diffuse").with("L", Value::Rgb(vec![[luminance, 0.97 * luminance, 0.92 * luminance]]));
    document.area_lights.push(light);
    let ball = Entity::new("sphere").with("radius", floats(&[LAMP_RADIUS * body.radius]));
    let lamp = Some(document.area_lights.len() - 1);
    let to_place = Transform::translate(place.as_vector());
    document.shapes.push(shape(ball, to_place, MaterialReference::Index(0), lamp));
    document.lights.push(LightEntity {
        entity: Entity::new("infinite").with("L", Value::Rgb(vec![SKY])),
        world_from_light: AnimatedTransform::constant(Transform::IDENTITY),
        outside_medium: String::new(),
    });
}

/// A disk that reaches the horizon, a little below the lowest point so that flat bases do not coincide with it.
fn add_ground(document: &mut Document, body: &Body, axes: Axes) {
    let low = axes.up.dot(body.low - body.center);
    let middle = body.center + axes.up * (low - 1e-4 * body.radius);
    let (x, y, z) = (axes.right, -axes.front, axes.up);
    let Some(place) = Transform::from_rows([
        [x.x, y.x, z.x, middle.x],
        [x.y, y.y, z.y, middle.y],
        [x.z, y.z, z.z, middle.z],
        [0.0, 0.0, 0.0, 1.0],
    ]) else {
        return;
    };
    let material = MaterialReference::Index(document.materials.len());
    let grey = Entity::new("diffuse").with("reflectance", Value::Rgb(vec![[0.42; 3]]));
    document.materials.push(MaterialEntity { name: None, entity: grey });
    let disk = Entity::new("disk").with("radius", floats(&[300.0 * body.radius]));
    document.shapes.push(shape(disk, place, material, None));
}

/// A perspective camera into whose view all points fit, and a film of their proportions.
fn add_camera(document: &mut Document, points: &[Point3], body: &Body, axes: Axes) {
    let back = axes.direction(CAMERA);
    let right = axes.up.cross(back).normalized();
    let up = back.cross(right);
    // Coordinates about the middle, so that distance costs no precision.
    let local: Vec<[f32; 3]> =
        points.iter().map(|p| *p - body.center).map(|d| [d.dot(right), d.dot(up), d.dot(back)]).collect();
    let extent = |axis: usize| {
        let values = || local.iter().map(|p| p[axis]);
        values().fold(f32::MIN, f32::max) - values().fold(f32::MAX, f32::min)
    };
    let aspect = (extent(0) / extent(1)).clamp(0.8, 16.0 / 9.0);
    let aspect = if aspect.is_finite() { aspect } else { 1.0 };
    let resolution = match &document.film {
        Some(_) => None,
        None => Some(size_of(aspect)),
    };
    let tangent = FILL * (FOV.to_radians() / 2.0).tan();
    let tangents = [tangent * aspect.max(1.0), tangent * (1.0 / aspect).max(1.0)];
    let (target, distance) = fitted(&local, tangents);
    let target = body.center + right * target[0] + up * target[1];
    let eye = target + back * distance;
    let Some(camera_from_world) = Transform::look_at(eye, target, axes.up) else { return };
    // pbrt's cameras are left-handed: without a mirror the picture would be turned round.
    let Some(mirror) = Transform::scale(-1.0, 1.0, 1.0) else { return };
    document.camera = Some(CameraEntity {
        entity: Entity::new("perspective").with("fov", floats(&[FOV])),
        world_from_camera: AnimatedTransform::constant(camera_from_world.inverse() * mirror),
        medium: String::new(),
    });
    if let Some([x, y]) = resolution {
        let film = Entity::new("rgb")
            .with("xresolution", Value::Integers(vec![x]))
            .with("yresolution", Value::Integers(vec![y]));
        document.film = Some(film);
    }
}

/// About 0.8 megapixels of that proportion, sides multiples of 16.
fn size_of(aspect: f32) -> [i32; 2] {
    let height = (0.8e6 / aspect).sqrt();
    [height * aspect, height].map(|side| ((side / 16.0).round() * 16.0) as i32)
}

/// Where in the plane through the middle to look, and from how far, so that all points lie within the tangents: for each
/// side the extreme points bound a cone, whose tip is moved until opposite sides touch.
fn fitted(local: &[[f32; 3]], tangents: [f32; 2]) -> ([f32; 2], f32) {
    let mut target = [0.0; 2];
    let mut distance = 0.0_f32;
    for axis in 0..2 {
        let t = tangents[axis];
        // x - c <= t (d - z) for all points, and -x + c <= t (d - z): upper and lower bounds of c.
        let above = local.iter().map(|p| p[axis] + t * p[2]).fold(f32::MIN, f32::max);
        let below = local.iter().map(|p| p[axis] - t * p[2]).fold(f32::MAX, f32::min);
        target[axis] = (above + below) / 2.0;
        distance = distance.max((above - below) / (2.0 * t));
    }
    // Not within the body.
    let nearest = local.iter().map(|p| p[2]).fold(f32::MIN, f32::max);
    (target, distance.max(nearest * 1.01))
}
