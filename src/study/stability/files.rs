//! Hard cases of files: what is malformed is refused with one line that says where, what is wrong, and what would be right; a
//! file of a few bytes that claims to be huge takes no time and no memory. Many were found by fuzzing (`tests/fuzz`).

mod experiments;
mod rays;
mod scenes;

use super::case::{Case, Finding, Group};
use super::first_hit::once;

/// The cases of this group.
pub fn cases() -> Vec<Case> {
    let mut all = scenes::cases();
    all.extend(rays::cases());
    all.extend(experiments::cases());
    all
}

/// A case of this group.
fn case(name: &'static str, stresses: &'static str, check: fn() -> Finding) -> Case {
    once(Group::Files, name, stresses, check)
}
