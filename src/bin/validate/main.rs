//! `validate`: the command line of sahlab.

mod args;
mod output;
mod progress;
mod publish;
mod run;

use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::Parser;
use sahlab::cost::CostModel;
use sahlab::kd::{StopRule, Strategy};
use sahlab::rays::LineLaw;
use sahlab::report::{read_run, screen, write_plots, write_tables};
use sahlab::scene::{Scene, catalogue};
use sahlab::study::plan::{Expect, Figure, Overrides};
use sahlab::study::{LineRule, Plan};

use args::{Cli, Command, Common, Listed};
use output::{complain, print};

/// Experiments that come with the program: name and text.
const EXPERIMENTS: [(&str, &str); 2] = [
    (
        "validate",
        include_str!("../../../experiments/validate.toml"),
    ),
    ("figure3", include_str!("../../../experiments/figure3.toml")),
];

fn main() -> ExitCode {
    let cli = Cli::parse();
    match execute(&cli) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            complain(&error);
            ExitCode::from(2)
        }
    }
}

/// Do what was asked; says whether every expectation held.
fn execute(cli: &Cli) -> Result<bool> {
    let common = &cli.common;
    let mut pool = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = common.threads {
        pool = pool.num_threads(threads.into());
    }
    pool.build_global().context("cannot start the threads")?;
    let overrides = Overrides {
        seed: common.seed,
        lines: common.lines,
        quick: common.quick,
    };
    match &cli.command {
        None => {
            let (name, text) = EXPERIMENTS[0];
            let plan = Plan::parse(text, &format!("experiments/{name}.toml"), name, overrides)?;
            run_plans(vec![plan], common)
        }
        Some(Command::Run { experiments }) => {
            let plans = experiments.iter().map(|path| Plan::read(path, overrides));
            run_plans(plans.collect::<Result<_, _>>()?, common)
        }
        Some(Command::Scene { scene, stop }) => one_scene(scene, *stop, common, overrides),
        Some(Command::List { what }) => print(&list(*what)).map(|()| true).map_err(Into::into),
        Some(Command::Plots { folder }) => {
            let files = write_plots(&read_run(folder)?, &run::plots_of(folder)?)?;
            print(&paths(&files))?;
            Ok(true)
        }
        Some(Command::Tables { folder }) => {
            let files = write_tables(&read_run(folder)?, &folder.join("tables"))?;
            print(&paths(&files))?;
            Ok(true)
        }
        Some(Command::Publish { names }) => publish::publish(&common.out, names, !common.quiet),
    }
}

/// Everything that can be wrong with the input is found before the first line is counted.
fn run_plans(mut plans: Vec<Plan>, common: &Common) -> Result<bool> {
    run::check_names(&plans)?;
    let scenes: Vec<Vec<Scene>> = plans
        .iter_mut()
        .map(run::load_scenes)
        .collect::<Result<_>>()?;
    let mut held = true;
    for (plan, scenes) in plans.iter().zip(&scenes) {
        held &= run::run(plan, scenes, common, screen::study)?;
    }
    Ok(held)
}

/// `validate scene`: the same measurement on one scene, every strategy.
fn one_scene(spec: &str, stop: StopRule, common: &Common, overrides: Overrides) -> Result<bool> {
    let slope_within = if common.quick { 0.02 } else { 0.005 };
    let lines = match overrides.lines {
        Some(n) => LineRule::exactly(n),
        None if common.quick => LineRule::exactly(1 << 16),
        None => LineRule::for_error(slope_within, 1 << 18, 1 << 22),
    };
    let mut plan = Plan {
        name: String::new(),
        command: format!("validate scene {spec} --stop {stop}"),
        question: format!(
            "What does a kd-tree over {spec} cost, and which strategy should build it?"
        ),
        seed: overrides.seed.unwrap_or(1),
        scenes: vec![spec.into()],
        strategies: Strategy::ALL.into(),
        stop,
        cost: CostModel::WALD_HAVRAN,
        lines: lines.map_err(anyhow::Error::msg)?,
        nodes: false,
        figure: Figure {
            scene: spec.into(),
            strategy: Strategy::Sah,
        },
        controls: None,
        expect: Expect {
            slope_within,
            family: 0.01,
            gate: 0.001,
        },
        quick: common.quick,
    };
    let scenes = run::load_scenes(&mut plan)?;
    plan.name = format!("scene-{}", file_name_of(&plan.scenes[0]));
    run::run(&plan, &scenes, common, screen::scene)
}

/// A scene's name as a part of a path: a file's stem, or the words of a procedural scene.
fn file_name_of(scene: &str) -> String {
    let name = match scene.split_once(':') {
        Some(("simple" | "spd", _)) => scene.into(),
        _ => Path::new(scene)
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned(),
    };
    name.replace(|c: char| !c.is_alphanumeric() && c != '_', "-")
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
        for (name, about) in rows {
            text += &format!("  {name:26} {about}\n");
        }
    };
    let mut scenes = catalogue();
    scenes.push(("PATH".into(), "a mesh: .obj, .ply or .off".into()));
    section(Listed::Scenes, "scenes", scenes);
    let strategies = Strategy::ALL.iter().map(|s| (s.name(), s.description()));
    section(Listed::Strategies, "strategies", strategies.collect());
    let laws = LineLaw::EXACT.iter().chain(&LineLaw::WRONG);
    let laws = laws.map(|l| (l.name().into(), l.description().into()));
    section(
        Listed::Samplers,
        "samplers of lines (wrong ones are negative controls)",
        laws.collect(),
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
        .map(|(name, text)| (format!("experiments/{name}.toml"), about(text)));
    section(Listed::Experiments, "experiments", experiments.collect());
    text
}

fn paths(files: &[std::path::PathBuf]) -> String {
    files.iter().map(|f| format!("{}\n", f.display())).collect()
}
