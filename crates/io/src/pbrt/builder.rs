//! What pbrt's directives mean: they change the graphics state or add to the document.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use etendue_math::Transform;
use etendue_scene::diagnostics::nearest_name;
use etendue_scene::document::{
    CameraEntity, Entity, InstanceEntity, LightEntity, MaterialEntity, MaterialReference, MediumEntity,
    ObjectEntity, Parameter, ShapeEntity, TextureEntity, TextureValue, Value,
};
use etendue_scene::{Diagnostics, Document, Span};
use etendue_spectrum::ColorSpaceName;

use super::state::{ActiveTransforms, AreaLight, Block, BlockKind, Defaults, GraphicsState};

/// A string of the file with its place.
#[derive(Clone, Debug)]
pub(super) struct Text {
    pub(super) content: String,
    pub(super) span: Span,
}

/// Collects the document.
#[derive(Debug, Default)]
pub(super) struct Builder {
    pub(super) document: Document,
    pub(super) diagnostics: Diagnostics,
    pub(super) state: GraphicsState,
    /// True after `WorldBegin`.
    pub(super) in_world: bool,
    blocks: Vec<Block>,
    coordinate_systems: HashMap<String, [Transform; 2]>,
    material_names: HashSet<String>,
    medium_names: HashSet<String>,
    texture_names: HashSet<(bool, String)>,
    object_names: HashSet<String>,
    open_object: Option<OpenObject>,
    warned_of_transform_begin: bool,
}

/// The object whose definition is open.
#[derive(Clone, Copy, Debug)]
struct OpenObject {
    /// Index of the object in the document.
    index: usize,
    /// Index of the block that its definition opened, if that is in this file and not in one that imports it.
    block: Option<usize>,
}

/// State that an `Import` gives back unchanged.
#[derive(Debug)]
pub(super) struct BeforeImport {
    state: GraphicsState,
    blocks: Vec<Block>,
    coordinate_systems: HashMap<String, [Transform; 2]>,
    open_object: Option<OpenObject>,
}

/// Transforms and attributes.
impl Builder {
    pub(super) fn concatenate(&mut self, transform: Transform) {
        self.state.change_transforms(|ctm| ctm * transform);
    }

    pub(super) fn set_transform(&mut self, transform: Transform) {
        self.state.change_transforms(|_| transform);
    }

    pub(super) fn coordinate_system(&mut self, name: Text) {
        self.coordinate_systems.insert(name.content, self.state.ctm);
    }

    pub(super) fn use_coordinate_system(&mut self, name: &Text) {
        if let Some(ctm) = self.coordinate_systems.get(&name.content) {
            self.state.ctm = *ctm;
            return;
        }
        let nearest = nearest_name(&name.content, self.coordinate_systems.keys().map(String::as_str));
        let help = nearest.map(|near| format!("did you mean `{near}`?"));
        let message = format!("there is no coordinate system `{}`: the transform stays", name.content);
        self.diagnostics.warning(name.span, message).help = help;
    }

    pub(super) fn activate(&mut self, active: ActiveTransforms) {
        self.state.active = active;
    }

    pub(super) fn transform_times(&mut self, times: [f32; 2], span: Span) {
        if times[0] >= times[1] {
            self.diagnostics.error(span, "the end time must be after the start time");
            return;
        }
        self.state.times = times;
    }

    pub(super) fn reverse_orientation(&mut self) {
        self.state.reverse_orientation ^= true;
    }

    pub(super) fn color_space(&mut self, name: &Text) {
        if let Some(color_space) = ColorSpaceName::from_name(&name.content.to_lowercase()) {
            self.state.color_space = color_space;
            return;
        }
        let names = ColorSpaceName::ALL.map(ColorSpaceName::name);
        let help = format!("there are: {}", names.join(", "));
        let message = format!("there is no colour space `{}`", name.content);
        self.diagnostics.error(name.span, message).with_help(help);
    }

    pub(super) fn medium_interface(&mut self, inside: &str, outside: &str) {
        self.state.inside_medium = Rc::from(inside);
        self.state.outside_medium = Rc::from(outside);
        self.state.has_medium_interface = true;
    }

    pub(super) fn attribute(&mut self, target: &Entity) {
        let defaults = Rc::make_mut(&mut self.state.defaults);
        let Some(list) = defaults.of(&target.type_name) else {
            let help = format!("the targets are: {}", Defaults::TARGETS.join(", "));
            let message = format!("`Attribute` has no target `{}`", target.type_name);
            self.diagnostics.error(target.span, message).with_help(help);
            return;
        };
        for parameter in &target.parameters {
            list.retain(|old| old.name != parameter.name);
            list.push(Parameter { may_be_unused: true, ..parameter.clone() });
        }
    }
}

/// Blocks.
impl Builder {
    pub(super) fn world_begin(&mut self) {
        self.in_world = true;
        self.state.ctm = [Transform::IDENTITY; 2];
        self.state.active = ActiveTransforms::All;
        self.coordinate_systems.insert("world".to_owned(), self.state.ctm);
    }

