//! Archives of finished runs: writing them, checking them, repeating what they hold.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};
use sahlab::REVISION;
use sahlab::archive::{self, RunFolders, TOLERANCE, Verified};
use sahlab::files::Scratch;
use sahlab::scene::Scene;
use sahlab::study::plan::Overrides;
use sahlab::study::store::hold;
use sahlab::study::{self, Plan};

use crate::args::Common;
use crate::output::{note, print};
use crate::run;

/// `validate archive`. With `--out` a file, if it ends in `.tar.gz`, or the folder that gets `archives/NAME.tar.gz`.
pub fn pack(folders: &[PathBuf], common: &Common) -> Result<bool> {
    let file = common.out.as_deref().filter(|out| is_archive_name(out));
    let held = folders.iter().map(|folder| hold(folder));
    let _held: Vec<_> = held.collect::<Result<_, _>>()?;
    let packed = gather(folders, None)?;
    if common.dry_run {
        let lines = packed.files().map(|(path, size)| {
            let name = packed.name();
            format!("{size:>12}  {name}/{path}\n")
        });
        print(&lines.collect::<String>())?;
        return Ok(true);
    }
    let file = file.map_or_else(|| place_below(&packed, common.root()), Path::to_path_buf);
    check_apart(&file, folders)?;
    if !common.force {
        check_replaced(&file, folders)?;
    }
    packed.write(&file)?;
    print(&format!("{}\n", file.display()))?;
    Ok(true)
}

/// An archive is not written among the files that it holds, or it would hold itself the next time.
fn check_apart(file: &Path, folders: &[PathBuf]) -> Result<()> {
    let whole = std::path::absolute(file)?;
    // The folder it goes into may have to be made in one that is there.
    let mut above = whole.ancestors().skip(1);
    let folder = above.find_map(|folder| folder.canonicalize().ok());
    let is_in = |own: PathBuf| Some(folder.as_ref()?.starts_with(own.canonicalize().ok()?));
    for data in folders {
        for own in [data.clone(), run::plots_of(data)?] {
            if is_in(own) == Some(true) {
                bail!(
                    "{}: in the folder of the run itself; --out FILE.tar.gz names another place",
                    file.display()
                );
            }
        }
    }
    Ok(())
}

/// An archive may replace one of the same runs; anything else that lies in its place stays.
fn check_replaced(file: &Path, folders: &[PathBuf]) -> Result<()> {
    if !file.exists() {
        return Ok(());
    }
    let names = folders.iter().map(|folder| run::name_of(folder));
    let names: BTreeSet<_> = names.collect::<Result<_>>()?;
    let what = match archive::verify(file) {
        Ok(there) => {
            let there: BTreeSet<_> = there.experiments.keys().map(OsString::from).collect();
            if there == names {
                return Ok(());
            }
            let there = there.iter().map(|name| name.to_string_lossy());
            format!("an archive of {}", there.collect::<Vec<_>>().join(", "))
        }
        Err(_) => "no archive of runs, or a damaged one".into(),
    };
    bail!(
        "{}: there is {what}; --force replaces it, --out FILE.tar.gz names another file",
        file.display()
    )
}

/// Write `archives/NAME.tar.gz` below a root; gives the file.
pub fn pack_below(folders: &[PathBuf], name: Option<&str>, root: &Path) -> Result<PathBuf> {
    let packed = gather(folders, name)?;
    let file = place_below(&packed, root);
    packed.write(&file)?;
    Ok(file)
}

/// Where an archive lies below a root, if it is given no place of its own.
fn place_below(packed: &archive::Packed, root: &Path) -> PathBuf {
    let name = format!("{}.tar.gz", packed.name());
    root.join("archives").join(name)
}

fn is_archive_name(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.ends_with(".tar.gz")
}

fn gather(folders: &[PathBuf], name: Option<&str>) -> Result<archive::Packed> {
    let runs = folders.iter().map(|data| {
        let name = run::name_of(data)?.to_string_lossy().into_owned();
        // The folder as given may be `.`, which has no `plots` beside it.
        let whole = data
            .canonicalize()
            .with_context(|| format!("{}: cannot read", data.display()))?;
        Ok(RunFolders {
            name,
            data: data.clone(),
            plots: run::plots_of(&whole)?,
        })
    });
    Ok(archive::pack(&runs.collect::<Result<Vec<_>>>()?, name)?)
}

