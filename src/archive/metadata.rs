//! What machines read about an archive: RO-Crate 1.1 with Process Run Crate 0.5, and what of it can be checked.

use std::collections::BTreeSet;

use serde_json::{Value, json};

use super::date::{Moment, day};
use super::gather::Run;
use super::identifier::{identifier, path_of};
use super::manifest::{digest, digits};
use super::{Facts, Files, METADATA, PAYLOAD};

/// The vocabulary; it has no word of its own for a digest.
const CONTEXT: &str = "https://w3id.org/ro/crate/1.1/context";
const SHA256: &str = "https://w3id.org/ro/terms/workflow-run#sha256";
const CRATE: &str = "https://w3id.org/ro/crate/1.1";
const PROCESS: &str = "https://w3id.org/ro/wfrun/process/0.5";
/// The program and its authors have no page of their own to be named by.
const PROGRAM: &str = "urn:sahlab:program";
const AUTHORS: &str = "urn:sahlab:authors";

/// The licences of Cargo.toml.
const LICENCES: [(&str, &str, &str); 2] = [
    (
        "https://spdx.org/licenses/MIT",
        "MIT License",
        "LICENSE-MIT",
    ),
    (
        "https://spdx.org/licenses/Apache-2.0",
        "Apache License 2.0",
        "LICENSE-APACHE",
    ),
];

/// The works that the runs examine.
const CITED: [(&str, &str, &str, &str); 2] = [
    (
        "https://doi.org/10.1007/BF01911006",
        "Heuristics for ray tracing using space subdivision",
        "J. D. MacDonald, K. S. Booth: Heuristics for ray tracing using space subdivision, The Visual Computer 6, 1990",
        "1990",
    ),
    (
        "urn:sahlab:havran-2000",
        "Heuristic Ray Shooting Algorithms",
        "V. Havran: Heuristic Ray Shooting Algorithms, thesis, Czech Technical University in Prague, 2000",
        "2000",
    ),
];

fn to(id: &str) -> Value {
    json!({ "@id": id })
}

/// One reference as itself, several as an array.
fn all(ids: impl IntoIterator<Item = String>) -> Value {
    let mut ids: Vec<_> = ids.into_iter().map(|id| to(&id)).collect();
    match ids.len() {
        1 => ids.remove(0),
        _ => Value::Array(ids),
    }
}

/// The bytes of `ro-crate-metadata.json` about the other files of the payload.
pub(super) fn json(name: &str, runs: &[Run], files: &Files, time: Moment) -> Vec<u8> {
    let files: Vec<_> = files
        .iter()
        .filter_map(|(path, facts)| Some((path.strip_prefix(PAYLOAD)?, facts)))
        .collect();
    let mut graph = vec![
        json!({
            "@id": "ro-crate-metadata.json",
            "@type": "CreativeWork",
            "about": to("./"),
            "conformsTo": to(CRATE),
        }),
        root(name, runs, &files, time),
    ];
    graph.extend(surroundings());
    for run in runs {
        graph.extend(action(run));
        graph.extend(folders(run, &files));
    }
    graph.extend(files.into_iter().map(|(path, facts)| file(path, facts)));
    let document = json!({
        "@context": [CONTEXT, { "sha256": SHA256 }],
        "@graph": graph,
    });
    let mut json = serde_json::to_vec_pretty(&document).expect("plain data");
    json.push(b'\n');
    json
}

/// The folders of a run's files in the archive.
fn folders_of(run: &str) -> [String; 2] {
    ["data", "plots"].map(|part| format!("{part}/{run}/"))
}

/// The archive as a whole.
fn root(name: &str, runs: &[Run], files: &[(&str, &Facts)], time: Moment) -> Value {
    let folders: Vec<_> = runs.iter().flat_map(|r| folders_of(r.name())).collect();
    let apart = files.iter().map(|(path, _)| path.to_string());
    let apart = apart.filter(|path| !folders.iter().any(|folder| path.starts_with(folder)));
    let parts = apart.chain(folders.iter().cloned());
    json!({
        "@id": "./",
        "@type": "Dataset",
        "name": format!("{name}: runs of sahlab"),
        "description": "Runs of a program that compares what the surface area heuristic predicts for ray tracing through kd-trees \
                        with what is counted: data, figures, and all that is needed to check and to repeat them. The date is \
                        1970-01-01 where none was told.",
        "datePublished": day(time.unwrap_or(0)),
        "license": all(LICENCES.map(|licence| licence.0.into())),
        "author": to(AUTHORS),
        "publisher": to(AUTHORS),
        "citation": all(CITED.map(|work| work.0.into())),
        "conformsTo": to(PROCESS),
        "mentions": all(runs.iter().map(|run| action_id(run.name()))),
        "hasPart": all(parts.map(|path| identifier(&path))),
    })
}

