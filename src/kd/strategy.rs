//! Strategies: which plane cuts a node. Numbered as in Havran's table (2000) where he has them.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::geom::{Aabb, Axis};

use super::planes::Fractions;

/// The rule that picks a node's plane. When to stop and where straddlers go is the same for all of them.
///
/// b_rm is the spatial median (middle of the node), b_om the object median (median of the centres of the objects'
/// bounds, clipped to the node). A node without objects has no bounds and no object median: only the spatial median can
/// cut it, which matters under the stop rule `depth`.
///
/// ```
/// use sahlab::kd::Strategy;
///
/// assert_eq!("sah".parse(), Ok(Strategy::Sah));
/// assert_eq!("sah-bins:64".parse::<Strategy>()?.name(), "sah-bins:64");
/// assert!("cheapest".parse::<Strategy>().is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Strategy {
    /// 1: b_rm, cyclic axis (depth mod 3: an octree's planes).
    SpatialMedian,
    /// 2: b_om, cyclic axis.
    ObjectMedian,
    /// 3: least cost over all axes and all object bounds; the reference.
    Sah,
    /// 4: least cost over all axes, object bounds between the medians and both medians.
    SahBetweenMedians,
    /// 5: least cost over the object bounds of one axis, cyclic.
    SahCyclic,
    /// 6: (b_rm + b_om)/2, cyclic axis.
    MedianMidpoint,
    /// 7: least cost over all axes, this many planes equally spaced between the medians and both medians.
    SahSamples(u16),
    /// Least cost over all axes, the planes between this many (2 or more) equal bins of the node. Not one of
    /// [`ALL`](Self::ALL): of the bins only the number tells one from another.
    SahBins(u16),
    /// 1 on the longest axis.
    SpatialMedianLongest,
    /// 2 on the longest axis.
    ObjectMedianLongest,
    /// 5 on the longest axis.
    SahLongest,
    /// 6 on the longest axis.
    MedianMidpointLongest,
}

/// In which order axes are asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AxisOrder {
    /// All three compete.
    All,
    /// Depth mod 3, then the next ones: the first with a candidate decides alone.
    Cyclic,
    /// The longest side first, then the others: the first with a candidate decides alone.
    Longest,
}

/// Which positions on an axis are candidates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Positions {
    SpatialMedian,
    ObjectMedian,
    MedianMidpoint,
    AllBounds,
    BoundsBetweenMedians,
    Samples(u16),
    Bins(u16),
}

/// Planes between the medians when none are given: as many as Havran's reading of MacDonald & Booth takes.
const SAMPLES: u16 = 10;

impl Strategy {
    /// Every strategy, in the order of the tables.
    pub const ALL: [Self; 11] = [
        Self::SpatialMedian,
        Self::ObjectMedian,
        Self::Sah,
        Self::SahBetweenMedians,
        Self::SahCyclic,
        Self::MedianMidpoint,
        Self::SahSamples(SAMPLES),
        Self::SpatialMedianLongest,
        Self::ObjectMedianLongest,
        Self::SahLongest,
        Self::MedianMidpointLongest,
    ];

    /// The name in files and on the command line.
    pub fn name(self) -> String {
        match self {
            Self::SpatialMedian => "spatial-median",
            Self::ObjectMedian => "object-median",
            Self::Sah => "sah",
            Self::SahBetweenMedians => "sah-between-medians",
            Self::SahCyclic => "sah-cyclic",
            Self::MedianMidpoint => "median-midpoint",
            Self::SahSamples(SAMPLES) => "sah-samples",
            Self::SahSamples(n) => return format!("sah-samples:{n}"),
            Self::SahBins(n) => return format!("sah-bins:{n}"),
            Self::SpatialMedianLongest => "spatial-median-longest",
            Self::ObjectMedianLongest => "object-median-longest",
            Self::SahLongest => "sah-longest",
            Self::MedianMidpointLongest => "median-midpoint-longest",
        }
        .into()
    }

    /// One line on what it does.
    pub fn description(self) -> String {
        match self {
            Self::SpatialMedian => "1: middle of the node, cyclic axis (an octree's planes)".into(),
            Self::ObjectMedian => "2: median of the objects' centres, cyclic axis".into(),
            Self::Sah => "3: least cost over all axes and object bounds (the reference)".into(),
            Self::SahBetweenMedians => {
                "4: least cost over all axes, object bounds between the two medians".into()
            }
            Self::SahCyclic => "5: least cost over the object bounds of one axis, cyclic".into(),
            Self::MedianMidpoint => "6: halfway between the two medians, cyclic axis".into(),
            Self::SahSamples(n) => {
                format!(
                    "7: least cost over all axes, {n} planes spaced between the two medians (sah-samples:N for another N)"
                )
            }
            Self::SahBins(n) => {
                format!(
                    "least cost over all axes, the planes between {n} equal bins of the node (sah-bins:N for another N)"
                )
            }
            Self::SpatialMedianLongest => "1 on the longest axis".into(),
            Self::ObjectMedianLongest => "2 on the longest axis".into(),
            Self::SahLongest => "5 on the longest axis".into(),
            Self::MedianMidpointLongest => "6 on the longest axis".into(),
        }
    }

