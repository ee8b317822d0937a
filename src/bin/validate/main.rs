//! `validate`: the command line of sahlab.

mod archive;
mod args;
mod examples;
mod output;
mod progress;
mod publish;
mod render;
mod run;
mod scene;
mod shards;
mod splice;
mod trace;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::{CommandFactory, Parser};
use sahlab::cost::CostModel;
use sahlab::files::{self, write_atomic};
use sahlab::kd::{Rules, Strategy};
use sahlab::rays::{LineLaw, Source};
use sahlab::report::{Run, screen, write_plots, write_report, write_tables};
use sahlab::scene::{Scene, catalogue};
use sahlab::study::plan::{Overrides, PlanError};
use sahlab::study::speed_vs_error::asked::Method;
use sahlab::study::{self, Plan, stability};
use sahlab::tracer::RayKind;

use args::{Cli, Command, Common, Listed};
use output::{complain, note, print};

/// Experiments that come with the program: name and text.
const EXPERIMENTS: [(&str, &str); 16] = [
    (
        "validate",
        include_str!("../../../experiments/validate.toml"),
    ),
    (
        "validate-strategies",
        include_str!("../../../experiments/validate-strategies.toml"),
    ),
    (
        "validate-cost",
        include_str!("../../../experiments/validate-cost.toml"),
    ),
    (
        "validate-assumptions",
        include_str!("../../../experiments/validate-assumptions.toml"),
    ),
    (
        "validate-speed",
        include_str!("../../../experiments/validate-speed.toml"),
    ),
    (
        "validate-stability",
        include_str!("../../../experiments/validate-stability.toml"),
    ),
    (
        "validate-traversal",
        include_str!("../../../experiments/validate-traversal.toml"),
    ),
    ("figure3", include_str!("../../../experiments/figure3.toml")),
    (
        "strategies",
        include_str!("../../../experiments/strategies.toml"),
    ),
    (
        "termination",
        include_str!("../../../experiments/termination.toml"),
    ),
    (
        "split-cost",
        include_str!("../../../experiments/split-cost.toml"),
    ),
    ("cost", include_str!("../../../experiments/cost.toml")),
    (
        "assumptions",
        include_str!("../../../experiments/assumptions.toml"),
    ),
    (
        "speed-vs-error",
        include_str!("../../../experiments/speed-vs-error.toml"),
    ),
    (
        "stability",
        include_str!("../../../experiments/stability.toml"),
    ),
    (
        "traversal",
        include_str!("../../../experiments/traversal.toml"),
    ),
];

/// So many of them, the first ones, are the default study.
const DEFAULT: usize = 7;

fn main() -> ExitCode {
    let cli = Cli::parse();
    if let Err(error) = stop_when_told() {
        complain(&error);
    }
    match execute(&cli) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            complain(&error);
            ExitCode::from(2)
        }
    }
}

/// Ctrl-C and a request to terminate end the program between two files: none stays half-written.
fn stop_when_told() -> Result<()> {
    let stop = || {
        note("stopped; what was finished is kept, and the same command goes on where this one was");
        files::exit(STOPPED)
    };
    ctrlc::set_handler(stop).context("cannot watch for Ctrl-C")
}

/// The exit code of a program that was told to stop: 128 and the number of the signal that Ctrl-C sends.
const STOPPED: i32 = 130;

