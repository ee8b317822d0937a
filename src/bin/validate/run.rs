//! Running a plan: cells that are not finished yet are measured, then everything is written and drawn from files.

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

/// Load a plan's scenes; a procedural scene's name then carries its size, in the plan too.
pub fn load_scenes(plan: &mut Plan) -> Result<Vec<Scene>> {
    let mut scenes = Vec::new();
    for spec in &mut plan.scenes {
        let scene = Scene::load(spec).map_err(|error| {
            let hint = "experiments/fetch-meshes.sh fetches the meshes of experiments/figure3.toml into models/";
            let missing = spec.starts_with("models/") && !Path::new(spec).exists();
            let error = anyhow::Error::from(error);
            if missing { error.context(hint) } else { error }
        })?;
        if plan.figure.scene == *spec {
            plan.figure.scene.clone_from(&scene.name);
        }
        spec.clone_from(&scene.name);
        scenes.push(scene);
    }
    Ok(scenes)
}

/// Run a plan over its scenes. Says whether every expectation held.
pub fn run(
    plan: &Plan,
    scenes: &[Scene],
    common: &Common,
    show: fn(&Run) -> String,
) -> Result<bool> {
    if common.dry_run {
        print(&describe(plan, scenes))?;
        return Ok(true);
    }
    if !common.quiet {
        for scene in scenes {
            for text in &scene.notes {
                note(&format!("{}: {text}", scene.name));
            }
        }
    }
    let data = common.out.join("data").join(&plan.name);
    let plots = common.out.join("plots").join(&plan.name);
    let results = measure_cells(plan, scenes, &data, common)?;
    let records: Vec<_> = results.iter().map(|r| r.record.clone()).collect();
    let samplers = check_samplers(plan, scenes, common);
    let summary = summarise(plan, &records, &samplers);
    Store::open(&data).write_run(&results, &samplers, &summary)?;

    // From here on only files are read.
    let run = report::read_run(&data)?;
    report::write_tables(&run, &data.join("tables"))?;
    report::write_plots(&run, &plots)?;
    if common.json {
        let json =
            serde_json::to_string_pretty(&run.summary).context("the summary is plain data")?;
        print(&(json + "\n"))?;
    } else {
        let files = format!("data   {}\nplots  {}\n", data.display(), plots.display());
        print(&(show(&run) + &screen::speed(&run) + &files))?;
    }
    Ok(run.summary.verdicts.iter().all(|v| v.held))
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
    let mut results = Vec::new();
    let mut found = 0;
    for cell in &planned {
        if !common.force
            && let Some(finished) = store.finished(&cell.id, cell.nodes)
        {
            progress.skip();
            found += 1;
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
fn describe(plan: &Plan, scenes: &[Scene]) -> String {
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
pub fn check_names(plans: &[Plan]) -> Result<()> {
    for (i, plan) in plans.iter().enumerate() {
        if plans[..i].iter().any(|p| p.name == plan.name) {
            bail!(
                "two experiments are named '{}' and would share data/{0}; run them apart with --out",
                plan.name
            );
        }
    }
    Ok(())
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
