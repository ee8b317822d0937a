//! The command line.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use sahlab::study::share::{Share, plain_number};

use crate::examples;

/// How well does the surface area heuristic predict what ray tracing through a kd-tree really costs?
///
/// Without a command: the default study in seven parts, about a minute. It writes data/ and plots/ of validate and of
/// validate-strategies, -cost, -assumptions, -speed, -stability and -traversal, and archives/validate.tar.gz, and ends with a
/// summary.
///
/// Exit codes: 0 done and every expectation held; 1 done, but an expectation was missed; 2 could not run; 130 stopped by Ctrl-C or by
/// a signal, in which case the same command goes on where this one was.
#[derive(Parser)]
#[command(version, about, after_help = examples::VALIDATE)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Option<Command>,
    /// Flags of every command.
    #[command(flatten)]
    pub common: Common,
}

/// Flags of every command.
#[derive(Args, Clone)]
pub struct Common {
    /// Folder that gets data/NAME and plots/NAME [default: the current one; for `plots`, `tables` and `report` the run's own]; for
    /// `archive` and `verify` see there.
    #[arg(short, long, global = true, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Seed of the lines, instead of the experiment's; a count as for --lines.
    #[arg(long, global = true, value_name = "N", value_parser = count, allow_negative_numbers = true)]
    pub seed: Option<u64>,
    /// Threads that count (all cores if not given). Results do not depend on it.
    #[arg(long, global = true, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Lines a cell counts, instead of the experiment's rule; 1000000, 1e6 and 2^20 are understood.
    #[arg(long, global = true, value_name = "N", value_parser = count, allow_negative_numbers = true)]
    pub lines: Option<u64>,
    /// As many lines, and rays of a source, as bring every tree's cost C within this relative error, at 95 %: 0.1% or 0.001.
    #[arg(long, global = true, value_name = "SHARE", value_parser = share, allow_negative_numbers = true, conflicts_with = "lines")]
    pub error: Option<f64>,
    /// Fewer lines and smaller scenes, as the experiment file says, into data/NAME-quick; nothing to publish.
    #[arg(long, global = true)]
    pub quick: bool,
    /// Print the summary as JSON on standard output; those of several experiments as an array.
    #[arg(long, global = true)]
    pub json: bool,
    /// No progress and no notes on standard error.
    #[arg(long, global = true)]
    pub quiet: bool,
    /// Measure again what an earlier run has finished; replace an archive of other runs.
    #[arg(long, global = true)]
    pub force: bool,
    /// Say what would be measured, and write nothing.
    #[arg(long, global = true)]
    pub dry_run: bool,
}

impl Common {
    /// The folder that has `data` and `plots`.
    pub fn root(&self) -> &Path {
        self.out.as_deref().unwrap_or(Path::new("."))
    }

    /// The flags that are given, but for --threads and --quiet, which are never wrong.
    fn given(&self) -> impl Iterator<Item = &'static str> {
        let flags = [
            ("--out", self.out.is_some()),
            ("--seed", self.seed.is_some()),
            ("--lines", self.lines.is_some()),
            ("--error", self.error.is_some()),
            ("--quick", self.quick),
            ("--json", self.json),
            ("--force", self.force),
            ("--dry-run", self.dry_run),
        ];
        flags
            .into_iter()
            .filter_map(|(flag, given)| given.then_some(flag))
    }
}

impl Cli {
    /// The flags that were given and that the command has no use for, as an error.
    ///
    /// # Errors
    /// If there is one: what is asked for by it would else be passed over in silence.
    pub fn check(&self) -> Result<()> {
        let Some((name, heeded)) = self.command.as_ref().and_then(Command::heeds) else {
            return Ok(());
        };
        let others = self.common.given().filter(|flag| !heeded.contains(flag));
        let others: Vec<&str> = others.collect();
        match others[..] {
            [] => Ok(()),
            [one] => bail!("leave {one} away: it means nothing to `validate {name}`"),
            _ => bail!(
                "leave {} away: they mean nothing to `validate {name}`",
                others.join(", ")
            ),
        }
    }
}

