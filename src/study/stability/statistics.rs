//! Hard cases of statistics: probabilities of 0 and 1, areas that span decades or are all equal, few lines, and fits through
//! data that leave few digits. What cannot be told is empty, never NaN.

mod cells;
mod fits;
mod tails;

use super::case::{Case, Check, Finding, Group};

/// The cases of this group.
pub fn cases() -> Vec<Case> {
    let mut all = cells::cases();
    all.extend(fits::cases());
    all.extend(tails::cases());
    all
}

/// A case that depends on no kernel and no tree.
fn case(name: &'static str, stresses: &'static str, check: fn() -> Finding) -> Case {
    Case {
        name,
        group: Group::Statistics,
        stresses,
        check: Check::Once(check),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::stability::case::Outcome;

    #[test]
    fn every_case_passes_and_has_a_name_of_its_own() {
        let mut names = std::collections::BTreeSet::new();
        for case in cases() {
            assert!(names.insert(case.name), "{} twice", case.name);
            let Check::Once(check) = case.check else {
                panic!("{} needs no kernel", case.name);
            };
            let finding = check();
            assert_eq!(finding.outcome, Outcome::Pass, "{}: {finding:?}", case.name);
        }
    }
}
