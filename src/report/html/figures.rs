//! The figures, each drawn into the page, its title and caption as text around it.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use super::escape::{address, anchor, escape, with_subscripts, without_subscripts};
use super::page::Section;
use crate::report::bitmap::base64;
use crate::report::glyphs::SUB;
use crate::report::{DOTS_PER_INCH, Figure, RENDER, ReportError, Run, svg};

/// Bytes of a drawing above which the page has a PNG in its place.
const LARGEST_DRAWING: usize = 2 << 20;

/// Every figure of the run, and the picture of the scene where the folder of figures has one.
pub fn section(run: &Run, plots: &Path) -> Result<Section, ReportError> {
    let (mut parts, mut body) = (Vec::new(), String::new());
    let figures = run.figures()?;
    for (name, figure) in &figures {
        let id = anchor("figure", name);
        let alike = figures
            .iter()
            .filter(|(_, other)| other.title == figure.title);
        let title = match alike.count() {
            1 => figure.title.clone(),
            _ => format!("{} ({name})", figure.title),
        };
        body += &framed(
            &id,
            name,
            &title,
            &drawn(name, &title, figure, plots)?,
            &figure.caption,
            plots,
        );
        parts.push((id, title.replace(SUB, "_")));
    }
    if let Some(picture) = picture(plots)? {
        let id = anchor("figure", RENDER);
        let title = "The scene as traced";
        let alt = "The scene as its camera sees it, and what the rays of every pixel cost";
        let drawn = format!("<img alt=\"{alt}\" src=\"{}\">", embedded(&picture));
        body += &framed(&id, RENDER, title, &drawn, "", plots);
        parts.push((id, title.to_owned()));
    }
    Ok(Section {
        id: "figures",
        title: "Figures",
        parts,
        body,
    })
}

/// The figure as an element of the page: a drawing, or a PNG where that would be too large.
fn drawn(name: &str, title: &str, figure: &Figure, plots: &Path) -> Result<String, ReportError> {
    let bare = figure.bare();
    let title = without_subscripts(title);
    let drawn = svg::element_of_page(&bare, &title);
    if drawn.len() <= LARGEST_DRAWING {
        return Ok(drawn);
    }
    let png = bare.png(DOTS_PER_INCH).map_err(|source| ReportError::Png {
        path: plots.join(format!("{name}.png")),
        source,
    })?;
    Ok(format!("<img alt=\"{title}\" src=\"{}\">", embedded(&png)))
}

/// A picture between its title and its caption, with its files beside the page, where there are any.
fn framed(id: &str, name: &str, title: &str, drawn: &str, caption: &str, plots: &Path) -> String {
    let files = ["svg", "png"].into_iter().filter_map(|extension| {
        let file = format!("{name}.{extension}");
        let shown = extension.to_uppercase();
        let there = plots.join(&file).is_file();
        there.then(|| format!("<a href=\"{}\">{shown}</a>", address(&file)))
    });
    let files = match files.collect::<Vec<_>>().join(", ") {
        none if none.is_empty() => none,
        links => format!(" <span class=\"files\">{}: {links}</span>", escape(name)),
    };
    format!(
        "<figure>\n<h3 id=\"{id}\">{}</h3>\n<div class=\"card\" tabindex=\"0\" role=\"region\" aria-label=\"{}\">{drawn}</div>\n\
         <figcaption>{}{files}</figcaption>\n</figure>\n",
        with_subscripts(title),
        escape(&without_subscripts(title)),
        with_subscripts(caption),
    )
}

fn embedded(png: &[u8]) -> String {
    format!("data:image/png;base64,{}", base64(png))
}

/// The picture that `validate scene` draws, if it is there.
fn picture(plots: &Path) -> Result<Option<Vec<u8>>, ReportError> {
    let path = plots.join(format!("{RENDER}.png"));
    match fs::read(&path) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(source) => Err(ReportError::Read { path, source }),
    }
}
