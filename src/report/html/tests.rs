//! The page as a whole.

use std::fs;

use super::*;
use crate::report::fixture;
use crate::study::records::Verdict;

const HOSTILE: &str = "<script>alert(\"1\" + '2')</script> & more";

/// A run whose every text from outside is hostile, in a folder of data of its own.
fn run(data: &Path) -> Run {
    let mut run = fixture::run(fixture::cells(2, 2));
    run.dir = data.to_owned();
    run.summary.question = HOSTILE.to_owned();
    run.summary.experiment = HOSTILE.to_owned();
    run.summary.command = HOSTILE.to_owned();
    let verdict = |held, message: &str| Verdict {
        name: HOSTILE.to_owned(),
        held,
        message: message.to_owned(),
    };
    run.summary.verdicts = vec![verdict(true, "first"), verdict(false, HOSTILE)];
    if let crate::report::Content::Hits(hits) = &mut run.content {
        hits.cells
            .iter_mut()
            .for_each(|cell| cell.scene = format!("{HOSTILE}{}", cell.scene));
    }
    run
}

/// Folders `data/e` and `plots/e` with a run, its experiment and its machines.
fn folders() -> tempfile::TempDir {
    let root = tempfile::tempdir().unwrap();
    for part in ["data/e/tables", "plots/e"] {
        fs::create_dir_all(root.path().join(part)).unwrap();
    }
    let write =
        |name: &str, text: &str| fs::write(root.path().join("data/e").join(name), text).unwrap();
    let scene = HOSTILE.replace('"', "\\\"");
    write(
        "experiment.toml",
        &format!(
            "question = \"{scene}\" # {HOSTILE}\n[run]\npath = \"{scene}\"\noptions = {{ quick = false }}\n\
             scenes = {{ \"{scene}\" = \"0123456789abcdef\" }}\n"
        ),
    );
    write(
        "times-run.json",
        &format!(
            "{{\"seconds\": 12.5, \"machines\": [{{\"version\": \"{scene}\", \"revision\": \"{scene}\", \"rustc\": \"{scene}\",\
             \"target\": \"{scene}\", \"os\": \"{scene}\", \"processor\": null, \"threads\": 2, \"pieces\": 3, \"seconds\": 12.5}}]}}"
        ),
    );
    write("cells & more.csv", "");
    root
}

#[test]
fn nothing_from_outside_is_markup() {
    let root = folders();
    let page = html(
        &run(&root.path().join("data/e")),
        &root.path().join("plots/e"),
    )
    .unwrap();
    assert!(!page.contains("<script>alert"));
    assert_eq!(page.matches("<script>").count(), 1, "the page's own");
    assert!(!page.contains("' & more") && !page.contains("> & more"));
    // Title, heading, question, command, two expectations, one message, text, scenes, tables, machines.
    let times = page
        .matches("&lt;script&gt;alert(&quot;1&quot; + &#39;2&#39;)&lt;/script&gt; &amp; more")
        .count();
    assert!(times > 20, "{times}");
    assert!(
        page.contains("<a href=\"../../data/e/cells%20%26%20more.csv\">cells &amp; more.csv</a>")
    );
    assert!(page.contains("<code>0123456789abcdef</code>"));
    assert!(page.contains("<dt>processor</dt><dd>unknown</dd>"));
}

#[test]
fn what_was_missed_comes_first() {
    let root = folders();
    let page = html(
        &run(&root.path().join("data/e")),
        &root.path().join("plots/e"),
    )
    .unwrap();
    assert!(page.contains("<p class=\"glance missed\">1 of 2 expectations missed, 1 held.</p>"));
    let place = |text: &str| page.find(text).unwrap();
    assert!(place("<li class=\"missed\">") < place("<li class=\"held\">"));
    assert!(place("id=\"verdict\"") < place("id=\"figures\""));
    assert!(place("id=\"figures\"") < place("id=\"tables\""));
}

#[test]
fn every_link_within_the_page_has_its_anchor_and_anchors_differ() {
    let root = folders();
    let page = html(
        &run(&root.path().join("data/e")),
        &root.path().join("plots/e"),
    )
    .unwrap();
    let all = |mark: &str| -> Vec<String> {
        let rest = page.split(mark).skip(1);
        rest.map(|rest| rest.split('"').next().unwrap().to_owned())
            .collect()
    };
    let anchors = all(" id=\"");
    let mut distinct = anchors.clone();
    distinct.sort();
    distinct.dedup();
    assert_eq!(distinct.len(), anchors.len());
    let links = all("href=\"#");
    assert!(links.len() > 8, "{links:?}");
    for link in links {
        assert!(anchors.contains(&link), "{link}");
    }
}

#[test]
fn the_same_folders_give_the_same_page_whose_policy_names_its_own_script() {
    let root = folders();
    let (data, plots) = (root.path().join("data/e"), root.path().join("plots/e"));
    let path = write_report(&run(&data), &plots).unwrap();
    assert_eq!(path, plots.join("report.html"));
    let first = fs::read_to_string(&path).unwrap();
    assert_eq!(
        fs::read_to_string(write_report(&run(&data), &plots).unwrap()).unwrap(),
        first
    );
    assert!(first.contains("content=\"default-src 'none'; style-src 'sha256-"));
    assert!(!first.contains("http://") && !first.contains("https://"));
}

#[test]
fn a_picture_of_the_scene_is_held_by_the_page() {
    let root = folders();
    let (data, plots) = (root.path().join("data/e"), root.path().join("plots/e"));
    assert!(!html(&run(&data), &plots).unwrap().contains("<img"));
    fs::write(plots.join("render.png"), b"\x89PNG").unwrap();
    let page = html(&run(&data), &plots).unwrap();
    assert!(page.contains("src=\"data:image/png;base64,iVBORw==\""));
}

#[test]
fn broken_records_of_the_origin_are_told() {
    let root = folders();
    let (data, plots) = (root.path().join("data/e"), root.path().join("plots/e"));
    let told = |file: &str| {
        let kept = fs::read(data.join(file)).unwrap();
        fs::write(data.join(file), "=").unwrap();
        let error = html(&run(&data), &plots).unwrap_err().to_string();
        fs::write(data.join(file), kept).unwrap();
        error.replace(&data.display().to_string(), "data/e")
    };
    let text = told("experiment.toml");
    assert!(
        text.starts_with("data/e/experiment.toml: not the text of an experiment"),
        "{text}"
    );
    let text = told("times-run.json");
    assert!(
        text.starts_with("data/e/times-run.json: not the times of a run"),
        "{text}"
    );
}
