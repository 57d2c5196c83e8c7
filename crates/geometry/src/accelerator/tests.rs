//! Every structure has to find what testing every primitive finds, to the last bit.

use std::f32::consts::PI;

use etendue_math::{AnimatedTransform, Point3, Ray, Rng, Transform, Vector3};

use super::{Accelerator, BinarySplit, DivisionSettings, GridSettings, KdTreeSettings};
use crate::bvh::TraversalRay;
use crate::test_support::{any, ball, cube, direction, point_in_cube, ray, soup, still};
use crate::{BilinearMesh, Geometry, GeometryBuilder, Hit, MovedVertices, Shape, TriangleMesh};

/// All structures, also with settings that make them deep, shallow or crowded.
fn accelerators() -> Vec<Accelerator> {
    let tiny = DivisionSettings { max_primitives: 1, max_depth: 60 };
    let kd = KdTreeSettings::DEFAULT;
    let more = [
        Accelerator::BinaryBvh { split: BinarySplit::Middle, max_primitives: 1 },
        Accelerator::BinaryBvh { split: BinarySplit::Equal, max_primitives: 2 },
        Accelerator::Grid { density: 64.0 },
        Accelerator::Grid { density: 0.0 },
        Accelerator::HierarchicalGrid(GridSettings { density: 2.0, max_primitives: 1, max_levels: 8 }),
        Accelerator::Octree(tiny),
        Accelerator::Bsp(tiny),
        Accelerator::KdTree(KdTreeSettings { max_depth: Some(60), intersect_cost: 80.0, ..kd }),
        Accelerator::KdTree(KdTreeSettings { max_depth: Some(0), ..kd }),
    ];
    Accelerator::ALL.into_iter().chain(more).collect()
}

/// A few of each kind of things there are.
struct Sketch {
    name: &'static str,
    builder: fn() -> GeometryBuilder,
    /// Rays start in a cube of this half side.
    size: f32,
}

fn of_shapes(shapes: Vec<Shape>) -> GeometryBuilder {
    let mut builder = GeometryBuilder::new();
    for shape in shapes {
        builder.add(shape, &still(Transform::IDENTITY), false);
    }
    builder
}

fn translate(x: f32, y: f32, z: f32) -> Transform {
    Transform::translate(Vector3::new(x, y, z))
}

