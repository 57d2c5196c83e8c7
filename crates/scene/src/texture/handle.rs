//! Handles to textures: what materials, lights and shapes hold. A constant needs no arena, everything else is an id.

use etendue_geometry::SurfacePoint;
use etendue_math::{Normal3, Point2, Point3, Vector3};
use etendue_spectrum::Spectrum;

use super::ShapePoint;

/// Index of a node in the arena of textures that yield numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FloatTextureId(pub u32);

/// Index of a node in the arena of textures that yield spectra.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SpectrumTextureId(pub u32);

/// A number that may vary over a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FloatTexture {
    /// The same everywhere.
    Constant(f32),
    /// A node of [`Textures`](super::Textures).
    Node(FloatTextureId),
}

impl FloatTexture {
    /// The value if it is the same everywhere.
    #[must_use]
    pub const fn constant(self) -> Option<f32> {
        match self {
            Self::Constant(value) => Some(value),
            Self::Node(_) => None,
        }
    }
}

/// A spectrum that may vary over a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpectrumTexture {
    /// The same everywhere.
    Constant(Spectrum),
    /// A node of [`Textures`](super::Textures).
    Node(SpectrumTextureId),
}

impl SpectrumTexture {
    /// The spectrum if it is the same everywhere.
    #[must_use]
    pub const fn constant(self) -> Option<Spectrum> {
        match self {
            Self::Constant(spectrum) => Some(spectrum),
            Self::Node(_) => None,
        }
    }
}

/// Where a texture is evaluated, with the change of place from one pixel to the next.
#[derive(Clone, Copy, Debug, Default)]
pub struct TextureContext {
    /// Position in the world, in metres.
    pub p: Point3,
    /// Change of `p` from a pixel to its right neighbour, in metres; zero if unknown (no antialiasing).
    pub dpdx: Vector3,
    /// Change of `p` from a pixel to the one below.
    pub dpdy: Vector3,
    /// Surface normal; zero off surfaces.
    pub n: Normal3,
    /// Surface parameters.
    pub uv: Point2,
    /// Change of u per pixel to the right.
    pub dudx: f32,
    /// Change of u per pixel down.
    pub dudy: f32,
    /// Change of v per pixel to the right.
    pub dvdx: f32,
    /// Change of v per pixel down.
    pub dvdy: f32,
    /// Index of the face in the mesh as written by its author.
    pub face_index: i32,
    /// The point of the shape, where it is known.
    pub shape_point: Option<ShapePoint>,
}

impl TextureContext {
    /// At a point of a surface, with unknown changes from pixel to pixel.
    #[inline]
    #[must_use]
    pub fn at(point: &SurfacePoint) -> Self {
        Self { p: point.p, n: point.ns, uv: point.uv, face_index: point.face_index, ..Self::default() }
    }
}
