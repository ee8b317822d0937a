//! What kernels get wrong, and their time.

use super::super::SpeedVsError;
use super::super::times::Of;
use crate::report::number::digits_for;
use crate::report::shown::{known, ratio, text};
use crate::report::table::{Cell, Column, Table};
use crate::study::records::PrecisionRecord;

/// Every kernel at every offset, by both families of lines.
pub fn precision(run: &SpeedVsError) -> Table {
    let columns = vec![
        Column::left("scene", "scene"),
        Column::right("offset", "offset"),
        Column::left("kernel", "kernel"),
        Column::left("lines", "family"),
        Column::left("verdict", "verdict"),
        Column::right("extent/ulp", "resolution"),
        Column::right("lines", "lines"),
        Column::right("visits", "visits"),
        Column::right("wrong", "wrong_visits"),
        Column::right("missed", "missed_visits"),
        Column::right("tied", "tied_visits"),
        Column::right("missed", "tied_missed_visits"),
        Column::right("per 10⁹", "visits_per_1e9"),
        Column::right("least", "visits_per_1e9_lo"),
        Column::right("most", "visits_per_1e9_hi"),
        Column::right("tests", "tests"),
        Column::right("wrong", "wrong_hits"),
        Column::right("missed", "missed_hits"),
        Column::right("tied", "tied_hits"),
        Column::right("per 10⁹", "hits_per_1e9"),
        Column::right("least", "hits_per_1e9_lo"),
        Column::right("most", "hits_per_1e9_hi"),
        Column::measured("slope − 1, %", "slope_minus_1_pct"),
        Column::right("max |z|", "max_z"),
        Column::right("flat nodes", "flat_nodes"),
    ];
    let row = |r: &PrecisionRecord| {
        let rate = |value: Option<f64>| known(value, ratio);
        let half = r.slope_se.map(|se| 100.0 * crate::report::number::Z99 * se);
        vec![
            text(&r.scene),
            Cell::Value(r.offset, digits_for(r.offset, 1)),
            text(&r.kernel),
            text(&r.family),
            text(&r.verdict),
            rate(r.resolution),
            Cell::Count(r.lines),
            Cell::Count(r.visits),
            Cell::Count(r.wrong_visits),
            Cell::Count(r.missed_visits),
            Cell::Count(r.tied_visits),
            Cell::Count(r.tied_missed_visits),
            rate(r.visits_per_1e9),
            rate(r.visits_per_1e9_lo),
            rate(r.visits_per_1e9_hi),
            Cell::Count(r.tests),
            Cell::Count(r.wrong_hits),
            Cell::Count(r.missed_hits),
            Cell::Count(r.tied_hits),
            rate(r.hits_per_1e9),
            rate(r.hits_per_1e9_lo),
            rate(r.hits_per_1e9_hi),
            known(r.slope_error, |error| Cell::Estimate(100.0 * error, half)),
            known(r.max_z, |z| Cell::Value(z, 1)),
            Cell::Count(r.flat_nodes),
        ]
    };
    Table {
        caption: "Nodes visited and triangles hit by a kernel against exact arithmetic: taken for met though missed (wrong), for missed \
                  though met (missed), either within 8 ulp of a tie (tied, of visits those missed beside them); all per 10⁹ visits or tests, with the 95 % interval. \
                  Offset: how far the scene was moved along x, y and z, over the longest side of its box; extent/ulp: that side over the \
                  spacing of f32 numbers at the farthest coordinate. Slope and largest |z| of a node are of random lines; ± is half of the \
                  99 % interval. f32 is judged on its own rounded inputs: what their rounding does shows in slope and |z| alone."
            .to_owned(),
        columns,
        keys: 4,
        rows: run.precision.iter().map(row).collect(),
    }
}

/// Time of every kernel at every offset; `None` where nothing was timed.
pub fn times_precision(run: &SpeedVsError) -> Option<Table> {
    let columns = vec![
        Column::left("scene", "scene"),
        Column::right("offset", "offset"),
        Column::left("kernel", "kernel"),
        Column::right("ns a visit", "visit_ns"),
        Column::right("over f64's", "visit_over_f64"),
        Column::right("ns a ray", "ray_ns"),
        Column::right("over f64's", "ray_over_f64"),
    ];
    let row = |r: &PrecisionRecord| {
        let same = |o: &&PrecisionRecord| {
            o.kernel == "f64" && o.scene == r.scene && o.offset == r.offset && o.family == r.family
        };
        let f64s = run.precision.iter().find(same);
        let over = |unit: &str| Some(run.kernel_ns(r, unit)? / run.kernel_ns(f64s?, unit)?);
        let [visit, ray] = ["visit", "ray"].map(|unit| run.kernel_ns(r, unit));
        (visit.is_some() || ray.is_some()).then(|| {
            vec![
                text(&r.scene),
                Cell::Value(r.offset, digits_for(r.offset, 1)),
                text(&r.kernel),
                known(visit, ratio),
                known(over("visit"), |x| Cell::Value(x, 2)),
                known(ray, ratio),
                known(over("ray"), |x| Cell::Value(x, 2)),
            ]
        })
    };
    let random = run.precision.iter().filter(|row| row.family == "random");
    let rows: Vec<_> = random.filter_map(row).collect();
    (!rows.is_empty()).then(|| Table {
        caption: format!(
            "Time of random lines by each kernel, on one thread: of a visit of a node where nothing stops the line, of a ray up to \
                  its nearest hit. Of refused trees, which have collapsed, only the first lines were timed.{}",
            run.disturbed(Of::Kernels)
        ),
        columns,
        keys: 3,
        rows,
    })
}
