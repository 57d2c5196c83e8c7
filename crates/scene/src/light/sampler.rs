//! Which light to ask: with many lights, one is drawn for each point, with a known probability.

use etendue_geometry::Reference;
use etendue_math::AliasTable;

use super::{Light, LightContext, LightId, LightTree};

/// The ways to choose, by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightSamplerKind {
    /// Every light equally often.
    Uniform,
    /// In proportion to power.
    Power,
    /// By a tree that knows where lights are.
    #[default]
    Tree,
}

impl LightSamplerKind {
    /// Names in scene files.
    pub const NAMES: [(&'static str, Self); 3] =
        [("uniform", Self::Uniform), ("power", Self::Power), ("bvh", Self::Tree)];
}

/// Chooses lights. To add a way: a variant here and in [`LightSamplerKind`], and a line in each match.
#[derive(Clone, Debug)]
pub enum LightSampler {
    /// Every one of so many lights equally often.
    Uniform(u32),
    /// In proportion to power, the same for every point; also the choice for emission into the scene (SPEC EMI-9).
    Power(Option<AliasTable>),
    /// By a tree that knows where lights are.
    Tree(LightTree),
}

impl LightSampler {
    /// Prepares to choose among `lights`, whose ids are their indices.
    #[must_use]
    pub fn new(kind: LightSamplerKind, lights: &[Light], context: &LightContext) -> Self {
        match kind {
            LightSamplerKind::Uniform => Self::Uniform(lights.len() as u32),
            LightSamplerKind::Power => Self::Power(power_table(lights, context)),
            LightSamplerKind::Tree => Self::Tree(LightTree::new(lights, context)),
        }
    }

    /// Groups of lights that are sampled apart; a point is lit by the sum of them.
    #[inline]
    #[must_use]
    pub fn n_groups(&self) -> usize {
        match self {
            Self::Tree(tree) => tree.n_groups(),
            Self::Uniform(_) | Self::Power(_) => 1,
        }
    }

    /// False if no group has lights to choose between, so that [`sample`](Self::sample) makes no use of its number.
    #[inline]
    #[must_use]
    pub fn uses_number(&self) -> bool {
        match self {
            Self::Tree(tree) => tree.has_choice(),
            Self::Uniform(_) | Self::Power(_) => true,
        }
    }

    /// A light of a group for the point `reference`, with its probability within the group; `None` if none of it can
    /// contribute.
    #[inline]
    #[must_use]
    pub fn sample(&self, group: usize, reference: &Reference, u: f32) -> Option<(LightId, f32)> {
        match self {
            Self::Tree(tree) => tree.sample(group, reference, u),
            _ => self.sample_anywhere(u),
        }
    }

    /// Probability with which [`sample`](Self::sample) takes `light` of its group.
    #[inline]
    #[must_use]
    pub fn pmf(&self, reference: &Reference, light: LightId) -> f32 {
        match self {
            Self::Tree(tree) => tree.pmf(reference, light),
            _ => self.pmf_anywhere(light),
        }
    }

    /// A light whatever the point to be lit, for paths that start at lights; `None` without lights and for trees.
    #[must_use]
    pub fn sample_anywhere(&self, u: f32) -> Option<(LightId, f32)> {
        match self {
            Self::Uniform(0) | Self::Power(None) | Self::Tree(_) => None,
            Self::Uniform(n) => Some((LightId(((u * *n as f32) as u32).min(n - 1)), 1.0 / *n as f32)),
            Self::Power(Some(table)) => {
                let (index, pmf, _) = table.sample(u);
                Some((LightId(index as u32), pmf))
            }
        }
    }

    /// Probability with which [`sample_anywhere`](Self::sample_anywhere) takes `light`.
    #[must_use]
    pub fn pmf_anywhere(&self, light: LightId) -> f32 {
        match self {
            Self::Uniform(0) | Self::Power(None) | Self::Tree(_) => 0.0,
            Self::Uniform(n) => 1.0 / *n as f32,
            Self::Power(Some(table)) => table.pmf(light.0 as usize),
        }
    }
}

/// Probabilities in proportion to power; a light that emits at all gets at least a millionth of the mean. `None` if
/// nothing emits.
fn power_table(lights: &[Light], context: &LightContext) -> Option<AliasTable> {
    let weights: Vec<f64> = lights.iter().map(|light| light.power(context).weight).collect();
    let total: f64 = weights.iter().sum();
    if total <= 0.0 || !total.is_finite() {
        return None;
    }
    let least = 1e-6 / lights.len() as f64;
    let share = |w: &f64| if *w > 0.0 { (w / total).max(least) as f32 } else { 0.0 };
    Some(AliasTable::new(&weights.iter().map(share).collect::<Vec<f32>>()))
}
