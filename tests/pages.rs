//! README and the pages of docs/: what they quote, what they link to, what they show.
#![allow(clippy::unwrap_used, missing_docs)]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command as Process;

use assert_cmd::Command;
use predicates::str::contains;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn validate(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("validate").unwrap();
    command.current_dir(folder);
    command
}

/// README, the change log and every page below docs, relative to the root.
fn pages() -> Vec<PathBuf> {
    let mut pages = vec!["README.md".into(), "CHANGELOG.md".into()];
    let mut open = vec![PathBuf::from("docs")];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(root().join(&folder)).unwrap() {
            let path = folder.join(entry.unwrap().file_name());
            if root().join(&path).is_dir() {
                open.push(path);
            } else {
                assert!(path.extension().unwrap() == "md", "{}", path.display());
                pages.push(path);
            }
        }
    }
    assert!(pages.len() > 15);
    pages
}

fn read(page: &Path) -> String {
    fs::read_to_string(root().join(page)).unwrap()
}

/// A page without its fenced code, and the text of each fence with the word behind it.
fn prose_and_code(text: &str) -> (String, Vec<(String, String)>) {
    let (mut prose, mut code) = (String::new(), Vec::new());
    for (i, part) in text.split("```").enumerate() {
        if i % 2 == 0 {
            prose += part;
        } else {
            let (kind, body) = part.split_once('\n').unwrap();
            code.push((kind.to_string(), body.to_string()));
        }
    }
    (prose, code)
}

/// Where each link and picture of a page leads, and what is written on it.
fn links(text: &str) -> Vec<(String, String)> {
    let prose = prose_and_code(text).0;
    let link = |(at, _): (usize, &str)| {
        let target = prose[at + 2..].split(')').next().unwrap();
        let words = prose[..at].rsplit('[').next().unwrap();
        (target.to_string(), words.to_string())
    };
    prose.match_indices("](").map(link).collect()
}

/// The anchors that GitHub gives the headings of a page.
fn anchors(text: &str) -> BTreeSet<String> {
    let prose = prose_and_code(text).0;
    let titles = prose.lines().filter(|line| line.starts_with('#'));
    let anchor = |title: &str| {
        let title = title.trim_start_matches('#').trim().to_lowercase();
        let kept = title
            .chars()
            .filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        kept.collect::<String>().replace(' ', "-")
    };
    titles.map(anchor).collect()
}

#[test]
fn every_quotation_is_up_to_date() {
    validate(root())
        .args(["publish", "--check"])
        .assert()
        .code(0)
        .stdout(contains("up to date: all quotations"));
}

/// The same without the program: blocks word for word, cells as words of the file they name.
#[test]
fn every_quotation_stands_in_the_file_it_names() {
    let (mut blocks, mut cells) = (0, 0);
    for page in pages() {
        let text = read(&page);
        for block in text.split("<!-- BEGIN ").skip(1) {
            let (mark, rest) = block.split_once(" -->\n").unwrap();
            let quoted = rest.split("<!-- END -->").next().unwrap();
            let file = mark.split(" :: ").next().unwrap();
            let content = read(Path::new(file));
            if file == mark {
                assert_eq!(quoted.trim_end(), content.trim_end(), "{mark}");
            } else {
                let words = quoted.split('|').map(str::trim);
                let words = words.filter(|word| !word.starts_with('-'));
                let gone = words.clone().find(|word| !content.contains(word));
                assert_eq!(gone, None, "{mark}");
                assert!(words.count() > 20, "{mark}");
            }
            blocks += 1;
        }
        for cell in text.split("<!-- = ").skip(1) {
            let (mark, rest) = cell.split_once(" -->").unwrap();
            let (quoted, _) = rest.split_once("<!-- / -->").unwrap();
            let file = mark.split(" :: ").next().unwrap();
            let content = read(Path::new(file));
            let keys: Vec<&str> = mark.split(" :: ").skip(1).collect();
            let (_, keys) = keys.split_last().unwrap();
            // The first one may name a group of rows, in a row of its own.
            let title = format!("| {} |", keys[0]);
            let empty = |rest: &str| rest.chars().all(|c| "| ".contains(c));
            let is_title = |line: &str| line.strip_prefix(&title).is_some_and(empty);
            let keys = &keys[usize::from(content.lines().any(is_title))..];
            let stands = |line: &str| {
                keys.iter().all(|key| line.contains(key)) && line.contains(&format!(" {quoted} "))
            };
            assert!(
                !quoted.is_empty() && content.lines().any(stands),
                "{mark}: {quoted}"
            );
            cells += 1;
        }
    }
    assert!(
        blocks >= 35 && cells >= 25,
        "{blocks} blocks, {cells} cells"
    );
}

