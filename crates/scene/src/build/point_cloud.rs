//! Point-sampled surfaces: from parameters or a loaded file to a shape.

use etendue_geometry::{PointCloud, Shape, estimate_normals};
use etendue_math::{Normal3, Point3};

use crate::parameters::{ParameterSpec, Parameters, spec};

use super::meshes::{MeshStore, per_vertex};
use super::shapes::ALPHA;

/// Parameters of `points`.
pub(super) const POINTS: &[ParameterSpec] = &[
    spec("P", "point3", "", "m", "positions"),
    spec("N", "normal", "", "", "normals, outside; without them they are those of planes through neighbours"),
    spec("filename", "string", "", "", "PLY file of points in place of \"P\" and \"N\"; faces do not matter"),
    spec("radius", "float", "", "m", "of all points, or of each; without it the distance of a neighbour"),
    spec("neighbors", "integer", "10", "", "which neighbour gives the radius; 3 to 30"),
    ALPHA,
];

pub(super) fn read_points(p: &mut Parameters<'_, '_>, meshes: &mut MeshStore) -> Option<Shape> {
    let n_neighbours = p.count_within("neighbors", 10, 3, 30);
    let radii = p.floats("radius").map(<[f32]>::to_vec);
    let (positions, mut normals) = read_positions(p, meshes)?;
    if let Some(bad) = positions.iter().position(|p| !p.is_finite()) {
        let name = if p.has("P") { "P" } else { "filename" };
        let span = p.span_of(name);
        p.diagnostics().error(span, format!("point {bad} is not finite"));
        return None;
    }
    if normals.is_empty() {
        normals = estimate_normals(&positions, n_neighbours.max(8));
    }
    let cloud = match radii {
        None => PointCloud::with_local_radii(positions, normals, n_neighbours),
        Some(radii) if radii.len() == 1 => {
            PointCloud { radii: vec![radii[0]; positions.len()], positions, normals }
        }
        Some(radii) => PointCloud { radii, positions, normals },
    };
    if let Err(error) = cloud.validate() {
        let name = if p.has("radius") { "radius" } else { "P" };
        let span = p.span_of(name);
        p.diagnostics().error(span, error.to_string());
        return None;
    }
    Some(Shape::Points(cloud))
}

fn read_positions(p: &mut Parameters<'_, '_>, meshes: &mut MeshStore) -> Option<(Vec<Point3>, Vec<Normal3>)> {
    let positions = p.points3("P").unwrap_or_default().to_vec();
    let normals = p.normals3("N");
    let file = p.string_opt("filename").filter(|name| !name.is_empty());
    if positions.is_empty() {
        let Some(file) = file else {
            p.missing("P", "a point-sampled surface needs positions \"P\", or a \"filename\" with some");
            return None;
        };
        // A file that could not be read was reported when it was loaded.
        let mesh = meshes.take(&file)?;
        return Some((mesh.positions, mesh.normals));
    }
    let normals = per_vertex(p, "N", normals, positions.len());
    Some((positions, normals))
}
