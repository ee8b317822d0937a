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
    /// As many lines, or rays of a source, as bring the relative error of every tree's cost below this.
    pub error: Option<f64>,
    /// The quick form.
    pub quick: bool,
}

impl Overrides {
    /// These, and where they are silent, others.
    pub fn or(self, others: Self) -> Self {
        Self {
            seed: self.seed.or(others.seed),
            // A number of lines and an error that settles it are one choice.
            lines: self.lines.or(others.lines.filter(|_| self.error.is_none())),
            error: self.error.or(others.error.filter(|_| self.lines.is_none())),
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
        if let Some(error) = self.error {
            text += &format!(" --error {error}");
        }
        text
    }
}
