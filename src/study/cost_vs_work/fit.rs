//! Constants fitted to times, and how well they predict scenes that were left out.
//!
//! Non-negative least squares of relative errors: every row is divided by its time, so that a cheap tree counts as much as a
//! dear one. What is judged was never fitted.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::stats::{Normal, concordant, kendall_tau_b, median, quantile, take_least};

use super::terms::{Row, Term};

/// A model: terms with a constant each, or terms whose ratio is given and only their scale is fitted.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Its name.
    pub name: String,
    /// Its terms.
    pub terms: Vec<Term>,
    /// Given ratio of the constants, if it is.
    pub ratio: Option<Vec<f64>>,
}

impl Model {
    /// A constant for each term.
    pub fn of(name: &str, terms: &[Term]) -> Self {
        Self {
            name: name.into(),
            terms: terms.into(),
            ratio: None,
        }
    }

    /// The columns of its terms.
    fn columns(&self) -> Vec<usize> {
        self.terms.iter().map(|term| term.column()).collect()
    }

    /// Its constants from sums over all terms.
    fn fitted(&self, all: &Normal) -> Vec<f64> {
        self.solved(&all.select(&self.columns()))
    }

    /// Its constants from sums over its own terms.
    fn solved(&self, own: &Normal) -> Vec<f64> {
        match &self.ratio {
            None => own.solve(),
            Some(ratio) => {
                let scale = own.scale(ratio);
                ratio.iter().map(|c| scale * c).collect()
            }
        }
    }

    /// Constants that are fitted.
    pub fn constants(&self) -> usize {
        self.ratio.as_ref().map_or(self.terms.len(), |_| 1)
    }
}

/// Rows with their sums by scene, so that any model can be fitted to any scenes.
pub struct Fitter<'a> {
    /// The rows.
    pub rows: &'a [Row<'a>],
    /// Which rows are a scene's.
    pub scenes: Vec<Vec<usize>>,
    /// Which scenes are sizes of one.
    pub groups: Vec<Vec<usize>>,
    /// The normal equations of all terms, of each scene.
    sums: Vec<Normal>,
    /// And of all scenes.
    all: Normal,
}

/// Numbers of items of the same name, in the order of names.
fn parted<'n>(names: impl Iterator<Item = &'n str>) -> Vec<Vec<usize>> {
    let mut parts: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (number, name) in names.enumerate() {
        parts.entry(name).or_default().push(number);
    }
    parts.into_values().collect()
}

impl<'a> Fitter<'a> {
    /// Sums of these rows.
    pub fn new(rows: &'a [Row<'a>]) -> Self {
        let scenes = parted(rows.iter().map(|row| row.work.scene.as_str()));
        let groups = parted(scenes.iter().map(|numbers| rows[numbers[0]].group()));
        let sums = scenes.iter().map(|numbers| {
            let mut sum = Normal::new(Term::ALL.len());
            for row in numbers.iter().map(|&number| &rows[number]) {
                let relative = Term::ALL.map(|term| term.of(row) / row.ns);
                sum.push(&relative, 1.0);
            }
            sum
        });
        let sums: Vec<Normal> = sums.collect();
        let mut all = Normal::new(Term::ALL.len());
        sums.iter().for_each(|sum| all.merge(sum));
        Self {
            rows,
            scenes,
            groups,
            sums,
            all,
        }
    }

    /// Every scene on its own: what is left out at a time.
    pub fn single_scenes(&self) -> Vec<Vec<usize>> {
        (0..self.scenes.len()).map(|scene| vec![scene]).collect()
    }

    /// The constants of a model fitted to these scenes, one that is named twice counting twice.
    pub fn constants(&self, model: &Model, scenes: impl IntoIterator<Item = usize>) -> Vec<f64> {
        let mut sum = Normal::new(Term::ALL.len());
        scenes
            .into_iter()
            .for_each(|scene| sum.merge(&self.sums[scene]));
        model.fitted(&sum)
    }

    /// The constants of a model fitted to all scenes but these.
    pub fn constants_without(&self, model: &Model, out: &[usize]) -> Vec<f64> {
        let sum = out
            .iter()
            .fold(self.all.select(&model.columns()), |sum, &scene| {
                sum.without(&self.sums[scene].select(&model.columns()))
            });
        model.solved(&sum)
    }

    /// All scenes but some.
    pub fn others(&self, out: &[usize]) -> impl Iterator<Item = usize> {
        (0..self.scenes.len()).filter(move |scene| !out.contains(scene))
    }

    /// Variance inflation of each constant, from all rows.
    pub fn inflation(&self, model: &Model) -> Vec<Option<f64>> {
        self.all.select(&model.columns()).variance_inflation()
    }

    /// Nanoseconds of the rows of these folds of scenes, each predicted by a model fitted without its fold and without the
    /// scenes `out`; other rows have 0. `choose` gives the model to fit when these scenes are out.
    pub fn left_out(
        &self,
        out: &[usize],
        folds: &[Vec<usize>],
        choose: impl Fn(&[usize]) -> Model + Sync,
    ) -> Vec<f64> {
        let fold = |fold: &Vec<usize>| {
            let left_out = [out, fold].concat();
            let model = choose(&left_out);
            let constants = self.constants_without(&model, &left_out);
            let numbers = fold.iter().flat_map(|&scene| &self.scenes[scene]);
            let predict = |&number: &usize| (number, time(&model, &constants, &self.rows[number]));
            numbers.map(predict).collect::<Vec<_>>()
        };
        let parts: Vec<Vec<(usize, f64)>> = folds.par_iter().map(fold).collect();
        let mut predicted = vec![0.0; self.rows.len()];
        for (number, ns) in parts.into_iter().flatten() {
            predicted[number] = ns;
        }
        predicted
    }

    /// Mean relative error of every scene but those that are out.
    pub fn errors(&self, predicted: &[f64], out: &[usize]) -> Vec<f64> {
        let of = |scene: usize| {
            let own = &self.scenes[scene];
            let error = |&number: &usize| (predicted[number] / self.rows[number].ns - 1.0).abs();
            own.iter().map(error).sum::<f64>() / own.len() as f64
        };
        self.others(out).map(of).collect()
    }
}

