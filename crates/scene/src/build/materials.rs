//! Materials: named ones may be used before the place that defines them, as in pbrt-v4, but mixtures need their parts
//! first.

use std::collections::HashMap;

use crate::document::{Entity, MaterialEntity, Value};
use crate::material::{Material, MaterialId};
use crate::parameters::Parameters;

use super::Builder;

/// Materials of pbrt-v4 for which grey diffuse stands in.
const MISSING_MATERIALS: &[&str] = &["subsurface"];

/// The grey diffuse material, which stands in for those that are missing or wrong.
pub(super) const DEFAULT_MATERIAL: MaterialId = MaterialId(0);

impl Builder<'_, '_> {
    pub(super) fn build_materials(&mut self) {
        let document = self.document;
        let default = self.materials.add(Material::default());
        debug_assert_eq!(default, DEFAULT_MATERIAL);
        self.material_ids = vec![DEFAULT_MATERIAL; document.materials.len()];
        let order = Order::of(&document.materials);
        for &index in &order.indices {
            let MaterialEntity { name, entity } = &document.materials[index];
            let id = match order.circles.get(&index) {
                Some(part) => self.report_circle(entity, part),
                None => self.build_material(entity),
            };
            self.material_ids[index] = id.unwrap_or(DEFAULT_MATERIAL);
            if let Some(name) = name {
                self.named_materials.insert(name.clone(), self.material_ids[index]);
            }
        }
    }

    fn build_material(&mut self, entity: &Entity) -> Option<MaterialId> {
        let name = entity.type_name.as_str();
        if MISSING_MATERIALS.contains(&name) {
            let message =
                format!("the material \"{name}\" is not available yet; grey \"diffuse\" stands in for it");
            self.context.diagnostics.warning(entity.span, message);
            return None;
        }
        self.materials.build(Parameters::new(entity, &mut self.context), &self.named_materials)
    }

    fn report_circle(&mut self, entity: &Entity, part: &str) -> Option<MaterialId> {
        let message = format!("the mixture contains itself, as its part \"{part}\" contains it");
        self.context.diagnostics.error(entity.span, message);
        None
    }
}

/// The order in which materials are built.
struct Order<'d> {
    /// All materials, the parts of a mixture before it.
    indices: Vec<usize>,
    /// Mixtures that close a circle, with the name of the part that leads around.
    circles: HashMap<usize, &'d str>,
}

#[derive(Clone, Copy, PartialEq)]
enum Visit {
    New,
    Begun,
    Done,
}

impl<'d> Order<'d> {
    fn of(materials: &'d [MaterialEntity]) -> Self {
        let by_name: HashMap<&str, usize> =
            materials.iter().enumerate().filter_map(|(i, m)| Some((m.name.as_deref()?, i))).collect();
        let mut order = Self { indices: Vec::with_capacity(materials.len()), circles: HashMap::new() };
        let mut state = vec![Visit::New; materials.len()];
        for index in 0..materials.len() {
            order.visit(index, materials, &by_name, &mut state);
        }
        order
    }

    /// Depth first, with an explicit stack: a long chain of mixtures must not overflow that of the process.
    fn visit(
        &mut self,
        index: usize,
        materials: &'d [MaterialEntity],
        by_name: &HashMap<&str, usize>,
        state: &mut [Visit],
    ) {
        let mut stack = vec![index];
        while let Some(&top) = stack.last() {
            if state[top] != Visit::New {
                if state[top] == Visit::Begun {
                    self.indices.push(top);
                }
                state[top] = Visit::Done;
                stack.pop();
                continue;
            }
            state[top] = Visit::Begun;
            for name in parts(&materials[top].entity) {
                let Some(&part) = by_name.get(name) else { continue };
                match state[part] {
                    Visit::New => stack.push(part),
                    // What is begun and not done contains what is above it on the stack.
                    Visit::Begun => {
                        self.circles.insert(top, name);
                    }
                    Visit::Done => {}
                }
            }
        }
    }
}

/// Names of the parts of a mixture.
fn parts(entity: &Entity) -> impl Iterator<Item = &str> {
    let materials = entity.parameters.iter().filter(|p| p.name == "materials" && entity.type_name == "mix");
    materials
        .flat_map(|p| match &p.value {
            Value::Strings(names) => names.as_slice(),
            _ => &[],
        })
        .map(String::as_str)
}
