//! What links take of memory.

use super::{INTERVAL, ratio_cells, ratio_columns};
use crate::report::shown::{known, percent, ratio, text};
use crate::report::strategies::averages::Averages;
use crate::report::table::{Cell, Column, Table};
use crate::report::traversal::Traversal;
use crate::report::traversal::against::{PRECISIONS, WAYS, beside, memory as factor};
use crate::study::records::LinkRecord;

fn per_leaf(row: &LinkRecord, bytes: u64) -> Cell {
    known(
        (row.leaves > 0).then(|| bytes as f64 / row.leaves as f64),
        ratio,
    )
}

/// Every tree in each precision.
pub fn memory(run: &Traversal) -> Table {
    let columns = vec![
        Column::left("scene", "scene"),
        Column::left("precision", "precision"),
        Column::right("leaves", "leaves"),
        Column::right("thin", "thin_leaves"),
        Column::right("depth", "depth"),
        Column::right("tree, bytes", "tree_bytes"),
        Column::right("per leaf", "tree_bytes_per_leaf"),
        Column::right("links, bytes", "link_bytes"),
        Column::right("per leaf", "link_bytes_per_leaf"),
        Column::right("face trees, bytes", "face_tree_bytes"),
        Column::right("per leaf", "face_tree_bytes_per_leaf"),
        Column::right("with links", "links_factor"),
        Column::right("with face trees", "face_trees_factor"),
        Column::right("straight, %", "straight_pct"),
    ];
    let row = |row: &LinkRecord| {
        let inside = row.links_to_leaves + row.links_to_inner;
        let straight = (inside > 0).then(|| row.links_to_leaves as f64 / inside as f64);
        vec![
            text(&row.scene),
            text(&row.precision),
            Cell::Count(row.leaves),
            Cell::Count(row.thin_leaves),
            Cell::Count(row.depth),
            Cell::Count(row.tree_bytes),
            per_leaf(row, row.tree_bytes),
            Cell::Count(row.link_bytes),
            per_leaf(row, row.link_bytes),
            Cell::Count(row.face_tree_bytes),
            per_leaf(row, row.face_tree_bytes),
            known(factor(row, "links"), ratio),
            known(factor(row, "face-trees"), ratio),
            known(straight, percent),
        ]
    };
    Table {
        caption: "Bytes of the tree (nodes and references), and beside them of links (leaves with their boxes, links and references, and \
                  leaf numbers of nodes) or of links through face trees; with links, with face trees: bytes with them over those of the \
                  tree alone. Thin: leaves thinner than 12 ulp of the root's longest side, whose planes are not told apart. Straight: links that \
                  lead to a leaf, of those within the root's box."
            .to_owned(),
        columns,
        keys: 2,
        rows: run.links.iter().map(row).collect(),
    }
}

/// All trees together.
pub fn memory_summary(run: &Traversal) -> Table {
    let mut columns = vec![
        Column::left("precision", "precision"),
        Column::left("way", "way"),
        Column::right("trees", "trees"),
        Column::right("bytes a leaf", "bytes_per_leaf"),
    ];
    columns.extend(ratio_columns("with them over the tree alone", "factor"));
    let row = |precision: &str, way: &str| {
        let own = || run.links.iter().filter(|row| row.precision == precision);
        let ratios: Vec<_> = own()
            .filter_map(|row| Some((row.scene.as_str(), factor(row, way)?)))
            .collect();
        let averages = Averages::of(&ratios)?;
        let leaf = |row: &LinkRecord| {
            let bytes = beside(row, way).filter(|_| row.leaves > 0)?;
            Some(bytes as f64 / row.leaves as f64)
        };
        let leaves: Vec<_> = own()
            .filter_map(|row| Some((row.scene.as_str(), leaf(row)?)))
            .collect();
        let mut row = vec![
            text(precision),
            text(way),
            Cell::Count(averages.scenes as u64),
            known(Averages::of(&leaves), |all: Averages| ratio(all.geometric)),
        ];
        row.extend(ratio_cells(Some(&averages)));
        Some(row)
    };
    let rows = PRECISIONS
        .iter()
        .flat_map(|precision| WAYS.iter().filter_map(move |way| row(precision, way)));
    Table {
        caption: format!(
            "What links, and links through face trees, take of memory: bytes a leaf beside the tree's own (geometric mean), and bytes \
                  of the tree with them over the tree alone (geometric mean over scenes, least and most; {INTERVAL}). Restarts take none."
        ),
        columns,
        keys: 2,
        rows: rows.collect(),
    }
}
