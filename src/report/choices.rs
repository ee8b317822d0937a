//! Which strategy to take for which rays: predicted by areas, counted on the rays.

use super::cost_vs_work::SETS;
use super::number::{counted, digits_for, fixed, percent_above, significant};
use super::table::{Cell, Column, Table};
use crate::study::records::StrategyChoiceRecord;

/// Counted costs this near to the predicted ones, as a share of these, make the cost trusted.
const COST_WITHIN: f64 = 0.05;
/// From this Kendall's tau on the order of the strategies is trusted.
const ORDERED: f64 = 0.8;
/// A choice that costs at most so many per cent above the best is trusted.
const MOST_LOSS: f64 = 5.0;
/// Per cent of cost below which trees count as equal.
const EQUAL: f64 = 0.005;

/// A row for each set of rays; of a run of several scenes, for each scene and set.
pub fn table(choices: &[StrategyChoiceRecord]) -> Table {
    let scenes = choices
        .iter()
        .any(|choice| choice.scene != choices[0].scene);
    let mut columns = vec![
        Column::left("rays", "rays"),
        Column::left("areas take", "predicted"),
        Column::right("C predicted", "c_predicted"),
        Column::right("counted", "c_counted"),
        Column::right("ratio", "counted_over_predicted"),
        Column::right("tau", "kendall_tau"),
        Column::left("counts take", "least"),
        Column::right("lost, %", "lost_pct"),
    ];
    if scenes {
        columns.insert(0, Column::left("scene", "scene"));
    }
    let row = |choice: &StrategyChoiceRecord| {
        let cost = |c: f64| Cell::Value(c, digits_for(c, 4));
        let some = |value: Option<f64>, decimals| {
            value.map_or(Cell::Missing, |value| Cell::Value(value, decimals))
        };
        let mut row = vec![
            Cell::Text(choice.rays.clone()),
            Cell::Text(choice.predicted.clone()),
            cost(choice.predicted_c_predicted),
            cost(choice.predicted_c_counted),
            some(ratio(choice), 3),
            some(choice.kendall_tau, 2),
            Cell::Text(choice.least.clone()),
            some(loss(choice), 2),
        ];
        if scenes {
            row.insert(0, Cell::Text(choice.scene.clone()));
        }
        row
    };
    Table {
        caption: format!(
            "What areas tell of rays that are not isotropic lines without end. The strategy of least C predicted, its C a \
                  ray predicted and counted, counted over predicted; Kendall's tau over all strategies between C predicted \
                  and counted (1: the same order); the strategy of least C counted, and the per cent by \
                  which the areas' choice costs more. {SETS} Own: the user's rays."
        ),
        columns,
        keys: 1 + usize::from(scenes),
        rows: choices.iter().map(row).collect(),
    }
}

/// C counted over predicted, of the tree the areas choose.
fn ratio(choice: &StrategyChoiceRecord) -> Option<f64> {
    let ratio = choice.predicted_c_counted / choice.predicted_c_predicted;
    ratio.is_finite().then_some(ratio)
}

/// By how many per cent the tree the areas choose costs more than the best, counted.
fn loss(choice: &StrategyChoiceRecord) -> Option<f64> {
    if choice.predicted_c_counted == choice.least_c_counted {
        return Some(0.0);
    }
    let loss = percent_above(choice.predicted_c_counted / choice.least_c_counted);
    loss.is_finite().then_some(loss)
}

/// The set of rays that stands for real ones: the user's own, else those of the eye, else the first that stop.
pub fn real(choices: &[StrategyChoiceRecord]) -> Option<&StrategyChoiceRecord> {
    let find = |is: fn(&&StrategyChoiceRecord) -> bool| choices.iter().find(is);
    find(|c| is_own(c))
        .or_else(|| find(|c| c.rays == "primary"))
        .or_else(|| find(|c| c.ask != "all"))
        .or_else(|| choices.first())
}

/// Whether these are a user's own rays.
pub fn is_own(choice: &StrategyChoiceRecord) -> bool {
    choice.rays == "own" || choice.rays.starts_with("own:")
}

/// Which strategy to take for these rays, what it costs, and for what the prediction is to be trusted; no strategy where no ray
/// meets the scene or all cost the same.
pub fn advice(choice: &StrategyChoiceRecord) -> String {
    let c = choice;
    let rays = counted(c.cast, "ray");
    if c.least_c_counted.is_nan() || c.least_c_counted <= 0.0 {
        return format!(
            "For {}, {rays}: no ray meets the scene: nothing to compare.",
            c.rays
        );
    }
    let lost = loss(c);
    let same = lost.is_some_and(|loss| loss < EQUAL);
    let (take, predicted, cost) = if same {
        (&c.predicted, c.predicted_c_predicted, c.predicted_c_counted)
    } else {
        (&c.least, c.least_c_predicted, c.least_c_counted)
    };
    let [predicted, cost] = [predicted, cost].map(|c| significant(c, 4));
    let [trusted, others] = &trust(c);
    let trust = match (trusted.as_slice(), others.as_slice()) {
        ([], _) => format!("do not trust the prediction for {}", listed(others, "or")),
        (_, []) => format!("trust the prediction for {}", listed(trusted, "and")),
        _ => format!(
            "trust the prediction for {}, not for {}",
            listed(trusted, "and"),
            listed(others, "or")
        ),
    };
    if undecided(c) {
        return format!(
            "For {} there is nothing to choose: predicted or counted, all strategies cost the same. {take} is predicted to \
             cost {predicted} a ray and counted at {cost} over {rays}: {trust}.",
            c.rays
        );
    }
    format!(
        "For {} take {take}, predicted to cost {predicted} a ray and counted at {cost} over {rays}: {trust}.",
        c.rays
    )
}

