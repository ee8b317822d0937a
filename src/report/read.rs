//! Reading the data directory of a finished run.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

use super::ReportError;
use super::assumptions::Assumptions;
use super::cost_vs_work::CostVsWork;
use super::hits::Hits;
use super::speed_vs_error::SpeedVsError;
use super::split_cost::SplitCost;
use super::stability::Stability;
use super::strategies::Strategies;
use super::termination::Termination;
use super::traversal::Traversal;
use crate::study::records::{SCHEMA, Summary, Verdict};

/// What a finished run left behind.
#[derive(Clone, Debug)]
pub struct Run {
    /// The directory it was read from.
    pub dir: PathBuf,
    /// `summary.json`.
    pub summary: Summary,
    /// The other files.
    pub content: Content,
}

/// The files of a run, by its kind.
#[derive(Clone, Debug)]
pub enum Content {
    /// Kind `hits-vs-area`.
    Hits(Hits),
    /// Kind `strategies`.
    Strategies(Strategies),
    /// Kind `termination`.
    Termination(Termination),
    /// Kind `split-cost`.
    SplitCost(SplitCost),
    /// Kind `cost-vs-work`.
    CostVsWork(CostVsWork),
    /// Kind `assumptions`.
    Assumptions(Assumptions),
    /// Kind `speed-vs-error`.
    SpeedVsError(SpeedVsError),
    /// Kind `stability`.
    Stability(Stability),
    /// Kind `traversal`.
    Traversal(Traversal),
}

impl Run {
    /// Whether every expectation held, of counts and of seconds.
    pub fn held(&self) -> bool {
        self.verdicts().all(|v| v.held)
    }

    /// All expectations and what came of them: of counts, then of seconds.
    pub fn verdicts(&self) -> impl Iterator<Item = &Verdict> {
        let times: &[Verdict] = match &self.content {
            Content::CostVsWork(trees) => &trees.time_verdicts.verdicts,
            _ => &[],
        };
        self.summary.verdicts.iter().chain(times)
    }

    /// The files of a run of kind `hits-vs-area`.
    pub fn hits(&self) -> Option<&Hits> {
        match &self.content {
            Content::Hits(hits) => Some(hits),
            _ => None,
        }
    }
}

/// Reads `summary.json` and the files that a run of its kind has.
///
/// ```
/// use sahlab::report::read_run;
///
/// let run = read_run("data/published/figure3".as_ref())?;
/// assert!(run.held() && !run.summary.quick);
/// let names: Vec<_> = run.verdicts().map(|verdict| verdict.name.as_str()).collect();
/// assert!(names.contains(&"slopes-cover"), "{names:?}");
/// # Ok::<(), sahlab::report::ReportError>(())
/// ```
pub fn read_run(dir: &Path) -> Result<Run, ReportError> {
    let path = dir.join("summary.json");
    let file = open(&path)?;
    let not_json = |source| ReportError::Json {
        path: path.clone(),
        source,
    };
    let value: serde_json::Value =
        serde_json::from_reader(io::BufReader::new(file)).map_err(not_json)?;
    if let Some(layout) = value["schema"].as_u64().filter(|&n| n != u64::from(SCHEMA)) {
        return Err(ReportError::Empty {
            what: format!(
                "{}: of layout {layout}, but this program reads {SCHEMA}; run the experiment again",
                path.display()
            ),
        });
    }
    let summary: Summary = serde_json::from_value(value).map_err(not_json)?;
    let content = match summary.kind.as_str() {
        "hits-vs-area" => Content::Hits(Hits::read(dir)?),
        "strategies" => Content::Strategies(Strategies::read(dir)?),
        "termination" => Content::Termination(Termination(Strategies::read(dir)?)),
        "split-cost" => Content::SplitCost(SplitCost::read(dir)?),
        "cost-vs-work" => Content::CostVsWork(CostVsWork::read(dir)?),
        "assumptions" => Content::Assumptions(Assumptions::read(dir)?),
        "speed-vs-error" => Content::SpeedVsError(SpeedVsError::read(dir)?),
        "stability" => Content::Stability(Stability::read(dir)?),
        "traversal" => Content::Traversal(Traversal::read(dir)?),
        other => {
            return Err(ReportError::Empty {
                what: format!("{}: unknown kind of run '{other}'", path.display()),
            });
        }
    };
    Ok(Run {
        dir: dir.to_owned(),
        summary,
        content,
    })
}

/// The rows of a file that must have some.
pub(super) fn rows_of<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>, ReportError> {
    let rows = rows(path, open(path)?)?;
    if rows.is_empty() {
        return Err(ReportError::Empty {
            what: format!("{}: no rows", path.display()),
        });
    }
    Ok(rows)
}

fn open(path: &Path) -> Result<File, ReportError> {
    File::open(path).map_err(|source| ReportError::Read {
        path: path.to_owned(),
        source,
    })
}

pub(super) fn optional_rows<T: DeserializeOwned>(
    path: &Path,
) -> Result<Option<Vec<T>>, ReportError> {
    match File::open(path) {
        Ok(file) => rows(path, file).map(Some),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(source) => Err(ReportError::Read {
            path: path.to_owned(),
            source,
        }),
    }
}

fn rows<T: DeserializeOwned>(path: &Path, file: File) -> Result<Vec<T>, ReportError> {
    let mut reader = csv::Reader::from_reader(file);
    let header = reader
        .headers()
        .map_err(|error| row_error(path, None, error))?
        .clone();
    reader
        .deserialize()
        .map(|row| row.map_err(|error| row_error(path, Some(&header), error)))
        .collect()
}

/// Names the line, and the column by its heading.
fn row_error(path: &Path, header: Option<&csv::StringRecord>, error: csv::Error) -> ReportError {
    let line = error.position().map_or(1, csv::Position::line);
    let what = match error.kind() {
        csv::ErrorKind::Deserialize { err, .. } => {
            let column = err.field().and_then(|field| header?.get(field as usize));
            match column {
                Some(column) => format!("column {column}: {}", err.kind()),
                None => err.kind().to_string(),
            }
        }
        csv::ErrorKind::UnequalLengths {
            expected_len, len, ..
        } => {
            format!("{len} fields where the header has {expected_len}")
        }
        _ => error.to_string(),
    };
    ReportError::Row {
        path: path.to_owned(),
        line,
        what,
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::study::records::TimingRecord;

    fn fault(text: &str) -> String {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("timings.csv");
        fs::write(&path, text).unwrap();
        let error = rows::<TimingRecord>(&path, open(&path).unwrap())
            .unwrap_err()
            .to_string();
        error.replace(&path.display().to_string(), "timings.csv")
    }

    #[test]
    fn a_fault_names_file_line_and_column() {
        let header = "cell,scene,strategy,build_s,count_s,threads,visits\n";
        let good = "a,b,c,1,2,3,4\n";
        assert_eq!(
            fault(&format!("{header}{good}a,b,c,1,x,3,4\n")),
            "timings.csv, line 3: column count_s: invalid float literal"
        );
        assert_eq!(
            fault(&format!("{header}a,b,c\n")),
            "timings.csv, line 2: 3 fields where the header has 7"
        );
        assert!(fault("cell,scene\na,b\n").starts_with("timings.csv, line 2: missing field"));
    }

    #[test]
    fn a_missing_directory_is_named() {
        let error = read_run(Path::new("no/such/run")).unwrap_err().to_string();
        assert_eq!(error, "no/such/run/summary.json: cannot read");
    }
}
