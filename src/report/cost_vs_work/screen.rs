//! A run of this kind on one screen.

use super::findings::NONE;
use super::times::{INTERVALS, constants, models};
use super::{CostVsWork, work};
use crate::report::table::{Table, fold};
use crate::study::records::ModelRecord;

/// The tables that fit: work by set of rays, errors of the models, constants of the chosen one.
pub fn tables(run: &CostVsWork, width: usize) -> String {
    let work = short(
        without(
            work::summary(run),
            &["trees", "pairs_right_pct", "regret_scene"],
        ),
        &format!(
            "{} counted on rays over the one predicted from surface areas, {}; order of a scene's trees by it",
            work::formula(run),
            work::trees(run)
        ),
        1,
    );
    let mut text = work.to_text(width);
    if run.models.is_empty() {
        return text + "\n" + &fold(NONE, width) + "\n";
    }
    let judged = models(run, |m| m.left_out == ModelRecord::SCENE);
    let judged = without(judged, &["left_out", "constants", "pairs_right_pct"]);
    let heading = "Time of a ray predicted from its counts, its scene left out";
    text += &format!("\n{}", short(judged, heading, 1).to_text(width));
    let own = without(
        constants(run, |c| c.model == ModelRecord::CHOSEN),
        &["model"],
    );
    let heading =
        format!("Nanoseconds of one of each chosen term, with the 95 % interval ({INTERVALS})");
    text + "\n" + &short(own, &heading, 1).to_text(width)
}

/// The table under a short heading.
fn short(table: Table, caption: &str, keys: usize) -> Table {
    Table {
        caption: caption.to_owned(),
        keys,
        ..table
    }
}

/// The table without some columns.
fn without(table: Table, keys: &[&str]) -> Table {
    let keep: Vec<bool> = table
        .columns
        .iter()
        .map(|column| !keys.contains(&column.key.as_str()))
        .collect();
    fn kept<T>(all: Vec<T>, keep: &[bool]) -> Vec<T> {
        let pairs = all.into_iter().zip(keep);
        pairs
            .filter_map(|(one, &keep)| keep.then_some(one))
            .collect()
    }
    Table {
        columns: kept(table.columns, &keep),
        rows: table.rows.into_iter().map(|row| kept(row, &keep)).collect(),
        ..table
    }
}