/// What is referred to and no file.
fn surroundings() -> Vec<Value> {
    let mut entities = vec![
        json!({
            "@id": PROCESS,
            "@type": "CreativeWork",
            "name": "Process Run Crate",
            "version": "0.5",
        }),
        json!({
            "@id": AUTHORS,
            "@type": "Organization",
            "name": "The sahlab authors",
            "url": to("CITATION.cff"),
        }),
        json!({
            "@id": PROGRAM,
            "@type": "SoftwareApplication",
            "name": "sahlab",
            "description": "Compares what the surface area heuristic predicts for ray tracing through kd-trees with what is counted.",
            "version": env!("CARGO_PKG_VERSION"),
            "identifier": crate::REVISION,
            "softwareRequirements": env!("SAHLAB_RUSTC"),
            "author": to(AUTHORS),
        }),
    ];
    entities.extend(LICENCES.map(|(id, name, text)| {
        json!({
            "@id": id,
            "@type": "CreativeWork",
            "name": name,
            "description": format!("{name}; its text is {text}"),
        })
    }));
    entities.extend(CITED.map(|(id, title, whole, year)| {
        json!({
            "@id": id,
            "@type": "ScholarlyArticle",
            "name": title,
            "description": whole,
            "datePublished": year,
        })
    }));
    entities
}

fn action_id(run: &str) -> String {
    format!("#run-{}", identifier(run))
}

/// What was done, and with which seed. When is not known: runs go piece by piece, and no clock is read.
fn action(run: &Run) -> [Value; 2] {
    let name = run.name();
    let seed = format!("#seed-{}", identifier(name));
    let experiment = identifier(&format!("experiments/{name}.toml"));
    [
        json!({
            "@id": action_id(name),
            "@type": "CreateAction",
            "name": run.plan.command,
            "description": run.plan.question,
            "instrument": to(PROGRAM),
            "object": all([experiment, "Cargo.lock".into(), seed.clone()]),
            "result": all(folders_of(name).map(|folder| identifier(&folder))),
            "actionStatus": "http://schema.org/CompletedActionStatus",
        }),
        json!({
            "@id": seed,
            "@type": "PropertyValue",
            "name": "seed",
            "value": run.plan.seed.to_string(),
        }),
    ]
}

/// The folders of a run.
fn folders(run: &Run, files: &[(&str, &Facts)]) -> [Value; 2] {
    let name = run.name();
    let [data, plots] = folders_of(name);
    let told = [
        (
            data,
            "data",
            "What the run found; README.md there explains every file and column.",
        ),
        (
            plots,
            "figures",
            "The figures of the run, drawn from its data alone.",
        ),
    ];
    told.map(|(folder, what, description)| {
        let parts = files.iter().filter(|(path, _)| path.starts_with(&folder));
        json!({
            "@id": identifier(&folder),
            "@type": "Dataset",
            "name": format!("{what} of {name}"),
            "description": description,
            "hasPart": all(parts.map(|(path, _)| identifier(path))),
        })
    })
}

fn file(path: &str, facts: &Facts) -> Value {
    json!({
        "@id": identifier(path),
        "@type": "File",
        "name": path,
        "contentSize": facts.size.to_string(),
        "encodingFormat": encoding(path),
        "sha256": digits(&facts.sha256),
    })
}

/// The media type of a file, by the end of its name.
fn encoding(path: &str) -> &'static str {
    match path.rsplit_once('.').map_or("", |(_, end)| end) {
        "csv" => "text/csv",
        "json" => "application/json",
        "md" => "text/markdown",
        "toml" | "lock" => "application/toml",
        "cff" => "application/yaml",
        "tex" => "text/x-tex",
        "html" => "text/html",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "pdf" => "application/pdf",
        "" | "txt" | "dat" => "text/plain",
        _ if !path.contains('.') => "text/plain",
        _ => "application/octet-stream",
    }
}

/// What is wrong with a `ro-crate-metadata.json` beside these files of a bag: every file of the payload is described once, with
/// its size and digest, and no other.
pub(super) fn check(json: &[u8], files: &Files) -> Result<(), String> {
    let document: Value = serde_json::from_slice(json).map_err(|error| error.to_string())?;
    let graph = document["@graph"]
        .as_array()
        .ok_or("it has no array \"@graph\"")?;
    let mut seen = BTreeSet::new();
    for entity in graph.iter().filter(|entity| entity["@type"] == "File") {
        let id = entity["@id"].as_str().unwrap_or_default();
        let path = path_of(id).map(|path| format!("{PAYLOAD}{path}"));
        let (path, facts) = path
            .as_ref()
            .and_then(|path| files.get_key_value(path))
            .ok_or_else(|| format!("{id:?} is no file of the payload"))?;
        let size = entity["contentSize"].as_str().unwrap_or_default();
        if size.parse() != Ok(facts.size) {
            return Err(format!(
                "contentSize of {path} is {size:?}, the file has {} bytes",
                facts.size
            ));
        }
        if entity["sha256"].as_str().and_then(digest) != Some(facts.sha256) {
            return Err(format!("sha256 of {path} is not that of the file"));
        }
        if !seen.insert(path) {
            return Err(format!("{path} is described twice"));
        }
    }
    let described = |path: &&String| *path == METADATA || seen.contains(path);
    let payload = || files.keys().filter(|path| path.starts_with(PAYLOAD));
    match payload().find(|path| !described(path)) {
        Some(path) => Err(format!("{path} is not described")),
        None => Ok(()),
    }
}
