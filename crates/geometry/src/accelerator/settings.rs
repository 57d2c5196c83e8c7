//! Which structure there is to be, and how it is built.

/// What finds the primitives that a ray may meet. Hits do not depend on it, but what they cost does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Accelerator {
    /// The hierarchy with eight children for each node: the fastest, and the only one made for speed.
    #[default]
    Bvh,
    /// A hierarchy of two children for each node.
    BinaryBvh {
        /// How primitives are divided.
        split: BinarySplit,
        /// Primitives in a leaf at most, where they can be told apart; at least 1.
        max_primitives: u32,
    },
    /// No structure: every primitive is tested.
    Brute,
    /// Equal cells.
    Grid {
        /// Cells for each primitive.
        density: f32,
    },
    /// Equal cells, of which crowded ones are divided again.
    HierarchicalGrid(GridSettings),
    /// Cubes in eight parts.
    Octree(DivisionSettings),
    /// Cells halved by planes.
    Bsp(DivisionSettings),
    /// Cells divided by planes where the expected cost of a ray is least.
    KdTree(KdTreeSettings),
}

impl Accelerator {
    /// All structures as they are by default.
    pub const ALL: [Self; 8] = [
        Self::Bvh,
        Self::BinaryBvh { split: BinarySplit::SurfaceArea, max_primitives: 4 },
        Self::Brute,
        Self::Grid { density: 4.0 },
        Self::HierarchicalGrid(GridSettings::HIERARCHICAL),
        Self::Octree(DivisionSettings::OCTREE),
        Self::Bsp(DivisionSettings::BSP),
        Self::KdTree(KdTreeSettings::DEFAULT),
    ];

    /// The name in scene files.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Bvh => "bvh",
            Self::BinaryBvh { .. } => "binarybvh",
            Self::Brute => "brute",
            Self::Grid { .. } => "grid",
            Self::HierarchicalGrid(_) => "hierarchicalgrid",
            Self::Octree(_) => "octree",
            Self::Bsp(_) => "bsp",
            Self::KdTree(_) => "kdtree",
        }
    }
}

/// How a node of a binary hierarchy divides its primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BinarySplit {
    /// Where the surface area heuristic expects the least cost.
    SurfaceArea,
    /// In the middle of the box of the centres, across its longest side.
    Middle,
    /// Into halves of equal number, across the longest side of the box of the centres.
    Equal,
}

/// When a cell is divided no further.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DivisionSettings {
    /// It has at most so many primitives.
    pub max_primitives: u32,
    /// It has been divided so often; at most [`Self::MAX_DEPTH`].
    pub max_depth: u32,
}

impl DivisionSettings {
    /// Beyond this depth cells are no longer divided, whatever the settings say.
    pub const MAX_DEPTH: u32 = 60;
    /// Of an octree.
    pub const OCTREE: Self = Self { max_primitives: 8, max_depth: 20 };
    /// Of a tree of planes.
    pub const BSP: Self = Self { max_primitives: 4, max_depth: 50 };
}

/// A grid, perhaps of grids.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridSettings {
    /// Cells for each primitive.
    pub density: f32,
    /// Cells with more primitives become grids themselves.
    pub max_primitives: u32,
    /// Grids within each other, at most; at least 1.
    pub max_levels: u32,
}

impl GridSettings {
    /// Of a hierarchical grid.
    pub const HIERARCHICAL: Self = Self { density: 1.0, max_primitives: 8, max_levels: 5 };

    /// A grid without others inside.
    #[must_use]
    pub const fn uniform(density: f32) -> Self {
        Self { density, max_primitives: u32::MAX, max_levels: 1 }
    }
}

/// Parameters of the heuristic, those of pbrt-v4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KdTreeSettings {
    /// Cost of the test of a primitive.
    pub intersect_cost: f32,
    /// Cost of a step to a child.
    pub traversal_cost: f32,
    /// By which share the cost of a split is reduced that leaves one side empty.
    pub empty_bonus: f32,
    /// A cell with at most so many primitives is divided no further.
    pub max_primitives: u32,
    /// Nor one that has been divided so often; `None` for 8 + 1.3 log2 N.
    pub max_depth: Option<u32>,
}

impl KdTreeSettings {
    /// As in pbrt-v4.
    pub const DEFAULT: Self = Self {
        intersect_cost: 5.0,
        traversal_cost: 1.0,
        empty_bonus: 0.5,
        max_primitives: 1,
        max_depth: None,
    };
}
