use super::*;
use crate::stats::least_squares;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

/// A design by rows and its y.
struct Problem {
    columns: usize,
    design: Vec<f64>,
    y: Vec<f64>,
}

impl Problem {
    fn normal(&self) -> Normal {
        let mut normal = Normal::new(self.columns);
        for (row, y) in self.design.chunks_exact(self.columns).zip(&self.y) {
            normal.push(row, *y);
        }
        normal
    }

    fn column(&self, j: usize) -> impl Iterator<Item = f64> {
        self.design.iter().skip(j).step_by(self.columns).copied()
    }

    fn residuals(&self, b: &[f64]) -> Vec<f64> {
        let rows = self.design.chunks_exact(self.columns);
        let fitted = rows.map(|row| row.iter().zip(b).map(|(x, b)| x * b).sum::<f64>());
        self.y.iter().zip(fitted).map(|(y, f)| y - f).collect()
    }

    /// Rows of random numbers, each column of its own size.
    fn random(random: &mut ChaCha8Rng, columns: usize, least: f64) -> Self {
        let rows = columns + random.random_range(0..60);
        let scales: Vec<f64> = (0..columns)
            .map(|_| 10f64.powi(random.random_range(-6..=6)))
            .collect();
        let mut uniform = || least + (1.0 - least) * random.random::<f64>();
        Self {
            columns,
            design: (0..rows * columns)
                .map(|i| scales[i % columns] * uniform())
                .collect(),
            y: (0..rows).map(|_| 50.0 * uniform()).collect(),
        }
    }
}

fn close(found: &[f64], expected: &[f64], error: f64) {
    assert_eq!(found.len(), expected.len());
    for (a, b) in found.iter().zip(expected) {
        assert!(
            (a - b).abs() <= error * b.abs(),
            "{found:?} not {expected:?}"
        );
    }
}

#[test]
fn known_solutions() {
    let solve = |columns, design: &[f64], y: &[f64]| {
        let (design, y) = (design.to_vec(), y.to_vec());
        Problem { columns, design, y }.normal().solve()
    };
    // The documented examples of scipy.optimize.nnls.
    let design = [1.0, 0.0, 1.0, 0.0, 0.0, 1.0];
    close(&solve(2, &design, &[2.0, 1.0, 1.0]), &[1.5, 1.0], 1e-15);
    assert_eq!(solve(2, &design, &[-1.0, -1.0, -1.0]), [0.0, 0.0]);
    // The documented example of MATLAB's lsqnonneg, in units of 1e-4; unconstrained it is (-2.5627, 3.1108).
    let design = [
        372.0, 2869.0, 6861.0, 7071.0, 6233.0, 6245.0, 6344.0, 6170.0,
    ];
    let found = solve(2, &design, &[8587.0, 1781.0, 747.0, 8405.0]);
    assert_eq!(found[0], 0.0);
    close(&found[1..], &[0.6929], 1e-4);
    assert!(Normal::new(0).solve().is_empty());
    assert_eq!(Normal::new(2).solve(), [0.0, 0.0]);
}

#[test]
fn a_column_may_come_and_go() {
    // By columns (0.6, 0.6, s) of length 1, (1, 0, 0) and (0, 1, 0). The first has the largest product with y, 10.8 - s/2
    // against 9 and 9, so it is freed first; beside the others only -s/2 is left of the product, and it returns to 0.
    let s = 0.28_f64.sqrt();
    let design = vec![0.6, 1.0, 0.0, 0.6, 0.0, 1.0, s, 0.0, 0.0];
    let y = vec![9.0, 9.0, -0.5];
    let problem = Problem {
        columns: 3,
        design,
        y,
    };
    let found = problem.normal().solve();
    assert_eq!(found[0], 0.0);
    close(&found[1..], &[9.0, 9.0], 1e-14);
}

