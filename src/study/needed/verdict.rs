//! Whether every C came out as well known as was wanted.

use crate::stats::normal_quantile;
use crate::study::LineRule;
use crate::study::records::{CellRecord, Verdict, WorkRecord};

use super::CONFIDENCE;

/// How well a C is known.
pub struct Known {
    place: String,
    /// The relative error that was wanted.
    wanted: f64,
    /// How far C may be off, over C.
    off: Off,
}

/// How far a C may be off.
enum Off {
    /// By no more than this, with 95 %: half of its interval.
    Within(f64),
    /// By this from the one that areas predict: its variance hangs on events too rare for the pilot, which tells no interval.
    Predicted(f64),
    /// Nothing tells.
    Unknown,
}

impl Off {
    fn of(c: f64, se: Option<f64>) -> Option<Self> {
        let z = normal_quantile(CONFIDENCE);
        se.map(|se| Self::Within(if se <= 0.0 { 0.0 } else { z * se / c }))
    }

    fn share(&self) -> f64 {
        match self {
            Self::Within(share) | Self::Predicted(share) => *share,
            Self::Unknown => f64::INFINITY,
        }
    }
}

/// Of cells whose lines a wanted error settles; none where something else does.
pub fn of_cells(rule: &LineRule, cells: &[CellRecord]) -> Vec<Known> {
    let wanted = rule.cost_error().into_iter();
    let one = |wanted: f64, r: &CellRecord| Known {
        place: format!("{} on {}", r.strategy, r.scene),
        wanted,
        off: Off::of(r.c_counted, r.c_se)
            .unwrap_or_else(|| Off::Predicted((r.c_counted / r.c_predicted - 1.0).abs())),
    };
    wanted
        .flat_map(|e| cells.iter().map(move |r| one(e, r)))
        .collect()
}

/// Of the rays of sources, whose number a wanted error settles; none where no error was wanted.
pub fn of_rays(error: Option<f64>, work: &[&WorkRecord]) -> Vec<Known> {
    let one = |wanted: f64, r: &WorkRecord| Known {
        place: format!("{} of {} on {}", r.rays, r.strategy, r.scene),
        wanted,
        off: Off::of(r.c_counted, r.c_se).unwrap_or(Off::Unknown),
    };
    let sampled = || work.iter().filter(|r| !r.complete && r.entered > 0);
    let wanted = error.into_iter();
    wanted
        .flat_map(|e| sampled().map(move |r| one(e, r)))
        .collect()
}

/// Whether all are kept: by the interval of what was counted; where it has none, by what areas predict.
pub fn verdict(all: &[Known]) -> Option<Verdict> {
    let kept = |one: &&Known| one.off.share() <= one.wanted;
    let within = all.iter().filter(kept).count();
    let mut wanted: Vec<f64> = all.iter().map(|one| one.wanted).collect();
    wanted.dedup();
    let wanted: Vec<String> = wanted.into_iter().map(percent).collect();
    let mut message = format!(
        "95 % interval of C within ± {} in {within} of {} cases",
        wanted.join(" or "),
        all.len()
    );
    let widest = |pick: fn(&Off) -> bool| {
        let some = all.iter().filter(move |one| pick(&one.off));
        let widest = some
            .clone()
            .max_by(|a, b| a.off.share().total_cmp(&b.off.share()));
        widest.map(|one| (some.count(), percent(one.off.share()), &one.place))
    };
    if let Some((_, share, place)) = widest(|off| matches!(off, Off::Within(_))) {
        message += &format!("; widest {share} ({place})");
    }
    if let Some((count, share, place)) = widest(|off| matches!(off, Off::Predicted(_))) {
        message += &format!(
            "; {count} without an interval, as their variance hangs on events too rare for the pilot, off the C that areas predict by \
             at most {share} ({place})"
        );
    }
    if let Some((count, ..)) = widest(|off| matches!(off, Off::Unknown)) {
        message += &format!("; {count} not known: fewer than two rays entered");
    }
    (!all.is_empty()).then(|| Verdict {
        name: "error".into(),
        held: within == all.len(),
        message,
    })
}

/// A share in per cent, to three digits at most.
fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    let scale = libm::exp10(2.0 - libm::floor(libm::log10(percent)));
    let rounded = if scale.is_finite() {
        (percent * scale).round() / scale
    } else {
        percent
    };
    format!("{rounded} %")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::CostModel;
    use crate::kd::{Rules, StopRule, Strategy};
    use crate::scene::Scene;
    use crate::study::hits::cell::{CellPlan, measure};

    const WANTED: f64 = 0.01;

    /// A cell whose C came out as this; 100 was predicted.
    fn cell(c_counted: f64, c_se: Option<f64>) -> CellRecord {
        CellRecord {
            c_predicted: 100.0,
            c_counted,
            c_se,
            ..CellRecord::default()
        }
    }

    #[test]
    fn what_the_count_cannot_tell_is_held_against_areas() {
        let rule = LineRule::for_cost_error(WANTED).expect("a rule");
        let told = |cells: &[CellRecord]| {
            let verdict = verdict(&of_cells(&rule, cells)).expect("an error was wanted");
            (verdict.held, verdict.message)
        };
        let (fine, wide) = (cell(100.0, Some(0.5)), cell(100.0, Some(0.6)));
        assert!(told(std::slice::from_ref(&fine)).0 && !told(&[fine.clone(), wide]).0);
        let (held, message) = told(&[fine.clone(), cell(99.5, None)]);
        assert!(
            held && message.contains("in 2 of 2 cases; widest 0.98 %"),
            "{message}"
        );
        assert!(
            message.contains("1 without an interval") && message.contains("at most 0.5 %"),
            "{message}"
        );
        let (held, message) = told(&[fine, cell(98.5, None)]);
        assert!(!held && message.contains("in 1 of 2 cases"), "{message}");
    }

    #[test]
    fn only_what_an_error_settled_is_judged() {
        let fixed = LineRule::exactly(4096).expect("a rule");
        assert!(of_cells(&fixed, &[cell(100.0, Some(50.0))]).is_empty());
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
            ..rays.clone()
        };
        assert!(of_rays(Some(WANTED), &[&all]).is_empty());
        let one = WorkRecord {
            c_se: None,
            entered: 1,
            ..rays
        };
        let unknown = verdict(&of_rays(Some(WANTED), &[&one])).expect("an error was wanted");
        assert!(!unknown.held && unknown.message.contains("1 not known"));
    }

    #[test]
    fn per_cents_are_short() {
        let told = [0.07, 0.001, 0.123_456, 0.0, 12.0].map(percent);
        assert_eq!(told, ["7 %", "0.1 %", "12.3 %", "0 %", "1200 %"]);
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
            .map(|plan| measure(plan, &()).expect("a sound cell").0.record)
            .collect();
        let r = &cells[0];
        assert_eq!(r.c_se, None);
        let verdict = verdict(&of_cells(&rule, &cells)).expect("an error was wanted");
        assert!(verdict.held, "{}", verdict.message);
    }
}
