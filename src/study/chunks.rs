//! Which rays of a set are timed.

use std::ops::Range;

use super::records::RUN;
use super::timing::CHUNK;

/// The chunks of a set of so many rays that are timed: runs of rays in the middle of equal parts of the set, about `wanted` rays
/// and at least one run.
pub fn spread(rays: usize, wanted: usize) -> Vec<Range<usize>> {
    let cut = |run: Range<usize>| {
        let end = run.end;
        run.step_by(CHUNK)
            .map(move |start| start..(start + CHUNK).min(end))
    };
    let wanted = wanted.max(RUN);
    if wanted >= rays {
        return cut(0..rays).collect();
    }
    let all = rays / RUN;
    let runs = (wanted / RUN).min(all);
    let run = |number: usize| {
        let start = (2 * number + 1) * all / (2 * runs) * RUN;
        start..start + RUN
    };
    (0..runs).map(run).flat_map(cut).collect()
}
