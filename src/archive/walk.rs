//! Going through an archive that may be anything: every limit is checked before it can hurt, and nothing is written.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use flate2::bufread::GzDecoder;
use tar::EntryType;

use super::{ArchiveError, Digesting, Files, LIMITS, Limits, is_plain};
use crate::study::plan::is_folder_name;

/// What an archive holds.
pub(super) struct Contents {
    /// Name of its one folder.
    pub name: String,
    /// Its files.
    pub files: Files,
}

/// Bytes of header and padding beside those of a file, at most.
const HEADER: u64 = 1024;
/// Bytes of zeros at the end, at most: some tools fill up to a block of their own size.
const END: u64 = 1 << 20;

/// Go through the files of an archive in their order. `visit` may read a file's bytes, all or some.
pub(super) fn walk(
    path: &Path,
    visit: impl FnMut(&str, &mut dyn Read) -> io::Result<()>,
) -> Result<Contents, ArchiveError> {
    walk_within(&LIMITS, path, visit)
}

fn walk_within(
    limits: &Limits,
    path: &Path,
    mut visit: impl FnMut(&str, &mut dyn Read) -> io::Result<()>,
) -> Result<Contents, ArchiveError> {
    let refused = |what: String| ArchiveError::Refused {
        path: path.into(),
        what,
    };
    let damaged = |error: io::Error| refused(format!("damaged or not a .tar.gz ({error})"));
    let file = File::open(path).map_err(|source| ArchiveError::Read {
        path: path.into(),
        source,
    })?;
    let mut stream = Capped {
        inner: GzDecoder::new(BufReader::new(file)),
        left: limits.all + HEADER * limits.files as u64 + END,
    };
    let mut folder = None;
    let mut files = BTreeMap::new();
    let mut total: u64 = 0;
    let mut archive = tar::Archive::new(&mut stream);
    // Raw: extensions of the format could name another file than the header does.
    for entry in archive.entries().map_err(damaged)?.raw(true) {
        let entry = entry.map_err(damaged)?;
        let full = String::from_utf8(entry.path_bytes().into_owned())
            .map_err(|_| refused("a path is not UTF-8".into()))?;
        let kind = entry.header().entry_type();
        if kind != EntryType::Regular {
            return Err(refused(format!(
                "{full:?} is no regular file ({kind:?}), and nothing else belongs in one"
            )));
        }
        let (top, below) = full.split_once('/').unwrap_or((&full, ""));
        if !is_folder_name(top) || !is_plain(below) {
            return Err(refused(format!(
                "{full:?} is no path of the form FOLDER/FILE without '..', '\\' and ':'"
            )));
        }
        let first = folder.get_or_insert_with(|| top.to_string());
        if first != top {
            return Err(refused(format!("two folders, {first:?} and {top:?}")));
        }
        let size = entry.size();
        total = size.saturating_add(total);
        if limits.are_passed(files.len() + 1, size, total) {
            return Err(refused(format!(
                "too large at {full:?} ({size} bytes); {limits} are read"
            )));
        }
        let mut entry = Digesting::new(entry);
        visit(below, &mut entry).map_err(damaged)?;
        let facts = entry.finish().map_err(damaged)?;
        if facts.size != size {
            return Err(refused(format!("ends within {full:?}")));
        }
        if files.insert(below.to_string(), facts).is_some() {
            return Err(refused(format!("{full:?} is there twice")));
        }
    }
    // The end: zeros, the checksum of the gzip stream, nothing.
    let mut buffer = [0; 8192];
    loop {
        let n = stream.read(&mut buffer).map_err(damaged)?;
        if n == 0 {
            break;
        }
        if buffer[..n].iter().any(|&b| b != 0) {
            return Err(refused("something follows the last file".into()));
        }
    }
    let mut rest = stream.inner.into_inner();
    if !rest.fill_buf().map_err(damaged)?.is_empty() {
        return Err(refused("something follows the compressed files".into()));
    }
    let name = folder.ok_or_else(|| refused("it is empty".into()))?;
    Ok(Contents { name, files })
}

/// A reader that fails beyond a number of bytes: a small file may unpack to a huge one.
struct Capped<R> {
    inner: R,
    left: u64,
}

impl<R: Read> Read for Capped<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let n = self.inner.read(buffer)?;
        self.left = self
            .left
            .checked_sub(n as u64)
            .ok_or_else(|| io::Error::other("it unpacks to more than is read of any archive"))?;
        Ok(n)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    /// An archive of so many files of so many zeros, and as many zeros behind its end.
    fn zeros(files: usize, size: usize, behind: usize) -> tempfile::NamedTempFile {
        let gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        let mut tar = tar::Builder::new(gzip);
        for i in 0..files {
            let mut header = tar::Header::new_ustar();
            header.set_size(size as u64);
            let path = format!("a/{i}");
            tar.append_data(&mut header, path, &vec![0; size][..])
                .expect("in memory");
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
        for (files, size, behind) in [(3, 800, 0), (2, 1000, 10_000), (1, 0, 0), (3, 0, 1 << 20)] {
            let file = zeros(files, size, behind);
            let walked = walk_within(&SMALL, file.path(), |_, _| Ok(())).expect("walked");
            let sizes: Vec<_> = walked.files.values().map(|facts| facts.size).collect();
            assert_eq!(sizes, vec![size as u64; files]);
        }
    }

    #[test]
    fn what_unpacks_to_too_much_is_refused() {
        for (files, size, behind, part) in [
            (4, 1, 0, "too large at \"a/3\""),
            (1, 1001, 0, "too large at \"a/0\""),
            (3, 1000, 0, "too large at \"a/2\""),
            (1, 1, 2 << 20, "unpacks to more"),
        ] {
            let file = zeros(files, size, behind);
            let mut bytes = 0;
            let walked = walk_within(&SMALL, file.path(), |_, reader| {
                bytes += io::copy(reader, &mut io::sink())?;
                Ok(())
            });
            let error = walked.map(|_| ()).expect_err("refused").to_string();
            assert!(error.contains(part), "{error}");
            assert!(bytes <= SMALL.all);
        }
    }
}
