//! The graphics state of pbrt: what directives set and what every entity takes with it.

use std::cell::Cell;
use std::rc::Rc;

use etendue_math::{AnimatedTransform, Transform};
use etendue_scene::Span;
use etendue_scene::document::{Entity, MaterialReference, Parameter};
use etendue_spectrum::ColorSpaceName;

/// Which of the two current transforms directives change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ActiveTransforms {
    Start,
    End,
    All,
}

/// Parameters that `Attribute` gives to all entities of a kind.
#[derive(Clone, Debug, Default)]
pub(super) struct Defaults {
    pub(super) shape: Vec<Parameter>,
    pub(super) light: Vec<Parameter>,
    pub(super) material: Vec<Parameter>,
    pub(super) medium: Vec<Parameter>,
    pub(super) texture: Vec<Parameter>,
}

impl Defaults {
    /// The names of the lists.
    pub(super) const TARGETS: [&'static str; 5] = ["shape", "light", "material", "medium", "texture"];

    /// The list of that name.
    pub(super) fn of(&mut self, target: &str) -> Option<&mut Vec<Parameter>> {
        Some(match target {
            "shape" => &mut self.shape,
            "light" => &mut self.light,
            "material" => &mut self.material,
            "medium" => &mut self.medium,
            "texture" => &mut self.texture,
            _ => return None,
        })
    }
}

/// An area light that shapes share; it enters the document with the first of them.
#[derive(Debug)]
pub(super) struct AreaLight {
    pub(super) entity: Entity,
    pub(super) index: Cell<Option<usize>>,
}

/// Everything that `AttributeBegin` saves.
#[derive(Clone, Debug)]
pub(super) struct GraphicsState {
    /// World-from-object at the start and the end of the motion.
    pub(super) ctm: [Transform; 2],
    pub(super) active: ActiveTransforms,
    /// Seconds.
    pub(super) times: [f32; 2],
    pub(super) color_space: ColorSpaceName,
    pub(super) reverse_orientation: bool,
    pub(super) material: MaterialReference,
    pub(super) area_light: Option<Rc<AreaLight>>,
    pub(super) inside_medium: Rc<str>,
    pub(super) outside_medium: Rc<str>,
    pub(super) has_medium_interface: bool,
    pub(super) defaults: Rc<Defaults>,
}

impl Default for GraphicsState {
    fn default() -> Self {
        Self {
            ctm: [Transform::IDENTITY; 2],
            active: ActiveTransforms::All,
            times: [0.0, 1.0],
            color_space: ColorSpaceName::Srgb,
            reverse_orientation: false,
            material: MaterialReference::Index(0),
            area_light: None,
            inside_medium: Rc::from(""),
            outside_medium: Rc::from(""),
            has_medium_interface: false,
            defaults: Rc::default(),
        }
    }
}

impl GraphicsState {
    /// Replaces each active transform by what `change` makes of it.
    pub(super) fn change_transforms(&mut self, change: impl Fn(Transform) -> Transform) {
        if self.active != ActiveTransforms::End {
            self.ctm[0] = change(self.ctm[0]);
        }
        if self.active != ActiveTransforms::Start {
            self.ctm[1] = change(self.ctm[1]);
        }
    }

    /// The current transforms with their times.
    pub(super) fn world_from_object(&self) -> AnimatedTransform {
        self.animated(self.ctm)
    }

    /// The inverse of the current transforms, as the camera needs it.
    pub(super) fn world_from_camera(&self) -> AnimatedTransform {
        self.animated(self.ctm.map(|m| m.inverse()))
    }

    fn animated(&self, [start, end]: [Transform; 2]) -> AnimatedTransform {
        if start == end {
            return AnimatedTransform::constant(start);
        }
        AnimatedTransform { start, end, start_time: self.times[0], end_time: self.times[1] }
    }
}

/// What opened a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BlockKind {
    /// `AttributeBegin`
    Attribute,
    /// `ObjectBegin`
    Object,
}

impl BlockKind {
    /// Its directives without `Begin` and `End`.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Attribute => "Attribute",
            Self::Object => "Object",
        }
    }
}

/// A block that is not yet closed, with the state to return to.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub(super) kind: BlockKind,
    pub(super) span: Span,
    pub(super) state: GraphicsState,
}
