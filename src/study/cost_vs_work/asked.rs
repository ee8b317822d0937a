//! What a `cost-vs-work` experiment asks for besides its scenes.

use serde::{Deserialize, Serialize};

use crate::kd::{StopRule, Strategy};
use crate::study::LineRule;
use crate::study::hits::asked::check_family;
use crate::study::plan::{Wrong, each_once, wrong_unless};
use crate::study::ray_sets::{Number, RaysOf};
use crate::study::timing::halves;

/// The keys of this kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CostVsWork {
    /// Strategies.
    pub strategies: Vec<Strategy>,
    /// Stop rules.
    pub stops: Vec<StopRule>,
    /// Whether straddling triangles and polygons are clipped to the parts of a node.
    #[serde(default)]
    pub clipped: bool,
    /// Isotropic lines that a cell counts against the prediction.
    pub lines: LineRule,
    /// Sets of rays that are counted and timed.
    pub rays: Vec<RaysOf>,
    /// Rays of each set that comes from a source.
    pub number: u64,
    /// Wanted relative error of the cost C in every tree by the rays of every source: as many as that takes, at least `number`.
    pub error: Option<f64>,
    /// Pixels across and up of the picture, whose rays are counted all.
    pub pixels: u32,
    /// How seconds are measured.
    pub timing: Timing,
    /// How constants are fitted to them.
    pub calibration: Calibration,
    /// What is expected.
    pub expect: Expect,
}

/// How seconds are measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Timing {
    /// Rays of each set that are timed, and whose steps are counted.
    pub rays: u64,
    /// Visits and tests of a set in a scene's dearest tree above which the scene is timed with fewer of them.
    pub work: u64,
    /// Times that every chunk of rays is traced; even, so that there are two halves.
    pub rounds: u32,
}

/// How constants are fitted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// Draws of the bootstrap over groups of scenes.
    pub draws: u32,
}

/// Bounds written before the run that they judge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expect {
    /// Chance that any of the simultaneous intervals of a correct run misses its prediction.
    pub family: f64,
    /// Median relative error of the predicted time of scenes left out, at most.
    pub error_median: Option<f64>,
    /// Mean over scenes and sets of rays of Kendall's tau between predicted and measured time, at least.
    pub tau: Option<f64>,
    /// Mean regret of taking the tree of least predicted time, at most.
    pub regret: Option<f64>,
}

/// Most rays of a set, each of 64 bytes.
const MOST_RAYS: u64 = 1 << 24;
/// Most pixels across.
const MOST_PIXELS: u32 = 2048;

impl CostVsWork {
    /// Whether the values make sense together.
    pub fn check(&self, _: &[String]) -> Result<(), Wrong> {
        each_once("strategies", "strategy", &self.strategies)?;
        each_once("stops", "stop rule", &self.stops)?;
        RaysOf::check(&self.rays)?;
        let within = |key: &'static str, value: u64, most: u64| {
            wrong_unless((1..=most).contains(&value), key, || {
                format!("{key} = {value}, but it must be 1 to {most}")
            })
        };
        within("number", self.number, MOST_RAYS)?;
        Number::check_error(self.error)?;
        within("pixels", self.pixels.into(), MOST_PIXELS.into())?;
        within("timing.rays", self.timing.rays, MOST_RAYS)?;
        within("timing.work", self.timing.work, u64::MAX)?;
        halves("timing.rounds", self.timing.rounds)?;
        within("calibration.draws", self.calibration.draws.into(), 1 << 20)?;
        check_family(self.expect.family)?;
        let Expect {
            error_median,
            tau,
            regret,
            ..
        } = self.expect;
        for (key, bound) in [
            ("expect.error_median", error_median),
            ("expect.tau", tau),
            ("expect.regret", regret),
        ] {
            let share = bound.is_none_or(|bound| (0.0..=1.0).contains(&bound));
            wrong_unless(share, key, || {
                format!(
                    "{key} = {}, but it must be 0 to 1",
                    bound.unwrap_or_default()
                )
            })?;
        }
        self.lines.check()
    }
}
