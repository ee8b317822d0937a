//! When links pay, in sentences made from the numbers.

use std::fmt::Write;

use super::Traversal;
use super::against::{Against, PRECISIONS, WAYS, averages, memory as factor, outcomes};
use super::figures::{BELIEF, disturbed, disturbed_builds, sample};
use crate::report::number::{counted, grouped, significant};
use crate::report::series::distinct;
use crate::report::strategies::averages::Averages;
use crate::report::text::capitalised;
use crate::study::records::TraversalRecord;

/// The findings, as a list.
pub fn text(run: &Traversal) -> String {
    let mut text = String::from(
        "Each way beside the stack in the same tree and precision: geometric means of the ratios over scenes, with their 99 % intervals \
         (three kinds of scenes or more; Student's t of the logarithms, the sizes of one scene together being one observation) and their \
         ends. Faster or slower: the ratio of seconds is further from 1 than it can be off: ",
    );
    let _ = writeln!(text, "{BELIEF}.\n");
    for line in all(run) {
        let _ = writeln!(text, "- {line}");
    }
    text
}

/// A sentence each.
pub fn all(run: &Traversal) -> Vec<String> {
    let mut all = Vec::new();
    for way in WAYS {
        for rays in run.sets() {
            let told = PRECISIONS.iter();
            let told = told.filter_map(|precision| of(precision, &run.of(rays, precision, way)));
            let told: Vec<String> = told.collect();
            if !told.is_empty() {
                all.push(format!(
                    "{}, {rays}. {}.",
                    capitalised(way),
                    told.join(". ")
                ));
            }
        }
    }
    all.extend(memory(run));
    all.extend(building(run));
    all.extend(where_they_pay(run));
    all.extend(fall_backs(run));
    all.extend(disturbances(run));
    all
}

/// "0.93 times WHAT (0.85 to 1.02; least 0.6 on X, most 1.3 on Y)".
fn times(averages: &Averages, what: &str) -> String {
    let show = |value: f64| significant(value, 3);
    let interval = averages.interval.map_or(String::new(), |[lo, hi]| {
        format!("{} to {}; ", show(lo), show(hi))
    });
    let ((best, least), (worst, most)) = (averages.best, averages.worst);
    format!(
        "{} times {what} ({interval}least {} on {best}, most {} on {worst})",
        show(averages.geometric),
        show(least),
        show(most)
    )
}

/// One way, set of rays and precision.
fn of(precision: &str, rows: &[Against]) -> Option<String> {
    let inner = averages(rows, Against::inner)?;
    let mut text = format!(
        "{precision}: {} times the stack's inner nodes",
        significant(inner.geometric, 3)
    );
    if let Some(seconds) = averages(rows, Against::seconds) {
        let [faster, slower, undecided] = outcomes(rows);
        let _ = write!(
            text,
            ", {}; faster on {faster} of {}, slower on {slower}, undecided on {undecided}",
            times(&seconds, "its seconds"),
            counted(seconds.scenes as u64, "scene")
        );
    }
    Some(text)
}

/// What links take of memory.
fn memory(run: &Traversal) -> Vec<String> {
    let sentence = |precision: &&str| {
        let of = |way: &str, what: &str| {
            let own = run.links.iter().filter(|row| row.precision == *precision);
            let ratios = own.filter_map(|row| Some((row.scene.as_str(), factor(row, way)?)));
            let averages = Averages::of(&ratios.collect::<Vec<_>>());
            averages.map(|averages| times(&averages, what))
        };
        Some(format!(
            "Memory, {precision}. Tree and links: {}. Tree and links through face trees: {}.",
            of("links", "the bytes of the tree alone")?,
            of("face-trees", "these")?
        ))
    };
    PRECISIONS.iter().filter_map(sentence).collect()
}

/// What links take to build.
fn building(run: &Traversal) -> Option<String> {
    let of = |way: &str, what: &str| {
        let own = run
            .links
            .iter()
            .filter(|row| row.precision == PRECISIONS[0]);
        let ratios = own.filter_map(|row| Some((row.scene.as_str(), run.building(row, way)?)));
        let averages = Averages::of(&ratios.collect::<Vec<_>>());
        averages.map(|averages| times(&averages, what))
    };
    Some(format!(
        "Building, f64. Links: {}. Links and face trees: {}.",
        of("links", "the seconds of the tree")?,
        of("face-trees", "these")?
    ))
}

