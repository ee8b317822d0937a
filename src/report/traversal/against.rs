//! Ways beside the stack: what they save, and whether the seconds can tell it.

use statrs::distribution::{ContinuousCDF, StudentsT};

use super::Traversal;
use crate::report::series::distinct;
use crate::report::strategies::averages::Averages;
use crate::study::records::{LinkRecord, PassTiming, RUN, TraversalRecord};

/// The way that all others are held against.
pub const STACK: &str = "stack";
/// The other ways, in the order in which they are told.
pub const WAYS: [&str; 3] = ["links", "face-trees", "restart"];
/// Both precisions.
pub const PRECISIONS: [&str; 2] = ["f64", "f32"];

/// The name of times of building a tree, and the beginning of those of building what ways need.
pub const BUILD: &str = "build";

/// What shifts all rays of a pass alike, such as where its data lie in memory, is no less than this.
const NOISE: f64 = 0.01;

/// Chance that the scatter of rays makes any of a run's ratios look faster or slower that is not.
const FALSE_ALARMS: f64 = 0.01;

/// What the seconds say of a way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Speed {
    /// Faster than the stack.
    Faster,
    /// Slower.
    Slower,
    /// The seconds cannot tell.
    Undecided,
}

/// A set of rays along one way beside the same along the stack, in one precision.
#[derive(Clone, Copy, Debug)]
pub struct Against<'r> {
    /// The way's row.
    pub own: &'r TraversalRecord,
    /// The stack's row.
    pub stack: &'r TraversalRecord,
    /// Ratios of the run, all of which are judged.
    judged: usize,
    times: Option<[&'r PassTiming; 2]>,
}

impl<'r> Against<'r> {
    /// Inner nodes over the stack's.
    pub fn inner(&self) -> Option<f64> {
        let [own, stack] = [self.own, self.stack].map(|row| row.inner_visits as f64);
        positive(own / stack)
    }

    /// Seconds over the stack's.
    pub fn seconds(&self) -> Option<f64> {
        let [own, stack] = self.times?;
        positive(own.seconds / stack.seconds)
    }

    /// How far the ratio of the seconds can be believed, over the ratio: half of its interval, by the scatter of runs of rays (Student's
    /// t; all of a run hold together with 1 - [`FALSE_ALARMS`], Bonferroni), and on top of it what shifts a pass as a whole: as far as
    /// the ratios of the even and of the odd rounds are apart, at least [`NOISE`]. Infinite for less than two runs of rays.
    pub fn error(&self) -> Option<f64> {
        let [own, stack] = self.times?;
        let a = positive(own.half_a_s / stack.half_a_s)?;
        let b = positive(own.half_b_s / stack.half_b_s)?;
        let shift = ((a - b).abs() / a.min(b)).max(NOISE);
        let draws = own.timed_units.div_ceil(RUN as u64);
        let Ok(law) = StudentsT::new(0.0, 1.0, draws as f64 - 1.0) else {
            return Some(f64::INFINITY);
        };
        let t = law.inverse_cdf(1.0 - 0.5 * FALSE_ALARMS / self.judged as f64);
        Some(t * own.sampling_se_s / own.seconds + shift)
    }

    /// What the seconds say.
    pub fn speed(&self) -> Option<Speed> {
        let (ratio, certain) = (self.seconds()?, 1.0 + self.error()?);
        Some(if ratio * certain < 1.0 {
            Speed::Faster
        } else if ratio > certain {
            Speed::Slower
        } else {
            Speed::Undecided
        })
    }

    /// Whether one of both times was disturbed.
    pub fn disturbed(&self) -> bool {
        self.times.into_iter().flatten().any(|time| time.disturbed)
    }
}

fn positive(ratio: f64) -> Option<f64> {
    (ratio.is_finite() && ratio > 0.0).then_some(ratio)
}

impl Traversal {
    /// Sets of rays, in the order of the run.
    pub fn sets(&self) -> Vec<&str> {
        distinct(self.walks.iter().map(|row| row.rays.as_str()))
    }

    /// Scenes, in the order of the run.
    pub fn scenes(&self) -> Vec<&str> {
        distinct(self.walks.iter().map(|row| row.scene.as_str()))
    }

    /// The row of a way of the same rays, tree and precision as another row's.
    pub fn beside(&self, row: &TraversalRecord, way: &str) -> Option<&TraversalRecord> {
        let same = |other: &&TraversalRecord| {
            (&other.cell, &other.rays, &other.precision) == (&row.cell, &row.rays, &row.precision)
                && other.way == way
        };
        self.walks.iter().find(same)
    }

    /// A row beside the stack's.
    pub fn against<'r>(&'r self, own: &'r TraversalRecord) -> Option<Against<'r>> {
        let stack = self.beside(own, STACK)?;
        let judged = self.walks.iter().filter(|row| row.way != STACK).count();
        Some(Against {
            own,
            stack,
            judged,
            times: self.time_of(own).zip(self.time_of(stack)).map(Into::into),
        })
    }

