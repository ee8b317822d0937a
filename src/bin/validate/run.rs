//! Running a plan: cells that are not finished yet are measured, then everything is written and drawn from files.

use std::collections::HashSet;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};
use sahlab::files::{make_folder, remove_unfinished};
use sahlab::report::{self, Run, screen};
use sahlab::scene::Scene;
use sahlab::study::pieces::{Extent, Piece};
use sahlab::study::store::{Claim, Store, check_finished};
use sahlab::study::{self, Plan};

use crate::args::Common;
use crate::output::{note, print};
use crate::progress::Progress;

/// What to do where a mesh of the experiments that come with the program is missing.
const FETCH: &str =
    "experiments/fetch-meshes.sh fetches the meshes of experiments/figure3.toml into models/";

/// Load a plan's scenes; a procedural scene's name then carries its size, in the plan too. `place`: the experiment file, if
/// there is one.
pub fn load_scenes(plan: &mut Plan, place: Option<&Path>) -> Result<Vec<Scene>> {
    let place = place.map_or_else(String::new, |path| format!("{}: ", path.display()));
    let mut scenes = Vec::new();
    for number in 0..plan.scenes.len() {
        let spec = plan.scenes[number].as_str();
        let scene = Scene::load(spec).map_err(|error| {
            let missing = spec.starts_with("models/") && !Path::new(spec).exists();
            let remedy = if missing {
                format!("; {FETCH}")
            } else {
                String::new()
            };
            anyhow!("{place}{:#}{remedy}", anyhow::Error::from(error))
        })?;
        plan.rename_scene(number, &scene.name);
        scenes.push(scene);
    }
    // Again, now that every scene has its full name: two ways to write one scene are the same scene.
    plan.check().map_err(|wrong| anyhow!("{place}{wrong}"))?;
    study::check_scenes(plan, &scenes).map_err(|wrong| anyhow!("{place}{wrong}"))?;
    if let Some(record) = &plan.record {
        record
            .check_scenes(&scenes)
            .map_err(|wrong| anyhow!("{place}{wrong}"))?;
    }
    Ok(scenes)
}

/// The folders of a plan's data and figures.
pub fn folders(plan: &Plan, common: &Common) -> [PathBuf; 2] {
    ["data", "plots"].map(|part| common.root().join(part).join(&plan.name))
}

/// Make a plan's folders: one that cannot be written is found before anything is measured. They are this process's own while
/// it holds what this gives.
pub fn prepare(plan: &Plan, common: &Common) -> Result<Claim> {
    let [data, plots] = folders(plan, common);
    let claim = Store::open(&data).prepare()?;
    let unwritable = || format!("{}: cannot write", plots.display());
    make_folder(&plots).with_context(unwritable)?;
    remove_unfinished(&plots).with_context(unwritable)?;
    Ok(claim)
}

/// Run a plan over its scenes and print what came out, unless it is wanted as JSON. Gives the run as read from its files.
pub fn run(
    plan: &Plan,
    scenes: &[Scene],
    common: &Common,
    show: fn(&Run) -> String,
) -> Result<Run> {
    let [data, _] = folders(plan, common);
    let store = Store::open(&data);
    let store = if common.force {
        store.forgetful()
    } else {
        store
    };
    measure(plan, scenes, &store, common)?;
    report(plan, common, show)
}

/// Measure what the store has not yet, with progress and notes.
pub fn measure(plan: &Plan, scenes: &[Scene], store: &Store, common: &Common) -> Result<()> {
    if !common.quiet {
        for scene in scenes {
            for text in &scene.notes {
                note(&format!("{}: {text}", scene.name));
            }
        }
    }
    let progress = Progress::new(common.quiet);
    let done = study::run(plan, scenes, store, &progress);
    progress.finish();
    Ok(done?)
}

/// Draw and tell what a run holds whose data are there, which finishes it. Gives the run as read from its files.
pub fn report(plan: &Plan, common: &Common, show: fn(&Run) -> String) -> Result<Run> {
    let [data, plots] = folders(plan, common);

    // From here on only files are read.
    let run = report::read_run(&data)?;
    report::write_tables(&run, &data.join("tables"))?;
    report::write_plots(&run, &plots)?;
    let page = report::write_report(&run, &plots)?;
    Store::open(&data).finish()?;
    if !common.json {
        let files = format!(
            "data   {}\nplots  {}\nreport {}\n",
            data.display(),
            plots.display(),
            page.display()
        );
        print(&(show(&run) + &screen::speed(&run) + &files))?;
    }
    Ok(run)
}

/// What all pieces of a run amount to, in a line.
pub fn total(pieces: &[Piece<()>]) -> String {
    let sum = |part: fn(&Extent) -> f64| pieces.iter().map(|p| part(&p.extent)).sum::<f64>();
    let lines = sum(|extent| extent.lines as f64);
    let minutes = sum(|extent| extent.seconds) / 60.0;
    let megabytes = sum(|extent| extent.bytes as f64) / 1e6 + REPORTED;
    let time = if minutes < 2.0 {
        match (minutes * 60.0).ceil() {
            few if few <= 1.0 => "1 second".into(),
            more => format!("{more:.0} seconds"),
        }
    } else {
        format!("{minutes:.0} minutes")
    };
    format!(
        "in all: {} pieces, at least {:.2} million lines and rays, about {time} on two cores of 2024, about {megabytes:.0} MB on \
         disk\n",
        pieces.len(),
        lines / 1e6,
    )
}

/// Megabytes of the tables, figures and page of a run, roughly.
const REPORTED: f64 = 3.0;

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
    check_finished(folder)?;
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

/// The folder of figures that belongs to a run's folder of data: `plots` in place of the last `data` above it.
pub fn plots_of(data: &Path) -> Result<PathBuf> {
    let beside = |data: &Path| {
        let above = data.parent()?;
        let place = above.ancestors().find(|at| at.ends_with("data"))?;
        let below = data.strip_prefix(place).ok()?;
        Some(place.with_file_name("plots").join(below))
    };
    // As it was typed, if that tells; `.` or a bare name does not.
    let whole = || data.canonicalize().ok();
    beside(data)
        .or_else(|| beside(&whole()?))
        .with_context(|| {
            format!(
                "{}: not below a folder `data`, so none of figures belongs to it; expected one such as data/validate",
                data.display()
            )
        })
}

/// The folder that a command on a finished run puts figures into: the run's own, or one below --out.
pub fn plots_for(data: &Path, common: &Common) -> Result<PathBuf> {
    match &common.out {
        Some(out) => Ok(out.join("plots").join(name_of(data)?)),
        None => plots_of(data),
    }
}
