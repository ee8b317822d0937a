//! Experiment files: strict TOML, validated once, trusted inside.
//!
//! Every kind of experiment has the same head (question, seed, scenes, costs) and keys of its own. `[quick]` holds keys that
//! take the place of those outside when the quick form is asked for.

mod error;
mod once;
mod overrides;
mod resolved;
mod table;

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use toml::Spanned;
use toml::de::{DeTable, Deserializer};

use crate::cost::CostModel;
use crate::scene::quotable;

use super::assumptions::Assumptions;
use super::cost_vs_work::CostVsWork;
use super::hits::HitsVsArea;
use super::record::Record;
use super::records::{Summary, file_stem};
use super::speed_vs_error::SpeedVsError;
use super::split_cost::SplitCost;
use super::stability::Stability;
use super::strategies::Strategies;
use super::traversal::Traversal;
use super::{LEVEL, LineRule, SCHEMA};

use error::Fault;
pub(super) use error::wrong_unless;
pub use error::{PlanError, Wrong};
pub(super) use once::{each_once, none_twice};
pub use overrides::Overrides;
use table::{overlay, place};

/// What an experiment asks for.
///
/// ```
/// use sahlab::study::Plan;
/// use sahlab::study::plan::Overrides;
///
/// let path = "experiments/validate.toml";
/// let whole = Plan::read(path.as_ref(), Overrides::default())?;
/// let quick = Plan::read(path.as_ref(), Overrides { quick: true, ..Overrides::default() })?;
/// assert_eq!((whole.name.as_str(), quick.name.as_str()), ("validate", "validate-quick"));
/// assert!(quick.scenes.len() < whole.scenes.len());
///
/// // What is wrong is told with its place.
/// let typo = "kind = \"hits-vs-area\"\nqestion = \"Does it?\"\n";
/// let wrong = Plan::parse(typo, "e.toml", "e", Overrides::default()).unwrap_err().to_string();
/// assert!(wrong.starts_with("e.toml"), "{wrong}");
/// # Ok::<(), sahlab::study::PlanError>(())
/// ```
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
    /// What steps cost.
    pub cost: CostModel,
    /// Whether this is the quick form.
    pub quick: bool,
    /// What its kind asks for besides.
    pub kind: Kind,
    /// What it was read from, if from an experiment's text: enough to repeat it.
    pub record: Option<Record>,
}

/// The kinds of experiment there are.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Kind {
    /// Hits against surface area, for every node of every tree.
    HitsVsArea(HitsVsArea),
    /// Trees of several strategies: counted, traced, timed.
    Strategies(Strategies),
    /// The same over stop rules and their settings: when is a node best left a leaf?
    Termination(Strategies),
    /// The split cost across nodes, and the medians.
    SplitCost(SplitCost),
    /// Predicted counts, counted ones and seconds of many kinds of rays.
    CostVsWork(CostVsWork),
    /// What the metric is worth where its assumptions fail.
    Assumptions(Assumptions),
    /// What samplers, kernels and plane searches cost in time and in error.
    SpeedVsError(SpeedVsError),
    /// Hard cases, and the exact oracle.
    Stability(Stability),
    /// A stack, restarts and links: steps, seconds and memory.
    Traversal(Traversal),
}

impl Kind {
    /// The names of all kinds.
    pub const NAMES: [&str; 9] = [
        "hits-vs-area",
        "strategies",
        "termination",
        "split-cost",
        "cost-vs-work",
        "assumptions",
        "speed-vs-error",
        "stability",
        "traversal",
    ];

