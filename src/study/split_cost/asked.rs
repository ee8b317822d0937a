//! What a `split-cost` experiment asks for besides its scenes.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::kd::StopRule;
use crate::kd::stop::MAX_FULL_DEPTH;
use crate::study::plan::{Wrong, none_twice, wrong_unless};

/// The keys of this kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SplitCost {
    /// The stop rule of the trees, of strategy `sah`, whose inner nodes are looked at.
    pub stop: StopRule,
    /// Planes between the medians that strategy 7 would look at.
    pub samples: u16,
    /// Nodes whose curves are kept and drawn.
    pub curves: Vec<CurveOf>,
    /// The octree to compare strategy 1 with.
    pub octree: Option<OctreeOf>,
    /// What is expected.
    pub expect: Expect,
}

/// A node whose split cost is drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CurveOf {
    /// Its scene, one of the experiment's.
    pub scene: String,
    /// Its rank among the inner nodes by surface area: 1 is the root.
    pub rank: u32,
}

impl fmt::Display for CurveOf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of {}", self.rank, self.scene)
    }
}

/// An octree.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OctreeOf {
    /// Most objects of a cell that is not halved.
    pub limit: u32,
    /// Most halvings.
    pub levels: u32,
    /// Isotropic lines that are counted.
    pub lines: u64,
}

/// Bounds written before the run that they judge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expect {
    /// Both medians cost the same, up to this share, where theory says so.
    pub equal_within: f64,
}

/// Most lines of the octree: a sum of their squared counts stays exact.
const MOST_LINES: u64 = 1 << 32;

impl SplitCost {
    /// Whether the values make sense together and with the scenes.
    pub fn check(&self, scenes: &[String]) -> Result<(), Wrong> {
        wrong_unless(self.samples >= 1, "samples", || {
            "samples = 0, but at least 1 plane must lie between the medians".into()
        })?;
        for CurveOf { scene, rank } in &self.curves {
            wrong_unless(scenes.contains(scene), "curves", || {
                format!("the curves' scene '{scene}' is not among the scenes")
            })?;
            wrong_unless(*rank >= 1, "curves", || {
                "rank = 0, but the largest node, the root, has rank 1".into()
            })?;
        }
        none_twice("curves", "node", &self.curves)?;
        if let Some(OctreeOf {
            limit,
            levels,
            lines,
        }) = self.octree
        {
            let most = MAX_FULL_DEPTH / 3;
            wrong_unless(limit >= 1, "octree.limit", || {
                "octree.limit = 0, but it must be at least 1".into()
            })?;
            wrong_unless((1..=most).contains(&levels), "octree.levels", || {
                format!("octree.levels = {levels}, but it must be 1 to {most}")
            })?;
            wrong_unless((2..=MOST_LINES).contains(&lines), "octree.lines", || {
                format!("octree.lines = {lines}, but it must be 2 to {MOST_LINES}")
            })?;
        }
        let within = self.expect.equal_within;
        wrong_unless((0.0..1.0).contains(&within), "expect.equal_within", || {
            format!("expect.equal_within = {within}, but it must be 0 to 1, 1 excluded")
        })
    }
}
