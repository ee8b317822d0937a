//! Where a run comes from: what was asked for (`experiment.toml`), and the machines that measured it (`times-run.json`).

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use toml::{Table, Value};

use super::escape::escape;
use super::page::Section;
use crate::report::number::{grouped, significant};
use crate::report::{ReportError, Run};
use crate::study::records::{MachineTimes, RunTimes};

/// The experiment's text, and what it says.
pub struct Asked {
    text: String,
    /// Its table `[run]`: how the program was called.
    run: Table,
}

/// What the run in this folder was asked for; `None` where it keeps no experiment.
pub fn read(data: &Path) -> Result<Option<Asked>, ReportError> {
    let path = data.join("experiment.toml");
    let Some(text) = optional(&path)? else {
        return Ok(None);
    };
    let whole: Table = toml::from_str(&text).map_err(|error| ReportError::Origin {
        path,
        what: format!("not the text of an experiment: {}", error.message()),
    })?;
    let run = whole.get("run").and_then(Value::as_table);
    let run = run.cloned().unwrap_or_default();
    Ok(Some(Asked { text, run }))
}

/// Seed, options, scenes, and the experiment's text.
pub fn parameters(run: &Run, asked: Option<&Asked>) -> Section {
    let summary = &run.summary;
    let mut facts = vec![
        ("command".to_owned(), summary.command.clone()),
        ("kind".to_owned(), summary.kind.clone()),
        ("seed".to_owned(), summary.seed.to_string()),
    ];
    let stop = summary.stop.iter();
    facts.extend(stop.map(|stop| ("stop rule of every tree".to_owned(), stop.clone())));
    let mut body = String::new();
    if let Some(asked) = asked {
        let own = asked.run.iter().filter(|(_, value)| !value.is_table());
        facts.extend(own.map(|(key, value)| (key.clone(), plain(value))));
        let options = asked.run.get("options").and_then(Value::as_table);
        let options = options.into_iter().flatten();
        facts.extend(options.map(|(key, value)| (format!("option {key}"), plain(value))));
        let scenes = asked.run.get("scenes").and_then(Value::as_table);
        let scenes: Vec<_> = scenes.into_iter().flatten().collect();
        if !scenes.is_empty() {
            body += "<h3 id=\"scenes\">Scenes and the digests of their content</h3>\n<ul class=\"scenes\">\n";
            for (scene, digest) in scenes {
                let (scene, digest) = (escape(scene), escape(&plain(digest)));
                body += &format!("<li>{scene} <code>{digest}</code></li>\n");
            }
            body += "</ul>\n";
        }
        body += &format!(
            "<h3 id=\"experiment\">The experiment’s text</h3>\n\
             <pre tabindex=\"0\" role=\"region\" aria-label=\"The experiment’s text\">{}</pre>\n",
            escape(&asked.text)
        );
    }
    Section {
        id: "parameters",
        title: "Parameters",
        parts: Vec::new(),
        body: list(&facts) + &body,
    }
}

/// Versions and machines, where the run keeps them.
pub fn machines(data: &Path) -> Result<Option<Section>, ReportError> {
    let path = data.join("times-run.json");
    let Some(text) = optional(&path)? else {
        return Ok(None);
    };
    let times: RunTimes = serde_json::from_str(&text).map_err(|error| ReportError::Origin {
        path,
        what: format!("not the times of a run: {error}"),
    })?;
    let several = times.machines.len() > 1;
    let mut body = format!(
        "<p>Measured in {} s of wall time{}.</p>\n",
        significant(times.seconds, 3),
        if several {
            ", all machines together"
        } else {
            ""
        }
    );
    body.extend(times.machines.iter().map(machine));
    Ok(Some(Section {
        id: "machine",
        title: "Versions and machine",
        parts: Vec::new(),
        body,
    }))
}

fn machine(times: &MachineTimes) -> String {
    let machine = &times.machine;
    let unknown = || "unknown".to_owned();
    let facts = [
        (
            "sahlab",
            format!("{}, revision {}", machine.version, machine.revision),
        ),
        ("compiler", machine.rustc.clone()),
        ("target", machine.target.clone()),
        ("operating system", machine.os.clone()),
        (
            "processor",
            machine.processor.clone().unwrap_or_else(unknown),
        ),
        ("threads", grouped(machine.threads)),
        (
            "measured",
            format!(
                "{} of the run’s pieces in {} s",
                grouped(times.pieces),
                significant(times.seconds, 3)
            ),
        ),
    ];
    list(&facts.map(|(name, value)| (name.to_owned(), value)))
}

/// Names and what they stand for.
fn list(facts: &[(String, String)]) -> String {
    let mut out = String::from("<dl>\n");
    for (name, value) in facts {
        out += &format!(
            "<div><dt>{}</dt><dd>{}</dd></div>\n",
            escape(name),
            escape(value)
        );
    }
    out + "</dl>\n"
}

/// A value without the quotes of a text.
fn plain(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

/// A file's text, if there is such a file.
fn optional(path: &Path) -> Result<Option<String>, ReportError> {
    match fs::read_to_string(path) {
        Ok(text) => Ok(Some(text)),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(source) => Err(ReportError::Read {
            path: path.to_owned(),
            source,
        }),
    }
}