/// The commands.
#[derive(Subcommand)]
pub enum Command {
    /// Run experiment files; what a stopped run had finished is kept.
    #[command(after_help = examples::RUN)]
    Run {
        /// Experiment files. Those that `validate list experiments` names are known without their files too.
        #[arg(required = true, value_name = "EXPERIMENT.toml")]
        experiments: Vec<PathBuf>,
        /// Only share I of N, into shards/NAME/I-of-N, for `validate merge`. As a task of a Slurm job array: `auto/N` for the share
        /// with the task's number, `auto` where the array is whole, of tasks 1 to N.
        #[arg(long, value_name = "I/N", value_parser = shard)]
        shard: Option<Share>,
    },
    /// Put the shards of a run together: the same files, to the byte, as if one machine had measured all of it; but for times.
    #[command(after_help = examples::MERGE)]
    Merge {
        /// Folders of all shards of one run, e.g. shards/strategies/*.
        #[arg(required = true, value_name = "DIR")]
        folders: Vec<PathBuf>,
    },
    /// Print the script that runs an experiment in shards on many machines and puts them together.
    ///
    /// It calls `validate` from the PATH, or what the variable VALIDATE names, in the folder where it is submitted, with the
    /// options --quick, --seed, --lines, --error, --threads and --out that are given here.
    #[command(after_help = examples::PLAN)]
    Plan {
        /// The experiment file.
        #[arg(value_name = "EXPERIMENT.toml")]
        experiment: PathBuf,
        /// Into how many shards.
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=10_000))]
        shards: u16,
        /// For which engine.
        #[arg(long, value_enum)]
        format: Engine,
    },
    /// One scene: its objects, a tree per strategy, predicted and counted work (of lines, of rays that stop, of your own), which
    /// strategy to take, and for which rays the prediction can be trusted.
    #[command(after_help = examples::SCENE)]
    Scene {
        /// simple:NAME, spd:NAME:SIZE, hard:NAME, or a .obj, .ply, .stl, .off or .nff file.
        #[arg(value_name = "SCENE")]
        scene: String,
        /// When nodes become leaves: `depth:D`, `objects:N[:D]`, `cost-k:K[:D]`, `cost-gain[:D]`,
        /// `automatic[:D]` or `octree:N:D`.
        #[arg(long, default_value = "cost-gain", value_name = "RULE")]
        stop: sahlab::kd::StopRule,
        /// Clip straddling triangles and polygons to the parts of a node ("perfect splits"): slower to build, fewer tests.
        #[arg(long)]
        clipped: bool,
        /// Your own rays, counted in every tree and taken as the real ones: a file as for `trace`.
        #[arg(long, value_name = "FILE", conflicts_with = "nff")]
        rays: Option<PathBuf>,
        /// What these rays ask: `nearest` hit, `any` hit, or `all` (nothing stops them).
        #[arg(long, value_name = "ASK", requires = "rays", default_value = "nearest")]
        ask: sahlab::kd::Ask,
        /// Write the scene with its camera, lights and materials to this file instead, for other renderers; `-` is standard
        /// output.
        #[arg(long, value_name = "FILE")]
        nff: Option<PathBuf>,
        /// Significant digits of that file: 17 keep every bit, the original programs write 6.
        #[arg(long, value_name = "N", requires = "nff", default_value_t = 17, value_parser = clap::value_parser!(u8).range(1..=17))]
        digits: u8,
    },
    /// Your own rays through one tree: what each hits, and the nodes and tests it takes.
    ///
    /// Writes data/trace/hits.csv (ray, object, t, n_K, n_B, n_t; a miss has no object and no t) and data/trace/trace.json.
    /// Rays begin at t = 0; t, in the file and in what is written, counts in units of the direction, which need not have
    /// length 1.
    #[command(after_help = examples::TRACE)]
    Trace {
        /// simple:NAME, spd:NAME:SIZE, hard:NAME, or a .obj, .ply, .stl, .off or .nff file.
        #[arg(value_name = "SCENE")]
        scene: String,
        /// .csv with the header ox,oy,oz,dx,dy,dz or ox,oy,oz,dx,dy,dz,tmax (blank: no end), or .npy of shape (n, 6) or
        /// (n, 7), type '<f8'.
        #[arg(long, value_name = "FILE")]
        rays: PathBuf,
        /// What the rays ask: `nearest` hit; `any` hit, which ends a ray and is the one told; or `all`, where nothing stops a
        /// ray and the nearest hit is told.
        #[arg(long, value_name = "ASK", default_value = "nearest")]
        ask: sahlab::kd::Ask,
        /// The strategy that builds the tree; `validate list strategies` names them.
        #[arg(long, default_value = "sah", value_name = "STRATEGY")]
        strategy: sahlab::kd::Strategy,
        /// When nodes become leaves, as for `scene`.
        #[arg(long, default_value = "cost-gain", value_name = "RULE")]
        stop: sahlab::kd::StopRule,
        /// Clip straddling triangles and polygons to the parts of a node, as for `scene`.
        #[arg(long)]
        clipped: bool,
    },
    /// What can be named: scenes, strategies, samplers, rays, hard cases, experiments.
    #[command(after_help = examples::LIST)]
    List {
        /// Only this list.
        what: Option<Listed>,
    },
    /// Draw the pictures of a finished run again, from its data alone.
    #[command(after_help = examples::PLOTS)]
    Plots {
        /// Data folder of the run, e.g. data/validate.
        #[arg(value_name = "DIR")]
        folder: PathBuf,
    },
    /// Write the tables of a finished run again, from its data alone.
    #[command(after_help = examples::TABLES)]
    Tables {
        /// Data folder of the run, e.g. data/validate.
        #[arg(value_name = "DIR")]
        folder: PathBuf,
    },
    /// Write the page of a finished run, report.html beside its figures, again from its data alone.
    #[command(after_help = examples::REPORT)]
    Report {
        /// Data folder of the run, e.g. data/validate.
        #[arg(value_name = "DIR")]
        folder: PathBuf,
    },
    /// Pack finished runs into one archive that anyone can check and repeat.
    ///
    /// Writes archives/NAME.tar.gz, the same bytes for the same runs; --out FILE.tar.gz names another file, --out DIR the
    /// folder that gets archives/. It is a bag (BagIt 1.0) whose payload is an RO-Crate (1.1, with Process Run Crate 0.5). With
    /// SOURCE_DATE_EPOCH set, its files have that time, else none.
    #[command(after_help = examples::ARCHIVE)]
    Archive {
        /// Data folders of the runs, e.g. data/validate.
        #[arg(required = true, value_name = "DIR")]
        folders: Vec<PathBuf>,
    },
    /// Check an archive against its manifests and metadata, and with --replay run everything in it again.
    ///
    /// Exit codes: 0 all as it should be; 1 something differs, and every difference is told; 2 no archive of runs, a damaged one,
    /// or one that could do harm; nothing of it is unpacked.
    #[command(after_help = examples::VERIFY)]
    Verify {
        /// The archive, or the folder it unpacks to.
        #[arg(value_name = "FILE.tar.gz")]
        file: PathBuf,
        /// Repeat every run from its experiment's text alone, in a temporary folder or an empty --out DIR, and compare all
        /// data, figures and claims: counts and words exactly, other numbers within 1e-9 of each other (relative). Times are
        /// only shown.
        #[arg(long)]
        replay: bool,
    },
    /// Copy finished runs to data/published and plots/published, and put their figures into README.md and the pages of docs/.
    #[command(after_help = examples::PUBLISH)]
    Publish {
        /// Names of runs under data/; the pages alone if none is given.
        #[arg(value_name = "NAME")]
        names: Vec<String>,
        /// Change nothing; name every page and the quotation in it that is not what is published (exit code 1).
        #[arg(long, conflicts_with = "names")]
        check: bool,
    },
    /// Print a script with which a shell completes the commands and flags of `validate`.
    #[command(after_help = examples::COMPLETIONS)]
    Completions {
        /// The shell.
        shell: Shell,
    },
}

