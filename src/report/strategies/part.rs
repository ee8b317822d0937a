//! The trees of one stop rule, and what is measured of each.

use super::Strategies;
use crate::cost::CostModel;
use crate::report::series::distinct;
use crate::study::records::{CellRecord, PassTiming, RayRecord};

/// The strategy that all others are measured against, as Havran's third.
pub use crate::report::tables::REFERENCE;

/// Something of a tree that is the better the smaller it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Tree cost C from surface areas.
    Predicted,
    /// Tree cost C from the counts of isotropic lines.
    Counted,
    /// The same constants times the counts of all rays of the picture, per ray.
    Traced,
    /// Seconds of building the tree and tracing all rays.
    Total,
    /// Seconds of tracing all rays.
    Trace,
    /// Seconds of building the tree.
    Build,
}

impl Measure {
    /// Those that follow from counts.
    pub const COSTS: [Self; 3] = [Self::Predicted, Self::Counted, Self::Traced];
    /// Those that a clock tells.
    pub const TIMES: [Self; 3] = [Self::Total, Self::Trace, Self::Build];

    /// Its name in a row of a table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Predicted => "C predicted",
            Self::Counted => "C counted",
            Self::Traced => "C of traced rays",
            Self::Total => "total time",
            Self::Trace => "trace time",
            Self::Build => "build time",
        }
    }

    /// What it is, for captions.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Predicted => "C predicted: tree cost from surface areas",
            Self::Counted => "C counted: tree cost from the visits of isotropic lines",
            Self::Traced => {
                "C of traced rays: the same constants times the visits of the rays of the picture, per ray"
            }
            Self::Total => {
                "total time: seconds to build the tree and to trace all rays of the picture"
            }
            Self::Trace => "trace time: seconds to trace all rays of the picture",
            Self::Build => "build time: seconds to build the tree",
        }
    }
}

/// One tree and all that was found of it.
pub struct Tree<'r> {
    /// Its row of `cells.csv`.
    pub cell: &'r CellRecord,
    /// Its rows of `rays.csv`.
    pub rays: Vec<&'r RayRecord>,
    /// Its rows of `timings.csv`.
    pub times: Vec<&'r PassTiming>,
}

/// What the traced rays of one tree are timed by, besides its building.
pub const KINDS: [&str; 3] = ["primary", "shadow", "secondary"];

/// The row of the building of a tree.
pub const BUILD: &str = "build";

impl<'r> Tree<'r> {
    /// The tree of a cell of this run.
    pub fn new(run: &'r Strategies, cell: &'r CellRecord) -> Self {
        let rays = run.rays.iter().filter(|row| row.cell == cell.cell);
        let times = run.timings.iter().flatten();
        Tree {
            cell,
            rays: rays.collect(),
            times: times.filter(|row| row.cell == cell.cell).collect(),
        }
    }

    /// c_K n_K + c_B n_B + c_t n_t for the visits of these rays together.
    pub fn cost_of(&self, rays: &RayRecord) -> f64 {
        let CellRecord { c_k, c_b, c_t, .. } = *self.cell;
        let [inner, leaves, tests] =
            [rays.inner_visits, rays.leaf_visits, rays.object_tests].map(|n| n as f64);
        CostModel { c_k, c_b, c_t }.cost(inner, leaves, tests)
    }

    /// The row of `timings.csv` of building or of a kind of rays.
    pub fn time(&self, what: &str) -> Option<&PassTiming> {
        self.times.iter().copied().find(|row| row.what == what)
    }

    /// Seconds of tracing the rays of every kind.
    fn trace_s(&self) -> Option<f64> {
        let seconds = KINDS.iter().map(|kind| Some(self.time(kind)?.seconds));
        seconds.sum()
    }

    /// One measure of the tree; None where it was not measured.
    pub fn value(&self, measure: Measure) -> Option<f64> {
        match measure {
            Measure::Predicted => Some(self.cell.c_predicted),
            Measure::Counted => Some(self.cell.c_counted),
            Measure::Traced => {
                let number: u64 = self.rays.iter().map(|rays| rays.rays).sum();
                let cost: f64 = self.rays.iter().map(|rays| self.cost_of(rays)).sum();
                (number > 0).then(|| cost / number as f64)
            }
            Measure::Total => Some(self.value(Measure::Build)? + self.trace_s()?),
            Measure::Trace => self.trace_s(),
            Measure::Build => Some(self.time(BUILD)?.seconds),
        }
    }
}

/// The trees of one stop rule.
pub struct Part<'r> {
    /// The rule.
    pub stop: &'r str,
    /// Its scenes, in the order of the run.
    pub scenes: Vec<&'r str>,
    /// Strategies of the whole run, in its order, so that each looks the same in every figure.
    pub strategies: Vec<&'r str>,
    /// Its rows of `cells.csv`.
    pub cells: Vec<CellRecord>,
    /// All of them.
    pub trees: Vec<Tree<'r>>,
}

impl<'r> Part<'r> {
    /// The trees of a run that stopped by this rule.
    pub fn new(run: &'r Strategies, stop: &'r str) -> Self {
        let cells = run.cells.iter().filter(|cell| cell.stop == stop);
        Part {
            stop,
            scenes: distinct(cells.clone().map(|cell| cell.scene.as_str())),
            strategies: distinct(run.cells.iter().map(|cell| cell.strategy.as_str())),
            cells: cells.clone().cloned().collect(),
            trees: cells.map(|cell| Tree::new(run, cell)).collect(),
        }
    }

    /// The tree of a strategy over a scene.
    pub fn tree(&self, scene: &str, strategy: &str) -> Option<&Tree<'r>> {
        let mut trees = self.trees.iter();
        trees.find(|tree| tree.cell.scene == scene && tree.cell.strategy == strategy)
    }

    /// A measure of a strategy's tree over a scene; only if it is a positive number.
    pub fn value(&self, measure: Measure, scene: &str, strategy: &str) -> Option<f64> {
        let value = self.tree(scene, strategy)?.value(measure)?;
        (value.is_finite() && value > 0.0).then_some(value)
    }

    /// How many times as much `strategy` takes as `other`, over one scene.
    pub fn ratio(&self, measure: Measure, scene: &str, strategy: &str, other: &str) -> Option<f64> {
        let value = |strategy| self.value(measure, scene, strategy);
        Some(value(strategy)? / value(other)?)
    }

    /// The same over every scene that has both trees.
    pub fn ratios(&self, measure: Measure, strategy: &str, other: &str) -> Vec<(&'r str, f64)> {
        let of = |&scene| Some((scene, self.ratio(measure, scene, strategy, other)?));
        self.scenes.iter().filter_map(of).collect()
    }
}
