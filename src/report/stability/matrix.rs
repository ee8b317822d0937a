//! The matrix of outcomes: a row a case, a column a kernel and a strategy.

use plotters::style::text_anchor::{HPos, VPos};

use super::Stability;
use super::cell::{cell, legend, shade};
use super::outcomes::{Outcome, kernel_words, missed};
use crate::report::Figure;
use crate::report::figure::{LEFT, Pen, WIDTH};
use crate::report::grid::{page, page_name, part};
use crate::report::palette::{GRID, INK, MUTED};
use crate::report::series::distinct;
use crate::report::text::{MEDIUM, SMALL, beginning, fit, text_width};
use crate::study::records::{CaseRecord, Summary};

const TITLE: &str = "Hard cases: is every answer right?";
/// Lines of a page at most: cases and headings of groups.
const LINES: usize = 42;
/// Height of a line; widest column.
const ROW: f64 = 10.4;
const COLUMN: f64 = 9.8;
/// A kernel's only column, and the room of the kernel's name above it.
const LONE: f64 = 34.0;
const KERNEL: f64 = 46.0;
/// Between two kernels.
const GAP: f64 = 6.0;
const WIDEST_NAME: f64 = 156.0;
/// Least room in which what a case stresses is told beside it.
const ROOM: f64 = 120.0;

/// A line of a page.
#[derive(Clone, Copy)]
enum Line<'r> {
    Group(&'r str),
    Case(&'r str, &'r str),
}

impl Line<'_> {
    /// Whether a row is of the line's case.
    fn shows(&self, row: &CaseRecord) -> bool {
        matches!(self, Line::Case(group, case) if row.group == *group && row.case == *case)
    }
}

/// The pages: cases with a tree, which say most, then those without one.
pub fn figures(run: &Stability, summary: &Summary) -> Vec<(String, Figure)> {
    let mut pages: Vec<(Vec<Line>, Vec<&CaseRecord>)> = Vec::new();
    for of_trees in [true, false] {
        let own = run.cases.iter();
        let own = own.filter(|row| row.strategy.is_empty() != of_trees);
        let rows: Vec<&CaseRecord> = own.collect();
        let lines = paged(&rows).into_iter();
        pages.extend(lines.map(|lines| {
            let shown = |row: &&&CaseRecord| lines.iter().any(|line| line.shows(row));
            let own = rows.iter().filter(shown).copied().collect();
            (lines, own)
        }));
    }
    let of = pages.len();
    let page = |(i, (lines, rows)): (usize, &(Vec<Line>, Vec<&CaseRecord>))| {
        (
            page_name("stability", i),
            figure(lines, rows, &part(i, of), summary),
        )
    };
    pages.iter().enumerate().map(page).collect()
}

/// Cases under the names of their groups, so many lines a page; a group that goes on names itself again.
fn paged<'r>(rows: &[&'r CaseRecord]) -> Vec<Vec<Line<'r>>> {
    let mut pages: Vec<Vec<Line>> = Vec::new();
    for group in distinct(rows.iter().map(|row| row.group.as_str())) {
        let own = rows.iter().filter(|row| row.group == group);
        let mut named = false;
        for case in distinct(own.map(|row| row.case.as_str())) {
            let needed = if named { 1 } else { 2 };
            let full = pages.last().is_none_or(|page| page.len() + needed > LINES);
            if full {
                pages.push(Vec::new());
            }
            if let Some(page) = pages.last_mut() {
                if full || !named {
                    page.push(Line::Group(group));
                }
                page.push(Line::Case(group, case));
            }
            named = true;
        }
    }
    pages
}

/// Where the columns of a page stand.
struct Columns<'r> {
    /// Kernel and strategy of each, with its left edge.
    all: Vec<(&'r str, &'r str, f64)>,
    width: f64,
    right: f64,
}