    pub(super) fn attribute_begin(&mut self, span: Span) {
        self.blocks.push(Block { kind: BlockKind::Attribute, span, state: self.state.clone() });
    }

    pub(super) fn transform_begin(&mut self, span: Span) {
        if !self.warned_of_transform_begin {
            self.warned_of_transform_begin = true;
            let message = "`TransformBegin` is deprecated: it saves all attributes, as `AttributeBegin` does";
            self.diagnostics
                .warning(span, message)
                .with_help("write `AttributeBegin` and `AttributeEnd` instead");
        }
        self.attribute_begin(span);
    }

    pub(super) fn object_begin(&mut self, name: Text, span: Span) {
        self.blocks.push(Block { kind: BlockKind::Object, span, state: self.state.clone() });
        if self.open_object.is_some() {
            self.diagnostics.error(span, "`ObjectBegin` inside of an object definition");
            return;
        }
        if !self.object_names.insert(name.content.clone()) {
            self.diagnostics.error(name.span, format!("the object `{}` is defined twice", name.content));
        }
        let block = Some(self.blocks.len() - 1);
        self.open_object = Some(OpenObject { index: self.document.objects.len(), block });
        self.document.objects.push(ObjectEntity {
            name: name.content,
            span: Some(name.span),
            shapes: Vec::new(),
        });
    }

    /// Closes the innermost block of that kind, with complaints if it is not the innermost at all.
    pub(super) fn end(&mut self, kind: BlockKind, directive: &str, span: Span) {
        if self.blocks.last().is_none_or(|block| block.kind != kind) {
            let message = match self.blocks.last() {
                None => format!("`{directive}` without a matching `{}Begin`", kind.name()),
                Some(open) => format!("`{directive}` inside of an open `{}Begin`", open.kind.name()),
            };
            self.diagnostics.error(span, message);
        }
        let Some(index) = self.blocks.iter().rposition(|block| block.kind == kind) else {
            return;
        };
        self.state = self.blocks[index].state.clone();
        self.blocks.truncate(index);
        if self.open_object.and_then(|object| object.block).is_some_and(|block| block >= index) {
            self.open_object = None;
        }
    }

    /// What to give to [`Self::import_end`].
    pub(super) fn import_begin(&mut self) -> BeforeImport {
        let open_object = self.open_object;
        self.open_object = open_object.map(|object| OpenObject { block: None, ..object });
        BeforeImport {
            open_object,
            state: self.state.clone(),
            blocks: std::mem::take(&mut self.blocks),
            coordinate_systems: self.coordinate_systems.clone(),
        }
    }

    /// Returns to the state before the import; definitions and shapes stay.
    pub(super) fn import_end(&mut self, before: BeforeImport) {
        self.report_open_blocks();
        self.state = before.state;
        self.blocks = before.blocks;
        self.open_object = before.open_object;
        self.coordinate_systems = before.coordinate_systems;
    }

    /// Reports the blocks that the end of the file leaves open, and closes them.
    pub(super) fn report_open_blocks(&mut self) {
        for block in std::mem::take(&mut self.blocks) {
            let name = block.kind.name();
            let message = format!("this `{name}Begin` has no `{name}End`");
            self.diagnostics.error(block.span, message);
        }
    }
}

/// Entities before `WorldBegin`.
impl Builder {
    pub(super) fn option(&mut self, mut option: Parameter) {
        // pbrt compares names of options without case, hyphens and underscores.
        option.name =
            option.name.chars().filter(|c| !matches!(c, '-' | '_')).flat_map(char::to_lowercase).collect();
        self.document.options.retain(|old| old.name != option.name);
        self.document.options.push(option);
    }

    pub(super) fn camera(&mut self, entity: Entity) {
        let world_from_camera = self.state.ctm.map(|m| m.inverse());
        self.coordinate_systems.insert("camera".to_owned(), world_from_camera);
        self.document.camera = Some(CameraEntity {
            entity,
            world_from_camera: self.state.world_from_camera(),
            medium: self.state.outside_medium.to_string(),
        });
    }

    pub(super) fn film(&mut self, entity: Entity) {
        self.document.film = Some(entity);
        self.document.film_color_space = self.state.color_space;
    }
}

/// Entities of the world.
impl Builder {
    pub(super) fn material(&mut self, entity: Entity) {
        let defaults = Rc::clone(&self.state.defaults);
        let entity = self.modern_material(with_defaults(entity, &defaults.material));
        self.state.material = MaterialReference::Index(self.document.materials.len());
        self.document.materials.push(MaterialEntity { name: None, entity });
    }

    /// Renames the types by which earlier versions meant a mere boundary between media.
    fn modern_material(&mut self, mut entity: Entity) -> Entity {
        if entity.type_name.is_empty() || entity.type_name == "none" {
            let message = format!("the material \"{}\" is deprecated", entity.type_name);
            self.diagnostics.warning(entity.span, message).with_help("write \"interface\" instead");
            entity.type_name = "interface".to_owned();
        }
        entity
    }

