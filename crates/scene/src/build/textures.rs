//! Textures, in the order of the document: a texture may use those before it.

use crate::diagnostics::Span;
use crate::document::{Entity, TextureEntity, Value};

use super::Builder;

/// Textures of pbrt-v4 for which a constant stands in.
const MISSING_TEXTURES: &[&str] = &["ptex"];

impl Builder<'_, '_> {
    pub(super) fn build_textures(&mut self) {
        for entity in &self.document.textures {
            if MISSING_TEXTURES.contains(&entity.entity.type_name.as_str()) {
                self.warn_of_missing(entity.entity.span, &entity.entity.type_name);
                let constant = Entity::new("constant").with("value", Value::Floats(vec![0.5]));
                self.textures
                    .define(&TextureEntity { entity: constant, ..entity.clone() }, &mut self.context);
            } else {
                self.textures.define(entity, &mut self.context);
            }
        }
    }

    fn warn_of_missing(&mut self, span: Option<Span>, name: &str) {
        let message =
            format!("the texture \"{name}\" is not available yet; the constant 0.5 stands in for it");
        self.context.diagnostics.warning(span, message);
    }
}