impl Command {
    /// Its name and the common flags it heeds; `None` if that is all of them.
    fn heeds(&self) -> Option<(&'static str, &'static [&'static str])> {
        let of: (_, &[_]) = match self {
            Command::Scene { nff: Some(_), .. } => ("scene --nff", &["--dry-run"]),
            Command::Run { .. } | Command::Scene { .. } => return None,
            Command::Merge { .. } => ("merge", &["--out", "--json", "--dry-run"]),
            Command::Plan { .. } => (
                "plan",
                &["--out", "--seed", "--lines", "--error", "--quick"],
            ),
            Command::Trace { .. } => ("trace", &["--out", "--json", "--dry-run"]),
            Command::List { .. } => ("list", &[]),
            Command::Plots { .. } => ("plots", &["--out"]),
            Command::Tables { .. } => ("tables", &["--out"]),
            Command::Report { .. } => ("report", &["--out"]),
            Command::Archive { .. } => ("archive", &["--out", "--force", "--dry-run"]),
            Command::Verify { replay: true, .. } => ("verify --replay", &["--out", "--dry-run"]),
            Command::Verify { .. } => ("verify", &[]),
            Command::Publish { .. } => ("publish", &["--out"]),
            Command::Completions { .. } => ("completions", &[]),
        };
        Some(of)
    }
}

/// What runs the shards of an experiment.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Engine {
    /// A shell script that submits a job array and a job that merges.
    Slurm,
    /// A Snakefile.
    Snakemake,
}

