//! Ways to estimate by lines.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::kd::Ask;
use crate::rays::{LineLaw, Sampler, Source};
use crate::study::ray_sets::RaysOf;

use super::asked::Samplers;

/// A way to estimate by lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Independent lines.
    Random,
    /// A line in each of m^4 cells.
    Stratified,
    /// Owen-scrambled Sobol'.
    Sobol,
    /// Directions of independent lines, positions integrated exactly.
    Conditional,
    /// Directions of Owen-scrambled Sobol' lines, positions integrated exactly.
    ConditionalSobol,
}

impl Method {
    /// Each of them.
    pub const ALL: [Self; 5] = [
        Self::Random,
        Self::Stratified,
        Self::Sobol,
        Self::Conditional,
        Self::ConditionalSobol,
    ];

    /// One line on what it does.
    pub fn description(self) -> &'static str {
        match self {
            Self::Conditional => {
                "directions of random lines, positions integrated exactly: checks directions alone"
            }
            Self::ConditionalSobol => {
                "directions of sobol lines, positions integrated exactly: checks directions alone"
            }
            _ => self.sampler().description(),
        }
    }

    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Random => "random",
            Self::Stratified => "stratified",
            Self::Sobol => "sobol",
            Self::Conditional => "conditional",
            Self::ConditionalSobol => "conditional-sobol",
        }
    }

    /// How its lines are drawn.
    pub fn sampler(self) -> Sampler {
        match self {
            Self::Random | Self::Conditional => Sampler::Random,
            Self::Stratified => Sampler::Stratified,
            Self::Sobol | Self::ConditionalSobol => Sampler::Sobol,
        }
    }

    /// Whether positions are integrated exactly, so that no line is traversed.
    pub fn is_conditional(self) -> bool {
        matches!(self, Self::Conditional | Self::ConditionalSobol)
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A method, and what its lines ask.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Way {
    /// The method.
    pub method: Method,
    /// What its lines ask.
    pub ask: Ask,
}

impl Way {
    /// All that a part of an experiment asks for.
    pub fn all(asked: &Samplers) -> Vec<Self> {
        let ask = |ask: Ask| {
            asked
                .methods
                .iter()
                .map(move |&method| Self { method, ask })
        };
        let nearest =
            ask(Ask::Nearest).filter(|way| asked.reference > 0 && !way.method.is_conditional());
        ask(Ask::All).chain(nearest).collect()
    }

    /// The name of its rays, as a set of rays is named.
    pub fn rays(self) -> String {
        RaysOf::Source(Source::Law(LineLaw::Surface), self.ask).to_string()
    }

    /// The numbers of lines of its replicates: every power of two, or what the sampler has nearest to it.
    pub fn sizes(self, asked: &Samplers) -> Vec<u64> {
        let powers = asked.from.ilog2()..=asked.to.ilog2();
        let mut sizes: Vec<u64> = powers
            .map(|log2| self.method.sampler().nearest_size(1 << log2))
            .collect();
        sizes.dedup();
        sizes
    }
}
