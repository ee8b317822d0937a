//! The tables of what was fitted to seconds. All of them differ from run to run, so all are named `times-*`.

mod choice;
mod constants;
mod models;
mod residuals;

pub use choice::choice;
pub use constants::{INTERVALS, TERMS, constants, identified, inflation, interval, unidentified};
pub use models::{models, order};
pub use residuals::{Key, Residuals, residuals};