    /// Whether nodes need their objects' bounds sorted.
    pub fn sweeps(self) -> bool {
        self.parts().1.are_bounds()
    }

    pub(super) fn parts(self) -> (AxisOrder, Positions) {
        match self {
            Self::SpatialMedian => (AxisOrder::Cyclic, Positions::SpatialMedian),
            Self::ObjectMedian => (AxisOrder::Cyclic, Positions::ObjectMedian),
            Self::Sah => (AxisOrder::All, Positions::AllBounds),
            Self::SahBetweenMedians => (AxisOrder::All, Positions::BoundsBetweenMedians),
            Self::SahCyclic => (AxisOrder::Cyclic, Positions::AllBounds),
            Self::MedianMidpoint => (AxisOrder::Cyclic, Positions::MedianMidpoint),
            Self::SahSamples(n) => (AxisOrder::All, Positions::Samples(n)),
            Self::SahBins(n) => (AxisOrder::All, Positions::Bins(n)),
            Self::SpatialMedianLongest => (AxisOrder::Longest, Positions::SpatialMedian),
            Self::ObjectMedianLongest => (AxisOrder::Longest, Positions::ObjectMedian),
            Self::SahLongest => (AxisOrder::Longest, Positions::AllBounds),
            Self::MedianMidpointLongest => (AxisOrder::Longest, Positions::MedianMidpoint),
        }
    }
}

impl Positions {
    /// Whether the objects' bounds are candidates, wherever they are.
    pub fn are_bounds(self) -> bool {
        matches!(self, Self::AllBounds | Self::BoundsBetweenMedians)
    }

    /// Where the other candidates are, between the node's faces or the medians.
    pub fn fractions(self) -> Fractions {
        match self {
            Self::AllBounds => Fractions::none(),
            Self::SpatialMedian | Self::ObjectMedian | Self::MedianMidpoint => Fractions::one(),
            // Both medians.
            Self::BoundsBetweenMedians => Fractions::samples(0),
            Self::Samples(count) => Fractions::samples(count),
            Self::Bins(count) => Fractions::bins(count),
        }
    }
}

impl AxisOrder {
    /// The axes in the order they are asked.
    pub(super) fn axes(self, depth: usize, bounds: &Aabb) -> [Axis; 3] {
        match self {
            Self::All => [0, 1, 2],
            Self::Cyclic => [depth % 3, (depth + 1) % 3, (depth + 2) % 3],
            Self::Longest => {
                let extent = bounds.extent();
                let mut axes = [0, 1, 2];
                // Stable: of equal sides the first axis goes first.
                axes.sort_by(|&a, &b| extent[b].total_cmp(&extent[a]));
                axes
            }
        }
    }
}

impl fmt::Display for Strategy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.name())
    }
}

impl FromStr for Strategy {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |of: &str, what: &str, least: u16| {
            text.strip_prefix(of).map(|n| match n.parse() {
                Ok(n) if n >= least => Ok(n),
                _ => Err(format!(
                    "'{text}': the number of {what} must be {least} to {}",
                    u16::MAX
                )),
            })
        };
        if let Some(n) = number("sah-samples:", "samples", 1) {
            return n.map(Self::SahSamples);
        }
        if let Some(n) = number("sah-bins:", "bins", 2) {
            return n.map(Self::SahBins);
        }
        Self::ALL
            .into_iter()
            .find(|s| s.name() == text)
            .ok_or_else(|| {
                let names: Vec<String> = Self::ALL.iter().map(|s| s.name()).collect();
                format!(
                    "unknown strategy '{text}', expected one of {}, sah-bins:N",
                    names.join(", ")
                )
            })
    }
}

impl TryFrom<String> for Strategy {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Strategy> for String {
    fn from(strategy: Strategy) -> Self {
        strategy.name()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_read_back() {
        let numbered = [Strategy::SahSamples(3), Strategy::SahBins(2)];
        for s in Strategy::ALL.into_iter().chain(numbered) {
            assert_eq!(s.name().parse(), Ok(s));
        }
        for wrong in [
            "sah-samples:0",
            "sah-samples:65536",
            "sah-bins:1",
            "sah-bins",
        ] {
            assert!(wrong.parse::<Strategy>().is_err(), "{wrong}");
        }
        let message = "sahh".parse::<Strategy>().expect_err("no such strategy");
        assert!(message.contains("sah-between-medians"), "{message}");
    }
}
