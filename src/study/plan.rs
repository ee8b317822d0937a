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
    /// The file's stem, with `-quick` behind it in the quick form: the name of its folders under `data/` and `plots/`.
    pub name: String,
    /// The command that repeats it, as printed in what it generates.
    pub command: String,
    /// The question, in one sentence.
    pub question: String,
    /// Seed of the run; each scene's lines have their own from it.
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
        rule.check().map_err(|wrong| wrong.message)?;
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

    fn check(&self) -> Result<(), Wrong> {
        let Self {
            slope_error,
            min,
            max,
        } = *self;
        wrong_unless(
            slope_error > 0.0 && slope_error <= 1.0,
            "lines.slope_error",
            || format!("lines.slope_error = {slope_error}, but it must be above 0 and at most 1"),
        )?;
        wrong_unless(min >= FEWEST_LINES, "lines.min", || {
            format!("{min} lines, but a cell needs at least {FEWEST_LINES} for its standard errors")
        })?;
        wrong_unless((min..=MOST_LINES).contains(&max), "lines.max", || {
            format!("lines.max = {max}, but it must be lines.min = {min} to {MOST_LINES}")
        })
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

/// A value that makes no sense.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{message}")]
pub struct Wrong {
    /// Its key in the file, with dots between tables and keys.
    pub key: &'static str,
    /// What is wrong, and what would be right.
    pub message: String,
}

fn wrong_unless(
    right: bool,
    key: &'static str,
    message: impl FnOnce() -> String,
) -> Result<(), Wrong> {
    if right {
        return Ok(());
    }
    let message = message();
    Err(Wrong { key, message })
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
    /// A value that stands nowhere in the file makes no sense.
    #[error("{path}: {message}")]
    Value {
        /// The file, or the option of the command line.
        path: String,
        /// What is wrong, and what would be right.
        message: String,
    },
}

/// Names of folders that are no run's under `data/`.
const RESERVED: [&str; 3] = ["published", "reference", "bench"];

/// Whether this can be the name of a folder for a run or a benchmark.
pub fn is_folder_name(name: &str) -> bool {
    let plain = |c: char| c.is_alphanumeric() || "-_.".contains(c);
    !name.is_empty() && !name.starts_with('.') && name.chars().all(plain)
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
    quick: Option<Quick>,
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

impl Overrides {
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
        let value = |message: &str| PlanError::Value {
            path: path.into(),
            message: message.into(),
        };
        if !is_folder_name(name) || RESERVED.iter().any(|r| r.eq_ignore_ascii_case(name)) {
            return Err(value(&format!(
                "'{name}' cannot name the folders of a run; the file's name must have letters, digits, '-', '_' and '.' \
                 only, not start with '.', and not be one of {}",
                RESERVED.join(", ")
            )));
        }
        if quick {
            let small = file.quick.ok_or_else(|| {
                value(
                    "--quick needs a section [quick] that says the smaller form: scenes, lines, figure and expect, \
                     each as outside of it",
                )
            })?;
            (scenes, lines, figure, expect) =
                (small.scenes, small.lines, small.figure, small.expect);
        }
        let mut command = format!("validate run {path}");
        command += &overrides.arguments();
        if let Some(n) = overrides.lines {
            lines = LineRule::exactly(n).map_err(|message| PlanError::Value {
                path: format!("--lines {n}"),
                message,
            })?;
        }
        let plan = Self {
            name: format!("{name}{}", if quick { "-quick" } else { "" }),
            command,
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
        plan.check()
            .map_err(|Wrong { key, message }| match place(text, key, quick) {
                Some(offset) => at(offset, message),
                None => value(&message),
            })?;
        Ok(plan)
    }

    /// Whether the values make sense together; the error says what would.
    pub fn check(&self) -> Result<(), Wrong> {
        wrong_unless(!self.question.trim().is_empty(), "question", || {
            "the question is empty; it is printed with every answer".into()
        })?;
        for (key, empty) in [
            ("scenes", self.scenes.is_empty()),
            ("strategies", self.strategies.is_empty()),
        ] {
            wrong_unless(!empty, key, || format!("{key} must name at least one"))?;
        }
        let mut seen = HashSet::new();
        for scene in &self.scenes {
            wrong_unless(seen.insert(scene.as_str()), "scenes", || {
                format!("scene '{scene}' is named twice")
            })?;
        }
        let mut seen = HashSet::new();
        for &strategy in &self.strategies {
            wrong_unless(seen.insert(strategy), "strategies", || {
                format!("strategy '{strategy}' is named twice")
            })?;
        }
        let Figure { scene, strategy } = &self.figure;
        let drawn = self.scenes.contains(scene) && self.strategies.contains(strategy);
        wrong_unless(drawn, "figure", || {
            format!(
                "the figure's cell ({scene}, {strategy}) is not among the scenes and strategies"
            )
        })?;
        let CostModel { c_k, c_b, c_t } = self.cost;
        let possible = [c_k, c_b, c_t]
            .iter()
            .all(|c| (0.0..=MOST_COST).contains(c));
        wrong_unless(possible && c_k + c_b + c_t > 0.0, "cost", || {
            format!(
                "c_k = {c_k}, c_b = {c_b}, c_t = {c_t}, but costs must be at most {MOST_COST:e}, none negative, and not \
                 all 0"
            )
        })?;
        let Expect {
            slope_within,
            family,
            gate,
        } = self.expect;
        let finite = slope_within > 0.0 && slope_within.is_finite();
        wrong_unless(finite, "expect.slope_within", || {
            format!("expect.slope_within = {slope_within}, but it must be a number above 0")
        })?;
        let likely = (LEAST_FAMILY..1.0).contains(&family);
        wrong_unless(likely, "expect.family", || {
            format!(
                "expect.family = {family}, but it must be at least {LEAST_FAMILY:e} and below 1"
            )
        })?;
        wrong_unless((0.0..1.0).contains(&gate), "expect.gate", || {
            format!("expect.gate = {gate}, but it must be 0 to 1, 1 excluded")
        })?;
        if let Some(Controls {
            lines,
            rejected_below,
            accepted_above,
        }) = self.controls
        {
            wrong_unless(lines >= FEWEST_LINES, "controls.lines", || {
                format!("controls.lines = {lines}, but it must be at least {FEWEST_LINES}")
            })?;
            for (key, bound) in [
                ("controls.rejected_below", rejected_below),
                ("controls.accepted_above", accepted_above),
            ] {
                wrong_unless((0.0..1.0).contains(&bound), key, || {
                    format!("{key} = {bound}, but it must be 0 to 1, 1 excluded")
                })?;
            }
        }
        self.lines.check()
    }
}

/// Costs above this could leave f64 in a sum.
const MOST_COST: f64 = 1e100;

/// The least chance of a miss of all intervals together for which their width can be computed.
const LEAST_FAMILY: f64 = 1e-12;

/// Where a key stands: in `[quick]` if the quick form has it, else outside; if not itself, then its table.
fn place(text: &str, key: &str, quick: bool) -> Option<usize> {
    let file = toml::de::DeTable::parse(text).ok()?;
    let mut outside = Some(file.get_ref());
    let mut found = None;
    if quick && let Some((_, value)) = entry(file.get_ref(), "quick") {
        let section = value.get_ref().as_table();
        let first = key.split('.').next()?;
        if section.is_some_and(|s| entry(s, first).is_some()) {
            outside = section;
        }
    }
    for part in key.split('.') {
        let Some((key, value)) = outside.and_then(|table| entry(table, part)) else {
            break;
        };
        found = Some(key);
        outside = value.get_ref().as_table();
    }
    found
}

/// Where a key of a table stands, and its value.
fn entry<'t, 'i>(
    table: &'t toml::de::DeTable<'i>,
    key: &str,
) -> Option<(usize, &'t toml::Spanned<toml::de::DeValue<'i>>)> {
    let (key, value) = table.iter().find(|(k, _)| k.get_ref().as_ref() == key)?;
    Some((key.span().start, value))
}

fn one_line(message: &str) -> String {
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = include_str!("../../experiments/figure3.toml");

    #[test]
    fn the_command_repeats_the_run() {
        let command = |seed, lines, quick| {
            let overrides = Overrides { seed, lines, quick };
            let plan = Plan::parse(FILE, "x.toml", "x", overrides).expect("a plan");
            (plan.name, plan.command)
        };
        assert_eq!(
            command(None, None, false),
            ("x".into(), "validate run x.toml".into())
        );
        assert_eq!(
            command(Some(7), Some(4096), true),
            (
                "x-quick".into(),
                "validate run x.toml --quick --seed 7 --lines 4096".into()
            )
        );
    }

    #[test]
    fn wrong_values_are_found_where_they_stand() {
        let error = |old: &str, new: &str| {
            assert!(FILE.contains(old), "{old}");
            let text = FILE.replacen(old, new, 1);
            let line = 1 + text[..text.find(new).expect("new")].matches('\n').count();
            let error = Plan::parse(&text, "x.toml", "x", Overrides::default());
            let error = error.expect_err(new).to_string();
            assert!(error.starts_with(&format!("x.toml:{line}:")), "{error}");
        };
        error("family = 0.01 ", "family = 1e-13 ");
        error("gate = 0.001 ", "gate = 1.0 ");
        error("accepted_above = 1e-4", "accepted_above = -1.0");
        error("slope_error = 0.002", "slope_error = 2.0");
        error("max = 16_777_216", "max = 16");
        error("question = ", "question = \"\" # ");
    }

    #[test]
    fn names_of_folders() {
        for name in ["validate", "figure3-quick", "a_b.c"] {
            assert!(is_folder_name(name), "{name}");
        }
        for name in ["", ".", "..", ".git", "a/b", "a\\b", "a b", "a:b"] {
            assert!(!is_folder_name(name), "{name}");
        }
    }
}
