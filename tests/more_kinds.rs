//! The kinds `termination`, `split-cost` and `assumptions`, and slices, as a user meets them: files, resumption, wrong input.
#![allow(clippy::unwrap_used, missing_docs)]

mod runs;

use std::collections::BTreeMap;
use std::path::Path;

use predicates::prelude::*;
use predicates::str::contains;
use runs::{contents, folder, validate};
use sahlab::study::records::{
    BiasRecord, CurveNodeRecord, ExactRecord, GroupRecord, MedianRecord, MetricRecord,
    OctreeRecord, OrderRecord, SliceRecord, Summary, VisitRecord, WorkRecord,
};
use serde::de::DeserializeOwned;

const TERMINATION: &str = r#"kind = "termination"
question = "When is a node a leaf?"
seed = 5
scenes = ["spd:balls:2", "spd:tree:3"]
strategies = ["sah", "spatial-median"]
stops = ["objects:1", "objects:8", "cost-gain", "depth:4"]
lines = { slope_error = 1.0, min = 2048, max = 2048 }
pixels = 16
checked = 50
cost = { c_k = 15.0, c_b = 0.0, c_t = 20.0 }
timing = { rounds = 2, builds = 2, pass_s = 0.002 }
slice = { scene = "spd:balls:2", axis = "z", at = 0.3 }
expect = { family = 0.001 }
"#;

const SPLIT_COST: &str = r#"kind = "split-cost"
question = "Where is the cheapest plane?"
seed = 5
scenes = ["spd:tree:5", "simple:soup:300", "simple:flat:300"]
stop = "objects:2:12"
samples = 10
curves = [{ scene = "spd:tree:5", rank = 1 }, { scene = "simple:soup:300", rank = 2 }]
octree = { limit = 3, levels = 3, lines = 500 }
cost = { c_k = 15.0, c_b = 0.0, c_t = 20.0 }
expect = { equal_within = 1e-12 }
"#;

const ASSUMPTIONS: &str = r#"kind = "assumptions"
question = "What is the metric worth where its assumptions fail?"
seed = 5
scenes = ["spd:balls:2", "simple:clustered:200"]
strategies = ["spatial-median", "sah"]
stop = "objects:2:10"
rays = ["lines", "beam", "volume-ray", "volume-segment", "lines:nearest", "volume-segment:any", "primary", "shadow"]
number = 2048
pixels = 12
figure = { scene = "spd:balls:2", strategy = "sah" }
cost = { c_k = 15.0, c_b = 0.0, c_t = 20.0 }
expect = { family = 1e-4, tau = 0.0, regret = 1.0 }
"#;

fn rows<T: DeserializeOwned>(folder: &Path, name: &str) -> Vec<T> {
    let mut reader = csv::Reader::from_path(folder.join("data/e").join(name)).unwrap();
    reader.deserialize().collect::<Result<_, _>>().unwrap()
}

/// A run, the same again from what is finished, and the same with another number of threads.
fn runs_alike(folder: &Path, finished: &str) -> BTreeMap<String, Vec<u8>> {
    let run = |more: &[&str]| validate(folder).args(more).assert().code(0);
    run(&["--threads", "1"]);
    let before = contents(folder);
    run(&[]).stderr(contains(finished));
    assert!(before == contents(folder));
    run(&["--threads", "2", "--force"]);
    assert!(before == contents(folder));
    before
}

#[test]
fn termination_compares_settings() {
    let folder = folder(TERMINATION);
    let files = runs_alike(folder.path(), "16 of 16 trees were finished");
    for file in [
        "data/e/cells.csv",
        "data/e/rays.csv",
        "data/e/tables/settings.md",
        "data/e/tables/termination.csv",
        "plots/e/termination.svg",
        "plots/e/termination-2.png",
        "plots/e/partition.svg",
    ] {
        assert!(files.contains_key(file), "{file}");
    }
    for file in [
        "data/e/tables/times-termination.md",
        "plots/e/times-termination.png",
    ] {
        assert!(folder.path().join(file).is_file(), "{file}");
    }
    // Two scenes, two strategies, three rules.
    let table = String::from_utf8(files["data/e/tables/termination.csv"].clone()).unwrap();
    assert_eq!(table.lines().count(), 1 + 12);
    // The cells of a slice tile it: every strategy covers the same area.
    let cells: Vec<SliceRecord> = rows(folder.path(), "slices.csv");
    let area = |strategy: &str| -> f64 {
        let own = cells.iter().filter(|c| c.strategy == strategy);
        own.map(|c| (c.u_hi - c.u_lo) * (c.v_hi - c.v_lo)).sum()
    };
    let (a, b) = (area("sah"), area("spatial-median"));
    assert!(a > 0.0 && (a / b - 1.0).abs() < 1e-12, "{a} {b}");
}

