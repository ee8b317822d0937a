//! What an `assumptions` experiment asks for besides its scenes.

use serde::{Deserialize, Serialize};

use crate::kd::{Ask, Rules, StopRule, Strategy};
use crate::rays::{LineLaw, Source};
use crate::study::Plan;
use crate::study::hits::asked::{Figure, check_family};
use crate::study::plan::{Wrong, each_once, wrong_unless};
use crate::study::ray_sets::{Number, RaysOf};

/// The keys of this kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Assumptions {
    /// Strategies whose trees are traced and ranked.
    pub strategies: Vec<Strategy>,
    /// The stop rule of every tree.
    pub stop: StopRule,
    /// Whether straddling triangles and polygons are clipped to the parts of a node.
    #[serde(default)]
    pub clipped: bool,
    /// Sets of rays, each with assumptions of its own that it breaks.
    pub rays: Vec<RaysOf>,
    /// Rays of a source.
    pub number: u64,
    /// Wanted relative error of the cost C in every tree by the rays of every source: as many as that takes, at least `number`.
    pub error: Option<f64>,
    /// Pixels across and up of a picture whose rays are taken.
    pub pixels: u32,
    /// The tree whose nodes are drawn.
    pub figure: Figure,
    /// What is expected.
    pub expect: Expect,
}

/// Bounds written before the run that they judge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expect {
    /// Chance that any of the simultaneous intervals of a correct run misses its prediction; likewise of the exact checks.
    pub family: f64,
    /// Kendall's tau of the strategies' costs, predicted and counted: its mean over scenes and sets of rays is at least this.
    pub tau: f64,
    /// What taking the tree predicted to be cheapest costs above the cheapest: its mean over them is at most this share.
    pub regret: f64,
}

/// Most rays of a source: each takes 64 bytes, and every set is kept while a scene is measured.
const MOST_RAYS: u64 = 1 << 22;
/// Most pixels across, likewise.
const MOST_PIXELS: u32 = 1024;

impl Assumptions {
    /// Whether the values make sense together and with the scenes.
    pub fn check(&self, scenes: &[String]) -> Result<(), Wrong> {
        each_once("strategies", "strategy", &self.strategies)?;
        wrong_unless(self.strategies.len() > 1, "strategies", || {
            "strategies must name at least two, which the metric and the rays rank".into()
        })?;
        RaysOf::check(&self.rays)?;
        wrong_unless(
            self.rays.iter().any(|&rays| is_control(rays)),
            "rays",
            || "rays must name 'lines', the control that keeps every assumption".into(),
        )?;
        self.check_number()?;
        Number::check_error(self.error)?;
        wrong_unless((1..=MOST_PIXELS).contains(&self.pixels), "pixels", || {
            format!(
                "pixels = {}, but it must be 1 to {MOST_PIXELS}",
                self.pixels
            )
        })?;
        let Figure { scene, strategy } = &self.figure;
        let drawn = scenes.contains(scene) && self.strategies.contains(strategy);
        wrong_unless(drawn, "figure", || {
            format!(
                "the figure's cell ({scene}, {strategy}) is not among the scenes and strategies"
            )
        })?;
        let Expect {
            family,
            tau,
            regret,
        } = self.expect;
        check_family(family)?;
        wrong_unless((-1.0..=1.0).contains(&tau), "expect.tau", || {
            format!("expect.tau = {tau}, but a rank correlation is -1 to 1")
        })?;
        wrong_unless(regret >= 0.0, "expect.regret", || {
            format!("expect.regret = {regret}, but it must be a number, 0 or more")
        })
    }

    /// Whether a source can have so many rays.
    pub fn check_number(&self) -> Result<(), Wrong> {
        wrong_unless((2..=MOST_RAYS).contains(&self.number), "number", || {
            format!(
                "{} rays of a source, but it must be 2 to {MOST_RAYS}",
                self.number
            )
        })
    }

    /// The rules of every tree over a scene.
    pub(super) fn rules(&self, plan: &Plan) -> Vec<Rules> {
        Rules::crossed(&[self.stop], &self.strategies, plan.cost, self.clipped)
    }

    /// How many rays.
    pub(super) fn sizes(&self) -> Number {
        Number {
            rays: self.number,
            pixels: self.pixels,
            error: self.error,
        }
    }
}

/// Whether these rays are uniform in origin and direction: what the metric assumes first. Rays in isotropic directions from
/// uniform points are, as far as they begin inside, which breaks another assumption.
pub fn is_uniform(rays: RaysOf) -> bool {
    match rays {
        RaysOf::Source(Source::Law(law), _) => {
            LineLaw::EXACT.contains(&law) || law == LineLaw::VolumeRay
        }
        RaysOf::Source(Source::Beam | Source::Eye | Source::Objects, _)
        | RaysOf::Traced(_)
        | RaysOf::Own(_) => false,
    }
}

/// Whether these rays keep all assumptions of the metric: the control.
pub fn is_control(rays: RaysOf) -> bool {
    let exact = |law| LineLaw::EXACT.contains(&law);
    matches!(rays, RaysOf::Source(Source::Law(law), Ask::All) if exact(law))
}