    /// The name in files.
    pub fn name(&self) -> &'static str {
        match self {
            Self::HitsVsArea(_) => Self::NAMES[0],
            Self::Strategies(_) => Self::NAMES[1],
            Self::Termination(_) => Self::NAMES[2],
            Self::SplitCost(_) => Self::NAMES[3],
            Self::CostVsWork(_) => Self::NAMES[4],
            Self::Assumptions(_) => Self::NAMES[5],
            Self::SpeedVsError(_) => Self::NAMES[6],
            Self::Stability(_) => Self::NAMES[7],
            Self::Traversal(_) => Self::NAMES[8],
        }
    }

    /// Whether a wanted error of C can settle its numbers of lines and rays.
    pub fn counts_to_an_error(&self) -> bool {
        !matches!(
            self,
            Self::SplitCost(_) | Self::SpeedVsError(_) | Self::Stability(_) | Self::Traversal(_)
        )
    }

    fn check(&self, scenes: &[String]) -> Result<(), Wrong> {
        match self {
            Self::HitsVsArea(asked) => asked.check(scenes),
            Self::Strategies(asked) | Self::Termination(asked) => asked.check(scenes),
            Self::SplitCost(asked) => asked.check(scenes),
            Self::CostVsWork(asked) => asked.check(scenes),
            Self::Assumptions(asked) => asked.check(scenes),
            Self::SpeedVsError(asked) => asked.check(scenes),
            Self::Stability(asked) => asked.check(scenes),
            Self::Traversal(asked) => asked.check(),
        }
    }
}

/// Names of folders that are no run's under `data/`.
const RESERVED: [&str; 4] = ["published", "reference", "bench", "trace"];

/// Whether this can be the name of a folder for a run or a benchmark.
pub fn is_folder_name(name: &str) -> bool {
    let plain = |c: char| c.is_alphanumeric() || "-_.".contains(c);
    !name.is_empty() && !name.starts_with('.') && name.chars().all(plain)
}

/// The keys that every kind has.
const HEAD: [&str; 5] = ["kind", "question", "seed", "scenes", "cost"];

/// What stands in them.
#[derive(Deserialize)]
struct Head {
    kind: Spanned<String>,
    question: String,
    seed: u64,
    scenes: Vec<String>,
    cost: CostModel,
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

    /// Parse an experiment's text; `path` names it in errors, `name` its folders. The text kept with a run (see [`Record`])
    /// gives that run again: its own name, and its options where `overrides` has none.
    pub fn parse(
        text: &str,
        path: &str,
        name: &str,
        overrides: Overrides,
    ) -> Result<Self, PlanError> {
        let record = Record::read(text, path, name, overrides)?;
        let (text, name, overrides) = (&*record.text, &*record.experiment, record.overrides);
        let at = |offset: usize, message: String| PlanError::at(text, path, offset, message);
        let syntax =
            |e: toml::de::Error| at(e.span().map_or(0, |s| s.start), one_line(e.message()));
        let value = |message: &str| PlanError::Value {
            path: path.into(),
            message: quotable(message),
        };
        let mut table = DeTable::parse(text).map_err(syntax)?;
        let quick = table.get_mut().remove("quick");
        if overrides.quick && quick.is_none() {
            return Err(value(
                "--quick needs a section [quick] that says the smaller form: scenes, lines, figure and expect, each as \
                 outside of it",
            ));
        }
        if !is_folder_name(name) || RESERVED.iter().any(|r| r.eq_ignore_ascii_case(name)) {
            return Err(value(&format!(
                "'{name}' cannot name the folders of a run; the file's name must have letters, digits, '-', '_' and '.' \
                 only, not start with '.', and not be one of {}",
                RESERVED.join(", ")
            )));
        }
        // Both forms are read, whichever is asked for: a mistake in either is told.
        let small = quick.map(|quick| overlay(&table, quick)).transpose();
        let small = small.map_err(|offset| at(offset, "quick must be a table".into()))?;
        let read = |table: &Spanned<DeTable>| {
            let fault = |fault: Fault| match fault {
                Fault::Toml(error) => syntax(error),
                Fault::At(offset, message) => at(offset, message),
                Fault::Value(Wrong { key, message }) => match place(table.get_ref(), key) {
                    Some(offset) => at(offset, message),
                    None => value(&message),
                },
            };
            let mut plan = Self::of(table).map_err(fault)?;
            plan.check().map_err(|wrong| fault(Fault::Value(wrong)))?;
            plan.name = name.into();
            Ok::<_, PlanError>(plan)
        };
        let full = read(&table)?;
        let small = small.map(|table| read(&table)).transpose()?;
        let mut plan = match small {
            Some(mut small) if overrides.quick => {
                small.make_quick();
                small
            }
            _ => full,
        };
        plan.command = format!("validate run {}{}", record.path, overrides.arguments());
        if let Some(seed) = overrides.seed {
            plan.seed = seed;
        }
        if let Some(error) = overrides.error {
            plan.set_error(error).map_err(|message| PlanError::Value {
                path: format!("--error {error}"),
                message,
            })?;
        }
        if let Some(n) = overrides.lines {
            plan.set_lines(n).map_err(|message| PlanError::Value {
                path: format!("--lines {n}"),
                message,
            })?;
        }
        plan.record = Some(record);
        Ok(plan)
    }

