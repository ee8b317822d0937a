//! The file of facts.

use std::collections::HashMap;
use std::path::Path;

use glam::DVec3;
use sahlab::scene::Scene;

/// A row of the file by its column names; an empty cell is absent.
pub struct Facts {
    row: HashMap<String, String>,
    /// The longest side of the scene's box.
    pub longest: f64,
}

impl Facts {
    /// All rows.
    pub fn all() -> Vec<Self> {
        let rows = table("spd-facts.csv").into_iter().map(|row| {
            let mut facts = Self { row, longest: 0.0 };
            let side = |axis: &str| {
                let end = |which: &str| facts.number(&format!("bb_{axis}{which}")).unwrap();
                end("max") - end("min")
            };
            facts.longest = ["x", "y", "z"].map(side).into_iter().fold(0.0, f64::max);
            facts
        });
        rows.collect()
    }

    /// The scene's full name.
    pub fn name(&self) -> String {
        format!("spd:{}:{}", self.row["scene"], self.row["size"])
    }

    pub fn scene(&self) -> Scene {
        Scene::load(&self.name()).unwrap()
    }

    pub fn text(&self, column: &str) -> &str {
        &self.row[column]
    }

    pub fn number(&self, column: &str) -> Option<f64> {
        let cell = self.text(column);
        (!cell.is_empty()).then(|| cell.parse().unwrap())
    }

    pub fn check(&self, column: &str, value: Option<f64>, tolerance: impl Fn(f64) -> f64) {
        let name = self.name();
        match (self.number(column), value) {
            (None, None) => {}
            (Some(fact), Some(ours)) => assert!(
                (fact - ours).abs() <= tolerance(fact),
                "{name} {column}: {ours}, not {fact}"
            ),
            (fact, ours) => panic!("{name} {column}: {ours:?}, not {fact:?}"),
        }
    }

    pub fn exact(&self, column: &str, value: usize) {
        self.check(column, Some(value as f64), |_| 0.0);
    }

    pub fn relative(&self, column: &str, value: Option<f64>) {
        self.check(column, value, |fact| 1e-9 * fact.abs());
    }

    /// Three columns, named by what replaces the star; to 1e-9 of the scene's longest side.
    pub fn place(&self, columns: &str, axes: [&str; 3], value: Option<DVec3>) {
        for (k, axis) in axes.into_iter().enumerate() {
            let column = columns.replace('*', axis);
            self.check(&column, value.map(|v| v[k]), |_| 1e-9 * self.longest);
        }
    }
}

/// The rows of a file of `data/reference`.
pub fn table(file: &str) -> Vec<HashMap<String, String>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/reference");
    let mut reader = csv::Reader::from_path(path.join(file)).unwrap();
    reader.deserialize().map(Result::unwrap).collect()
}
