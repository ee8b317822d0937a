//! What a `strategies` experiment asks for besides its scenes.

use serde::{Deserialize, Serialize};

use crate::kd::{StopRule, Strategy};
use crate::study::LineRule;
use crate::study::hits::asked::check_family;
use crate::study::plan::{Wrong, each_once, wrong_unless};
use crate::study::records::file_stem;
use crate::study::timing::Timing;
use crate::tracer::PIXELS;

use super::slices::SliceOf;

/// The keys of this kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Strategies {
    /// Strategies.
    pub strategies: Vec<Strategy>,
    /// Stop rules; each makes a table of its own.
    pub stops: Vec<StopRule>,
    /// Whether straddling triangles and polygons are clipped to the parts of a node.
    #[serde(default)]
    pub clipped: bool,
    /// Isotropic lines that a cell counts.
    pub lines: LineRule,
    /// Pixels across and up: (pixels + 1)^2 eye rays go through their corners.
    pub pixels: u32,
    /// Random pixel corners of every scene whose hits are held against brute force.
    pub checked: u32,
    /// How seconds are measured.
    pub timing: Timing,
    /// A slice through one of the scenes, to be drawn.
    pub slice: Option<SliceOf>,
    /// What is expected.
    pub expect: Expect,
}

/// Most pixels across: a ray takes 64 bytes, and an eye ray leads to up to a dozen.
const MOST_PIXELS: u32 = 2048;
/// Most rays held against brute force: each meets every object.
const MOST_CHECKED: u32 = 1_000_000;

/// Bounds written before the run that they judge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expect {
    /// Chance that any of the simultaneous intervals of a correct run misses its prediction.
    pub family: f64,
    /// Eye rays that hit something may differ from the published number by this many: of full pictures only.
    pub primary_hits_within: Option<u64>,
}

impl Strategies {
    /// Whether the values make sense together.
    pub fn check(&self, scenes: &[String]) -> Result<(), Wrong> {
        each_once("strategies", "strategy", &self.strategies)?;
        each_once("stops", "stop rule", &self.stops)?;
        wrong_unless((1..=MOST_PIXELS).contains(&self.pixels), "pixels", || {
            format!(
                "pixels = {}, but it must be 1 to {MOST_PIXELS}",
                self.pixels
            )
        })?;
        self.timing.check()?;
        let full = self.pixels == PIXELS;
        wrong_unless(
            full || self.expect.primary_hits_within.is_none(),
            "expect.primary_hits_within",
            || {
                format!(
                    "expect.primary_hits_within judges pictures of {PIXELS} pixels only, but pixels = {}",
                    self.pixels
                )
            },
        )?;
        wrong_unless(
            (1..=MOST_CHECKED).contains(&self.checked),
            "checked",
            || {
                format!(
                    "checked = {}, but it must be 1 to {MOST_CHECKED}",
                    self.checked
                )
            },
        )?;
        let stems: Vec<String> = self
            .stops
            .iter()
            .map(|s| file_stem(&s.to_string()))
            .collect();
        for (i, stem) in stems.iter().enumerate() {
            wrong_unless(!stems[..i].contains(stem), "stops", || {
                format!("two stop rules would both have files named '{stem}'")
            })?;
        }
        check_family(self.expect.family)?;
        if let Some(slice) = &self.slice {
            slice.check(scenes)?;
        }
        self.lines.check()
    }
}
