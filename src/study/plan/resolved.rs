//! An experiment written out: every default in its place, the options of the command line applied.

use serde::Serialize;

use super::{CostModel, Kind, Plan};

/// The experiment as it stands in a file.
#[derive(Serialize)]
struct File<'a> {
    question: &'a str,
    seed: u64,
    scenes: &'a [String],
    #[serde(flatten)]
    kind: &'a Kind,
    cost: CostModel,
}

impl Plan {
    /// The text of an experiment file that asks for the same without any option. Procedural scenes have their full names if the
    /// run is recorded. It is the full form even where this is the quick one: what the quick form changes is written out.
    pub fn resolved(&self) -> String {
        let mut plan = self.clone();
        for (number, spec) in self.scenes.iter().enumerate() {
            if let Some(name) = self.record.as_ref().and_then(|r| r.full_name(spec)) {
                plan.rename_scene(number, name);
            }
        }
        let Self {
            question,
            seed,
            scenes,
            kind,
            cost,
            ..
        } = &plan;
        let file = File {
            question,
            seed: *seed,
            scenes,
            kind,
            cost: *cost,
        };
        let text = toml::to_string(&file).expect("an experiment is plain data");
        let command = self.command.replace(char::is_control, " ");
        format!("# What `{command}` asks for: defaults written out, options applied.\n{text}")
    }
}

#[cfg(test)]
mod tests {
    use super::super::Overrides;
    use super::*;

    /// What a plan asks for, without how it was asked.
    fn bare(plan: Plan) -> Plan {
        Plan {
            command: String::new(),
            quick: false,
            record: None,
            ..plan
        }
    }

    #[test]
    fn every_experiment_is_read_again_as_it_was() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/experiments");
        let mut kinds = std::collections::BTreeSet::new();
        for entry in std::fs::read_dir(folder).expect("experiments") {
            let path = entry.expect("an entry").path();
            if path.extension().is_none_or(|e| e != "toml") {
                continue;
            }
            let options = [(None, None), (Some(u64::MAX), Some(65_536)), (None, None)];
            for (number, (seed, lines)) in options.into_iter().enumerate() {
                let error = (number == 2).then_some(0.001);
                for quick in [false, true] {
                    let overrides = Overrides {
                        seed,
                        lines,
                        error,
                        quick,
                    };
                    // Not every experiment takes every option.
                    let Ok(plan) = Plan::read(&path, overrides) else {
                        continue;
                    };
                    let text = plan.resolved();
                    let again = Plan::parse(&text, "r.toml", &plan.name, Overrides::default());
                    let again = again.unwrap_or_else(|error| panic!("{error}\n{text}"));
                    kinds.insert((plan.kind.name(), number));
                    assert_eq!(bare(again), bare(plan), "{text}");
                }
            }
        }
        // Of nine kinds, five count to an error.
        assert_eq!(kinds.len(), 2 * Kind::NAMES.len() + 5, "{kinds:?}");
    }

    #[test]
    fn scenes_get_the_names_they_ran_under() {
        let text = include_str!("../../../experiments/figure3.toml");
        let plan = Plan::parse(text, "x.toml", "x", Overrides::default());
        let mut plan = plan.expect("a plan");
        let record = plan.record.as_mut().expect("a record");
        for name in ["simple:soup:2000", "spd:balls:4", "models/teapot.obj"] {
            record.scenes.insert(name.into(), "0123".into());
        }
        let again = Plan::parse(&plan.resolved(), "r.toml", "x", Overrides::default());
        let scenes = again.expect("a plan").scenes;
        assert!(scenes.contains(&"simple:soup:2000".into()));
        assert!(scenes.contains(&"spd:balls:4".into()) && scenes.contains(&"simple:flat".into()));
        assert_eq!(scenes.len(), plan.scenes.len());
    }
}
