//! Tests of textures.

mod build;
mod mappings;
mod pictures;
mod procedural;

use std::sync::Arc;

use etendue_image::{Encoding, TexelData, Texels, srgb_decode};
use etendue_math::statistics::{Moments, mean_test};
use etendue_math::{Normal3, Point2, Point3, Rng, Transform, Vector3};
use etendue_spectrum::{ColorSpaceName, Spectrum, Wavelengths};

use super::*;
use crate::assets::Assets;
use crate::document::{Entity, TextureEntity, TextureValue, Value};
use crate::parameters::{BuildContext, Parameters, SpectrumRole};

fn at_uv(u: f32, v: f32) -> TextureContext {
    TextureContext { uv: Point2::new(u, v), n: Normal3::new(0.0, 0.0, 1.0), ..TextureContext::default() }
}

fn at_point(x: f32, y: f32, z: f32) -> TextureContext {
    TextureContext { p: Point3::new(x, y, z), ..TextureContext::default() }
}

/// A footprint of this size, in u and v.
fn with_footprint(mut ctx: TextureContext, du: f32, dv: f32) -> TextureContext {
    (ctx.dudx, ctx.dvdy) = (du, dv);
    ctx
}

fn plane(st: Point2) -> Coordinates2 {
    Coordinates2 { st, dsdx: 0.0, dsdy: 0.0, dtdx: 0.0, dtdy: 0.0 }
}

fn lambda() -> Wavelengths {
    Wavelengths::sample_visible(0.3)
}

/// Builds a texture that yields numbers, with the number of problems.
fn read_float(entity: &Entity, assets: &Assets) -> (Textures, FloatTexture, usize) {
    let mut textures = Textures::default();
    let mut context = BuildContext::new(assets);
    let mut parameters = Parameters::new(entity, &mut context);
    let texture = textures.build_float(&mut parameters, &Transform::IDENTITY);
    parameters.finish();
    let n_problems = context.diagnostics.list().len();
    textures.spectra = context.spectra;
    (textures, texture, n_problems)
}

fn read_spectrum(entity: &Entity, assets: &Assets, role: SpectrumRole) -> (Textures, SpectrumTexture, usize) {
    let mut textures = Textures::default();
    let mut context = BuildContext::new(assets);
    let mut parameters = Parameters::new(entity, &mut context);
    let texture = textures.build_spectrum(&mut parameters, &Transform::IDENTITY, role);
    parameters.finish();
    let n_problems = context.diagnostics.list().len();
    textures.spectra = context.spectra;
    (textures, texture, n_problems)
}

fn floats(values: &[f32]) -> Value {
    Value::Floats(values.to_vec())
}

fn strings(value: &str) -> Value {
    Value::Strings(vec![value.to_owned()])
}

/// Gray texels given as bytes.
fn gray(width: usize, height: usize, values: &[u8]) -> Arc<Texels> {
    Arc::new(Texels::new(width, height, 1, TexelData::U8(values.to_vec())))
}

fn image_map(texels: &Arc<Texels>, filter: ImageFilter, wrap: WrapMode) -> ImageMap {
    let encoding = Encoding::Linear;
    ImageMap::new(
        texels.clone(),
        ImageOptions { filter, wrap: [wrap; 2], encoding, ..ImageOptions::default() },
    )
}

const FILTERS: [ImageFilter; 4] =
    [ImageFilter::Point, ImageFilter::Bilinear, ImageFilter::Trilinear, ImageFilter::Ewa];
