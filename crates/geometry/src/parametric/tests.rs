use etendue_math::{Point3, Ray, Rng, Transform};

use super::*;
use crate::Shape;
use crate::test_support::{any, direction, point_in_cube, single};

fn surface(text: [&str; 3], u: [f64; 2], v: [f64; 2], tolerance: f64) -> ParametricSurface {
    let position = text.map(|text| {
        Expression::parse(text, &["u", "v"], &mut |_| None).unwrap_or_else(|error| panic!("{text}: {error}"))
    });
    ParametricSurface { position, u, v, tolerance: Some(tolerance), max_triangles: 1_000_000 }
}

const TAU: f64 = std::f64::consts::TAU;
const PI: f64 = std::f64::consts::PI;

fn torus(tolerance: f64) -> ParametricSurface {
    let text = ["(0.8+0.3*cos(v))*cos(u)", "(0.8+0.3*cos(v))*sin(u)", "0.3*sin(v)"];
    surface(text, [0.0, TAU], [0.0, TAU], tolerance)
}

fn sphere(tolerance: f64) -> ParametricSurface {
    surface(["sin(v)*cos(u)", "sin(v)*sin(u)", "-cos(v)"], [0.0, TAU], [0.0, PI], tolerance)
}

/// All points of all triangles are as near to the surface as asked for, and the triangles are few: at most four times
/// as many as the coarsest even grid of that error has, since cells are halved until they are fine enough.
#[test]
fn the_tolerance_is_met() {
    let check = |surface: &ParametricSurface, distance: &dyn Fn(Point3) -> f64, most: usize| {
        let tolerance = surface.tolerance.expect("it was given");
        let Tessellation { mesh, error, .. } = tessellate(surface);
        assert!(error <= tolerance, "{error}");
        mesh.validate().expect("a valid mesh");
        let mut rng = Rng::new(71, 0);
        for [a, b, c] in &mesh.indices {
            let [a, b, c] = [a, b, c].map(|i| mesh.positions[*i as usize]);
            for _ in 0..4 {
                let (s, t) = (rng.next_f32().sqrt(), rng.next_f32());
                let p = a + (b - a) * (s * (1.0 - t)) + (c - a) * (s * t);
                let d = distance(p);
                assert!(d.abs() <= tolerance, "{d} exceeds {tolerance} at {p:?}");
            }
        }
        assert!(mesh.indices.len() <= most, "{} triangles", mesh.indices.len());
    };
    let norm = |p: Point3| f64::from((p - Point3::ORIGIN).length());
    let to_torus = |p: Point3| {
        let (x, y, z) = (f64::from(p.x), f64::from(p.y), f64::from(p.z));
        (x.hypot(y) - 0.8).hypot(z) - 0.3
    };
    check(&torus(1e-3), &to_torus, 4 * 11_300);
    check(&torus(2e-2), &to_torus, 2_000);
    check(&sphere(1e-3), &|p| norm(p) - 1.0, 4 * 10_000);
    // Half of it bends much, half of it hardly: cells of several sizes.
    let wave = surface(["u", "v", "exp(-20*(u^2+v^2))"], [-2.0, 2.0], [-2.0, 2.0], 1e-3);
    check(&wave, &|p| to_graph(&wave, p), 12_000);
    // Flat at the ends of the quarters of the first cells.
    let ripples = surface(["u", "v", "0.01*sin(32*pi*u)"], [0.0, 1.0], [0.0, 1.0], 1e-3);
    check(&ripples, &|p| to_graph(&ripples, p), 100_000);
}

/// Distance of a point from z = f(x, y): from the foot of its perpendicular, found by steps in tangential planes.
fn to_graph(surface: &ParametricSurface, p: Point3) -> f64 {
    let p = double::point(p);
    let (mut foot, mut least) = (p, f64::INFINITY);
    for _ in 0..8 {
        let (z, slope) = surface.position[2].gradient([foot.x, foot.y, 0.0]);
        foot.z = z;
        let offset = p - foot;
        least = least.min(offset.length());
        let n = DVec3::new(-slope[0], -slope[1], 1.0).normalize();
        foot += offset - n * offset.dot(n);
    }
    least
}

/// Where the finest cells are too coarse, that is told: the distance from a step is half of it.
#[test]
fn errors_of_the_finest_cells_are_told() {
    let step = surface(["u", "v", "if(u < 0.33717, 0, 1)"], [0.0, 1.0], [0.0, 0.001], 1e-3);
    let Tessellation { error, .. } = tessellate(&step);
    assert!(error > 0.1, "{error}");
}

/// Long formulas make fewer triangles.
#[test]
fn work_is_bounded() {
    let terms: Vec<String> = (0..2000).map(|i| format!("sin({i}.5*u)")).collect();
    let long = surface(["u", "v", &terms.join("+")], [0.0, 1.0], [0.0, 1.0], 1e-9);
    let most = ParametricSurface { max_triangles: usize::MAX, ..long.clone() }.most_triangles();
    assert!(most <= MAX_WORK / 6000 && most > 128, "{most}");
    assert_eq!(ParametricSurface { max_triangles: 200, ..long }.most_triangles(), 200);
}