/// Do what was asked; says whether every expectation held.
fn execute(cli: &Cli) -> Result<bool> {
    let common = &cli.common;
    cli.check()?;
    let mut pool = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = common.threads {
        pool = pool.num_threads(threads.into());
    }
    pool.build_global().context("cannot start the threads")?;
    let overrides = Overrides {
        seed: common.seed,
        lines: common.lines,
        error: common.error,
        quick: common.quick,
    };
    match &cli.command {
        None => {
            let plans = EXPERIMENTS[..DEFAULT].iter().map(|(name, text)| {
                let path = file_of(name);
                let plan = |overrides| Plan::parse(text, &path, name, overrides);
                let error = None;
                let plain = plan(Overrides { error, ..overrides })?;
                let plan = match overrides.error {
                    Some(_) if plain.kind.counts_to_an_error() => plan(overrides)?,
                    Some(_) => {
                        note(&format!("{path}: --error does not apply to its kind"));
                        plain
                    }
                    None => plain,
                };
                Ok::<_, PlanError>((path.into(), plan))
            });
            let plans: Vec<(PathBuf, Plan)> = plans.collect::<Result<_, _>>()?;
            let names: Vec<String> = plans.iter().map(|(_, plan)| plan.name.clone()).collect();
            let held = run_plans(plans, common)?;
            if !common.dry_run {
                let data = common.root().join("data");
                let folders: Vec<_> = names.iter().map(|name| data.join(name)).collect();
                let file = archive::pack_below(&folders, Some(&names[0]), common.root())?;
                if !common.json {
                    print(&format!("archive {}\n", file.display()))?;
                }
            }
            Ok(held)
        }
        Some(Command::Run { experiments, shard }) => {
            let plans = experiments
                .iter()
                .map(|path| Ok::<_, PlanError>((path.clone(), read_plan(path, overrides)?)));
            let plans = plans.collect::<Result<_, _>>()?;
            match shard {
                Some(share) => shards::run(&load(plans)?, *share, common),
                None => run_plans(plans, common),
            }
        }
        Some(Command::Merge { folders }) => shards::merge(folders, common),
        Some(Command::Plan {
            experiment,
            shards,
            format,
        }) => {
            let plan = read_plan(experiment, overrides)?;
            let script = shards::script(&plan, experiment, *shards, *format, common)?;
            print(&script)?;
            Ok(true)
        }
        Some(Command::Scene {
            scene,
            nff: Some(file),
            digits,
            ..
        }) => write_nff(scene, file, *digits, common),
        Some(Command::Scene {
            scene,
            stop,
            clipped,
            rays,
            ask,
            ..
        }) => {
            let asked = scene::OneScene {
                spec: scene,
                stop: *stop,
                clipped: *clipped,
                own: rays.as_deref().map(|file| (file, *ask)),
            };
            scene::one_scene(&asked, common, overrides)
        }
        Some(Command::Trace {
            scene,
            rays,
            ask,
            strategy,
            stop,
            clipped,
        }) => {
            let rules = Rules {
                strategy: *strategy,
                stop: *stop,
                cost: CostModel::WALD_HAVRAN,
                clipped: *clipped,
            };
            trace::trace(scene, rays, *ask, rules, common)
        }
        Some(Command::List { what }) => print(&list(*what)).map(|()| true).map_err(Into::into),
        Some(Command::Plots { folder }) => {
            let run = run::read(folder)?;
            let files = write_plots(&run, &run::plots_for(folder, common)?)?;
            print(&paths(&files))?;
            Ok(true)
        }
        Some(Command::Report { folder }) => {
            let run = run::read(folder)?;
            let page = write_report(&run, &run::plots_for(folder, common)?)?;
            print(&paths(&[page]))?;
            Ok(true)
        }
        Some(Command::Tables { folder }) => {
            let run = run::read(folder)?;
            let data = match &common.out {
                Some(out) => out.join("data").join(run::name_of(folder)?),
                None => folder.clone(),
            };
            let files = write_tables(&run, &data.join("tables"))?;
            print(&paths(&files))?;
            Ok(true)
        }
        Some(Command::Archive { folders }) => archive::pack(folders, common),
        Some(Command::Verify { file, replay }) => archive::verify(file, *replay, common),
        Some(Command::Publish { check: true, .. }) => publish::check_pages(common.root()),
        Some(Command::Publish { names, .. }) => {
            publish::publish(common.root(), names, !common.quiet)
        }
        Some(Command::Completions { shell }) => {
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut Cli::command(), "validate", &mut script);
            print(&String::from_utf8(script)?)?;
            Ok(true)
        }
    }
}

/// The file of an experiment that comes with the program.
fn file_of(name: &str) -> String {
    format!("experiments/{name}.toml")
}

/// The plan of an experiment file; of one that comes with the program, where there is no such file.
fn read_plan(path: &Path, overrides: Overrides) -> Result<Plan, PlanError> {
    let known = EXPERIMENTS
        .iter()
        .find(|(name, _)| Path::new(&file_of(name)) == path);
    match known {
        Some((name, text)) if !path.exists() => {
            Plan::parse(text, &path.display().to_string(), name, overrides)
        }
        _ => Plan::read(path, overrides),
    }
}

fn run_plans(plans: Vec<(PathBuf, Plan)>, common: &Common) -> Result<bool> {
    run_loaded(&load(plans)?, common, screen::study)
}

/// Everything that can be wrong with the input is found before the first line is counted.
fn load(plans: Vec<(PathBuf, Plan)>) -> Result<Vec<(Plan, Vec<Scene>)>> {
    run::check_names(plans.iter().map(|(_, plan)| plan))?;
    let mut loaded = Vec::new();
    for (path, mut plan) in plans {
        let scenes = run::load_scenes(&mut plan, Some(&path))?;
        loaded.push((plan, scenes));
    }
    Ok(loaded)
}

