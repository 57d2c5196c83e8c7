//! Tests of lights. Significance is 1e-5 each, about 1e-3 over the tests of this folder.

mod area;
mod bands;
mod build;
mod emission;
mod fields;
mod luminaire;
mod profiled;
mod sampler;
mod units;

use std::sync::Arc;

use etendue_geometry::{Geometry, GeometryBuilder, Reference, Shape};
use etendue_image::Texels;
use etendue_math::{AnimatedTransform, Normal3, Point3, Rng, Transform, Vector3, hash64};
use etendue_spectrum::{LAMBDA_MIN_NM, N_DENSE, Sampled, SpectrumTables, Wavelengths, cie};

use super::*;
use crate::assets::Assets;
use crate::diagnostics::Diagnostics;
use crate::document::{Entity, LightEntity, Parameter, Value};
use crate::parameters::BuildContext;
use crate::texture::{FloatTexture, Textures};

const SIGNIFICANCE: f64 = 1e-5;

/// Everything that a light refers to, owned.
pub(super) struct World {
    geometry: Geometry,
    textures: Textures,
    spectra: SpectrumTables,
    pub(super) tables: LightTables,
    pub(super) lights: Vec<Light>,
    pub(super) diagnostics: Diagnostics,
}

impl World {
    /// Lights from entities, over shapes of which each emits by the entity beside it.
    pub(super) fn new(
        entities: &[LightEntity],
        shapes: Vec<(Shape, Transform, Entity)>,
        assets: &Assets,
    ) -> Self {
        let mut builder = GeometryBuilder::new();
        let mut emissive = Vec::new();
        for (shape, transform, entity) in shapes {
            let transform = AnimatedTransform::constant(transform);
            emissive.push((builder.add(shape, &transform, false), entity));
        }
        let geometry = builder.build();
        let mut context = BuildContext::new(assets);
        let mut tables = LightTables::default();
        let mut lights: Vec<Light> =
            entities.iter().flat_map(|entity| tables.build_light(entity, &mut context)).collect();
        for (id, entity) in emissive {
            let n = geometry.n_primitives(id);
            let area = (0..n).map(|primitive| geometry.area(id, primitive)).sum();
            let alpha = FloatTexture::Constant(1.0);
            let Some(emission) = tables.build_emission(&entity, &mut context, area, alpha) else { continue };
            let primitives =
                (0..n).map(|primitive| AreaLight::new(&geometry, id, primitive, emission, &tables));
            lights.extend(primitives.map(Light::Area));
        }
        let (spectra, diagnostics) = (context.spectra, context.diagnostics);
        Self { geometry, textures: Textures::default(), spectra, tables, lights, diagnostics }
    }

    /// One light without shapes.
    pub(super) fn of(entity: Entity) -> Self {
        Self::with_picture(entity, None)
    }

    /// One light without shapes, and the picture `map`.
    pub(super) fn with_picture(entity: Entity, picture: Option<Texels>) -> Self {
        let mut assets = Assets::default();
        if let Some(picture) = picture {
            assets.images.insert("map".to_owned(), Arc::new(picture));
        }
        Self::new(&[placed(entity, Transform::IDENTITY)], Vec::new(), &assets)
    }

    pub(super) fn context(&self) -> LightContext<'_> {
        LightContext {
            geometry: &self.geometry,
            textures: &self.textures,
            spectra: &self.spectra,
            tables: &self.tables,
            time: 0.0,
        }
    }

    pub(super) fn light(&self) -> &Light {
        assert!(!self.diagnostics.has_errors(), "{:?}", self.diagnostics.list());
        &self.lights[0]
    }
}

pub(super) fn placed(entity: Entity, transform: Transform) -> LightEntity {
    let world_from_light = AnimatedTransform::constant(transform);
    LightEntity { entity, world_from_light, outside_medium: String::new() }
}

pub(super) fn floats(values: &[f32]) -> Value {
    Value::Floats(values.to_vec())
}

pub(super) fn point(x: f32, y: f32, z: f32) -> Value {
    Value::Points3(vec![Point3::new(x, y, z)])
}

pub(super) fn string(text: &str) -> Value {
    Value::Strings(vec![text.to_owned()])
}

pub(super) fn rgb(r: f32, g: f32, b: f32) -> Value {
    Value::Rgb(vec![[r, g, b]])
}

pub(super) fn at(p: Point3) -> Reference {
    Reference { p, n: None }
}

pub(super) fn facing(p: Point3, n: Vector3) -> Reference {
    Reference { p, n: Some(n.as_normal()) }
}

pub(super) fn rng(name: &str) -> Rng {
    let words: Vec<u64> = name.bytes().map(u64::from).collect();
    Rng::new(hash64(&words), 1)
}

pub(super) fn seed(name: &str) -> u64 {
    rng(name).next_u64()
}

/// Wavelengths for quantities that are compared at a few wavelengths only.
pub(super) fn some_wavelengths() -> Wavelengths {
    Wavelengths::sample_visible(0.4)
}

/// The photometric value of a spectrum that is given at any wavelengths: its integral against y-bar.
pub(super) fn luminance(f: impl Fn(&Wavelengths) -> Sampled) -> f64 {
    let mut sum = 0.0;
    for start in (0..N_DENSE).step_by(4) {
        let nm: [f32; 4] = std::array::from_fn(|i| LAMBDA_MIN_NM + (start + i) as f32);
        let values = f(&Wavelengths::from_parts(nm, [1.0; 4])).to_array();
        for i in 0..4.min(N_DENSE - start) {
            sum += f64::from(values[i]) * f64::from(cie::y_bar(nm[i]));
        }
    }
    sum
}

#[track_caller]
pub(super) fn assert_close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value} is not near {expected}");
}

/// A square grey picture with structure: a dark half, a gradient and one bright texel.
fn grey_picture(size: usize) -> Texels {
    Texels::from_fn(size, size, 3, |x, y, _| grey_value(size, x, y))
}

fn grey_value(size: usize, x: usize, y: usize) -> f32 {
    if x == size / 3 && y == size / 4 {
        return 5.0;
    }
    if y >= size * 3 / 4 { 0.0 } else { 0.1 + x as f32 / size as f32 }
}

/// A rotation without symmetry.
pub(super) fn tilted() -> Transform {
    Transform::rotate(1.1, Vector3::new(0.3, -0.7, 0.5)).expect("the axis is not zero")
}
