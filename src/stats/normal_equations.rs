//! The sums a least squares fit needs, for groups of rows that come and go.
//!
//! The idea: everything the fit of y = X b needs is in X'X, X'y and y'y. Kept to 32 digits, these sums let groups of rows
//! be added and left out by adding and subtracting ([`Normal::merge`], [`Normal::without`]), and a fit works on k x k
//! numbers however many rows there are. The price: X'X squares the condition number of X, so columns that are alike to
//! more than about 5 digits cannot be told apart; [`super::regression`] can, but needs the rows.
//!
//! The invariant: sums reached by different ways of adding and leaving out agree to the digits of a double; a column that
//! is zero in all rows that stay is zero exactly.

use super::double_double::DoubleDouble;

/// The largest magnitude of a value: sums of its squares stay far from overflow.
const LARGEST: f64 = 1e100;

/// A column of which no more than this share (of its sum of squares) stays when rows are left out is zero: what stays is
/// the rounding of sums to 32 digits.
const NOTHING_LEFT: f64 = 1e-24;

/// The normal equations of y = X b: sums over rows, to 32 digits.
#[derive(Clone, Debug, PartialEq)]
pub struct Normal {
    n: u64,
    /// X'X: row i holds its i + 1 entries up to the diagonal.
    gram: Vec<Vec<DoubleDouble>>,
    /// X'y.
    rhs: Vec<DoubleDouble>,
    /// y'y.
    total: DoubleDouble,
}

impl Normal {
    /// The sums over no rows, of the given number of columns.
    pub fn new(columns: usize) -> Self {
        let zero = DoubleDouble::default();
        Self {
            n: 0,
            gram: (0..columns).map(|i| vec![zero; i + 1]).collect(),
            rhs: vec![zero; columns],
            total: zero,
        }
    }

    /// Adds one row of X, a number a column, and its y.
    ///
    /// # Panics
    /// If the row has another number of columns, or a value is not a number of magnitude at most 1e100.
    pub fn push(&mut self, row: &[f64], y: f64) {
        let (found, columns) = (row.len(), self.rhs.len());
        assert!(found == columns, "{found} values for {columns} columns");
        for value in row.iter().chain([&y]) {
            assert!(value.abs() <= LARGEST, "row {}: value {value}", self.n);
        }
        self.n += 1;
        for (i, a) in row.iter().enumerate() {
            (self.gram[i].iter_mut().zip(row)).for_each(|(sum, b)| sum.add_product(*a, *b));
            self.rhs[i].add_product(*a, y);
        }
        self.total.add_product(y, y);
    }

    /// Adds the rows of another part.
    ///
    /// # Panics
    /// If the numbers of columns differ.
    pub fn merge(&mut self, other: &Self) {
        self.n += other.n;
        self.add(other, 1.0);
    }

    /// The sums over all rows but those of `other`, which must be among them.
    ///
    /// # Panics
    /// If the numbers of columns differ, or `other` has more rows.
    #[must_use]
    pub fn without(&self, other: &Self) -> Self {
        let (all, out) = (self.n, other.n);
        assert!(out <= all, "{out} of {all} rows cannot be left out");
        let mut rest = self.clone();
        rest.n -= out;
        rest.add(other, -1.0);
        for j in 0..rest.rhs.len() {
            if rest.gram[j][j].value() <= NOTHING_LEFT * self.gram[j][j].value() {
                rest.clear(j);
            }
        }
        rest
    }

    /// The same with these columns alone, in this order.
    pub fn select(&self, columns: &[usize]) -> Self {
        let entry = |i: usize, j: usize| self.gram[i.max(j)][i.min(j)];
        let gram = columns.iter().enumerate().map(|(place, &i)| {
            let up_to = columns[..=place].iter();
            up_to.map(|&j| entry(i, j)).collect()
        });
        Self {
            n: self.n,
            gram: gram.collect(),
            rhs: columns.iter().map(|&i| self.rhs[i]).collect(),
            total: self.total,
        }
    }

    /// The number of rows.
    pub fn n(&self) -> u64 {
        self.n
    }

    /// The factor s for which s X b is nearest to y: of coefficients whose ratio is given. 0 if X b is zero.
    ///
    /// # Panics
    /// If there is not one coefficient a column.
    pub fn scale(&self, b: &[f64]) -> f64 {
        let (found, columns) = (b.len(), self.rhs.len());
        assert!(
            found == columns,
            "{found} coefficients for {columns} columns"
        );
        let (mut across, mut square) = (0.0, 0.0);
        for i in 0..columns {
            across += b[i] * self.rhs[i].value();
            for (j, other) in b.iter().enumerate() {
                square += b[i] * other * self.gram[i.max(j)][i.min(j)].value();
            }
        }
        if square > 0.0 { across / square } else { 0.0 }
    }

