//! Experiment files: strict TOML, validated once, trusted inside.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use thiserror::Error;

use crate::cost::CostModel;
use crate::kd::{StopRule, Strategy};

/// What an experiment asks for.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The file's stem: the name of its folders under `data/` and `plots/`.
    pub name: String,
    /// The command that repeats it, as printed in what it generates.
    pub command: String,
    /// The question, in one sentence.
    pub question: String,
    /// Seed of the lines.
    pub seed: u64,
    /// Scenes, as on the command line.
    pub scenes: Vec<String>,
    /// Strategies.
    pub strategies: Vec<Strategy>,
    /// The stop rule, the same for all.
    pub stop: StopRule,
    /// What steps cost.
    pub cost: CostModel,
    /// How many lines a cell counts.
    pub lines: LineRule,
    /// Whether `nodes.csv` has every cell's nodes; otherwise the figure's only.
    pub nodes: bool,
    /// The cell that the main figure shows.
    pub figure: Figure,
    /// Which checks are made of the samplers besides those of the run's own lines.
    pub controls: Option<Controls>,
    /// What is expected.
    pub expect: Expect,
    /// Whether this is the quick form.
    pub quick: bool,
}

/// How many lines a cell counts.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LineRule {
    /// Wanted half-width of the slope's 99 % interval around 1, with room for chance: see [`choose`](Self::choose).
    slope_error: f64,
    /// At least so many.
    min: u64,
    /// At most so many.
    max: u64,
}

/// 2.58 standard errors for the interval and 3.3 for chance: the interval lies within the wanted bounds in all but one of
/// two thousand correct runs.
const ROOM: f64 = 5.9;

/// Fewest lines a cell may count: two make a variance, and the contrasts' covariance needs more.
const FEWEST_LINES: u64 = 1024;
/// Most lines a cell may count: sums of squares of counts stay exact.
const MOST_LINES: u64 = 1 << 40;

impl LineRule {
    /// Exactly so many lines.
    pub fn exactly(lines: u64) -> Result<Self, String> {
        Self::for_error(1.0, lines, lines)
    }

    /// As many as a wanted error of the slope asks for, from `min` to `max`.
    pub fn for_error(slope_error: f64, min: u64, max: u64) -> Result<Self, String> {
        let rule = Self {
            slope_error,
            min,
            max,
        };
        rule.check()?;
        Ok(rule)
    }

    /// The smallest power of two times `min` for which 5.9 `sigma` / sqrt(N) is at most the wanted error, capped at the
    /// maximum. `sigma` is the standard deviation of the slope's per-line score.
    pub fn choose(&self, sigma: f64) -> u64 {
        let wanted = ROOM * sigma / self.slope_error;
        let mut n = self.min;
        while n < self.max && (n as f64) < wanted * wanted {
            n *= 2;
        }
        n.min(self.max)
    }

    /// The fewest lines it can give.
    pub fn at_least(&self) -> u64 {
        self.min
    }

    fn check(&self) -> Result<(), String> {
        if !(self.slope_error > 0.0 && self.slope_error <= 1.0) {
            return Err(format!(
                "lines.slope_error = {}, but it must be above 0 and at most 1",
                self.slope_error
            ));
        }
        if self.min < FEWEST_LINES {
            return Err(format!(
                "{} lines, but a cell needs at least {FEWEST_LINES} for its standard errors",
                self.min
            ));
        }
        if self.max < self.min || self.max > MOST_LINES {
            return Err(format!(
                "lines.max = {}, but it must be lines.min to {MOST_LINES}",
                self.max
            ));
        }
        Ok(())
    }
}

/// The cell a figure shows.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Figure {
    /// Its scene, one of the experiment's.
    pub scene: String,
    /// Its strategy, one of the experiment's.
    pub strategy: Strategy,
}

/// Negative controls: every law of lines there is, exact or not, goes through the sampler checks.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Controls {
    /// Lines of each law.
    pub lines: u64,
    /// Of a wrong law at least one p-value must lie below this.
    pub rejected_below: f64,
    /// Of an exact law all p-values must lie above this.
    pub accepted_above: f64,
}

/// Bounds written before the run that they judge.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expect {
    /// Every 99 % interval of a slope lies within 1 +- this.
    pub slope_within: f64,
    /// Chance that any of the simultaneous intervals of a correct run misses its prediction.
    pub family: f64,
    /// Level of the gate: Holm over the p-values of all cells.
    pub gate: f64,
}

/// Why an experiment cannot be run.
#[derive(Debug, Error)]
pub enum PlanError {
    /// The file cannot be read.
    #[error("{path}: cannot read the experiment", path = path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The file is not what an experiment looks like.
    #[error("{path}:{line}:{column}: {message}")]
    Syntax {
        /// The file.
        path: String,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong, and what would be right.
        message: String,
    },
    /// A value makes no sense.
    #[error("{path}: {message}")]
    Value {
        /// The file.
        path: String,
        /// What is wrong, and what would be right.
        message: String,
    },
}

/// The kinds of experiment there are.
pub const KINDS: [&str; 1] = ["hits-vs-area"];

/// The only key that must be known before the rest can be read.
#[derive(Deserialize)]
struct Header {
    kind: toml::Spanned<String>,
}

