//! Damaged and hostile archives: refused with one message, nothing written.

use super::*;

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
        "a/%2e%2e/x",
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
    // What would be one file, or a device, on some system.
    for path in [
        "a/x?",
        "a/CON",
        "a/b/nul.txt",
        "a/x.",
        "a/\u{202e}gvs.x",
        "a/x\u{200b}",
    ] {
        with(&[(path, regular)], "is no path of the form FOLDER/FILE");
    }
    for (one, other) in [
        ("a/x", "a/X"),
        ("a/\u{212b}", "a/\u{c5}"),
        ("a/p", "a/p/x"),
        ("a/p/x", "a/p"),
        ("a/p/x", "a/P/y"),
    ] {
        with(
            &[(one, regular), (other, regular)],
            "cannot be unpacked side by side",
        );
    }
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
    // What another program has packed: it may hide what cannot be seen here.
    let other = "is not as `validate archive` writes it";
    for change in [
        |h: &mut Header| h.set_mode(0o4755),
        |h: &mut Header| h.set_uid(1000),
        |h: &mut Header| h.set_gid(1000),
        |h: &mut Header| h.as_old_mut().linkname[0] = b'x',
        |h: &mut Header| h.as_old_mut().linkflag[0] = 0,
        |h: &mut Header| h.as_mut_bytes()[511] = 1,
        |h: &mut Header| h.as_mut_bytes()[257..265].copy_from_slice(b"ustar  \0"),
    ] {
        let mut changed = header("a/x", regular, 0);
        change(&mut changed);
        changed.set_cksum();
        raw(&[&changed.as_bytes()[..], &[0; 1024]].concat());
        refused(&file, other);
    }
    let mut changed = header("a/x", regular, 0);
    changed.as_mut_bytes()[2] = 0xff;
    changed.set_cksum();
    raw(changed.as_bytes());
    refused(&file, "is not UTF-8");
    // Sizes that are claimed and not there, or beyond all use.
    for (size, part) in [
        (1_u64 << 20, "ends within \"x\""),
        (3 << 30, "too large"),
        (1 << 50, "too large"),
        (u64::MAX, "too large"),
        (u64::MAX - 600, "too large"),
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
    for more in [&b"more"[..], &end] {
        raw(&[&header("a/x", regular, 0).as_bytes()[..], &end, more].concat());
        refused(&file, "something follows the last file");
    }
    raw(&[
        &header("a/x", regular, 1).as_bytes()[..],
        &[b'x'; 512],
        &end,
    ]
    .concat());
    refused(&file, "damaged in \"x\" (something follows it)");
    // A time, names and comments in the header of the stream.
    let mut dated = pack([("a/x", regular, &b"x"[..])]);
    dated[4] = 1;
    fs::write(&file, dated).unwrap();
    refused(&file, "the gzip header tells another time");
    for gzip in [
        GzBuilder::new().operating_system(3),
        GzBuilder::new().operating_system(255).filename("x"),
        GzBuilder::new().operating_system(255).comment("x"),
        GzBuilder::new().operating_system(255).extra("x"),
    ] {
        let gzip = gzip.write(Vec::new(), Compression::default());
        fs::write(&file, gzip.finish().unwrap()).unwrap();
        refused(&file, "the gzip header is not as");
    }
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
