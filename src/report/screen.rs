//! A run on one screen.

use std::fmt::Write;

use super::number::{counted, grouped, percent_above, significant};
use super::table::fold;
use super::{Content, Hits, Run, choices, strategies, tables};
use crate::study::records::{CellRecord, TimingRecord};

/// Columns of the screen.
pub(in crate::report) const WIDTH: usize = 100;

/// The summary of a study: its question, its main figures, the verdicts.
pub fn study(run: &Run) -> String {
    match &run.content {
        Content::Hits(hits) => hits_study(run, hits),
        Content::Strategies(strategies) => strategies::study(run, strategies),
        Content::Termination(trees) => answer(run, &trees.short_table().to_text(WIDTH)),
        Content::SplitCost(nodes) => answer(run, &nodes.screen(WIDTH)),
        Content::CostVsWork(trees) => answer(run, &trees.screen(WIDTH)),
        Content::Assumptions(rays) => answer(run, &rays.screen(WIDTH)),
        Content::SpeedVsError(parts) => answer(run, &parts.screen(WIDTH)),
        Content::Stability(cases) => answer(run, &cases.screen(WIDTH)),
        Content::Traversal(walks) => answer(run, &walks.screen(WIDTH)),
    }
}

/// The question, tables, and the verdicts.
fn answer(run: &Run, tables: &str) -> String {
    format!("\n{}\n\n{tables}{}", run.summary.question, verdicts(run))
}

fn hits_study(run: &Run, hits: &Hits) -> String {
    let lines: u64 = hits.cells.iter().map(|c| c.lines).sum();
    let mut text = format!("\n{}\n", run.summary.question);
    let first = &hits.cells[0];
    let _ = writeln!(
        text,
        "{}, stop {}, costs {}:{}:{}, seed {}, {} lines in all\n",
        counted(hits.cells.len() as u64, "cell"),
        first.stop,
        first.c_k,
        first.c_b,
        first.c_t,
        run.summary.seed,
        grouped(lines)
    );
    let costs = tables::costs(&hits.cells);
    let table = if costs.fits(WIDTH) {
        costs
    } else {
        tables::extremes(&hits.cells)
    };
    text + &table.to_text(WIDTH) + &of_rays(hits) + &verdicts(run) + nothing_to_fit(hits)
}

/// What rays of other kinds made of the trees; empty where none were traced.
fn of_rays(hits: &Hits) -> String {
    match hits.choices.as_deref() {
        None | Some([]) => String::new(),
        Some(all) => format!("\n{}", choices::table(all).to_text(WIDTH)),
    }
}

/// The summary of one scene: its trees, their costs, and which to take.
pub fn scene(run: &Run) -> String {
    let Some(hits) = run.hits() else {
        return study(run);
    };
    let first = &hits.cells[0];
    let mut text = format!(
        "\n{}: {}, stop {}\n\n",
        first.scene,
        counted(first.objects, "object"),
        first.stop
    );
    text += &tables::of_scene(&hits.cells).to_text(WIDTH);
    let real = hits.choices.as_deref().and_then(choices::real);
    // Real rays go before lines.
    if !real.is_some_and(choices::is_own) {
        text += &advice(&hits.cells);
    }
    text += &of_rays(hits);
    if let Some(real) = real {
        text += &format!("\n{}\n", fold(&choices::advice(real), WIDTH));
    }
    text + &verdicts(run) + nothing_to_fit(hits)
}