/// `validate verify`. Says whether all is as it should be.
pub fn verify(file: &Path, replay: bool, common: &Common) -> Result<bool> {
    let verified = archive::verify(file)?;
    let (files, bytes) = verified.size();
    let mut text = String::new();
    for fault in &verified.faults {
        text += &format!("{fault}\n");
    }
    let name = &verified.name;
    text += &match verified.faults.len() {
        0 => format!("{name}: {files} files, {bytes} bytes, all as in the manifest\n"),
        n => format!("{name}: {files} files, faults: {n}\n"),
    };
    print(&text)?;
    if !verified.faults.is_empty() {
        return Ok(false);
    }
    if replay {
        return repeat(file, &verified, common);
    }
    Ok(true)
}

/// Run every experiment of an archive again, from its text alone, and compare what comes out.
fn repeat(file: &Path, verified: &Verified, common: &Common) -> Result<bool> {
    let mut loaded = Vec::new();
    for (name, text) in &verified.experiments {
        loaded.push(load(file, name, text, common)?);
    }
    if loaded.is_empty() {
        bail!("{}: no experiment to run in it", file.display());
    }
    if common.dry_run {
        for (plan, scenes) in &loaded {
            print(&study::describe(plan, scenes))?;
        }
        return Ok(true);
    }
    let (root, scratch) = match &common.out {
        Some(folder) => {
            make_empty(folder)?;
            (folder.clone(), None)
        }
        None => {
            let scratch = Scratch::new("replay").map_err(|(folder, error)| {
                anyhow!("{}: cannot write: {error}", folder.display())
            })?;
            (scratch.path().to_path_buf(), Some(scratch))
        }
    };
    let anew = Common {
        out: Some(root.clone()),
        // A summary of what is only repeated would hide what matters: whether it came out the same.
        json: true,
        force: true,
        ..common.clone()
    };
    let compared =
        run_again(&loaded, &anew).and_then(|()| Ok(archive::compare(file, verified, &root)?))?;
    let mut text = compared.to_string();
    let (equal, within) = (compared.equal, compared.within.len());
    let (all, others) = (equal + within, compared.differences.len());
    let same = others == 0;
    if let (false, Some(scratch)) = (same, scratch) {
        // What differs stays, to be looked at.
        scratch.keep();
    }
    text += &match (others, within) {
        (0, 0) => {
            format!(
                "replayed: all {all} files of data, figures and claims equal to the byte; times are only shown\n"
            )
        }
        (0, _) => format!(
            "replayed: all {all} files of data, figures and claims equal, {equal} to the byte, {within} within {TOLERANCE:e} (relative, \
             counts and words exactly); times are only shown\n"
        ),
        _ => format!(
            "replayed: {others} of {} files of data, figures and claims not equal; the repeated runs are in {}\n",
            all + others,
            root.display()
        ),
    };
    print(&text)?;
    Ok(same)
}

fn run_again(runs: &[(Plan, Vec<Scene>)], common: &Common) -> Result<()> {
    for (plan, scenes) in runs {
        let _claim = run::prepare(plan, common)?;
        run::run(plan, scenes, common, |_| String::new())?;
    }
    Ok(())
}

/// An archived run, ready to be repeated.
fn load(file: &Path, name: &str, text: &str, common: &Common) -> Result<(Plan, Vec<Scene>)> {
    let place = format!("{}:experiments/{name}.toml", file.display());
    let mut plan = Plan::parse(text, &place, name, Overrides::default())?;
    let recorded = plan.record.as_ref().and_then(|r| r.revision.clone());
    let Some(revision) = recorded.filter(|_| plan.name == name) else {
        bail!("{place}: not the text that was kept with the run '{name}'");
    };
    if revision != REVISION && !common.quiet {
        note(&format!(
            "{name}: made by revision {revision} of the program, repeated by revision {REVISION}; claims and resolved experiments \
             are not compared"
        ));
    }
    let scenes = run::load_scenes(&mut plan, Some(Path::new(&place)))?;
    Ok((plan, scenes))
}

/// Make a folder, in which nothing may be yet.
fn make_empty(folder: &Path) -> Result<()> {
    let unwritable = || format!("{}: cannot write", folder.display());
    fs::create_dir_all(folder).with_context(unwritable)?;
    let mut entries = fs::read_dir(folder).with_context(unwritable)?;
    if entries.next().is_some() {
        bail!(
            "{}: not empty; name a new folder to repeat the runs in",
            folder.display()
        );
    }
    Ok(())
}