#[test]
fn split_cost_finds_minima_and_medians() {
    let folder = folder(SPLIT_COST);
    let files = runs_alike(folder.path(), "3 of 3 scenes were finished");
    for file in [
        "data/e/curves.csv",
        "data/e/curve-nodes.csv",
        "data/e/tables/medians.md",
        "data/e/tables/octree.tex",
        "plots/e/split-cost.svg",
        "plots/e/medians.png",
    ] {
        assert!(files.contains_key(file), "{file}");
    }
    let medians: Vec<MedianRecord> = rows(folder.path(), "medians.csv");
    let nodes = |axis: &str, sized: fn(&MedianRecord) -> bool| -> u64 {
        let own = medians.iter().filter(|r| r.axis == axis && sized(r));
        own.map(|r| r.nodes).sum()
    };
    let whole = |r: &MedianRecord| r.objects_lo == 2 && r.objects_hi.is_none();
    let by_axis: u64 = ["x", "y", "z"].map(|axis| nodes(axis, whole)).iter().sum();
    assert_eq!(nodes("all", whole), by_axis);
    assert_eq!(
        nodes("all", |r| r.objects_lo > 2 || r.objects_hi.is_some()),
        by_axis
    );
    assert!(medians.iter().all(|r| r.between_centres == r.nodes));
    let octrees: Vec<OctreeRecord> = rows(folder.path(), "octree.csv");
    assert!(
        octrees
            .iter()
            .all(|r| r.kd_inner_nodes == 7 * r.octree_inner_nodes)
    );
}

#[test]
fn assumptions_are_broken_one_by_one() {
    let folder = folder(ASSUMPTIONS);
    let files = runs_alike(folder.path(), "2 of 2 scenes were finished");
    for file in [
        "data/e/nodes-by.csv",
        "data/e/tables/totals.md",
        "data/e/tables/bias.tex",
        "data/e/tables/order.csv",
        "data/e/tables/exact.md",
        "data/e/tables/metrics.md",
        "plots/e/assumptions-metrics.png",
        "plots/e/assumptions.svg",
        "plots/e/assumptions-totals.png",
        "plots/e/assumptions-order.svg",
    ] {
        assert!(files.contains_key(file), "{file}");
    }
    // Eight sets of one scene, six of the one without a picture; two trees each.
    let work: Vec<WorkRecord> = rows(folder.path(), "work.csv");
    let bias: Vec<BiasRecord> = rows(folder.path(), "bias.csv");
    assert_eq!((work.len(), bias.len()), (28, 28));
    for (row, work) in bias.iter().zip(&work) {
        assert_eq!(
            row.uniform,
            ["lines", "volume-ray", "lines:nearest"].contains(&&*row.rays)
        );
        match &*row.rays {
            "volume-ray" | "volume-segment" | "volume-segment:any" | "shadow" => {
                assert_eq!(row.inside, 1.0);
            }
            _ => assert_eq!(row.inside, 0.0, "{}", row.rays),
        }
        assert_eq!(row.stopped > 0.0, work.ask != "all", "{}", row.rays);
        let visits = (work.inner_visits + work.leaf_visits) as f64 / row.entered as f64;
        let predicted = work.n_k_predicted + work.n_b_predicted;
        assert!((row.visits.unwrap() / (visits / predicted) - 1.0).abs() < 1e-12);
        if row.rays == "lines" {
            assert!((row.c.unwrap() - 1.0).abs() < 0.1 && row.spread.unwrap() < 0.1);
        }
    }
    // Every group of nodes adds up to all visits.
    let groups: Vec<GroupRecord> = rows(folder.path(), "nodes-by.csv");
    for by in ["depth", "area", "distance"] {
        for row in &work {
            let own = groups.iter().filter(|g| {
                (&*g.by, &g.scene, &g.strategy, &g.rays)
                    == (by, &row.scene, &row.strategy, &row.rays)
            });
            let hits: u64 = own.map(|g| g.hits).sum();
            assert_eq!(hits, row.inner_visits + row.leaf_visits);
        }
    }
    let visits: Vec<VisitRecord> = rows(folder.path(), "visits.csv");
    assert!(visits.len() > 20);
    assert!(
        visits
            .iter()
            .all(|v| v.entered as f64 * v.p >= 25.0 && v.node > 0)
    );
    let orders: Vec<OrderRecord> = rows(folder.path(), "order.csv");
    assert_eq!(orders.len(), 14 * 5);
    assert!(
        orders
            .iter()
            .all(|row| row.right + row.wrong + row.tied == 1)
    );
    let metrics: Vec<MetricRecord> = rows(folder.path(), "metrics.csv");
    let (mailbox, metrics): (Vec<_>, Vec<_>) = metrics
        .into_iter()
        .partition(|row| row.rays == "lines with a mailbox");
    assert_eq!(metrics.len(), 28 * 5);
    assert_eq!(metrics.iter().filter(|row| row.suited).count(), 28);
    // Of each tree the metric that tests again, which expects more, and the one that does not.
    assert_eq!(mailbox.len(), 4 * 2);
    for rows in mailbox.chunks(2) {
        assert_eq!((&*rows[0].metric, &*rows[1].metric), ("area", "mailbox"));
        assert!(rows[0].c >= (1.0 - 1e-12) * rows[1].c && rows[0].c_counted == rows[1].c_counted);
    }
    for row in &metrics {
        let own = |b: &&BiasRecord| {
            (&b.scene, &b.strategy, &b.rays) == (&row.scene, &row.strategy, &row.rays)
        };
        let area = bias.iter().find(own).unwrap().c.unwrap();
        assert!(row.metric != "area" || (row.ratio.unwrap() / area - 1.0).abs() < 1e-12);
    }
    // Two trees a scene; in the flat root of the balls a few long chords outweigh all others, so that lines tell nothing of
    // segments.
    let exact: Vec<ExactRecord> = rows(folder.path(), "exact.csv");
    let trees = |scene: &str, rays: &str, by: &str| {
        let own = exact
            .iter()
            .filter(|r| (&*r.scene, &*r.rays, &*r.by) == (scene, rays, by));
        own.count()
    };
    for (scene, expected) in [
        ("spd:balls:2", [2, 0, 2]),
        ("simple:clustered:200", [2, 2, 2]),
    ] {
        let found = [
            trees(scene, "volume-ray", "lines"),
            trees(scene, "volume-segment", "lines"),
            trees(scene, "volume-segment", "slab"),
        ];
        assert_eq!(found, expected, "{scene}");
    }
    let summary = std::fs::read(folder.path().join("data/e/summary.json")).unwrap();
    let summary: Summary = serde_json::from_slice(&summary).unwrap();
    let names: Vec<&str> = summary.verdicts.iter().map(|v| &*v.name).collect();
    assert_eq!(names, ["control", "exact", "stops-less", "order", "regret"]);
    assert_eq!(summary.estimates.len(), 12);
}

