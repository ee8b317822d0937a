//! The tables. Where the script runs, a click on a column's head sorts by it.

use super::escape::{anchor, escape};
use super::files::Place;
use super::page::Section;
use crate::report::Run;
use crate::report::number::counted;
use crate::report::table::{Align, Cell, Column, Table};

/// Tables of more rows are folded.
const OPEN: usize = 24;

/// Every table of the run.
pub fn section(run: &Run, place: &Place) -> Section {
    let (mut parts, mut body) = (Vec::new(), String::new());
    for (name, table) in run.tables() {
        let id = anchor("table", &name);
        let files = place.table(&name);
        body += &format!(
            "<h3 id=\"{id}\">{}</h3>\n<p class=\"caption\">{}{files}</p>\n{}",
            escape(&name),
            escape(&table.caption),
            folded(&name, &table)
        );
        parts.push((id, name));
    }
    Section {
        id: "tables",
        title: "Tables",
        parts,
        body,
    }
}

/// The table in a box of its own, folded where it is long.
fn folded(name: &str, table: &Table) -> String {
    let boxed = format!(
        "<div class=\"box\" role=\"region\" tabindex=\"0\" aria-label=\"Table {}\">\n{}</div>\n",
        escape(name),
        html(table)
    );
    match table.rows.len() {
        rows if rows > OPEN => format!(
            "<details>\n<summary>{}</summary>\n{boxed}</details>\n",
            counted(rows as u64, "row")
        ),
        _ => boxed,
    }
}

/// The table alone.
fn html(table: &Table) -> String {
    let mut out = String::from("<table>\n<thead>\n<tr>");
    for column in &table.columns {
        let class = class(column.align);
        out += &format!("<th scope=\"col\"{class}>{}</th>", escape(&column.title));
    }
    out += "</tr>\n</thead>\n<tbody>\n";
    for row in &table.rows {
        out += "<tr>";
        for (i, (cell, column)) in row.iter().zip(&table.columns).enumerate() {
            out += &cell_html(cell, column, i < table.keys);
        }
        out += "</tr>\n";
    }
    out + "</tbody>\n</table>\n"
}

/// A cell; `data-v` is the number it is sorted by, empty where that is unknown, left out where it is what is shown.
fn cell_html(cell: &Cell, column: &Column, names_row: bool) -> String {
    let (shown, raw) = (cell.show(), cell.raw());
    let value = match cell {
        Cell::Text(_) => String::new(),
        _ if shown == raw => String::new(),
        _ => format!(" data-v=\"{raw}\""),
    };
    let class = class(column.align);
    let [open, close] = if names_row {
        ["th scope=\"row\"", "th"]
    } else {
        ["td", "td"]
    };
    format!("<{open}{class}{value}>{}</{close}>", escape(&shown))
}

fn class(align: Align) -> &'static str {
    match align {
        Align::Left => "",
        Align::Paragraph => " class=\"p\"",
        Align::Right => " class=\"n\"",
    }
}
