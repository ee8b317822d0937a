//! The page of a run in a real browser, where one of Chromium's family is found: `SAHLAB_BROWSER`, else on the PATH.
#![allow(clippy::unwrap_used, missing_docs)]

mod runs;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::tempdir;

const EXPERIMENT: &str = r#"kind = "hits-vs-area"
question = "Is <i>this</i> & \"that\" 'shown'?"
seed = 5
scenes = ["simple:uniform:200"]
strategies = ["sah", "spatial-median", "object-median", "sah-cyclic", "sah-longest"]
stop = "objects:2:10"
nodes = false
cost = { c_k = 15.0, c_b = 0.0, c_t = 20.0 }
lines = { slope_error = 0.1, min = 8192, max = 8192 }
figure = { scene = "simple:uniform:200", strategy = "sah" }
expect = { slope_within = 0.3, family = 0.01, gate = 0.001 }
"#;

/// Notes what goes wrong from the first moment on, in place of the page's policy for scripts.
const WATCH: &str = "<script>
const told = [];
addEventListener('error', (event) => told.push(event.message));
addEventListener('securitypolicyviolation', (event) => told.push(event.violatedDirective + ' ' + event.blockedURI));
</script>";

/// Clicks heads of the first table and tells the frame around the page what came of it, a line each.
const PROBE: &str = r#"<script>
{
  const table = document.querySelector('table');
  const column = [...table.tHead.rows[0].cells].findIndex((head) => head.textContent.startsWith('nodes'));
  const same = [...table.tHead.rows[0].cells].findIndex((head) => head.textContent === 'lines');
  const button = (i) => table.tHead.rows[0].cells[i].querySelector('button');
  const cells = () => [...table.tBodies[0].rows].map((row) => row.cells[column]);
  const values = () => cells().map((cell) => cell.textContent === '–' ? '-' : cell.dataset.v ?? cell.textContent).join(' ');
  const order = () => table.tHead.rows[0].cells[column].getAttribute('aria-sort') ?? 'none';
  cells()[1].textContent = '–';
  cells()[1].dataset.v = '';
  const lines = [`file=${values()}`];
  for (const click of ['first', 'second', 'third']) {
    button(column).click();
    lines.push(`${click}=${order()} ${values()}`);
  }
  button(same).click();
  lines.push(`equal=${values()}`);
  button(1).click();
  lines.push(`words=${[...table.tBodies[0].rows].map((row) => row.cells[1].textContent).join(' ')}`);
  const root = document.documentElement;
  lines.push(`width=${innerWidth}`);
  lines.push(`room=${root.clientWidth}`);
  lines.push(`taken=${root.scrollWidth}`);
  lines.push(`ground=${getComputedStyle(document.body).backgroundColor}`);
  lines.push(`ink=${getComputedStyle(document.body).color}`);
  lines.push(`loaded=${performance.getEntriesByType('resource').length}`);
  lines.push(`question=${document.querySelector('.question').textContent}`);
  lines.push(`reached=${[...document.querySelectorAll('thead th')].every((head) => head.querySelector('button').tabIndex === 0)}`);
  lines.push(`wrong=${told.join('; ')}`);
  parent.postMessage(lines.join('\n'), '*');
}
</script>"#;

/// Shows the page in a frame as wide as a phone, narrower than a browser's window may be, and takes down what it tells.
const FRAME: &str = r#"<!DOCTYPE html>
<meta name="color-scheme" content="light dark">
<pre id="probe"></pre>
<script>
addEventListener('message', (event) => { document.getElementById('probe').textContent = event.data; });
</script>
<iframe src="probe.html" width="390" height="800" style="border: 0"></iframe>
"#;

/// The browser, if there is one.
fn browser() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os("SAHLAB_BROWSER") {
        return Some(named.into());
    }
    let folders: Vec<PathBuf> = std::env::split_paths(&std::env::var_os("PATH")?).collect();
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let mut all = names
        .iter()
        .flat_map(|name| folders.iter().map(move |f| f.join(name)));
    all.find(|path| path.is_file())
}

/// What the browser makes of a page: the document at last, and all it said.
fn open(browser: &Path, page: &Path, more: &[&str]) -> (String, String) {
    let profile = tempdir().unwrap();
    let output = Command::new(browser)
        .args(["--headless=new", "--no-sandbox", "--disable-gpu"])
        .args(["--dump-dom", "--enable-logging=stderr"])
        .arg("--virtual-time-budget=5000")
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .args(more)
        .arg(format!("file://{}", page.display()))
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (text(&output.stdout), text(&output.stderr))
}

