//! Shapes, objects, instances and alpha.

use etendue_math::Point2;

use super::*;
use crate::assets::LoadedMesh;
use crate::light::LightPoint;

/// Every shape is there, as large as it was asked for.
#[test]
fn every_kind_of_shape() {
    let check = |entity: Entity, n_primitives: u32, half: [f32; 3]| {
        let name = entity.type_name.clone();
        let scene = scene(&lit_with(vec![shape(entity)]));
        assert_eq!(scene.geometry.n_primitives(GeometryId(0)), n_primitives, "{name}");
        let size = scene.bounds().max - scene.bounds().min;
        let expected = Vector3::new(2.0 * half[0], 2.0 * half[1], 2.0 * half[2]);
        assert!((size - expected).length() < 1e-4, "{name}: {size:?}");
    };
    check(Entity::new("sphere").with("radius", floats(&[2.0])), 1, [2.0; 3]);
    check(Entity::new("disk").with("height", floats(&[7.0])), 1, [1.0, 1.0, 0.0]);
    check(Entity::new("cylinder").with("zmax", floats(&[3.0])), 1, [1.0, 1.0, 2.0]);
    check(Entity::new("cone").with("height", floats(&[3.0])), 1, [1.0, 1.0, 1.5]);
    check(Entity::new("paraboloid").with("zmax", floats(&[4.0])), 1, [1.0, 1.0, 2.0]);
    check(Entity::new("paraboloid").with("a", floats(&[2.0])).with("b", floats(&[0.5])), 1, [2.0, 0.5, 0.5]);
    check(Entity::new("hyperboloid"), 1, [2.0_f32.sqrt(), 2.0_f32.sqrt(), 0.5]);
    check(Entity::new("torus").with("minorradius", floats(&[0.5])), 1, [1.5, 1.5, 0.5]);
    check(Entity::new("plane").with("extent", floats(&[3.0])).with("d", floats(&[7.0])), 1, [3.0, 3.0, 0.0]);
    check(square(), 2, [1.0, 1.0, 0.0]);
    let corners = points(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 2.0]]);
    check(Entity::new("bilinearmesh").with("P", corners), 1, [0.5, 0.5, 1.0]);
    // A flat square stays flat, and its corners move inwards.
    let control = Entity { type_name: "loopsubdiv".to_owned(), ..square_without_uv() };
    let scene = scene(&lit_with(vec![shape(control.with("levels", integers(&[2])))]));
    assert_eq!(scene.geometry.n_primitives(GeometryId(0)), 2 * 16);
    assert!(scene.bounds().max.x < 1.0 && scene.bounds().max.z.abs() < 1e-6);
}

fn square_without_uv() -> Entity {
    let mut entity = square();
    entity.parameters.retain(|p| p.name != "uv");
    entity
}

/// The tables list what is asked for: the documentation is made from them.
#[test]
fn tables_list_what_is_asked_for() {
    for (name, specs) in SHAPES {
        let mut entity = Entity::new(*name);
        for spec in *specs {
            let value = match (spec.name, spec.kind) {
                ("P", _) => points(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]),
                ("N", _) if *name == "curve" => continue,
                ("N", _) => Value::Normals3(vec![Normal3::new(0.0, 0.0, 1.0); 4]),
                ("S", _) => Value::Vectors3(vec![Vector3::new(1.0, 0.0, 0.0); 4]),
                ("uv", _) => Value::Points2(vec![Point2::splat(0.5); 4]),
                ("indices", _) if *name == "bilinearmesh" => integers(&[0, 1, 2, 3]),
                ("indices", _) => integers(&[0, 1, 2]),
                // One or the other.
                ("displacement", _) if *name == "trianglemesh" || *name == "plymesh" => continue,
                ("filename1", _) => strings(&["a.ply"]),
                ("N1", _) => Value::Normals3(vec![Normal3::new(0.0, 0.0, 1.0); 4]),
                ("P1", _) => points(&[[0.0; 3]; 4]),
                ("type", _) => strings(&["cylinder"]),
                ("basis", _) => strings(&["bspline"]),
                ("degree", _) => integers(&[3]),
                ("neighbors", _) => integers(&[5]),
                ("filename" | "profile", _) if *name == "revolution" => continue,
                ("contour", _) => Value::Points2(vec![Point2::new(0.0, 0.0), Point2::new(1.0, 1.0)]),
                ("y" | "z", "string") => strings(&["u + v"]),
                ("z", _) => floats(&[0.0; 4]),
                ("nu" | "nv", _) => integers(&[2]),
                ("encoding", _) => strings(&["linear"]),
                (_, "bool") => Value::Bools(vec![true]),
                ("filename", _) => strings(&["a.ply"]),
                ("bounds", _) => points(&[[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]]),
                ("p2", _) => points(&[[1.0, 1.0, 1.0]]),
                (_, "point3") => points(&[[0.5, 0.0, 0.0]]),
                (_, "vector3") => Value::Vectors3(vec![Vector3::new(1.0, 0.0, 0.0)]),
                ("zmax" | "thetamax", _) => floats(&[0.75]),
                // Zero in the plane x = 1/4, which meets the ball of this radius, and with a slope within "lipschitz".
                ("function", _) => strings(&["(x - radius / 2) / 4"]),
                ("x", "string") => strings(&["u*tolerance"]),
                ("urange" | "vrange", _) => floats(&[0.0, 1.0]),
                ("maxtriangles", _) => integers(&[1000]),
                (_, "integer") => integers(&[1]),
                _ => floats(&[0.5]),
            };
            entity = entity.with(spec.name, value);
        }
        let mesh = LoadedMesh {
            triangles: vec![[0, 1, 2]],
            positions: [0.0, 1.0, 2.0].map(|x| Point3::new(x, x * x, 0.0)).to_vec(),
            ..LoadedMesh::default()
        };
        let assets =
            Assets { meshes: HashMap::from([("a.ply".to_owned(), mesh.into())]), ..Assets::default() };
        let (scene, problems) = build_with(&lit_with(vec![shape(entity)]), assets);
        assert!(problems.is_empty(), "{name}: {problems:?}");
        assert_eq!(scene.expect("no problem was reported").attributes.len(), 1);
    }
}

