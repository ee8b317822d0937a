//! The statistics behind every verdict of the study.
//!
//! The idea: sums are gathered to 32 digits ([`ScoreMoments`]),
//! lines are fitted to the accuracy of the data ([`least_squares`]), and each claim ends in one p-value
//! ([`normal_p`], [`student_p`], [`binomial_tail`], [`hotelling()`]) that [`holm()`] corrects for its companions.
//!
//! Costs are fitted by coefficients that are not negative ([`Normal::solve`]), orders are compared by [`kendall_tau_b`] and
//! [`spearman_rho`], and [`cluster_bootstrap`] gives an interval to what no formula does.
//!
//! The invariant: every function here is a deterministic function of its arguments and never returns NaN. A quantity
//! that does not exist (the mean of nothing) is `None`; an argument that can only come from a programming error (a
//! probability of 2) is a panic with the value in its message; bad data for a regression is an error.

pub mod binomial;
pub mod bootstrap;
mod cholesky;
pub mod collinearity;
mod double_double;
pub mod hotelling;
pub mod inverse;
pub mod moments;
pub mod multiple;
pub mod nnls;
pub mod normal_equations;
pub mod poisson;
mod qr;
pub mod quantile;
pub mod rank;
pub mod regression;
pub mod tails;
pub mod uniform;

pub use binomial::binomial_tail;
pub use bootstrap::cluster_bootstrap;
pub use hotelling::{Hotelling, hotelling};
pub use inverse::{chi_square_quantile, f_quantile};
pub use moments::ScoreMoments;
pub use multiple::holm;
pub use normal_equations::Normal;
pub use poisson::clustered_interval;
pub use quantile::{median, quantile, quantile_of_sorted};
pub use rank::{Pairs, Taken, concordant, kendall_tau_b, spearman_rho, take_least};
pub use regression::{Fit, RegressionError, least_squares, weighted_least_squares};
pub use tails::{f_tail, normal_p, normal_quantile, simultaneous_quantile, student_p};
pub use uniform::uniform_p;
