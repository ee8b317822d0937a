//! Stop rules: when a node becomes a leaf. The same for every strategy of a comparison.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// When a node becomes a leaf.
///
/// Every rule but `depth` and, between its levels, `octree` also ends at an empty node, at a depth bound, and where the
/// strategy has no candidate plane.
///
/// ```
/// use sahlab::kd::StopRule;
///
/// let havran: StopRule = "objects:2:16".parse()?;
/// assert_eq!(havran, StopRule::Objects { limit: 2, depth: Some(16) });
/// assert_eq!(havran.depth_bound(1_000_000), 16);
/// // Without a bound of its own it is 8 + 1.3 log2 N.
/// assert_eq!("cost-gain".parse::<StopRule>()?.depth_bound(1024), 21);
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum StopRule {
    /// `depth:D`: at depth D (at most [`MAX_FULL_DEPTH`]) and nowhere else. Empty nodes are cut too, but by the strategies
    /// of the spatial median only: no other has a candidate plane where there is no object. As a full tree is wanted, planes that keep all objects
    /// on both sides are taken; on a cube, strategy 1 at depth 3k makes a grid of 2^k cells a side.
    Depth(u32),
    /// `objects:N[:D]`: at most N objects, or depth D.
    Objects {
        /// Most objects in a leaf.
        limit: u32,
        /// Depth bound; without one see [`default_depth`].
        depth: Option<u32>,
    },
    /// `cost-k:K[:D]`: expected object tests n SA(K)/SA(R) at most K (MacDonald & Booth's f(b) <= k for all b).
    CostK {
        /// Most expected tests a line makes here.
        k: f64,
        /// Depth bound; without one see [`default_depth`].
        depth: Option<u32>,
    },
    /// `cost-gain[:D]`: where the chosen plane's one-level cost is no less than the leaf's, c_B + c_t n.
    CostGain {
        /// Depth bound; without one see [`default_depth`].
        depth: Option<u32>,
    },
    /// `automatic[:D]`: when the path from the root has had its share of planes that gain little (Havran & Bittner 2002):
    /// of those whose one-level cost is above 3/4 of the leaf's it may have 1 + D/5, rounded down.
    Automatic {
        /// Depth bound; without one see [`automatic_depth`].
        depth: Option<u32>,
    },
    /// `octree:N:D`: as `objects:N:D`, but asked at depths divisible by three only (D is one); nodes between are always cut,
    /// empty ones and by useless planes too, as under `depth`. With strategy 1 the cells are an octree's of D/3 levels.
    Octree {
        /// Most objects in a leaf.
        limit: u32,
        /// Depth bound, a multiple of 3 of at most [`MAX_FULL_DEPTH`]: every cell that an object fills is cut down to it.
        depth: u32,
    },
}

/// Depth bound where a rule names none: 8 + 1.3 floor(log2 N), rounded, as in pbrt (3rd edition, 4.4.1).
pub fn default_depth(objects: usize) -> usize {
    8 + (13 * objects.max(1).ilog2() as usize + 5) / 10
}

/// Depth bound of the rule `automatic` where it names none: 1.2 log2 N + 2, rounded (Havran & Bittner 2002).
pub fn automatic_depth(objects: usize) -> usize {
    libm::round(1.2 * libm::log2(objects.max(1) as f64) + 2.0) as usize
}

/// A plane whose one-level cost is above this share of the leaf's gains little: the rule `automatic` counts it.
const LITTLE_GAIN: f64 = 0.75;

/// Largest depth bound of any rule. It bounds the traversal stack (one entry a level) and the recursion of builder and streams;
/// the number of nodes is bounded by the objects, as these rules stop at empty nodes.
pub const MAX_DEPTH: u32 = 128;

/// Largest depth of the rule `depth`, which cuts empty nodes too: a full tree of that depth has 2^23 nodes, about a
/// gigabyte with its boxes and scores, and each level more would double it.
pub const MAX_FULL_DEPTH: u32 = 22;

impl StopRule {
    /// The depth at which every node becomes a leaf, in a tree over so many objects.
    pub fn depth_bound(self, objects: usize) -> usize {
        match self {
            Self::Depth(depth) | Self::Octree { depth, .. } => depth as usize,
            Self::Objects { depth, .. } | Self::CostK { depth, .. } | Self::CostGain { depth } => {
                depth.map_or_else(|| default_depth(objects), |d| d as usize)
            }
            Self::Automatic { depth } => {
                depth.map_or_else(|| automatic_depth(objects), |d| d as usize)
            }
        }
    }

    /// Planes of little gain that a path from the root may have: [`cuts`](Self::cuts) uses them up.
    pub(super) fn patience(self, objects: usize) -> usize {
        match self {
            Self::Automatic { .. } => 1 + self.depth_bound(objects) / 5,
            _ => 0,
        }
    }

    /// Whether planes that keep all objects on both sides are taken.
    pub(super) fn takes_useless_planes(self) -> bool {
        matches!(self, Self::Depth(_) | Self::Octree { .. })
    }

    /// Whether a node of `n` objects is a leaf before any plane is looked at; `share` is SA(K)/SA(R).
    pub(super) fn stops_at(self, depth: usize, n: usize, share: f64) -> bool {
        match self {
            Self::Octree { limit, .. } => depth.is_multiple_of(3) && n <= limit as usize,
            Self::Depth(_) => false,
            Self::Objects { limit, .. } => n <= limit as usize,
            Self::CostK { k, .. } => n as f64 * share <= k,
            Self::CostGain { .. } | Self::Automatic { .. } => n == 0,
        }
    }

