//! x
pub mod records;
