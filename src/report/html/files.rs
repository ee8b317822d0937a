//! Where the run's files are, and how to make them again.

use std::ffi::OsStr;
use std::fs;
use std::path::{Component, Path};

use super::escape::{address, escape};
use super::page::Section;
use crate::report::{ReportError, Run};

/// Where the data lie, seen from the page.
pub struct Place {
    /// The way from the page's folder to that of the data, where both lie in one tree.
    way: Option<String>,
    /// Name of the folder of data.
    name: String,
}

impl Place {
    /// Of a run whose figures lie in `plots`.
    pub fn of(run: &Run, plots: &Path) -> Self {
        let data = run.dir.canonicalize().ok();
        let plots = plots.canonicalize().ok();
        let name = data.as_deref().unwrap_or(&run.dir).file_name();
        Place {
            way: data
                .as_ref()
                .zip(plots.as_ref())
                .and_then(|(data, plots)| way(plots, data)),
            name: name
                .unwrap_or(OsStr::new("NAME"))
                .to_string_lossy()
                .into_owned(),
        }
    }

    /// A file of the data, below their folder.
    fn link(&self, file: &str, shown: &str) -> String {
        match &self.way {
            Some(way) => {
                let address = address(&format!("{way}/{file}"));
                format!("<a href=\"{address}\">{}</a>", escape(shown))
            }
            None => escape(shown),
        }
    }

    /// The files of a table.
    pub fn table(&self, name: &str) -> String {
        let files = [("csv", "CSV"), ("md", "Markdown"), ("tex", "LaTeX")];
        let links = files.map(|(e, shown)| self.link(&format!("tables/{name}.{e}"), shown));
        match self.way {
            Some(_) => format!(" <span class=\"files\">{}</span>", links.join(", ")),
            None => String::new(),
        }
    }
}

/// The way from one folder to another; `None` where they share nothing within three folders up.
fn way(from: &Path, to: &Path) -> Option<String> {
    let shared = from.components().zip(to.components());
    let shared = shared.take_while(|(a, b)| a == b).count();
    let up = from.components().count() - shared;
    let down = to.components().skip(shared).map(Component::as_os_str);
    let down: Option<Vec<&str>> = down.map(OsStr::to_str).collect();
    let steps = std::iter::repeat_n("..", up).chain(down?);
    (up <= 3).then(|| steps.collect::<Vec<_>>().join("/"))
}

/// Commands, and what they are for.
fn told(what_for: &str, label: &str, commands: &str) -> String {
    format!(
        "<p>{what_for}:</p>\n<pre tabindex=\"0\" role=\"region\" aria-label=\"{label}\">{}</pre>\n",
        escape(commands)
    )
}

/// Commands that repeat the run, `archived` where it keeps the experiment that an archive needs.
pub fn again(run: &Run, archived: bool) -> Section {
    let name = run.dir.canonicalize().unwrap_or_else(|_| run.dir.clone());
    let name = name
        .file_name()
        .unwrap_or(OsStr::new("NAME"))
        .to_string_lossy();
    let mut body = told(
        "The same program, seed and scenes give the same data but for seconds, with any number of threads",
        "Command that repeats the run",
        &run.summary.command,
    );
    if archived {
        body += &told(
            "From the experiment that is kept with the data, where the file it was read from is not at hand",
            "Command that repeats the run from its data",
            &format!("validate run data/{name}/experiment.toml --out again"),
        );
        body += &told(
            "To hand the run on, and to have all of it repeated and compared (counts exactly, other figures within 1e-9 of each other)",
            "Commands that archive and repeat the run",
            &format!(
                "validate archive data/{name} --out {name}-alone.tar.gz\nvalidate verify {name}-alone.tar.gz --replay"
            ),
        );
    }
    body += &told(
        "This page alone, from the data",
        "Command that makes this page",
        &format!("validate report data/{name}"),
    );
    Section {
        id: "again",
        title: "How to run it again",
        parts: Vec::new(),
        body,
    }
}

/// The files of data; those of figures and tables stand beside each.
pub fn section(run: &Run, place: &Place) -> Result<Section, ReportError> {
    let unread = |source| ReportError::Read {
        path: run.dir.clone(),
        source,
    };
    let mut files = Vec::new();
    for entry in fs::read_dir(&run.dir).map_err(unread)? {
        let path = entry.map_err(unread)?.path();
        let extension = path.extension().and_then(OsStr::to_str);
        let told = extension.is_some_and(|e| ["csv", "json", "toml", "md"].contains(&e));
        if told && let Some(name) = path.file_name().and_then(OsStr::to_str) {
            files.push(name.to_owned());
        }
    }
    files.sort();
    let mut body = format!(
        "<p>Data in <code>data/{}</code>; its README.md explains every file and column.</p>\n<ul class=\"files\">\n",
        escape(&place.name)
    );
    for file in files {
        body += &format!("<li>{}</li>\n", place.link(&file, &file));
    }
    body += "</ul>\n";
    Ok(Section {
        id: "files",
        title: "Files",
        parts: Vec::new(),
        body,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_lead_up_and_down_but_not_far() {
        let way = |from, to| way(Path::new(from), Path::new(to));
        assert_eq!(way("/a/plots/x", "/a/data/x").unwrap(), "../../data/x");
        assert_eq!(way("/a/x", "/a/x/data").unwrap(), "data");
        assert_eq!(way("/a/b/c/plots/x", "/d/data/x"), None);
    }
}