#[test]
fn positive_solutions_are_those_of_least_squares() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    for columns in (1..=16).chain(1..=16) {
        let mut problem = Problem::random(&mut random, columns, 0.0);
        // One row more than columns, so that the other fit has a residual to judge by; y from positive coefficients.
        let extra: Vec<f64> = (0..columns).map(|j| problem.design[j]).collect();
        problem.design.extend(extra);
        let lengths = |j| problem.column(j).fold(0.0, f64::max);
        let truth: Vec<f64> = (0..columns)
            .map(|j| (1.0 + random.random::<f64>()) / lengths(j))
            .collect();
        problem.y = vec![0.0; problem.design.len() / columns];
        let y = problem.residuals(&truth);
        problem.y = y
            .iter()
            .map(|v| -v * (1.0 + 1e-3 * random.random::<f64>()))
            .collect();
        let expected = least_squares(&problem.design, columns, &problem.y).unwrap();
        let positive = expected.coefficients.iter().all(|b| *b > 0.0);
        assert!(positive, "{:?}", expected.coefficients);
        let normal = problem.normal();
        let found = normal.solve();
        close(&found, &expected.coefficients, 1e-9);
        let left = normal.residual_sum_of_squares(&found);
        close(&[left], &[expected.residual_sum_of_squares], 1e-9);
    }
}

#[test]
fn random_problems_satisfy_karush_kuhn_and_tucker() {
    let mut random = ChaCha8Rng::seed_from_u64(2);
    let (mut held, mut free) = (0, 0);
    for i in 0..200 {
        let columns = random.random_range(1..=24);
        let mut problem = Problem::random(&mut random, columns, -0.3);
        // Some columns repeat another, some are sums of two, some are zero.
        for _ in 0..i % 4 {
            let [to, a, b] = [(); 3].map(|()| random.random_range(0..columns));
            let kind = random.random_range(0..3);
            for row in problem.design.chunks_exact_mut(columns) {
                row[to] = [0.0, 2.0 * row[a], row[a] + row[b]][kind];
            }
        }
        let found = problem.normal().solve();
        let residuals = problem.residuals(&found);
        let norm = |v: &mut dyn Iterator<Item = f64>| v.map(|v| v * v).sum::<f64>().sqrt();
        let size = norm(&mut problem.y.iter().copied());
        for (j, b) in found.into_iter().enumerate() {
            let length = norm(&mut problem.column(j));
            let product: f64 = problem.column(j).zip(&residuals).map(|(x, r)| x * r).sum();
            // As the cosine between column and residual, but against |y|.
            let gradient = if length > 0.0 {
                product / length / size
            } else {
                0.0
            };
            assert!(b >= 0.0 && b.is_finite(), "problem {i}: {b}");
            assert!(gradient < 1e-9, "problem {i}, column {j}: {gradient:e}");
            if b > 0.0 {
                assert!(gradient > -1e-9, "problem {i}, column {j}: {gradient:e}");
                free += 1;
            } else {
                held += 1;
            }
        }
    }
    // Both kinds are common, so both conditions were put to the test.
    assert!(free > 500 && held > 500, "{free} free, {held} held at 0");
}

#[test]
fn columns_that_depend_share_one_fit() {
    // y = 3 x0 + 2 x1, with x2 = 2 x0, x3 = x0 + x1 and x4 = 0: whichever are free, the fit is exact.
    let rows = [[1.0, 0.0], [0.1, 1.0], [0.7, 0.3], [-0.2, 0.4]];
    let mut normal = Normal::new(5);
    for [a, b] in rows {
        normal.push(&[a, b, 2.0 * a, a + b, 0.0], 3.0 * a + 2.0 * b);
    }
    let found = normal.solve();
    assert_eq!(found[4], 0.0);
    assert!(found.iter().filter(|b| **b > 0.0).count() <= 2);
    assert!(normal.residual_sum_of_squares(&found) < 1e-28);
    // Of equal columns the first is free.
    let mut normal = Normal::new(3);
    for a in [0.3, 0.9, 1.7] {
        normal.push(&[a, a, a], 5.0 * a);
    }
    let found = normal.solve();
    close(&found, &[5.0, 0.0, 0.0], 1e-15);
}

#[test]
fn nearly_equal_columns_do_no_harm() {
    // Columns alike to 3..=15 digits: the fit is at least as good as that of one of them alone.
    for digits in 3..=15 {
        let apart = 10f64.powi(-digits);
        let (mut both, mut one) = (Normal::new(2), Normal::new(1));
        for i in 0..50 {
            let x = 1.0 + f64::from(i * i % 17);
            let y = x + 0.1 * f64::from(i % 3) + apart * f64::from(i % 7);
            both.push(&[x, x + apart * f64::from(i % 5)], y);
            one.push(&[x], y);
        }
        let (found, alone) = (both.solve(), one.solve());
        assert!(found.iter().all(|b| (0.0..2.0).contains(b)), "{found:?}");
        let left = both.residual_sum_of_squares(&found);
        assert!(left <= one.residual_sum_of_squares(&alone) * (1.0 + 1e-9));
    }
}
