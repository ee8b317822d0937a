//! A run of this kind on one screen: the few rows that answer its question.

use super::SpeedVsError;
use super::coverage::kept;
use super::planes::{Timed, told};
use super::tables::{at_most, efficiency, is_exact};
use super::times::Of;
use crate::report::means::{arithmetic, geometric};
use crate::report::number::{counted, grouped, significant};
use crate::report::series::distinct;
use crate::report::shown::{change, known, ratio, text};
use crate::report::table::{Cell, Column, Table, fold};
use crate::study::records::{EnoughRecord, ErrorRecord, PrecisionRecord};

/// Searches shown at most.
const SEARCHES: usize = 4;

/// The tables, one below the other, of the parts that the run has.
pub fn tables(run: &SpeedVsError, width: usize) -> String {
    let own = [
        (!run.errors.is_empty()).then(|| samplers(run)),
        (!run.precision.is_empty()).then(|| precision(run)),
        searches(run, SEARCHES),
    ];
    let texts = own.iter().flatten().map(|table| table.to_text(width));
    let mut parts: Vec<String> = texts.collect();
    if !run.coverage.is_empty() {
        parts.push(format!("{}\n", fold(&coverage(run), width)));
    }
    parts.join("\n")
}

/// The wanted error nearest to this one is told of.
const WANTED: f64 = 1e-3;

/// Samplers at their most lines, over all scenes.
pub fn samplers(run: &SpeedVsError) -> Table {
    let most = at_most(run);
    let mean = |rays: &str, sampler: &str, of: &dyn Fn(&ErrorRecord) -> Option<f64>| {
        let own = most
            .iter()
            .filter(|row| (&*row.rays, &*row.sampler, &*row.quantity) == (rays, sampler, "C"));
        let (exact, others): (Vec<&ErrorRecord>, Vec<_>) = own.partition(|row| is_exact(row));
        if others.is_empty() && !exact.is_empty() {
            return text("exact");
        }
        let values = others.into_iter().filter_map(of).filter(|v| *v > 0.0);
        known(geometric(&values.collect::<Vec<_>>()), short)
    };
    let far = |row: &&EnoughRecord| (row.wanted / WANTED).ln().abs();
    let wanted = run.enough.iter();
    let wanted = wanted
        .min_by(|a, b| far(a).total_cmp(&far(b)))
        .map(|row| row.wanted);
    let row = |sampler: &str| {
        let fits = run
            .exponents
            .iter()
            .filter(|row| (&*row.rays, &*row.sampler, &*row.quantity) == ("lines", sampler, "C"));
        let exponents: Vec<f64> = fits.map(|row| row.exponent).collect();
        let enough = run.enough.iter().filter(|row| {
            (&*row.rays, &*row.sampler, Some(row.wanted)) == ("lines", sampler, wanted)
        });
        // The scene that takes the most.
        let enough = enough.max_by_key(|row| row.lines);
        vec![
            text(sampler),
            mean("lines", sampler, &|row| row.gain),
            known(arithmetic(&exponents), |mean| Cell::Value(mean, 2)),
            mean("lines", sampler, &|row| efficiency(run, row)),
            known(enough, |row| Cell::Count(row.lines)),
            known(enough.and_then(|row| run.enough_seconds(row)), short),
            mean("lines:nearest", sampler, &|row| row.gain),
            mean("lines:nearest", sampler, &|row| efficiency(run, row)),
        ]
    };
    let percent = wanted.map_or("–".to_owned(), |wanted| significant(100.0 * wanted, 1));
    let samplers = distinct(run.errors.iter().map(|row| row.sampler.as_str()));
    Table {
        caption: format!(
            "Samplers at their most lines, estimating C, means over the scenes but where exact (RMSE below 10⁻¹²). Gain: how many \
             times fewer lines reach the error of random ones; efficiency: times sooner; lines an error takes where it takes most, \
             seconds on one thread.{}",
            run.disturbed(Of::Samplers)
        ),
        columns: vec![
            Column::left("sampler", "sampler"),
            Column::right("gain", "gain"),
            Column::right("exponent", "exponent"),
            Column::right("efficiency", "efficiency"),
            Column::right(&format!("lines, {percent} %"), "lines"),
            Column::right("seconds", "seconds"),
            Column::right("nearest: gain", "nearest_gain"),
            Column::right("nearest: efficiency", "nearest_efficiency"),
        ],
        keys: 1,
        rows: samplers.into_iter().map(row).collect(),
    }
}

/// A large number without a fraction, its digits in groups; a very large one by its power of ten.
fn short(value: f64) -> Cell {
    if value < 1000.0 {
        ratio(value)
    } else if value < 1e7 {
        Cell::Count(value.round() as u64)
    } else {
        Cell::Rounded(value, 2)
    }
}

