//! Files that are either whole or absent.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

/// Write a file under a temporary name in the same folder, sync it, rename it. Makes the folder if it is missing.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write_atomic_with(path, |file| file.write_all(bytes))
}

/// As [`write_atomic`], for what is too large to be held at once. Where writing fails, no temporary file stays.
pub fn write_atomic_with(
    path: &Path,
    write: impl FnOnce(&mut fs::File) -> io::Result<()>,
) -> io::Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder)?;
    let mut temporary = path.as_os_str().to_owned();
    temporary.push(".part");
    let mut file = fs::File::create(&temporary)?;
    let written = write(&mut file);
    if written.is_err() {
        // The first failure is the one to tell.
        let _ = fs::remove_file(&temporary);
    }
    written?;
    file.sync_all()?;
    fs::rename(&temporary, path)
}
