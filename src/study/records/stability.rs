//! What a run of kind `stability` leaves behind.

use serde::{Deserialize, Serialize};

/// One hard case, by one kernel through one strategy's tree. A row of `cases.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseRecord {
    /// Name of the case.
    pub case: String,
    /// What it is about: `lines`, `boxes`, `triangles`, `spheres`, `cones`, `polygons`, `trees`, `files` or `statistics`.
    pub group: String,
    /// The property it stresses.
    pub stresses: String,
    /// Strategy of the tree; empty where no tree is built.
    pub strategy: String,
    /// `f64`, `f32` or `f32-padded`.
    pub kernel: String,
    /// The outcome that is exactly right.
    pub expected: String,
    /// The outcome.
    pub measured: String,
    /// `pass`; `off` by so much; `refused` with a message, where that is not what is expected; `failed`.
    pub outcome: String,
    /// How far off, in units of the last place of the kernel's numbers or as the case says.
    pub off: Option<f64>,
    /// Whether the verdict demands that it passes or is off, which case and kernel fix: all of f64, and what the f32 kernels promise.
    pub demanded: bool,
}

/// Random lines and lines aimed at edges and corners, each visit and test held against the exact oracle. A row of
/// `random.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RandomRecord {
    /// Scene of the tree.
    pub scene: String,
    /// Strategy of the tree.
    pub strategy: String,
    /// `f64`, `f32` or `f32-padded`.
    pub kernel: String,
    /// `box`: is a node visited; `triangle`: is a triangle hit, in some leaf visited.
    pub against: String,
    /// `random` or `aimed`.
    pub family: String,
    /// Pairs judged.
    pub cases: u64,
    /// Of them, those in which the line meets the box or triangle, exactly.
    pub hits: u64,
    /// Taken for hit, but missed by 8 ulp or more.
    pub wrong: u64,
    /// Taken for missed, but hit by 8 ulp or more; of a triangle, its leaf may have been passed by.
    pub missed: u64,
    /// Pairs nearer than 8 ulp to a tie.
    pub ties: u64,
    /// Of them, those judged wrongly.
    pub tied_wrong: u64,
    /// Of those, hits taken for missed: a padded kernel has none.
    pub tied_missed: u64,
}

/// A pair judged wrongly, nearer than 8 ulp to a tie. A row of `ties.csv`; of many the first of each row of `random.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TieRecord {
    /// Scene of the tree.
    pub scene: String,
    /// Strategy of the tree.
    pub strategy: String,
    /// Kernel.
    pub kernel: String,
    /// `box` or `triangle`.
    pub against: String,
    /// `random` or `aimed`.
    pub family: String,
    /// Number of the node or triangle.
    pub target: u64,
    /// How near the tie is, in the units of [`Incidence::ulps`](crate::exact::Incidence::ulps) or
    /// [`Crossing::ulps`](crate::exact::Crossing::ulps), scaled to the kernel's numbers.
    pub ulps: f64,
    /// Whether the line meets it, exactly.
    pub exact: bool,
    /// Origin of the line.
    pub ox: f64,
    /// Likewise, y.
    pub oy: f64,
    /// Likewise, z.
    pub oz: f64,
    /// Direction of the line.
    pub dx: f64,
    /// Likewise, y.
    pub dy: f64,
    /// Likewise, z.
    pub dz: f64,
}

/// A tree and its lines, transformed together: every count must stay. A row of `metamorphic.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MetamorphicRecord {
    /// Scene of the tree.
    pub scene: String,
    /// Strategy of the tree.
    pub strategy: String,
    /// What was done, e.g. `scale 2^-30`, `reflect x`, `axes yzx`.
    pub transform: String,
    /// `lines` or `lines:nearest`.
    pub rays: String,
    /// Lines.
    pub lines: u64,
    /// Nodes.
    pub nodes: u64,
    /// Nodes whose hits differ.
    pub differing_nodes: u64,
    /// Lines whose nearest hit, or n_K, n_B or n_t on the way to it, differs.
    pub differing_hits: u64,
}
