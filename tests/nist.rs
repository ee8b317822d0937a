//! Regression and moments against the certified values of NIST's Statistical Reference Datasets.
//!
//! Accuracy is the log relative error of McCullough (Amer. Statist. 52, 1998): the number of right leading digits,
//! smallest over the parameters, at most 15. The bounds are a little below what is attained, and what is attained is
//! printed (`cargo test --test nist -- --nocapture`).

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::PathBuf;

use sahlab::stats::{Fit, ScoreMoments, least_squares, weighted_least_squares};
use serde_json::Value;

/// One dataset: the columns of the CSV file by row, y first, and the certified values.
struct Dataset {
    name: &'static str,
    rows: Vec<Vec<f64>>,
    json: Value,
}

impl Dataset {
    fn read(name: &'static str) -> Self {
        let path = |extension: &str| {
            let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/nist");
            folder.join(format!("{name}.{extension}"))
        };
        let mut reader = csv::Reader::from_path(path("csv")).unwrap();
        let rows = reader.records().map(|record| {
            let record = record.unwrap();
            record.iter().map(|field| field.parse().unwrap()).collect()
        });
        let rows: Vec<Vec<f64>> = rows.collect();
        let json: Value = serde_json::from_str(&fs::read_to_string(path("json")).unwrap()).unwrap();
        assert_eq!(rows.len() as u64, json["n"].as_u64().unwrap(), "{name}");
        Self { name, rows, json }
    }

    /// y, the design by rows, and its number of columns.
    fn model(&self) -> (Vec<f64>, Vec<f64>, usize) {
        let intercept = self.json["intercept"].as_bool().unwrap();
        let degree = self.json["degree"].as_i64().map(|degree| degree as i32);
        let mut design = Vec::new();
        for row in &self.rows {
            design.extend(intercept.then_some(1.0));
            match degree {
                Some(degree) => design.extend((1..=degree).map(|power| row[1].powi(power))),
                None => design.extend(&row[1..]),
            }
        }
        let columns = design.len() / self.rows.len();
        (
            self.rows.iter().map(|row| row[0]).collect(),
            design,
            columns,
        )
    }

    fn fit(&self) -> Fit {
        let (y, design, columns) = self.model();
        least_squares(&design, columns, &y).unwrap()
    }

    /// A list of 30-digit values.
    fn exact(&self, key: &str) -> Vec<f64> {
        let list = self.json["exact_30_digits"][key].as_array().unwrap();
        list.iter().map(number).collect()
    }

    /// R^2 in the form NIST certifies for this dataset.
    fn r_squared(&self, fit: &Fit) -> f64 {
        let kind = self.json["certified"]["r_squared_kind"].as_str().unwrap();
        match kind {
            "1-SSE/sum((y-ybar)^2)" => fit.r_squared_centred.unwrap(),
            "1-SSE/sum(y^2) (no intercept)" => fit.r_squared_uncentred.unwrap(),
            _ => panic!("{}: R^2 of kind {kind}", self.name),
        }
    }
}

fn number(value: &Value) -> f64 {
    value.as_str().unwrap().parse().unwrap()
}

/// The number of right digits of one value; of a value that should be zero, its zeros after the point.
fn digits(value: f64, certified: f64) -> f64 {
    let unit = if certified == 0.0 {
        1.0
    } else {
        certified.abs()
    };
    (-((value - certified).abs() / unit).log10()).clamp(0.0, 15.0)
}

/// The smallest number of right digits.
fn fewest_digits(values: &[f64], certified: &[f64]) -> f64 {
    assert_eq!(values.len(), certified.len());
    let pairs = values.iter().zip(certified);
    pairs.map(|(v, c)| digits(*v, *c)).fold(15.0, f64::min)
}

#[test]
fn regression_attains_the_certified_values() {
    // Bounds on coefficients, standard errors, residual sd (NIST's own 15 digits) and R^2.
    let bounds = [
        ("norris", 13.5, 12.0, 12.0, 13.0),
        ("noint1", 14.0, 14.0, 13.0, 13.0),
        ("noint2", 14.0, 14.0, 13.0, 13.0),
        ("longley", 13.0, 12.0, 12.0, 13.0),
        ("wampler1", 13.0, 12.0, 12.0, 13.0),
        ("wampler4", 13.0, 13.0, 13.0, 13.0),
        ("wampler5", 13.0, 13.0, 13.0, 13.0),
    ];
    println!("digits:    coefficients  standard errors  residual sd  R^2");
    for (name, coefficients, standard_errors, residual_sd, r_squared) in bounds {
        let data = Dataset::read(name);
        let fit = data.fit();
        let certified_sd = number(&data.json["certified"]["residual_sd"]);
        let exact_r_squared = number(&data.json["exact_30_digits"]["r_squared"]);
        let attained = [
            fewest_digits(&fit.coefficients, &data.exact("parameters")),
            fewest_digits(&fit.standard_errors, &data.exact("standard_errors")),
            digits(fit.residual_sd, certified_sd),
            digits(data.r_squared(&fit), exact_r_squared),
        ];
        let [a, b, c, d] = attained;
        println!("{name:10} {a:12.1} {b:16.1} {c:12.1} {d:4.1}");
        let demanded = [coefficients, standard_errors, residual_sd, r_squared];
        for (attained, demanded) in attained.iter().zip(demanded) {
            assert!(
                *attained >= demanded,
                "{name}: {attained:.2} digits of {demanded}"
            );
        }
    }
}