/// Whether no strategy is to be preferred: all have the same cost, predicted or counted.
fn undecided(c: &StrategyChoiceRecord) -> bool {
    c.kendall_tau.is_none() && loss(c).is_some_and(|loss| loss < EQUAL)
}

/// What of the prediction is trusted, and what is not.
fn trust(c: &StrategyChoiceRecord) -> [Vec<String>; 2] {
    let mut parts = [Vec::new(), Vec::new()];
    let mut tell = |trusted: bool, what: String| parts[usize::from(!trusted)].push(what);
    let above = match loss(c) {
        Some(loss) if loss < EQUAL => "none is better".to_owned(),
        Some(loss) => format!("{} % above the best", significant(loss, 2)),
        None => "the best costs nothing".to_owned(),
    };
    let near = loss(c).is_some_and(|loss| loss <= MOST_LOSS);
    if !undecided(c) {
        tell(
            near,
            format!("the choice of a strategy ({}, {above})", c.predicted),
        );
    }
    if let Some(tau) = c.kendall_tau {
        let order = format!(
            "the order of all {} (Kendall's tau {})",
            c.strategies,
            fixed(tau, 2)
        );
        tell(tau >= ORDERED, order);
    }
    if let Some(ratio) = ratio(c) {
        let cost = format!("the cost (counted is {} times it)", significant(ratio, 3));
        tell((ratio - 1.0).abs() <= COST_WITHIN, cost);
    }
    parts
}

/// `a`, `a and b`, `a, b and c`.
fn listed(parts: &[String], word: &str) -> String {
    match parts {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} {word} {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::fixture::choice;

    #[test]
    fn trust_is_told_in_words() {
        let with = |tau, predicted, counted, least| {
            let mut choice = choice("own:nearest");
            choice.kendall_tau = tau;
            choice.predicted_c_predicted = predicted;
            choice.predicted_c_counted = counted;
            choice.least_c_counted = least;
            advice(&choice)
        };
        assert_eq!(
            with(Some(0.95), 100.0, 99.0, 99.0),
            "For own:nearest take sah, predicted to cost 100.0 a ray and counted at 99.00 over 1,000 rays: trust the prediction for the choice \
             of a strategy (sah, none is better), the order of all 3 (Kendall's tau 0.95) and the cost (counted is 0.990 times \
             it)."
        );
        let order = with(Some(0.95), 100.0, 50.0, 49.0);
        assert_eq!(
            order,
            "For own:nearest take sah-cyclic, predicted to cost 120.0 a ray and counted at 49.00 over 1,000 rays: trust the prediction for the \
             choice of a strategy (sah, 2.0 % above the best) and the order of all 3 (Kendall's tau 0.95), not for the cost \
             (counted is 0.500 times it)."
        );
        let nothing = with(Some(-0.5), 100.0, 50.0, 40.0);
        assert!(nothing.contains(
            "do not trust the prediction for the choice of a strategy (sah, 25 % above the best), the order of all 3 \
             (Kendall's tau −0.50) or the cost"
        ));
        let equal = with(None, 100.0, 100.0, 100.0);
        assert_eq!(
            equal,
            "For own:nearest there is nothing to choose: predicted or counted, all strategies cost the same. sah is \
             predicted to cost 100.0 a ray and counted at 100.0 over 1,000 rays: trust the prediction for the cost (counted is 1.00 times it)."
        );
        // Rays that meet no tree.
        assert_eq!(
            with(None, 100.0, 0.0, 0.0),
            "For own:nearest, 1,000 rays: no ray meets the scene: nothing to compare."
        );
    }

    #[test]
    fn a_users_own_rays_are_the_real_ones() {
        let named = |names: &[&str]| names.iter().map(|name| choice(name)).collect::<Vec<_>>();
        let all = named(&["own:any", "lines", "lines:nearest", "primary"]);
        for (from, wanted) in [(0, "own:any"), (1, "primary")] {
            assert_eq!(real(&all[from..]).expect("one").rays, wanted);
        }
        assert_eq!(real(&all[1..3]).expect("one").rays, "lines:nearest");
        assert_eq!(real(&all[1..2]).expect("one").rays, "lines");
        assert_eq!(real(&[]), None);
    }

    #[test]
    fn several_scenes_have_a_column() {
        let mut all = vec![choice("lines"), choice("own")];
        assert_eq!(table(&all).keys, 1);
        all[1].scene = "another".into();
        let several = table(&all);
        assert_eq!(
            (several.keys, several.columns.len(), several.rows[0].len()),
            (2, 9, 9)
        );
        all[0].predicted_c_predicted = 0.0;
        all[0].kendall_tau = None;
        assert!(!table(&all).to_csv().contains("NaN"));
    }
}