/// Nanoseconds of a row.
pub fn time(model: &Model, constants: &[f64], row: &Row) -> f64 {
    let parts = model.terms.iter().zip(constants);
    parts.map(|(term, c)| c * term.of(row)).sum()
}

/// How far predictions are from the times.
pub struct Errors {
    pub median: f64,
    pub mean: f64,
    pub p90: f64,
    pub max: f64,
}

impl Errors {
    /// Of every row's prediction; `None` without rows.
    pub fn of(rows: &[Row], predicted: &[f64]) -> Option<Self> {
        let errors = rows.iter().zip(predicted);
        let errors: Vec<f64> = errors.map(|(row, p)| (p / row.ns - 1.0).abs()).collect();
        Some(Self {
            median: median(&errors)?,
            mean: errors.iter().sum::<f64>() / errors.len() as f64,
            p90: quantile(&errors, 0.9)?,
            max: errors.iter().copied().fold(0.0, f64::max),
        })
    }
}

/// How well a cost orders the trees of each scene, under each set of rays.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Orders {
    /// Scenes times sets with at least two trees of different time and cost.
    pub scenes: u64,
    pub tau: f64,
    pub pairs_right: f64,
    pub regret_mean: f64,
    pub regret_max: f64,
    /// The scene of the worst regret.
    pub worst: String,
}

impl Orders {
    /// A figure of it, where there was anything to rank.
    pub fn ranked(&self, figure: f64) -> Option<f64> {
        (self.scenes > 0).then_some(figure)
    }

    /// Of the rows that are wanted, by a cost.
    pub fn of(rows: &[Row], cost: &[f64], wanted: impl Fn(&Row) -> bool) -> Self {
        let mut trees: BTreeMap<(&str, &str), Vec<(f64, f64)>> = BTreeMap::new();
        for (row, &cost) in rows.iter().zip(cost).filter(|(row, _)| wanted(row)) {
            let key = (row.work.scene.as_str(), row.work.rays.as_str());
            trees.entry(key).or_default().push((cost, row.ns));
        }
        let mut all = Self::default();
        let (mut right, mut pairs) = (0, 0);
        for ((scene, _), trees) in trees {
            let (costs, times): (Vec<f64>, Vec<f64>) = trees.into_iter().unzip();
            let Some(tau) = kendall_tau_b(&costs, &times) else {
                continue;
            };
            let own = concordant(&costs, &times);
            right += own.right;
            pairs += own.right + own.wrong;
            all.scenes += 1;
            all.tau += tau;
            let taken = take_least(&costs, &times);
            let regret = taken.and_then(|taken| taken.regret).unwrap_or(0.0);
            all.regret_mean += regret;
            if regret > all.regret_max || all.worst.is_empty() {
                all.regret_max = regret;
                all.worst = scene.into();
            }
        }
        let scenes = (all.scenes as f64).max(1.0);
        all.tau /= scenes;
        all.regret_mean /= scenes;
        all.pairs_right = right as f64 / (pairs as f64).max(1.0);
        all
    }
}

#[cfg(test)]
pub mod tests {
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    use super::*;
    use crate::study::records::{CellRecord, StepRecord, WorkRecord};

