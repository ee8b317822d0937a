//! Tables of a run of this kind. Those that hold seconds are named `times-*`.

mod coverage;
mod planes;
mod precision;
mod samplers;

pub use coverage::coverage;
pub use planes::{planes, times_planes};
pub use precision::{precision, times_precision};
pub use samplers::{at_most, efficiency, enough, is_exact, samplers, times_enough, times_samplers};
