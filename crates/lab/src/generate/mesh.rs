//! Meshes of generated scenes: surfaces over a grid.

use etendue_math::{Normal3, Point2, Point3, Vector3};
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
