//! Running a plan: cells that are not finished yet are measured, then everything is written and drawn from files.

use std::collections::HashSet;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};
use sahlab::rays::LineLaw;
use sahlab::report::{self, Run, screen};
use sahlab::scene::Scene;
use sahlab::study::Plan;
use sahlab::study::cell::{CellResult, measure};
use sahlab::study::hits_vs_area::{cells, summarise};
use sahlab::study::records::SamplerRecord;
use sahlab::study::samplers;
use sahlab::study::store::Store;

use crate::args::Common;
use crate::output::{note, print};
use crate::progress::Progress;

/// Lines a cell is guessed to take before its pilot, as a multiple of the least.
const GUESS: u64 = 2;

/// What to do where a mesh of the experiments that come with the program is missing.
const FETCH: &str =
    "experiments/fetch-meshes.sh fetches the meshes of experiments/figure3.toml into models/";

/// Load a plan's scenes; a procedural scene's name then carries its size, in the plan too. `place`: the experiment file, if
/// there is one.
pub fn load_scenes(plan: &mut Plan, place: Option<&Path>) -> Result<Vec<Scene>> {
    let place = place.map_or_else(String::new, |path| format!("{}: ", path.display()));
    let mut scenes = Vec::new();
    for spec in &mut plan.scenes {
        let scene = Scene::load(spec).map_err(|error| {
            let missing = spec.starts_with("models/") && !Path::new(spec).exists();
            let remedy = if missing {
                format!("; {FETCH}")
            } else {
                String::new()
            };
            anyhow!("{place}{:#}{remedy}", anyhow::Error::from(error))
        })?;
        if plan.figure.scene == *spec {
            plan.figure.scene.clone_from(&scene.name);
        }
        spec.clone_from(&scene.name);
        scenes.push(scene);
    }
    // Again, now that every scene has its full name: two ways to write one scene are the same scene.
    plan.check().map_err(|wrong| anyhow!("{place}{wrong}"))?;
    Ok(scenes)
}

/// The folders of a plan's data and figures.
fn folders(plan: &Plan, common: &Common) -> [PathBuf; 2] {
    ["data", "plots"].map(|part| common.root().join(part).join(&plan.name))
}

/// Make a plan's folders: one that cannot be written is found before anything is measured.
pub fn prepare(plan: &Plan, common: &Common) -> Result<()> {
    let [data, plots] = folders(plan, common);
    Store::open(&data).prepare()?;
    fs::create_dir_all(&plots).with_context(|| format!("{}: cannot write", plots.display()))
}

/// Run a plan over its scenes and print what came out, unless it is wanted as JSON. Gives the run as read from its files.
pub fn run(
    plan: &Plan,
    scenes: &[Scene],
    common: &Common,
    show: fn(&Run) -> String,
) -> Result<Run> {
    if !common.quiet {
        for scene in scenes {
            for text in &scene.notes {
                note(&format!("{}: {text}", scene.name));
            }
        }
    }
    let [data, plots] = folders(plan, common);
    let results = measure_cells(plan, scenes, &data, common)?;
    let records: Vec<_> = results.iter().map(|r| r.record.clone()).collect();
    let samplers = check_samplers(plan, scenes, common);
    let summary = summarise(plan, &records, &samplers);
    Store::open(&data).write_run(&results, &samplers, &summary)?;

    // From here on only files are read.
    let run = report::read_run(&data)?;
    report::write_tables(&run, &data.join("tables"))?;
    report::write_plots(&run, &plots)?;
    if !common.json {
        let files = format!("data   {}\nplots  {}\n", data.display(), plots.display());
        print(&(show(&run) + &screen::speed(&run) + &files))?;
    }
    Ok(run)
}

/// Print summaries as JSON: one as itself, several as an array.
pub fn print_json(runs: &[Run]) -> Result<()> {
    let summaries: Vec<_> = runs.iter().map(|run| &run.summary).collect();
    let json = match summaries[..] {
        [one] => serde_json::to_string_pretty(one),
        _ => serde_json::to_string_pretty(&summaries),
    };
    print(&(json.context("summaries are plain data")? + "\n"))?;
    Ok(())
}

