//! Files that are either whole or absent.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

/// Write a file under a temporary name in the same folder, sync it, rename it. Makes the folder if it is missing.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder)?;
    let mut temporary = path.as_os_str().to_owned();
    temporary.push(".part");
    let mut file = fs::File::create(&temporary)?;
    file.write_all(bytes)?;
    file.sync_all()?;
    fs::rename(&temporary, path)
}
