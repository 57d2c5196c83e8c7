//! Lights, and how one of them is chosen.

use etendue_geometry::Geometry;

use crate::document::Value;
use crate::light::{
    AreaLight, Light, LightContext, LightId, LightSampler, LightSamplerKind, LightTables, MovingAreaLight,
    SceneBox, SceneSphere, placed_area,
};
use crate::scene::ShapeLights;
use crate::texture::FloatTexture;

use super::{Builder, Emitter};

/// The lights of a scene.
pub(super) struct BuiltLights {
    pub(super) lights: Vec<Light>,
    pub(super) tables: LightTables,
    pub(super) infinite: Vec<LightId>,
    pub(super) sampler: LightSampler,
}

impl Builder<'_, '_> {
    pub(super) fn build_lights(&mut self, geometry: &Geometry) -> BuiltLights {
        let mut tables = LightTables {
            scene_sphere: SceneSphere::around(geometry.bounds()),
            scene_box: SceneBox::around(geometry.bounds()),
            ..LightTables::default()
        };
        let mut lights = Vec::new();
        for entity in &self.document.lights {
            let built = tables.build_light(entity, &mut self.context);
            self.controls.add_lights(&entity.entity, built.len());
            lights.extend(built);
        }
        for emitter in std::mem::take(&mut self.emitters) {
            self.add_area_lights(emitter, geometry, &mut tables, &mut lights);
        }
        let ids = || (0..lights.len() as u32).map(LightId);
        let infinite = ids().filter(|id| lights[id.0 as usize].is_environment()).collect();
        let kind = self.light_sampler_kind();
        let textures = &self.textures;
        let context =
            LightContext { geometry, textures, spectra: &self.context.spectra, tables: &tables, time: 0.0 };
        let sampler = LightSampler::new(kind, &lights, &context);
        BuiltLights { lights, tables, infinite, sampler }
    }

    /// One light for each primitive of an emitting shape, or one for two triangles that are a parallelogram.
    fn add_area_lights(
        &mut self,
        emitter: Emitter,
        geometry: &Geometry,
        tables: &mut LightTables,
        lights: &mut Vec<Light>,
    ) {
        let id = emitter.geometry;
        debug_assert!(
            geometry.can_emit(id) || emitter.motion.is_some(),
            "instances are refused when shapes are added"
        );
        let primitives = 0..geometry.n_primitives(id);
        let area_of = |primitive| match &emitter.motion {
            None => geometry.area(id, primitive),
            Some(motion) => placed_area(geometry, id, primitive, &motion.ends().start),
        };
        let area: f64 = primitives.clone().map(|primitive| f64::from(area_of(primitive))).sum();
        let entity = &self.document.area_lights[emitter.area_light];
        let attributes = &mut self.attributes[id.0 as usize];
        let alpha = attributes.alpha.unwrap_or(FloatTexture::Constant(1.0));
        let Some(emission) = tables.build_emission(entity, &mut self.context, area as f32, alpha) else {
            return;
        };
        let next = LightId(lights.len() as u32);
        if let Some(motion) = emitter.motion {
            let motion = tables.add_motion(*motion);
            let light = |primitive| MovingAreaLight::new(id, primitive, emission, motion, tables);
            attributes.lights = Some(ShapeLights::each(next));
            lights.extend(primitives.map(light).map(Light::MovingArea));
            self.controls.add_lights(entity, lights.len() - next.0 as usize);
            return;
        }
        if let Some(light) = AreaLight::joined(geometry, id, emission, tables) {
            attributes.lights = Some(ShapeLights::whole(next));
            lights.push(Light::Area(light));
            self.controls.add_lights(entity, 1);
            return;
        }
        attributes.lights = Some(ShapeLights::each(next));
        let primitives =
            primitives.map(|primitive| AreaLight::new(geometry, id, primitive, emission, tables));
        lights.extend(primitives.map(Light::Area));
        self.controls.add_lights(entity, lights.len() - next.0 as usize);
    }

    /// The choice belongs to the integrator's parameters, but is prepared with the scene.
    fn light_sampler_kind(&mut self) -> LightSamplerKind {
        let parameters = self.document.integrator.iter().flat_map(|entity| &entity.parameters);
        let Some(parameter) = parameters.into_iter().find(|p| p.name == "lightsampler") else {
            return LightSamplerKind::default();
        };
        let word = match &parameter.value {
            Value::Strings(words) => words.first().map_or("", String::as_str),
            _ => "",
        };
        match word {
            "bvh" | "exhaustive" => LightSamplerKind::Tree,
            "power" => LightSamplerKind::Power,
            "uniform" => LightSamplerKind::Uniform,
            unknown => {
                let known = LightSamplerKind::NAMES.map(|(name, _)| name);
                self.context.diagnostics.unknown_name(parameter.span, "light sampler", unknown, known);
                LightSamplerKind::default()
            }
        }
    }
}
