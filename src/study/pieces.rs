//! Runs go piece by piece: each is measured as a whole and is on disk before the next begins, so that a run that is stopped at
//! any moment goes on where it was, and so that several machines can share the pieces of one run.
//!
//! A piece is finished when its result and its times are on disk, the times last. What comes out of a run depends on the
//! pieces' results alone, never on who measured them and when.

use std::collections::BTreeMap;
use std::time::Instant;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::machine::machine;
use super::records::{Machine, MachineTimes, RunTimes};
use super::store::{RUN_TIMES, Store, StoreError, TIMINGS};
use super::{RunError, Watcher};

/// What a piece of a run amounts to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extent {
    /// Things of the run's own kind, as it tells them: trees, scenes.
    pub things: usize,
    /// Units of progress.
    pub units: u64,
    /// Lines and rays that go through trees; where a pilot settles that, the fewest.
    pub lines: u64,
    /// A guess at the seconds it takes, on two cores of 2024.
    pub seconds: f64,
    /// A guess at its bytes on disk.
    pub bytes: u64,
}

/// One piece of a run.
pub struct Piece<P> {
    /// Identity, from all that its result and its times depend on.
    pub id: String,
    /// What it is, for people: scene and strategy.
    pub place: String,
    /// How much it is.
    pub extent: Extent,
    /// What is measured.
    pub of: P,
}

impl<P> Piece<P> {
    /// The piece without what is measured.
    pub fn bare(self) -> Piece<()> {
        Piece {
            id: self.id,
            place: self.place,
            extent: self.extent,
            of: (),
        }
    }
}

/// What measuring a piece gives.
pub struct Made<R, T> {
    /// Its result, which is on disk already.
    pub result: R,
    /// Its rows of `timings.csv`, if its kind has any.
    pub times: Vec<T>,
}

impl<R: Default, T> Made<R, T> {
    /// Of a piece in which there is nothing.
    pub fn nothing() -> Self {
        Self {
            result: R::default(),
            times: Vec::new(),
        }
    }
}

impl<R> Made<R, ()> {
    /// A result without rows of `timings.csv`.
    pub fn untimed(result: R) -> Self {
        Self {
            result,
            times: Vec::new(),
        }
    }
}

/// The times of a finished piece, and where it was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound(serialize = "T: Serialize", deserialize = "T: DeserializeOwned"))]
pub struct PieceTimes<T> {
    /// The machine.
    pub machine: Machine,
    /// Wall seconds from its begin to its end.
    pub seconds: f64,
    /// Its rows of `timings.csv`.
    #[serde(with = "as_csv")]
    pub rows: Vec<T>,
}

/// Rows as the text of a CSV file, which has numbers that JSON has not: without bounds.
mod as_csv {
    use serde::de::{DeserializeOwned, Error as _};
    use serde::ser::Error as _;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<T: Serialize, S: Serializer>(rows: &[T], to: S) -> Result<S::Ok, S::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        for row in rows {
            writer.serialize(row).map_err(S::Error::custom)?;
        }
        let bytes = writer.into_inner().map_err(S::Error::custom)?;
        to.serialize_str(&String::from_utf8(bytes).map_err(S::Error::custom)?)
    }

    pub fn deserialize<'de, T, D>(from: D) -> Result<Vec<T>, D::Error>
    where
        T: DeserializeOwned,
        D: Deserializer<'de>,
    {
        let text = String::deserialize(from)?;
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let rows = reader.deserialize().collect::<Result<_, _>>();
        rows.map_err(D::Error::custom)
    }
}