#[test]
fn the_other_r_squared_is_another_number() {
    // Recomputed from the data: the centred R^2 of the two models without an intercept.
    for (name, centred) in [("noint1", -0.157), ("noint2", 0.591)] {
        let fit = Dataset::read(name).fit();
        let attained = fit.r_squared_centred.unwrap();
        assert!((attained - centred).abs() < 5e-4, "{name}: {attained}");
    }
}

#[test]
fn equal_weights_change_nothing_but_the_scale() {
    for name in ["norris", "longley", "wampler5"] {
        let data = Dataset::read(name);
        let (y, design, columns) = data.model();
        let plain = data.fit();
        let weighted = weighted_least_squares(&design, columns, &y, &vec![4.0; y.len()]).unwrap();
        assert!(
            fewest_digits(&weighted.coefficients, &plain.coefficients) >= 14.0,
            "{name}"
        );
        assert!(
            fewest_digits(&weighted.standard_errors, &plain.standard_errors) >= 14.0,
            "{name}"
        );
        assert_eq!(weighted.residual_sd, 2.0 * plain.residual_sd, "{name}");
    }
}

/// The textbook way, which squares the condition number: Cholesky on X'X b = X'y.
fn normal_equations(design: &[f64], columns: usize, y: &[f64]) -> Vec<f64> {
    let p = columns;
    let rows = || design.chunks_exact(p).zip(y);
    let product = |i: usize, j: usize| rows().map(|(x, _)| x[i] * x[j]).sum::<f64>();
    let mut lower = vec![vec![0.0; p]; p];
    let mut b: Vec<f64> = (0..p)
        .map(|i| rows().map(|(x, y)| x[i] * y).sum())
        .collect();
    for i in 0..p {
        for j in 0..=i {
            let known: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
            let rest = product(i, j) - known;
            lower[i][j] = if i == j {
                rest.sqrt()
            } else {
                rest / lower[j][j]
            };
        }
        let known: f64 = (0..i).map(|k| lower[i][k] * b[k]).sum();
        b[i] = (b[i] - known) / lower[i][i];
    }
    for i in (0..p).rev() {
        let known: f64 = (i + 1..p).map(|k| lower[k][i] * b[k]).sum();
        b[i] = (b[i] - known) / lower[i][i];
    }
    b
}

#[test]
fn the_bounds_can_fail() {
    for (name, demanded) in [
        ("norris", 13.5),
        ("longley", 13.0),
        ("wampler1", 13.0),
        ("wampler5", 13.0),
    ] {
        let data = Dataset::read(name);
        let (y, design, columns) = data.model();
        let b = normal_equations(&design, columns, &y);
        let attained = fewest_digits(&b, &data.exact("parameters"));
        println!("{name}: normal equations {attained:.1} digits");
        assert!(
            attained > 4.0 && attained < demanded,
            "{name}: {attained:.2} digits"
        );
    }
}

#[test]
fn moments_attain_the_certified_values() {
    // NumAcc4: rounding the decimal data to doubles leaves 8.3 digits of the standard deviation.
    for (name, demanded) in [("mavro", 12.0), ("numacc2", 13.0), ("numacc4", 8.0)] {
        let data = Dataset::read(name);
        let mut whole = ScoreMoments::<1>::default();
        let mut parts = [ScoreMoments::<1>::default(); 3];
        for (i, row) in data.rows.iter().enumerate() {
            whole.push([row[0]]);
            parts[i % 3].push([row[0]]);
        }
        let [mut merged, second, third] = parts;
        merged.merge(&second);
        merged.merge(&third);
        for moments in [whole, merged] {
            let mean = moments.mean().unwrap()[0];
            let sd = moments.covariance().unwrap()[0][0].sqrt();
            let mean = digits(mean, number(&data.json["exact_30_digits"]["mean"]));
            let sd = digits(sd, number(&data.json["exact_30_digits"]["sd"]));
            println!("{name:8} digits of the mean {mean:.1}, of the standard deviation {sd:.1}");
            assert!(
                mean >= 14.0 && sd >= demanded,
                "{name}: {mean:.2} and {sd:.2} digits"
            );
        }
    }
}
