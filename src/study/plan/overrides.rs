//! What the command line may change in an experiment.

use serde::{Deserialize, Serialize};

/// What the command line may change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Overrides {
    /// Another seed.
    pub seed: Option<u64>,
    /// Exactly so many lines a cell.
    pub lines: Option<u64>,
    /// The quick form.
    pub quick: bool,
}

impl Overrides {
    /// These, and where they are silent, others.
    pub fn or(self, others: Self) -> Self {
        Self {
            seed: self.seed.or(others.seed),
            lines: self.lines.or(others.lines),
            quick: self.quick || others.quick,
        }
    }

    /// As arguments of the command line, each with a space before it.
    pub fn arguments(&self) -> String {
        let mut text = String::new();
        if self.quick {
            text += " --quick";
        }
        if let Some(seed) = self.seed {
            text += &format!(" --seed {seed}");
        }
        if let Some(lines) = self.lines {
            text += &format!(" --lines {lines}");
        }
        text
    }
}
