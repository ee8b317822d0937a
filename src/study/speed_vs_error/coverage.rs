//! Whether intervals cover what they should, tests reject as often as they should, and a wanted error is kept: over many
//! independent runs of one small scene.

use rayon::prelude::*;

use crate::kd::stream::Streams;
use crate::kd::{Counts, Prediction, Tree, predict};
use crate::rays::{PointSet, Sampler};
use crate::stats::{ScoreMoments, binomial_tail, normal_quantile, student_p, uniform_p};
use crate::study::hits::cell::{CellPlan, compare, plant};
use crate::study::identity::line_seed;
use crate::study::records::{CellRecord, CoverageRecord, Verdict};
use crate::study::{LineRule, Watcher};

use super::asked::{Coverage, SpeedVsError};
use super::{Found, Piece};

/// Level of the intervals.
const LEVEL: f64 = 0.95;

/// Levels of the tests.
const LEVELS: [f64; 2] = [0.05, 0.01];

/// Chance that a correct program's count of covered or rejected runs lies outside its band.
const FALSE_ALARM: f64 = 0.001;

/// Sets whose scatter gives an interval where the lines of one are not independent.
const SETS: u64 = 32;

/// Lines of each of them: so many times fewer than of a run of independent lines.
const FEWER: u64 = 16;

/// Relative differences below this are rounding: what no line changes has no variance.
const ROUNDING: f64 = 1e-12;

/// Share of runs whose true error is within the wanted one, at least.
const KEPT: f64 = 0.9;

/// Units of progress of a scene.
pub fn units(asked: &Coverage) -> u64 {
    u64::from(asked.seeds) + 2 * u64::from(asked.replicates) + u64::from(asked.stops)
}

/// Measure a scene.
///
/// # Errors
/// If the program contradicts itself.
pub fn measure(
    asked: &Coverage,
    piece: &Piece<'_>,
    watcher: &impl Watcher,
) -> Result<Found, String> {
    let (tree, _) = plant(piece.scene, &piece.rules)?;
    let prediction = predict(&tree);
    let runs = |kind: &str, runs: u32, lines: LineRule| -> Result<Vec<CellRecord>, String> {
        let run = |i: u32| {
            let plan = CellPlan {
                id: piece.id.clone(),
                scene: piece.scene,
                rules: piece.rules,
                seed: piece.seed,
                line_seed: line_seed(piece.seed, &format!("{kind} {i}")),
                lines,
                nodes: false,
            };
            let (found, _) = compare(&plan, &tree, &prediction, &())?;
            watcher.done(1);
            Ok(found.record)
        };
        (0..runs).into_par_iter().map(run).collect()
    };
    let fixed = runs("coverage", asked.seeds, LineRule::exactly(asked.lines)?)?;
    let mut rows = Rows::of(piece);
    rows.of_runs(&fixed, asked.replicates as usize);
    for sampler in [Sampler::Stratified, Sampler::Sobol] {
        let sets = Sets {
            tree: &tree,
            prediction: &prediction,
            seed: line_seed(piece.seed, sampler.name()),
            sampler,
            lines: sampler.nearest_size(asked.lines / FEWER),
        };
        rows.of_sets(&sets, piece, asked.replicates, watcher);
    }
    let stopped = runs("error", asked.stops, LineRule::for_cost_error(asked.error)?)?;
    rows.of_stopped(&stopped, asked.error);
    Ok(Found {
        coverage: rows.all,
        ..Found::default()
    })
}

/// Sets of lines that are not independent within a set.
struct Sets<'a> {
    tree: &'a Tree,
    prediction: &'a Prediction,
    seed: u64,
    sampler: Sampler,
    lines: u64,
}

impl Sets<'_> {
    /// Mean n_K, n_B, n_t and C of a set.
    fn means(&self, piece: &Piece<'_>, set: u64, streams: &mut Streams) -> [f64; 4] {
        let points = PointSet::new(self.sampler, self.seed, set, self.lines);
        let lines: Vec<_> = points.lines(&self.tree.world, 0..self.lines).collect();
        let mut counts = Counts::new(self.tree);
        streams.count(self.tree, &lines, &mut counts);
        let n = self.lines as f64;
        let [k, b, t] = [counts.work.inner, counts.work.leaves, counts.work.tests]
            .map(|count| count as f64 / n);
        [k, b, t, piece.rules.cost.cost(k, b, t)]
    }

    /// Whether the intervals of n_K, n_B, n_t and C from the sets of run `i` cover what is predicted.
    fn covers(&self, piece: &Piece<'_>, i: u64) -> [bool; 4] {
        let mut streams = Streams::default();
        let mut moments = ScoreMoments::default();
        for set in i * SETS..(i + 1) * SETS {
            moments.push(self.means(piece, set, &mut streams));
        }
        let mean = moments.mean().expect("there are sets");
        let covariance = moments.covariance().expect("there are two sets");
        let truth = predicted(piece, self.prediction);
        std::array::from_fn(|q| {
            let se = (covariance[q][q] / SETS as f64).sqrt();
            let off = mean[q] - truth[q];
            off.abs() <= ROUNDING * truth[q]
                || student_p(off / se, (SETS - 1) as f64) >= 1.0 - LEVEL
        })
    }
}

