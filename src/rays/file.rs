//! Rays of a user's own, from a file: `.csv` with a header, or `.npy` as NumPy writes it.
//!
//! A row is a ray: origin, direction, and where it ends (`tmax`; blank, infinite or left out: nowhere). It begins at t = 0.
//! The direction need not have unit length: t counts in units of it. Numbers are kept to the bit, so both forms of the same
//! rays are the same rays.

mod csv;
mod npy;

use std::fmt;
use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::ops::RangeInclusive;
use std::path::Path;

use glam::DVec3;

use crate::geom::{Cast, Span};
use crate::scene::quotable;

/// The columns, in this order; the last may be left out.
pub const COLUMNS: [&str; 7] = ["ox", "oy", "oz", "dx", "dy", "dz", "tmax"];

/// Lengths of a direction's largest part that are understood: its square, that of its reciprocal and products with squares
/// of coordinates stay within f64. A smaller part beside it may have any size: where its reciprocal overflows the ray
/// counts as parallel (see [`Line::is_parallel`](crate::geom::Line::is_parallel)).
pub const LENGTHS: RangeInclusive<f64> = 1e-50..=1e50;

/// Why a file gives no rays: each message says where, what is wrong, and what would be right.
#[derive(Debug, thiserror::Error)]
pub enum RayFileError {
    /// The file cannot be opened or read.
    #[error("{path}: cannot read the file")]
    Read {
        /// The file.
        path: String,
        /// Why.
        #[source]
        source: io::Error,
    },
    /// What stands in it is no set of rays.
    #[error("{place}: {fault}")]
    Content {
        /// The file, with the line (`.csv`, counted from 1) or row (`.npy`, counted from 0) where there is one.
        place: String,
        /// What is wrong.
        fault: Fault,
    },
}

/// What is wrong, and what would be right.
#[derive(Debug, PartialEq)]
pub struct Fault {
    wrong: String,
    right: String,
}

impl Fault {
    /// `wrong` may quote the file.
    fn new(wrong: impl AsRef<str>, right: impl Into<String>) -> Self {
        Self {
            wrong: quotable(wrong.as_ref()),
            right: right.into(),
        }
    }

    /// A file without a single ray.
    fn no_rays() -> Self {
        Self::new("there are no rays in it", "expected at least one")
    }

    fn at(self, place: String) -> RayFileError {
        RayFileError::Content { place, fault: self }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {}", self.wrong, self.right)
    }
}

/// The rays of a file, in its order; at least one.
///
/// # Errors
/// If the file cannot be read, is of another kind, is damaged, or has a row that is no ray.
pub fn read(path: &Path) -> Result<Vec<Cast>, RayFileError> {
    let name = path.display().to_string();
    let reader = reader(&name)?;
    let file = File::open(path);
    let file = file.map_err(|source| unread(&name, source))?;
    reader(&name, &mut BufReader::new(file))
}

/// As [`read`], of a file's contents; its name tells the form and stands in errors.
///
/// # Errors
/// As those of [`read`].
pub fn parse(name: &str, mut contents: impl BufRead) -> Result<Vec<Cast>, RayFileError> {
    reader(name)?(name, &mut contents)
}

/// Reads the contents of a file of this name.
type Parse = fn(&str, &mut dyn BufRead) -> Result<Vec<Cast>, RayFileError>;

/// What reads files that end like this one.
fn reader(name: &str) -> Result<Parse, RayFileError> {
    let extension = Path::new(name).extension();
    let extension = extension.map(|e| e.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("csv") => Ok(csv::parse),
        Some("npy") => Ok(|name, contents| {
            let mut bytes = Vec::new();
            let read = contents.read_to_end(&mut bytes);
            read.map_err(|source| unread(name, source))?;
            npy::parse(name, &bytes)
        }),
        _ => {
            let right = "expected a file ending in .csv or .npy";
            Err(Fault::new("is no file of rays", right).at(name.into()))
        }
    }
}

fn unread(name: &str, source: io::Error) -> RayFileError {
    RayFileError::Read {
        path: name.into(),
        source,
    }
}

/// The ray of a row: six numbers, and where it ends.
fn cast(parts: [f64; 6], tmax: f64) -> Result<Cast, Fault> {
    if let Some(i) = parts.iter().position(|part| !part.is_finite()) {
        let wrong = format!("{} is {}", COLUMNS[i], parts[i]);
        return Err(Fault::new(wrong, "it must be a finite number"));
    }
    if tmax.is_nan() || tmax < 0.0 {
        let right = "it must be 0 or more; blank or inf for a ray without end";
        return Err(Fault::new(format!("tmax is {tmax}"), right));
    }
    let [origin, direction] = [0, 3].map(|i| DVec3::new(parts[i], parts[i + 1], parts[i + 2]));
    let length = direction.abs().max_element();
    if length == 0.0 {
        let right = "at least one of dx, dy and dz must not be zero";
        return Err(Fault::new("the direction is zero", right));
    }
    if !LENGTHS.contains(&length) {
        let wrong = format!("the largest part of the direction is {length:e}");
        let right = format!(
            "it must lie within {:e} to {:e}: scale the direction; tmax counts in units of it",
            LENGTHS.start(),
            LENGTHS.end()
        );
        return Err(Fault::new(wrong, right));
    }
    let span = Span { t0: 0.0, t1: tmax };
    Ok(Cast {
        origin,
        direction,
        span,
    })
}

#[cfg(test)]
mod tests;
