//! The constants, and which of them the times can tell apart.

use super::super::CostVsWork;
use super::super::shown::{known, percent, text};
use crate::report::number::{decimals_for, digits_for, fixed};
use crate::report::table::{Cell, Column, Table};
use crate::study::records::{ConstantRecord, ModelRecord};

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

/// A sentence on the model of the tree cost C, where c_K and c_B cannot be told apart.
pub fn unidentified(run: &CostVsWork) -> Option<String> {
    let of = |term: &str| {
        let own = |c: &&ConstantRecord| c.model == ModelRecord::THREE && c.term == term;
        run.constants.iter().find(own)?.inflation
    };
    let (inner, leaf) = (of(ConstantRecord::INNER)?, of(ConstantRecord::LEAF)?);
    (inner > INFLATED && leaf > INFLATED).then(|| {
        format!(
            "In the model {} c_K and c_B are not separately identified: their variance inflation is {} and {}, above {}.",
            ModelRecord::THREE,
            fixed(inner, 1),
            fixed(leaf, 1),
            fixed(INFLATED, 0)
        )
    })
}

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
             interval of a bootstrap over groups of scenes; inflation: by how much the other terms widen its variance; share: of \
             the predicted time, mean over all times.{remark}"
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
