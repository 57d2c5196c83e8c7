//! Materials: named ones may be used before the place that defines them, as in pbrt-v4, but mixtures need their parts
//! first.

use std::collections::HashMap;

use crate::document::{Entity, MaterialEntity, Value};
use crate::material::Material;
use crate::parameters::Parameters;
use crate::scene::MaterialId;

use super::Builder;

/// Materials of pbrt-v4 for which grey diffuse stands in.
const MISSING_MATERIALS: &[&str] = &["hair", "measured", "subsurface"];

impl Builder<'_, '_> {
    pub(super) fn build_materials(&mut self) -> Vec<Material> {
        let document = self.document;
        let mut materials = vec![Material::default()];
        let mut named: HashMap<String, Material> = HashMap::new();
        self.material_ids = vec![MaterialId(0); document.materials.len()];
        for index in self.order_of_materials() {
            let MaterialEntity { name, entity } = &document.materials[index];
            let material = self.build_material(entity, &named).unwrap_or_default();
            let id = MaterialId(materials.len() as u32);
            self.material_ids[index] = id;
            if let Some(name) = name {
                self.named_materials.insert(name.clone(), id);
                named.insert(name.clone(), material.clone());
            }
            materials.push(material);
        }
        materials
    }

    fn build_material(&mut self, entity: &Entity, named: &HashMap<String, Material>) -> Option<Material> {
        let name = entity.type_name.as_str();
        if MISSING_MATERIALS.contains(&name) {
            let message =
                format!("the material \"{name}\" is not available yet; grey \"diffuse\" stands in for it");
            self.context.diagnostics.warning(entity.span, message);
            return None;
        }
        Material::build(Parameters::new(entity, &mut self.context), named)
    }

    /// Indices of the materials, parts of mixtures before the mixtures. Where mixtures contain each other in a
    /// circle, the order of the file is kept, and the missing part is reported when the mixture is built.
    fn order_of_materials(&self) -> Vec<usize> {
        let materials = &self.document.materials;
        let by_name: HashMap<&str, usize> =
            materials.iter().enumerate().filter_map(|(i, m)| Some((m.name.as_deref()?, i))).collect();
        let mut order = Vec::with_capacity(materials.len());
        let mut state = vec![Visit::New; materials.len()];
        for index in 0..materials.len() {
            visit(index, materials, &by_name, &mut state, &mut order);
        }
        order
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Visit {
    New,
    Begun,
    Done,
}

fn visit(
    index: usize,
    materials: &[MaterialEntity],
    by_name: &HashMap<&str, usize>,
    state: &mut [Visit],
    order: &mut Vec<usize>,
) {
    // An explicit stack: a long chain of mixtures must not overflow that of the process.
    let mut stack = vec![index];
    while let Some(&top) = stack.last() {
        if state[top] == Visit::Done {
            stack.pop();
            continue;
        }
        if state[top] == Visit::Begun {
            state[top] = Visit::Done;
            order.push(top);
            stack.pop();
            continue;
        }
        state[top] = Visit::Begun;
        for part in parts(&materials[top].entity) {
            if let Some(&part) = by_name.get(part)
                && state[part] == Visit::New
            {
                stack.push(part);
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