/// What is predicted of n_K, n_B, n_t and C.
fn predicted(piece: &Piece<'_>, p: &Prediction) -> [f64; 4] {
    [
        p.n_k,
        p.n_b,
        p.n_t,
        piece.rules.cost.cost(p.n_k, p.n_b, p.n_t),
    ]
}

/// Names of these quantities.
const QUANTITIES: [&str; 4] = ["n_K", "n_B", "n_t", "C"];

/// The rows, as they come.
struct Rows {
    scene: String,
    all: Vec<CoverageRecord>,
}

impl Rows {
    fn of(piece: &Piece<'_>) -> Self {
        Self {
            scene: piece.scene.name.clone(),
            all: Vec::new(),
        }
    }

    /// Add a row: of `runs`, so many `counted`, with its band.
    fn add(
        &mut self,
        check: &str,
        sampler: Sampler,
        lines: u64,
        nominal: f64,
        (counted, runs): (usize, usize),
        band: [u64; 2],
    ) {
        self.all.push(CoverageRecord {
            check: check.into(),
            scene: self.scene.clone(),
            sampler: sampler.to_string(),
            lines,
            nominal,
            runs: runs as u64,
            counted: counted as u64,
            least: band[0],
            most: band[1],
        });
    }

    /// Runs of independent lines: the slope's interval and the tests; of the first of them the counts' intervals too.
    fn of_runs(&mut self, runs: &[CellRecord], replicates: usize) {
        let lines = runs.first().map_or(0, |r| r.lines);
        let z = normal_quantile(LEVEL);
        let within = |value: f64, se: Option<f64>, truth: f64| {
            Some((value - truth).abs() <= z * se? + ROUNDING * truth)
        };
        let interval = |rows: &mut Self, check: &str, covers: Vec<bool>| {
            let n = covers.len();
            let covered = covers.iter().filter(|c| **c).count();
            let band = band(n as u64, LEVEL);
            rows.add(check, Sampler::Random, lines, LEVEL, (covered, n), band);
        };
        let slopes = runs
            .iter()
            .filter_map(|r| within(r.slope?, r.slope_se, 1.0));
        interval(self, "slope", slopes.collect());
        let first = &runs[..replicates.min(runs.len())];
        type Of = fn(&CellRecord) -> (f64, Option<f64>, f64);
        let quantities: [Of; 4] = [
            |r| (r.n_k_counted, r.n_k_se, r.n_k_predicted),
            |r| (r.n_b_counted, r.n_b_se, r.n_b_predicted),
            |r| (r.n_t_counted, r.n_t_se, r.n_t_predicted),
            |r| (r.c_counted, r.c_se, r.c_predicted),
        ];
        for (name, of) in QUANTITIES.into_iter().zip(quantities) {
            let covers = first.iter().filter_map(|r| {
                let (value, se, truth) = of(r);
                within(value, se, truth)
            });
            interval(self, name, covers.collect());
        }
        // The smallest tail is Bonferroni's, so too cautious by design: it may reject as rarely as it likes.
        type P = fn(&CellRecord) -> Option<f64>;
        let tests: [(&str, P, bool); 3] = [
            ("p-slope", |r| r.slope_p, true),
            ("p-tail", |r| r.tail_p, false),
            ("p-contrasts", |r| r.hotelling_p, true),
        ];
        for (name, p, exact) in tests {
            let p: Vec<f64> = runs.iter().filter_map(p).collect();
            for level in LEVELS {
                let rejected = p.iter().filter(|p| **p < level).count();
                let [least, most] = band(p.len() as u64, level);
                let band = [if exact { least } else { 0 }, most];
                self.add(
                    name,
                    Sampler::Random,
                    lines,
                    level,
                    (rejected, p.len()),
                    band,
                );
            }
            if exact {
                // Kolmogorov's test, whether the p-values are uniform.
                let rejected = usize::from(uniform_p(&p).is_some_and(|p| p < FALSE_ALARM));
                let name = format!("uniform-{name}");
                self.add(
                    &name,
                    Sampler::Random,
                    lines,
                    FALSE_ALARM,
                    (rejected, 1),
                    [0, 0],
                );
            }
        }
    }

