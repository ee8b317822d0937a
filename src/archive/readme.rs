//! The README of an archive.

use std::fmt::Write;

use super::TOLERANCE;
use super::bag::agent;
use super::claims::cell;
use super::gather::Run;
use crate::study::Plan;

/// The text, for an archive of that name.
pub(super) fn text(name: &str, runs: &[Run]) -> String {
    let mut text = format!("# {name}: runs of {}\n\n", agent());
    text += "How well does the surface area heuristic predict what ray tracing through a kd-tree really costs? Here are the\n\
             files of finished runs, with what is needed to check and to repeat them.\n\n";
    text += "| run | question | made by |\n|:---|:---|:---|\n";
    for Run { plan, .. } in runs {
        let (question, command) = (cell(&plan.question), cell(&plan.command));
        writeln!(text, "| {} | {question} | `{command}` |", plan.name).expect("in memory");
    }
    text += "\n`data/RUN/README.md` explains every file and column of a run, `plots/RUN/` has its figures and\n\
             `report.html`, all of it on one page, `experiments/RUN.toml`\n\
             what was asked for and with which options, `resolved/RUN.toml` the same with all defaults written out, `CLAIMS.md` what\n\
             was found and how to check it, `environment.json` which programs and machines measured and which packed this,\n\
             `Cargo.lock` the dependencies, `replay.json` the digests of all files that a repeated run must reproduce,\n\
             `ro-crate-metadata.json` all of it for machines (RO-Crate 1.1, Process Run Crate 0.5). The folder around this one is\n\
             a bag (BagIt 1.0). Dates are 1970-01-01 where none was told.\n\n## To check the files\n\n```sh\n";
    text += "sha256sum -c manifest-sha256.txt      # in the folder around this one\n";
    writeln!(text, "validate verify {name}.tar.gz").expect("in memory");
    writeln!(
        text,
        "```\n\n## To repeat the runs\n\nOf every file under `data/` but those that hold times (`timings.csv`, `times-*`), counts and words must come out the same,\n\
         on any number of threads, and other figures within {TOLERANCE:e} of each other (relative; on the same kind of machine they\n\
         are equal to the byte):\n\n```sh\nvalidate verify {name}.tar.gz --replay\n```\n\nor by hand, in this folder:\n\n```sh"
    )
    .expect("in memory");
    for run in runs {
        let run = run.name();
        writeln!(
            text,
            "validate run experiments/{run}.toml --out again; diff -r -x cells -x timings.csv -x 'times-*' data/{run} again/data/{run}"
        )
        .expect("in memory");
    }
    text += "```\n";
    let meshes: Vec<_> = runs.iter().flat_map(|run| meshes(&run.plan)).collect();
    if !meshes.is_empty() {
        text += "\nMeshes are not packed. They must lie at these paths, seen from where the command is given; another mesh is\n\
                 refused by the digest of its objects and look:\n\n| mesh | digest |\n|:---|:---|\n";
        for (mesh, digest) in meshes {
            writeln!(text, "| `{}` | `{digest}` |", cell(mesh)).expect("in memory");
        }
    }
    text
}

/// The scenes of a plan that are files, with their contents.
fn meshes(plan: &Plan) -> Vec<(&str, &str)> {
    let scenes = plan.record.iter().flat_map(|record| &record.scenes);
    let made = ["simple:", "spd:", "hard:"];
    let is_file = |name: &str| !made.iter().any(|prefix| name.starts_with(prefix));
    scenes
        .filter(|(name, _)| is_file(name))
        .map(|(name, content)| (name.as_str(), content.as_str()))
        .collect()
}