/// The strategy to take: the least cost counted, and how far the others are.
fn advice(cells: &[CellRecord]) -> String {
    let least = |cost: fn(&CellRecord) -> f64| {
        let by_cost = |a: &&CellRecord, b: &&CellRecord| cost(a).total_cmp(&cost(b));
        cells.iter().min_by(by_cost)
    };
    let Some((best, predicted)) = least(|c| c.c_counted).zip(least(|c| c.c_predicted)) else {
        return String::new();
    };
    let more = |cell: &CellRecord| per_cent_more(cell.c_counted, best.c_counted);
    let (tied, mut others): (Vec<&CellRecord>, Vec<_>) =
        cells.iter().partition(|cell| !gains(more(cell)));
    others.sort_by(|a, b| a.c_counted.total_cmp(&b.c_counted));
    let (Some((take, also)), Some(next)) = (tied.split_first(), others.first()) else {
        return "\nEvery strategy gives a tree of the same cost.\n".to_owned();
    };
    let also: Vec<&str> = also.iter().map(|cell| cell.strategy.as_str()).collect();
    let also = match also[..] {
        [] => String::new(),
        [one] => format!(" (as does {one})"),
        [one, two] => format!(" (as do {one}, {two})"),
        _ => format!(" ({} others cost the same)", also.len()),
    };
    let mut text = format!(
        "\nTake {}: its lines cost {} each, counted{also}. {} costs {} % more",
        take.strategy,
        significant(take.c_counted, 4),
        next.strategy,
        significant(more(next), 2)
    );
    if let [_, .., worst] = others[..] {
        let percent = significant(more(worst), 2);
        let _ = write!(text, ", the worst, {}, {percent} % more", worst.strategy);
    }
    let same = !gains(per_cent_more(take.c_predicted, predicted.c_predicted));
    let picked = if same {
        "the same"
    } else {
        &predicted.strategy
    };
    let _ = write!(
        text,
        ". Surface areas alone would have picked {picked}. All this is for lines that never stop."
    );
    fold(&text, WIDTH) + "\n"
}

fn per_cent_more(cost: f64, least: f64) -> f64 {
    percent_above(cost / least)
}

/// Whether a saving of so many per cent is one (it is none where costs are 0 and their ratio no number).
fn gains(percent: f64) -> bool {
    percent >= LEAST_GAIN
}

/// Per cent of cost below which trees count as equal.
const LEAST_GAIN: f64 = 0.005;

/// Several runs on one screen: what each asked, and which of its expectations held; of those that did not, the figures.
pub fn together(runs: &[Run]) -> String {
    const MARGIN: usize = 27;
    let all: Vec<_> = runs.iter().flat_map(Run::verdicts).collect();
    let held = all.iter().filter(|v| v.held).count();
    let parts = counted(runs.len() as u64, "experiment");
    let mut text = format!(
        "\n{parts}: {held} of {} expectations held, {} missed\n\n",
        all.len(),
        all.len() - held
    );
    for run in runs {
        text += &beside(MARGIN, &run.summary.experiment, &run.summary.question);
        let (held, missed): (Vec<_>, Vec<_>) = run.verdicts().partition(|v| v.held);
        let names: Vec<_> = held.iter().map(|v| &*v.name).collect();
        if !names.is_empty() {
            text += &beside(MARGIN, "", &format!("held: {}", names.join(", ")));
        }
        for v in missed {
            text += &beside(MARGIN, "", &format!("MISSED: {}: {}", v.name, v.message));
        }
    }
    text
}

/// A name, and from column `margin` on a text, folded; a name that is too long for that has a line of its own.
fn beside(margin: usize, name: &str, text: &str) -> String {
    let indent = format!("\n{:margin$}", "");
    let text = fold(text, WIDTH - margin).replace('\n', &indent);
    if name.len() < margin {
        format!("{name:margin$}{text}\n")
    } else {
        format!("{name}{indent}{text}\n")
    }
}

/// A verdict and its figures each, folded beside their name.
pub(in crate::report) fn verdicts(run: &Run) -> String {
    const MARGIN: usize = 22;
    let mut text = String::from("\n");
    for v in run.verdicts() {
        let mark = if v.held { "held" } else { "MISSED" };
        text += &beside(MARGIN, &format!("{mark:6}  {}", v.name), &v.message);
    }
    if run.summary.quick {
        text += "quick form: fewer lines, smaller scenes; no figure of it is to be published\n";
    }
    text
}

/// What is said where no tree has a node besides its root.
fn nothing_to_fit(hits: &Hits) -> &'static str {
    if hits.cells.iter().all(|cell| cell.slope.is_none()) {
        "no tree has a node besides its root: nothing to fit\n"
    } else {
        ""
    }
}

