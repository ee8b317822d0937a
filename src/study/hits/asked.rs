//! What a `hits-vs-area` experiment asks for besides its scenes.

use serde::{Deserialize, Serialize};

use crate::kd::{StopRule, Strategy};
use crate::study::LineRule;
use crate::study::lines::FEWEST_LINES;
use crate::study::plan::{Wrong, each_once, wrong_unless};

use super::work::Work;

/// The keys of this kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HitsVsArea {
    /// Strategies.
    pub strategies: Vec<Strategy>,
    /// The stop rule, the same for all.
    pub stop: StopRule,
    /// Whether straddling triangles and polygons are clipped to the parts of a node.
    #[serde(default)]
    pub clipped: bool,
    /// Whether `nodes.csv` has every cell's nodes; otherwise the figure's only.
    #[serde(default)]
    pub nodes: bool,
    /// How many lines a cell counts.
    pub lines: LineRule,
    /// The cell that the main figure shows.
    pub figure: Figure,
    /// Which checks are made of the samplers besides those of the run's own lines. None in the quick form.
    pub controls: Option<Controls>,
    /// Which sets of rays are traced through every tree besides.
    pub work: Option<Work>,
    /// What is expected.
    pub expect: Expect,
}

/// The cell a figure shows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Figure {
    /// Its scene, one of the experiment's.
    pub scene: String,
    /// Its strategy, one of the experiment's.
    pub strategy: Strategy,
}

/// Negative controls: every law of lines there is, exact or not, goes through the sampler checks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Controls {
    /// Lines of each law.
    pub lines: u64,
    /// Of a wrong law at least one p-value must lie below this.
    pub rejected_below: f64,
    /// Of an exact law all p-values must lie above this.
    pub accepted_above: f64,
}

/// Bounds written before the run that they judge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expect {
    /// Every 99 % interval of a slope lies within 1 +- this.
    pub slope_within: f64,
    /// Chance that any of the simultaneous intervals of a correct run misses its prediction.
    pub family: f64,
    /// Level of the gate: Holm over the p-values of all cells.
    pub gate: f64,
}

impl HitsVsArea {
    /// Whether the values make sense together and with the scenes.
    pub fn check(&self, scenes: &[String]) -> Result<(), Wrong> {
        each_once("strategies", "strategy", &self.strategies)?;
        let Figure { scene, strategy } = &self.figure;
        let drawn = scenes.contains(scene) && self.strategies.contains(strategy);
        wrong_unless(drawn, "figure", || {
            format!(
                "the figure's cell ({scene}, {strategy}) is not among the scenes and strategies"
            )
        })?;
        let Expect {
            slope_within,
            family,
            gate,
        } = self.expect;
        let finite = slope_within > 0.0 && slope_within.is_finite();
        wrong_unless(finite, "expect.slope_within", || {
            format!("expect.slope_within = {slope_within}, but it must be a number above 0")
        })?;
        check_family(family)?;
        wrong_unless((0.0..1.0).contains(&gate), "expect.gate", || {
            format!("expect.gate = {gate}, but it must be 0 to 1, 1 excluded")
        })?;
        if let Some(Controls {
            lines,
            rejected_below,
            accepted_above,
        }) = self.controls
        {
            wrong_unless(lines >= FEWEST_LINES, "controls.lines", || {
                format!("controls.lines = {lines}, but it must be at least {FEWEST_LINES}")
            })?;
            for (key, bound) in [
                ("controls.rejected_below", rejected_below),
                ("controls.accepted_above", accepted_above),
            ] {
                wrong_unless((0.0..1.0).contains(&bound), key, || {
                    format!("{key} = {bound}, but it must be 0 to 1, 1 excluded")
                })?;
            }
        }
        if let Some(work) = &self.work {
            work.check()?;
        }
        self.lines.check()
    }
}

/// Whether simultaneous intervals of this chance of a miss can be computed.
pub fn check_family(family: f64) -> Result<(), Wrong> {
    let likely = (LEAST_FAMILY..1.0).contains(&family);
    wrong_unless(likely, "expect.family", || {
        format!("expect.family = {family}, but it must be at least {LEAST_FAMILY:e} and below 1")
    })
}

/// The least chance of a miss of all intervals together for which their width can be computed.
const LEAST_FAMILY: f64 = 1e-12;
