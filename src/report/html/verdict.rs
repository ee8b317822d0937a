//! What was expected and what came of it, what was missed first.

use super::escape::escape;
use super::page::Section;
use crate::report::Run;
use crate::report::number::counted;
use crate::study::records::Verdict;

/// The verdict at a glance, then every expectation.
pub fn section(run: &Run) -> Section {
    let (held, missed): (Vec<&Verdict>, Vec<&Verdict>) = run.verdicts().partition(|v| v.held);
    let (class, glance) = match (missed.len(), held.len()) {
        (0, 0) => ("none", "Nothing was expected beforehand.".to_owned()),
        (0, 1) => ("held", "The expectation held.".to_owned()),
        (0, all) => ("held", format!("All {all} expectations held.")),
        (missed, held) => {
            let all = counted((missed + held) as u64, "expectation");
            ("missed", format!("{missed} of {all} missed, {held} held."))
        }
    };
    let mut body = format!("<p class=\"glance {class}\">{glance}</p>\n");
    if run.summary.quick {
        body += "<p class=\"quick\">Quick form: fewer lines, smaller scenes; no figure of it is to be published.</p>\n";
    }
    if class != "none" {
        body += "<ul class=\"verdicts\">\n";
        for verdict in missed.into_iter().chain(held) {
            body += &item(verdict);
        }
        body += "</ul>\n";
    }
    Section {
        id: "verdict",
        title: "Verdict",
        parts: Vec::new(),
        body,
    }
}

fn item(verdict: &Verdict) -> String {
    let word = if verdict.held { "held" } else { "missed" };
    format!(
        "<li class=\"{word}\"><b class=\"mark\">{word}</b> <span class=\"name\">{}</span> <span class=\"message\">{}</span></li>\n",
        escape(&verdict.name),
        escape(&verdict.message)
    )
}
