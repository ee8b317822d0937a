//! Going through an archive that may be anything, packed or unpacked: every limit is checked before it can hurt, and nothing is
//! written.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use flate2::bufread::GzDecoder;
use tar::{EntryType, Header};

use super::gzip::{BLOCK, Capped, OTHERWISE, end, gzip_time};
use super::names::{NOT_PLAIN, Names, is_plain};
use super::{ArchiveError, Digesting, Files, LIMITS, Limits, header};
use crate::study::plan::is_folder_name;

/// Bytes of header and padding beside those of a file, at most.
const HEADER: u64 = 1024;

/// Go through the files of an archive in their order, or of its folder. `visit` may read a file's bytes, all or some. What has been
/// read is in `files`, even where the rest cannot be. Gives the folder's name.
pub(super) fn walk(
    path: &Path,
    files: &mut Files,
    visit: impl FnMut(&str, &mut dyn Read) -> io::Result<()>,
) -> Result<String, ArchiveError> {
    walk_within(&LIMITS, path, files, visit)
}

fn walk_within(
    limits: &Limits,
    path: &Path,
    files: &mut Files,
    visit: impl FnMut(&str, &mut dyn Read) -> io::Result<()>,
) -> Result<String, ArchiveError> {
    let unreadable = |source| ArchiveError::Read {
        path: path.into(),
        source,
    };
    let refused = |what| ArchiveError::Refused {
        path: path.into(),
        what,
    };
    let kind = fs::metadata(path).map_err(unreadable)?.file_type();
    let mut taker = Taker {
        limits,
        files,
        names: Names::default(),
        total: 0,
        visit,
    };
    if kind.is_dir() {
        taker.folder(path, "").map_err(refused)?;
        if taker.files.is_empty() {
            return Err(refused("it is empty".into()));
        }
        let whole = path.canonicalize().map_err(unreadable)?;
        return Ok(whole
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into());
    }
    if !kind.is_file() {
        return Err(refused("neither a file nor a folder".into()));
    }
    let file = File::open(path).map_err(unreadable)?;
    taker.stream(BufReader::new(file)).map_err(refused)
}

/// Takes one file after the other. Its errors say what is wrong, and where.
struct Taker<'a, V> {
    limits: &'a Limits,
    files: &'a mut Files,
    names: Names,
    total: u64,
    visit: V,
}

impl<V: FnMut(&str, &mut dyn Read) -> io::Result<()>> Taker<'_, V> {
    /// Take a file of so many bytes, if that is not too much.
    fn take(&mut self, below: &str, size: u64, reader: impl Read) -> Result<(), String> {
        if self.files.contains_key(below) {
            return Err(format!("{below:?} is there twice"));
        }
        self.names.take(below)?;
        self.total = size.saturating_add(self.total);
        let limits = self.limits;
        if limits.are_passed(self.files.len() + 1, size, self.total) {
            return Err(format!(
                "too large at {below:?} ({size} bytes); {limits} are read"
            ));
        }
        let damaged = |error| format!("damaged in {below:?} ({error})");
        let mut reader = Digesting::new(reader.take(size));
        (self.visit)(below, &mut reader).map_err(damaged)?;
        let facts = reader.finish().map_err(damaged)?;
        if facts.size != size {
            return Err(format!("damaged: it ends within {below:?}"));
        }
        self.files.insert(below.to_string(), facts);
        Ok(())
    }

    /// Take all files below a folder, whose path below the first one is `prefix`.
    fn folder(&mut self, folder: &Path, prefix: &str) -> Result<(), String> {
        let unreadable = |error| format!("cannot read {prefix:?} ({error})");
        let entries = fs::read_dir(folder).map_err(unreadable)?;
        let mut entries: Vec<_> = entries.collect::<Result<_, _>>().map_err(unreadable)?;
        entries.sort_by_key(|entry| entry.file_name());
        for entry in entries {
            let name = entry.file_name();
            let name = name
                .to_str()
                .filter(|name| is_plain(name))
                .ok_or_else(|| wrong_path(&format!("{prefix}{}", name.to_string_lossy())))?;
            let below = format!("{prefix}{name}");
            // Of a link itself, not of where it leads.
            let facts = entry
                .metadata()
                .map_err(|error| format!("cannot read {below:?} ({error})"))?;
            if facts.is_dir() {
                self.folder(&entry.path(), &format!("{below}/"))?;
            } else if facts.is_file() {
                let file = File::open(entry.path());
                let file = file.map_err(|error| format!("cannot read {below:?} ({error})"))?;
                self.take(&below, facts.len(), BufReader::new(file))?;
            } else {
                return Err(no_file(&below, "a link or a device"));
            }
        }
        Ok(())
    }

    /// Take all files of a `.tar.gz`; gives the name of its one folder.
    fn stream(&mut self, mut file: impl BufRead) -> Result<String, String> {
        let time = gzip_time(&mut file)?;
        let mut stream = Capped {
            inner: GzDecoder::new(file),
            left: self.limits.all + HEADER * self.limits.files as u64 + 2 * BLOCK as u64,
        };
        let mut folder: Option<String> = None;
        let mut place = "at its beginning".to_string();
        loop {
            let damaged = |error: &dyn std::fmt::Display| format!("damaged {place} ({error})");
            let mut block = [0; BLOCK];
            stream.read_exact(&mut block).map_err(|e| damaged(&e))?;
            if block == [0; BLOCK] {
                break;
            }
            let described = Header::from_byte_slice(&block);
            if described.cksum().ok() != Some(checksum(&block)) {
                return Err(damaged(&"the header there has another checksum"));
            }
            let full = String::from_utf8(described.path_bytes().into_owned())
                .map_err(|_| format!("a path {place} is not UTF-8"))?;
            let kind = described.entry_type();
            if kind != EntryType::Regular {
                return Err(no_file(&full, &format!("{kind:?}")));
            }
            let (top, below) = full.split_once('/').unwrap_or((&full, ""));
            if !is_folder_name(top) || !is_plain(below) {
                return Err(wrong_path(&full));
            }
            let first = folder.get_or_insert_with(|| top.to_string());
            if first != top {
                return Err(format!("two folders, {first:?} and {top:?}"));
            }
            let size = described.entry_size().map_err(|e| damaged(&e))?;
            if described.mtime().ok() != Some(time.into()) {
                return Err(format!(
                    "the gzip header tells another time than that of {full:?}"
                ));
            }
            let wanted = header(top, below, size, time);
            if wanted.is_none_or(|wanted| wanted.as_bytes() != &block) {
                return Err(format!("the header of {full:?} {OTHERWISE}"));
            }
            self.take(below, size, &mut stream)?;
            let filled = (size as usize).wrapping_neg() % BLOCK;
            let padding = &mut block[..filled];
            let damaged = |error: &dyn std::fmt::Display| format!("damaged in {below:?} ({error})");
            stream.read_exact(padding).map_err(|e| damaged(&e))?;
            if padding.iter().any(|&b| b != 0) {
                return Err(damaged(&"something follows it"));
            }
            place = format!("behind {below:?}");
        }
        let name = folder.ok_or("it is empty")?;
        end(stream)?;
        Ok(name)
    }
}