/// What `list` lists.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Listed {
    /// Scenes.
    Scenes,
    /// Strategies.
    Strategies,
    /// Samplers of lines.
    Samplers,
    /// Sets of rays.
    Rays,
    /// Hard cases of the kind `stability`.
    Cases,
    /// Experiments that come with the program.
    Experiments,
}

/// A count: digits with underscores, 1e6, or 2^20.
fn count(text: &str) -> Result<u64, String> {
    let plain = text.replace('_', "");
    let power = |base: u64, exponent: &str| base.checked_pow(exponent.parse().ok()?);
    let parsed = if let Some((base, exponent)) = plain.split_once('^') {
        base.parse().ok().and_then(|base| power(base, exponent))
    } else if let Some((digits, exponent)) = plain.split_once(['e', 'E']) {
        digits
            .parse::<u64>()
            .ok()
            .zip(power(10, exponent))
            .and_then(|(d, p)| d.checked_mul(p))
    } else {
        plain.parse().ok()
    };
    parsed.ok_or_else(|| "expected a whole number such as 1000000, 1e6 or 2^20".into())
}

/// A share of a run: 2/6, or what Slurm says.
fn shard(text: &str) -> Result<Share, String> {
    let variable = |name: &str| std::env::var(name).ok();
    match text.split_once('/') {
        None if text == "auto" => Share::of_slurm(None, variable),
        Some(("auto", of)) => {
            let of = plain_number(of).ok_or("expected auto/N, e.g. auto/6")?;
            Share::of_slurm(Some(of), variable)
        }
        _ => text.parse(),
    }
}

/// A share: 0.1% or 0.001.
fn share(text: &str) -> Result<f64, String> {
    let (number, unit) = match text.strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text, 1.0),
    };
    let parsed = number.trim_end().parse::<f64>().ok().map(|n| n * unit);
    parsed
        .filter(|share| *share > 0.0 && *share < 1.0)
        .ok_or_else(|| "expected a share such as 0.1% or 0.001, above 0 and below 1".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_understood() {
        assert_eq!(count("1_000"), Ok(1000));
        assert_eq!(count("1e6"), Ok(1_000_000));
        assert_eq!(count("2^20"), Ok(1 << 20));
        for wrong in ["", "-1", "1.5", "2^99", "1e99", "many"] {
            assert!(count(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn shares_are_understood() {
        assert_eq!(share("0.001"), Ok(0.001));
        assert_eq!(share("50%"), Ok(0.5));
        assert_eq!(share("1e-3 %"), Ok(1e-5));
        for wrong in ["", "%", "0", "1", "100%", "-1%", "nan", "inf", "1 in 10"] {
            assert!(share(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn the_command_line_is_consistent() {
        use clap::CommandFactory;
        Cli::command().debug_assert();
    }
}
