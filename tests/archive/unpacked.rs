//! The folder that an archive unpacks to is checked likewise.

use super::*;

/// An archive and its folder, unpacked.
fn unpacked() -> (TempDir, PathBuf) {
    let (folder, file) = archive();
    for (path, bytes) in unpack(&file) {
        let path = folder.path().join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    let root = folder.path().join("e-e-quick");
    (folder, root)
}

#[test]
fn an_unpacked_folder_is_verified() {
    let (folder, root) = unpacked();
    let said = |file: &Path| verify(file, &[]).code(0).get_output().stdout.clone();
    assert_eq!(said(&root), said(&folder.path().join("a.tar.gz")));
    // From within, and under another name.
    validate(&root).args(["verify", "."]).assert().code(0);
    let before = files_below(&root);
    verify(&root, &["--replay", "--quiet"])
        .code(0)
        .stdout(contains(
            "files of data, figures and claims equal to the byte",
        ));
    assert_eq!(files_below(&root), before);

    let bins = root.join("data/data/e/bins.csv");
    let mut bytes = fs::read(&bins).unwrap();
    bytes[5] ^= 1;
    fs::write(&bins, bytes).unwrap();
    fs::write(root.join("data/extra.txt"), "x").unwrap();
    fs::remove_file(root.join("data/CLAIMS.md")).unwrap();
    verify(&root, &[]).code(1).stdout(predicate::str::starts_with(
        "data/CLAIMS.md: missing\ndata/data/e/bins.csv: differs from the manifest\ndata/extra.txt: not in the manifest\n",
    ));
}

#[test]
fn a_hostile_folder_is_refused() {
    let (folder, root) = unpacked();
    let refused = |part: &str| {
        verify(&root, &[])
            .code(2)
            .stdout("")
            .stderr(contains(part).and(predicate::function(|s: &str| s.lines().count() == 1)));
    };
    let odd = root.join("data/a:b");
    fs::write(&odd, "").unwrap();
    refused("\"data/a:b\" is no path of the form");
    fs::remove_file(odd).unwrap();
    #[cfg(unix)]
    {
        use std::os::unix::fs::symlink;
        let link = root.join("data/link");
        for target in ["/etc/passwd", "README.md", "..", "nowhere"] {
            symlink(target, &link).unwrap();
            refused("\"data/link\" is no regular file (a link or a device)");
            fs::remove_file(&link).unwrap();
        }
        let pipe = Process::new("mkfifo").arg(&link).status();
        if pipe.is_ok_and(|status| status.success()) {
            refused("\"data/link\" is no regular file");
            fs::remove_file(&link).unwrap();
        }
        verify(Path::new("/dev/null"), &[])
            .code(2)
            .stderr(contains("neither a file nor a folder"));
    }
    fs::remove_file(root.join("tagmanifest-sha256.txt")).unwrap();
    refused("it has no tagmanifest-sha256.txt");
    let empty = folder.path().join("empty");
    fs::create_dir(&empty).unwrap();
    verify(&empty, &[]).code(2).stderr(contains("it is empty"));
}
