//! One of two materials at each point, chosen at random in a given proportion.
//!
//! The choice is a hash of position and direction, so that asking twice gives the same answer, and the mean over
//! a pixel is the mixture.

use std::collections::HashMap;

use etendue_math::{hash64, unit_f32};

use super::{MaterialContext, MaterialId};
use crate::parameters::{ParameterSpec, Parameters};
use crate::texture::{FloatTexture, Textures};

/// Parameters of `mix`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MixMaterial {
    /// The materials at amount 0 and at amount 1.
    pub materials: [MaterialId; 2],
    /// Share of the second material, in [0, 1].
    pub amount: FloatTexture,
}

impl MixMaterial {
    /// What scene files may say.
    pub const PARAMETERS: &'static [ParameterSpec] = &[
        ParameterSpec {
            name: "materials",
            kind: "string",
            default: "",
            unit: "",
            doc: "Names of two materials, defined before.",
        },
        ParameterSpec {
            name: "amount",
            kind: "float texture",
            default: "0.5",
            unit: "",
            doc: "Share of the second material, in [0, 1].",
        },
    ];

    pub(super) fn build(p: &mut Parameters<'_, '_>, named: &HashMap<String, MaterialId>) -> Option<Self> {
        let amount = p.float_texture("amount", 0.5);
        let names = p.strings("materials").unwrap_or_default();
        let span = p.span_of("materials");
        let [first, second] = names else {
            p.diagnostics().error(span, format!("\"materials\" takes two names, not {}", names.len()));
            return None;
        };
        let mut find = |name: &String| {
            let found = named.get(name).copied();
            if found.is_none() {
                p.diagnostics().unknown_name(span, "material", name, named.keys().map(String::as_str));
            }
            found
        };
        let (first, second) = (find(first), find(second));
        Some(Self { materials: [first?, second?], amount })
    }

    /// The material at a point.
    #[inline]
    pub(super) fn choose(&self, textures: &Textures, ctx: &MaterialContext) -> MaterialId {
        let amount = textures.eval_float(self.amount, &ctx.texture);
        if amount <= 0.0 {
            return self.materials[0];
        }
        if amount >= 1.0 {
            return self.materials[1];
        }
        self.materials[usize::from(amount >= self.random(ctx))]
    }

    /// A number in [0, 1) that depends on nothing but the arguments. The parts' ids make the choices of different
    /// mixtures independent, also if one is part of another.
    fn random(&self, ctx: &MaterialContext) -> f32 {
        let pair = |a: f32, b: f32| u64::from(a.to_bits()) << 32 | u64::from(b.to_bits());
        let (p, wo) = (ctx.texture.p, ctx.wo);
        let parts = u64::from(self.materials[0].0) << 32 | u64::from(self.materials[1].0);
        let hash = hash64(&[pair(p.x, p.y), pair(p.z, wo.x), pair(wo.y, wo.z), parts]);
        unit_f32((hash >> 32) as u32)
    }
}
