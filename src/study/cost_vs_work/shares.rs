//! Where the time goes: which share of it each term of a model explains.

use crate::study::records::ShareRecord;

use super::fit::{Model, time};
use super::terms::Row;

/// The share of each term in the time that a model gives to a row, in the mean over some rows; 0 of a row without time.
pub fn mean_shares<'r>(
    model: &Model,
    constants: &[f64],
    rows: impl Iterator<Item = &'r Row<'r>>,
) -> Vec<f64> {
    let mut sums = vec![0.0; constants.len()];
    let mut number = 0.0;
    for row in rows {
        number += 1.0;
        let whole = time(model, constants, row);
        if whole > 0.0 {
            for ((sum, term), c) in sums.iter_mut().zip(&model.terms).zip(constants) {
                *sum += c * term.of(row) / whole;
            }
        }
    }
    sums.iter().map(|sum| sum / f64::max(number, 1.0)).collect()
}

/// The shares by set of rays.
pub fn by_set<'r>(
    model: &Model,
    constants: &[f64],
    rows: &'r [Row<'r>],
    sets: &[String],
) -> Vec<ShareRecord> {
    let mut records = Vec::new();
    for rays in sets {
        let own = rows.iter().filter(|row| row.work.rays == *rays);
        if own.clone().next().is_none() {
            continue;
        }
        let shares = mean_shares(model, constants, own);
        let named = model.terms.iter().zip(shares);
        records.extend(named.map(|(term, share)| ShareRecord {
            rays: rays.clone(),
            term: term.name(),
            share,
        }));
    }
    records
}

#[cfg(test)]
mod tests {
    use super::super::terms::Term;
    use super::*;
    use crate::study::records::{CellRecord, StepRecord, WorkRecord};

    #[test]
    fn shares_by_hand() {
        let cell = CellRecord::default();
        let sets = ["lines", "primary"].map(|rays| WorkRecord {
            rays: rays.into(),
            ..WorkRecord::default()
        });
        let steps = [(3, 1), (1, 1), (0, 0)].map(|(inner, tests)| StepRecord {
            cast: 1,
            inner_visits: inner,
            sphere_tests: tests,
            ..StepRecord::default()
        });
        let row = |set: usize, number: usize| Row {
            cell: &cell,
            work: &sets[set],
            steps: &steps[number],
            ns: 1.0,
            disturbed: false,
        };
        let rows = [row(0, 0), row(0, 1), row(1, 2)];
        let model = Model::of("both", &[Term::Inner, Term::Test]);
        let names = ["lines", "primary"].map(String::from);
        // 2 ns a node and 6 a test: 6 of 12 and 2 of 8, a half and a quarter. A ray that does nothing takes no time.
        let found = by_set(&model, &[2.0, 6.0], &rows, &names);
        let told: Vec<_> = found
            .iter()
            .map(|s| (&*s.rays, &*s.term, s.share))
            .collect();
        assert_eq!(
            told,
            [
                ("lines", "inner node (c_K)", 0.375),
                ("lines", "object test (c_t)", 0.625),
                ("primary", "inner node (c_K)", 0.0),
                ("primary", "object test (c_t)", 0.0),
            ]
        );
    }
}
