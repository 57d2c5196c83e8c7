//! Height fields, fractals and displacement: meshes that are made finer than what the file says.

use etendue_geometry::{
    BilinearMesh, Fractal, FractalHeights, HeightGrid, MAX_HEIGHT_LEVELS, MAX_HEIGHTS, Refined, Shape,
    TriangleMesh,
};
use etendue_image::{Encoding, Texels};
use etendue_math::Transform;

use crate::parameters::{ParameterSpec, Parameters, spec};
use crate::texture::{FloatTexture, MeshAttributes, TextureContext, Textures};

use super::meshes::{MeshStore, read_ply_mesh, read_triangle_mesh};
use super::shapes::ALPHA;

/// Parameters of `heightfield`.
pub(super) const HEIGHT_FIELD: &[ParameterSpec] = &[
    spec("z", "float", "", "m", "heights over the unit square: rows in order of y, each in order of x"),
    spec("nu", "integer", "", "", "heights in a row of \"z\""),
    spec("nv", "integer", "", "", "rows of \"z\""),
    spec("filename", "string", "", "", "picture of heights in place of \"z\", its top at y = 1"),
    spec("encoding", "string", "linear", "", "of a picture with 8 bits: linear, sRGB or gamma and exponent"),
    spec(
        "levels",
        "integer",
        "8",
        "",
        "without \"z\" and \"filename\", a fractal of 2^levels squares a side; at most 11",
    ),
    SEED,
    HURST,
    spec("amplitude", "float", "0.1", "m", "deviation of heights of the fractal over the length 1"),
    spec("scale", "float", "1", "", "factor of all heights"),
    spec("offset", "float", "0", "m", "added to all heights"),
    ALPHA,
];
/// Parameters of `fractal`.
pub(super) const FRACTAL: &[ParameterSpec] = &[
    spec("P", "point3", "", "m", "vertex positions of the mesh to start from"),
    spec("indices", "integer", "0 1 2", "", "three vertices for each triangle"),
    spec("N", "normal", "", "", "vertex normals; not used"),
    spec("uv", "point2", "", "", "vertex texture coordinates"),
    spec("filename", "string", "", "", "PLY file in place of \"P\""),
    spec("levels", "integer", "5", "", "subdivision steps, each making four triangles of one; at most 12"),
    SEED,
    HURST,
    spec("amplitude", "float", "0.1", "m", "the middles of edges move by 2^(-hurst level) of this"),
    spec("keepborder", "bool", "true", "", "open edges stay where they are"),
    ALPHA,
];
const SEED: ParameterSpec = spec("seed", "integer", "0", "", "which of all such surfaces");
const HURST: ParameterSpec = spec("hurst", "float", "0.8", "", "from 0, rough, to 1, smooth");
/// Parameters of displacement, of all triangle meshes.
pub(super) const DISPLACEMENT: ParameterSpec =
    spec("displacement", "float texture", "", "m", "moves the surface along its normals");
/// See [`DISPLACEMENT`].
pub(super) const EDGE_LENGTH: ParameterSpec =
    spec("edgelength", "float", "1", "m", "with displacement, longer edges are split; in the world");

/// Most levels of `fractal`.
const MAX_LEVELS: u32 = 12;

