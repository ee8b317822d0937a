//! Writing an archive: the same runs give the same bytes, whoever packs them and when.

use std::io::{self, BufWriter, Read, Write};
use std::path::Path;

use flate2::{Compression, GzBuilder};

use super::date::{self, Moment};
use super::gather::{Run, RunFolders, Source, Sources, files_of, unfit};
use super::names::Names;
use super::{
    ArchiveError, BAG_INFO, BAGIT, Digesting, Facts, Files, LIMITS, MANIFEST, METADATA, PAYLOAD,
    REPLAY, TAG_MANIFEST, bag, claims, environment, header, manifest, metadata, readme, reproduced,
};
use crate::files::write_atomic_with;

/// What goes into every archive as it is.
const CONSTANT: [(&str, &str); 4] = [
    ("CITATION.cff", include_str!("../../CITATION.cff")),
    // The dependencies this program was built with.
    ("Cargo.lock", include_str!("../../Cargo.lock")),
    ("LICENSE-APACHE", include_str!("../../LICENSE-APACHE")),
    ("LICENSE-MIT", include_str!("../../LICENSE-MIT")),
];

/// A file of an archive.
struct Entry {
    path: String,
    source: Source,
    facts: Facts,
}

/// What will be in an archive.
pub struct Packed {
    name: String,
    time: Moment,
    /// In the order in which they are written: what checks the others comes first.
    entries: Vec<Entry>,
}

/// Gather finished runs. The archive is named after them, if it is given no name of its own.
///
/// # Errors
/// If a run is not finished, lacks its experiment's text or its figures, was made by another program (whose dependencies
/// would be packed wrongly), or has files that do not belong in an archive; if `SOURCE_DATE_EPOCH` makes no sense.
pub fn pack(runs: &[RunFolders], name: Option<&str>) -> Result<Packed, ArchiveError> {
    let time = date::told()?;
    let mut folders: Vec<_> = runs.iter().collect();
    folders.sort_by(|a, b| a.name.cmp(&b.name));
    for pair in folders.windows(2) {
        if pair[0].name == pair[1].name {
            return Err(unfit(&pair[1].data, "this run is to be packed twice"));
        }
    }
    let runs = folders.iter().map(|folders| Run::read(folders));
    let runs: Vec<_> = runs.collect::<Result<_, _>>()?;
    let names: Vec<_> = runs.iter().map(Run::name).collect();
    let name = name.map_or_else(|| names.join("-"), str::to_owned);

    let mut sources = Sources::new();
    for run in folders {
        files_of(run, &mut sources)?;
    }
    let mut add = |path: String, text: Vec<u8>| sources.insert(path, Source::Memory(text));
    for (path, text) in CONSTANT {
        add(path.into(), text.into());
    }
    for run in &runs {
        let path = format!("experiments/{}.toml", run.name());
        add(path, run.text.clone().into());
    }
    for (path, text) in claims::texts(&runs) {
        add(path, text.into());
    }
    add("README.md".into(), readme::text(&name, &runs).into());
    add("environment.json".into(), environment::json(&runs));

    let mut gathered = Gathered {
        name: &name,
        files: Files::new(),
        names: Names::default(),
        total: 0,
    };
    let mut entries = Vec::new();
    for (path, source) in sources {
        entries.push(gathered.entry(format!("{PAYLOAD}{path}"), source)?);
    }
    // Each of these tells of all that come before it.
    let list = reproduced::json(&gathered.files);
    entries.push(gathered.entry(REPLAY.into(), Source::Memory(list))?);
    let metadata = metadata::json(&name, &runs, &gathered.files, time);
    entries.push(gathered.entry(METADATA.into(), Source::Memory(metadata))?);
    entries.sort_by(|a, b| a.path.cmp(&b.path));
    let payload = manifest::write(&gathered.files);
    let info = bag::info(&name, &gathered.files, time);
    gathered.files.clear();
    let mut tags = Vec::new();
    for (path, text) in [
        (BAGIT, bag::DECLARATION.into()),
        (BAG_INFO, info),
        (MANIFEST, payload),
    ] {
        tags.push(gathered.entry(path.into(), Source::Memory(text.into()))?);
    }
    let listed = manifest::write(&gathered.files);
    tags.push(gathered.entry(TAG_MANIFEST.into(), Source::Memory(listed.into()))?);
    tags.extend(entries);
    Ok(Packed {
        name,
        time,
        entries: tags,
    })
}

/// What is in an archive so far.
struct Gathered<'a> {
    name: &'a str,
    files: Files,
    names: Names,
    total: u64,
}

impl Gathered<'_> {
    /// One more file, if an archive can hold it.
    fn entry(&mut self, path: String, source: Source) -> Result<Entry, ArchiveError> {
        let beside = self.names.take(&path);
        beside.map_err(|what| unfit(&source.place(&path), &what))?;
        let facts = source.facts(&path)?;
        self.total += facts.size;
        // Some that tell of the others follow.
        if LIMITS.are_passed(self.files.len() + 8, facts.size, self.total) {
            let what = format!("too much for an archive, which holds {LIMITS}");
            return Err(unfit(&source.place(&path), &what));
        }
        if header(self.name, &path, facts.size, 0).is_none() {
            let what = "its path is too long for an archive, which has room for 100 bytes behind a '/' and 155 before it";
            return Err(unfit(&source.place(&path), what));
        }
        self.files.insert(path.clone(), facts);
        Ok(Entry {
            path,
            source,
            facts,
        })
    }
}

impl Packed {
    /// Name of the archive and of the folder in it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Path and size of each file.
    pub fn files(&self) -> impl Iterator<Item = (&str, u64)> {
        let entries = self.entries.iter();
        entries.map(|entry| (entry.path.as_str(), entry.facts.size))
    }

    /// Write the archive.
    ///
    /// # Errors
    /// If it cannot be written, or if a file is no longer what it was when it was gathered.
    pub fn write(&self, to: &Path) -> Result<(), ArchiveError> {
        let mtime = self.time.unwrap_or(0);
        let written = write_atomic_with(to, |file| {
            let gzip = GzBuilder::new()
                .mtime(mtime)
                .operating_system(UNKNOWN_SYSTEM)
                .write(BufWriter::new(file), Compression::default());
            let mut tar = tar::Builder::new(gzip);
            for Entry {
                path,
                source,
                facts,
            } in &self.entries
            {
                let reader = source.open().map_err(io::Error::other)?;
                let mut reader = Digesting::new(reader.take(facts.size));
                let header = header(&self.name, path, facts.size, mtime);
                tar.append(&header.expect("seen to fit"), &mut reader)?;
                if reader.finish()? != *facts {
                    let wrong = unfit(&source.place(path), "changed while it was packed");
                    return Err(io::Error::other(wrong));
                }
            }
            tar.into_inner()?.finish()?.flush()
        });
        written.map_err(|error| match error.downcast::<ArchiveError>() {
            Ok(own) => own,
            Err(source) => ArchiveError::Write {
                path: to.into(),
                source,
            },
        })
    }
}

/// What a gzip header says of the system it was made on.
const UNKNOWN_SYSTEM: u8 = 255;