/// A radius is positive.
#[test]
fn radii_are_positive() {
    for name in ["sphere", "disk", "cylinder"] {
        for radius in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            let entity = here(Entity::new(name).with("radius", floats(&[radius])));
            error_here(&lit_with(vec![shape(entity)]), "\"radius\" must be positive");
        }
    }
    let entity = here(Entity::new("sphere").with("radius", floats(&[1.0, 2.0])));
    error_here(&lit_with(vec![shape(entity)]), "takes one value, not 2");
    let entity = here(Entity::new("sphere").with("radius", strings(&["one"])));
    let (_, problems) = build(&lit_with(vec![shape(entity)]));
    assert!(problems[0].message.contains("must be of type float, not string"), "{problems:?}");
}

/// A shape that nobody knows is an error.
#[test]
fn unknown_shapes() {
    let entity = here(Entity::new("trianglmesh").with("P", points(&[])));
    let problem = error_here(&lit_with(vec![shape(entity)]), "unknown shape \"trianglmesh\"");
    assert_helps(&problem, "did you mean \"trianglemesh\"?");
}

/// `ReverseOrientation` turns normals over.
#[test]
fn orientation_can_be_reversed() {
    let normal = |reverse_orientation: bool| {
        let scene = scene(&lit_with(vec![ShapeEntity { reverse_orientation, ..sphere() }]));
        let ray = down(0.0, 0.0);
        let hit = scene.intersect(&ray, f32::INFINITY).expect("the sphere is below");
        scene.surface(&ray, &hit).point.ng.z
    };
    assert!((normal(false) - 1.0).abs() < 1e-6 && (normal(true) + 1.0).abs() < 1e-6);
}

fn object(name: &str, shapes: Vec<ShapeEntity>) -> ObjectEntity {
    ObjectEntity { name: name.to_owned(), span: None, shapes }
}

fn instance(object: &str, x: f32) -> InstanceEntity {
    let world_from_instance = still(Transform::translate(Vector3::new(x, 0.0, 0.0)));
    InstanceEntity { object: object.to_owned(), span: Some(HERE), world_from_instance }
}

/// An object is seen where its instances are, and nowhere else.
#[test]
fn objects_are_seen_through_instances() {
    let objects = vec![object("ball", vec![sphere(), shape(square())]), object("unused", vec![sphere()])];
    let instances = vec![instance("ball", 5.0), instance("ball", -5.0)];
    let scene = scene(&Document { objects, instances, ..lit_with(vec![sphere()]) });
    assert_eq!(scene.attributes.len(), 4);
    assert_eq!(below(&scene, 0.0, 0.0), Some((GeometryId(0), 0)));
    assert_eq!(below(&scene, 5.0, 0.0), Some((GeometryId(1), 0)));
    assert_eq!(below(&scene, -5.0, 0.0), Some((GeometryId(1), 0)));
    assert_eq!(below(&scene, 5.9, -0.9), Some((GeometryId(2), 0)));
    assert_eq!(below(&scene, 2.0, 0.0), None);
    let counts = scene.geometry.counts();
    assert_eq!((counts.n_objects, counts.n_instances), (2, 2));
}

