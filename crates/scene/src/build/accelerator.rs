//! Accelerators: which structure finds the surfaces that rays meet. Pictures do not depend on it.

use etendue_geometry::{Accelerator, BinarySplit, DivisionSettings, GridSettings, KdTreeSettings};

use crate::document::{Document, Entity};
use crate::parameters::{ParameterSpec, Parameters, spec};

use super::BuildContext;

const BVH: &[ParameterSpec] = &[
    spec("maxnodeprims", "integer", "", "", "accepted; leaves are chosen by their cost"),
    spec("splitmethod", "string", "", "", "accepted; splits are by the surface area heuristic"),
];
const BINARY_BVH: &[ParameterSpec] = &[
    spec("splitmethod", "string", "sah", "", "sah (surface area heuristic), middle, or equal (numbers)"),
    spec("maxnodeprims", "integer", "4", "", "primitives in a leaf at most, 1 to 255"),
];
const GRID: &[ParameterSpec] = &[spec("density", "float", "4", "", "cells for each primitive, 0 to 64")];
const HIERARCHICAL_GRID: &[ParameterSpec] = &[
    spec("density", "float", "1", "", "cells for each primitive, 0 to 64"),
    spec("maxprims", "integer", "8", "", "cells with more primitives become grids themselves"),
    spec("maxlevels", "integer", "5", "", "grids within each other at most, 1 to 8"),
];
const OCTREE: &[ParameterSpec] = &[
    spec("maxprims", "integer", "8", "", "cells with no more primitives are not divided"),
    spec("maxdepth", "integer", "20", "", "levels at most, 0 to 60"),
];
const BSP: &[ParameterSpec] = &[
    spec("maxprims", "integer", "4", "", "cells with no more primitives are not divided"),
    spec("maxdepth", "integer", "50", "", "levels at most, 0 to 60"),
];
const KD_TREE: &[ParameterSpec] = &[
    spec("intersectcost", "integer", "5", "", "cost of the test of a primitive"),
    spec("traversalcost", "integer", "1", "", "cost of a step to a child"),
    spec("emptybonus", "float", "0.5", "", "share of the cost that an empty side saves, 0 to 1"),
    spec("maxprims", "integer", "1", "", "cells with no more primitives are not divided"),
    spec("maxdepth", "integer", "-1", "", "levels at most, up to 60; -1 for 8 + 1.3 log2 of the primitives"),
];

/// Accelerator types, what they are, and their parameters.
pub const ACCELERATORS: &[(&str, &str, &[ParameterSpec])] = &[
    ("bvh", "bounding volume hierarchy with eight children for each node; the default and the fastest", BVH),
    ("binarybvh", "bounding volume hierarchy with two children for each node", BINARY_BVH),
    ("brute", "tests every primitive", &[]),
    ("grid", "equal cells", GRID),
    ("hierarchicalgrid", "equal cells, of which crowded ones are divided again", HIERARCHICAL_GRID),
    ("octree", "cubes in eight parts", OCTREE),
    ("bsp", "cells halved by planes", BSP),
    ("kdtree", "cells divided by planes at least expected cost", KD_TREE),
];

/// Largest number of primitives that a parameter may ask for.
const MANY: u32 = 1 << 20;

pub(super) fn build_accelerator(document: &Document, context: &mut BuildContext<'_>) -> Accelerator {
    let fallback = Entity::new("bvh");
    let entity = document.accelerator.as_ref().unwrap_or(&fallback);
    let mut p = Parameters::new(entity, context);
    let accelerator = match entity.type_name.as_str() {
        "bvh" => {
            p.ignore("maxnodeprims");
            p.ignore("splitmethod");
            Accelerator::Bvh
        }
        "binarybvh" => read_binary_bvh(&mut p),
        "brute" => Accelerator::Brute,
        "grid" => Accelerator::Grid { density: p.float_within("density", 4.0, [0.0, 64.0]) },
        "hierarchicalgrid" => read_hierarchical_grid(&mut p),
        "octree" => Accelerator::Octree(read_division(&mut p, &DivisionSettings::OCTREE)),
        "bsp" => Accelerator::Bsp(read_division(&mut p, &DivisionSettings::BSP)),
        "kdtree" => read_kd_tree(&mut p),
        unknown => {
            let span = p.span();
            let known = ACCELERATORS.iter().map(|(name, ..)| *name);
            p.diagnostics().unknown_name(span, "accelerator", unknown, known);
            p.accept_all();
            Accelerator::Bvh
        }
    };
    p.finish();
    accelerator
}

fn read_binary_bvh(p: &mut Parameters<'_, '_>) -> Accelerator {
    let splits =
        [("sah", BinarySplit::SurfaceArea), ("middle", BinarySplit::Middle), ("equal", BinarySplit::Equal)];
    Accelerator::BinaryBvh {
        split: p.choice("splitmethod", "sah", &splits),
        max_primitives: p.count_within("maxnodeprims", 4, 1, 255),
    }
}

fn read_hierarchical_grid(p: &mut Parameters<'_, '_>) -> Accelerator {
    let default = GridSettings::HIERARCHICAL;
    Accelerator::HierarchicalGrid(GridSettings {
        density: p.float_within("density", default.density, [0.0, 64.0]),
        max_primitives: p.count_within("maxprims", default.max_primitives, 0, MANY),
        max_levels: p.count_within("maxlevels", default.max_levels, 1, 8),
    })
}

fn read_division(p: &mut Parameters<'_, '_>, default: &DivisionSettings) -> DivisionSettings {
    DivisionSettings {
        max_primitives: p.count_within("maxprims", default.max_primitives, 0, MANY),
        max_depth: p.count_within("maxdepth", default.max_depth, 0, DivisionSettings::MAX_DEPTH),
    }
}

fn read_kd_tree(p: &mut Parameters<'_, '_>) -> Accelerator {
    let KdTreeSettings { intersect_cost, traversal_cost, empty_bonus, max_primitives, .. } =
        KdTreeSettings::DEFAULT;
    let is_automatic = p.integer_opt("maxdepth").is_none_or(|depth| depth == -1);
    Accelerator::KdTree(KdTreeSettings {
        intersect_cost: p.count_within("intersectcost", intersect_cost as u32, 0, MANY) as f32,
        traversal_cost: p.count_within("traversalcost", traversal_cost as u32, 0, MANY) as f32,
        empty_bonus: p.float_within("emptybonus", empty_bonus, [0.0, 1.0]),
        max_primitives: p.count_within("maxprims", max_primitives, 0, MANY),
        max_depth: (!is_automatic).then(|| p.count_within("maxdepth", 0, 0, DivisionSettings::MAX_DEPTH)),
    })
}
