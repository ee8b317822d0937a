//! What the rays of the pictures are and do.

use super::text;
use crate::report::number::percent_above;
use crate::report::series::distinct;
use crate::report::strategies::havran;
use crate::report::strategies::part::{KINDS, Part, Tree};
use crate::report::table::{Cell, Column, Table};
use crate::study::records::RayRecord;

/// Every tree: what a traced ray of each kind does in it on average.
pub fn rays(part: &Part) -> Table {
    let columns = vec![
        Column::left("scene", "scene"),
        Column::left("strategy", "strategy"),
        Column::left("kind", "kind"),
        Column::right("rays", "rays"),
        Column::right("hit, %", "hits_pct"),
        Column::right("n_K", "n_k"),
        Column::right("n_B", "n_b"),
        Column::right("n_t", "n_t"),
        Column::right("C", "c"),
    ];
    let row = |tree: &Tree, rays: &RayRecord| {
        let per_ray = |sum: f64, decimals| match rays.rays {
            0 => Cell::Missing,
            number => Cell::Value(sum / number as f64, decimals),
        };
        vec![
            text(&tree.cell.scene),
            text(&tree.cell.strategy),
            text(&rays.kind),
            Cell::Count(rays.rays),
            per_ray(100.0 * rays.hits as f64, 1),
            per_ray(rays.inner_visits as f64, 2),
            per_ray(rays.leaf_visits as f64, 2),
            per_ray(rays.object_tests as f64, 2),
            per_ray(tree.cost_of(rays), 1),
        ]
    };
    let mut rows = Vec::new();
    for tree in &part.trees {
        rows.extend(tree.rays.iter().map(|rays| row(tree, rays)));
    }
    Table {
        caption: format!(
            "Work of the rays of each picture, stop {}: inner nodes n_K, leaves n_B and object tests n_t per ray, complete \
             counts, and c_K n_K + c_B n_B + c_t n_t. Rays stop where they hit something.",
            part.stop
        ),
        columns,
        keys: 3,
        rows,
    }
}

/// The rays of one scene, whatever tree they are traced through.
struct Counts {
    primary: u64,
    primary_hits: u64,
    shadow: u64,
    shadow_hits: u64,
    secondary: u64,
}

impl Counts {
    fn of(rays: &[RayRecord], scene: &str) -> Self {
        let of_kind = |kind: &str| {
            let row = rays
                .iter()
                .find(|row| row.scene == scene && row.kind == kind);
            row.map_or((0, 0), |row| (row.rays, row.hits))
        };
        let [
            (primary, primary_hits),
            (shadow, shadow_hits),
            (secondary, _),
        ] = KINDS.map(of_kind);
        Self {
            primary,
            primary_hits,
            shadow,
            shadow_hits,
            secondary,
        }
    }
}

/// The rays of every scene, and how far they are from Havran's counts of 1999.
pub fn ray_counts(rays: &[RayRecord]) -> Table {
    let counted = [
        ("eye rays", "primary_rays"),
        ("that hit", "primary_hits"),
        ("shadow rays", "shadow_rays"),
        ("blocked", "shadow_hits"),
        ("secondary rays", "secondary_rays"),
        ("all rays", "all_rays"),
    ];
    let mut columns = vec![Column::left("scene", "scene")];
    columns.extend(counted.map(|(title, key)| Column::right(title, key)));
    columns.push(Column::right(
        "eye rays that hit, more than Havran's",
        "primary_hits_more",
    ));
    columns.extend(counted[2..].iter().map(|(title, key)| {
        Column::right(
            &format!("{title}, % more than Havran's"),
            &format!("{key}_more_pct"),
        )
    }));
    let row = |scene: &str| {
        let ours = Counts::of(rays, scene);
        let all = ours.primary + ours.shadow + ours.secondary;
        let counts = [
            ours.primary,
            ours.primary_hits,
            ours.shadow,
            ours.shadow_hits,
            ours.secondary,
            all,
        ];
        let his = havran::rays(scene).filter(|_| ours.primary == havran::EYE_RAYS);
        let hits = his.and_then(|his| his.primary_hits);
        let pairs = his.map_or([None; 4], |his| {
            [
                his.shadow_rays,
                his.shadow_hits,
                his.secondary_rays,
                his.all_rays,
            ]
        });
        let mut row = vec![text(scene)];
        row.extend(counts.map(Cell::Count));
        row.push(hits.map_or(Cell::Missing, |his| {
            Cell::Change(ours.primary_hits as f64 - his as f64, 0)
        }));
        row.extend(pairs.iter().zip(&counts[2..]).map(|(his, &ours)| {
            his.map_or(Cell::Missing, |his| {
                Cell::Change(percent_above(ours as f64 / his as f64), 1)
            })
        }));
        row
    };
    let scenes = distinct(rays.iter().map(|row| row.scene.as_str()));
    Table {
        caption: "Rays of a whole picture of each scene, and how many more they are than Vlastimil Havran counted in 1999 at \
                  the same sizes, where he tells and the picture has 513 × 513 eye rays. Why they differ: our surfaces are \
                  two-sided, so what is seen of a shell's inner side (teapot) asks for shadows too, and is blocked; his \
                  materials were older, his glass gears reflected; the rest, in gears and lattice, is not explained."
            .to_owned(),
        columns,
        keys: 1,
        rows: scenes.into_iter().map(row).collect(),
    }
}