/// Kernels, all scenes together.
pub fn precision(run: &SpeedVsError) -> Table {
    let least = run.precision.iter().map(|row| row.offset).reduce(f64::min);
    let row = |kernel: &str| {
        let own = || run.precision.iter().filter(|row| row.kernel == kernel);
        let near = || own().filter(|row| Some(row.offset) == least);
        let rate = |family: &str, of: fn(&PrecisionRecord) -> [u64; 2]| {
            let mut sums = [0u64; 2];
            for row in near().filter(|row| row.family == family) {
                let [wrong, all] = of(row);
                sums = [sums[0] + wrong, sums[1] + all];
            }
            match sums {
                [_, 0] => Cell::Missing,
                [wrong, all] => short(1e9 * wrong as f64 / all as f64),
            }
        };
        let visits = |r: &PrecisionRecord| [r.tied_visits, r.visits];
        let hits = |r: &PrecisionRecord| [r.tied_hits, r.tests];
        let beyond =
            |r: &PrecisionRecord| r.wrong_visits + r.missed_visits + r.wrong_hits + r.missed_hits;
        let ns = |unit: &str| {
            let random = near().filter(|row| row.family == "random");
            let times: Vec<f64> = random.filter_map(|row| run.kernel_ns(row, unit)).collect();
            known(geometric(&times), ratio)
        };
        let from = |verdict: &str| {
            let own = own().filter(|row| row.verdict == verdict);
            known(own.map(|row| row.offset).reduce(f64::min), short)
        };
        vec![
            text(kernel),
            ns("visit"),
            ns("ray"),
            Cell::Count(near().map(beyond).sum()),
            rate("random", visits),
            rate("aimed", visits),
            rate("random", hits),
            rate("aimed", hits),
            from("warned"),
            from("refused"),
        ]
    };
    let kernels = distinct(run.precision.iter().map(|row| row.kernel.as_str()));
    Table {
        caption: format!(
            "Kernels. Wrong by more than 8 ulp, visits and hits together; at ties, wrong by less, per 10⁹, of random lines, beside them \
             of lines aimed at edges and corners; offsets from which on f32 is warned of and refused. Times on one thread.{}",
            run.disturbed(Of::Kernels)
        ),
        columns: vec![
            Column::left("kernel", "kernel"),
            Column::right("ns a visit", "visit_ns"),
            Column::right("ns a ray", "ray_ns"),
            Column::right("wrong", "wrong"),
            Column::right("tied visits", "tied_visits_random"),
            Column::right("aimed", "tied_visits_aimed"),
            Column::right("tied hits", "tied_hits_random"),
            Column::right("aimed", "tied_hits_aimed"),
            Column::right("warned", "warned_from"),
            Column::right("refused", "refused_from"),
        ],
        keys: 1,
        rows: kernels.into_iter().map(row).collect(),
    }
}

/// Plane searches that no other dominates in the mean over the scenes: at most so many, those with the cheapest trees.
pub fn searches(run: &SpeedVsError, most: usize) -> Option<Table> {
    let scenes = distinct(run.planes.iter().map(|row| row.scene.as_str()));
    let exact = |scene: &str| {
        let all = Timed::all(run, scene);
        let exact = all.iter();
        let mut exact = exact.filter(|one| one.row.strategy == "sah" && !one.row.clipped);
        exact.next().map(|one| one.seconds)
    };
    let mut means = Vec::new();
    for clipped in [false, true] {
        for strategy in distinct(run.planes.iter().map(|row| row.strategy.as_str())) {
            let own: Vec<_> = run
                .planes
                .iter()
                .filter(|row| row.strategy == strategy && row.clipped == clipped)
                .collect();
            let dearer: Vec<f64> = own.iter().map(|row| 1.0 + row.above_unclipped).collect();
            let slower = own
                .iter()
                .filter_map(|row| Some(run.build_seconds(row)? / exact(&row.scene)?));
            let slower: Vec<f64> = slower.collect();
            // Only searches of every scene have comparable means.
            if own.len() == scenes.len()
                && let Some((dearer, slower)) =
                    geometric(&dearer).zip(geometric(&slower).filter(|_| slower.len() == own.len()))
            {
                means.push((strategy, clipped, dearer, slower));
            }
        }
    }
    let dominated = |one: &(&str, bool, f64, f64)| {
        means.iter().any(|other| {
            other.2 <= one.2 && other.3 <= one.3 && (other.2 < one.2 || other.3 < one.3)
        })
    };
    let mut kept: Vec<_> = means.iter().filter(|one| !dominated(one)).collect();
    kept.sort_by(|a, b| a.2.total_cmp(&b.2));
    let left_out = kept.len().saturating_sub(most);
    kept.truncate(most);
    let rows = kept.into_iter().map(|(strategy, clipped, dearer, slower)| {
        vec![
            text(strategy),
            text(told(*clipped)),
            change(dearer - 1.0),
            ratio(*slower),
        ]
    });
    let rows: Vec<_> = rows.collect();
    let of = counted(scenes.len() as u64, "scene");
    let disturbed = run.disturbed(Of::Builds);
    let others = match left_out {
        0 => String::new(),
        n => format!(" Faster ones with dearer trees: {n} more."),
    };
    (!rows.is_empty()).then(|| Table {
        caption: format!(
            "Plane searches that no other betters in both, cost C and time of a build, against the exact search without clipping; \
             geometric means over {of}.{others}{disturbed}"
        ),
        columns: vec![
            Column::left("search", "strategy"),
            Column::left("objects", "clipped"),
            Column::right("C above exact, %", "above_pct"),
            Column::right("build over exact's", "over_exact"),
        ],
        keys: 2,
        rows,
    })
}

/// How many checks of intervals, tests and the stopping rule are kept, and which are not.
fn coverage(run: &SpeedVsError) -> String {
    let all = run.coverage.len() as u64;
    let missed: Vec<String> = run
        .coverage
        .iter()
        .filter(|row| !kept(row))
        .map(|r| {
            let (n, of) = (grouped(r.counted), grouped(r.runs));
            format!(
                "{}, {}: {n} of {of}, not {} to {}",
                r.check, r.sampler, r.least, r.most
            )
        })
        .collect();
    let within = all - missed.len() as u64;
    let mut text = format!(
        "Intervals, tests and the stopping rule: {within} of {} within their bands.",
        counted(all, "check")
    );
    if !missed.is_empty() {
        text += &format!(" Outside: {}.", missed.join("; "));
    }
    text
}
