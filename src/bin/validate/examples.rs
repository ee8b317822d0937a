//! Examples at the end of `--help`, a text for each command. The tests parse every line that begins with `validate`.

/// Of `validate` itself.
pub const VALIDATE: &str = "Examples:
  validate                                  the default study
  validate run experiments/figure3.toml     every scene and strategy, real meshes
  validate scene spd:balls:4                one scene, every strategy, and which to take
  validate scene model.obj --lines 2^20     your own mesh
  validate trace model.obj --rays r.csv     your own rays: what they hit and cost
  validate list strategies                  what can be named where";

/// Of `run`.
pub const RUN: &str = "Examples:
  validate run experiments/strategies.toml            Havran's table; resumes what was stopped
  validate run experiments/cost.toml --dry-run        what it would measure
  validate run experiments/validate.toml --quick      its short form, into data/validate-quick
  validate run experiments/validate.toml --error 0.1% --out exact
  validate run experiments/strategies.toml --shard 1/2  half of it, into shards/strategies/1-of-2";

/// Of `merge`.
pub const MERGE: &str = "Example, where both folders have been brought to one machine:
  validate merge shards/strategies/1-of-2 shards/strategies/2-of-2";

/// Of `plan`.
pub const PLAN: &str = "Examples:
  validate plan experiments/strategies.toml --shards 6 --format slurm > submit.sh
  validate plan experiments/strategies.toml --shards 6 --format snakemake > Snakefile";

/// Of `scene`.
pub const SCENE: &str = "Examples:
  validate scene model.obj                            your mesh
  validate scene model.obj --rays r.csv --ask any     and your rays, which stop at any hit
  validate scene simple:soup:2000 --stop objects:2:16 --clipped
  validate scene spd:teapot:12 --nff teapot.nff --digits 6";

/// Of `trace`.
pub const TRACE: &str = "Examples:
  validate trace model.obj --rays r.csv               nearest hits, in the tree of sah
  validate trace model.ply --rays r.npy --ask all --strategy sah-bins:32
  validate trace spd:gears:2 --rays r.csv --stop automatic --clipped --out elsewhere";

/// Of `list`.
pub const LIST: &str = "Examples:
  validate list                                       everything that can be named
  validate list scenes                                one list of it";

/// Of `plots`.
pub const PLOTS: &str = "Examples:
  validate plots data/validate                        into plots/validate
  validate plots data/published/figure3 --out again   into again/plots/figure3";

/// Of `tables`.
pub const TABLES: &str = "Examples:
  validate tables data/validate                       into data/validate/tables
  validate tables data/published/figure3 --out again  into again/data/figure3/tables";

/// Of `report`.
pub const REPORT: &str = "Examples:
  validate report data/validate                       into plots/validate/report.html
  validate report data/published/figure3 --out again  into again/plots/figure3/report.html";

/// Of `archive`.
pub const ARCHIVE: &str = "Examples:
  validate archive data/validate                      into archives/validate.tar.gz
  validate archive data/figure3 data/cost --out both.tar.gz";

/// Of `verify`.
pub const VERIFY: &str = "Examples:
  validate verify archives/validate.tar.gz            is it whole?
  validate verify archives/validate.tar.gz --replay   does it come out the same again?";

/// Of `publish`.
pub const PUBLISH: &str = "Examples:
  validate publish figure3 strategies                 these runs, and every page that quotes them
  validate publish                                    the pages only
  validate publish --check                            which page is out of date?";

/// Of `completions`.
pub const COMPLETIONS: &str = "Examples:
  validate completions bash > ~/.local/share/bash-completion/completions/validate
  validate completions fish > ~/.config/fish/completions/validate.fish";

#[cfg(test)]
mod tests {
    use std::path::Path;

    use clap::{CommandFactory, Parser};

    use crate::args::Cli;

    /// What `validate COMMAND --help` prints.
    fn help(command: &[&str]) -> String {
        let words = ["validate"].iter().chain(command).chain(&["--help"]);
        let shown = Cli::try_parse_from(words).err().expect("help is shown");
        assert_eq!(shown.kind(), clap::error::ErrorKind::DisplayHelp);
        shown.to_string()
    }

    /// The examples of a help text: their words, without what is said about them and without redirection.
    fn examples(help: &str) -> Vec<Vec<&str>> {
        let lines = help.lines().filter_map(|line| line.strip_prefix("  "));
        let lines = lines.filter(|line| line.starts_with("validate"));
        lines
            .map(|line| {
                let line = line.split("  ").next().unwrap_or_default();
                let line = line.split(" > ").next().unwrap_or_default();
                line.split_whitespace().collect()
            })
            .collect()
    }

    #[test]
    fn every_command_has_examples_and_they_can_be_parsed() {
        let mut commands = vec![vec![]];
        let cli = Cli::command();
        commands.extend(
            cli.get_subcommands()
                .map(|command| vec![command.get_name()]),
        );
        assert!(commands.len() >= 11);
        for command in commands {
            let help = help(&command);
            let examples = examples(&help);
            assert!(!examples.is_empty(), "{command:?}: no examples:\n{help}");
            for words in examples {
                let name = words.get(1).copied();
                assert!(
                    command.is_empty() || name == command.first().copied(),
                    "{words:?}"
                );
                if let Err(error) = Cli::try_parse_from(&words) {
                    panic!("{words:?}: {error}");
                }
                let file = |word: &&&str| word.starts_with("experiments/");
                let root = Path::new(env!("CARGO_MANIFEST_DIR"));
                let gone = words
                    .iter()
                    .filter(file)
                    .find(|file| !root.join(file).is_file());
                assert_eq!(gone, None, "{words:?}");
            }
        }
    }

    /// The commands in README and docs, as far as they are of this program.
    #[test]
    fn commands_in_the_pages_can_be_parsed() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let mut parsed = 0;
        for page in ["README.md", "docs/your-own-model.md", "docs/archives.md"] {
            let text = std::fs::read_to_string(root.join(page)).expect(page);
            for code in text.split("```sh\n").skip(1) {
                let code = code.split("```").next().unwrap_or_default();
                for line in code.lines().filter(|line| line.starts_with("validate ")) {
                    let command = line.split(" #").next().unwrap_or_default();
                    let words = command.split_whitespace();
                    if let Err(error) = Cli::try_parse_from(words) {
                        panic!("{page}: {line}: {error}");
                    }
                    parsed += 1;
                }
            }
        }
        assert!(parsed >= 12, "{parsed}");
    }
}
