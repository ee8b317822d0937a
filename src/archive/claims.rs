//! What the runs claim, and how each claim is checked: `CLAIMS.md`.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::TOLERANCE;
use super::gather::Run;

/// What is told of runs beside their own files, by path: what was claimed, and each experiment with every default written out.
pub(super) fn texts(runs: &[Run]) -> BTreeMap<String, String> {
    let resolved = runs.iter().map(|run| {
        let path = format!("resolved/{}.toml", run.name());
        (path, run.plan.resolved())
    });
    let claims = ("CLAIMS.md".into(), text(runs));
    resolved.chain([claims]).collect()
}

/// The text of `CLAIMS.md`: a row for each verdict.
fn text(runs: &[Run]) -> String {
    let mut text = String::from(
        "# Claims\n\nEach row is an expectation that was written down before its run: what came of it, the command that repeats the run from this\n\
         folder, the file that must come out again below `again/`, and the minutes it took (see environment.json for the machines).\n\n\
         | run | claim | held | what was found | command | file | minutes | tolerance |\n\
         |:---|:---|:---|:---|:---|:---|---:|:---|\n",
    );
    for run in runs {
        let name = run.name();
        let minutes = minutes(run.times.seconds);
        for verdict in &run.summary.verdicts {
            let held = if verdict.held { "yes" } else { "no" };
            writeln!(
                text,
                "| {name} | {} | {held} | {} | `validate run experiments/{name}.toml --out again` | `data/{name}/summary.json` | {minutes} | \
                 counts and words exactly, other figures within {TOLERANCE:e} |",
                cell(&verdict.name),
                cell(&verdict.message),
            )
            .expect("in memory");
        }
    }
    text += "\nA claim that rests on seconds is made from times, which differ from run to run and are only shown; files that hold them\n\
             (`timings.csv`, `times-*`) are not compared.\n";
    text
}

/// Minutes, to a hundredth.
fn minutes(seconds: f64) -> String {
    match seconds / 60.0 {
        few if few < 0.01 => "< 0.01".into(),
        more => format!("{more:.2}"),
    }
}

/// Text as it stands in a cell of a table.
pub(super) fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace(char::is_control, " ")
}
