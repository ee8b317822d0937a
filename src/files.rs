//! Files that are either whole or absent, whatever happens while they are written.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// What the name of a file ends in that is not whole yet.
pub const PART: &str = ".part";

/// The files that this process is writing, and its folders for temporary files.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Write a file under a temporary name in the same folder, sync it, rename it, and sync the folder. Makes the folder if it is
/// missing.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write_atomic_with(path, |file| file.write_all(bytes))
}

/// As [`write_atomic`], for what is too large to be held at once. Where writing fails, no temporary file stays.
pub fn write_atomic_with(
    path: &Path,
    write: impl FnOnce(&mut fs::File) -> io::Result<()>,
) -> io::Result<()> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    make_folder(folder)?;
    let (temporary, mut file) = begin(folder, path)?;
    let written = write(&mut file)
        .and_then(|()| file.sync_all())
        .and_then(|()| fs::rename(&temporary, path));
    if written.is_err() {
        // The first failure is the one to tell.
        let _ = fs::remove_file(&temporary);
    }
    register(|unfinished| unfinished.remove(&temporary));
    written?;
    sync_folder(folder)
}

/// A file under a name of its own, and listed, that will be this one.
fn begin(folder: &Path, path: &Path) -> io::Result<(PathBuf, fs::File)> {
    static WRITTEN: AtomicU64 = AtomicU64::new(0);
    loop {
        let number = WRITTEN.fetch_add(1, Ordering::Relaxed);
        let mut name = OsString::from(".");
        name.push(path.file_name().unwrap_or_default());
        name.push(format!(".{}-{number}{PART}", std::process::id()));
        let temporary = folder.join(name);
        let made: io::Result<fs::File> = register(|unfinished| {
            let file = fs::File::create_new(&temporary)?;
            unfinished.insert(temporary.clone());
            Ok(file)
        });
        match made {
            Ok(file) => return Ok((temporary, file)),
            // Left by a process of the same number that was killed, or another machine's.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
}

/// A renamed file outlives a failure of the power only if its folder is on disk as well.
fn sync_folder(folder: &Path) -> io::Result<()> {
    // Elsewhere a folder cannot be opened.
    if cfg!(unix) {
        fs::File::open(folder)?.sync_all()?;
    }
    Ok(())
}

/// Make a folder, with those above it, unless it is there.
pub fn make_folder(folder: &Path) -> io::Result<()> {
    register(|_| fs::create_dir_all(folder))
}

/// Change what is listed; from [`exit`] on this waits for the end of the process.
fn register<T>(change: impl FnOnce(&mut BTreeSet<PathBuf>) -> T) -> T {
    let mut unfinished = UNFINISHED.lock().unwrap_or_else(|e| e.into_inner());
    change(&mut unfinished)
}

/// Whether a file's name is that of one that is not whole: what a process that was killed has left.
pub fn is_unfinished(name: &str) -> bool {
    name.starts_with('.') && name.ends_with(PART)
}

/// Remove what a killed process has left unfinished in a folder; nobody else may be writing there. No folder, nothing to do.
pub fn remove_unfinished(folder: &Path) -> io::Result<()> {
    let entries = match fs::read_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        entries => entries?,
    };
    for entry in entries {
        let entry = entry?;
        let is_file = entry.file_type()?.is_file();
        if is_file && is_unfinished(&entry.file_name().to_string_lossy()) {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

/// Times that a folder is removed in which files may still be written.
const TRIES: usize = 3;

/// End this process, leaving no file of it unfinished.
pub fn exit(code: i32) -> ! {
    // Held to the end: nothing new is begun.
    let unfinished = UNFINISHED.lock().unwrap_or_else(|e| e.into_inner());
    for path in &*unfinished {
        // A file may be whole by now, under its own name. One that was listed before may still come into a folder while that is
        // removed.
        let gone = || fs::remove_file(path).or_else(|_| fs::remove_dir_all(path));
        let _ = (0..TRIES).any(|_| gone().is_ok());
    }
    std::process::exit(code)
}

/// A new folder for temporary files. It goes when this does, and at [`exit`].
pub struct Scratch {
    folder: PathBuf,
    stays: bool,
}

impl Scratch {
    /// A folder where the system has temporary files, named after what it is for.
    ///
    /// # Errors
    /// If it cannot be made; names it.
    pub fn new(purpose: &str) -> Result<Self, (PathBuf, io::Error)> {
        let id = std::process::id();
        let mut number = 0;
        loop {
            let folder = std::env::temp_dir().join(format!("sahlab-{purpose}-{id}-{number}"));
            let made: io::Result<()> = register(|unfinished| {
                fs::create_dir(&folder)?;
                unfinished.insert(folder.clone());
                Ok(())
            });
            match made {
                Ok(()) => {
                    return Ok(Self {
                        folder,
                        stays: false,
                    });
                }
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => number += 1,
                Err(error) => return Err((folder, error)),
            }
        }
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.folder
    }

    /// Leave it there.
    pub fn keep(mut self) {
        self.stays = true;
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        register(|unfinished| unfinished.remove(&self.folder));
        if !self.stays {
            // What cannot be removed is the system's to clear.
            let _ = fs::remove_dir_all(&self.folder);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("read");
        let name = |e: io::Result<fs::DirEntry>| e.expect("read").file_name();
        let mut names: Vec<_> = entries
            .map(|e| name(e).to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn whole_or_absent() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("below/a.csv");
        write_atomic(&path, b"old").expect("written");
        let failed = write_atomic_with(&path, |file| {
            file.write_all(b"new")?;
            let names = names(&folder.path().join("below"));
            assert!(names.len() == 2 && is_unfinished(&names[0]), "{names:?}");
            Err(io::Error::other("full"))
        });
        assert_eq!(failed.expect_err("fails").to_string(), "full");
        assert_eq!(fs::read(&path).expect("read"), b"old");
        assert_eq!(names(&folder.path().join("below")), ["a.csv"]);
    }

    #[test]
    fn what_another_process_of_this_number_has_left_is_no_matter() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for number in 0..200 {
            let name = format!(".a.{}-{number}{PART}", std::process::id());
            fs::write(folder.path().join(name), "left").expect("written");
        }
        for text in ["one", "two"] {
            write_atomic(&folder.path().join("a"), text.as_bytes()).expect("written");
        }
        let read = fs::read(folder.path().join("a")).expect("read");
        assert_eq!((&*read, names(folder.path()).len()), (&b"two"[..], 201));
    }

    #[test]
    fn what_was_left_goes() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for name in [".a.csv.7-0.part", "a.csv", "own.part"] {
            fs::write(folder.path().join(name), "x").expect("written");
        }
        fs::create_dir(folder.path().join(".folder.part")).expect("made");
        remove_unfinished(folder.path()).expect("removed");
        let left = [".folder.part", "a.csv", "own.part"];
        assert_eq!(names(folder.path()), left);
        remove_unfinished(&folder.path().join("none")).expect("nothing to do");
    }

    #[test]
    fn a_temporary_folder_goes_unless_it_is_kept() {
        let one = Scratch::new("test").expect("a folder");
        let other = Scratch::new("test").expect("a folder");
        let paths = [one.path().to_path_buf(), other.path().to_path_buf()];
        fs::write(paths[0].join("a"), "x").expect("written");
        drop(one);
        other.keep();
        assert_eq!(paths.each_ref().map(|path| path.is_dir()), [false, true]);
        fs::remove_dir(&paths[1]).expect("removed");
    }

    #[test]
    fn one_file_may_be_written_by_many_at_once() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a");
        std::thread::scope(|scope| {
            for byte in 0..8_u8 {
                let path = &path;
                scope.spawn(move || {
                    for _ in 0..20 {
                        write_atomic(path, &[byte; 5000]).expect("written");
                    }
                });
            }
        });
        let bytes = fs::read(&path).expect("read");
        assert!(bytes.len() == 5000 && bytes.iter().all(|b| *b == bytes[0]));
        assert_eq!(names(folder.path()), ["a"]);
    }
}
