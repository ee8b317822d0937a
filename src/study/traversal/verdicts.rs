//! Verdicts of `traversal`: each expectation, and what the counts say of it.

use crate::study::records::{LinkRecord, TraversalRecord, Verdict};

use super::asked::Expect;
use super::way::Way;

/// Every verdict of a run.
pub fn all(expect: &Expect, walks: &[&TraversalRecord], links: &[&LinkRecord]) -> Vec<Verdict> {
    let mut all = vec![hits(walks), leaves(walks), identities(walks)];
    let bounds = expect.fall_backs;
    for (precision, bound) in [("f64", bounds.f64), ("f32", bounds.f32)] {
        all.extend(fall_backs(walks, precision, bound));
    }
    all.extend(fewer(walks, links));
    all
}

/// Rows of ways that have no stack.
fn others<'r>(walks: &[&'r TraversalRecord]) -> impl Iterator<Item = &'r TraversalRecord> + Clone {
    let others = |row: &&&TraversalRecord| row.way != Way::Stack.name();
    let rows: Vec<_> = walks.iter().filter(others).copied().collect();
    rows.into_iter()
}

fn sum<'r>(
    rows: impl Iterator<Item = &'r TraversalRecord>,
    of: fn(&TraversalRecord) -> u64,
) -> u64 {
    rows.map(of).sum()
}

fn hits(walks: &[&TraversalRecord]) -> Verdict {
    let tested = others(walks).filter(|row| row.differing_hits.is_some());
    let differing = sum(tested.clone(), |row| row.differing_hits.unwrap_or(0));
    Verdict {
        name: "hits".into(),
        held: differing == 0,
        message: format!(
            "{differing} of {} rays along restarts, links and face trees have another nearest hit than with a stack in the same \
             precision, to the last bit; fall-backs included",
            sum(tested, |row| row.cast)
        ),
    }
}

fn leaves(walks: &[&TraversalRecord]) -> Verdict {
    let differing = sum(others(walks), |row| row.differing_leaves);
    Verdict {
        name: "leaves".into(),
        held: differing == 0,
        message: format!(
            "{differing} of {} rays that did not fall back visit other leaves than with a stack, or in another order",
            sum(others(walks), |row| row.cast - row.fall_backs)
        ),
    }
}

fn identities(walks: &[&TraversalRecord]) -> Verdict {
    let all = walks.iter().copied();
    let broken = sum(all.clone(), |row| row.broken);
    Verdict {
        name: "identities".into(),
        held: broken == 0,
        message: format!(
            "{broken} of {} rays that did not fall back break an identity: every leaf but the first is reached by a link or a \
             restart, restarts visit the depth of every leaf, links and face trees no more inner nodes than the stack",
            sum(all, |row| row.cast - row.fall_backs)
        ),
    }
}

/// Each set of random rays along each way in each tree has its share; rays that meet a thin leaf are told, and not judged.
fn fall_backs(walks: &[&TraversalRecord], precision: &str, bound: f64) -> Option<Verdict> {
    let own = others(walks).filter(|row| row.random && row.precision == precision);
    let share = |row: &TraversalRecord| {
        (row.fall_backs - row.thin_fall_backs) as f64 / row.cast.max(1) as f64
    };
    let worst = own.clone().max_by(|a, b| share(a).total_cmp(&share(b)))?;
    let fell = sum(own.clone(), |row| row.fall_backs);
    let thin = sum(own.clone(), |row| row.thin_fall_backs);
    let of = sum(own, |row| row.cast);
    let most = match share(worst) {
        0.0 => String::new(),
        most => format!(
            ", most {most:.1e} of a set along a way ({} along {} on {})",
            worst.rays, worst.way, worst.scene
        ),
    };
    Some(Verdict {
        name: format!("certain-{precision}"),
        held: share(worst) <= bound,
        message: format!(
            "{fell} of {of} random rays fell back on the stack in {precision}: {thin} that meet a leaf thinner than 12 ulp of the root's \
             box, which are not judged, and {} others{most}; at most a share of {bound:.0e} wanted of each set along each way",
            fell - thin
        ),
    })
}

/// A tree of two leaves has nothing to save.
const SHALLOW: u64 = 1;

