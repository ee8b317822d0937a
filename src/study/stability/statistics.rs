//! Hard cases of statistics: probabilities of 0 and 1, areas that span decades or are all equal, few lines, and fits through
//! data that leave few digits. What cannot be told is empty, never NaN.

mod cells;
mod fits;
mod tails;

use super::case::{Case, Finding, Group};
use super::first_hit::once;

/// The cases of this group.
pub fn cases() -> Vec<Case> {
    let mut all = cells::cases();
    all.extend(fits::cases());
    all.extend(tails::cases());
    all
}

/// A case of this group.
fn case(name: &'static str, stresses: &'static str, check: fn() -> Finding) -> Case {
    once(Group::Statistics, name, stresses, check)
}
