//! The sets of rays of a run, by their names.

use super::CostVsWork;
use crate::report::palette::Look;
use crate::report::series::distinct;

/// Sets of rays that the scene's picture has.
pub const TRACED: [&str; 3] = ["primary", "shadow", "secondary"];

/// What the names of sets mean, for captions.
pub const NAMES: &str = "Sets of rays: lines are the metric's own, isotropic and never stopped; :nearest and :any stop at their \
                         first or at any hit; volume-ray starts uniformly in the scene's box, objects on the objects' surfaces; \
                         primary, shadow and secondary are those of the scene's picture.";

/// The sets in the order of their first appearance.
pub fn of(run: &CostVsWork) -> Vec<&str> {
    distinct(run.work.iter().map(|row| row.rays.as_str()))
}

/// The look of a set: the same in every figure of the run.
pub fn look(sets: &[&str], rays: &str) -> Look {
    Look::of(sets.iter().position(|&set| set == rays).unwrap_or_default())
}