fn fewer(walks: &[&TraversalRecord], links: &[&LinkRecord]) -> Option<Verdict> {
    let deep = |row: &&&TraversalRecord| {
        let own = links.iter().find(|tree| tree.cell == row.cell);
        own.is_some_and(|tree| tree.depth > SHALLOW) && row.links > 0
    };
    let stack = |row: &TraversalRecord| {
        let same = |other: &&&TraversalRecord| {
            (&other.cell, &other.rays, &other.precision) == (&row.cell, &row.rays, &row.precision)
                && other.way == Way::Stack.name()
        };
        walks
            .iter()
            .find(same)
            .map_or(0, |other| other.inner_visits)
    };
    let own = walks.iter().filter(|row| row.way == Way::Links.name());
    let ratio = |row: &TraversalRecord| row.inner_visits as f64 / stack(row) as f64;
    let ratios: Vec<_> = own.filter(deep).map(|row| (*row, ratio(row))).collect();
    let (row, worst) = ratios.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(Verdict {
        name: "fewer-inner".into(),
        held: *worst < 1.0,
        message: format!(
            "along links each of {} sets of rays in a tree and a precision, of those that follow any, should visit fewer inner nodes \
             than with a stack: most {worst:.3} times as many ({} in {} on {})",
            ratios.len(),
            row.rays,
            row.precision,
            row.scene
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::traversal::asked::Shares;

    fn walk(way: Way, inner: u64, fall_backs: u64) -> TraversalRecord {
        TraversalRecord {
            cell: "a".into(),
            scene: "spd:tetra:3".into(),
            strategy: "sah".into(),
            stop: "cost-gain".into(),
            rays: "lines:nearest".into(),
            random: true,
            precision: "f64".into(),
            way: way.name().into(),
            cast: 1000,
            entered: 1000,
            hits: Some(10),
            inner_visits: inner,
            leaf_visits: 5000,
            object_tests: Some(70),
            links: 4000,
            fall_backs,
            thin_fall_backs: 0,
            differing_hits: Some(0),
            differing_leaves: 0,
            broken: 0,
        }
    }

    fn tree(depth: u64) -> LinkRecord {
        LinkRecord {
            cell: "a".into(),
            scene: "spd:tetra:3".into(),
            strategy: "sah".into(),
            stop: "cost-gain".into(),
            precision: "f64".into(),
            objects: 64,
            depth,
            inner_nodes: 9,
            leaves: 10,
            thin_leaves: 1,
            tree_bytes: 400,
            links_to_leaves: 30,
            links_to_inner: 10,
            links_outside: 20,
            link_bytes: 800,
            face_tree_bytes: 900,
        }
    }

    /// Names of the expectations that are missed.
    fn missed(walks: &[TraversalRecord], depth: u64) -> Vec<String> {
        let expect = Expect {
            fall_backs: Shares {
                f64: 1e-3,
                f32: 1e-3,
            },
        };
        let walks: Vec<_> = walks.iter().collect();
        let all = all(&expect, &walks, &[&tree(depth)]);
        let missed = all.into_iter().filter(|verdict| !verdict.held);
        missed.map(|verdict| verdict.name).collect()
    }

    #[test]
    fn what_differs_is_missed() {
        let good = [walk(Way::Stack, 9000, 0), walk(Way::Links, 8999, 1)];
        assert!(missed(&good, 5).is_empty());
        let with = |change: fn(&mut TraversalRecord)| {
            let mut rows = good.clone();
            change(&mut rows[1]);
            missed(&rows, 5)
        };
        assert_eq!(with(|row| row.differing_hits = Some(1)), ["hits"]);
        assert_eq!(with(|row| row.differing_leaves = 1), ["leaves"]);
        assert_eq!(with(|row| row.broken = 1), ["identities"]);
        assert_eq!(with(|row| row.fall_backs = 2), ["certain-f64"]);
        assert_eq!(with(|row| row.inner_visits = 9000), ["fewer-inner"]);
        // Rays through thin leaves and those of a picture may tie as they will, and a tree of two leaves has nothing to save.
        let thin = with(|row| (row.fall_backs, row.thin_fall_backs) = (900, 899));
        assert!(thin.is_empty());
        let more = with(|row| (row.fall_backs, row.thin_fall_backs) = (900, 898));
        assert_eq!(more, ["certain-f64"]);
        let picture = with(|row| {
            row.fall_backs = 900;
            row.random = false;
        });
        assert!(picture.is_empty());
        // Nor have rays that end in their first leaf.
        let first = with(|row| (row.inner_visits, row.links) = (9000, 0));
        assert!(first.is_empty());
        let shallow = [walk(Way::Stack, 1000, 0), walk(Way::Links, 1000, 0)];
        assert!(missed(&shallow, 1).is_empty());
        assert_eq!(missed(&shallow, 2), ["fewer-inner"]);
    }
}
