//! The constants, and which of them the times can tell apart.

use super::super::CostVsWork;
use crate::report::number::{decimals_for, digits_for, fixed};
use crate::report::series::distinct;
use crate::report::shown::{known, percent, text};
use crate::report::table::{Cell, Column, Table};
use crate::study::records::ConstantRecord;

/// Variance inflation above which a constant is not told apart from the others.
const INFLATED: f64 = 10.0;

/// Digits of a constant without an interval.
const DIGITS: usize = 2;

/// Decimals that the interval of a constant supports: those of two digits of half of it.
fn decimals(constant: &ConstantRecord) -> usize {
    match constant.lo.zip(constant.hi) {
        Some((lo, hi)) if hi > lo => decimals_for(0.5 * (hi - lo)),
        _ => digits_for(constant.ns, DIGITS),
    }
}

/// A constant with its interval, in words: "17.0 ns (13.8 to 20.0)".
pub fn interval(constant: &ConstantRecord) -> String {
    let show = |ns: f64| fixed(ns, decimals(constant));
    let ends = constant.lo.zip(constant.hi);
    let ends = ends.map_or(String::new(), |(lo, hi)| {
        format!(" ({} to {})", show(lo), show(hi))
    });
    format!("{} ns{ends}", show(constant.ns))
}

/// How far the intervals are to be believed.
pub const INTERVALS: &str = "given these terms; of few groups of scenes, so rather too short";

/// Whether the other terms of its model leave a constant to be told.
pub fn identified(constant: &ConstantRecord) -> bool {
    constant.inflation.is_some_and(|by| by <= INFLATED)
}

/// A constant's variance inflation, in words.
pub fn inflation(constant: &ConstantRecord) -> String {
    let infinite = || "without end".to_owned();
    constant.inflation.map_or_else(infinite, |by| fixed(by, 1))
}

/// A sentence on the constants of all models that cannot be told apart; `None` where all can.
pub fn unidentified(run: &CostVsWork) -> Option<String> {
    let models = distinct(run.constants.iter().map(|c| c.model.as_str()));
    let of = |model: &str| {
        let own = run.constants.iter().filter(|c| c.model == model);
        let own = own.filter(|c| !identified(c));
        let terms: Vec<String> = own
            .map(|c| format!("{} {}", c.term, inflation(c)))
            .collect();
        (!terms.is_empty()).then(|| format!("of the model {model}: {}", terms.join("; ")))
    };
    let found: Vec<String> = models.into_iter().filter_map(of).collect();
    (!found.is_empty()).then(|| {
        format!(
            "Not separately identified, with a variance inflation above {}, are {}.",
            fixed(INFLATED, 0),
            found.join("; and ")
        )
    })
}

/// What the terms mean, for captions.
pub const TERMS: &str = "Mispredicted branches and cache misses are those of a simulated branch predictor and of simulated \
                         caches. Near: the ray crosses the object's own box. Far memory: times the doublings of the memory \
                         of tree and objects above 4 MiB.";

/// The constants that are wanted.
pub fn constants(run: &CostVsWork, wanted: impl Fn(&&ConstantRecord) -> bool) -> Table {
    let row = |c: &ConstantRecord| {
        let show = |ns: f64| Cell::Value(ns, decimals(c));
        vec![
            text(&c.model),
            text(&c.term),
            show(c.ns),
            known(c.lo, show),
            known(c.hi, show),
            known(c.inflation, |inflation| Cell::Value(inflation, 1)),
            percent(c.share),
        ]
    };
    let rows: Vec<_> = run.constants.iter().filter(wanted).map(row).collect();
    let remark = unidentified(run).map_or(String::new(), |remark| format!(" {remark}"));
    Table {
        caption: format!(
            "Nanoseconds of one of each term, fitted to all scenes (non-negative least squares of relative errors), with the 95 % \
             interval of a bootstrap over groups of scenes ({INTERVALS}); inflation: by how much the other terms widen its \
             variance; share: of the predicted time, mean over all times. {TERMS}{remark}"
        ),
        columns: vec![
            Column::left("model", "model"),
            Column::left("term", "term"),
            Column::right("ns", "ns"),
            Column::right("from", "ns_lo95"),
            Column::right("to", "ns_hi95"),
            Column::right("inflation", "inflation"),
            Column::right("share, %", "share_pct"),
        ],
        keys: 2,
        rows,
    }
}
