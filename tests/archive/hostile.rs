//! Damaged and hostile archives: refused with one message, nothing written.

use super::*;

#[test]
fn a_changed_byte_in_the_compressed_stream_is_found() {
    let (_folder, file) = archive();
    let bytes = fs::read(&file).unwrap();
    let n = bytes.len();
    // Bytes 4 to 9 of the header are a time and names of systems: nothing that the files depend on.
    let mut places: Vec<_> = [0, 1, 2, 3, 10, 11].into();
    places.extend((1..40).map(|i| 11 + i * (n - 19) / 40));
    places.extend(n - 8..n);
    for at in places {
        let mut changed = bytes.clone();
        changed[at] ^= 0xff;
        fs::write(&file, changed).unwrap();
        let output = verify(&file, &[]).get_output().clone();
        assert!(
            matches!(output.status.code(), Some(1 | 2)),
            "byte {at}: {output:?}"
        );
    }
    for length in [0, 1, 9, 10, 1000, n / 2, n - 8, n - 1] {
        fs::write(&file, &bytes[..length]).unwrap();
        refused(&file, "damaged or not a .tar.gz");
    }
    for garbage in [&b"\0"[..], b"x", &bytes] {
        fs::write(&file, [&bytes, garbage].concat()).unwrap();
        refused(&file, "something follows the compressed files");
    }
}

/// Refused with one message, by replay too, and nothing written.
fn refused(file: &Path, part: &str) {
    let folder = file.parent().unwrap();
    let before = files_below(folder);
    let temporary = folder.join("tmp");
    fs::create_dir_all(&temporary).unwrap();
    for more in [&[][..], &["--replay"]] {
        let output = validate(folder)
            .arg("verify")
            .arg(file)
            .args(more)
            .env("TMPDIR", &temporary)
            .output()
            .unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(output.stdout.is_empty());
        assert!(message.contains(part), "'{part}' is not in: {message}");
        assert_eq!(message.lines().count(), 1, "{message}");
        assert!(fs::read_dir(&temporary).unwrap().next().is_none());
        assert_eq!(files_below(folder), before);
    }
}

#[test]
fn hostile_archives_are_refused() {
    let folder = tempdir().unwrap();
    let file = folder.path().join("h.tar.gz");
    let regular = EntryType::Regular;
    let with = |entries: &[(&str, EntryType)], part: &str| {
        let bytes = pack(entries.iter().map(|&(path, kind)| (path, kind, &b"x"[..])));
        fs::write(&file, bytes).unwrap();
        refused(&file, part);
    };
    for path in [
        "/etc/passwd",
        "../x",
        "a/../x",
        "a/..",
        "a/./x",
        "a//x",
        "./a/x",
        "a",
        "a/",
        "x\\y/z",
        "a/x\\y",
        "a/c:x",
        "a/x\ny",
        "a/\x1b[2J",
    ] {
        with(&[(path, regular)], "is no path of the form FOLDER/FILE");
    }
    for kind in [
        EntryType::Symlink,
        EntryType::Link,
        EntryType::Char,
        EntryType::Block,
        EntryType::Fifo,
        EntryType::Directory,
        EntryType::Continuous,
        EntryType::GNUSparse,
        EntryType::GNULongName,
        EntryType::GNULongLink,
        EntryType::XHeader,
        EntryType::XGlobalHeader,
        EntryType::new(b'?'),
    ] {
        with(&[("a/x", kind)], "is no regular file");
    }
    with(&[("a/x", regular), ("a/x", regular)], "there twice");
    with(&[("a/x", regular), ("b/x", regular)], "two folders");
    with(&[("a/x", regular)], "no manifest-sha256.txt");
    with(&[], "empty");
    with(
        &[("a/manifest-sha256.txt", regular)],
        "manifest-sha256.txt, line 1",
    );

    let raw = |tar: &[u8]| {
        let mut gzip = gzip();
        gzip.write_all(tar).unwrap();
        fs::write(&file, gzip.finish().unwrap()).unwrap();
    };
    // Sizes that are claimed and not there, or beyond all use.
    for (size, part) in [
        (1_u64 << 20, "ends within"),
        (3 << 30, "too large"),
        (1 << 50, "too large"),
        (u64::MAX, "damaged"),
        (u64::MAX - 600, "damaged"),
    ] {
        raw(header("a/x", regular, size).as_bytes());
        let before = fs::read(&file).unwrap();
        refused(&file, part);
        assert_eq!(before, fs::read(&file).unwrap());
    }
    // A wrong checksum, half a header, something behind the end, no tar at all.
    let mut wrong = header("a/x", regular, 0);
    wrong.as_old_mut().cksum = *b"0000000\0";
    raw(wrong.as_bytes());
    refused(&file, "damaged");
    raw(&header("a/x", regular, 0).as_bytes()[..300]);
    refused(&file, "damaged");
    let end = [0; 1024];
    raw(&[&header("a/x", regular, 0).as_bytes()[..], &end, b"more"].concat());
    refused(&file, "something follows the last file");
    raw(b"hello");
    refused(&file, "damaged");
    fs::write(&file, "hello").unwrap();
    refused(&file, "damaged");
    // What is not there or not a file.
    verify(&folder.path().join("none.tar.gz"), &[])
        .code(2)
        .stderr(contains("cannot read"));
    verify(&folder.path().join("tmp"), &[]).code(2);
}
