//! What a run was asked for, kept with its data: the experiment's text, and behind it a table `[run]` with what the command
//! line added. From this one file the run can be repeated, byte for byte.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::scene::Scene;

use super::identity::whole;
use super::plan::{Overrides, PlanError, one_line};

/// What a run was asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// The experiment's text, without `[run]`.
    pub text: String,
    /// Name of the experiment: its file's stem.
    pub experiment: String,
    /// The experiment's file as named on the command line.
    pub path: String,
    /// What the command line changed.
    pub overrides: Overrides,
    /// Of a text that was kept with a run: the program that ran it.
    pub revision: Option<String>,
    /// Of a text that was kept with a run: each scene's name and content.
    pub scenes: BTreeMap<String, String>,
}

/// Parts the experiment's text from the table that is the program's.
const MARK: &str =
    "# Added by the program: how this experiment was run. Run this file and the run is repeated.\n";

/// The program's part of the text.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Tail {
    run: Ran,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Ran {
    experiment: String,
    path: String,
    revision: String,
    options: Overrides,
    scenes: BTreeMap<String, String>,
}

impl Record {
    /// From the text of an experiment file, or of one kept with a run. The latter has a name, a path and options of its own;
    /// `overrides` go before those options.
    pub fn read(
        text: &str,
        path: &str,
        name: &str,
        overrides: Overrides,
    ) -> Result<Self, PlanError> {
        let Some(start) = text.rfind(MARK) else {
            return Ok(Self {
                text: text.into(),
                experiment: name.into(),
                path: path.into(),
                overrides,
                revision: None,
                scenes: BTreeMap::new(),
            });
        };
        let Tail { run } = toml::from_str(&text[start..]).map_err(|error| {
            let offset = start + error.span().map_or(0, |span| span.start);
            PlanError::at(text, path, offset, one_line(error.message()))
        })?;
        Ok(Self {
            text: text[..start].trim_end_matches('\n').to_owned() + "\n",
            experiment: run.experiment,
            path: run.path,
            overrides: overrides.or(run.options),
            revision: Some(run.revision),
            scenes: run.scenes,
        })
    }

    /// The text to keep with a run of this program over these scenes.
    pub fn recorded(&self, scenes: &[Scene]) -> String {
        let contents = scenes.iter().map(|s| (s.name.clone(), whole(s)));
        let tail = Tail {
            run: Ran {
                experiment: self.experiment.clone(),
                path: self.path.clone(),
                revision: crate::REVISION.into(),
                options: self.overrides,
                scenes: contents.collect(),
            },
        };
        let tail = toml::to_string(&tail).expect("a record is plain data");
        format!("{}\n\n{MARK}{tail}", self.text.trim_end_matches('\n'))
    }

    /// The full name that a scene of the experiment had in the recorded run, if it was named without its size.
    pub fn full_name(&self, spec: &str) -> Option<&str> {
        let sized = |name: &&String| name.strip_prefix(spec).is_some_and(|s| s.starts_with(':'));
        let mut names = self.scenes.keys().filter(sized);
        match (self.scenes.contains_key(spec), names.next(), names.next()) {
            (false, Some(name), None) => Some(name),
            _ => None,
        }
    }

    /// Whether scenes are those the recorded run had; the message says what else they are. Scenes it did not have are no
    /// matter, nor is anything where no run is recorded.
    pub fn check_scenes(&self, scenes: &[Scene]) -> Result<(), String> {
        for scene in scenes {
            let found = whole(scene);
            if let Some(wanted) = self.scenes.get(&scene.name)
                && *wanted != found
            {
                return Err(format!(
                    "{}: its objects and look have the digest {found}, those of the recorded run {wanted}; the scene is \
                     not the one that was counted then: put that one in its place, or remove [run] for a run of its own",
                    scene.name
                ));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::Plan;
    use super::*;

    const FILE: &str = include_str!("../../experiments/validate.toml");

    fn scene(spec: &str) -> Scene {
        Scene::load(spec).expect("a scene")
    }

    #[test]
    fn a_kept_text_gives_the_run_again() {
        let options = [
            Overrides::default(),
            Overrides {
                seed: Some(u64::MAX),
                lines: Some(4096),
                error: None,
                quick: true,
            },
            Overrides {
                error: Some(0.001),
                ..Overrides::default()
            },
        ];
        for overrides in options {
            let first = Plan::parse(FILE, "a \"b\"/v.toml", "v", overrides).expect("a plan");
            let record = first.record.clone().expect("a record");
            let kept = record.recorded(&[scene("simple:greedy")]);
            assert!(kept.starts_with(FILE.trim_end()));
            let again = Plan::parse(&kept, "elsewhere/x.toml", "x", Overrides::default());
            let again = again.expect("a plan");
            let record = again.record.clone().expect("a record");
            assert_eq!(record.revision.as_deref(), Some(crate::REVISION));
            assert_eq!(record.recorded(&[scene("simple:greedy")]), kept);
            let bare = |plan: &Plan| Plan {
                record: None,
                ..plan.clone()
            };
            assert_eq!(bare(&first), bare(&again));
            assert!(
                record
                    .check_scenes(&[scene("simple:greedy"), scene("simple:soup")])
                    .is_ok()
            );
        }
    }

    #[test]
    fn another_scene_of_the_same_name_is_refused() {
        let mut record = Record::read(FILE, "v.toml", "v", Overrides::default()).expect("read");
        let content = "0123456789abcdef".to_string();
        record.scenes.insert("simple:greedy:1000".into(), content);
        let wrong = record
            .check_scenes(&[scene("simple:greedy")])
            .expect_err("refused");
        assert!(wrong.starts_with("simple:greedy:1000: ") && wrong.contains("0123456789abcdef"));
    }

    #[test]
    fn a_damaged_table_is_told_with_its_place() {
        let record = Record::read(FILE, "v.toml", "v", Overrides::default()).expect("read");
        let kept = record.recorded(&[]).replace("quick = false", "quick = 3");
        let line = 1 + kept[..kept.find("quick = 3").expect("there")]
            .matches('\n')
            .count();
        let error = Record::read(&kept, "v.toml", "v", Overrides::default());
        let error = error.expect_err("refused").to_string();
        assert!(error.starts_with(&format!("v.toml:{line}:")), "{error}");
    }
}