/// Parts that trees are ordered into.
const PARTS: usize = 3;

/// Seconds along links on the smallest and the largest trees, and on those where links save most and least.
fn where_they_pay(run: &Traversal) -> Vec<String> {
    let of_set = |rays: &str| {
        let rows = run.of(rays, PRECISIONS[0], WAYS[0]);
        let by_bytes = |row: &Against| Some(run.tree(row.own)?.tree_bytes as f64);
        let by = |key: &dyn Fn(&Against) -> Option<f64>| {
            let keyed = rows.iter().filter_map(|row| Some((key(row)?, *row)));
            keyed.filter(|(_, row)| row.speed().is_some()).collect()
        };
        [
            parts("bytes of the tree", by(&by_bytes)),
            parts("inner nodes over the stack's", by(&|row| row.inner())),
        ]
        .map(|parts| Some(format!("Links, {rays}, f64, {}.", parts?)))
    };
    let sets = run.sets();
    sets.into_iter().flat_map(of_set).flatten().collect()
}

/// Trees in the order of a key, in parts: the keys' ends and the seconds of each.
fn parts(key: &str, mut rows: Vec<(f64, Against)>) -> Option<String> {
    if rows.len() < PARTS {
        return None;
    }
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let part = |part: &[(f64, Against)]| {
        let own: Vec<Against> = part.iter().map(|(_, row)| *row).collect();
        let seconds = averages(&own, Against::seconds)?;
        let [faster, ..] = outcomes(&own);
        let ((first, _), (last, _)) = part.first().zip(part.last())?;
        Some(format!(
            "{} to {}: {} times the stack's seconds, faster on {faster} of {}",
            significant(*first, 3),
            significant(*last, 3),
            significant(seconds.geometric, 3),
            own.len()
        ))
    };
    let chunks = rows.chunks(rows.len().div_ceil(PARTS));
    let parts: Vec<String> = chunks.filter_map(part).collect();
    Some(format!("by {key}. {}", parts.join("; ")))
}

/// Who falls back on the stack, and how many of them meet thin leaves.
fn fall_backs(run: &Traversal) -> Vec<String> {
    let of_set = |rays: &str, precision: &str| {
        let rows: Vec<&TraversalRecord> = WAYS
            .iter()
            .flat_map(|way| run.of(rays, precision, way))
            .map(|row| row.own)
            .collect();
        let sum = |of: fn(&TraversalRecord) -> u64| rows.iter().map(|row| of(row)).sum::<u64>();
        let others = |row: &TraversalRecord| row.fall_backs - row.thin_fall_backs;
        let on: Vec<&str> = distinct(
            rows.iter()
                .filter(|row| others(row) > 0)
                .map(|row| row.scene.as_str()),
        );
        let on = match on.len() {
            0 => String::new(),
            _ => format!(", on {}", on.join(", ")),
        };
        (!rows.is_empty()).then(|| {
            format!(
                "Fall-backs, {rays}, {precision}. {} of {} rays along the three ways; {} that meet a leaf thinner than 12 ulp of the root's \
                 longest side, {} others{on}.",
                grouped(sum(|row| row.fall_backs)),
                grouped(sum(|row| row.cast)),
                grouped(sum(|row| row.thin_fall_backs)),
                grouped(sum(others)),
            )
        })
    };
    let sets = run.sets().into_iter();
    sets.flat_map(|rays| PRECISIONS.map(|precision| of_set(rays, precision)))
        .flatten()
        .collect()
}

/// How far the seconds can be believed.
fn disturbances(run: &Traversal) -> Option<String> {
    let timed = run.walks.iter().any(|row| run.time_of(row).is_some());
    timed.then(|| {
        format!(
            "Rays.{}{} Builds.{}",
            sample(run),
            disturbed(run),
            disturbed_builds(run)
        )
    })
}
