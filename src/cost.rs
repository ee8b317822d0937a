//! The tree cost C = c_K n_K + c_B n_B + c_t n_t (MacDonald & Booth 1990), written once.

use serde::{Deserialize, Serialize};

/// What one step costs, in any common unit: only ratios matter to a tree's shape.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CostModel {
    /// Visit of an inner node.
    pub c_k: f64,
    /// Visit of a leaf, empty ones too.
    pub c_b: f64,
    /// Test of one object.
    pub c_t: f64,
}

impl CostModel {
    /// Wald & Havran (2006): 15 a traversal step, 20 an object test, leaves free.
    pub const WALD_HAVRAN: Self = Self {
        c_k: 15.0,
        c_b: 0.0,
        c_t: 20.0,
    };

    /// C = c_K n_K + c_B n_B + c_t n_t: of a line if the counts are a line's, expected if they are expectations.
    ///
    /// ```
    /// use sahlab::cost::CostModel;
    /// let model = CostModel { c_k: 1.0, c_b: 2.0, c_t: 10.0 };
    /// assert_eq!(model.cost(3.0, 4.0, 5.0), 3.0 + 8.0 + 50.0);
    /// ```
    #[inline]
    pub fn cost(&self, n_k: f64, n_b: f64, n_t: f64) -> f64 {
        self.c_k * n_k + self.c_b * n_b + self.c_t * n_t
    }

    /// Expected cost of a node left as a leaf of `n` objects, for a line that hits it.
    #[inline]
    pub fn leaf(&self, n: f64) -> f64 {
        self.cost(0.0, 1.0, n)
    }

    /// Expected cost of a node cut once, its two parts left as leaves, for a line that hits it.
    ///
    /// `p_left` and `p_right` are the parts' surface areas over the node's; with c_B = 0 this is c_K + c_t f / SA for
    /// the split cost f = LSA L + RSA R.
    #[inline]
    pub fn split(&self, p_left: f64, n_left: f64, p_right: f64, n_right: f64) -> f64 {
        self.cost(1.0, p_left + p_right, p_left * n_left + p_right * n_right)
    }
}
