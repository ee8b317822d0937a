//! What is expected of kernels: f64 errs at ties alone, a padded kernel misses no node at all.

use crate::study::kernel::Kernel;
use crate::study::records::{PrecisionRecord, Verdict};

use super::super::Found;
use super::super::asked::SpeedVsError;

/// What came of the expectations of the kernels that were asked for.
pub fn verdicts(asked: &SpeedVsError, found: &[Found]) -> Vec<Verdict> {
    let kernels = asked.precision.as_ref().map_or(&[][..], |p| &p.kernels);
    let rows: Vec<&PrecisionRecord> = found.iter().flat_map(|f| &f.precision).collect();
    let mut all = Vec::new();
    if kernels.contains(&Kernel::F64) {
        all.push(exact(&rows));
    }
    if kernels.contains(&Kernel::F32Padded) {
        all.push(padded(&rows));
    }
    all
}

/// The sum over the rows of a kernel.
fn of(rows: &[&PrecisionRecord], kernel: Kernel, value: fn(&PrecisionRecord) -> u64) -> u64 {
    let own = rows.iter().filter(|r| r.kernel == kernel.name());
    own.map(|r| value(r)).sum()
}

fn exact(rows: &[&PrecisionRecord]) -> Verdict {
    let of = |value| of(rows, Kernel::F64, value);
    let wrong = of(|r| r.wrong_visits + r.missed_visits);
    let hits = of(|r| r.wrong_hits + r.missed_hits);
    Verdict {
        name: "f64-exact".into(),
        held: wrong == 0 && hits == 0,
        message: format!(
            "f64 against exact integers: {wrong} of {} visits and {hits} of {} triangle tests wrong by more than 8 ulp; {} and {} at \
             ties",
            of(|r| r.visits),
            of(|r| r.tests),
            of(|r| r.tied_visits),
            of(|r| r.tied_hits),
        ),
    }
}

/// Ties count: boxes are padded for them.
pub(super) fn padded(rows: &[&PrecisionRecord]) -> Verdict {
    let of = |value| of(rows, Kernel::F32Padded, value);
    let missed = of(|r| r.missed_visits + r.tied_missed_visits);
    Verdict {
        name: "padded".into(),
        held: missed == 0,
        message: format!(
            "f32, padded: {missed} of {} visits missed, ties included",
            of(|r| r.visits)
        ),
    }
}