fn measure_cells(
    plan: &Plan,
    scenes: &[Scene],
    data: &Path,
    common: &Common,
) -> Result<Vec<CellResult>> {
    let mut store = Store::open(data);
    let planned = cells(plan, scenes);
    let progress = Progress::new(planned.len(), GUESS * plan.lines.at_least(), common.quiet);
    let finished: Vec<Option<CellResult>> = planned
        .iter()
        .map(|cell| {
            if common.force {
                return None;
            }
            store.finished(&cell.id, cell.nodes)
        })
        .collect();
    let found = finished.iter().flatten().count();
    progress.announce(planned.len() - found);
    let mut results = Vec::new();
    for (cell, finished) in planned.iter().zip(finished) {
        if let Some(finished) = finished {
            progress.skip();
            results.push(finished);
            continue;
        }
        let (scene, strategy) = (&cell.scene.name, cell.rules.strategy.name());
        progress.begin(scene, &strategy);
        let result = measure(cell, &progress).map_err(|e| anyhow!("{scene} {strategy}: {e}"))?;
        store.save(&result)?;
        results.push(result);
    }
    progress.finish();
    if found > 0 && !common.quiet {
        note(&format!(
            "{found} of {} cells were finished by an earlier run (--force measures them again)",
            planned.len()
        ));
    }
    Ok(results)
}

/// The checks of the run's own lines and, where asked for, of every other law.
fn check_samplers(plan: &Plan, scenes: &[Scene], common: &Common) -> Vec<SamplerRecord> {
    let mut records = samplers::check_scenes(plan, scenes);
    if let Some(controls) = plan.controls {
        let laws = LineLaw::EXACT.len() + LineLaw::WRONG.len();
        let progress = Progress::new(laws, controls.lines, common.quiet);
        progress.begin("laws of lines", "checked");
        records.extend(samplers::check_laws(plan, &progress));
        progress.finish();
    }
    records
}

/// What a dry run prints.
pub fn describe(plan: &Plan, scenes: &[Scene]) -> String {
    let mut text = format!(
        "{}\n{}: stop {}, seed {}\n",
        plan.question, plan.name, plan.stop, plan.seed
    );
    for cell in cells(plan, scenes) {
        let line = format!(
            "{}  {:24} {:24} {:>9} objects, at least {} lines\n",
            cell.id,
            cell.scene.name,
            cell.rules.strategy,
            cell.scene.bounds.len(),
            plan.lines.at_least()
        );
        text += &line;
    }
    text
}

/// Names must differ, or one run would overwrite the other.
pub fn check_names<'a>(plans: impl Iterator<Item = &'a Plan>) -> Result<()> {
    let mut seen = HashSet::new();
    for plan in plans {
        if !seen.insert(&plan.name) {
            bail!(
                "two experiments are named '{}' and would share data/{0}; run them apart with --out",
                plan.name
            );
        }
    }
    Ok(())
}

/// A finished run, read from its folder of data.
pub fn read(folder: &Path) -> Result<Run> {
    report::read_run(folder).map_err(|error| {
        let remedy = if folder.join("summary.json").is_file() {
            ""
        } else {
            "; expected the folder of a finished run such as data/validate"
        };
        anyhow!("{:#}{remedy}", anyhow::Error::from(error))
    })
}

/// The name of the run in a folder of data.
pub fn name_of(data: &Path) -> Result<OsString> {
    let whole = data.canonicalize();
    let whole = whole.with_context(|| format!("{}: cannot read", data.display()))?;
    let name = whole.file_name().map(OsStr::to_os_string);
    name.context("expected the folder of a finished run such as data/validate")
}

/// The folder of figures that belongs to a data folder: `plots` in place of `data`.
pub fn plots_of(data: &Path) -> Result<PathBuf> {
    let name = data
        .file_name()
        .context("expected a folder such as data/validate")?;
    let root = data
        .parent()
        .and_then(Path::parent)
        .unwrap_or(Path::new("."));
    Ok(root.join("plots").join(name))
}
