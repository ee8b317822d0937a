//! Outcomes of hard cases, counted.

use crate::study::records::CaseRecord;

/// What came of a case, as files name it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// As expected.
    Pass,
    /// Off by so much.
    Off,
    /// Refused, where an answer is expected.
    Refused,
    /// Wrong.
    Failed,
}

impl Outcome {
    /// All of them, from good to bad.
    pub const ALL: [Self; 4] = [Self::Pass, Self::Off, Self::Refused, Self::Failed];

    /// Of a row; what has another name counts as failed.
    pub fn of(row: &CaseRecord) -> Self {
        let named = |outcome: &Self| outcome.name() == row.outcome;
        Self::ALL.into_iter().find(named).unwrap_or(Self::Failed)
    }

    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Off => "off",
            Self::Refused => "refused",
            Self::Failed => "failed",
        }
    }
}

/// How often each outcome came, and how far the worst is off.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// How often, in the order of [`Outcome::ALL`].
    pub counts: [u64; 4],
    /// The largest `off`.
    pub worst: Option<f64>,
}

impl Tally {
    /// Of these rows.
    pub fn of<'r>(rows: impl IntoIterator<Item = &'r CaseRecord>) -> Self {
        let mut tally = Self::default();
        for row in rows {
            tally.counts[Outcome::of(row) as usize] += 1;
            if let Some(off) = row.off.filter(|off| !off.is_nan()) {
                tally.worst = Some(tally.worst.map_or(off, |worst| worst.max(off)));
            }
        }
        tally
    }

    /// Whether there was any.
    pub fn is_empty(&self) -> bool {
        self.counts == [0; 4]
    }
}

/// Whether a row is demanded and neither passes nor is off by what is allowed.
pub fn missed(row: &CaseRecord) -> bool {
    row.demanded && !matches!(Outcome::of(row), Outcome::Pass | Outcome::Off)
}

/// A kernel's heading; a case that depends on none is checked once.
pub fn kernel_words(kernel: &str) -> &str {
    match kernel {
        "" => "once",
        kernel => kernel,
    }
}