/// The file as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(rename = "kind")]
    _kind: String,
    question: String,
    seed: u64,
    scenes: Vec<String>,
    strategies: Vec<Strategy>,
    stop: StopRule,
    #[serde(default)]
    nodes: bool,
    cost: CostModel,
    lines: LineRule,
    figure: Figure,
    controls: Option<Controls>,
    expect: Expect,
    quick: Quick,
}

/// What `--quick` puts in place: smaller scenes, fewer lines, nothing else.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Quick {
    scenes: Vec<String>,
    lines: LineRule,
    figure: Figure,
    expect: Expect,
}

/// What the command line may change.
#[derive(Clone, Copy, Debug, Default)]
pub struct Overrides {
    /// Another seed.
    pub seed: Option<u64>,
    /// Exactly so many lines a cell.
    pub lines: Option<u64>,
    /// The quick form.
    pub quick: bool,
}

impl Plan {
    /// Read an experiment file.
    pub fn read(path: &Path, overrides: Overrides) -> Result<Self, PlanError> {
        let text = fs::read_to_string(path).map_err(|source| PlanError::Read {
            path: path.into(),
            source,
        })?;
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        Self::parse(&text, &path.display().to_string(), &stem, overrides)
    }

    /// Parse an experiment's text; `path` names it in errors, `name` its folders.
    pub fn parse(
        text: &str,
        path: &str,
        name: &str,
        overrides: Overrides,
    ) -> Result<Self, PlanError> {
        let at = |offset: usize, message: String| {
            let before = &text[..offset.min(text.len())];
            let line_start = before.rfind('\n').map_or(0, |i| i + 1);
            PlanError::Syntax {
                path: path.into(),
                line: before.matches('\n').count() + 1,
                column: before[line_start..].chars().count() + 1,
                message,
            }
        };
        let syntax =
            |e: toml::de::Error| at(e.span().map_or(0, |s| s.start), one_line(e.message()));
        let kind = toml::from_str::<Header>(text).map_err(syntax)?.kind;
        if !KINDS.contains(&kind.get_ref().as_str()) {
            let message = format!(
                "unknown kind '{}', expected one of {}",
                kind.get_ref(),
                KINDS.join(", ")
            );
            return Err(at(kind.span().start, message));
        }
        let file: File = toml::from_str(text).map_err(syntax)?;
        let quick = overrides.quick;
        let (mut scenes, mut lines, mut figure, mut expect) =
            (file.scenes, file.lines, file.figure, file.expect);
        if quick {
            (scenes, lines, figure, expect) = (
                file.quick.scenes,
                file.quick.lines,
                file.quick.figure,
                file.quick.expect,
            );
        }
        let value = |message: String| PlanError::Value {
            path: path.into(),
            message,
        };
        if let Some(n) = overrides.lines {
            lines = LineRule::exactly(n).map_err(value)?;
        }
        let plan = Self {
            name: name.into(),
            command: format!("validate run {path}{}", if quick { " --quick" } else { "" }),
            question: file.question,
            seed: overrides.seed.unwrap_or(file.seed),
            scenes,
            strategies: file.strategies,
            stop: file.stop,
            cost: file.cost,
            lines,
            nodes: file.nodes,
            figure,
            controls: file.controls.filter(|_| !quick),
            expect,
            quick,
        };
        plan.check().map_err(value)?;
        Ok(plan)
    }

    /// Whether the values make sense together; the error says what would.
    pub fn check(&self) -> Result<(), String> {
        if self.scenes.is_empty() || self.strategies.is_empty() {
            return Err("scenes and strategies must each name at least one".into());
        }
        let mut seen = HashSet::new();
        if let Some(twice) = self.scenes.iter().find(|s| !seen.insert(s.as_str())) {
            return Err(format!("scene '{twice}' is named twice"));
        }
        let mut seen = HashSet::new();
        if let Some(twice) = self.strategies.iter().find(|s| !seen.insert(**s)) {
            return Err(format!("strategy '{twice}' is named twice"));
        }
        if !self.scenes.contains(&self.figure.scene)
            || !self.strategies.contains(&self.figure.strategy)
        {
            let Figure { scene, strategy } = &self.figure;
            return Err(format!(
                "the figure's cell ({scene}, {strategy}) is not among the scenes and strategies"
            ));
        }
        let CostModel { c_k, c_b, c_t } = self.cost;
        if ![c_k, c_b, c_t].iter().all(|c| c.is_finite() && *c >= 0.0) || c_k + c_b + c_t == 0.0 {
            return Err(
                "the costs c_k, c_b, c_t must be finite, none negative, and not all 0".into(),
            );
        }
        let Expect {
            slope_within,
            family,
            gate,
        } = self.expect;
        if !(slope_within > 0.0 && (0.0..1.0).contains(&family) && (0.0..1.0).contains(&gate)) {
            return Err(
                "expect.slope_within must be above 0, expect.family and expect.gate 0 to 1".into(),
            );
        }
        if let Some(Controls {
            lines,
            rejected_below,
            accepted_above,
        }) = self.controls
            && !(lines >= FEWEST_LINES
                && (0.0..1.0).contains(&rejected_below)
                && (0.0..1.0).contains(&accepted_above))
        {
            return Err(format!(
                "controls.lines must be at least {FEWEST_LINES}, its bounds 0 to 1"
            ));
        }
        self.lines.check()
    }
}

fn one_line(message: &str) -> String {
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}
