//! Runs go piece by piece, and keep what an earlier run has finished.

use super::{RunError, Watcher};

/// What a piece of a run amounts to.
#[derive(Clone, Copy)]
pub struct Extent {
    /// Things of the run's own kind, as it tells them: trees, scenes.
    pub things: usize,
    /// Units of progress.
    pub units: u64,
}

/// The results of all pieces, in their order: those `found`, and those that `measure` makes now. `things` is their name in
/// the note on what was found; `announce` is told the pieces that are left, if any are.
pub fn piece_by_piece<P, R>(
    pieces: &[P],
    found: Vec<Option<R>>,
    extent: impl Fn(&P) -> Extent,
    things: &str,
    watcher: &impl Watcher,
    announce: impl FnOnce(&[&P]),
    mut measure: impl FnMut(&P) -> Result<R, RunError>,
) -> Result<Vec<R>, RunError> {
    watcher.expect(pieces.iter().map(|piece| extent(piece).units).sum());
    let both = || pieces.iter().zip(&found);
    let left = both().filter(|(_, found)| found.is_none());
    let left: Vec<&P> = left.map(|(piece, _)| piece).collect();
    let all: usize = pieces.iter().map(|piece| extent(piece).things).sum();
    let already = all - left.iter().map(|piece| extent(piece).things).sum::<usize>();
    if already > 0 {
        watcher.note(&format!(
            "{already} of {all} {things} were finished by an earlier run (--force measures them again)"
        ));
    }
    if already < all {
        announce(&left);
    }
    let one = |(piece, found): (&P, Option<R>)| match found {
        Some(found) => {
            watcher.skip(extent(piece).units);
            Ok(found)
        }
        None => measure(piece),
    };
    pieces.iter().zip(found).map(one).collect()
}