    /// |y - X b|^2 of these rows for any coefficients, such as those fitted to other rows.
    ///
    /// # Panics
    /// If there is not one coefficient a column.
    pub fn residual_sum_of_squares(&self, b: &[f64]) -> f64 {
        let (found, columns) = (b.len(), self.rhs.len());
        assert!(
            found == columns,
            "{found} coefficients for {columns} columns"
        );
        // y'y + b'(X'X b - 2 X'y): near the least value all digits of a double cancel, hence 32 to the end.
        let mut sum = self.total;
        for i in 0..columns {
            let mut slope = DoubleDouble::default();
            slope.add_scaled(self.rhs[i], -2.0);
            for (j, b) in b.iter().enumerate() {
                slope.add_scaled(self.gram[i.max(j)][i.min(j)], *b);
            }
            sum.add_scaled(slope, b[i]);
        }
        sum.value().max(0.0)
    }

    /// The equations of columns of length 1.
    pub(super) fn scaled(&self) -> Scaled {
        let columns = self.rhs.len();
        let inverse_lengths: Vec<f64> = (0..columns)
            .map(|j| {
                let square = self.gram[j][j].value();
                if square >= f64::MIN_POSITIVE {
                    1.0 / square.sqrt()
                } else {
                    0.0
                }
            })
            .collect();
        let entry = |i: usize, j: usize| {
            self.gram[i.max(j)][i.min(j)].value() * inverse_lengths[i] * inverse_lengths[j]
        };
        Scaled {
            gram: (0..columns)
                .map(|i| (0..columns).map(|j| entry(i, j)).collect())
                .collect(),
            rhs: (self.rhs.iter().zip(&inverse_lengths))
                .map(|(sum, scale)| sum.value() * scale)
                .collect(),
            inverse_lengths,
        }
    }

    fn add(&mut self, other: &Self, factor: f64) {
        let (columns, others) = (self.rhs.len(), other.rhs.len());
        assert!(columns == others, "{columns} columns against {others}");
        let gram = self.gram.iter_mut().flatten();
        for (sum, other) in gram.zip(other.gram.iter().flatten()) {
            sum.add_scaled(*other, factor);
        }
        for (sum, other) in self.rhs.iter_mut().zip(&other.rhs) {
            sum.add_scaled(*other, factor);
        }
        self.total.add_scaled(other.total, factor);
    }

    /// Makes column j zero.
    fn clear(&mut self, j: usize) {
        let zero = DoubleDouble::default();
        self.rhs[j] = zero;
        for i in 0..self.rhs.len() {
            self.gram[i.max(j)][i.min(j)] = zero;
        }
    }
}

/// Normal equations in plain doubles, of columns of length 1.
pub(super) struct Scaled {
    /// The cosines between the columns; zero for a column that is zero.
    pub gram: Vec<Vec<f64>>,
    /// X'y.
    pub rhs: Vec<f64>,
    /// One over the length of each column; 0 for one that is zero.
    pub inverse_lengths: Vec<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn columns_are_selected_and_scaled() {
        let rows = rows(7, 50);
        let all = of(&rows);
        let mut two = Normal::new(2);
        rows.iter()
            .for_each(|row| two.push(&[row[2], row[0]], row[3]));
        assert_eq!(all.select(&[2, 0]), two);
        // The least squares factor of one column is that column's coefficient.
        let mut one = Normal::new(1);
        let b = [2.0, 3e7, 1e-9];
        let sum = |row: &[f64; 4]| row.iter().zip(b).map(|(x, b)| x * b).sum::<f64>();
        rows.iter().for_each(|row| one.push(&[sum(row)], row[3]));
        let wanted = one.rhs[0].value() / one.gram[0][0].value();
        assert!((all.scale(&b) / wanted - 1.0).abs() < 1e-12);
        assert_eq!(Normal::new(2).scale(&[1.0, 1.0]), 0.0);
    }

    /// Sums over rows of three columns, of very different sizes, and y.
    fn of(rows: &[[f64; 4]]) -> Normal {
        let mut normal = Normal::new(3);
        rows.iter().for_each(|row| normal.push(&row[..3], row[3]));
        normal
    }

