//! One machine's share of a run's pieces: every N-th, from the I-th on.

use std::fmt;
use std::str::FromStr;

/// Share I of N: pieces I, I + N, I + 2 N, … in the canonical order of the run's pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Share {
    /// From 1 to `of`.
    index: usize,
    of: usize,
}

/// Most shares of a run.
const MOST: usize = 10_000;

impl Share {
    /// Share `index`, from 1, of so many.
    ///
    /// # Errors
    /// If there is no such share; the message says what would be right.
    pub fn new(index: usize, of: usize) -> Result<Self, String> {
        if (1..=of).contains(&index) && of <= MOST {
            return Ok(Self { index, of });
        }
        Err(format!(
            "there is no share {index}/{of}; expected I/N with I from 1 to N, and N at most {MOST}"
        ))
    }

    /// Whether it has the piece of this number, from 0.
    pub fn has(&self, number: usize) -> bool {
        number % self.of == self.index - 1
    }

    /// Its number, from 1.
    pub fn index(&self) -> usize {
        self.index
    }

    /// How many there are.
    pub fn of(&self) -> usize {
        self.of
    }

    /// The name of its folder: `2-of-6`.
    pub fn folder(&self) -> String {
        format!("{}-of-{}", self.index, self.of)
    }

    /// The share of a task of a Slurm job array, from the variables that Slurm sets: `SLURM_ARRAY_TASK_ID`, `_MIN`, `_MAX`, `_STEP`
    /// and `_COUNT`.
    ///
    /// # Errors
    /// If one of them is missing or no number, or if the numbers of the tasks have gaps, so that some shares would have no task.
    pub fn of_slurm(variable: impl Fn(&str) -> Option<String>) -> Result<Self, String> {
        let number = |part: &str| {
            let name = format!("SLURM_ARRAY_TASK_{part}");
            let text = variable(&name).ok_or_else(|| {
                format!(
                    "{name} is not set, so this is no task of a Slurm job array; give --shard I/N"
                )
            })?;
            text.parse::<usize>()
                .map_err(|_| format!("{name} is '{text}', expected a number"))
        };
        let [id, min, max, count] = ["ID", "MIN", "MAX", "COUNT"].map(number);
        let (id, min, max, count) = (id?, min?, max?, count?);
        let step = number("STEP").unwrap_or(1).max(1);
        let even =
            (min..=max).contains(&id) && (id - min) % step == 0 && (max - min) / step + 1 == count;
        if !even {
            return Err(format!(
                "the tasks of the job array ({count} from {min} to {max}) are not numbered evenly; expected --array=1-N"
            ));
        }
        Self::new((id - min) / step + 1, count)
    }
}

impl fmt::Display for Share {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.of)
    }
}

impl FromStr for Share {
    type Err = String;

    /// From `I/N`.
    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/');
        let parts = parts.and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        let (index, of) = parts.ok_or("expected I/N, e.g. 2/6")?;
        Self::new(index, of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_part_the_pieces() {
        for of in [1, 2, 6, 7] {
            let shares = (1..=of).map(|index| Share::new(index, of).expect("a share"));
            let shares: Vec<_> = shares.collect();
            for number in 0..20 {
                assert_eq!(shares.iter().filter(|share| share.has(number)).count(), 1);
            }
        }
        assert_eq!(
            "2/6".parse::<Share>().map(|s| s.folder()),
            Ok("2-of-6".into())
        );
        for wrong in ["0/6", "7/6", "1/0", "1", "a/b", "-1/2", "1/99999", ""] {
            assert!(wrong.parse::<Share>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_task_of_an_array_is_a_share() {
        let task = |id: &'static str,
                    min: &'static str,
                    max: &'static str,
                    step: &'static str,
                    count: &'static str| {
            Share::of_slurm(move |name| {
                let text = match name.strip_prefix("SLURM_ARRAY_TASK_")? {
                    "ID" => id,
                    "MIN" => min,
                    "MAX" => max,
                    "STEP" => step,
                    "COUNT" => count,
                    _ => return None,
                };
                (!text.is_empty()).then(|| text.to_owned())
            })
        };
        assert_eq!(task("2", "1", "6", "1", "6"), Share::new(2, 6));
        assert_eq!(task("0", "0", "5", "", "6"), Share::new(1, 6));
        assert_eq!(task("20", "10", "30", "10", "3"), Share::new(2, 3));
        for wrong in [
            task("", "1", "6", "1", "6"),
            task("x", "1", "6", "1", "6"),
            task("3", "1", "7", "1", "3"),
            task("9", "1", "6", "1", "6"),
        ] {
            assert!(wrong.is_err(), "{wrong:?}");
        }
    }
}
