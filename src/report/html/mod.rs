//! A run on one page, `report.html`: what was asked, what came out, where it comes from. The page needs no other file, no
//! network and no script: the script only sorts tables and opens what is folded before printing.

mod escape;
mod figures;
mod files;
mod markdown;
mod origin;
mod page;
mod tables;
#[cfg(test)]
mod tests;
mod verdict;

use std::path::{Path, PathBuf};

use super::{ReportError, Run, write};
use page::Section;

/// Name of the page in the folder of a run's figures.
pub const REPORT: &str = "report.html";

/// Writes the page of a run into the folder of its figures; gives its path.
///
/// The same folders give the same bytes. Tables and figures are made again from what was read; the folder of data is asked for
/// `experiment.toml` and `times-run.json`, the folder of figures for the picture that `validate scene` draws.
///
/// # Errors
/// Where a figure cannot be drawn, one of these files is not what it should be, or the page cannot be written.
pub fn write_report(run: &Run, plots: &Path) -> Result<PathBuf, ReportError> {
    let path = plots.join(REPORT);
    write(&path, html(run, plots)?.as_bytes())?;
    Ok(path)
}

/// The page of a run whose figures lie in `plots`.
fn html(run: &Run, plots: &Path) -> Result<String, ReportError> {
    let place = files::Place::of(run, plots);
    let asked = origin::read(&run.dir)?;
    let sections = [
        Some(verdict::section(run)),
        Some(figures::section(run, plots)?),
        Some(tables::section(run, &place)),
        markdown::section(run),
        Some(origin::parameters(run, asked.as_ref())),
        origin::machines(&run.dir)?,
        Some(files::again(run, asked.is_some())),
        Some(files::section(run, &place)?),
    ];
    let sections: Vec<Section> = sections.into_iter().flatten().collect();
    Ok(page::document(&run.summary, &sections))
}