    /// Six scenes in three groups, of eight trees each, under one set of rays, whose times are 3 n_K + 7 n_t + 11 surprises, and up to `noise` of that.
    pub fn trees(noise: f64) -> Vec<(CellRecord, WorkRecord, StepRecord, f64)> {
        let mut random = ChaCha8Rng::seed_from_u64(4);
        let mut trees = Vec::new();
        for scene in 0..6 {
            for _ in 0..8 {
                let mut any = |most: u64| random.random_range(most / 4..most);
                let steps = StepRecord {
                    cast: 100,
                    inner_visits: any(8000),
                    leaf_visits: any(3000),
                    empty_leaf_visits: any(1000),
                    triangle_tests: any(6000),
                    surprises: any(2000),
                    first_misses: any(900),
                    ..StepRecord::default()
                };
                let sum = 3 * steps.inner_visits + 7 * steps.triangle_tests + 11 * steps.surprises;
                let off = 1.0 + noise * (2.0 * random.random::<f64>() - 1.0);
                let work = WorkRecord {
                    scene: format!("spd:{}:{}", scene / 2, scene % 2),
                    rays: "lines".into(),
                    ..WorkRecord::default()
                };
                let cell = CellRecord {
                    bytes: 1000,
                    objects: 100,
                    references: 150,
                    ..CellRecord::default()
                };
                trees.push((cell, work, steps, off * sum as f64 / 100.0));
            }
        }
        trees
    }

    pub fn rows(trees: &[(CellRecord, WorkRecord, StepRecord, f64)]) -> Vec<Row<'_>> {
        trees
            .iter()
            .map(|(cell, work, steps, ns)| Row {
                cell,
                work,
                steps,
                ns: *ns,
                disturbed: false,
            })
            .collect()
    }

    const TRUE: [Term; 3] = [Term::Inner, Term::Test, Term::Surprise];

    #[test]
    fn constants_that_made_the_times_are_found_without_any_group() {
        let trees = trees(0.0);
        let rows = rows(&trees);
        let fitter = Fitter::new(&rows);
        assert_eq!((fitter.scenes.len(), fitter.groups.len()), (6, 3));
        let model = Model::of("true", &TRUE);
        let constants = fitter.constants(&model, [0, 3, 5]);
        let without = fitter.constants_without(&model, &[1, 2, 4]);
        for (with, without) in constants.iter().zip(without) {
            assert!((with - without).abs() < 1e-12 * with);
        }
        for (found, wanted) in constants.iter().zip([3.0, 7.0, 11.0]) {
            assert!((found - wanted).abs() < 1e-9, "{constants:?}");
        }
        let predicted = fitter.left_out(&[], &fitter.groups, |_| model.clone());
        assert!(Errors::of(&rows, &predicted).is_some_and(|e| e.max < 1e-12));
        let orders = Orders::of(&rows, &predicted, |_| true);
        assert_eq!(
            (orders.scenes, orders.tau, orders.regret_max),
            (6, 1.0, 0.0)
        );
    }

    #[test]
    fn rows_left_out_have_no_say_in_their_prediction() {
        let mut trees = trees(0.1);
        let model = Model::of("true", &TRUE);
        let first = |trees: &[(CellRecord, WorkRecord, StepRecord, f64)]| {
            let rows = rows(trees);
            let fitter = Fitter::new(&rows);
            let folds = fitter.single_scenes();
            fitter.left_out(&[], &folds, |_| model.clone())[0]
        };
        let before = first(&trees);
        // Times of its own scene change nothing, those of another do.
        trees[1].3 *= 5.0;
        assert_eq!(first(&trees), before);
        trees[20].3 *= 5.0;
        assert_ne!(first(&trees), before);
    }

    #[test]
    fn a_given_ratio_leaves_one_constant() {
        let trees = trees(0.0);
        let rows = rows(&trees);
        let fitter = Fitter::new(&rows);
        let model = Model {
            ratio: Some(vec![6.0, 14.0, 22.0]),
            ..Model::of("twice", &TRUE)
        };
        let constants = fitter.constants(&model, 0..6);
        assert!((constants[2] - 11.0).abs() < 1e-9 && model.constants() == 1);
    }

    #[test]
    fn the_order_of_trees_by_hand() {
        let mut trees = trees(0.0);
        trees.truncate(3);
        for (tree, ns) in trees.iter_mut().zip([10.0, 12.0, 20.0]) {
            tree.3 = ns;
        }
        let rows = rows(&trees);
        // The second tree is taken, which costs a fifth; of three pairs one is wrong.
        let orders = Orders::of(&rows, &[2.0, 1.0, 3.0], |_| true);
        assert!((orders.tau - 1.0 / 3.0).abs() < 1e-15);
        assert!((orders.pairs_right - 2.0 / 3.0).abs() < 1e-15);
        assert!((orders.regret_mean - 0.2).abs() < 1e-15 && orders.worst == "spd:0:0");
    }
}