    /// Whether a node is cut by its chosen plane, of one-level cost `split`, where a leaf would cost `leaf`: the patience
    /// left below it, or `None` for a leaf.
    pub(super) fn cuts(self, split: f64, leaf: f64, patience: usize) -> Option<usize> {
        match self {
            Self::CostGain { .. } => (split < leaf).then_some(patience),
            Self::Automatic { .. } if split > LITTLE_GAIN * leaf => patience.checked_sub(1),
            _ => Some(patience),
        }
    }
}

impl fmt::Display for StopRule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let depth = match *self {
            Self::Depth(d) => return write!(f, "depth:{d}"),
            Self::Octree { limit, depth } => return write!(f, "octree:{limit}:{depth}"),
            Self::Objects { limit, depth } => {
                write!(f, "objects:{limit}")?;
                depth
            }
            Self::CostK { k, depth } => {
                write!(f, "cost-k:{k}")?;
                depth
            }
            Self::CostGain { depth } => {
                write!(f, "cost-gain")?;
                depth
            }
            Self::Automatic { depth } => {
                write!(f, "automatic")?;
                depth
            }
        };
        depth.map_or(Ok(()), |d| write!(f, ":{d}"))
    }
}

impl FromStr for StopRule {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!(
                "'{text}' is no stop rule; expected depth:D, objects:N[:D], cost-k:K[:D], cost-gain[:D], \
                 automatic[:D] or octree:N:D with N >= 1, K >= 0 and a depth D of at most {MAX_DEPTH} (of depth:D and \
                 octree:N:D at most {MAX_FULL_DEPTH}, a full tree of 2^{} nodes; of octree:N:D a multiple of 3), e.g. objects:2:16",
                MAX_FULL_DEPTH + 1
            )
        };
        let mut parts = text.split(':');
        let rule = parts.next().unwrap_or_default();
        let depth_up_to = |most: u32, part: &str| match part.parse::<u32>() {
            Ok(d) if d <= most => Ok(d),
            _ => Err(wrong()),
        };
        let parameter = match rule {
            "cost-gain" | "automatic" => None,
            _ => Some(parts.next().ok_or_else(wrong)?),
        };
        let depth = parts
            .next()
            .map(|d| depth_up_to(MAX_DEPTH, d))
            .transpose()?;
        if parts.next().is_some() {
            return Err(wrong());
        }
        match (rule, parameter) {
            ("depth", Some(d)) if depth.is_none() => {
                Ok(Self::Depth(depth_up_to(MAX_FULL_DEPTH, d)?))
            }
            ("objects", Some(n)) => match n.parse() {
                Ok(limit) if limit > 0 => Ok(Self::Objects { limit, depth }),
                _ => Err(wrong()),
            },
            ("octree", Some(n)) => match (n.parse(), depth) {
                (Ok(limit), Some(depth))
                    if limit > 0 && depth <= MAX_FULL_DEPTH && depth.is_multiple_of(3) =>
                {
                    Ok(Self::Octree { limit, depth })
                }
                _ => Err(wrong()),
            },
            ("cost-k", Some(k)) => match k.parse() {
                Ok(k) if (0.0..f64::INFINITY).contains(&k) => Ok(Self::CostK { k, depth }),
                _ => Err(wrong()),
            },
            ("cost-gain", None) => Ok(Self::CostGain { depth }),
            ("automatic", None) => Ok(Self::Automatic { depth }),
            _ => Err(wrong()),
        }
    }
}

impl TryFrom<String> for StopRule {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<StopRule> for String {
    fn from(rule: StopRule) -> Self {
        rule.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_read_back() {
        for text in [
            "depth:9",
            "depth:22",
            "objects:1:128",
            "objects:2:16",
            "objects:1",
            "cost-k:0.5:20",
            "cost-k:3",
            "cost-gain",
            "cost-gain:40",
            "automatic",
            "automatic:16",
            "octree:2:21",
        ] {
            let rule: StopRule = text.parse().expect(text);
            assert_eq!(rule.to_string(), text);
        }
        for text in [
            "",
            "depth",
            "depth:23",
            "objects:1:129",
            "depth:3:4",
            "objects",
            "objects:0",
            "cost-k:-1",
            "cost-k:inf",
            "cost-gain:x",
            "objects:2:16:1",
            "automatic:129",
            "octree:2",
            "octree:2:16",
            "octree:2:24",
            "octree:0:15",
            "automatic:",
        ] {
            assert!(text.parse::<StopRule>().is_err(), "{text}");
        }
    }

    #[test]
    fn default_depths_are_pbrts() {
        assert_eq!(
            [1, 1_000, 10_000, 100_000].map(default_depth),
            [8, 20, 25, 29]
        );
    }

    #[test]
    fn automatic_depths_and_patience_are_havrans() {
        // 1.2 log2 N + 2 = 2, 13.96, 17.95, 21.93; one failure and one more for every five levels.
        let rule = StopRule::Automatic { depth: None };
        let found = [1, 1_000, 10_000, 100_000].map(|n| (rule.depth_bound(n), rule.patience(n)));
        assert_eq!(found, [(2, 1), (14, 3), (18, 4), (22, 5)]);
    }

    #[test]
    fn patience_is_for_planes_of_little_gain() {
        let rule = StopRule::Automatic { depth: None };
        assert_eq!(rule.cuts(75.0, 100.0, 0), Some(0));
        assert_eq!(rule.cuts(76.0, 100.0, 0), None);
        assert_eq!(rule.cuts(176.0, 100.0, 2), Some(1));
        let gain = StopRule::CostGain { depth: None };
        assert_eq!(gain.cuts(100.0, 100.0, 0), None);
        assert_eq!(gain.cuts(99.0, 100.0, 0), Some(0));
    }
}
