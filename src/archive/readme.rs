//! The README of an archive.

use std::fmt::Write;

use crate::study::Plan;

/// The text, for an archive of that name.
pub(super) fn text(name: &str, plans: &[Plan]) -> String {
    let mut text = format!(
        "# {name}: runs of sahlab {}, revision {}\n\n",
        env!("CARGO_PKG_VERSION"),
        crate::REVISION
    );
    text += "How well does the surface area heuristic predict what ray tracing through a kd-tree really costs? Here are the\n\
             files of finished runs, with what is needed to check and to repeat them.\n\n";
    text += "| run | question | made by |\n|:---|:---|:---|\n";
    for plan in plans {
        let question = plan.question.replace('|', "\\|");
        writeln!(text, "| {} | {question} | `{}` |", plan.name, plan.command).expect("in memory");
    }
    text += "\n`data/RUN/README.md` explains every file and column of a run, `plots/RUN/` has its figures and\n\
             `report.html`, all of it on one page, `experiments/RUN.toml` what was asked for and with which options,\n\
             `environment.json` program, compiler and the machine that packed this\n\
             (not always the one that ran), `Cargo.lock` the dependencies.\n\n## To check the files\n\n```sh\n";
    text += "sha256sum -c manifest-sha256.txt      # in this folder\n";
    writeln!(text, "validate verify {name}.tar.gz").expect("in memory");
    text += "```\n\n## To repeat the runs\n\nEvery file under `data/` but those that hold times (`timings.csv`, `times-*`) must \
             come out the same to the byte, on any\nnumber of threads:\n\n```sh\n";
    writeln!(text, "validate verify {name}.tar.gz --replay").expect("in memory");
    text += "```\n\nor by hand, in this folder:\n\n```sh\n";
    for plan in plans {
        let run = &plan.name;
        writeln!(
            text,
            "validate run experiments/{run}.toml --out again; diff -r -x cells -x timings.csv -x 'times-*' data/{run} again/data/{run}"
        )
        .expect("in memory");
    }
    text += "```\n";
    let meshes: Vec<_> = plans.iter().flat_map(meshes).collect();
    if !meshes.is_empty() {
        text += "\nMeshes are not packed. They must lie at these paths, seen from where the command is given; another mesh is\n\
                 refused by the digest of its objects and look:\n\n| mesh | digest |\n|:---|:---|\n";
        for (mesh, digest) in meshes {
            writeln!(text, "| `{mesh}` | `{digest}` |").expect("in memory");
        }
    }
    text
}

/// The scenes of a plan that are files, with their contents.
fn meshes(plan: &Plan) -> Vec<(&str, &str)> {
    let scenes = plan.record.iter().flat_map(|record| &record.scenes);
    let is_file = |name: &str| !name.starts_with("simple:") && !name.starts_with("spd:");
    scenes
        .filter(|(name, _)| is_file(name))
        .map(|(name, content)| (name.as_str(), content.as_str()))
        .collect()
}