    fn rows(seed: u64, n: usize) -> Vec<[f64; 4]> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let scales = [1.0, 1e-7, 1e9, 3.0];
        let mut row = || scales.map(|scale| scale * (random.random::<f64>() - 0.3));
        (0..n).map(|_| row()).collect()
    }

    /// All sums, rounded to doubles.
    fn sums(normal: &Normal) -> Vec<f64> {
        let all = normal.gram.iter().flatten().chain(&normal.rhs);
        all.chain([&normal.total]).map(|s| s.value()).collect()
    }

    fn assert_agree(a: &Normal, b: &Normal) {
        assert_eq!(a.n(), b.n());
        for (a, b) in sums(a).into_iter().zip(sums(b)) {
            assert!((a - b).abs() <= 4.0 * f64::EPSILON * b.abs(), "{a:e} {b:e}");
        }
    }

    #[test]
    fn sums_by_hand() {
        let normal = of(&[[1.0, 2.0, 0.0, 3.0], [-1.0, 0.5, 4.0, 2.0]]);
        let expected = [2.0, 1.5, 4.25, -4.0, 2.0, 16.0, 1.0, 7.0, 8.0, 13.0];
        assert_eq!((normal.n(), sums(&normal)), (2, expected.to_vec()));
        let scaled = normal.scaled();
        assert_eq!(scaled.inverse_lengths[2], 0.25);
        assert_eq!((scaled.rhs[2], scaled.gram[2][2]), (2.0, 1.0));
        assert_eq!(scaled.gram[2][0], scaled.gram[0][2]);
        assert!((scaled.gram[2][0] + 1.0 / 2f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn groups_come_and_go() {
        let (a, mut b, c) = (rows(1, 40), rows(2, 7), rows(3, 300));
        // What a large group leaves behind is as good as if it had never been there.
        b.iter_mut().flatten().for_each(|v| *v *= 1e6);
        let mut all = of(&a);
        all.merge(&of(&b));
        all.merge(&of(&c));
        assert_agree(&all, &of(&[&a[..], &b, &c].concat()));
        assert_agree(&all.without(&of(&b)), &of(&[&c[..], &a].concat()));
        assert_agree(&all.without(&of(&b)).without(&of(&c)), &of(&a));
        let none = all.without(&all);
        assert_eq!((none.n(), sums(&none)), (0, vec![0.0; 10]));
    }

    #[test]
    fn a_column_that_only_left_rows_have_is_zero() {
        let mut a = rows(4, 30);
        a.iter_mut().for_each(|row| row[1] = 0.0);
        let (b, c) = (rows(5, 30), rows(6, 30));
        let all = of(&[&a[..], &b, &c].concat());
        let rest = all.without(&of(&b)).without(&of(&c));
        assert_agree(&rest, &of(&a));
        assert_eq!(rest.scaled().inverse_lengths[1], 0.0);
        assert_eq!(rest.scaled().gram[1], [0.0; 3]);
    }

    #[test]
    fn residuals_of_any_coefficients() {
        let rows = rows(7, 60);
        let normal = of(&rows);
        let residual =
            |row: &[f64; 4], b: &[f64; 3]| row[3] - (0..3).map(|j| b[j] * row[j]).sum::<f64>();
        for b in [[0.0; 3], [1.0, 3e6, 2e-9], [-4.0, 0.0, 1e-3]] {
            let direct: f64 = rows.iter().map(|row| residual(row, &b).powi(2)).sum();
            let found = normal.residual_sum_of_squares(&b);
            assert!((found / direct - 1.0).abs() < 1e-12, "{found} {direct}");
        }
        // An exact fit leaves nothing, where plain sums would leave 1e-16 of |y|^2 = 5e9.
        let exact = of(&[[3e4, 1.0, 7.0, 6e4 + 1.0], [2e4, 5.0, 1.0, 4e4 + 5.0]]);
        assert_eq!(exact.residual_sum_of_squares(&[2.0, 1.0, 0.0]), 0.0);
        let near = exact.residual_sum_of_squares(&[2.0, 1.0, 1e-9]);
        assert!((near - 5e-17).abs() < 1e-22, "{near}");
    }

    #[test]
    #[should_panic(expected = "2 values for 3 columns")]
    fn a_short_row_is_refused() {
        Normal::new(3).push(&[1.0, 2.0], 1.0);
    }

    #[test]
    #[should_panic(expected = "row 0: value NaN")]
    fn nan_is_refused() {
        Normal::new(1).push(&[1.0], f64::NAN);
    }

    #[test]
    #[should_panic(expected = "2 of 1 rows cannot be left out")]
    fn more_than_all_cannot_be_left_out() {
        let _ = of(&rows(1, 1)).without(&of(&rows(1, 2)));
    }
}