/// A square of `n` by `n` cells at z = 0: rays run along its lines and planes.
fn flat(n: u32) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for (j, i) in (0..=n).flat_map(|j| (0..=n).map(move |i| (j, i))) {
        let coordinate = |i: u32| 2.0 * i as f32 / n as f32 - 1.0;
        mesh.positions.push(Point3::new(coordinate(i), coordinate(j), 0.0));
    }
    for (j, i) in (0..n).flat_map(|j| (0..n).map(move |i| (j, i))) {
        let a = j * (n + 1) + i;
        mesh.indices.extend([[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
    }
    mesh
}

/// Small and large, flat and round, many and none, strewn and in one place.
const SKETCHES: &[Sketch] = &[
    Sketch { name: "nothing", builder: GeometryBuilder::new, size: 1.0 },
    Sketch { name: "one", builder: || of_shapes(vec![Shape::Triangles(soup(1, 0.8, 4))]), size: 1.0 },
    Sketch { name: "soup", builder: || of_shapes(vec![Shape::Triangles(soup(900, 0.15, 5))]), size: 1.5 },
    Sketch { name: "large", builder: || of_shapes(vec![Shape::Triangles(soup(150, 2.0, 6))]), size: 2.5 },
    Sketch { name: "ball", builder: || of_shapes(vec![Shape::Triangles(ball(4))]), size: 1.2 },
    Sketch { name: "cube", builder: || of_shapes(vec![Shape::Triangles(cube())]), size: 1.5 },
    Sketch { name: "flat", builder: || of_shapes(vec![Shape::Triangles(flat(16))]), size: 1.5 },
    Sketch { name: "stack", builder: stack, size: 1.5 },
    Sketch { name: "far", builder: far, size: 1.5 },
    Sketch { name: "stadium", builder: stadium, size: 1.5 },
    Sketch { name: "mixture", builder: mixture, size: 1.5 },
    Sketch { name: "marbles", builder: marbles, size: 1.5 },
    Sketch { name: "instances", builder: instances, size: 3.0 },
];

/// Equal triangles, points, lines and things that are not finite, all in one place.
fn stack() -> GeometryBuilder {
    let mut mesh = TriangleMesh::default();
    mesh.positions.extend(soup(1, 0.9, 8).positions);
    mesh.positions.extend([Point3::splat(f32::NAN), Point3::splat(f32::INFINITY)]);
    mesh.indices = vec![[0, 1, 2]; 300];
    mesh.indices.extend([[0, 0, 0], [0, 1, 1], [0, 1, 3], [0, 1, 4]]);
    of_shapes(vec![Shape::Triangles(mesh.clone()), Shape::Triangles(mesh)])
}

/// What is far from the origin has coordinates that are far apart.
fn far() -> GeometryBuilder {
    let mut builder = GeometryBuilder::new();
    for (k, shape) in
        [Shape::Triangles(ball(3)), Shape::sphere(0.8), Shape::Triangles(flat(8))].into_iter().enumerate()
    {
        builder.add(shape, &still(translate(0.3 * k as f32 + 3000.0, -20_000.0, 700.0)), false);
    }
    builder
}

/// A small thing of many parts in a large one of few.
fn stadium() -> GeometryBuilder {
    let mut builder = GeometryBuilder::new();
    let scale = |s: f32| Transform::scale(s, s, s).expect("invertible");
    builder.add(Shape::Triangles(cube()), &still(scale(500.0)), false);
    builder.add(Shape::Triangles(flat(4)), &still(translate(0.0, 0.0, -1.0) * scale(300.0)), false);
    builder.add(Shape::Triangles(ball(4)), &still(translate(0.2, -0.1, 0.0) * scale(0.05)), false);
    builder
}

/// One of each kind of shape.
fn mixture() -> GeometryBuilder {
    let p = Point3::new;
    let patch = |z: f32| BilinearMesh {
        positions: vec![p(-1.0, -1.0, 0.0), p(1.0, -1.0, z), p(-1.0, 1.0, z), p(1.0, 1.0, 0.0)],
        indices: vec![[0, 1, 2, 3]],
        ..BilinearMesh::default()
    };
    let shapes = vec![
        Shape::Triangles(soup(60, 0.3, 9)),
        Shape::Bilinear(patch(0.7)),
        Shape::Bilinear(patch(0.0)),
        Shape::sphere(0.6),
        Shape::Sphere { radius: 0.9, z_min: -0.5, z_max: 0.6, phi_max_rad: 4.0 },
        Shape::Disk { height: 0.25, radius: 1.0, inner_radius: 0.3, phi_max_rad: 5.0 },
        Shape::Cylinder { radius: 0.5, z_min: -0.75, z_max: 1.0, phi_max_rad: 6.0 },
    ];
    of_shapes(shapes)
}

/// Spheres that touch on a lattice.
fn marbles() -> GeometryBuilder {
    let mut builder = GeometryBuilder::new();
    for k in 0..6_i32.pow(3) {
        let place = [k % 6, k / 6 % 6, k / 36].map(|i| 0.25 * i as f32 - 0.625);
        builder.add(Shape::sphere(0.125), &still(translate(place[0], place[1], place[2])), false);
    }
    builder
}

/// Two objects, placed, mirrored, in one place many times, and moving; an empty one; and shapes of the world.
fn instances() -> GeometryBuilder {
    let mut builder = of_shapes(vec![Shape::Triangles(soup(200, 0.2, 3)), Shape::sphere(0.3)]);
    let objects = [builder.begin_object(), builder.begin_object()];
    builder.add_to_object(objects[0], Shape::Triangles(ball(2)), &Transform::IDENTITY, false);
    builder.add_to_object(objects[1], Shape::Triangles(soup(300, 0.3, 3)), &Transform::IDENTITY, false);
    builder.add_to_object(objects[1], Shape::sphere(0.4), &Transform::IDENTITY, false);
    let turn = Transform::rotate(1.1, Vector3::new(1.0, -0.5, 0.3)).expect("an axis");
    let mirror = Transform::scale(0.5, 1.4, -0.8).expect("invertible");
    let places = [
        translate(2.0, 0.0, 0.0),
        translate(-2.0, 0.5, 0.0) * turn,
        translate(0.0, -2.0, -1.0) * turn * mirror,
    ];
    let moving = AnimatedTransform { end: places[2], ..still(places[0]) };
    let in_one_place = std::iter::repeat_n(still(translate(1.0, 1.0, -2.0)), 12);
    for (k, place) in places.into_iter().map(still).chain([moving]).chain(in_one_place).enumerate() {
        builder.add_instance(objects[k % 2], &place);
    }
    let empty = builder.begin_object();
    builder.add_instance(empty, &still(Transform::IDENTITY));
    let axis = Vector3::new(0.0, 0.0, 1.0);
    let turning = AnimatedTransform {
        end: Transform::rotate(2.5, axis).expect("an axis"),
        ..still(Transform::IDENTITY)
    };
    builder.add(Shape::Triangles(cube()), &turning, false);
    builder
}

/// Rays of every awkward kind: along axes, with zeros of either sign, within planes, from far away, along edges of cells, from
/// inside and on the surface.
fn awkward_ray(rng: &mut Rng, geometry: &Geometry, size: f32) -> Ray {
    let bounds = geometry.bounds();
    let centre = if bounds.is_empty() { Point3::ORIGIN } else { bounds.min.lerp(bounds.max, 0.5) };
    let offset = if centre.as_vector().length() > 100.0 { centre.as_vector() } else { Vector3::default() };
    let free = ray(rng, size);
    let mut free = Ray { origin: free.origin + offset, time: rng.next_f32(), ..free };
    // Middles, quarters and eighths of the box are where cells end.
    let snapped = |rng: &mut Rng, axis: usize| {
        let part = rng.next_below(9) as f32 / 8.0;
        bounds.min[axis] + (bounds.max[axis] - bounds.min[axis]) * part
    };
    let axis = rng.next_below(3) as usize;
    match rng.next_below(10) {
        0 => {
            free.direction = Vector3::splat(if rng.next_below(2) == 0 { 0.0 } else { -0.0 });
            free.direction[axis] = if rng.next_below(2) == 0 { 1.0 } else { -1.0 };
        }
        1 => free.direction[axis] = if rng.next_below(2) == 0 { 0.0 } else { -0.0 },
        2 => free.direction[axis] *= 1e-30,
        3 if !bounds.is_empty() => {
            free.origin[axis] = snapped(rng, axis);
            free.direction[axis] = 0.0;
        }
        4 if !bounds.is_empty() => {
            free.origin = Point3::new(snapped(rng, 0), snapped(rng, 1), snapped(rng, 2));
            if rng.next_below(2) == 0 {
                let to = Point3::new(snapped(rng, 0), snapped(rng, 1), snapped(rng, 2));
                free.direction = to - free.origin;
            }
        }
        5 => free.origin = free.origin - direction(rng) * 1e4,
        6 => {
            let target = point_in_cube(rng, size) + offset;
            free.origin = target + direction(rng) * 1e3;
            free.direction = target - free.origin;
        }
        7 => {
            if let Some(hit) = geometry.intersect(&free, f32::INFINITY, &any) {
                free.origin += free.direction * hit.t;
                free.direction = direction(rng);
            }
        }
        _ => {}
    }
    free
}

/// Refuses some primitives, as alpha textures do.
fn some(hit: &Hit) -> bool {
    !(hit.primitive ^ hit.geometry.0 ^ hit.instance).is_multiple_of(3)
}

/// True for two hits at the same distance. Of such, the default hierarchy rarely misses the first: the rounding of a box that
/// begins at this very distance may hide it.
fn is_tie(brute: &Geometry, ray: &Ray, found: Option<Hit>, expected: Option<Hit>) -> bool {
    let (Some(found), Some(expected)) = (found, expected) else { return false };
    let is_found = |hit: &Hit| {
        (hit.geometry, hit.primitive, hit.instance) == (found.geometry, found.primitive, found.instance)
    };
    found.t == expected.t && brute.intersect(ray, f32::INFINITY, &is_found) == Some(found)
}

/// Compares hits of all structures with those of testing everything.
#[track_caller]
fn same_hits(sketch: &Sketch, n_rays: u32, geometries: &[Geometry]) -> u32 {
    let brute = (sketch.builder)().build_with(Accelerator::Brute);
    let mut rng = Rng::new(23, sketch.name.len() as u64);
    let mut n_hits = 0;
    for index in 0..n_rays {
        let ray = awkward_ray(&mut rng, &brute, sketch.size);
        let t_max = if rng.next_below(4) == 0 { rng.next_f32() } else { f32::INFINITY };
        let filter = if index % 4 == 0 { some } else { any };
        let expected = brute.intersect(&ray, t_max, &filter);
        n_hits += u32::from(expected.is_some());
        assert_eq!(brute.occluded(&ray, t_max, &filter), expected.is_some());
        for geometry in geometries {
            let what = || format!("{} in {:?}: {ray:?} up to {t_max}", sketch.name, geometry.accelerator());
            let found = geometry.intersect(&ray, t_max, &filter);
            if geometry.accelerator() != Accelerator::Bvh || !is_tie(&brute, &ray, found, expected) {
                assert_eq!(found, expected, "{}", what());
            }
            assert_eq!(geometry.occluded(&ray, t_max, &filter), expected.is_some(), "{}", what());
        }
    }
    n_hits
}

/// SPEC ACC-1 to ACC-4: whatever the structure, a ray finds the bits that testing every primitive finds.
#[test]
fn every_structure_finds_the_hits_of_brute_force() {
    let n_rays = if std::env::var_os("ETENDUE_SLOW").is_some_and(|v| v == "1") { 100_000 } else { 600 };
    for sketch in SKETCHES {
        let geometries: Vec<Geometry> =
            accelerators().iter().map(|own| (sketch.builder)().build_with(*own)).collect();
        let n_hits = same_hits(sketch, n_rays, &geometries);
        let is_dense = !matches!(sketch.name, "nothing" | "one" | "stack");
        assert!(n_hits > n_rays / 30 || !is_dense, "{}: {n_hits} of {n_rays} hit", sketch.name);
    }
}

/// The same for rays that graze: they run towards corners and along edges of triangles in planes that cells end at, where boxes
/// and cells without room for errors lose hits (SPEC ACC-7).
#[test]
fn grazing_rays_find_the_hits_of_brute_force() {
    for place in [translate(0.1, 0.2, 0.3), translate(31.7, -12.3, 5.1)] {
        let turns = [0.0, 0.5]
            .map(|half| Transform::rotate(half * PI, Vector3::new(0.0, 1.0, 0.0)).expect("an axis"));
        let mut mesh = TriangleMesh::default();
        for turn in turns {
            let n = mesh.positions.len() as u32;
            let own = flat(7);
            mesh.positions.extend(own.positions.iter().map(|p| (place * turn).point(*p)));
            mesh.indices.extend(own.indices.iter().map(|corners| corners.map(|i| i + n)));
        }
        let build = |accelerator| of_shapes(vec![Shape::Triangles(mesh.clone())]).build_with(accelerator);
        let brute = build(Accelerator::Brute);
        let geometries: Vec<Geometry> = accelerators().into_iter().map(build).collect();
        let mut rng = Rng::new(29, 0);
        let mut n_hits = 0;
        for _ in 0..4000 {
            let [a, b, _] = mesh.indices[rng.next_below(mesh.indices.len() as u32) as usize];
            let [a, b] = [a, b].map(|v| mesh.positions[v as usize]);
            let target = if rng.next_below(2) == 0 { a } else { a.lerp(b, rng.next_f32()) };
            let distance = 10.0_f32.powf(3.0 * rng.next_f32() - 1.0);
            let origin = target + point_in_cube(&mut rng, distance).as_vector();
            let ray = Ray::new(origin, target - origin);
            let expected = brute.intersect(&ray, f32::INFINITY, &any);
            n_hits += u32::from(expected.is_some());
            for geometry in &geometries {
                let found = geometry.intersect(&ray, f32::INFINITY, &any);
                if geometry.accelerator() == Accelerator::Bvh {
                    // Of hits that rounding alone orders it may find another.
                    let [found, expected] =
                        [found, expected].map(|hit| hit.map_or(f32::INFINITY, |hit| hit.t));
                    assert!(found == expected || found <= expected * TraversalRay::WIDEN, "{ray:?}");
                } else {
                    assert_eq!(found, expected, "{:?}: {ray:?}", geometry.accelerator());
                }
            }
        }
        assert!(n_hits > 3000, "{n_hits} hits");
    }
}

/// SPEC ACC-8: after vertices have moved, every structure finds what one over the new places finds.
#[test]
fn structures_follow_vertices_that_move() {
    let sketch = |mesh: TriangleMesh| {
        let mut builder = of_shapes(vec![Shape::Triangles(mesh.clone()), Shape::sphere(0.2)]);
        let object = builder.begin_object();
        let id = builder.add_to_object(object, Shape::Triangles(mesh), &Transform::IDENTITY, false);
        builder.add_instance(object, &still(translate(0.5, 0.0, 0.3)));
        (builder, id)
    };
    for accelerator in Accelerator::ALL {
        let (builder, id) = sketch(soup(200, 0.2, 1));
        let mut moved = builder.build_with(accelerator);
        let positions = soup(200, 0.2, 2).positions;
        let meshes = [crate::GeometryId(0), id].map(|geometry| MovedVertices {
            geometry,
            positions: positions.clone(),
            normals: Vec::new(),
        });
        assert_eq!(moved.move_vertices(meshes.into()), Ok(()));
        let expected = sketch(soup(200, 0.2, 2)).0.build();
        assert_eq!(moved.bounds(), expected.bounds());
        let mut rng = Rng::new(41, 0);
        let mut n_hits = 0;
        for _ in 0..300 {
            let ray = ray(&mut rng, 1.0);
            let hit = moved.intersect(&ray, f32::INFINITY, &any);
            assert_eq!(hit, expected.intersect(&ray, f32::INFINITY, &any), "{accelerator:?}");
            n_hits += u32::from(hit.is_some());
        }
        assert!(n_hits > 50, "{n_hits} hits");
    }
}

/// Nothing makes a structure large: not primitives that overlap each other everywhere, nor many in one place, nor few that
/// are long and thin.
#[test]
fn memory_is_bounded() {
    let mut needles = TriangleMesh::default();
    let mut rng = Rng::new(2, 0);
    for k in 0..2000 {
        needles.positions.extend([point_in_cube(&mut rng, 1.0), point_in_cube(&mut rng, 1.0)]);
        needles.indices.push([2 * k, 2 * k + 1, (2 * k + 3) % 4000]);
    }
    let mut one_place = soup(1, 0.5, 3);
    one_place.indices = vec![[0, 1, 2]; 3000];
    for (name, mesh) in [("needles", needles), ("one place", one_place), ("walls", soup(2000, 5.0, 4))] {
        let n = mesh.indices.len();
        for accelerator in accelerators() {
            let geometry = of_shapes(vec![Shape::Triangles(mesh.clone())]).build_with(accelerator);
            let bytes = geometry.hierarchy_bytes() as f64 / n as f64;
            // References, and for each of them at most two nodes; grids may have 64 empty cells for each primitive.
            assert!(bytes < 1200.0, "{name}, {accelerator:?}: {bytes} bytes for each of {n} triangles");
        }
    }
}

/// The structure is the same for any number of threads.
#[test]
fn structures_do_not_depend_on_threads() {
    let build = |n: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads start");
        pool.install(|| {
            Accelerator::ALL.map(|own| {
                let mesh = Shape::Triangles(soup(12_000, 0.05, 7));
                let mut rng = Rng::new(3, 0);
                let geometry = of_shapes(vec![mesh]).build_with(own);
                let rays: Vec<Ray> = (0..50).map(|_| ray(&mut rng, 1.0)).collect();
                (geometry.hierarchy_bytes(), geometry.counts(), geometry.work_to_intersect(&rays, 10.0))
            })
        })
    };
    assert_eq!(build(1), build(4));
}

/// SPEC ACC-5, ACC-6: what structures are for. A ray around a ball of 8192 triangles tests few of them, and fewer in a hierarchy by
/// the surface area heuristic than in one by halves.
#[test]
fn few_primitives_are_tested() {
    let tests = |accelerator: Accelerator| {
        let mut builder = of_shapes(vec![Shape::Triangles(ball(5))]);
        builder.add(
            Shape::Triangles(cube()),
            &still(Transform::scale(40.0, 40.0, 40.0).expect("invertible")),
            false,
        );
        let geometry = builder.build_with(accelerator);
        let mut rng = Rng::new(5, 0);
        let rays: Vec<Ray> = (0..2000).map(|_| ray(&mut rng, 3.0)).collect();
        geometry.work_to_intersect(&rays, f32::INFINITY).primitives as f64 / rays.len() as f64
    };
    let hierarchy = |split| tests(Accelerator::BinaryBvh { split, max_primitives: 4 });
    assert_eq!(tests(Accelerator::Brute), 8204.0);
    for accelerator in Accelerator::ALL.into_iter().filter(|own| *own != Accelerator::Brute) {
        let n = tests(accelerator);
        // A teapot in a stadium: the equal cells of a grid are so large that a few hold the whole ball.
        let most = if matches!(accelerator, Accelerator::Grid { .. }) { 4000.0 } else { 40.0 };
        assert!(n < most, "{accelerator:?}: {n} tests for each ray");
    }
    let (sah, equal) = (hierarchy(BinarySplit::SurfaceArea), hierarchy(BinarySplit::Equal));
    assert!(sah < equal, "{sah} tests by the heuristic, {equal} by halving");
}
