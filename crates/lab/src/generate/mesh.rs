//! Meshes of generated scenes: surfaces over a grid, bodies of revolution, and pieces put together.

use std::f32::consts::TAU;

use etendue_math::{Normal3, Point2, Point3, Transform, Vector3};
use etendue_scene::LoadedMesh;

/// Cells along each side of a grid, and whether the last column is the first one again.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    /// Cells along u and v.
    pub(super) cells: [u32; 2],
    /// A surface that closes along u shares its vertices there.
    pub(super) closes_u: bool,
}

impl Grid {
    /// A sheet.
    pub(super) const fn sheet(cells: [u32; 2]) -> Self {
        Self { cells, closes_u: false }
    }

    /// A tube along v.
    pub(super) const fn tube(cells: [u32; 2]) -> Self {
        Self { cells, closes_u: true }
    }

    /// Two triangles for each cell of the surface `position(u, v)`, u and v in [0, 1], with smooth normals, which point
    /// along dp/du x dp/dv.
    pub(super) fn mesh(self, position: impl Fn(f32, f32) -> Point3) -> LoadedMesh {
        let [nu, nv] = self.cells;
        let columns = if self.closes_u { nu } else { nu + 1 };
        let mut mesh = LoadedMesh::default();
        for (row, column) in (0..=nv).flat_map(|row| (0..columns).map(move |column| (row, column))) {
            let uv = Point2::new(column as f32 / nu as f32, row as f32 / nv as f32);
            mesh.positions.push(position(uv.x, uv.y));
            mesh.uvs.push(uv);
        }
        for (row, column) in (0..nv).flat_map(|row| (0..nu).map(move |column| (row, column))) {
            let right = (column + 1) % columns;
            let at = |row: u32, column: u32| row * columns + column;
            let [a, b, c, d] = [at(row, column), at(row, right), at(row + 1, right), at(row + 1, column)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
        smooth(&mut mesh);
        mesh
    }
}

/// Gives each vertex the mean normal of its triangles, weighted by their areas.
pub(super) fn smooth(mesh: &mut LoadedMesh) {
    let mut sums = vec![Vector3::splat(0.0); mesh.positions.len()];
    for corners in &mesh.triangles {
        let [a, b, c] = corners.map(|i| mesh.positions[i as usize]);
        let normal = (b - a).cross(c - a);
        corners.iter().for_each(|i| sums[*i as usize] += normal);
    }
    let unit = |n: Vector3| if n.length() > 0.0 { n / n.length() } else { Vector3::new(0.0, 1.0, 0.0) };
    mesh.normals = sums
        .into_iter()
        .map(|n| {
            let n = unit(n);
            Normal3::new(n.x, n.y, n.z)
        })
        .collect();
}

/// A body of revolution about the y axis: the contour runs through (radius, height); its normals point to the right of
/// the contour as it is drawn with the radius to the right and the height upwards.
pub(super) fn lathe(contour: &[[f32; 2]], n_around: u32) -> LoadedMesh {
    let n = contour.len().max(2) as u32 - 1;
    Grid::tube([n_around, n]).mesh(|u, v| {
        let index = (v * n as f32).round() as usize;
        let [radius, height] = contour[index.min(contour.len() - 1)];
        let (sine, cosine) = (TAU * u).sin_cos();
        Point3::new(radius * sine, height, radius * cosine)
    })
}

/// Adds a mesh, moved by a transform, to another.
pub(super) fn append(mesh: &mut LoadedMesh, part: &LoadedMesh, place: &Transform) {
    let first = mesh.positions.len() as u32;
    mesh.positions.extend(part.positions.iter().map(|p| place.point(*p)));
    mesh.normals.extend(part.normals.iter().map(|n| place.normal(*n)));
    mesh.uvs.extend(&part.uvs);
    mesh.triangles.extend(part.triangles.iter().map(|corners| corners.map(|i| i + first)));
}

/// Points on a smooth curve through the given ones, `n` from each to the next: Catmull and Rom's, centripetal
/// (Yuksel, Schaefer and Keyser 2011), which has no loops. Points that are given twice make corners.
pub(super) fn spline(points: &[[f32; 2]], n: u32) -> Vec<[f32; 2]> {
    let at = |i: isize| points[i.clamp(0, points.len() as isize - 1) as usize];
    let mut curve = Vec::new();
    for i in 0..points.len() as isize - 1 {
        let corners = [at(i - 1), at(i), at(i + 1), at(i + 2)];
        if distance(corners[1], corners[2]) > 0.0 {
            curve.extend((0..n).map(|k| centripetal(corners, k as f32 / n as f32)));
        }
    }
    curve.extend(points.last());
    curve
}

fn distance(a: [f32; 2], b: [f32; 2]) -> f32 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The curve between the second and the third point, by the pyramid of Barry and Goldman (1988).
fn centripetal(points: [[f32; 2]; 4], t: f32) -> [f32; 2] {
    let [a, b, c, d] = points;
    // A point that is given twice has a knot of its own all the same.
    let step = |p: [f32; 2], q: [f32; 2]| distance(p, q).sqrt().max(1e-6);
    let t1 = step(a, b);
    let t2 = t1 + step(b, c);
    let t3 = t2 + step(c, d);
    let t = t1 + t * (t2 - t1);
    let mix = |p: [f32; 2], q: [f32; 2], t0: f32, t1: f32| {
        let w = (t - t0) / (t1 - t0);
        [p[0] + w * (q[0] - p[0]), p[1] + w * (q[1] - p[1])]
    };
    let (ab, bc, cd) = (mix(a, b, 0.0, t1), mix(b, c, t1, t2), mix(c, d, t2, t3));
    mix(mix(ab, bc, 0.0, t2), mix(bc, cd, t1, t3), t1, t2)
}

/// Those triangles whose middle is inside, and the others. Both keep all vertices.
pub(super) fn split(mesh: &LoadedMesh, is_inside: impl Fn(Point3) -> bool) -> (LoadedMesh, LoadedMesh) {
    let middle = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|i| mesh.positions[i as usize].as_vector());
        Point3::splat(0.0) + (a + b + c) / 3.0
    };
    let (inside, outside) = mesh.triangles.iter().partition(|corners| is_inside(middle(corners)));
    let of = |triangles| LoadedMesh { triangles, ..mesh.clone() };
    (of(inside), of(outside))
}
