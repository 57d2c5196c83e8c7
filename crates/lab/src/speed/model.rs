//! Things for rays to hit: a box of 32 triangles, a terrain of any size, and copies of copies of a cube.

use etendue_geometry::{GeometryBuilder, Shape, TriangleMesh};
use etendue_math::{AnimatedTransform, Point3, Rng, Transform, Vector3};

/// Meshes with a camera and a lamp. The lamp is a place that shadow rays aim at; it need not be among the meshes.
#[derive(Clone, Debug)]
pub struct Model {
    /// Name for tables.
    pub name: String,
    /// Triangles in the space of the world, or of an object if there are copies.
    pub meshes: Vec<TriangleMesh>,
    /// Places of copies in the world: all meshes together are one object. Empty if the meshes stand for themselves.
    pub copies: Vec<Transform>,
    /// Where the camera is.
    pub eye: Point3,
    /// What it looks at; y is up.
    pub target: Point3,
    /// Full angle across the shorter side of the picture.
    pub fov_rad: f32,
    /// Where light would come from.
    pub lamp: Lamp,
}

/// A parallelogram.
#[derive(Clone, Copy, Debug)]
pub struct Lamp {
    /// One corner.
    pub corner: Point3,
    /// The sides that meet there.
    pub edges: [Vector3; 2],
}

impl Model {
    /// The classic Cornell box: room, two boxes and lamp, of side 1 and open towards +z.
    #[must_use]
    pub fn cornell_box() -> Self {
        let (x, y, z) =
            (Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.0, 1.0, 0.0), Vector3::new(0.0, 0.0, 1.0));
        let lamp = Lamp { corner: Point3::new(-0.13, 0.999, -0.11), edges: [x * 0.26, z * 0.22] };
        let mut mesh = TriangleMesh::default();
        add_parallelogram(&mut mesh, Point3::new(-0.5, 0.0, 0.5), x, -z);
        add_parallelogram(&mut mesh, Point3::new(-0.5, 1.0, -0.5), x, z);
        add_parallelogram(&mut mesh, Point3::new(-0.5, 0.0, -0.5), x, y);
        add_parallelogram(&mut mesh, Point3::new(-0.5, 0.0, 0.5), -z, y);
        add_parallelogram(&mut mesh, Point3::new(0.5, 0.0, -0.5), z, y);
        add_parallelogram(&mut mesh, lamp.corner, lamp.edges[0], lamp.edges[1]);
        add_pillar(&mut mesh, [-0.17, -0.15], 0.6, 17.0);
        add_pillar(&mut mesh, [0.17, 0.17], 0.3, -17.0);
        Self {
            name: "box".to_owned(),
            meshes: vec![mesh],
            copies: Vec::new(),
            eye: Point3::new(0.0, 0.5, 1.9),
            target: Point3::new(0.0, 0.5, 0.0),
            fov_rad: 39.0_f32.to_radians(),
            lamp,
        }
    }

    /// Hills over the square [-1, 1]^2: `n` by `n` cells of two triangles each, under a lamp of side 1.
    ///
    /// Heights are six octaves of value noise: random numbers at the points of a lattice, blended smoothly between.
    #[must_use]
    pub fn terrain(n: u32) -> Self {
        let mut mesh = TriangleMesh::default();
        let heights = heights(n + 1);
        let coordinate = |i: u32| 2.0 * i as f32 / n as f32 - 1.0;
        for (k, height) in (0..).zip(&heights) {
            mesh.positions.push(Point3::new(coordinate(k % (n + 1)), *height, coordinate(k / (n + 1))));
        }
        for (row, column) in (0..n).flat_map(|row| (0..n).map(move |column| (row, column))) {
            let a = row * (n + 1) + column;
            let b = a + n + 1;
            mesh.indices.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
        }
        Self {
            name: "terrain".to_owned(),
            meshes: vec![mesh],
            copies: Vec::new(),
            eye: Point3::new(0.0, 1.25, 1.0),
            target: Point3::new(0.0, 0.0, -0.05),
            fov_rad: 45.0_f32.to_radians(),
            lamp: Lamp {
                corner: Point3::new(-0.5, 1.6, -0.5),
                edges: [Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.0, 0.0, 1.0)],
            },
        }
    }

    /// A Menger sponge of cubes, `depth` steps deep, whose 400 copies form a sponge of two more steps. Each copy is
    /// turned a little, so that no transform is simple, and neighbours do not touch.
    #[must_use]
    pub fn fractal_box(depth: u32) -> Self {
        let mut mesh = TriangleMesh::default();
        for (centre, side) in sponge(depth) {
            add_cube(&mut mesh, centre, 0.96 * side);
        }
        let mut rng = Rng::new(3, 0);
        let mut axis = || Vector3::new(rng.next_f32(), rng.next_f32(), rng.next_f32()) - Vector3::splat(0.5);
        let place = |(centre, side): (Point3, f32)| {
            let scale = Transform::scale(0.8 * side, 0.8 * side, 0.8 * side)?;
            let turn = Transform::rotate(0.15, axis())?;
            Some(Transform::translate(centre.as_vector()) * turn * scale)
        };
        Self {
            name: "fractal".to_owned(),
            meshes: vec![mesh],
            copies: sponge(2).into_iter().filter_map(place).collect(),
            eye: Point3::new(0.9, 0.8, 1.2),
            target: Point3::new(0.0, -0.05, 0.0),
            fov_rad: 40.0_f32.to_radians(),
            lamp: Lamp {
                corner: Point3::new(0.2, 1.2, 0.2),
                edges: [Vector3::new(0.6, 0.0, 0.0), Vector3::new(0.0, 0.0, 0.6)],
            },
        }
    }

    /// Triangles stored; copies do not count again.
    #[must_use]
    pub fn n_triangles(&self) -> usize {
        self.meshes.iter().map(|mesh| mesh.indices.len()).sum()
    }

    /// Everything, ready to build the hierarchy.
    #[must_use]
    pub fn into_builder(self) -> GeometryBuilder {
        let mut builder = GeometryBuilder::new();
        if self.copies.is_empty() {
            let place = AnimatedTransform::constant(Transform::IDENTITY);
            for mesh in self.meshes {
                builder.add(Shape::Triangles(mesh), &place, false);
            }
            return builder;
        }
        let object = builder.begin_object();
        for mesh in self.meshes {
            builder.add_to_object(object, Shape::Triangles(mesh), &Transform::IDENTITY, false);
        }
        for place in &self.copies {
            builder.add_instance(object, &AnimatedTransform::constant(*place));
        }
        builder
    }
}

