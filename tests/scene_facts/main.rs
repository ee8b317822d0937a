//! The SPD generators against facts measured on the original programs (`data/reference/spd-facts.csv`).
#![allow(clippy::unwrap_used, missing_docs)]

mod facts;
mod hits;
mod looks;
mod objects;
mod shapes;
mod spots;
