//! The findings in words: the little of Markdown they are written in (paragraphs, lists in lists, strong words, code).

use super::escape::{anchor, escape};
use super::page::Section;
use crate::report::Run;

/// The findings, where a run of this kind has any.
pub fn section(run: &Run) -> Option<Section> {
    let texts = run.texts();
    if texts.is_empty() {
        return None;
    }
    let (mut parts, mut body) = (Vec::new(), String::new());
    for (name, text) in texts {
        let id = anchor("text", &name);
        body += &format!("<h3 id=\"{id}\">{}</h3>\n{}", escape(&name), html(&text));
        parts.push((id, name));
    }
    Some(Section {
        id: "findings",
        title: "Findings in words",
        parts,
        body,
    })
}

/// Paragraphs, and items whose depth is half of their indentation.
fn html(text: &str) -> String {
    let mut out = String::new();
    let mut depth = 0;
    for line in text.lines().filter(|line| !line.trim().is_empty()) {
        let indentation = line.len() - line.trim_start().len();
        let (wanted, words) = match line.trim_start().strip_prefix("- ") {
            Some(item) => (indentation / 2 + 1, item),
            None => (0, line.trim()),
        };
        if wanted > depth {
            out += &"<ul>\n<li>".repeat(wanted - depth);
        } else {
            out += &"</li>\n</ul>\n".repeat(depth - wanted);
            out += if wanted > 0 { "</li>\n<li>" } else { "" };
        }
        depth = wanted;
        out += &match wanted {
            0 => format!("<p>{}</p>\n", inline(words)),
            _ => inline(words),
        };
    }
    out + &"</li>\n</ul>\n".repeat(depth)
}

/// Strong words and code; a mark without its partner stays as it is.
fn inline(text: &str) -> String {
    let mut out = escape(text);
    for (mark, element) in [("**", "strong"), ("`", "code")] {
        let pieces: Vec<&str> = out.split(mark).collect();
        let pairs = (pieces.len() - 1) / 2;
        let mut marked = String::from(pieces[0]);
        for (i, piece) in pieces[1..].iter().enumerate() {
            match i {
                _ if i >= 2 * pairs => marked += mark,
                _ if i % 2 == 0 => marked += &format!("<{element}>"),
                _ => marked += &format!("</{element}>"),
            }
            marked += piece;
        }
        out = marked;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_nest_and_close() {
        let text = "One **two** <b>.\n\n- a `b`\n  - c\n  - d\n- e ** f\n\nEnd.\n";
        let wanted = "<p>One <strong>two</strong> &lt;b&gt;.</p>\n\
                      <ul>\n<li>a <code>b</code><ul>\n<li>c</li>\n<li>d</li>\n</ul>\n</li>\n<li>e ** f</li>\n</ul>\n\
                      <p>End.</p>\n";
        assert_eq!(html(text), wanted);
    }
}
