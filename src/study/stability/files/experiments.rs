//! Experiment files.

use super::case;
use crate::study::Plan;
use crate::study::plan::Overrides;
use crate::study::stability::case::{Case, Finding};

/// An experiment in which nothing is wrong.
const GOOD: &str = r#"kind = "split-cost"
question = "Why?"
seed = 7
scenes = ["spd:tree:8"]
stop = "objects:2:16"
samples = 10
curves = [{ scene = "spd:tree:8", rank = 2 }]
octree = { limit = 2, levels = 5, lines = 65_536 }
[cost]
c_k = 15.0
c_b = 0.0
c_t = 20.0
[expect]
equal_within = 1e-12
"#;

/// The cases of experiment files.
pub(super) fn cases() -> Vec<Case> {
    vec![
        case("toml-as-it-should-be", "the control", || {
            told(GOOD, "split-cost of 1 scenes")
        }),
        case("toml-no-table", "syntax", || {
            told("kind", "x.toml:1:5: key with no value, expected `=`")
        }),
        case("toml-deep-nesting", "recursion", || {
            told(
                &format!("kind = {}", "[".repeat(100_000)),
                "x.toml:1:88: cannot recurse further; max recursion depth met",
            )
        }),
        case("toml-number-too-large", "overflow", || {
            told(
                &GOOD.replace("seed = 7", "seed = 18446744073709551616"),
                "x.toml:3:8: invalid type: integer `18446744073709551616` as i128, expected u64",
            )
        }),
        case("toml-key-twice", "syntax", || {
            told(
                &GOOD.replace("seed = 7", "seed = 7\nseed = 8"),
                "x.toml:4:1: duplicate key",
            )
        }),
        case("toml-unknown-key", "keys", || {
            told(
                &GOOD.replace("seed = 7", "seed = 7\nsede = 8"),
                "x.toml:4:1: unknown field `sede`, expected one of `stop`, `samples`, `curves`, `octree`, `expect`",
            )
        }),
        case("toml-unknown-kind", "kinds", || {
            told(
                &GOOD.replace("split-cost", "spilt-cost"),
                "x.toml:1:8: unknown kind 'spilt-cost', expected one of hits-vs-area, strategies, termination, split-cost, cost-vs-work, assumptions, speed-vs-error, stability, traversal",
            )
        }),
        case("toml-escape-sequence", "control characters", || {
            told(
                &GOOD.replace("split-cost", "\\u001b[2J"),
                "x.toml:1:8: unknown kind '\\u{1b}[2J', expected one of hits-vs-area, strategies, termination, split-cost, cost-vs-work, assumptions, speed-vs-error, stability, traversal",
            )
        }),
        case("toml-unknown-stop-rule", "rules", || {
            told(
                &GOOD.replace("objects:2:16", "objects:0:16"),
                "x.toml:5:8: 'objects:0:16' is no stop rule; expected depth:D, objects:N[:D], cost-k:K[:D], cost-gain[:D], automatic[:D] or octree:N:D with N >= 1, K >= 0 and a depth D of at most 128 (of depth:D and octree:N:D at most 22, a full tree of 2^23 nodes; of octree:N:D a multiple of 3), e.g. objects:2:16",
            )
        }),
        case("toml-stop-rule-not-a-number", "numbers", || {
            told(
                &GOOD.replace("objects:2:16", "cost-k:nan"),
                "x.toml:5:8: 'cost-k:nan' is no stop rule; expected depth:D, objects:N[:D], cost-k:K[:D], cost-gain[:D], automatic[:D] or octree:N:D with N >= 1, K >= 0 and a depth D of at most 128 (of depth:D and octree:N:D at most 22, a full tree of 2^23 nodes; of octree:N:D a multiple of 3), e.g. objects:2:16",
            )
        }),
        case("toml-too-deep", "rules", || {
            told(
                &GOOD.replace("objects:2:16", "depth:23"),
                "x.toml:5:8: 'depth:23' is no stop rule; expected depth:D, objects:N[:D], cost-k:K[:D], cost-gain[:D], automatic[:D] or octree:N:D with N >= 1, K >= 0 and a depth D of at most 128 (of depth:D and octree:N:D at most 22, a full tree of 2^23 nodes; of octree:N:D a multiple of 3), e.g. objects:2:16",
            )
        }),
        case("toml-no-scenes", "emptiness", || {
            told(
                &GOOD.replace("[\"spd:tree:8\"]", "[]"),
                "x.toml:4:1: scenes must name at least one",
            )
        }),
        case("toml-scene-twice", "names", || {
            told(
                &GOOD.replace("[\"spd:tree:8\"]", "[\"spd:tree:8\", \"spd:tree:8\"]"),
                "x.toml:4:1: scene 'spd:tree:8' is named twice",
            )
        }),
        case("toml-cost-not-a-number", "numbers", || {
            told(
                &GOOD.replace("c_t = 20.0", "c_t = nan"),
                "x.toml:9:2: c_k = 15, c_b = 0, c_t = NaN, but costs must be at most 1e100, none negative, and not all 0",
            )
        }),
        case("toml-costs-of-nothing", "costs", || {
            told(
                &GOOD.replace("15.0", "0.0").replace("20.0", "0.0"),
                "x.toml:9:2: c_k = 0, c_b = 0, c_t = 0, but costs must be at most 1e100, none negative, and not all 0",
            )
        }),
        case("toml-no-question", "emptiness", || {
            told(
                &GOOD.replace("Why?", " "),
                "x.toml:2:1: the question is empty; it is printed with every answer",
            )
        }),
        case("toml-tail-without-its-head", "records", || {
            told(
                &format!(
                    "{GOOD}# Added by the program: how this experiment was run. Run this file and the run is repeated.\n[run]\n"
                ),
                "x.toml:16:1: missing field `experiment`",
            )
        }),
    ]
}

/// What is said of a text: what it asks for, or why it is refused.
fn told(text: &str, expected: &str) -> Finding {
    let measured = match Plan::parse(text, "x.toml", "x", Overrides::default()) {
        Ok(plan) => format!("{} of {} scenes", plan.kind.name(), plan.scenes.len()),
        Err(error) => error.to_string(),
    };
    Finding::of(expected, measured)
}
