//! The parts of the experiment, each with what is asked of it.

use std::slice;

use crate::scene::Scene;
use crate::study::pieces::Extent;
use crate::study::{Watcher, guess};

use super::asked::{Coverage, Planes, Precision, Samplers, SpeedVsError};
use super::{Found, Piece, coverage, planes, precision, samplers};

/// One part.
#[derive(Clone, Copy)]
pub enum Part<'a> {
    Samplers(&'a Samplers),
    Precision(&'a Precision),
    Planes(&'a Planes),
    Coverage(&'a Coverage),
}

impl<'a> Part<'a> {
    /// Those that are asked for, in their order.
    pub fn all(asked: &'a SpeedVsError) -> impl Iterator<Item = Self> {
        let all = [
            asked.samplers.as_ref().map(Self::Samplers),
            asked.precision.as_ref().map(Self::Precision),
            asked.planes.as_ref().map(Self::Planes),
            asked.coverage.as_ref().map(Self::Coverage),
        ];
        all.into_iter().flatten()
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Samplers(_) => "Samplers",
            Self::Precision(_) => "Precision",
            Self::Planes(_) => "Planes",
            Self::Coverage(_) => "Coverage",
        }
    }

    /// All that is asked of it, as a text.
    pub fn section(self) -> String {
        match self {
            Self::Samplers(part) => format!("{part:?}"),
            Self::Precision(part) => format!("{part:?}"),
            Self::Planes(part) => format!("{part:?}"),
            Self::Coverage(part) => format!("{part:?}"),
        }
    }

    /// Its scenes.
    pub fn scenes(self) -> &'a [String] {
        match self {
            Self::Samplers(part) => &part.scenes,
            Self::Precision(part) => &part.scenes,
            Self::Planes(part) => &part.scenes,
            Self::Coverage(part) => slice::from_ref(&part.scene),
        }
    }

    /// What a scene amounts to; [`measure`](Self::measure) tells the watcher as many units done.
    pub fn extent(self, scene: &Scene) -> Extent {
        let objects = scene.bounds.len();
        let (units, lines, seconds) = match self {
            Self::Samplers(part) => {
                let lines = samplers::units(part);
                (lines, lines, guess::traced(lines))
            }
            Self::Precision(part) => {
                let units = precision::units(part);
                let timed = f64::from(part.rounds) * guess::timed(units / 2);
                (units, units, 5.0 * guess::traced(units) + timed)
            }
            Self::Planes(part) => {
                let trees = planes::units(part) as f64 / 2.0;
                let builds = 1.0 + f64::from(part.builds);
                (
                    planes::units(part),
                    0,
                    trees * builds * guess::tree(objects),
                )
            }
            Self::Coverage(part) => {
                let runs = u64::from(part.seeds) + 2 * u64::from(part.replicates);
                let lines = runs * part.lines;
                (coverage::units(part), lines, guess::traced(lines))
            }
        };
        Extent {
            things: 1,
            units,
            lines,
            seconds: guess::tree(objects) + seconds,
            bytes: guess::rows(200),
        }
    }

    /// Measure a scene; the error tells a fault of the program.
    pub fn measure(self, piece: &Piece<'_>, watcher: &impl Watcher) -> Result<Found, String> {
        match self {
            Self::Samplers(part) => samplers::measure(part, piece, watcher),
            Self::Precision(part) => Ok(precision::measure(part, piece, watcher)),
            Self::Planes(part) => planes::measure(part, piece, watcher),
            Self::Coverage(part) => coverage::measure(part, piece, watcher),
        }
    }
}