/// An instance of an object that does not exist is an error.
#[test]
fn unknown_objects_are_errors() {
    let objects = vec![object("ball", vec![sphere()])];
    let document = Document { objects, instances: vec![instance("bal", 0.0)], ..lit() };
    let problem = error_here(&document, "unknown object \"bal\"");
    assert_helps(&problem, "did you mean \"ball\"?");
}

/// Objects move through their instances; within them, shapes stand still.
#[test]
fn shapes_of_objects_stand_still() {
    let shapes = vec![ShapeEntity { world_from_object: moving(), ..shape(here(Entity::new("sphere"))) }];
    let objects = vec![object("ball", shapes)];
    let document = Document { objects, instances: vec![instance("ball", 0.0)], ..lit() };
    warning_here(&document, "cannot move within it");
}

/// Rays meet a shape of alpha a with probability a: none at 0, all at 1, and the same ray always or never.
#[test]
fn alpha_is_the_share_of_rays_that_meet() {
    let share = |alpha: f32| {
        let scene = scene(&lit_with(vec![shape(square().with("alpha", floats(&[alpha])))]));
        assert_eq!(scene.has_alpha, alpha != 1.0);
        let n = 100_i16;
        let mut n_hits = 0;
        for i in 0..n * n {
            let (x, y) = (f32::from(i / n) / f32::from(n) - 0.5, f32::from(i % n) / f32::from(n) - 0.5);
            let is_hit = below(&scene, x, y).is_some();
            assert_eq!(is_hit, below(&scene, x, y).is_some());
            n_hits += u32::from(is_hit);
        }
        f64::from(n_hits) / f64::from(n).powi(2)
    };
    assert_eq!((share(0.0), share(-1.0), share(1.0), share(2.0)), (0.0, 0.0, 1.0, 1.0));
    for alpha in [0.1, 0.5, 0.9] {
        // 4.5 standard deviations.
        let tolerance = 4.5 * f64::from(alpha * (1.0 - alpha)).sqrt() / 100.0;
        assert!((share(alpha) - f64::from(alpha)).abs() < tolerance, "{} at {alpha}", share(alpha));
    }
}

/// A texture cuts holes: leaves are made so.
#[test]
fn alpha_may_be_a_texture() {
    let checks = Entity::new("checkerboard").with("uscale", floats(&[2.0]));
    let leaf = shape(square().with("alpha", texture("checks")));
    let document = Document { textures: vec![float_texture("checks", checks)], ..lit_with(vec![leaf]) };
    let scene = scene(&document);
    assert!(scene.has_alpha && scene.has_passable);
    // One check on the left, u < 1/2, where it is 1.
    assert!(below(&scene, -0.5, 0.1).is_some() && below(&scene, 0.5, 0.1).is_none());
    let unknown = here(square().with("alpha", texture("cheks")));
    let problem = error_here(
        &Document { shapes: vec![shape(unknown)], ..document },
        "no float texture named \"cheks\"",
    );
    assert_helps(&problem, "did you mean \"checks\"?");
}

/// Light passes where rays pass: through holes, and through the boundaries of media.
#[test]
fn shadow_rays_pass_what_rays_pass() {
    let floor = ShapeEntity {
        world_from_object: still(Transform::translate(Vector3::new(0.0, 0.0, -1.0))),
        ..shape(square())
    };
    let light = |blocker: ShapeEntity| {
        let mut document = lit_with(vec![floor.clone(), blocker]);
        document.materials.push(named_material("none", Entity::new("interface")));
        let scene = scene(&document);
        let ray = Ray::new(Point3::new(0.3, 0.2, -0.5), Vector3::new(0.0, 0.0, -1.0));
        let hit = scene.intersect(&ray, f32::INFINITY).expect("the floor is below");
        assert_eq!(hit.geometry, GeometryId(0));
        let surface = scene.surface(&ray, &hit);
        let to = LightPoint {
            p: down(0.3, 0.2).origin,
            p_error: Vector3::splat(0.0),
            n: None,
            uv: Point2::splat(0.0),
        };
        let share = scene.transmittance(&surface, &to);
        assert_eq!(share, scene.transmittance_to_infinity(&surface, Vector3::new(0.0, 0.0, 1.0)));
        share
    };
    assert_eq!(light(shape(square())), 0.0);
    assert_eq!(light(shape(square().with("alpha", floats(&[0.0])))), 1.0);
    let interface = MaterialReference::Name("none".to_owned(), None);
    assert_eq!(light(ShapeEntity { material: interface, ..shape(square()) }), 1.0);
}
