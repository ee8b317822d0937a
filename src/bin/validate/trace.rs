//! `validate trace`: a user's own rays through one tree.

use std::path::Path;

use anyhow::{Context, Result};
use sahlab::kd::{Ask, Rules};
use sahlab::rays::file;
use sahlab::report;
use sahlab::scene::Scene;
use sahlab::study::records::TraceRecord;
use sahlab::study::store::Store;
use sahlab::study::trace::{Trace, trace as run};
use serde::Serialize;

use crate::args::Common;
use crate::output::{note, print};
use crate::progress::Progress;

/// What `--json` prints: the record, and the seconds, which no file has.
#[derive(Serialize)]
struct Printed<'a> {
    #[serde(flatten)]
    record: &'a TraceRecord,
    build_s: f64,
    trace_s: f64,
}

/// Trace the rays of a file and write `data/trace/`. Everything wrong with the input is found before anything is written.
pub fn trace(spec: &str, rays: &Path, ask: Ask, rules: Rules, common: &Common) -> Result<bool> {
    let casts = file::read(rays)?;
    let scene = Scene::load(spec)?;
    if !common.quiet {
        for text in &scene.notes {
            note(&format!("{}: {text}", scene.name));
        }
    }
    let folder = common.root().join("data").join("trace");
    if common.dry_run {
        let text = format!(
            "would trace {} rays of {}, asking {ask}, through the tree of {} (stop {}{}) over {} ({}) and write {}\n",
            casts.len(),
            rays.display(),
            rules.strategy,
            rules.stop,
            if rules.clipped { ", clipped" } else { "" },
            scene.name,
            scene.counts(),
            folder.join("hits.csv").display()
        );
        print(&text)?;
        return Ok(true);
    }
    let asked = Trace {
        scene: &scene,
        rules,
        ask,
        file: rays.display().to_string(),
        casts: &casts,
    };
    let store = Store::open(&folder);
    store.prepare()?;
    let progress = Progress::new(common.quiet);
    let (record, seconds) = run(&asked, &store, &progress)?;
    progress.finish();
    let text = if common.json {
        let printed = Printed {
            record: &record,
            build_s: seconds.build,
            trace_s: seconds.trace,
        };
        serde_json::to_string_pretty(&printed).context("a record is plain data")? + "\n"
    } else {
        let hits = folder.join("hits.csv");
        report::trace::screen(&record, [seconds.build, seconds.trace])
            + &format!("hits   {}\n", hits.display())
    };
    print(&text)?;
    Ok(true)
}
