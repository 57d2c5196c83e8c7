//! What artists may switch off (SPEC EMI-14): shapes that cast or receive no caustics or no indirect light, and lights that
//! reach some shapes alone.
//!
//! A **caustic** is light whose last scatterings before a diffuse one are sharp: `L S+ D` in the language of paths, where S
//! are mirrors, glass and sharp gloss, D all wider scattering. It is cast by the sharp surfaces and received by the diffuse
//! one. **Indirect** light is what a diffuse surface sends to another, `D S* D`: cast by the one nearer to the light,
//! received by the other. What the camera sees of a surface itself is neither.
//!
//! A light may belong to a **group**, and a shape may name the groups whose light it receives. Lights without a group reach
//! everything, shapes that name no groups receive all. The camera, and what shines through an interface, is no receiver.

use std::collections::HashMap;

use etendue_geometry::GeometryId;

use crate::diagnostics::Diagnostics;
use crate::document::{Entity, Value};
use crate::light::LightId;
use crate::parameters::{ParameterSpec, Parameters, spec};

/// Parameters of every shape.
pub const SHAPE_CONTROLS: &[ParameterSpec] = &[
    spec("castscaustics", "bool", "true", "", "false if sharp reflection by it lights no diffuse surface"),
    spec("receivescaustics", "bool", "true", "", "false if it shows no light of sharp reflection"),
    spec("castsindirect", "bool", "true", "", "false if its diffuse reflection lights nothing else"),
    spec("receivesindirect", "bool", "true", "", "false if it shows no light of diffuse reflection"),
    spec("lights", "string", "", "", "groups of lights that reach it; all if absent"),
];

/// Parameters of every light.
pub const LIGHT_CONTROLS: &[ParameterSpec] =
    &[spec("group", "string", "", "", "name by which shapes choose the lights that reach them")];

/// Bits of a mask, of which the first stands for lights without a group.
const MAX_GROUPS: usize = 63;

/// The switches of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShapeControls {
    /// Sharp reflection by it lights diffuse surfaces.
    pub casts_caustics: bool,
    /// It shows light of sharp reflection.
    pub receives_caustics: bool,
    /// Its diffuse reflection lights others.
    pub casts_indirect: bool,
    /// It shows light of diffuse reflection.
    pub receives_indirect: bool,
    /// Bit g is set if the lights of group g reach it.
    groups: u64,
}

impl Default for ShapeControls {
    fn default() -> Self {
        Self {
            casts_caustics: true,
            receives_caustics: true,
            casts_indirect: true,
            receives_indirect: true,
            groups: u64::MAX,
        }
    }
}

/// The switches of a scene that uses any.
#[derive(Clone, Debug, Default)]
pub struct Controls {
    shapes: Vec<ShapeControls>,
    /// Group of each light; 0 for none.
    lights: Vec<u8>,
}

impl Controls {
    /// The switches of a shape.
    #[must_use]
    pub fn shape(&self, id: GeometryId) -> ShapeControls {
        self.shapes[id.0 as usize]
    }

    /// True if the light may reach the shape.
    #[must_use]
    pub fn reaches(&self, light: LightId, shape: GeometryId) -> bool {
        self.shape(shape).groups >> self.lights[light.0 as usize] & 1 == 1
    }
}

/// Switches while a scene is built.
#[derive(Debug, Default)]
pub(crate) struct ControlsBuilder {
    controls: Controls,
    /// Numbers of groups by name, from 1.
    groups: HashMap<String, u8>,
}

impl ControlsBuilder {
    /// The groups of the document's lights; of more than 63 a problem is reported.
    pub(crate) fn new<'d>(lights: impl Iterator<Item = &'d Entity>, diagnostics: &mut Diagnostics) -> Self {
        let mut builder = Self::default();
        for entity in lights {
            let Some(parameter) = entity.parameters.iter().find(|p| p.name == "group") else { continue };
            let Value::Strings(names) = &parameter.value else {
                diagnostics.error(parameter.span, "\"group\" must be of type string");
                continue;
            };
            let next = builder.groups.len() + 1;
            let Some(name) = names.first().filter(|name| !builder.groups.contains_key(*name)) else {
                continue;
            };
            if next > MAX_GROUPS {
                diagnostics
                    .error(parameter.span, format!("there are more than {MAX_GROUPS} groups of lights"));
                break;
            }
            builder.groups.insert(name.clone(), next as u8);
        }
        builder
    }

    /// The switches of a shape.
    pub(crate) fn read(&self, p: &mut Parameters) -> ShapeControls {
        let mut groups = u64::MAX;
        if let Some(names) = p.strings("lights") {
            groups = 1;
            for name in names.iter().filter(|name| !name.is_empty()) {
                match self.groups.get(name) {
                    Some(group) => groups |= 1 << group,
                    None => {
                        let span = p.span_of("lights");
                        p.diagnostics().warning(span, format!("no light belongs to the group \"{name}\""));
                    }
                }
            }
        }
        ShapeControls {
            casts_caustics: p.bool("castscaustics", true),
            receives_caustics: p.bool("receivescaustics", true),
            casts_indirect: p.bool("castsindirect", true),
            receives_indirect: p.bool("receivesindirect", true),
            groups,
        }
    }

    /// Adds the next shape.
    pub(crate) fn add_shape(&mut self, controls: ShapeControls) {
        self.controls.shapes.push(controls);
    }

    /// Adds the next lights, so many, of an entity.
    pub(crate) fn add_lights(&mut self, entity: &Entity, n: usize) {
        let name = entity.parameters.iter().find(|p| p.name == "group").and_then(|p| match &p.value {
            Value::Strings(names) => names.first(),
            _ => None,
        });
        let group = name.and_then(|name| self.groups.get(name)).copied().unwrap_or(0);
        self.controls.lights.extend(std::iter::repeat_n(group, n));
    }

    /// What was collected; `None` if nothing is switched off.
    pub(crate) fn finish(self) -> Option<Box<Controls>> {
        let is_used = self.controls.shapes.iter().any(|shape| *shape != ShapeControls::default());
        is_used.then(|| Box::new(self.controls))
    }
}