/// The lines that the probe wrote.
fn probed(document: &str) -> BTreeMap<&str, &str> {
    let (_, rest) = document.split_once("<pre id=\"probe\">").unwrap();
    let (lines, _) = rest.split_once("</pre>").unwrap();
    lines
        .lines()
        .map(|line| line.split_once('=').unwrap())
        .collect()
}

/// Makes the run and gives its page.
fn page(folder: &Path) -> PathBuf {
    runs::validate(folder).assert().code(0);
    let page = folder.join("plots/e/report.html");
    page.canonicalize().unwrap()
}

/// A frame, beside the page, around a copy of it with the watch and the probe, which its policy would not let run.
fn probing(page: &Path) -> PathBuf {
    let text = fs::read_to_string(page).unwrap();
    let (before, rest) = text.split_once("script-src '").unwrap();
    let (_, after) = rest.split_once("';").unwrap();
    let text = format!("{before}script-src 'unsafe-inline';{after}");
    let text = text.replacen("<title>", &format!("{WATCH}<title>"), 1);
    let text = text.replacen("</body>", &format!("{PROBE}</body>"), 1);
    fs::write(page.with_file_name("probe.html"), text).unwrap();
    let frame = page.with_file_name("frame.html");
    fs::write(&frame, FRAME).unwrap();
    frame
}

#[test]
fn the_page_sorts_fits_and_needs_nothing_else() {
    let Some(browser) = browser() else {
        eprintln!("no browser of Chromium's family: the page of a run is not opened");
        return;
    };
    let folder = runs::folder(EXPERIMENT);
    let page = page(folder.path());
    let (document, said) = open(&browser, &page, &[]);
    assert!(
        document.contains("<button type=\"button\">nodes</button>"),
        "the script runs\n{said}"
    );
    assert!(!said.contains("CONSOLE"), "{said}");

    let frame = probing(&page);
    let (document, said) = open(&browser, &frame, &[]);
    let light = probed(&document);
    assert_eq!((light["wrong"], light["loaded"]), ("", "0"));
    assert!(!said.contains("CONSOLE"), "{said}");
    assert_eq!(
        light["question"],
        "Is &lt;i&gt;this&lt;/i&gt; &amp; \"that\" 'shown'?"
    );

    // Numbers by value, the unknown one last either way, then back to the order of the file.
    let file: Vec<&str> = light["file"].split(' ').collect();
    assert_eq!((file.len(), file[1]), (5, "-"));
    let mut known: Vec<u64> = file.iter().filter_map(|text| text.parse().ok()).collect();
    known.sort_unstable();
    let shown = |numbers: &[u64]| numbers.iter().map(|n| format!("{n} ")).collect::<String>() + "-";
    assert_eq!(light["first"], format!("ascending {}", shown(&known)));
    known.reverse();
    assert_eq!(light["second"], format!("descending {}", shown(&known)));
    assert_eq!(light["third"], format!("none {}", light["file"]));
    // All cells have as many lines: nothing moves.
    assert_eq!(light["equal"], light["file"]);
    let words = "object-median sah sah-cyclic sah-longest spatial-median";
    assert_eq!((light["words"], light["reached"]), (words, "true"));

    assert_eq!(light["width"], "390");
    assert_eq!(light["taken"], light["room"], "no sideways scroll");

    let dark = [
        "--blink-settings=preferredColorScheme=0",
        "--force-dark-mode",
    ];
    let (document, _) = open(&browser, &frame, &dark);
    let dark = probed(&document);
    assert!(dark["ground"] != light["ground"] && dark["ink"] != light["ink"]);
}

#[test]
fn the_page_comes_from_data_alone() {
    let folder = runs::folder(EXPERIMENT);
    let page = page(folder.path());
    let first = fs::read(&page).unwrap();
    fs::remove_file(&page).unwrap();
    let report = |more: &[&str]| {
        let mut command = assert_cmd::Command::cargo_bin("validate").unwrap();
        let command = command.current_dir(folder.path());
        command.args(["report", "data/e"]).args(more).assert()
    };
    report(&[]).code(0).stdout("plots/e/report.html\n");
    assert!(fs::read(&page).unwrap() == first);
    report(&["--out", "x"])
        .code(0)
        .stdout("x/plots/e/report.html\n");
    assert!(folder.path().join("x/plots/e/report.html").is_file());
    report(&["--dry-run"]).code(2);
}
