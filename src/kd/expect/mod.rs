//! What rays are expected to cost that are not the surface area metric's own lines: corrections computed from a tree and
//! the areas of its objects, without casting a ray.
//!
//! The metric's lines are isotropic, come from outside, never stop, and test an object once in every leaf. Each
//! [`Metric`] gives up one or two of these.

mod chord;
mod interior;
mod interior_occlusion;
mod mailbox;
mod occlusion;
mod parts;
mod surface;
mod ways;

use std::fmt;
use std::ops::{Add, Mul};
use std::str::FromStr;

pub use parts::Parts;

use super::{Tree, predict};

/// Expected visits and tests of one ray.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Expected {
    /// Inner nodes visited.
    pub n_k: f64,
    /// Leaves visited, empty ones too.
    pub n_b: f64,
    /// Objects tested.
    pub n_t: f64,
}

impl Expected {
    /// The visit of an inner node, without its children.
    const INNER: Self = Self {
        n_k: 1.0,
        n_b: 0.0,
        n_t: 0.0,
    };

    /// The visit of a leaf.
    fn leaf(objects: u32) -> Self {
        Self {
            n_k: 0.0,
            n_b: 1.0,
            n_t: f64::from(objects),
        }
    }
}

impl Add for Expected {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            n_k: self.n_k + other.n_k,
            n_b: self.n_b + other.n_b,
            n_t: self.n_t + other.n_t,
        }
    }
}

impl Mul<f64> for Expected {
    type Output = Self;

    fn mul(self, share: f64) -> Self {
        Self {
            n_k: self.n_k * share,
            n_b: self.n_b * share,
            n_t: self.n_t * share,
        }
    }
}

/// A law of rays and of what they do, for which counts are expected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Metric {
    /// Isotropic lines that never stop (MacDonald & Booth 1990): exact.
    Area,
    /// Isotropic rays from outside that stop at their nearest hit (after Haines, Ray Tracing News 17(1), and Ize & Hansen 2011).
    Occlusion,
    /// Rays from uniform points of the root's box, in uniform directions, that never stop (Fabianowski, Fowler & Dingliana
    /// 2009): exact but for interpolation in a table.
    Interior,
    /// Rays from uniform points of the root's box, in uniform directions, that stop at their nearest hit.
    InteriorOcclusion,
    /// Rays from uniform points of the objects' surfaces, by the cosine law, that stop at their next hit. They start on either
    /// side; where a surface lies in a face of the root, on the inner one.
    Surface,
    /// Isotropic lines that never stop and test no object twice (after Haines, Ray Tracing News 17(1), and Hunt 2008).
    Mailbox,
}

impl Metric {
    /// Every metric.
    pub const ALL: [Self; 6] = [
        Self::Area,
        Self::Occlusion,
        Self::Interior,
        Self::InteriorOcclusion,
        Self::Surface,
        Self::Mailbox,
    ];

    /// The name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Area => "area",
            Self::Occlusion => "occlusion",
            Self::Interior => "interior",
            Self::InteriorOcclusion => "interior-occlusion",
            Self::Surface => "surface",
            Self::Mailbox => "mailbox",
        }
    }

    /// One line on what it expects.
    pub fn description(self) -> &'static str {
        match self {
            Self::Area => "lines that never stop (the surface area metric itself)",
            Self::Occlusion => "rays from outside that stop at their nearest hit",
            Self::Interior => "rays from inside the root's box that never stop",
            Self::InteriorOcclusion => {
                "rays from inside the root's box that stop at their nearest hit"
            }
            Self::Surface => "rays from the objects' surfaces that stop at their nearest hit",
            Self::Mailbox => "lines that never stop and test no object twice",
        }
    }

    /// What a ray of this law is expected to do in a tree; `parts` are those of the tree's leaves.
    pub fn expected(self, tree: &Tree, parts: &Parts) -> Expected {
        match self {
            Self::Area => {
                let p = predict(tree);
                Expected {
                    n_k: p.n_k,
                    n_b: p.n_b,
                    n_t: p.n_t,
                }
            }
            Self::Occlusion => occlusion::expected(tree, parts),
            Self::Interior => interior::expected(tree),
            Self::InteriorOcclusion => interior_occlusion::expected(tree, parts),
            Self::Surface => surface::expected(tree, parts),
            Self::Mailbox => mailbox::expected(tree),
        }
    }
}

impl fmt::Display for Metric {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Metric {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|m| m.name() == text)
            .ok_or_else(|| {
                let names = Self::ALL.map(Self::name).join(", ");
                format!("unknown metric '{text}', expected one of {names}")
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_read_back() {
        for metric in Metric::ALL {
            assert_eq!(metric.name().parse(), Ok(metric));
            assert!(!metric.description().is_empty());
        }
        let message = "surfaces".parse::<Metric>().expect_err("no such metric");
        assert!(message.contains("interior-occlusion"), "{message}");
    }
}
