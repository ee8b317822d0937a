//! What an archive says of itself, made anew after its files were changed: whoever changes one file can change all that tell of it.

use serde_json::{Value, json};

use super::*;

pub const NAME: &str = "e-e-quick/";

pub type Files = BTreeMap<String, Vec<u8>>;

fn digits(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|b| format!("{b:02x}")).collect()
}

/// Give a file other text.
pub fn change(files: &mut Files, path: &str, change: impl Fn(&str) -> String) {
    let bytes = files.get_mut(&format!("{NAME}{path}")).unwrap();
    let old = String::from_utf8(bytes.clone()).unwrap();
    let new = change(&old);
    assert_ne!(old, new, "{path}");
    *bytes = new.into_bytes();
}

fn payload(files: &Files) -> impl Iterator<Item = (&str, &Vec<u8>)> {
    let prefix = format!("{NAME}data/");
    let below = files.iter();
    below.filter_map(move |(path, bytes)| Some((path.strip_prefix(&prefix)?, bytes)))
}

/// Let the list of what is reproduced fit the runs' files.
pub fn list(files: &mut Files) {
    let path = format!("{NAME}data/replay.json");
    let mut reproduced: Value = serde_json::from_slice(&files[&path]).unwrap();
    reproduced["sha256"] = payload(files)
        .filter(|(path, _)| path.starts_with("data/") || path.starts_with("plots/"))
        .filter(|(path, _)| !path.contains("/tim") && !path.ends_with("/report.html"))
        .map(|(path, bytes)| (path.to_string(), Value::from(digits(bytes))))
        .collect::<serde_json::Map<_, _>>()
        .into();
    files.insert(path, serde_json::to_vec_pretty(&reproduced).unwrap());
}

/// Let the metadata fit the files of the payload.
pub fn describe(files: &mut Files) {
    let path = format!("{NAME}data/ro-crate-metadata.json");
    let mut described: Value = serde_json::from_slice(&files[&path]).unwrap();
    let graph = described["@graph"].as_array_mut().unwrap();
    graph.retain(|entity| entity["@type"] != "File");
    for (path, bytes) in payload(files).filter(|(path, _)| *path != "ro-crate-metadata.json") {
        graph.push(json!({
            "@id": path,
            "@type": "File",
            "contentSize": bytes.len().to_string(),
            "sha256": digits(bytes),
        }));
    }
    files.insert(path, serde_json::to_vec(&described).unwrap());
}

/// Let all that tells of the files fit them.
pub fn reseal(files: &mut Files) {
    list(files);
    describe(files);
    seal(files);
}

/// Let the bag fit its files.
pub fn seal(files: &mut Files) {
    let manifest: String = payload(files)
        .map(|(path, bytes)| format!("{}  data/{path}\n", digits(bytes)))
        .collect();
    let sizes: usize = payload(files).map(|(_, bytes)| bytes.len()).sum();
    let info = format!("Payload-Oxum: {sizes}.{}\n", payload(files).count());
    files.insert(format!("{NAME}manifest-sha256.txt"), manifest.into());
    files.insert(format!("{NAME}bag-info.txt"), info.into());
    seal_tags(files);
}

/// Let the second manifest fit the other files that are no payload.
pub fn seal_tags(files: &mut Files) {
    let tags = ["bag-info.txt", "bagit.txt", "manifest-sha256.txt"].map(|path| {
        let bytes = &files[&format!("{NAME}{path}")];
        format!("{}  {path}\n", digits(bytes))
    });
    let text = tags.concat().into_bytes();
    files.insert(format!("{NAME}tagmanifest-sha256.txt"), text);
}

