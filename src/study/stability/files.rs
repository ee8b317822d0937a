//! Hard cases of files: what is malformed is refused with one line that says where, what is wrong, and what would be right; a
//! file of a few bytes that claims to be huge takes no time and no memory. Many were found by fuzzing (`tests/fuzz`).

mod experiments;
mod rays;
mod scenes;

use super::case::{Case, Check, Finding, Group};

/// The cases of this group.
pub fn cases() -> Vec<Case> {
    let mut all = scenes::cases();
    all.extend(rays::cases());
    all.extend(experiments::cases());
    all
}

/// A case that depends on no kernel and no tree.
fn case(name: &'static str, stresses: &'static str, check: fn() -> Finding) -> Case {
    Case {
        name,
        group: Group::Files,
        stresses,
        check: Check::Once(check),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_passes_and_has_a_name_of_its_own() {
        let mut names = std::collections::BTreeSet::new();
        for case in cases() {
            assert!(names.insert(case.name), "{} twice", case.name);
            let Check::Once(check) = case.check else {
                panic!("{} needs no kernel", case.name);
            };
            let finding = check();
            assert_eq!(finding.measured, finding.expected, "{}", case.name);
        }
    }
}
