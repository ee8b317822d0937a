//! What can be wrong with an experiment, and where.

use std::path::PathBuf;

use thiserror::Error;

use crate::scene::quotable;

/// A value that makes no sense.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{message}")]
pub struct Wrong {
    /// Its key in the file, with dots between tables and keys.
    pub key: &'static str,
    /// What is wrong, and what would be right.
    pub message: String,
}

/// An error for this key, unless it is right.
pub(in crate::study) fn wrong_unless(
    right: bool,
    key: &'static str,
    message: impl FnOnce() -> String,
) -> Result<(), Wrong> {
    if right {
        return Ok(());
    }
    let message = message();
    Err(Wrong { key, message })
}

/// Why an experiment cannot be run.
#[derive(Debug, Error)]
pub enum PlanError {
    /// The file cannot be read.
    #[error("{path}: cannot read the experiment", path = path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The file is not what an experiment looks like.
    #[error("{path}:{line}:{column}: {message}")]
    Syntax {
        /// The file.
        path: String,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong, and what would be right.
        message: String,
    },
    /// A value that stands nowhere in the file makes no sense.
    #[error("{path}: {message}")]
    Value {
        /// The file, or the option of the command line.
        path: String,
        /// What is wrong, and what would be right.
        message: String,
    },
}

impl PlanError {
    /// A fault at a byte of a file's text.
    pub(in crate::study) fn at(text: &str, path: &str, offset: usize, message: String) -> Self {
        let before = &text[..offset.min(text.len())];
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        Self::Syntax {
            path: path.into(),
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
            message: quotable(&message),
        }
    }
}

/// What is wrong with a table.
pub(super) enum Fault {
    Toml(toml::de::Error),
    Value(Wrong),
    At(usize, String),
}

impl From<toml::de::Error> for Fault {
    fn from(error: toml::de::Error) -> Self {
        Self::Toml(error)
    }
}
