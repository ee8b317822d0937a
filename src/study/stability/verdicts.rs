//! What is expected of the runs, and what came of it.

use crate::study::kernel::Kernel;
use crate::study::records::{CaseRecord, MetamorphicRecord, RandomRecord, Verdict};

use super::Found;

/// The verdicts on everything found.
pub fn verdicts(found: &[Found]) -> Vec<Verdict> {
    let cases: Vec<&CaseRecord> = found.iter().flat_map(|f| &f.cases).collect();
    let random: Vec<&RandomRecord> = found.iter().flat_map(|f| &f.random).collect();
    let rows: Vec<&MetamorphicRecord> = found.iter().flat_map(|f| &f.metamorphic).collect();
    let mut verdicts = vec![on_cases(&cases), on_oracle(&random)];
    let padded = Kernel::F32Padded.name();
    if cases.iter().any(|row| row.kernel == padded) || random.iter().any(|row| row.kernel == padded)
    {
        verdicts.push(on_padded(&cases, &random));
    }
    verdicts.push(on_metamorphic(&rows));
    verdicts
}

/// Names of cases told where they fail.
const TOLD: usize = 12;

/// Every cell that is demanded passes, or is off by no more than is allowed.
fn on_cases(rows: &[&CaseRecord]) -> Verdict {
    let mut names: Vec<&str> = rows.iter().map(|row| &*row.case).collect();
    names.dedup();
    let demanded = rows.iter().filter(|row| row.demanded).count();
    let is_allowed = |row: &CaseRecord| ["pass", "off"].contains(&&*row.outcome);
    let mut failed: Vec<&str> = rows
        .iter()
        .filter(|row| row.demanded && !is_allowed(row))
        .map(|row| &*row.case)
        .collect();
    let cells = failed.len();
    failed.dedup();
    let number = |demanded: bool, outcome: &str| {
        rows.iter()
            .filter(|row| row.demanded == demanded && row.outcome == outcome)
            .count()
    };
    let told = match cells {
        0 => "all do".into(),
        _ => {
            let more = if failed.len() > TOLD { ", ..." } else { "" };
            format!(
                "{cells} do not: {}{more}",
                failed[..failed.len().min(TOLD)].join(", ")
            )
        }
    };
    Verdict {
        name: "cases".into(),
        held: cells == 0,
        message: format!(
            "{} hard cases in {} cells (strategy by kernel), {demanded} of which must be right: {told}, {} of them off by no more than \
             allowed (f64: t of a hit by less than 8 ulp; padded f32: hits too many); of the others, {} are off, {} refused with a message and {} \
             failed",
            names.len(),
            rows.len(),
            number(true, "off"),
            number(false, "off"),
            number(false, "refused"),
            number(false, "failed")
        ),
    }
}

/// f64 judges wrongly in ties alone.
fn on_oracle(rows: &[&RandomRecord]) -> Verdict {
    let of = |against: &str, part: fn(&RandomRecord) -> u64| -> u64 {
        let own = rows
            .iter()
            .filter(|row| row.kernel == Kernel::F64.name() && row.against == against);
        own.map(|row| part(row)).sum()
    };
    let wrong = |against| of(against, |row| row.wrong + row.missed);
    let told = |against, names: &str| {
        format!(
            "{:.3e} {names} ({:.2e} hit): {} wrong; of {} within 8 ulp of a tie {} wrong",
            of(against, |row| row.cases) as f64,
            of(against, |row| row.hits) as f64,
            wrong(against),
            of(against, |row| row.ties),
            of(against, |row| row.tied_wrong)
        )
    };
    Verdict {
        name: "oracle".into(),
        held: wrong("box") + wrong("triangle") == 0,
        message: format!(
            "f64 against exact integers, random lines and lines aimed at edges and corners: {}; {}",
            told("box", "visits of nodes"),
            told("triangle", "tests of triangles")
        ),
    }
}

/// Padded planes never lose a node.
fn on_padded(cases: &[&CaseRecord], rows: &[&RandomRecord]) -> Verdict {
    let own = || {
        rows.iter()
            .filter(|row| row.kernel == Kernel::F32Padded.name() && row.against == "box")
    };
    let unpadded = rows
        .iter()
        .filter(|row| row.kernel == Kernel::F32.name() && row.against == "box");
    let sum = |part: fn(&RandomRecord) -> u64| own().map(|row| part(row)).sum::<u64>();
    let missed = |row: &RandomRecord| row.missed + row.tied_missed;
    let failed =
        |row: &&&CaseRecord| row.kernel == Kernel::F32Padded.name() && row.outcome == "failed";
    let lost = sum(missed);
    let in_cases = cases.iter().filter(failed).count();
    Verdict {
        name: "padded".into(),
        held: lost as usize + in_cases == 0,
        message: format!(
            "f32 with padded planes missed {lost} of {:.2e} nodes that its lines hit (unpadded: {}), and fails in {in_cases} cells of the hard \
             cases; it visited {} of {:.2e} that they miss",
            sum(|row| row.hits) as f64,
            unpadded.map(|row| missed(row)).sum::<u64>(),
            sum(|row| row.wrong + row.tied_wrong - row.tied_missed),
            sum(|row| row.cases - row.hits) as f64,
        ),
    }
}

/// Transforms that round nothing change nothing.
fn on_metamorphic(rows: &[&MetamorphicRecord]) -> Verdict {
    let nodes: u64 = rows.iter().map(|row| row.differing_nodes).sum();
    let hits: u64 = rows.iter().map(|row| row.differing_hits).sum();
    let lines: u64 = rows.iter().map(|row| row.lines).sum();
    let mut names: Vec<&str> = rows.iter().map(|row| &*row.transform).collect();
    names.sort_unstable();
    names.dedup();
    Verdict {
        name: "metamorphic".into(),
        held: nodes + hits == 0,
        message: format!(
            "{} transforms of tree and lines together (powers of two, reflections, axes), {lines} lines: the hits of {nodes} nodes \
             differ, and {hits} nearest hits or their n_K, n_B and n_t",
            names.len()
        ),
    }
}