impl<'r> Columns<'r> {
    fn of(rows: &[&'r CaseRecord], left: f64) -> Self {
        let kernels = distinct(rows.iter().map(|row| row.kernel.as_str()));
        let strategies = distinct(rows.iter().map(|row| row.strategy.as_str()));
        let known = |kernel: &str, strategy: &str| {
            let mut all = rows.iter();
            all.any(|row| row.kernel == kernel && row.strategy == strategy)
        };
        let blocks = kernels.iter().map(|kernel| {
            let own = strategies.iter().copied().filter(|s| known(kernel, s));
            (*kernel, own.collect::<Vec<_>>())
        });
        let blocks: Vec<_> = blocks.collect();
        let count: usize = blocks.iter().map(|(_, own)| own.len()).sum();
        let gaps = GAP * blocks.len().saturating_sub(1) as f64;
        let room = WIDTH - LEFT - left - gaps;
        let widest = if strategies.len() == 1 { LONE } else { COLUMN };
        let width = (room / count.max(1) as f64).min(widest);
        let (mut x, mut all) = (left, Vec::new());
        for (kernel, own) in blocks {
            for strategy in own {
                all.push((kernel, strategy, x));
                x += width;
            }
            x += GAP;
        }
        Columns {
            all,
            width,
            right: x - GAP,
        }
    }

    /// Names of kernels and strategies above the matrix.
    fn headings(&self, pen: &Pen, top: f64, kernels: f64) {
        let names = self.all.iter().map(|(kernel, _, _)| *kernel);
        for kernel in distinct(names) {
            let own = self.all.iter().filter(|column| column.0 == kernel);
            let lefts: Vec<f64> = own.map(|column| column.2).collect();
            let (first, last) = (lefts[0], lefts[lefts.len() - 1] + self.width);
            let middle = (0.5 * (first + last), kernels);
            let name = fit(kernel_words(kernel), MEDIUM, (last - first).max(KERNEL));
            pen.text(&name, middle, MEDIUM, INK, (HPos::Center, VPos::Bottom));
            let rule = kernels + 2.5;
            pen.line(&[(first, rule), (last, rule)], INK, 0.5);
        }
        for (_, strategy, left) in &self.all {
            let at = (left + 0.5 * self.width + 2.5, top - 3.0);
            let name = fit(strategy, SMALL, WIDEST_NAME);
            pen.upright(&name, at, SMALL, MUTED, (HPos::Left, VPos::Bottom));
        }
    }
}

fn figure(lines: &[Line], rows: &[&CaseRecord], which: &str, summary: &Summary) -> Figure {
    let caption = caption(which, summary);
    let strategies = rows.iter().map(|row| text_width(&row.strategy, SMALL));
    // Strategies read upwards above their columns, kernels stand above them.
    let upright = strategies.fold(0.0, f64::max).min(WIDEST_NAME);
    let above = 24.0 + upright;
    // Nothing stands below the matrix that a panel's axis would need room for.
    let high = above + ROW * lines.len() as f64 - 20.0;
    page((TITLE, caption), &[], high, summary, |pen, top| {
        legend(pen, top - 6.0);
        let names = lines.iter().map(|line| match line {
            Line::Group(name) => text_width(name, MEDIUM),
            Line::Case(_, name) => 6.0 + text_width(name, MEDIUM),
        });
        let names = names.fold(0.0, f64::max).min(6.0 + WIDEST_NAME);
        let columns = Columns::of(rows, LEFT + names + 6.0);
        let first = top + above;
        columns.headings(pen, first, top + 16.0);
        for (i, line) in lines.iter().enumerate() {
            let middle = first + ROW * (i as f64 + 0.5);
            match *line {
                Line::Group(name) => {
                    pen.text(
                        name,
                        (LEFT, middle),
                        MEDIUM,
                        INK,
                        (HPos::Left, VPos::Center),
                    );
                }
                Line::Case(group, name) => {
                    let own = rows.iter().copied();
                    let own = own.filter(|row| row.group == group && row.case == name);
                    case(pen, &columns, own.collect(), middle);
                }
            }
        }
    })
}

fn caption(which: &str, summary: &Summary) -> String {
    format!(
        "A row is a named case with an exactly known outcome, a column a kernel and a strategy's tree; blank: not for it. Passed: the \
         outcome is the expected one, a refusal included where one is expected. Off: by units in the last place of the kernel's \
         numbers, or as the case says. Framed: demanded, and refused or failed. Stop {}. Seed {}.{which}",
        summary.stop.as_deref().unwrap_or("unknown"),
        summary.seed
    )
}

/// One case: its name, its cells and, where there is room, what it stresses.
fn case(pen: &Pen, columns: &Columns, rows: Vec<&CaseRecord>, middle: f64) {
    let Some(first) = rows.first() else {
        return;
    };
    let name = fit(&first.case, MEDIUM, WIDEST_NAME);
    let at = (LEFT + 6.0, middle);
    pen.text(&name, at, MEDIUM, INK, (HPos::Left, VPos::Center));
    let below = middle + 0.5 * ROW;
    pen.line(&[(LEFT, below), (columns.right, below)], GRID, 0.3);
    for (kernel, strategy, left) in &columns.all {
        let own = rows.iter();
        let mut own = own.filter(|row| row.kernel == *kernel && row.strategy == *strategy);
        if let Some(row) = own.next() {
            let corner = (left + 0.5, middle - 0.5 * ROW + 0.5);
            let opposite = (left + columns.width - 0.5, below - 0.5);
            let shade = shade(row.off);
            cell(
                pen,
                Outcome::of(row),
                shade,
                missed(row),
                (corner, opposite),
            );
        }
    }
    let (left, right) = (columns.right + 8.0, WIDTH - LEFT);
    if right - left >= ROOM {
        let text = beginning(&first.stresses, SMALL, right - left);
        pen.text(
            &text,
            (left, middle),
            SMALL,
            MUTED,
            (HPos::Left, VPos::Center),
        );
    }
}
