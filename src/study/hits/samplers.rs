//! The law of the lines, checked in every run; and the look-alikes, which the same checks must reject.
//!
//! Hits of a tree's boxes are blind to most wrong laws of directions, so a run that only compared hits with areas would
//! prove less than it seems to.

use glam::DVec3;

use crate::geom::{Aabb, Line, Span};
use crate::rays::checks::{SamplerChecks, check_sampler};
use crate::rays::{LineLaw, SurfaceLines};
use crate::scene::Scene;
use crate::stats::holm;

use crate::study::identity::{content, line_seed};
use crate::study::{LineRule, Watcher};

use super::asked::{Controls, HitsVsArea};
use crate::study::records::{SamplerRecord, Verdict};

/// Most lines of a scene that are checked.
const CHECKED: u64 = 1 << 18;

/// The law that a run's own lines are recorded under.
const OWN: &str = "study";

/// Sides of the box that the laws are compared on: no two equal, or symmetry would hide faults.
const SIDES: DVec3 = DVec3::new(1.0, 0.8, 0.5);

/// The run's own lines through every scene's box, checked.
pub fn check_scenes(seed: u64, lines: LineRule, scenes: &[Scene]) -> Vec<SamplerRecord> {
    let check = |scene: &Scene| {
        let n = lines.at_least().min(CHECKED);
        let (world, seed) = (scene.world, line_seed(seed, &content(scene)));
        let lines: Vec<Line> = SurfaceLines { world, seed }.range(0..n).collect();
        let checks = check_sampler(&world, seed, n, |i| (lines[i as usize], Span::FULL));
        record(OWN, true, &scene.name, n, checks)
    };
    scenes.iter().map(check).collect()
}

/// Laws that [`check_laws`] checks.
pub const LAWS: u64 = (LineLaw::EXACT.len() + LineLaw::WRONG.len()) as u64;

/// Every law there is through one box, checked.
pub fn check_laws(seed: u64, controls: Controls, watcher: &impl Watcher) -> Vec<SamplerRecord> {
    let lines = controls.lines;
    let world = Aabb::new(DVec3::ZERO, SIDES);
    let name = format!("box {} x {} x {}", SIDES.x, SIDES.y, SIDES.z);
    let laws = LineLaw::EXACT.map(|law| (law, true)).into_iter();
    let laws = laws.chain(LineLaw::WRONG.map(|law| (law, false)));
    let check = |(law, exact): (LineLaw, bool)| {
        let checks = check_sampler(&world, seed, lines, |i| law.sample(&world, seed, i));
        watcher.done(lines);
        record(law.name(), exact, &name, lines, checks)
    };
    laws.map(check).collect()
}

fn record(law: &str, exact: bool, scene: &str, lines: u64, p: SamplerChecks) -> SamplerRecord {
    SamplerRecord {
        law: law.into(),
        exact,
        scene: scene.into(),
        lines,
        boxes_p: p.boxes,
        mean_chord_p: p.mean_chord,
        fourth_chord_p: p.fourth_chord,
        directions_p: p.directions,
        triangles_p: p.triangles,
    }
}

/// Whether the run's lines passed, and whether the checks told right laws from wrong ones.
pub fn verdicts(asked: &HitsVsArea, records: &[SamplerRecord]) -> Vec<Verdict> {
    let (own, laws): (Vec<&SamplerRecord>, _) = records.iter().partition(|r| r.law == OWN);
    [own_verdict(asked, &own), law_verdict(asked, &laws)]
        .into_iter()
        .flatten()
        .collect()
}

/// Holm over the five checks of every scene's lines.
fn own_verdict(asked: &HitsVsArea, records: &[&SamplerRecord]) -> Option<Verdict> {
    let names = SamplerChecks::NAMES;
    let named = |r: &&SamplerRecord| {
        let scene = r.scene.clone();
        names
            .into_iter()
            .zip(r.p_values())
            .filter_map(move |(name, p)| Some((p?, name, scene.clone())))
    };
    let checks: Vec<(f64, &str, String)> = records.iter().flat_map(named).collect();
    let worst = (0..checks.len()).min_by(|&a, &b| checks[a].0.total_cmp(&checks[b].0))?;
    let p: Vec<f64> = checks.iter().map(|c| c.0).collect();
    let adjusted = holm(&p)[worst];
    Some(Verdict {
        name: "sampler".into(),
        held: adjusted >= asked.expect.gate,
        message: format!(
            "{} checks of the lines ({}): smallest p-value {:.2e} ({}, {}), after Holm {:.3}",
            p.len(),
            names.join(", "),
            p[worst],
            checks[worst].1,
            checks[worst].2,
            adjusted
        ),
    })
}

/// Wrong laws rejected, exact ones not.
fn law_verdict(asked: &HitsVsArea, records: &[&SamplerRecord]) -> Option<Verdict> {
    let Controls {
        lines,
        rejected_below,
        accepted_above,
    } = asked.controls?;
    let least = |r: &SamplerRecord| r.p_values().into_iter().flatten().fold(1.0, f64::min);
    let passes = |r: &SamplerRecord| {
        if r.exact {
            least(r) > accepted_above
        } else {
            least(r) < rejected_below
        }
    };
    let failed: Vec<&str> = records
        .iter()
        .filter(|r| !passes(r))
        .map(|r| r.law.as_str())
        .collect();
    let count = |exact| records.iter().filter(|r| r.exact == exact).count();
    let failed = if failed.is_empty() {
        String::new()
    } else {
        format!("; not so: {}", failed.join(", "))
    };
    Some(Verdict {
        name: "controls".into(),
        held: failed.is_empty(),
        message: format!(
            "{} wrong laws of lines rejected (p < {rejected_below:e} in at least one check), {} exact ones not \
             (p > {accepted_above:e} in all), {lines} lines each{failed}",
            count(false),
            count(true)
        ),
    })
}
