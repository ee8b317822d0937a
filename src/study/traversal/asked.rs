//! What a `traversal` experiment asks for besides its scenes.

use serde::{Deserialize, Serialize};

use crate::kd::{Ask, StopRule, Strategy};
use crate::study::plan::{Wrong, wrong_unless};
use crate::study::ray_sets::RaysOf;
use crate::study::timing::halves;

/// The keys of this kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Traversal {
    /// Strategy of the trees.
    pub strategy: Strategy,
    /// Stop rule of the trees.
    pub stop: StopRule,
    /// Sets of rays. Those that nothing stops are counted: no object is tested; all others ask for their nearest hit.
    pub rays: Vec<RaysOf>,
    /// Rays of each set that comes from a source.
    pub number: u64,
    /// Pixels across and up of the picture, all of whose rays are taken.
    pub pixels: u32,
    /// How seconds are measured.
    pub timing: Timing,
    /// What is expected.
    pub expect: Expect,
}

/// How seconds are measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Timing {
    /// Rays of each set that are timed.
    pub rays: u64,
    /// Visits and tests of a set by the way that makes most of them, above which fewer rays are timed.
    pub work: u64,
    /// Times that every chunk of rays is traced; even, so that there are two halves.
    pub rounds: u32,
    /// Times that every tree, its links and its face trees are built; even likewise.
    pub builds: u32,
}

/// Bounds written before the run that they judge. Equal hits, equal leaves and fewer inner nodes are expected by nature.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expect {
    /// Share of the rays of each source that each walk without a stack gives up, at most; rays that meet a leaf too thin for its
    /// planes to be told apart do not count.
    pub fall_backs: Shares,
}

/// A share for each precision.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shares {
    /// In double precision.
    pub f64: f64,
    /// In single precision.
    pub f32: f64,
}

/// Most rays of a set: each is kept in both precisions, with what it did.
const MOST_RAYS: u64 = 1 << 22;
/// Most pixels across.
const MOST_PIXELS: u32 = 1024;

impl Traversal {
    /// Whether the values make sense together.
    pub fn check(&self) -> Result<(), Wrong> {
        RaysOf::check(&self.rays)?;
        for set in &self.rays {
            wrong_unless(set.ask() != Ask::Any, "rays", || {
                format!(
                    "rays '{set}' end with any hit; take sets that nothing stops, such as lines, or that ask for the nearest hit, \
                     such as lines:nearest or primary"
                )
            })?;
        }
        self.check_number()?;
        let pixels = self.pixels;
        wrong_unless((1..=MOST_PIXELS).contains(&pixels), "pixels", || {
            format!("pixels = {pixels}, but it must be 1 to {MOST_PIXELS}")
        })?;
        let Timing {
            rays,
            work,
            rounds,
            builds,
        } = self.timing;
        for (key, value) in [("timing.rays", rays), ("timing.work", work)] {
            wrong_unless(value > 0, key, || {
                format!("{key} = 0, but it must be at least 1")
            })?;
        }
        halves("timing.rounds", rounds)?;
        halves("timing.builds", builds)?;
        let Shares { f64, f32 } = self.expect.fall_backs;
        for (key, share) in [
            ("expect.fall_backs.f64", f64),
            ("expect.fall_backs.f32", f32),
        ] {
            wrong_unless((0.0..=1.0).contains(&share), key, || {
                format!("{key} = {share}, but it must be 0 to 1")
            })?;
        }
        Ok(())
    }

    /// Whether the number of rays can be one.
    pub fn check_number(&self) -> Result<(), Wrong> {
        let number = self.number;
        wrong_unless((1..=MOST_RAYS).contains(&number), "number", || {
            format!("number = {number}, but it must be 1 to {MOST_RAYS}")
        })
    }
}
