//! From a document and its assets to the scene.
//!
//! Everything is looked at even after an error, so that all problems are reported together. The order follows who
//! needs whom: textures, materials, shapes, geometry, lights, light sampler, camera and film.

mod accelerator;
mod camera;
mod curves;
mod emitters;
mod expressions;
mod film;
mod formulas;
mod heights;
mod lights;
mod materials;
mod meshes;
mod motion;
mod point_cloud;
mod revolution;
mod shapes;
#[cfg(test)]
mod tests;

use std::collections::HashMap;

use etendue_geometry::{GeometryBuilder, ObjectId};

use crate::assets::Assets;
use crate::controls::ControlsBuilder;
use crate::diagnostics::Diagnostics;
use crate::document::{Document, Entity, InstanceEntity};
use crate::material::{MaterialId, Materials};
use crate::parameters::{BuildContext, ParameterSpec};
use crate::scene::{Scene, ShapeAttributes};
use crate::texture::Textures;

pub use accelerator::ACCELERATORS;
pub use film::{FILMS, SAMPLERS};
pub use meshes::{MESH_FILE_PARAMETERS, MESH_FILES};
pub use shapes::SHAPES;

use emitters::Placed;
use meshes::MeshStore;
use shapes::{Emitter, Target};

/// The state of a build.
struct Builder<'d, 'a> {
    document: &'d Document,
    context: BuildContext<'a>,
    textures: Textures,
    materials: Materials,
    /// The material of each entity of the document.
    material_ids: Vec<MaterialId>,
    named_materials: HashMap<String, MaterialId>,
    attributes: Vec<ShapeAttributes>,
    emitters: Vec<Emitter>,
    /// Objects whose shapes can be lights, with the index of the instance that moves them.
    moving: HashMap<String, usize>,
    controls: ControlsBuilder,
}

impl Scene {
    /// Builds the scene that a document describes, and says all that is wrong with it.
    ///
    /// There is a scene unless a diagnostic is an error.
    #[must_use]
    pub fn build(document: &Document, mut assets: Assets) -> (Option<Self>, Diagnostics) {
        let Placed { document, moving } = emitters::place_emitters(document, &assets);
        let document = document.as_ref();
        let loaded = std::mem::take(&mut assets.meshes);
        let integrator_files = std::mem::take(&mut assets.of_integrator);
        let mut builder = Builder {
            document,
            context: BuildContext::new(&assets),
            textures: Textures::default(),
            materials: Materials::new(),
            material_ids: Vec::new(),
            named_materials: HashMap::new(),
            attributes: Vec::new(),
            emitters: Vec::new(),
            moving,
            controls: ControlsBuilder::default(),
        };
        let lights = document.lights.iter().map(|light| &light.entity).chain(&document.area_lights);
        builder.controls = ControlsBuilder::new(lights, &mut builder.context.diagnostics);
        builder.build_textures();
        builder.warn_of_media();
        builder.build_materials();
        let object_shapes = document.objects.iter().flat_map(|object| &object.shapes);
        let mut meshes = MeshStore::new(loaded, document.shapes.iter().chain(object_shapes));
        let geometry = builder.build_geometry(&mut meshes);
        drop(meshes);
        let film = film::build_film(document, &mut builder.context);
        let sampler = film::build_sampler(document, &mut builder.context);
        let filter = builder.build_filter();
        let camera = builder.build_camera(&film, &filter);
        builder.report_missing_attributes();
        let lights = builder.build_lights(&geometry);
        // After an error it may be the light that is missing.
        let is_dark = lights.lights.is_empty() && !builder.materials.have_ambient();
        if is_dark && !builder.context.diagnostics.has_errors() {
            builder.context.diagnostics.warning(None, "the scene has no lights; the image will be black");
        }
        let Builder { mut context, mut textures, materials, attributes, controls, .. } = builder;
        textures.spectra = context.spectra;
        context.diagnostics.remove_repetitions();
        if context.diagnostics.has_errors() {
            return (None, context.diagnostics);
        }
        let has_alpha = attributes.iter().any(|a| a.alpha.is_some());
        let has_passable = has_alpha || attributes.iter().any(|a| materials.is_interface(a.material));
        let scene = Self {
            geometry,
            attributes,
            textures,
            materials,
            lights: lights.lights,
            light_tables: lights.tables,
            infinite_lights: lights.infinite,
            light_sampler: lights.sampler,
            camera,
            film,
            filter,
            sampler,
            integrator: document.integrator.clone().unwrap_or_else(|| Entity::new("volpath")),
            integrator_files,
            controls: controls.finish(),
            has_alpha,
            has_passable,
        };
        (Some(scene), context.diagnostics)
    }
}

impl Builder<'_, '_> {
    /// In the order of the document: a texture may use those before it.
    fn build_textures(&mut self) {
        for entity in &self.document.textures {
            self.textures.define(entity, &mut self.context);
        }
    }

    fn build_geometry(&mut self, meshes: &mut MeshStore) -> etendue_geometry::Geometry {
        let document = self.document;
        let mut geometry = GeometryBuilder::new();
        self.add_shapes(&document.shapes, Target::World, &mut geometry, meshes);
        let mut objects: HashMap<&str, ObjectId> = HashMap::new();
        for object in &document.objects {
            let id = geometry.begin_object();
            objects.insert(&object.name, id);
            let target = match self.moving.get(&object.name) {
                Some(instance) => Target::Moving(id, *instance),
                None => Target::Object(id),
            };
            self.add_shapes(&object.shapes, target, &mut geometry, meshes);
        }
        for instance in &document.instances {
            if let Some(object) = self.find_object(&objects, instance) {
                geometry.add_instance(object, &instance.world_from_instance);
            }
        }
        geometry.build_with(accelerator::build_accelerator(document, &mut self.context))
    }

    fn find_object(
        &mut self,
        objects: &HashMap<&str, ObjectId>,
        instance: &InstanceEntity,
    ) -> Option<ObjectId> {
        let found = objects.get(instance.object.as_str()).copied();
        if found.is_none() {
            let known = objects.keys().copied();
            self.context.diagnostics.unknown_name(instance.span, "object", &instance.object, known);
        }
        found
    }

    fn report_missing_attributes(&mut self) {
        for name in self.textures.mesh_attributes.missing() {
            let message = format!("no mesh has the attribute \"{name}\"; the texture is 0 everywhere");
            self.context.diagnostics.warning(None, message);
        }
    }

    fn warn_of_media(&mut self) {
        for medium in &self.document.media {
            self.context.diagnostics.warning(
                medium.entity.span,
                format!(
                    "participating media are not available yet; \"{}\" is rendered as empty space",
                    medium.name
                ),
            );
        }
    }
}

/// Names of a table of types.
fn known_names(
    table: &'static [(&'static str, &'static [ParameterSpec])],
) -> impl Iterator<Item = &'static str> {
    table.iter().map(|(name, _)| *name)
}
