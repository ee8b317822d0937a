//! Runs on many machines: one share of the pieces each, then all put together; and the scripts that do so.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use sahlab::report::screen;
use sahlab::scene::Scene;
use sahlab::study::plan::Overrides;
use sahlab::study::shards::Shards;
use sahlab::study::share::Share;
use sahlab::study::store::{EXPERIMENT, Store};
use sahlab::study::{self, Plan};

use crate::args::{Common, Engine};
use crate::output::print;
use crate::run;

/// The folder of a plan's shards.
fn folder(plan: &Plan, common: &Common) -> PathBuf {
    common.root().join("shards").join(&plan.name)
}

/// `validate run --shard`: measure a share of each plan's pieces.
pub fn run(plans: &[(Plan, Vec<Scene>)], share: Share, common: &Common) -> Result<bool> {
    for (plan, scenes) in plans {
        let folder = folder(plan, common).join(share.folder());
        let store = Store::open(&folder).sharing(Some(share));
        let store = if common.force {
            store.forgetful()
        } else {
            store
        };
        let pieces = study::pieces(plan, scenes).into_iter().enumerate();
        let own = pieces.filter(|(number, _)| share.has(*number));
        let own: Vec<_> = own.map(|(_, piece)| piece).collect();
        let head = format!("{}, share {share}: ", plan.name);
        if common.dry_run {
            let line =
                |piece: &study::pieces::Piece<()>| format!("{}  {}\n", piece.id, piece.place);
            let lines: String = own.iter().map(line).collect();
            print(&format!("{head}\n{lines}{}", run::total(&own)))?;
            continue;
        }
        let _claim = store.prepare()?;
        run::measure(plan, scenes, &store, common)?;
        if !common.json {
            print(&format!(
                "{head}{} pieces in {}\n",
                own.len(),
                folder.display()
            ))?;
        }
    }
    Ok(true)
}

/// `validate merge`. Says whether every expectation of the run held.
pub fn merge(folders: &[PathBuf], common: &Common) -> Result<bool> {
    let shards = Shards::read(folders)?;
    let place = folders[0].join(EXPERIMENT);
    let name = place.display().to_string();
    let mut plan = Plan::parse(&shards.experiment, &name, "", Overrides::default())?;
    let scenes = run::load_scenes(&mut plan, Some(&place))?;
    shards.check(&plan, &scenes)?;
    if common.dry_run {
        print(&format!(
            "would put {} shards together into {}\n",
            folders.len(),
            run::folders(&plan, common)[0].display()
        ))?;
        return Ok(true);
    }
    let _claim = run::prepare(&plan, common)?;
    let [data, _] = run::folders(&plan, common);
    let store = Store::open(&data);
    shards.copy(&store)?;
    run::measure(&plan, &scenes, &store.complete(), common)?;
    let run = run::report(&plan, common, screen::study)?;
    let held = run.held();
    if common.json {
        run::print_json(&[run])?;
    }
    Ok(held)
}

/// `validate plan`: the script that runs all shards of a plan and merges them.
pub fn script(
    plan: &Plan,
    experiment: &Path,
    shards: u16,
    engine: Engine,
    common: &Common,
) -> Result<String> {
    let Plan { name, .. } = plan;
    let out = common.root().display();
    for path in [experiment, common.root()] {
        let plain = |c: char| c.is_alphanumeric() || "-_./".contains(c);
        if !path.to_string_lossy().chars().all(plain) {
            bail!(
                "{}: a script can only name paths of letters, digits, '-', '_', '.' and '/'; rename it or go elsewhere",
                path.display()
            );
        }
    }
    let (folder, data) = match &common.out {
        Some(_) => (format!("{out}/shards/{name}"), format!("{out}/data/{name}")),
        None => (format!("shards/{name}"), format!("data/{name}")),
    };
    let mut options = plan
        .record
        .as_ref()
        .map_or_else(String::new, |record| record.overrides.arguments());
    let mut place = String::new();
    if common.out.is_some() {
        place = format!(" --out {out}");
        options += &place;
    }
    let threads = common.threads.unwrap_or(match engine {
        Engine::Slurm => 2,
        // One a core: as many shards at a time as there are cores.
        Engine::Snakemake => 1,
    });
    let given = common
        .threads
        .map_or_else(String::new, |n| format!(" --threads {n}"));
    let head = format!(
        "# {shards} shards of {}, and the job that puts them together. Made by\n\
         #   validate plan {} --shards {shards} --format {}{options}{given}\n\
         # Run it where the experiment's path leads to the experiment, with `validate` on the PATH or named by VALIDATE.\n",
        experiment.display(),
        experiment.display(),
        match engine {
            Engine::Slurm => "slurm",
            Engine::Snakemake => "snakemake",
        }
    );
    // One that comes with the program may have no file.
    let input = match experiment.exists() {
        true => format!("\n    input:\n        \"{}\",", experiment.display()),
        false => String::new(),
    };
    let text = match engine {
        Engine::Slurm => SLURM,
        Engine::Snakemake => SNAKEMAKE,
    };
    let text = text
        .replace("{INPUT}", &input)
        .replace("{EXPERIMENT}", &experiment.display().to_string())
        .replace("{OPTIONS}", &options)
        .replace("{PLACE}", &place)
        .replace("{FOLDER}", &folder)
        .replace("{DATA}", &data)
        .replace("{NAME}", name)
        .replace("{THREADS}", &threads.to_string())
        .replace("{N}", &shards.to_string());
    Ok(head + &text)
}

/// Exit code 1 of `merge` says that an expectation was missed: the run is finished all the same.
const SLURM: &str = r#"set -eu
validate=${VALIDATE:-validate}
threads=${THREADS:-{THREADS}}
array=$(sbatch --parsable --job-name={NAME} --array=1-{N} --cpus-per-task="$threads" --output={NAME}-%a.log \
  --wrap "$validate run {EXPERIMENT} --shard auto/{N} --threads $threads{OPTIONS}")
echo "shards: job array $array"
sbatch --wait --job-name={NAME}-merge --dependency="afterok:${array%%;*}" --kill-on-invalid-dep=yes --output={NAME}-merge.log \
  --wrap "$validate merge {FOLDER}/*-of-{N}{PLACE} || test \$? -eq 1"
echo "done: {DATA}, and {NAME}-merge.log says whether the expectations held"
"#;

const SNAKEMAKE: &str = r#"import os

VALIDATE = os.environ.get("VALIDATE", "validate")
SHARDS = range(1, {N} + 1)


rule all:
    input:
        "{DATA}/summary.json",


rule shard:{INPUT}
    output:
        "{FOLDER}/{i}-of-{N}/shard.json",
    threads: {THREADS}
    shell:
        "{VALIDATE} run {EXPERIMENT} --shard {wildcards.i}/{N} --threads {threads}{OPTIONS}"


rule merge:
    input:
        expand("{FOLDER}/{i}-of-{N}/shard.json", i=SHARDS),
    output:
        "{DATA}/summary.json",
    # Exit code 1 says that an expectation was missed: the run is finished all the same.
    shell:
        "{VALIDATE} merge {FOLDER}/*-of-{N}{PLACE} || test $? -eq 1"
"#;