#[test]
fn ranks_beyond_the_tree_are_told() {
    let folder = folder(&SPLIT_COST.replace("rank = 2", "rank = 100000"));
    let told = contains("simple:soup:300 has only").and(contains("rank 100000 is not drawn"));
    validate(folder.path()).assert().code(0).stderr(told);
    let drawn: Vec<CurveNodeRecord> = rows(folder.path(), "curve-nodes.csv");
    assert!(drawn.iter().all(|r| r.scene == "spd:tree:5" && r.rank == 1));
}

#[test]
fn wrong_experiments_are_refused() {
    let cases = [
        (
            TERMINATION,
            "axis = \"z\"",
            "axis = \"w\"",
            "e.toml:12",
            "unknown variant",
        ),
        (
            TERMINATION,
            "{ scene = \"spd:balls:2\"",
            "{ scene = \"spd:balls:9\"",
            "e.toml:12",
            "not among the scenes",
        ),
        (
            TERMINATION,
            "\"spd:tree:3\"",
            "\"simple:soup:9\"",
            "simple:soup:9",
            "no camera",
        ),
        (
            ASSUMPTIONS,
            "\"beam\"",
            "\"bean\"",
            "e.toml:7",
            "'bean' is no source of rays",
        ),
        (
            ASSUMPTIONS,
            "number = 2048",
            "number = 1",
            "e.toml:8",
            "2 to 4194304",
        ),
        (
            ASSUMPTIONS,
            "strategy = \"sah\"",
            "strategy = \"sah-cyclic\"",
            "e.toml:10",
            "not among the scenes and strategies",
        ),
        (
            ASSUMPTIONS,
            "tau = 0.0",
            "tau = 2.0",
            "e.toml:12",
            "-1 to 1",
        ),
        (SPLIT_COST, "rank = 1", "rank = 0", "e.toml:7", "has rank 1"),
        (
            SPLIT_COST,
            "rank = 2",
            "rnk = 2",
            "e.toml:7",
            "unknown field",
        ),
        (SPLIT_COST, "levels = 3", "levels = 8", "e.toml:8", "1 to 7"),
        (SPLIT_COST, "lines = 500", "lines = 1", "e.toml:8", "2 to"),
        (
            SPLIT_COST,
            "equal_within = 1e-12",
            "equal_within = -1.0",
            "e.toml:10",
            "0 to 1",
        ),
    ];
    for (good, old, new, place, wrong) in cases {
        assert!(good.contains(old));
        let folder = folder(&good.replacen(old, new, 1));
        let stderr = validate(folder.path()).assert().code(2);
        stderr.stderr(contains(place).and(contains(wrong)));
        assert!(!folder.path().join("data").exists(), "{new}");
    }
}