    /// `entity` has the name in place of the type.
    pub(super) fn make_named_material(&mut self, entity: Entity) {
        let name = entity.type_name.clone();
        let defaults = Rc::clone(&self.state.defaults);
        let Some(entity) = self.typed_by_parameter(with_defaults(entity, &defaults.material)) else { return };
        let entity = self.modern_material(entity);
        if !self.material_names.insert(name.clone()) {
            self.diagnostics.error(entity.span, format!("the material `{name}` is defined twice"));
            return;
        }
        self.document.materials.push(MaterialEntity { name: Some(name), entity });
    }

    pub(super) fn named_material(&mut self, name: Text) {
        self.state.material = MaterialReference::Name(name.content, Some(name.span));
    }

    /// `entity` has the name in place of the type.
    pub(super) fn make_named_medium(&mut self, entity: Entity) {
        let name = entity.type_name.clone();
        let defaults = Rc::clone(&self.state.defaults);
        let Some(entity) = self.typed_by_parameter(with_defaults(entity, &defaults.medium)) else { return };
        if !self.medium_names.insert(name.clone()) {
            self.diagnostics.error(entity.span, format!("the medium `{name}` is defined twice"));
            return;
        }
        let world_from_medium = self.state.world_from_object();
        self.document.media.push(MediumEntity { name, world_from_medium, entity });
    }

    /// Moves the parameter `type` to the place of the type.
    fn typed_by_parameter(&mut self, mut entity: Entity) -> Option<Entity> {
        let given = entity.parameters.iter().position(|p| p.name == "type");
        let Some(index) = given else {
            let message = format!("`{}` has no parameter \"string type\"", entity.type_name);
            self.diagnostics.error(entity.span, message);
            return None;
        };
        let parameter = entity.parameters.remove(index);
        match parameter.value {
            Value::Strings(names) if names.len() == 1 => {
                entity.type_name = names.into_iter().next().expect("there is one name");
                Some(entity)
            }
            _ => {
                self.diagnostics.error(parameter.span, "the parameter `type` must be one string");
                None
            }
        }
    }

    pub(super) fn texture(&mut self, name: Text, value: TextureValue, entity: Entity) {
        let key = (value == TextureValue::Float, name.content.clone());
        if !self.texture_names.insert(key) {
            self.diagnostics.error(name.span, format!("the texture `{}` is defined twice", name.content));
            return;
        }
        if self.state.ctm[0] != self.state.ctm[1] {
            self.diagnostics.warning(name.span, "textures do not move: the start transform holds");
        }
        let entity = with_defaults(entity, &self.state.defaults.texture);
        let world_from_texture = self.state.ctm[0];
        self.document.textures.push(TextureEntity { name: name.content, value, world_from_texture, entity });
    }

    pub(super) fn light(&mut self, entity: Entity) {
        self.document.lights.push(LightEntity {
            entity: with_defaults(entity, &self.state.defaults.light),
            world_from_light: self.state.world_from_object(),
            outside_medium: self.state.outside_medium.to_string(),
        });
    }

    /// An empty type ends the emission.
    pub(super) fn area_light(&mut self, entity: Entity) {
        if entity.type_name.is_empty() {
            self.state.area_light = None;
            return;
        }
        let entity = with_defaults(entity, &self.state.defaults.light);
        self.state.area_light = Some(Rc::new(AreaLight { entity, index: None.into() }));
    }

    pub(super) fn shape(&mut self, entity: Entity) {
        let area_light = self.area_light_of_shape(&entity);
        let state = &self.state;
        let shape = ShapeEntity {
            entity: with_defaults(entity, &state.defaults.shape),
            world_from_object: state.world_from_object(),
            reverse_orientation: state.reverse_orientation,
            material: state.material.clone(),
            area_light,
            inside_medium: state.inside_medium.to_string(),
            outside_medium: state.outside_medium.to_string(),
            has_medium_interface: state.has_medium_interface,
        };
        match self.open_object {
            Some(object) => self.document.objects[object.index].shapes.push(shape),
            None => self.document.shapes.push(shape),
        }
    }

    fn area_light_of_shape(&mut self, shape: &Entity) -> Option<usize> {
        let light = Rc::clone(self.state.area_light.as_ref()?);
        if self.open_object.is_some() {
            let message = "shapes of objects that are instanced cannot emit light: the area light is ignored";
            self.diagnostics.warning(shape.span, message);
            return None;
        }
        if light.index.get().is_none() {
            light.index.set(Some(self.document.area_lights.len()));
            self.document.area_lights.push(light.entity.clone());
        }
        light.index.get()
    }

    pub(super) fn instance(&mut self, name: Text) {
        if self.open_object.is_some() {
            self.diagnostics.error(name.span, "`ObjectInstance` inside of an object definition");
            return;
        }
        self.document.instances.push(InstanceEntity {
            object: name.content,
            span: Some(name.span),
            world_from_instance: self.state.world_from_object(),
        });
    }
}

/// The entity with those defaults whose names it does not give itself.
fn with_defaults(mut entity: Entity, defaults: &[Parameter]) -> Entity {
    let n_own = entity.parameters.len();
    for default in defaults {
        if !entity.parameters[..n_own].iter().any(|own| own.name == default.name) {
            entity.parameters.push(default.clone());
        }
    }
    entity
}
