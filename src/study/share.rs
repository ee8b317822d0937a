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

    /// The share of a task of a Slurm job array, from the variables that Slurm sets: the number of the task,
    /// `SLURM_ARRAY_TASK_ID`, of so many from 1 on. Where it is not told how many, the array must be whole, of the tasks 1 to N
    /// or 0 to N - 1 (`_MIN`, `_MAX`, `_COUNT`).
    ///
    /// # Errors
    /// If one of them is missing or no number; if there is no such share; if the tasks are not all of an array, as when some of
    /// them are submitted again: they would divide the run in another way. The message says what would be right.
    pub fn of_slurm(
        of: Option<usize>,
        variable: impl Fn(&str) -> Option<String>,
    ) -> Result<Self, String> {
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
        let id = number("ID")?;
        if let Some(of) = of {
            return Self::new(id, of);
        }
        let [min, max, count] = ["MIN", "MAX", "COUNT"].map(number);
        let (min, max, count) = (min?, max?, count?);
        let whole = min <= 1 && (min..=max).contains(&id) && max - min + 1 == count;
        // An array of one task may as well be the part of another that is submitted again.
        if !whole || count == 1 {
            return Err(format!(
                "the tasks of the job array ({count}, from {min} to {max}) may be a part of another; expected --array=1-N, or \
                 --shard auto/N with N the shards there are"
            ));
        }
        Self::new(id - min + 1, count)
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
        let parts = parts.and_then(|(i, n)| Some((plain_number(i)?, plain_number(n)?)));
        let (index, of) = parts.ok_or("expected I/N, e.g. 2/6")?;
        Self::new(index, of)
    }
}

/// A number of digits alone, without a leading zero: one way to write each.
pub fn plain_number(text: &str) -> Option<usize> {
    let number: usize = text.parse().ok()?;
    (number.to_string() == text).then_some(number)
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
        for wrong in [
            "0/6", "7/6", "1/0", "1", "a/b", "-1/2", "1/99999", "", "+1/2", "01/2", "1/2/3", " 1/2",
        ] {
            assert!(wrong.parse::<Share>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_task_of_an_array_is_a_share() {
        let task = |of, [id, min, max, count]: [&'static str; 4]| {
            Share::of_slurm(of, move |name| {
                let text = match name.strip_prefix("SLURM_ARRAY_TASK_")? {
                    "ID" => id,
                    "MIN" => min,
                    "MAX" => max,
                    "COUNT" => count,
                    _ => return None,
                };
                (!text.is_empty()).then(|| text.to_owned())
            })
        };
        assert_eq!(task(None, ["2", "1", "6", "6"]), Share::new(2, 6));
        assert_eq!(task(None, ["0", "0", "5", "6"]), Share::new(1, 6));
        // A part of an array, submitted again.
        assert_eq!(task(Some(6), ["3", "3", "3", "1"]), Share::new(3, 6));
        for parts in [
            ["", "1", "6", "6"],
            ["x", "1", "6", "6"],
            ["3", "1", "7", "3"],
            ["9", "1", "6", "6"],
            ["3", "3", "3", "1"],
            ["1", "1", "1", "1"],
            ["3", "2", "4", "3"],
            ["1", "1", "x", "6"],
        ] {
            let wrong = task(None, parts);
            assert!(wrong.is_err(), "{wrong:?}");
        }
        for id in ["0", "7", ""] {
            let wrong = task(Some(6), [id, "0", "7", "8"]);
            assert!(wrong.is_err(), "{wrong:?}");
        }
    }
}
