//! One byte of an archive is another: what is damaged is named, wherever that byte lies.

use super::*;

/// The places a message may name.
const NAMED: [&str; 7] = [
    "at its beginning",
    "gzip header",
    "gzip trailer",
    "data/",
    "bagit.txt",
    "bag-info.txt",
    "manifest-sha256.txt",
];

/// What verify says of an archive with these bytes; it must be found wrong, with a file named.
fn told(file: &Path, bytes: &[u8], at: usize) -> String {
    fs::write(file, bytes).unwrap();
    let output = verify(file, &[]).get_output().clone();
    let text = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
    assert!(
        matches!(output.status.code(), Some(1 | 2)),
        "byte {at}: {text}"
    );
    let first = text.lines().next().unwrap();
    let first = first.replace("a.tar.gz", "");
    assert!(
        NAMED.iter().any(|name| first.contains(name)),
        "byte {at}: {text}"
    );
    text
}

#[test]
fn a_flipped_byte_anywhere_names_what_is_damaged() {
    let (_folder, file) = archive();
    let bytes = fs::read(&file).unwrap();
    let n = bytes.len();
    let flip = |at: usize, bits: u8| {
        let mut changed = bytes.clone();
        changed[at] ^= bits;
        told(&file, &changed, at)
    };
    for at in 0..10 {
        for bits in [1, 2, 4, 0xff] {
            let text = flip(at, bits);
            assert!(text.contains("gzip header"), "byte {at}: {text}");
        }
    }
    for at in n - 8..n {
        let text = flip(at, 0xff);
        assert!(text.contains("gzip trailer"), "byte {at}: {text}");
    }
    // The files that check the others, and then all the rest. Knuth's generator of MMIX: places anywhere, the same each time.
    let tags = (11..1500).step_by(50);
    let mut state = 7_u64;
    let random = std::iter::repeat_with(|| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        11 + (state >> 33) as usize % (n - 19)
    });
    let mut files = std::collections::BTreeSet::new();
    for at in tags.chain(random.take(200)) {
        let text = flip(at, 0xff);
        let words = text.split([' ', ':', '"', '\n']);
        files.extend(words.filter(|w| w.contains("data/")).map(str::to_string));
    }
    assert!(files.len() > 10, "{files:?}");
}

#[test]
fn an_archive_that_ends_early_or_late_is_refused() {
    let (_folder, file) = archive();
    let bytes = fs::read(&file).unwrap();
    let n = bytes.len();
    for length in [0, 1, 9, 10, 1000, n / 2, n - 8, n - 1] {
        let text = told(&file, &bytes[..length], length);
        assert!(text.contains("damaged"), "{length}: {text}");
    }
    for garbage in [&b"\0"[..], b"x", &bytes] {
        let text = told(&file, &[&bytes, garbage].concat(), n);
        assert!(
            text.contains("something follows the gzip trailer"),
            "{text}"
        );
    }
}

#[test]
fn a_changed_byte_in_any_file_is_found() {
    let (_folder, file) = archive();
    let files = unpack(&file);
    let manifest = "e-e-quick/manifest-sha256.txt";
    let others = files.keys().filter(|path| !path.contains("manifest-"));
    for path in others {
        for at in [0, files[path].len() / 2, files[path].len() - 1] {
            let mut changed = files.clone();
            changed.get_mut(path).unwrap()[at] ^= 1;
            fs::write(&file, repack(&changed)).unwrap();
            let below = path.split_once('/').unwrap().1;
            verify(&file, &[]).code(1).stdout(
                predicate::str::starts_with(format!("{below}: differs from the manifest\n"))
                    .and(contains("faults: 1\n")),
            );
        }
    }
    // In the manifest: a digit, a path, the end of a line, the space before a path.
    let text = String::from_utf8(files[manifest].clone()).unwrap();
    let line = text.find("  data/data/e/bins.csv").unwrap();
    let digit = if text.as_bytes()[line - 1] == b'0' {
        b'1'
    } else {
        b'0'
    };
    for (at, byte, code, told) in [
        (
            line - 1,
            digit,
            1,
            "data/data/e/bins.csv: differs from the manifest\n",
        ),
        (line + 14, b'B', 1, "data/data/e/Bins.csv: missing\n"),
        (
            line + 14,
            b'B',
            1,
            "\ndata/data/e/bins.csv: not in the manifest\n",
        ),
        (line, b'!', 2, "manifest-sha256.txt, line "),
    ] {
        let mut changed = files.clone();
        changed.get_mut(manifest).unwrap()[at] = byte;
        fs::write(&file, repack(&changed)).unwrap();
        let output = verify(&file, &[]).code(code).get_output().clone();
        let all = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
        assert!(all.contains(told), "{all}");
    }
    // All differences are told, of every kind.
    let mut changed = files.clone();
    changed.remove("e-e-quick/data/Cargo.lock");
    changed.insert("e-e-quick/data/extra".into(), vec![]);
    changed.insert("e-e-quick/extra".into(), vec![]);
    let readme = changed.get_mut("e-e-quick/data/README.md");
    readme.unwrap().push(b'x');
    fs::write(&file, repack(&changed)).unwrap();
    for more in [&[][..], &["--replay"]] {
        verify(&file, more).code(1).stdout(
            predicate::str::starts_with(
                "data/Cargo.lock: missing\ndata/README.md: differs from the manifest\ndata/extra: not in the manifest\n\
                 extra: not in the manifest\n",
            )
            .and(contains("faults: 4\n"))
            .and(contains("replay").not()),
        );
    }
}