pub(super) fn read_height_field(p: &mut Parameters<'_, '_>) -> Option<Shape> {
    let fractal = FractalHeights {
        levels: p.count_within("levels", 8, 1, MAX_HEIGHT_LEVELS),
        hurst: read_hurst(p),
        amplitude: p.float("amplitude", 0.1),
        seed: read_seed(p),
    };
    let (scale, offset) = (p.float("scale", 1.0), p.float("offset", 0.0));
    let encoding = p.string("encoding", "linear");
    let (n, heights) = if p.has("z") {
        p.ignore("filename");
        read_grid(p)?
    } else if p.has("filename") {
        read_picture(p, &encoding)?
    } else {
        let grid = HeightGrid::fractal(&fractal);
        let side = 1 + (1 << fractal.levels);
        ([side; 2], grid.heights().to_vec())
    };
    let heights = heights.into_iter().map(|z| offset + scale * z).collect();
    let Some(grid) = HeightGrid::new(n, heights) else {
        let name = ["z", "filename", "amplitude"].into_iter().find(|name| p.has(name)).unwrap_or("amplitude");
        let span = p.span_of(name);
        let message = format!(
            "{} by {} heights make no field: at least 2 along each side are needed, at most {MAX_HEIGHTS} in all, and finite ones",
            n[0], n[1]
        );
        p.diagnostics().error(span, message);
        return None;
    };
    Some(Shape::Triangles(grid.mesh()))
}

fn read_seed(p: &mut Parameters<'_, '_>) -> u64 {
    p.integer("seed", 0) as u32 as u64
}

fn read_hurst(p: &mut Parameters<'_, '_>) -> f32 {
    let hurst = p.float("hurst", 0.8);
    if (0.0..=1.0).contains(&hurst) {
        return hurst;
    }
    let span = p.span_of("hurst");
    p.diagnostics().error(span, format!("\"hurst\" must lie between 0 and 1, not {hurst}"));
    0.8
}

fn read_grid(p: &mut Parameters<'_, '_>) -> Option<([u32; 2], Vec<f32>)> {
    let n = [p.count("nu", 0), p.count("nv", 0)];
    let heights = p.floats("z")?.to_vec();
    if n[0] as usize * n[1] as usize == heights.len() {
        return Some((n, heights));
    }
    let span = p.span_of("z");
    let message = format!(
        "\"z\" has {} heights, not \"nu\" times \"nv\", which is {} by {}",
        heights.len(),
        n[0],
        n[1]
    );
    p.diagnostics().error(span, message);
    None
}

fn read_picture(p: &mut Parameters<'_, '_>, encoding: &str) -> Option<([u32; 2], Vec<f32>)> {
    let Some(encoding) = Encoding::parse(encoding) else {
        let span = p.span_of("encoding");
        let error = p.diagnostics().error(span, format!("unknown encoding \"{encoding}\""));
        error.with_help("known are: sRGB, linear, gamma followed by the exponent");
        return None;
    };
    let name = p.string_opt("filename")?;
    let assets = p.context.assets;
    let Some(texels) = assets.images.get(&name) else {
        if !assets.failed.contains(&name) {
            let span = p.span_of("filename");
            p.diagnostics().error(span, format!("the picture \"{name}\" was not loaded"));
        }
        return None;
    };
    let (width, height) = (texels.width() as u32, texels.height() as u32);
    if !HeightGrid::is_size([width, height]) {
        return Some(([width, height], Vec::new()));
    }
    let gray: Texels = texels.to_gray(encoding).to_linear(encoding);
    let row = |y: usize| (0..gray.width()).map(move |x| (x, y));
    let texels = (0..gray.height()).rev().flat_map(row);
    Some(([width, height], texels.map(|(x, y)| gray.texel(x, y, 0)).collect()))
}

pub(super) fn read_fractal(
    p: &mut Parameters<'_, '_>,
    meshes: &mut MeshStore,
    attributes: &MeshAttributes,
) -> Vec<Shape> {
    let fractal = Fractal {
        levels: p.count_within("levels", 5, 0, MAX_LEVELS),
        hurst: read_hurst(p),
        amplitude: p.float("amplitude", 0.1),
        seed: read_seed(p),
        keeps_border: p.bool("keepborder", true),
    };
    let shapes = if p.has("filename") && !p.has("P") {
        read_ply_mesh(p, meshes, attributes)
    } else {
        p.ignore("filename");
        read_triangle_mesh(p).map(Shape::Triangles).into_iter().collect()
    };
    // They belong to vertices of the file.
    meshes.attributes.clear();
    let Some(mesh) = triangulated(shapes) else { return Vec::new() };
    if !fractal.amplitude.is_finite() {
        let span = p.span_of("amplitude");
        p.diagnostics().error(span, "\"amplitude\" must be finite");
        return Vec::new();
    }
    match fractal.subdivide(mesh) {
        Ok(mesh) => vec![Shape::Triangles(mesh)],
        Err(error) => {
            let span = p.span_of("levels");
            p.diagnostics().error(span, error.to_string()).with_help("take fewer \"levels\"");
            Vec::new()
        }
    }
}