/// Every edge of a closed surface has one neighbour by position, whatever the sizes of cells: no cracks, seams or holes at poles.
#[test]
fn closed_formulas_give_closed_meshes() {
    let bumpy = surface(
        [
            "(1+0.3*exp(-9*((u-2)^2+(v-1.5)^2)))*sin(v)*cos(u)",
            "(1+0.3*exp(-9*((u-2)^2+(v-1.5)^2)))*sin(v)*sin(u)",
            "-(1+0.3*exp(-9*((u-2)^2+(v-1.5)^2)))*cos(v)",
        ],
        [0.0, TAU],
        [0.0, PI],
        2e-3,
    );
    // Bends most at its seam.
    let seamed = surface(
        ["(0.8+0.3*cos(v)+0.2*cos(u)^31)*cos(u)", "(0.8+0.3*cos(v)+0.2*cos(u)^31)*sin(u)", "0.3*sin(v)"],
        [0.0, TAU],
        [0.0, TAU],
        2e-3,
    );
    for surface in [torus(3e-3), sphere(3e-3), bumpy, seamed] {
        let mesh = tessellate(&surface).mesh;
        let key = |i: u32| {
            let p = mesh.positions[i as usize];
            [p.x, p.y, p.z].map(|c| (c + 0.0).to_bits())
        };
        let mut edges: HashMap<_, i32> = HashMap::new();
        for triangle in &mesh.indices {
            for k in 0..3 {
                let (a, b) = (key(triangle[k]), key(triangle[(k + 1) % 3]));
                *edges.entry((a, b)).or_default() += 1;
                *edges.entry((b, a)).or_default() -= 1;
            }
        }
        let n_open = edges.values().filter(|n| **n != 0).count();
        assert_eq!(n_open, 0, "of {} edges", edges.len());
    }
}

/// Hits of rays are those of the exact torus within the tolerance, and normals are exact.
#[test]
fn hits_are_those_of_the_exact_shape() {
    let tolerance = 1e-3;
    let mesh = tessellate(&torus(tolerance)).mesh;
    let (triangles, _) = single(Shape::Triangles(mesh), Transform::IDENTITY, false);
    let exact = Shape::Torus {
        major_radius: 0.8,
        minor_radius: 0.3,
        theta_min_rad: 0.0,
        theta_max_rad: std::f32::consts::TAU,
        phi_max_rad: std::f32::consts::TAU,
    };
    let (exact, _) = single(exact, Transform::IDENTITY, false);
    let mut rng = Rng::new(73, 0);
    let mut n_hits = 0;
    for _ in 0..3000 {
        let from = Point3::ORIGIN + direction(&mut rng) * 3.0;
        let ray = Ray::new(from, (point_in_cube(&mut rng, 1.0) - from).normalized());
        let [a, b] = [&triangles, &exact]
            .map(|g| g.intersect(&ray, f32::INFINITY, &any).map(|hit| (hit.t, g.surface_point(&ray, &hit))));
        let cosine = |s: &Option<(f32, crate::SurfacePoint)>| {
            s.as_ref().map_or(1.0, |(_, s)| s.ng.abs_dot_vector(ray.direction))
        };
        if cosine(&a).min(cosine(&b)) < 0.2 {
            continue;
        }
        match (a, b) {
            (Some((ta, a)), Some((tb, b))) => {
                n_hits += 1;
                assert!((ta - tb).abs() * 0.2 < 1.2e-3, "{ta} {tb}");
                // The hit is off by the tolerance sideways at most 1 / 0.2 times, over the least radius.
                assert!(a.ns.dot(b.ns) > 1.0 - 5e-4, "{a:?} {b:?}");
            }
            (None, None) => {}
            // Only near the outline.
            _ => panic!("{ray:?}"),
        }
    }
    assert!(n_hits > 500, "{n_hits}");
}

/// The limit on triangles holds, and the error is told. Undefined parts are left out; nothing panics.
#[test]
fn limits_hold() {
    let rough = surface(["u", "v", "sin(300*u)*sin(300*v)"], [0.0, 1.0], [0.0, 1.0], 1e-5);
    let rough = tessellate(&ParametricSurface { max_triangles: 20_000, ..rough });
    assert!(rough.mesh.indices.len() <= 20_000 && rough.error > 1e-5, "{}", rough.error);
    let half = tessellate(&surface(["u", "v", "sqrt(u)"], [-1.0, 1.0], [0.0, 1.0], 1e-3)).mesh;
    half.validate().expect("a valid mesh");
    assert!(
        !half.indices.is_empty()
            && half.indices.iter().flatten().all(|i| half.positions[*i as usize].x >= 0.0)
    );
    let nowhere = tessellate(&surface(["0/0", "v", "u"], [-1.0, 1.0], [0.0, 1.0], 1e-3)).mesh;
    assert!(nowhere.indices.is_empty());
    nowhere.validate().expect("a valid mesh");
    assert!(tessellate(&surface(["1", "2", "3"], [0.0, 1.0], [0.0, 1.0], 1e-3)).mesh.indices.is_empty());
    let pole = tessellate(&surface(["1/u", "v", "1e39*u"], [-1.0, 1.0], [0.0, 1.0], 1e-3)).mesh;
    pole.validate().expect("a valid mesh");
}