/// The results of all pieces, in their order: those `found` on disk, and those that `measure` makes now and keeps there.
/// `things` is their name in the note on what was found; `announce` is told the pieces that are left, if any are. Writes
/// `timings.csv` and `times-run.json`.
///
/// Gives nothing where the store takes only a share of the pieces: the rest of the run is for whoever has all.
///
/// # Errors
/// If a piece cannot be measured or written; and, where the store takes only what is there, if a piece is missing.
pub fn piece_by_piece<P, R, T: Serialize + DeserializeOwned>(
    store: &Store,
    pieces: &[Piece<P>],
    things: &str,
    watcher: &impl Watcher,
    found: impl Fn(&Piece<P>) -> Option<R>,
    announce: impl FnOnce(&[&Piece<P>]),
    mut measure: impl FnMut(&Piece<P>) -> Result<Made<R, T>, RunError>,
) -> Result<Option<Vec<R>>, RunError> {
    let (own, whole) = own_share(store, pieces);
    let finished = |piece: &Piece<P>| {
        let times = store.times(&piece.id)?;
        found(piece).map(|result| (result, times))
    };
    let found: Vec<Option<(R, PieceTimes<T>)>> = own.iter().map(|piece| finished(piece)).collect();
    let left = || own.iter().zip(&found).filter(|(_, found)| found.is_none());
    let left: Vec<&Piece<P>> = left().map(|(piece, _)| *piece).collect();
    if store.takes_only_what_is_there() && !left.is_empty() {
        let missing = left
            .iter()
            .map(|piece| (piece.id.clone(), piece.place.clone()));
        return Err(RunError::Missing(missing.collect()));
    }
    watcher.expect(own.iter().map(|piece| piece.extent.units).sum());
    let all: usize = own.iter().map(|piece| piece.extent.things).sum();
    let already = all - left.iter().map(|piece| piece.extent.things).sum::<usize>();
    if already > 0 {
        watcher.note(&format!(
            "{already} of {all} {things} were finished by an earlier run (--force measures them again)"
        ));
    }
    if already < all {
        announce(&left);
    }
    let one = |(piece, found): (&&Piece<P>, Option<_>)| match found {
        Some(found) => {
            watcher.skip(piece.extent.units);
            Ok(found)
        }
        None => {
            let started = Instant::now();
            let Made { result, times } = measure(piece)?;
            let times = PieceTimes {
                machine: machine(),
                seconds: started.elapsed().as_secs_f64(),
                rows: times,
            };
            store.keep_times(&piece.id, &times)?;
            Ok::<_, RunError>((result, times))
        }
    };
    let done = own.iter().zip(found).map(one);
    let (results, times): (Vec<R>, Vec<PieceTimes<T>>) =
        done.collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
    if !whole {
        return Ok(None);
    }
    write_times(store, &times)?;
    Ok(Some(results))
}

/// The pieces that this run is to have, and whether these are all.
pub fn own_share<'p, P>(store: &Store, pieces: &'p [Piece<P>]) -> (Vec<&'p Piece<P>>, bool) {
    match store.share() {
        Some(share) => {
            let own = pieces.iter().enumerate();
            let own = own.filter(|(number, _)| share.has(*number));
            (own.map(|(_, piece)| piece).collect(), false)
        }
        None => (pieces.iter().collect(), true),
    }
}

/// Write `timings.csv`, where there are rows for it, and `times-run.json`.
fn write_times<T: Serialize>(store: &Store, times: &[PieceTimes<T>]) -> Result<(), StoreError> {
    let mut rows = times.iter().flat_map(|piece| &piece.rows).peekable();
    if rows.peek().is_some() {
        store.write_rows(TIMINGS, rows)?;
    } else {
        store.remove(TIMINGS)?;
    }
    store.write_json(RUN_TIMES, &run_times(times))
}

/// Where and how long a run was measured.
fn run_times<T>(times: &[PieceTimes<T>]) -> RunTimes {
    let mut run = RunTimes::default();
    let mut places = BTreeMap::new();
    for PieceTimes {
        machine, seconds, ..
    } in times
    {
        let next = run.machines.len();
        // All that tells machines apart, as one text.
        let place = *places.entry(format!("{machine:?}")).or_insert(next);
        if place == next {
            run.machines.push(MachineTimes {
                machine: machine.clone(),
                pieces: 0,
                seconds: 0.0,
            });
        }
        run.machines[place].pieces += 1;
        run.machines[place].seconds += seconds;
        run.seconds += seconds;
    }
    run
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_without_bounds_are_kept() {
        let times = PieceTimes {
            machine: machine(),
            seconds: 0.1 + 0.2,
            rows: vec![row(f64::INFINITY, "a,\"b\""), row(-0.0, "\n")],
        };
        let text = serde_json::to_string(&times).expect("written");
        let read: PieceTimes<Row> = serde_json::from_str(&text).expect("read");
        assert_eq!(read, times);
    }

    fn row(x: f64, text: &str) -> Row {
        let text = text.into();
        Row { x, text }
    }

    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    struct Row {
        x: f64,
        text: String,
    }

    #[test]
    fn machines_are_told_apart() {
        let piece = |threads: u64, seconds: f64| PieceTimes::<()> {
            machine: Machine {
                threads,
                ..machine()
            },
            seconds,
            rows: vec![],
        };
        let run = run_times(&[piece(1, 0.5), piece(2, 1.0), piece(1, 0.25)]);
        assert_eq!(run.seconds, 1.75);
        let told = run.machines.iter();
        let told: Vec<_> = told
            .map(|m| (m.machine.threads, m.pieces, m.seconds))
            .collect();
        assert_eq!(told, [(1, 2, 0.75), (2, 1, 1.0)]);
    }
}