/// One mesh of triangles from all parts of a file, which share no vertices then.
pub(super) fn triangulated(shapes: Vec<Shape>) -> Option<TriangleMesh> {
    shapes.into_iter().filter_map(triangles_of).reduce(|mut all, mesh| {
        let first = all.positions.len() as u32;
        all.indices.extend(mesh.indices.iter().map(|face| face.map(|v| v + first)));
        all.positions.extend(mesh.positions);
        all.normals.extend(mesh.normals);
        all.uvs.extend(mesh.uvs);
        all
    })
}

fn triangles_of(shape: Shape) -> Option<TriangleMesh> {
    match shape {
        Shape::Triangles(mesh) => Some(TriangleMesh { face_indices: Vec::new(), ..mesh }),
        Shape::Bilinear(BilinearMesh { positions, indices, normals, uvs, .. }) => Some(TriangleMesh {
            positions,
            indices: indices.iter().flat_map(|&[a, b, c, d]| [[a, b, d], [a, d, c]]).collect(),
            normals,
            uvs,
            ..TriangleMesh::default()
        }),
        _ => None,
    }
}

/// A texture that moves the vertices of a mesh, and how short its edges are to be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Displacement {
    texture: FloatTexture,
    edge_length: f32,
}

/// The displacement that parameters ask for, if any. `edge_scale` is the option `displacementedgescale`.
pub(super) fn read_displacement(p: &mut Parameters<'_, '_>, edge_scale: f32) -> Option<Displacement> {
    let edge_length = p.float("edgelength", 1.0) * edge_scale;
    let texture = p.float_texture_opt("displacement")?;
    if !(edge_length > 0.0 && edge_length.is_finite()) {
        let span = p.span_of("edgelength");
        p.diagnostics().error(span, format!("\"edgelength\" must be positive, not {edge_length}"));
        return None;
    }
    (texture != FloatTexture::Constant(0.0)).then_some(Displacement { texture, edge_length })
}

impl Displacement {
    /// The displaced surface of meshes; other shapes have no displacement. Heights are lengths in object space, as in pbrt-v4; textures
    /// are asked at points of the world.
    pub(super) fn apply(
        &self,
        p: &mut Parameters<'_, '_>,
        shapes: Vec<Shape>,
        textures: &Textures,
        world_from_object: &Transform,
    ) -> Vec<Shape> {
        let Some(mesh) = triangulated(shapes) else { return Vec::new() };
        let refined = match Refined::new(mesh, self.edge_length, world_from_object) {
            Ok(refined) => refined,
            Err(error) => {
                let span = p.span_of("edgelength");
                p.diagnostics().error(span, error.to_string()).with_help("take a longer \"edgelength\"");
                return Vec::new();
            }
        };
        let height = |(point, n, uv)| {
            let (p, n) = (world_from_object.point(point), world_from_object.normal(n));
            let context = TextureContext { p, n, uv, ..TextureContext::default() };
            textures.eval_float(self.texture, &context)
        };
        let heights: Vec<f32> = refined.vertices().map(height).collect();
        if let Some(bad) = heights.iter().find(|height| !height.is_finite()) {
            let span = p.span_of("displacement");
            p.diagnostics().error(span, format!("\"displacement\" has the value {bad}"));
            return Vec::new();
        }
        vec![Shape::Triangles(refined.displaced(&heights))]
    }
}
