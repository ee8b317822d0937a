//! What a kernel visits and hits on a line, held against the exact oracle ([`crate::exact`]) on the kernel's own inputs.
//!
//! One source for kernels of `f64` and `f32`: a [`Subject`] is a tree in a kernel's numbers, [`Aim`] draws lines for it, [`Visits`] are
//! the nodes that the kernel takes a line to, [`nodes`] judges them and [`triangles`] what is in their leaves, and a [`Tally`] counts.

mod aim;
mod nodes;
mod numbers;
mod pair;
mod subject;
mod tally;
#[cfg(test)]
mod tests;
mod triangles;

pub use aim::{Against, Aim};
pub use nodes::{Visits, nodes};
pub use numbers::{Exact, exact_line};
pub use pair::{Judged, Pair, TIE};
pub use subject::{Narrow, Subject};
pub use tally::Tally;
pub use triangles::triangles;
