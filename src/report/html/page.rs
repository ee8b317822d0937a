//! The frame of the page: head, contents, sections.

use sha2::{Digest, Sha256};

use super::escape::escape;
use crate::report::bitmap::base64;
use crate::study::records::Summary;

const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");

/// One part of the page.
pub struct Section {
    /// Name of its anchor.
    pub id: &'static str,
    /// Heading.
    pub title: &'static str,
    /// Anchors and titles of its own parts, for the contents; may be empty.
    pub parts: Vec<(String, String)>,
    /// Everything below the heading, as HTML.
    pub body: String,
}

/// The whole page.
pub fn document(summary: &Summary, sections: &[Section]) -> String {
    let name = escape(&summary.experiment);
    let question = escape(&summary.question);
    let body: String = sections.iter().map(Section::html).collect();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <title>{name}: {question}</title>\n<link rel=\"icon\" href=\"data:,\">\n<style>{STYLE}</style>\n</head>\n<body>\n\
         <header>\n<p class=\"kind\">sahlab, experiment of kind {}</p>\n<h1>{name}</h1>\n<p class=\"question\">{question}</p>\n\
         </header>\n{}<main>\n{body}</main>\n<script>{SCRIPT}</script>\n</body>\n</html>\n",
        policy(),
        escape(&summary.kind),
        contents(sections),
    )
}

/// What the page may load and run (Content Security Policy): its own style and script, by their digests, and pictures that it
/// holds itself.
fn policy() -> String {
    let digest = |text: &str| format!("'sha256-{}'", base64(&Sha256::digest(text.as_bytes())));
    format!(
        "default-src 'none'; style-src {}; script-src {}; img-src data:; base-uri 'none'; form-action 'none'",
        digest(STYLE),
        digest(SCRIPT)
    )
}

fn contents(sections: &[Section]) -> String {
    let entry = |id: &str, title: &str| format!("<a href=\"#{id}\">{}</a>", escape(title));
    let mut out = String::from("<nav aria-label=\"Contents\">\n<ul>\n");
    for section in sections {
        out += &format!("<li>{}", entry(section.id, section.title));
        if !section.parts.is_empty() {
            out += "\n<ul>\n";
            for (id, title) in &section.parts {
                out += &format!("<li>{}</li>\n", entry(id, title));
            }
            out += "</ul>\n";
        }
        out += "</li>\n";
    }
    out + "</ul>\n</nav>\n"
}

impl Section {
    fn html(&self) -> String {
        format!(
            "<section aria-labelledby=\"{0}\">\n<h2 id=\"{0}\">{1}</h2>\n{2}</section>\n",
            self.id, self.title, self.body
        )
    }
}