/// The findings of README: every number in an answer is quoted, but for what was asked and names.
#[test]
fn no_number_of_a_finding_is_typed_by_hand() {
    let text = read(Path::new("README.md"));
    let findings = text.split("## Findings").nth(1).unwrap();
    let rows = findings.lines().skip_while(|line| !line.starts_with('|'));
    let answers = rows.skip(2).take_while(|line| line.starts_with('|'));
    let names = ["f32", "f64", "(2000", "0.1", "(90", "(99", "(10⁵"];
    let mut quoted = 0;
    for answer in answers.map(|row| row.split(" | ").nth(1).unwrap()) {
        for part in answer.split("<!-- = ") {
            let typed = part.rsplit("<!-- / -->").next().unwrap();
            let number = |word: &&str| word.chars().any(|c| c.is_ascii_digit());
            let by_hand = typed.split_whitespace().filter(number);
            let mut by_hand = by_hand
                .filter(|word| !names.contains(&word.trim_end_matches([',', '.', ':', ')'])));
            assert_eq!(by_hand.next(), None, "{typed}");
            quoted += usize::from(part.contains("<!-- / -->"));
        }
    }
    assert!(quoted > 25, "{quoted}");
}

#[test]
fn every_link_leads_somewhere_and_every_page_is_linked() {
    let pages = pages();
    let mut reached: BTreeSet<PathBuf> = [root().join("README.md")].into();
    let mut wrong = Vec::new();
    for page in &pages {
        let text = read(page);
        for (target, words) in links(&text) {
            if target.starts_with("https://") {
                continue;
            }
            let (file, anchor) = target.split_once('#').unwrap_or((&target, ""));
            let here = root().join(page);
            let there = match file {
                "" => here.clone(),
                _ => here.parent().unwrap().join(file),
            };
            let Ok(there) = there.canonicalize() else {
                wrong.push(format!("{}: {target}", page.display()));
                continue;
            };
            let known = || anchors(&fs::read_to_string(&there).unwrap()).contains(anchor);
            if !anchor.is_empty() && !known() {
                wrong.push(format!("{}: {target}: no such heading", page.display()));
            }
            if words.is_empty() {
                wrong.push(format!(
                    "{}: {target}: nothing is written on it",
                    page.display()
                ));
            }
            reached.insert(there);
        }
    }
    for page in &pages {
        if !reached.contains(&root().join(page).canonicalize().unwrap()) {
            wrong.push(format!("{}: no page links to it", page.display()));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Names of files in code marks: what a page calls `src/kd/strategy.rs` is there.
#[test]
fn every_file_that_is_named_is_there() {
    let mut named = BTreeSet::new();
    for page in pages() {
        let prose = prose_and_code(&read(&page)).0;
        for (i, word) in prose.split('`').enumerate() {
            let ours = [
                "src/",
                "tests/",
                "experiments/",
                "benches/",
                "fuzz/",
                "peers/",
                ".ci/",
            ];
            if i % 2 == 1
                && ours.iter().any(|folder| word.starts_with(folder))
                && !word.contains(' ')
            {
                assert!(root().join(word).exists(), "{}: {word}", page.display());
                named.insert(word.to_string());
            }
        }
    }
    assert!(named.len() > 15, "{named:?}");
}

/// What a reader copies must work: the model, the rays and the experiment of the page on own models, and what it says that
/// the program answers.
#[test]
fn the_worked_example_is_what_the_program_does() {
    let page = read(Path::new("docs/your-own-model.md"));
    let (_, code) = prose_and_code(&page);
    let of = |wanted: &'static str| code.iter().filter(move |(kind, _)| kind == wanted);
    let folder = tempfile::tempdir().unwrap();
    let answer = |args: &[&str]| {
        let done = validate(folder.path())
            .args(args)
            .arg("--quiet")
            .assert()
            .code(0);
        String::from_utf8(done.get_output().stdout.clone()).unwrap()
    };
    answer(&["scene", "spd:teapot:12", "--nff", "model.nff"]);
    let answers: Vec<&String> = of("text").map(|(_, text)| text).collect();
    let [advice, own] = answers[..] else {
        panic!("{answers:?}")
    };
    let (_, text) = of("toml").next().unwrap();
    fs::write(folder.path().join("mine.toml"), text).unwrap();
    assert!(answer(&["run", "mine.toml", "--dry-run"]).contains("sah-bins:32"));

    let (_, rays) = of("sh").find(|(_, text)| text.starts_with("awk")).unwrap();
    let (script, _) = rays.split_once("validate").unwrap();
    let shell = Process::new("sh")
        .current_dir(folder.path())
        .args(["-c", script])
        .status();
    // Both answers take seconds: one is enough, and without a shell and awk it is the other one.
    if shell.is_ok_and(|status| status.success()) {
        assert!(answer(&["scene", "model.nff", "--rays", "rays.csv"]).contains(own));
    } else {
        assert!(answer(&["scene", "model.nff"]).contains(advice));
    }
}

/// Published results are whole runs, and the expectations they were held to are told with them.
#[test]
fn published_runs_are_not_quick_ones() {
    for (name, cells) in [
        ("figure3", 132),
        ("validate", 45),
        ("strategies", 660),
        ("termination", 100),
    ] {
        let folder = root().join("data/published").join(name);
        let run = sahlab::report::read_run(&folder).unwrap();
        assert!(!run.summary.quick);
        assert!(!run.summary.verdicts.is_empty());
        let rows = fs::read_to_string(folder.join("cells.csv")).unwrap();
        assert!(rows.lines().count() > cells, "{name}");
    }
}