    /// The plan in a table; its name and command are not there.
    fn of(table: &Spanned<DeTable>) -> Result<Self, Fault> {
        let head: Head = Head::deserialize(Deserializer::from(table.clone()))?;
        let mut rest = table.clone();
        for key in HEAD {
            rest.get_mut().remove(key);
        }
        fn asked<T: DeserializeOwned>(table: Spanned<DeTable>) -> Result<T, Fault> {
            Ok(T::deserialize(Deserializer::from(table))?)
        }
        let kind = match head.kind.get_ref().as_str() {
            "hits-vs-area" => Kind::HitsVsArea(asked(rest)?),
            "strategies" => Kind::Strategies(asked(rest)?),
            "termination" => Kind::Termination(asked(rest)?),
            "split-cost" => Kind::SplitCost(asked(rest)?),
            "cost-vs-work" => Kind::CostVsWork(asked(rest)?),
            "assumptions" => Kind::Assumptions(asked(rest)?),
            "speed-vs-error" => Kind::SpeedVsError(asked(rest)?),
            "stability" => Kind::Stability(asked(rest)?),
            "traversal" => Kind::Traversal(asked(rest)?),
            other => {
                let message = format!(
                    "unknown kind '{other}', expected one of {}",
                    Kind::NAMES.join(", ")
                );
                return Err(Fault::At(head.kind.span().start, message));
            }
        };
        Ok(Self {
            name: String::new(),
            command: String::new(),
            question: head.question,
            seed: head.seed,
            scenes: head.scenes,
            cost: head.cost,
            quick: false,
            kind,
            record: None,
        })
    }

    /// Whether the values make sense together; the error says what would.
    pub fn check(&self) -> Result<(), Wrong> {
        wrong_unless(!self.question.trim().is_empty(), "question", || {
            "the question is empty; it is printed with every answer".into()
        })?;
        each_once("scenes", "scene", &self.scenes)?;
        let mut stems = HashMap::new();
        for scene in &self.scenes {
            let other = stems.insert(file_stem(scene), scene);
            wrong_unless(other.is_none(), "scenes", || {
                format!(
                    "scenes '{}' and '{scene}' would share the files '{}'; names of scenes must differ in their letters and \
                     digits or in where others part them",
                    other.map_or("", String::as_str),
                    file_stem(scene)
                )
            })?;
        }
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
        self.kind.check(&self.scenes)
    }

    /// The head of its summary.
    pub(super) fn summary(&self) -> Summary {
        Summary {
            schema: SCHEMA,
            experiment: self.name.clone(),
            kind: self.kind.name().into(),
            question: self.question.clone(),
            seed: self.seed,
            command: self.command.clone(),
            stop: None,
            interval_level: LEVEL,
            family_level: None,
            quick: self.quick,
            slope_within: None,
            figure_scene: None,
            figure_strategy: None,
            verdicts: Vec::new(),
            estimates: Vec::new(),
        }
    }

