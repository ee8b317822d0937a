//! Whether every C came out as well known as was wanted.

use crate::stats::normal_quantile;
use crate::study::LineRule;
use crate::study::ray_sets::MOST_RAYS;
use crate::study::records::{CellRecord, Verdict, WorkRecord};

use super::CONFIDENCE;

/// How well a C is known.
pub struct Known {
    place: String,
    /// The relative error that was wanted.
    wanted: f64,
    /// Half of the 95 % interval over C; `None` where what was counted cannot tell it, as it hangs on events too rare for that.
    share: Option<f64>,
    /// Whether as many were counted as [`needed`](super::needed) asked for, which reckons with such events.
    enough: bool,
}

impl Known {
    fn new(place: String, wanted: f64, (c, se): (f64, Option<f64>), enough: bool) -> Self {
        let z = normal_quantile(CONFIDENCE);
        let share = |se: f64| if se <= 0.0 { 0.0 } else { z * se / c };
        Self {
            place,
            wanted,
            share: se.map(share),
            enough,
        }
    }
}

/// Of cells whose lines a wanted error settles; none where something else does.
pub fn of_cells(rule: &LineRule, cells: &[CellRecord]) -> Vec<Known> {
    let [_, most] = rule.bounds();
    let one = |(wanted, r): (f64, &CellRecord)| {
        let place = format!("{} on {}", r.strategy, r.scene);
        Known::new(place, wanted, (r.c_counted, r.c_se), r.lines < most)
    };
    let wanted = rule.cost_error().into_iter();
    wanted
        .flat_map(|e| cells.iter().map(move |r| (e, r)))
        .map(one)
        .collect()
}

/// Of the rays of sources, whose number a wanted error settles; none where no error was wanted.
pub fn of_rays(error: Option<f64>, work: &[&WorkRecord]) -> Vec<Known> {
    let one = |(wanted, r): (f64, &WorkRecord)| {
        let place = format!("{} of {} on {}", r.rays, r.strategy, r.scene);
        Known::new(place, wanted, (r.c_counted, r.c_se), r.cast < MOST_RAYS)
    };
    let sampled = || work.iter().filter(|r| !r.complete && r.entered > 0);
    let wanted = error.into_iter();
    wanted
        .flat_map(|e| sampled().map(move |r| (e, *r)))
        .map(one)
        .collect()
}

/// By the standard error of what was counted; where that has none, by the variance that settled how much was counted: the
/// wanted error is kept if as much was.
pub fn verdict(all: &[Known]) -> Option<Verdict> {
    let (told, untold): (Vec<&Known>, Vec<_>) = all.iter().partition(|one| one.share.is_some());
    let (settled, unknown): (Vec<&Known>, Vec<_>) = untold.into_iter().partition(|one| one.enough);
    let shares = || told.iter().filter_map(|one| Some((one.share?, *one)));
    let within = shares().filter(|(share, one)| *share <= one.wanted).count() + settled.len();
    let mut wanted: Vec<f64> = all.iter().map(|one| one.wanted).collect();
    wanted.dedup();
    let wanted: Vec<String> = wanted
        .iter()
        .map(|e| format!("± {} %", 100.0 * e))
        .collect();
    let mut message = format!(
        "95 % interval of C within {} in {within} of {} cases",
        wanted.join(" or "),
        all.len()
    );
    if let Some((share, one)) = shares().max_by(|a, b| a.0.total_cmp(&b.0)) {
        message += &format!("; widest {:.3} % ({})", 100.0 * share, one.place);
    }
    if !settled.is_empty() {
        message += &format!(
            "; {} judged by the variance that settled their lines, as it hangs on events too rare for the pilot",
            settled.len()
        );
    }
    if !unknown.is_empty() {
        message += &format!(
            "; {} not known: their variance hangs on events too rare for as many as may be counted",
            unknown.len()
        );
    }
    (!all.is_empty()).then(|| Verdict {
        name: "error".into(),
        held: within == all.len(),
        message,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::CostModel;
    use crate::kd::{Rules, StopRule, Strategy};
    use crate::scene::Scene;
    use crate::study::hits::cell::{CellPlan, measure};

    const WANTED: f64 = 0.01;

    /// A cell of C = 100.
    fn cell(se: Option<f64>, lines: u64) -> CellRecord {
        CellRecord {
            c_counted: 100.0,
            c_se: se,
            lines,
            ..CellRecord::default()
        }
    }

    #[test]
    fn what_the_count_cannot_tell_is_kept_if_enough_was_counted() {
        let rule = LineRule::for_cost_error(WANTED).expect("a rule");
        let [_, most] = rule.bounds();
        let told = |cells: &[CellRecord]| {
            let verdict = verdict(&of_cells(&rule, cells)).expect("an error was wanted");
            (verdict.held, verdict.message)
        };
        let (fine, wide) = (cell(Some(0.5), 9000), cell(Some(0.6), 9000));
        assert!(told(std::slice::from_ref(&fine)).0 && !told(&[fine.clone(), wide]).0);
        let (held, message) = told(&[fine.clone(), cell(None, 9000)]);
        assert!(
            held && message.contains("in 2 of 2 cases; widest 0.980 %"),
            "{message}"
        );
        assert!(
            message.contains("1 judged by the variance that settled"),
            "{message}"
        );
        let (held, message) = told(&[fine, cell(None, most)]);
        assert!(!held && message.contains("in 1 of 2 cases"), "{message}");
        assert!(message.contains("1 not known"), "{message}");
    }

    #[test]
    fn only_what_an_error_settled_is_judged() {
        let fixed = LineRule::exactly(4096).expect("a rule");
        assert!(of_cells(&fixed, &[cell(Some(50.0), 4096)]).is_empty());
        let rays = WorkRecord {
            c_counted: 100.0,
            c_se: Some(0.6),
            entered: 10,
            ..WorkRecord::default()
        };
        assert!(verdict(&of_rays(None, &[&rays])).is_none());
        let missed = verdict(&of_rays(Some(WANTED), &[&rays])).expect("an error was wanted");
        assert!(!missed.held, "{}", missed.message);
        let all = WorkRecord {
            complete: true,
            ..rays
        };
        assert!(of_rays(Some(WANTED), &[&all]).is_empty());
    }

    /// The leaves of a tree's twigs are rare: the pilot's standard error is none, but the lines are enough.
    #[test]
    fn a_scene_of_rare_clusters_keeps_the_wanted_error() {
        let scene = Scene::load("spd:tree:8").expect("a scene");
        let rules = Rules {
            strategy: Strategy::SpatialMedianLongest,
            stop: StopRule::CostGain { depth: None },
            cost: CostModel::WALD_HAVRAN,
            clipped: false,
        };
        let rule = LineRule::for_cost_error(WANTED).expect("a rule");
        let plans = CellPlan::of_scene(&scene, &[rules], 1, rule);
        let cells: Vec<CellRecord> = plans
            .iter()
            .map(|plan| measure(plan, &()).expect("a sound cell").record)
            .collect();
        let r = &cells[0];
        assert_eq!(r.c_se, None);
        assert!((r.c_counted / r.c_predicted - 1.0).abs() <= WANTED);
        let verdict = verdict(&of_cells(&rule, &cells)).expect("an error was wanted");
        assert!(verdict.held, "{}", verdict.message);
    }
}