    /// Runs of sets of lines that are not independent: an interval from the scatter of each run's sets.
    fn of_sets(&mut self, sets: &Sets<'_>, piece: &Piece<'_>, runs: u32, watcher: &impl Watcher) {
        let run = |i: u32| {
            let covers = sets.covers(piece, i.into());
            watcher.done(1);
            covers
        };
        let covers: Vec<[bool; 4]> = (0..runs).into_par_iter().map(run).collect();
        for (q, name) in QUANTITIES.into_iter().enumerate() {
            let covered = covers.iter().filter(|c| c[q]).count();
            let lines = SETS * sets.lines;
            let of = (covered, covers.len());
            let band = band(covers.len() as u64, LEVEL);
            self.add(name, sets.sampler, lines, LEVEL, of, band);
        }
    }

    /// Runs whose number of lines a wanted error of C settled: how many kept it.
    fn of_stopped(&mut self, runs: &[CellRecord], error: f64) {
        let kept = |r: &&CellRecord| (r.c_counted - r.c_predicted).abs() <= error * r.c_predicted;
        let kept = runs.iter().filter(kept).count();
        let n = runs.len().max(1) as u64;
        let mean = runs.iter().map(|r| r.lines).sum::<u64>() / n;
        let least = (KEPT * runs.len() as f64).ceil() as u64;
        let band = [least, runs.len() as u64];
        let of = (kept, runs.len());
        self.add("error", Sampler::Random, mean, error, of, band);
    }
}

/// The counts of `runs` that chance p gives with all but [`FALSE_ALARM`].
fn band(runs: u64, p: f64) -> [u64; 2] {
    let likely = |count: &u64| binomial_tail(*count, runs, p) >= FALSE_ALARM;
    let least = (0..=runs).find(likely).unwrap_or(0);
    let most = (least..=runs).rev().find(likely).unwrap_or(runs);
    [least, most]
}

/// What came of the expectations.
pub fn verdicts(_: &SpeedVsError, found: &[Found]) -> Vec<Verdict> {
    let rows: Vec<&CoverageRecord> = found.iter().flat_map(|f| &f.coverage).collect();
    let held = |row: &CoverageRecord| (row.least..=row.most).contains(&row.counted);
    let told = |row: &CoverageRecord| {
        let CoverageRecord {
            check,
            sampler,
            nominal,
            runs,
            counted,
            least,
            most,
            ..
        } = row;
        format!(
            "{check} by {sampler} lines at {nominal}: {counted} of {runs}, {least} to {most} expected"
        )
    };
    let verdict = |name: &str, of: &dyn Fn(&CoverageRecord) -> bool, what: &str| {
        let own: Vec<&CoverageRecord> = rows.iter().copied().filter(|row| of(row)).collect();
        let missed: Vec<String> = own.iter().filter(|r| !held(r)).map(|r| told(r)).collect();
        let told = match missed[..] {
            [] => String::new(),
            _ => format!("; outside: {}", missed.join("; ")),
        };
        (!own.is_empty()).then(|| Verdict {
            name: name.into(),
            held: missed.is_empty(),
            message: format!("{} of {} {what}{told}", own.len() - missed.len(), own.len()),
        })
    };
    let is_test = |row: &CoverageRecord| row.check.contains("p-");
    let is_error = |row: &CoverageRecord| row.check == "error";
    let error = rows.iter().find(|row| is_error(row)).map(|row| Verdict {
        name: "error".into(),
        held: held(row),
        message: format!(
            "--error {}: the true error of C is within the wanted one in {} of {} runs, at least {} wanted; {} lines a run in \
             the mean",
            row.nominal, row.counted, row.runs, row.least, row.lines
        ),
    });
    [
        verdict(
            "coverage",
            &|row| !is_test(row) && !is_error(row),
            "95 % intervals cover as often as they should",
        ),
        verdict("levels", &is_test, "tests reject as often as they should"),
        error,
    ]
    .into_iter()
    .flatten()
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_are_exact() {
        // Exact binomial tails of 1/2000 on either side.
        assert_eq!(band(1000, 0.05), [29, 74]);
        assert_eq!(band(1000, 0.01), [2, 22]);
        let [least, most] = band(500, 0.95);
        assert!((458..=460).contains(&least) && (489..=491).contains(&most));
    }
}