/// The sum of a header's bytes, those of the sum itself taken for spaces.
fn checksum(block: &[u8; BLOCK]) -> u32 {
    let sum = |bytes: &[u8]| bytes.iter().map(|&b| u32::from(b)).sum::<u32>();
    sum(&block[..148]) + 8 * u32::from(b' ') + sum(&block[156..])
}

fn no_file(path: &str, kind: &str) -> String {
    format!("{path:?} is no regular file ({kind}), and nothing else belongs in an archive")
}

fn wrong_path(path: &str) -> String {
    format!(
        "{path:?} is no path of the form FOLDER/FILE without '..', {NOT_PLAIN}, devices, and names that end in a space or dot"
    )
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    /// An archive of so many files of so many zeros, and as many zeros behind its end.
    fn zeros(files: usize, size: usize, behind: usize) -> tempfile::NamedTempFile {
        let gzip = flate2::GzBuilder::new().operating_system(255);
        let gzip = gzip.write(Vec::new(), flate2::Compression::default());
        let mut tar = tar::Builder::new(gzip);
        for i in 0..files {
            let header = header("a", &i.to_string(), size as u64, 0).expect("a short path");
            tar.append(&header, &vec![0; size][..]).expect("in memory");
        }
        let mut gzip = tar.into_inner().expect("in memory");
        gzip.write_all(&vec![0; behind]).expect("in memory");
        let file = tempfile::NamedTempFile::new().expect("a temporary file");
        std::fs::write(file.path(), gzip.finish().expect("in memory")).expect("written");
        file
    }

    const SMALL: Limits = Limits {
        files: 3,
        file: 1000,
        all: 2500,
    };

    #[test]
    fn what_is_small_enough_is_read() {
        for (files, size) in [(3, 800), (2, 1000), (1, 0), (3, 512)] {
            let file = zeros(files, size, 0);
            let mut read = Files::new();
            walk_within(&SMALL, file.path(), &mut read, |_, _| Ok(())).expect("walked");
            let sizes: Vec<_> = read.values().map(|facts| facts.size).collect();
            assert_eq!(sizes, vec![size as u64; files]);
        }
    }

    #[test]
    fn what_unpacks_to_too_much_is_refused() {
        for (files, size, behind, part) in [
            (4, 1, 0, "too large at \"3\""),
            (1, 1001, 0, "too large at \"0\""),
            (3, 1000, 0, "too large at \"2\""),
            (1, 1, 2 << 20, "something follows the last file"),
        ] {
            let file = zeros(files, size, behind);
            let mut bytes = 0;
            let mut read = Files::new();
            let walked = walk_within(&SMALL, file.path(), &mut read, |_, reader| {
                bytes += io::copy(reader, &mut io::sink())?;
                Ok(())
            });
            let error = walked.map(|_| ()).expect_err("refused").to_string();
            assert!(error.contains(part), "{error}");
            assert!(bytes <= SMALL.all);
        }
    }
}
