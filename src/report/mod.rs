//! Figures and tables of a finished run, from its files alone.
//!
//! [`read_run`] reads a data directory; [`write_plots`], [`write_tables`] and [`write_report`] are functions of what it read. Nothing here
//! knows of trees, scenes or lines: the only imports from the rest are the row types of [`crate::study::records`], the
//! cost formula and [`crate::files`].

mod assumptions;
mod axis;
mod bare;
mod bitmap;
mod canvas;
mod choices;
mod cost;
mod cost_vs_work;
mod density;
mod figure;
mod figure3;
#[cfg(test)]
mod fixture;
mod glyphs;
mod grid;
mod hits;
mod html;
mod legend;
mod means;
mod number;
mod palette;
mod panel;
mod partition;
mod parts;
mod raster;
mod read;
pub mod render;
pub mod screen;
mod series;
mod shown;
mod slopes;
mod speed_vs_error;
mod split_cost;
mod stability;
mod strategies;
mod svg;
mod table;
mod tables;
mod termination;
#[cfg(test)]
mod tests;
mod text;
pub mod trace;
mod traversal;

use std::path::{Path, PathBuf};
use std::{fs, io};

use crate::files::write_atomic;

pub use assumptions::Assumptions;
pub use bitmap::Bitmap;
pub use cost_vs_work::CostVsWork;
pub use figure::Figure;
pub use hits::Hits;
pub use html::{REPORT, write_report};
pub use read::{Content, Run, read_run};
pub use speed_vs_error::SpeedVsError;
pub use split_cost::SplitCost;
pub use stability::Stability;
pub use strategies::Strategies;
pub use table::{Align, Cell, Column, Table};
pub use termination::Termination;
pub use traversal::Traversal;

/// Resolution of the PNG files, in dots per inch.
const DOTS_PER_INCH: f64 = 216.0;

/// Name of the figure that `validate scene` draws from the scene itself, beside those of its run.
pub const RENDER: &str = "render";

/// Why a run could not be read or reported.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A file cannot be opened or read.
    #[error("{path}: cannot read", path = path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A row of a CSV file is not what it should be.
    #[error("{path}, line {line}: {what}", path = path.display())]
    Row {
        /// The file.
        path: PathBuf,
        /// The line, the header being line 1.
        line: u64,
        /// What is wrong.
        what: String,
    },
    /// A JSON file is not what it should be.
    #[error("{path}: not a summary of a run", path = path.display())]
    Json {
        /// The file.
        path: PathBuf,
        /// Line, column and fault.
        source: serde_json::Error,
    },
    /// There is nothing to draw or to print.
    #[error("{what}")]
    Empty {
        /// What is missing, and where.
        what: String,
    },
    /// What tells where a run comes from is not what it should be.
    #[error("{path}: {what}", path = path.display())]
    Origin {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// A picture of a run is not what it should be.
    #[error("{path}: {what}", path = path.display())]
    Picture {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// The tables would land on the data they are made from.
    #[error("{path}: holds the data of the run, which cells.csv would overwrite; name another directory", path = path.display())]
    Overwrite {
        /// The directory.
        path: PathBuf,
    },
    /// An image cannot be encoded.
    #[error("{path}: cannot encode the image", path = path.display())]
    Png {
        /// The file.
        path: PathBuf,
        /// Why.
        source: png::EncodingError,
    },
    /// A file of an earlier run cannot be removed.
    #[error("{path}: cannot remove what an earlier run wrote", path = path.display())]
    Remove {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A file cannot be written.
    #[error("{path}: cannot write", path = path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}

/// Draws every figure of a run into `out`, as SVG and PNG; gives the files in the order written.
///
/// Other SVG and PNG files there, of an earlier form of the run, are removed, but for [`RENDER`] and but in the run's own
/// data directory.
pub fn write_plots(run: &Run, out: &Path) -> Result<Vec<PathBuf>, ReportError> {
    let mut files = Vec::new();
    for (name, figure) in run.figures()? {
        files.extend(write_figure(out, &name, &figure)?);
    }
    if !holds_data(run, out) {
        remove_others(out, &["svg", "png"], &files)?;
    }
    Ok(files)
}

/// Writes a figure into `out` as SVG and PNG; gives the two files.
pub fn write_figure(out: &Path, name: &str, figure: &Figure) -> Result<[PathBuf; 2], ReportError> {
    let [svg, png] = ["svg", "png"].map(|extension| out.join(format!("{name}.{extension}")));
    write(&svg, figure.svg().as_bytes())?;
    let bytes = figure
        .png(DOTS_PER_INCH)
        .map_err(|source| ReportError::Png {
            path: png.clone(),
            source,
        })?;
    write(&png, &bytes)?;
    Ok([svg, png])
}

/// Writes every table of a run into `out`, as Markdown, LaTeX and CSV, and its findings in words as Markdown; gives the
/// files in the order written.
///
/// Other files of these kinds there, of an earlier form of the run, are removed.
///
/// The tables name the command of the run as what made them, so that the same run gives the same bytes however often they are
/// written.
pub fn write_tables(run: &Run, out: &Path) -> Result<Vec<PathBuf>, ReportError> {
    if holds_data(run, out) {
        return Err(ReportError::Overwrite {
            path: out.to_owned(),
        });
    }
    let command = &run.summary.command;
    let mut files = Vec::new();
    for (name, text) in run.texts() {
        let path = out.join(format!("{name}.md"));
        let text = format!("<!-- {} -->\n\n{text}", table::generated_by(command));
        write(&path, text.as_bytes())?;
        files.push(path);
    }
    for (name, table) in run.tables() {
        let texts = [
            ("md", table.to_markdown(command)),
            ("tex", table.to_latex(command)),
            ("csv", table.to_csv()),
        ];
        for (extension, text) in texts {
            let path = out.join(format!("{name}.{extension}"));
            write(&path, text.as_bytes())?;
            files.push(path);
        }
    }
    remove_others(out, &["md", "tex", "csv"], &files)?;
    Ok(files)
}

/// Whether this is the directory that the run was read from.
fn holds_data(run: &Run, out: &Path) -> bool {
    let pair = (run.dir.canonicalize(), out.canonicalize());
    matches!(pair, (Ok(data), Ok(out)) if data == out)
}

/// Removes the files with these extensions in `out` that are not among those written: they would pass for this run's.
fn remove_others(out: &Path, extensions: &[&str], written: &[PathBuf]) -> Result<(), ReportError> {
    let unread = |source| ReportError::Read {
        path: out.to_owned(),
        source,
    };
    let entries = match fs::read_dir(out) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        entries => entries.map_err(unread)?,
    };
    for entry in entries {
        let entry = entry.map_err(unread)?;
        let path = entry.path();
        let reported = path
            .extension()
            .is_some_and(|own| extensions.iter().any(|&e| own == e));
        let kept = path.file_stem().is_some_and(|stem| stem == RENDER) || written.contains(&path);
        if reported && !kept && entry.file_type().map_err(unread)?.is_file() {
            fs::remove_file(&path).map_err(|source| ReportError::Remove { path, source })?;
        }
    }
    Ok(())
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), ReportError> {
    write_atomic(path, bytes).map_err(|source| ReportError::Write {
        path: path.to_owned(),
        source,
    })
}