#[test]
fn sound_files_must_not_contradict_each_other() {
    let (_folder, file) = archive();
    let files = unpack(&file);
    let mut same = files.clone();
    reseal(&mut same);
    fs::write(&file, repack(&same)).unwrap();
    verify(&file, &[]).code(0);

    let told = |path: &str, old: &str, new: &str, wanted: &str| {
        let mut changed = files.clone();
        change(&mut changed, path, |text| text.replacen(old, new, 1));
        seal(&mut changed);
        fs::write(&file, repack(&changed)).unwrap();
        verify(&file, &[])
            .code(1)
            .stdout(contains(wanted).and(contains("faults: 1\n")));
    };
    let metadata = "data/ro-crate-metadata.json";
    for (old, new, wanted) in [
        (
            "\"contentSize\": \"",
            "\"contentSize\": \"1",
            "contentSize of data/CITATION.cff is \"1",
        ),
        (
            "\"contentSize\"",
            "\"size\"",
            "contentSize of data/CITATION.cff is \"\"",
        ),
        (
            "yaml\",\n      \"sha256\": \"",
            "yaml\",\n      \"sha256\": \"0",
            "sha256 of data/CITATION.cff is not that of the file",
        ),
        (
            "\"@id\": \"README.md\",\n      \"@type\": \"File\"",
            "\"@id\": \"..%2F..%2Fetc/passwd\",\n      \"@type\": \"File\"",
            "\"..%2F..%2Fetc/passwd\" is no file of the payload",
        ),
        (
            "\"@id\": \"README.md\",\n      \"@type\": \"File\"",
            "\"@id\": \"README.md\",\n      \"@type\": \"Thing\"",
            "data/README.md is not described",
        ),
        ("\"@graph\"", "\"@grab\"", "no array \"@graph\""),
        ("{", "", "data/ro-crate-metadata.json: "),
    ] {
        told(metadata, old, new, wanted);
    }
}

#[test]
fn the_list_of_what_is_reproduced_must_be_that_of_the_data() {
    let (_folder, file) = archive();
    let files = unpack(&file);
    for (old, new, wanted) in [
        (
            "e/bins.csv",
            "e/bin.csv",
            "\"data/e/bin.csv\" is no file of a run",
        ),
        (
            "\"data/e/bins.csv\": \"",
            "\"data/e/bins.csv\": \"0",
            "the digest of \"data/e/bins.csv\" is another",
        ),
        ("{", "{ \"x\": 1,", "unknown field `x`"),
    ] {
        let mut changed = files.clone();
        change(&mut changed, "data/replay.json", |text| {
            text.replacen(old, new, 1)
        });
        describe(&mut changed);
        seal(&mut changed);
        fs::write(&file, repack(&changed)).unwrap();
        verify(&file, &[])
            .code(1)
            .stdout(contains(wanted).and(contains("faults: 1\n")));
    }
    // One left out is told too.
    let mut changed = files;
    changed.insert(format!("{NAME}data/data/e/more.csv"), b"x\n".to_vec());
    describe(&mut changed);
    seal(&mut changed);
    fs::write(&file, repack(&changed)).unwrap();
    verify(&file, &[]).code(1).stdout(contains(
        "data/replay.json: \"data/e/more.csv\" is not in it\n",
    ));
}

#[test]
fn the_bag_must_be_one_that_is_known() {
    let (_folder, file) = archive();
    let files = unpack(&file);
    let told = |path: &str, old: &str, new: &str, code: i32, wanted: &str| {
        let mut changed = files.clone();
        change(&mut changed, path, |text| text.replacen(old, new, 1));
        seal_tags(&mut changed);
        fs::write(&file, repack(&changed)).unwrap();
        let output = verify(&file, &[]).code(code).get_output().clone();
        let text = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
        assert!(text.contains(wanted), "{text}");
    };
    let version = "does not say BagIt-Version: 1.0";
    told("bagit.txt", "1.0", "0.97", 2, version);
    told("bagit.txt", "UTF-8", "UTF-16", 2, version);
    let oxum = "bag-info.txt: Payload-Oxum is \"";
    told("bag-info.txt", "Oxum: ", "Oxum: 1", 1, oxum);
    told("bag-info.txt", "Payload-Oxum", "payload", 1, oxum);
    let path = "the path is not a plain one";
    let manifest = "manifest-sha256.txt";
    for new in ["../", "/", "data/../", "data/%2e", "data\\"] {
        told(manifest, "  data/", &format!("  {new}"), 2, path);
    }
    let other = "belongs in the other manifest";
    told(manifest, "  data/CITATION", "  CITATION", 2, other);
    let unlisted = "its manifests do not list data/ro-crate-metadata.json";
    told(manifest, "ro-crate-m", "ro-crate-n", 2, unlisted);
    for path in ["bagit.txt", "bag-info.txt", "tagmanifest-sha256.txt"] {
        let mut changed = files.clone();
        changed.remove(&format!("{NAME}{path}"));
        fs::write(&file, repack(&changed)).unwrap();
        let output = verify(&file, &[]).get_output().clone();
        let text = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
        assert!(text.contains(path), "{text}");
        assert!(!output.status.success());
    }
}
