//! Experiments: from a file to cells, from cells to records, from records to verdicts.

pub mod cell;
pub mod findings;
pub mod hits_vs_area;
pub mod plan;
pub mod records;
pub mod samplers;
pub mod scores;
pub mod spread;
pub mod store;
pub mod verdicts;

pub use plan::{LineRule, Plan, PlanError};
