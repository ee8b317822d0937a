//! Verdicts of `strategies`: each expectation of the plan, and what the counts say of it.

use crate::study::hits;
use crate::study::records::{CellRecord, Estimate, RayRecord, Verdict};
use crate::tracer::{PIXELS, RayKind};

use super::asked::Strategies;

/// Eye rays that hit something in each scene of the databases, by brute force over the original programs' output.
const FACTS: &str = include_str!("../../../data/reference/spd-facts.csv");

/// Every verdict of a run.
pub fn all(
    asked: &Strategies,
    cells: &[CellRecord],
    rays: &[&RayRecord],
    estimates: &[Estimate],
) -> Vec<Verdict> {
    let counts: Vec<&Estimate> = estimates.iter().filter(|e| e.name != "slope").collect();
    let mut all = vec![hits::verdicts::identities(cells), brute_force(asked, cells)];
    all.extend(primary_hits(asked, rays));
    all.extend(hits::verdicts::simultaneous(
        asked.expect.family,
        "counts-cover",
        "the predicted count",
        &counts,
    ));
    all
}

/// A ray that hits something else than by brute force ends the run with an error, so a finished run has none.
fn brute_force(asked: &Strategies, cells: &[CellRecord]) -> Verdict {
    Verdict {
        name: "brute-force".into(),
        held: true,
        message: format!(
            "{} random eye rays of each of {} trees, and a quarter as many shadow and secondary rays each, hit the same object \
             at the same t, bit for bit, as without a tree; every ray that hits something does so in \
             all trees, and one in sixteen of the others, tested again, in none",
            asked.checked,
            cells.len()
        ),
    }
}

/// Eye rays that hit anything, against the facts known of the scenes: only of full pictures.
fn primary_hits(asked: &Strategies, rays: &[&RayRecord]) -> Option<Verdict> {
    let within = asked.expect.primary_hits_within?;
    let mut seen = std::collections::BTreeMap::new();
    for row in rays.iter().filter(|r| r.kind == RayKind::Primary.name()) {
        if let Some(fact) = fact(&row.scene) {
            seen.insert(&row.scene, (row.hits, fact));
        }
    }
    let apart = seen
        .iter()
        .map(|(scene, (hits, fact))| (hits.abs_diff(*fact), scene));
    let (worst, scene) = apart.max()?;
    Some(Verdict {
        name: "primary-hits".into(),
        held: worst <= within,
        message: format!(
            "eye rays that hit something, against the numbers of the original geometry: {} scenes, largest difference {worst} \
             of {} rays ({scene}), at most {within} wanted",
            seen.len(),
            u64::from(PIXELS + 1).pow(2)
        ),
    })
}

/// The number of eye rays that hit something, where it is known.
fn fact(scene: &str) -> Option<u64> {
    let wanted: Vec<&str> = scene.strip_prefix("spd:")?.split(':').collect();
    let mut reader = csv::Reader::from_reader(FACTS.as_bytes());
    let header = reader.headers().ok()?.clone();
    let column = header.iter().position(|name| name == "primary_hits_513")?;
    let mut rows = reader.records().filter_map(Result::ok);
    let row =
        rows.find(|row| [row.get(0), row.get(1)] == [Some(wanted[0]), wanted.get(1).copied()])?;
    row.get(column)?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facts_are_found() {
        assert_eq!(fact("spd:tetra:6"), Some(49_949));
        assert_eq!(fact("spd:tetra:99"), None);
        assert_eq!(fact("simple:soup:2000"), None);
    }
}