/// Two triangles whose normal is `u` x `v`.
fn add_parallelogram(mesh: &mut TriangleMesh, corner: Point3, u: Vector3, v: Vector3) {
    let first = mesh.positions.len() as u32;
    mesh.positions.extend([corner, corner + u, corner + u + v, corner + v]);
    mesh.indices.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
}

/// A box of width and depth 0.3 that stands on the floor, without its bottom.
fn add_pillar(mesh: &mut TriangleMesh, [x, z]: [f32; 2], height: f32, degrees: f32) {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let along = |a: f32, b: f32| Vector3::new(cosine * a + sine * b, 0.0, cosine * b - sine * a) * 0.3;
    let up = Vector3::new(0.0, height, 0.0);
    let centre = Point3::new(x, 0.0, z);
    let mut corner = [along(-0.5, -0.5), along(0.5, -0.5), along(0.5, 0.5), along(-0.5, 0.5)];
    for _ in 0..4 {
        add_parallelogram(mesh, centre + corner[1], corner[0] - corner[1], up);
        corner.rotate_left(1);
    }
    add_parallelogram(mesh, centre + corner[3] + up, corner[2] - corner[3], corner[1] - corner[2]);
}

fn add_cube(mesh: &mut TriangleMesh, centre: Point3, side: f32) {
    let axes = [Vector3::new(side, 0.0, 0.0), Vector3::new(0.0, side, 0.0), Vector3::new(0.0, 0.0, side)];
    let half = (axes[0] + axes[1] + axes[2]) * 0.5;
    for axis in 0..3 {
        let (u, v) = (axes[(axis + 1) % 3], axes[(axis + 2) % 3]);
        add_parallelogram(mesh, centre - half, v, u);
        add_parallelogram(mesh, centre - half + axes[axis], u, v);
    }
}

/// Centres and side of the cubes of a Menger sponge of side 1 about the origin: 20 to the power of `depth` of them.
fn sponge(depth: u32) -> Vec<(Point3, f32)> {
    let mut cubes = vec![(Point3::splat(0.0), 1.0)];
    for _ in 0..depth {
        let parts = |(centre, side): (Point3, f32)| {
            let third = side / 3.0;
            (0..27).map(|k| [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1]).filter_map(move |step: [i32; 3]| {
                let is_kept = step.iter().filter(|s| **s == 0).count() < 2;
                let offset = Vector3::new(step[0] as f32, step[1] as f32, step[2] as f32) * third;
                is_kept.then_some((centre + offset, third))
            })
        };
        cubes = cubes.into_iter().flat_map(parts).collect();
    }
    cubes
}

/// Heights of `n` by `n` points, row by row.
fn heights(n: u32) -> Vec<f32> {
    let mut rng = Rng::new(7, 0);
    let mut heights = vec![0.0; (n * n) as usize];
    for octave in 0..6 {
        let cells = 4_u32 << octave;
        let amplitude = 0.4 / (1_u32 << octave) as f32;
        let stride = cells as usize + 2;
        let lattice: Vec<f32> = (0..stride * stride).map(|_| rng.next_f32() - 0.5).collect();
        let cell = |k: u32| {
            let p = k as f32 / (n - 1) as f32 * cells as f32;
            let f = p.fract();
            (p as usize, f * f * (3.0 - 2.0 * f))
        };
        for (k, height) in (0..).zip(&mut heights) {
            let ((row, v), (column, u)) = (cell(k / n), cell(k % n));
            let blend = |corner: usize| lattice[corner] * (1.0 - u) + lattice[corner + 1] * u;
            let corner = row * stride + column;
            *height += amplitude * (blend(corner) * (1.0 - v) + blend(corner + stride) * v);
        }
    }
    heights
}