/// Run plans over their scenes. Says whether every expectation held.
fn run_loaded(
    plans: &[(Plan, Vec<Scene>)],
    common: &Common,
    show: fn(&Run) -> String,
) -> Result<bool> {
    if common.dry_run {
        for (plan, scenes) in plans {
            let head = format!("{}\n{}: ", plan.question, plan.name);
            let pieces = study::pieces(plan, scenes);
            print(&(head + &study::describe(plan, scenes) + &run::total(&pieces)))?;
        }
        return Ok(true);
    }
    let claims = plans.iter().map(|(plan, _)| run::prepare(plan, common));
    let _claims = claims.collect::<Result<Vec<_>>>()?;
    let runs = plans
        .iter()
        .map(|(plan, scenes)| run::run(plan, scenes, common, show))
        .collect::<Result<Vec<_>>>()?;
    if common.json {
        run::print_json(&runs)?;
    } else if runs.len() > 1 {
        print(&screen::together(&runs))?;
    }
    Ok(runs.iter().all(Run::held))
}

/// `validate scene --nff`: the scene as a file.
fn write_nff(spec: &str, file: &Path, digits: u8, common: &Common) -> Result<bool> {
    let scene = Scene::load(spec)?;
    if !common.quiet {
        for text in &scene.notes {
            note(&format!("{}: {text}", scene.name));
        }
    }
    let text = scene.to_nff(digits.into()).with_context(|| {
        format!(
            "{}: has no camera, lights and materials, which an NFF file needs; scenes named spd: and .nff files with a view \
             have them",
            scene.name
        )
    })?;
    let what = format!("{}, {} significant digits", scene.counts(), digits);
    if common.dry_run {
        print(&format!("would write {}: {what}\n", file.display()))?;
        return Ok(true);
    }
    if file == Path::new("-") {
        return print(&text).map(|()| true).map_err(Into::into);
    }
    write_atomic(file, text.as_bytes())
        .with_context(|| format!("{}: cannot write", file.display()))?;
    print(&format!("{}: {what}\n", file.display()))?;
    Ok(true)
}

fn list(what: Option<Listed>) -> String {
    let mut text = String::new();
    let mut section = |listed: Listed, title: &str, rows: Vec<(String, String)>| {
        if what.is_some_and(|w| w != listed) {
            return;
        }
        if what.is_none() {
            text += &format!("{title}\n");
        }
        let widest = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
        for (name, about) in rows {
            text += &format!("  {name:widest$}  {about}\n");
        }
    };
    let mut scenes = catalogue();
    scenes.push((
        "PATH".into(),
        "a file: .obj, .ply, .stl, .off or .nff".into(),
    ));
    section(Listed::Scenes, "scenes", scenes);
    let strategies = Strategy::ALL.into_iter().chain([Strategy::SahBins(32)]);
    let strategies = strategies.map(|s| (s.name(), s.description()));
    section(Listed::Strategies, "strategies", strategies.collect());
    let laws = LineLaw::EXACT.iter().chain(&LineLaw::WRONG);
    let laws = laws.map(|l| (l.name().into(), l.description().into()));
    let methods = Method::ALL.map(|m| (m.name().into(), m.description().into()));
    section(
        Listed::Samplers,
        "samplers of lines: laws (wrong ones are negative controls), then the methods of [samplers], all of the exact law",
        laws.chain(methods).collect(),
    );
    let sources = Source::all().map(|s| (s.name().into(), s.description().into()));
    let kinds = RayKind::ALL.map(|kind| {
        let about = "a picture's rays of this kind, of scenes with a camera and lights";
        (kind.name().into(), about.into())
    });
    section(
        Listed::Rays,
        "rays (SOURCE: nothing stops them; SOURCE:nearest, SOURCE:any: up to their first, or any, hit; wrong: not the metric's)",
        sources.chain(kinds).collect(),
    );
    let cases = stability::catalogue();
    let cases = cases.iter().map(|case| {
        let about = format!("{}: {}", case.group.name(), case.stresses);
        (case.name.to_string(), about)
    });
    section(
        Listed::Cases,
        "hard cases (GROUP: what it stresses)",
        cases.collect(),
    );
    let about = |text: &str| {
        text.lines()
            .next()
            .unwrap_or_default()
            .trim_start_matches("# ")
            .to_string()
    };
    let experiments = EXPERIMENTS
        .iter()
        .map(|(name, text)| (file_of(name), about(text)));
    section(Listed::Experiments, "experiments", experiments.collect());
    text
}

fn paths(files: &[PathBuf]) -> String {
    files.iter().map(|f| format!("{}\n", f.display())).collect()
}