    /// Mark the plan as the quick form: no controls, folders of its own.
    fn make_quick(&mut self) {
        self.quick = true;
        self.name += "-quick";
        match &mut self.kind {
            Kind::HitsVsArea(asked) => asked.controls = None,
            Kind::Strategies(_)
            | Kind::Termination(_)
            | Kind::SplitCost(_)
            | Kind::CostVsWork(_)
            | Kind::Assumptions(_)
            | Kind::SpeedVsError(_)
            | Kind::Stability(_)
            | Kind::Traversal(_) => {}
        }
    }

    /// Count exactly so many lines in every cell.
    fn set_lines(&mut self, lines: u64) -> Result<(), String> {
        let rule = LineRule::exactly(lines)?;
        match &mut self.kind {
            Kind::HitsVsArea(asked) => asked.lines = rule,
            Kind::Strategies(asked) | Kind::Termination(asked) => asked.lines = rule,
            Kind::CostVsWork(asked) => asked.lines = rule,
            Kind::SplitCost(asked) => {
                if let Some(octree) = &mut asked.octree {
                    octree.lines = lines;
                }
            }
            Kind::Assumptions(asked) => {
                asked.number = lines;
                asked.check_number().map_err(|wrong| wrong.message)?;
            }
            Kind::SpeedVsError(asked) => asked.set_lines(lines)?,
            Kind::Stability(asked) => asked.set_lines(lines)?,
            Kind::Traversal(asked) => {
                asked.number = lines;
                asked.check_number().map_err(|wrong| wrong.message)?;
            }
        }
        Ok(())
    }

    /// Count as many lines and rays as bring the relative error of every tree's cost below this.
    fn set_error(&mut self, error: f64) -> Result<(), String> {
        let rule = LineRule::for_cost_error(error)?;
        match &mut self.kind {
            Kind::HitsVsArea(asked) => {
                asked.lines = rule;
                if let Some(work) = &mut asked.work {
                    work.error = Some(error);
                }
            }
            Kind::Strategies(asked) | Kind::Termination(asked) => asked.lines = rule,
            Kind::CostVsWork(asked) => {
                asked.lines = rule;
                asked.error = Some(error);
            }
            Kind::Assumptions(asked) => asked.error = Some(error),
            Kind::SplitCost(_)
            | Kind::SpeedVsError(_)
            | Kind::Stability(_)
            | Kind::Traversal(_) => {
                return Err(format!(
                    "no wanted error settles the number of lines of kind '{}'; give --lines",
                    self.kind.name()
                ));
            }
        }
        Ok(())
    }

    /// Give a scene its full name, wherever the plan names it.
    pub fn rename_scene(&mut self, number: usize, name: &str) {
        let old = std::mem::replace(&mut self.scenes[number], name.into());
        match &mut self.kind {
            Kind::HitsVsArea(asked) if asked.figure.scene == old => {
                asked.figure.scene = name.into();
            }
            Kind::SplitCost(asked) => {
                for curve in asked.curves.iter_mut().filter(|c| c.scene == old) {
                    curve.scene = name.into();
                }
            }
            Kind::Strategies(asked) | Kind::Termination(asked) => {
                let slice = asked.slice.iter_mut();
                for slice in slice.filter(|slice| slice.scene == old) {
                    slice.scene = name.into();
                }
            }
            Kind::Assumptions(asked) if asked.figure.scene == old => {
                asked.figure.scene = name.into();
            }
            Kind::SpeedVsError(asked) => asked.rename_scene(&old, name),
            Kind::HitsVsArea(_)
            | Kind::Assumptions(_)
            | Kind::CostVsWork(_)
            | Kind::Stability(_)
            | Kind::Traversal(_) => {}
        }
    }
}

/// Costs above this could leave f64 in a sum.
const MOST_COST: f64 = 1e100;

pub(super) fn one_line(message: &str) -> String {
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests;
