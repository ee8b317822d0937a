//! What came of tracing a user's own rays, on one screen.

use super::number::{counted, digits_for, grouped, significant};
use super::screen::WIDTH;
use super::table::{Cell, Column, Table};
use crate::study::records::TraceRecord;

/// Rays, hits, and the work of a ray beside what areas predict; `seconds` of building and of tracing.
pub fn screen(record: &TraceRecord, seconds: [f64; 2]) -> String {
    let [build, trace] = seconds.map(|s| significant(s, 3));
    let head = format!(
        "\n{}: {}, tree of {}, stop {}{}\n{}: {} asking {}, {} meet the scene's box, {} hit an object\n\n",
        record.scene,
        counted(record.objects, "object"),
        record.strategy,
        record.stop,
        if record.clipped { ", clipped" } else { "" },
        record.file,
        counted(record.rays, "ray"),
        record.ask,
        grouped(record.entered),
        grouped(record.hits),
    );
    let built = format!("\ntree built in {build} s, rays traced and written in {trace} s\n");
    head + &table(record).to_text(WIDTH) + &built
}

fn table(record: &TraceRecord) -> Table {
    let r = record;
    let rows = [
        ("inner nodes n_K", r.n_k_counted, r.n_k_predicted),
        ("leaves n_B", r.n_b_counted, r.n_b_predicted),
        ("object tests n_t", r.n_t_counted, r.n_t_predicted),
        ("cost C", r.c_counted, r.c_predicted),
    ];
    let row = |(name, counted, predicted): (&str, f64, f64)| {
        let cell = |value: f64| Cell::Value(value, digits_for(value, 4));
        let ratio = Cell::Value(counted / predicted, 3);
        vec![
            Cell::Text(name.into()),
            cell(counted),
            cell(predicted),
            ratio,
        ]
    };
    Table {
        caption: format!(
            "Per ray, and what areas predict of isotropic lines that never stop (costs {}:{}:{}).",
            r.c_k, r.c_b, r.c_t
        ),
        columns: vec![
            Column::left("", "what"),
            Column::right("counted", "counted"),
            Column::right("predicted", "predicted"),
            Column::right("ratio", "ratio"),
        ],
        keys: 1,
        rows: rows.map(row).into(),
    }
}
