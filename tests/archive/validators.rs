//! What the validators of the formats say of a real archive. They are no part of this project: `tests/archive/validators.sh` fetches
//! them, and without them nothing is checked here.

use super::*;

/// The folder of the validators, if it was made.
fn validators() -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = root.join(".validators");
    if folder.join("ready").is_file() {
        return Some(folder);
    }
    eprintln!(
        "skipped: no .validators/; tests/archive/validators.sh makes it, in a minute and with a network"
    );
    None
}

/// Run a program, which must end well.
fn passes(program: &Path, arguments: &[&str], folder: &Path) -> String {
    let output = Process::new(program)
        .args(arguments)
        .current_dir(folder)
        .env("COLUMNS", "120")
        .output();
    let output = output.unwrap();
    let text = String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned();
    let status = output.status;
    assert!(
        status.success(),
        "{} {arguments:?}: {status}\n{text}",
        program.display()
    );
    text
}

/// An unpacked archive of two runs.
fn unpacked() -> TempDir {
    let (folder, file) = archive();
    for (path, bytes) in unpack(&file) {
        let path = folder.path().join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    folder
}

#[test]
fn the_bag_is_valid() {
    let Some(validators) = validators() else {
        return;
    };
    let folder = unpacked();
    let bagit = validators.join("bin/bagit.py");
    let said = passes(&bagit, &["--validate", "e-e-quick"], folder.path());
    assert!(said.contains("e-e-quick is valid"), "{said}");
    let bdbag = validators.join("bin/bdbag");
    let said = passes(&bdbag, &["--validate", "full", "e-e-quick"], folder.path());
    assert!(said.contains("e-e-quick is valid"), "{said}");
    // And not because they say so of everything.
    let changed = folder.path().join("e-e-quick/data/data/e/bins.csv");
    fs::write(changed, "x").unwrap();
    let output = Process::new(bagit)
        .args(["--validate", "e-e-quick"])
        .current_dir(folder.path())
        .output();
    assert!(!output.unwrap().status.success());
}

#[test]
fn the_crate_is_valid() {
    let Some(validators) = validators() else {
        return;
    };
    let folder = unpacked();
    let cache = validators.join("cache");
    let validator = validators.join("bin/rocrate-validator");
    let options = |profile, level| {
        let cache = cache.to_str().unwrap().to_string();
        let fixed = ["--no-interactive", "-y", "validate", "--no-paging", "-v"];
        let mut all: Vec<_> = fixed.map(str::to_string).into();
        all.extend(["-p", profile, "-l", level].map(str::to_string));
        all.extend(["--offline".into(), "--cache-path".into(), cache]);
        all.push("e-e-quick/data".into());
        all
    };
    for (profile, level) in [
        ("ro-crate-1.1", "recommended"),
        ("process-run-crate-0.5", "required"),
    ] {
        let options = options(profile, level);
        let options: Vec<_> = options.iter().map(String::as_str).collect();
        let said = passes(&validator, &options, folder.path());
        let wanted = format!("[OK] RO-Crate is a valid {profile}");
        assert!(said.contains(&wanted), "{said}");
    }
    let python = validators.join("bin/python");
    let script = "from rocrate.rocrate import ROCrate\n\
                  crate = ROCrate('e-e-quick/data')\n\
                  actions = [e for e in crate.get_entities() if e.type == 'CreateAction']\n\
                  print(crate.root_dataset['name'], len(actions))";
    let said = passes(&python, &["-c", script], folder.path());
    assert!(said.contains("e-e-quick: runs of sahlab 2"), "{said}");
    // A file that is not there is missed.
    fs::remove_file(folder.path().join("e-e-quick/data/data/e/bins.csv")).unwrap();
    let output = Process::new(validator)
        .args(options("ro-crate-1.1", "required"))
        .current_dir(folder.path())
        .output();
    assert!(!output.unwrap().status.success());
}

#[test]
fn the_citation_is_valid() {
    let Some(validators) = validators() else {
        return;
    };
    let cff = validators.join("cff/bin/cffconvert");
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let said = passes(&cff, &["--validate", "-i", "CITATION.cff"], root);
    assert!(said.contains("are valid"), "{said}");
}