    /// One way over all scenes, for one set of rays in one precision.
    pub fn of(&self, rays: &str, precision: &str, way: &str) -> Vec<Against<'_>> {
        let rows = self.rows(rays, precision, way).into_iter();
        rows.filter_map(|row| self.against(row)).collect()
    }

    fn rows(&self, rays: &str, precision: &str, way: &str) -> Vec<&TraversalRecord> {
        let own = self.walks.iter().filter(|row| {
            (row.rays.as_str(), row.precision.as_str(), row.way.as_str()) == (rays, precision, way)
        });
        own.collect()
    }

    /// Seconds of a way in single precision over those in double, by scene; the stack too is a way here.
    pub fn narrow_over_wide(&self, rays: &str, way: &str) -> Vec<(&str, f64)> {
        let [wide, narrow] = PRECISIONS.map(|precision| self.rows(rays, precision, way));
        let ratio = |row: &TraversalRecord| {
            let other = wide.iter().find(|other| other.cell == row.cell)?;
            positive(self.time_of(row)?.seconds / self.time_of(other)?.seconds)
        };
        let known = narrow
            .into_iter()
            .filter_map(|row| Some((row.scene.as_str(), ratio(row)?)));
        known.collect()
    }

    /// Every ratio of seconds at which a way is faster than the stack.
    pub fn faster(&self) -> Vec<Against<'_>> {
        let all = self.walks.iter().filter_map(|row| self.against(row));
        all.filter(|row| row.speed() == Some(Speed::Faster))
            .collect()
    }

    /// How many ratios of seconds there are.
    pub fn ratios(&self) -> u64 {
        let others = self.walks.iter().filter(|row| row.way != STACK);
        others
            .filter_map(|row| self.against(row)?.seconds())
            .count() as u64
    }

    /// The tree of a row, in its precision.
    pub fn tree(&self, row: &TraversalRecord) -> Option<&LinkRecord> {
        let mut trees = self.links.iter();
        trees.find(|tree| (&tree.cell, &tree.precision) == (&row.cell, &row.precision))
    }

    /// The latest time of one thing done with one tree: rows of earlier runs stand before it.
    pub fn timing(&self, cell: &str, what: &str) -> Option<&PassTiming> {
        let own = |row: &&PassTiming| row.cell == cell && row.what == what && row.units > 0;
        self.timings.iter().rev().find(own)
    }

    /// The time of a row.
    pub fn time_of(&self, row: &TraversalRecord) -> Option<&PassTiming> {
        let what = format!("{} {} {}", row.rays, row.precision, row.way);
        self.timing(&row.cell, &what)
    }

    /// Seconds of building the links or face trees of a tree over those of building the tree. Face trees are made from links, so
    /// that both are built.
    pub fn building(&self, row: &LinkRecord, way: &str) -> Option<f64> {
        let seconds = |what: &str| {
            let what = format!("{BUILD} {what} {}", row.precision);
            Some(self.timing(&row.cell, &what)?.seconds)
        };
        let tree = self.timing(&row.cell, BUILD)?.seconds;
        let links = seconds("links")?;
        match way {
            "links" => positive(links / tree),
            "face-trees" => positive((links + seconds("face-trees")?) / tree),
            _ => None,
        }
    }
}

/// Bytes of a tree and what a way needs beside it; a restart needs nothing.
pub fn bytes(row: &LinkRecord, way: &str) -> u64 {
    row.tree_bytes + beside(row, way).unwrap_or(0)
}

/// Bytes that a way needs beside the tree; `None` of one that needs nothing.
pub fn beside(row: &LinkRecord, way: &str) -> Option<u64> {
    match way {
        "links" => Some(row.link_bytes),
        "face-trees" => Some(row.face_tree_bytes),
        _ => None,
    }
}

/// Bytes of a tree with what a way needs beside it, over those of the tree alone.
pub fn memory(row: &LinkRecord, way: &str) -> Option<f64> {
    beside(row, way)?;
    positive(bytes(row, way) as f64 / row.tree_bytes as f64)
}

/// Averages over scenes of a measure of what is known.
pub fn averages<'r>(
    rows: &[Against<'r>],
    measure: impl Fn(&Against<'r>) -> Option<f64>,
) -> Option<Averages<'r>> {
    let known = |row: &Against<'r>| Some((row.own.scene.as_str(), measure(row)?));
    let ratios: Vec<_> = rows.iter().filter_map(known).collect();
    Averages::of(&ratios)
}

/// How many are faster, slower and undecided.
pub fn outcomes(rows: &[Against<'_>]) -> [u64; 3] {
    let number = |speed| rows.iter().filter(|row| row.speed() == Some(speed)).count() as u64;
    [Speed::Faster, Speed::Slower, Speed::Undecided].map(number)
}
