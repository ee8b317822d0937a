//! Rays as comma-separated values: plain numbers, so a line is a row and a comma parts two fields. Spaces around them and
//! blank lines are passed over.

use std::io::BufRead;

use super::{COLUMNS, Fault, RayFileError, cast, unread};
use crate::geom::Cast;

/// The rays of a file's text; `name` names it in errors.
pub(super) fn parse(name: &str, text: &mut dyn BufRead) -> Result<Vec<Cast>, RayFileError> {
    let mut wanted = None;
    let mut casts = Vec::new();
    for (i, line) in text.split(b'\n').enumerate() {
        let line = line.map_err(|source| unread(name, source))?;
        let at = |fault: Fault| fault.at(format!("{name}:{}", i + 1));
        let line = std::str::from_utf8(&line);
        let line = line.map_err(|_| at(Fault::new("not UTF-8", "expected text")))?;
        let line = line.trim_start_matches('\u{feff}').trim();
        match wanted {
            None => wanted = Some(fields_of_header(line).map_err(at)?),
            Some(_) if line.is_empty() => {}
            Some(wanted) => casts.push(ray(line, wanted).map_err(at)?),
        }
    }
    if casts.is_empty() {
        let empty = wanted.is_none().then(|| wrong_header("the file is empty"));
        return Err(empty.unwrap_or_else(Fault::no_rays).at(name.into()));
    }
    Ok(casts)
}

/// How many fields a row has, by the header.
fn fields_of_header(line: &str) -> Result<usize, Fault> {
    let columns: Vec<&str> = line.split(',').map(str::trim).collect();
    match columns.len() {
        n @ (6 | 7) if columns == COLUMNS[..n] => Ok(n),
        _ => Err(wrong_header(format!("the header is '{line}'"))),
    }
}

fn wrong_header(wrong: impl AsRef<str>) -> Fault {
    let [without, with] = [6, 7].map(|n| COLUMNS[..n].join(","));
    Fault::new(wrong, format!("expected '{without}' or '{with}'"))
}

fn ray(line: &str, wanted: usize) -> Result<Cast, Fault> {
    let fields: Vec<&str> = line.split(',').map(str::trim).collect();
    if fields.len() != wanted {
        let s = if fields.len() == 1 { "" } else { "s" };
        let wrong = format!("{} field{s}", fields.len());
        let right = format!("expected {wanted}, as in the header");
        return Err(Fault::new(wrong, right));
    }
    let mut parts = [0.0; 6];
    for ((part, column), text) in parts.iter_mut().zip(COLUMNS).zip(&fields) {
        *part = number(column, text)?;
    }
    let tmax = match fields.get(6) {
        None | Some(&"") => f64::INFINITY,
        Some(text) => number(COLUMNS[6], text)?,
    };
    cast(parts, tmax)
}

fn number(column: &str, text: &str) -> Result<f64, Fault> {
    text.parse().map_err(|_| {
        let wrong = format!("{column} is '{text}'");
        Fault::new(wrong, "expected a number such as -1.5 or 2e-3")
    })
}
