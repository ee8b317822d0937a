//! What a `stability` experiment asks for besides its scenes.

use serde::{Deserialize, Serialize};

use crate::kd::{StopRule, Strategy};
use crate::study::kernel::Kernel;
use crate::study::plan::{Wrong, each_once, none_twice, wrong_unless};

/// The keys of this kind. The catalogue of hard cases goes through every strategy and kernel; `scenes` are those of the random
/// cases and of the metamorphic checks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stability {
    /// Strategies.
    pub strategies: Vec<Strategy>,
    /// Stop rule of every tree.
    pub stop: StopRule,
    /// Kernels.
    pub kernels: Vec<Kernel>,
    /// Only these cases of the catalogue; all if not given.
    pub cases: Option<Vec<String>>,
    /// Pairs of a random line and a box or triangle that the oracle judges, over all scenes and strategies; as many of each
    /// of the two.
    pub random: u64,
    /// Likewise, of lines aimed at edges and corners.
    pub aimed: u64,
    /// Lines of each metamorphic check.
    pub lines: u64,
}

/// Most pairs.
const MOST: u64 = 1 << 40;

impl Stability {
    /// Take so many pairs of each family.
    pub fn set_lines(&mut self, lines: u64) -> Result<(), String> {
        (self.random, self.aimed) = (lines, lines);
        self.check(&[]).map_err(|wrong| wrong.message)
    }

    /// Whether the values make sense together and with the scenes.
    pub fn check(&self, _scenes: &[String]) -> Result<(), Wrong> {
        each_once("strategies", "strategy", &self.strategies)?;
        none_twice("cases", "case", self.cases.as_deref().unwrap_or_default())?;
        let known = super::catalogue::select(self.cases.as_deref());
        wrong_unless(known.is_ok(), "cases", || known.err().unwrap_or_default())?;
        each_once("kernels", "kernel", &self.kernels)?;
        let f64_there = self.kernels.contains(&Kernel::F64);
        wrong_unless(f64_there, "kernels", || {
            "kernels must name 'f64', of which right answers are demanded".into()
        })?;
        for (key, pairs) in [("random", self.random), ("aimed", self.aimed)] {
            wrong_unless((1..=MOST).contains(&pairs), key, || {
                format!("{key} = {pairs}, but it must be 1 to 2^40")
            })?;
        }
        wrong_unless((1..=1 << 24).contains(&self.lines), "lines", || {
            format!("lines = {}, but it must be 1 to 2^24", self.lines)
        })
    }
}