/// How fast the cells of the run went, from `timings.csv`; empty where it has no times of them.
pub fn speed(run: &Run) -> String {
    let Some(hits) = run.hits() else {
        return String::new();
    };
    let of_run = |timing: &&TimingRecord| hits.cells.iter().any(|cell| cell.cell == timing.cell);
    let timings: Vec<&TimingRecord> = hits.timings.iter().flatten().filter(of_run).collect();
    let Some(first) = timings.first() else {
        return String::new();
    };
    let sum = |part: fn(&TimingRecord) -> f64| timings.iter().map(|t| part(t)).sum::<f64>();
    let (build, count) = (sum(|t| t.build_s), sum(|t| t.count_s));
    let visits: u64 = timings.iter().map(|t| t.visits).sum();
    format!(
        "speed  {} visits in {} s of counting ({} a second, {}), trees built in {} s\n",
        significant(visits as f64, 3),
        significant(count, 3),
        significant(visits as f64 / count, 3),
        counted(first.threads, "thread"),
        significant(build, 3)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::fixture;

    /// One scene, strategies a, b, ... of these counted and predicted costs.
    fn trees(costs: &[(f64, f64)]) -> Vec<CellRecord> {
        let names = ["a", "b", "c", "d", "e"];
        let tree = |(name, &(counted, predicted)): (&&str, &(f64, f64))| CellRecord {
            c_counted: counted,
            c_predicted: predicted,
            ..fixture::cell("scene", name, 601)
        };
        names.iter().zip(costs).map(tree).collect()
    }

    #[test]
    fn texts_stand_beside_names() {
        assert_eq!(beside(6, "name", "text"), "name  text\n");
        assert_eq!(beside(6, "longer", "text"), "longer\n      text\n");
        let words = "words ".repeat(20);
        let folded = beside(6, "", &words);
        assert!(folded.lines().count() > 1);
        assert!(folded.lines().all(|line| line.starts_with("      words")));
    }

    #[test]
    fn ties_are_told() {
        let advice = |costs: &[(f64, f64)]| advice(&trees(costs)).replace('\n', " ");
        let one = advice(&[(20.0, 20.0), (10.0, 9.0), (30.0, 30.0)]);
        assert!(one.contains("Take b: its lines cost 10.00 each, counted. a costs 100 % more"));
        assert!(
            one.contains(
                "the worst, c, 200 % more. Surface areas alone would have picked the same."
            )
        );
        let tied = advice(&[(10.0001, 10.0), (10.0, 9.0), (30.0, 30.0)]);
        assert!(tied.contains(
            "Take a: its lines cost 10.00 each, counted (as does b). c costs 200 % more."
        ));
        assert!(tied.contains("would have picked b."), "{tied}");
        let many = advice(&[
            (10.0, 9.0),
            (10.0, 9.0),
            (10.0, 9.0),
            (10.0, 9.0),
            (20.0, 9.0),
        ]);
        assert!(many.contains("(3 others cost the same)"), "{many}");
        for costs in [(10.0, 9.0), (0.0, 0.0), (f64::NAN, f64::NAN)] {
            let all = advice(&[costs; 3]);
            assert_eq!(all, " Every strategy gives a tree of the same cost. ");
        }
    }

    fn hits(run: &mut Run) -> &mut Hits {
        match &mut run.content {
            Content::Hits(hits) => hits,
            _ => unreachable!("it is a run of kind hits-vs-area"),
        }
    }

    #[test]
    fn only_times_of_the_runs_cells_count() {
        let time = |cell: &str| TimingRecord {
            cell: cell.to_owned(),
            scene: String::new(),
            strategy: String::new(),
            build_s: 1.0,
            count_s: 2.0,
            threads: 3,
            visits: 100,
        };
        let mut run = fixture::run(trees(&[(1.0, 1.0)]));
        assert_eq!(speed(&run), "");
        hits(&mut run).timings = Some(vec![time("another"), time("scene-a")]);
        assert!(
            speed(&run)
                .starts_with("speed  100 visits in 2.00 s of counting (50.0 a second, 3 threads)")
        );
        hits(&mut run).timings = Some(vec![time("another")]);
        assert_eq!(speed(&run), "");
    }

    #[test]
    fn a_run_of_single_leaves_says_so() {
        let mut run = fixture::run(trees(&[(1.0, 1.0), (1.0, 1.0)]));
        assert!(!study(&run).contains("nothing to fit"));
        let cells = &mut hits(&mut run).cells;
        cells.iter_mut().for_each(|cell| cell.slope = None);
        assert!(study(&run).contains("no tree has a node besides its root: nothing to fit\n"));
    }
}
