//! Hard cases of polygons: corners and edges, reflex corners, holes, slivers, and many corners against whole numbers.

use crate::geom::{Object, Polygon};

use super::case::{Case, Finding, Group};
use super::first_hit::{First, line, once, whole};

type Corner = [i64; 2];

/// An arrowhead: its fourth corner is a reflex one.
const ARROW: [Corner; 4] = [[0, 0], [8, 0], [4, 8], [4, 2]];
/// A star of five points whose edges cross: the corners go round its middle twice, so that it is a hole.
const STAR: [Corner; 5] = [[0, 10], [6, -8], [-9, 3], [9, 3], [-6, -8]];
/// A square with corners in the middle of its edges.
const COLLINEAR: [Corner; 8] = [
    [0, 0],
    [2, 0],
    [4, 0],
    [4, 2],
    [4, 4],
    [2, 4],
    [0, 4],
    [0, 2],
];

/// Corners in the plane z = 0, scaled.
fn polygon(corners: &[Corner], scale: f64) -> Result<Polygon, &'static str> {
    let point = |&[x, y]: &Corner| scale * whole([x, y, 0]);
    Polygon::new(corners.iter().map(point).collect())
}

/// A line against the polygon.
fn check(corners: &[Corner], scale: f64, first: First) -> Finding {
    match polygon(corners, scale) {
        Ok(polygon) => first.check(Object::Polygon(&polygon)),
        Err(wrong) => Finding::failed("a polygon", wrong),
    }
}

/// Down onto a point of the plane.
fn onto(corners: &[Corner], x: f64, y: f64, hit: bool) -> Finding {
    check(
        corners,
        1.0,
        line([x, y, 3.0], [0.0, 0.0, -1.0], hit.then_some(3.0)),
    )
}

/// The cases of this group.
pub fn cases() -> Vec<Case> {
    let case = |name, stresses, check| once(Group::Polygons, name, stresses, check);
    vec![
        case("polygon-corner", "a corner belongs to it", || {
            onto(&ARROW, 8.0, 0.0, true)
        }),
        case("polygon-edge", "an edge belongs to it", || {
            onto(&ARROW, 4.0, 5.0, true)
        }),
        case("polygon-beside-an-edge", "one step outside an edge", || {
            onto(&ARROW, 4.0, -f64::from_bits(1), false)
        }),
        case(
            "polygon-reflex-corner",
            "a reflex corner belongs to it",
            || onto(&ARROW, 4.0, 2.0, true),
        ),
        case("polygon-notch", "beside a reflex corner", || {
            onto(&ARROW, 3.0, 2.0, false)
        }),
        case(
            "polygon-hole",
            "where the corners go round twice is a hole",
            || onto(&STAR, 0.0, 0.0, false),
        ),
        case(
            "polygon-point-of-star",
            "between the hole and a point of the star",
            || onto(&STAR, 0.0, 8.0, true),
        ),
        case(
            "polygon-collinear-corners",
            "a half-line through corners that do not turn",
            || onto(&COLLINEAR, 1.0, 2.0, true),
        ),
        case(
            "polygon-in-its-plane",
            "a line in the plane is no hit",
            || check(&ARROW, 1.0, line([-1.0, 1.0, 0.0], [1.0, 0.0, 0.0], None)),
        ),
        case(
            "polygon-parallel-above",
            "a line above the plane by the least number",
            || {
                check(
                    &ARROW,
                    1.0,
                    line([-1.0, 1.0, f64::from_bits(1)], [1.0, 0.0, 0.0], None),
                )
            },
        ),
        case("polygon-grazing", "a slope of 2^-20", || {
            let slope = libm::ldexp(1.0, -20);
            check(
                &ARROW,
                1.0,
                line([-4.0, 1.0, 8.0 * slope], [1.0, 0.0, -slope], Some(8.0)),
            )
        }),
        case("polygon-scale-2^100", "coordinates of 10^30", || {
            scaled(100)
        }),
        case("polygon-scale-2^-100", "coordinates of 10^-30", || {
            scaled(-100)
        }),
        case(
            "polygon-144-corners",
            "a gear on whole numbers against exact even-odd counting",
            || sweep(&gear()),
        ),
        case(
            "polygon-star-swept",
            "the star against exact even-odd counting",
            || sweep(&STAR),
        ),
        case("polygon-of-a-line", "no area: refused", || {
            refusal(
                &[[0, 0], [1, 0], [2, 0]],
                "the polygon has no area, or its parts cancel",
            )
        }),
        case(
            "polygon-figure-eight",
            "two loops that cancel: refused",
            || {
                refusal(
                    &[[0, 0], [2, 2], [2, 0], [0, 2]],
                    "the polygon has no area, or its parts cancel",
                )
            },
        ),
        case(
            "polygon-repeated-corner",
            "two successive corners coincide: refused",
            || {
                refusal(
                    &[[0, 0], [1, 0], [1, 0], [0, 1]],
                    "two successive corners of the polygon coincide",
                )
            },
        ),
    ]
}

fn scaled(k: i32) -> Finding {
    let s = libm::ldexp(1.0, k);
    check(
        &ARROW,
        s,
        line([5.0 * s, 3.0 * s, 3.0 * s], [0.0, 0.0, -1.0], Some(3.0 * s)),
    )
}

fn refusal(corners: &[Corner], message: &str) -> Finding {
    let found = polygon(corners, 1.0);
    Finding::of(message, found.err().unwrap_or("taken for a polygon"))
}

/// 36 teeth: 144 corners, 72 of them reflex, on multiples of 1/1000 of the radius.
fn gear() -> Vec<Corner> {
    let corner = |k: usize| {
        let (sine, cosine) = libm::sincos(std::f64::consts::TAU * k as f64 / 144.0);
        let radius = if k % 4 < 2 { 1000.0 } else { 800.0 };
        [radius * cosine, radius * sine].map(|x| libm::round(x) as i64)
    };
    (0..144).map(corner).collect()
}

/// Lines onto the points of a grid around the polygon, corners and edges among them: how many are judged otherwise than by whole
/// numbers.
fn sweep(corners: &[Corner]) -> Finding {
    let polygon = match polygon(corners, 1.0) {
        Ok(polygon) => polygon,
        Err(wrong) => return Finding::failed("a polygon", wrong),
    };
    let reach = corners.iter().flatten().map(|x| x.abs()).max().unwrap_or(0);
    let step = (reach / 32).max(1);
    let at = |k: i64| -reach - step + k * step;
    let grid = (0..2 * (reach / step + 2)).map(at);
    let mut points: Vec<Corner> = grid
        .clone()
        .flat_map(|x| grid.clone().map(move |y| [x, y]))
        .collect();
    points.extend(corners);
    let wrong = points.iter().filter(|&&[x, y]| {
        let down = line([x as f64, y as f64, 3.0], [0.0, 0.0, -1.0], None).as_ray();
        polygon.intersect(&down).is_some() != inside(corners, [x, y])
    });
    let told = |wrong: usize| format!("{wrong} of {} points wrong", points.len());
    Finding::of(told(0), told(wrong.count()))
}

/// Even-odd in whole numbers; the edges belong to the polygon.
fn inside(corners: &[Corner], [x, y]: Corner) -> bool {
    let mut odd = false;
    for (i, &[ax, ay]) in corners.iter().enumerate() {
        let [bx, by] = corners[(i + 1) % corners.len()];
        let cross = (bx - ax) * (y - ay) - (by - ay) * (x - ax);
        let between = |a: i64, b: i64, c: i64| a.min(b) <= c && c <= a.max(b);
        if cross == 0 && between(ax, bx, x) && between(ay, by, y) {
            return true;
        }
        if (ay > y) != (by > y) && (cross > 0) == (by > ay) {
            odd = !odd;
        }
    }
    odd
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_tell_inside_from_outside() {
        assert!(inside(&ARROW, [4, 4]) && inside(&ARROW, [4, 2]) && !inside(&ARROW, [3, 2]));
        assert!(!inside(&STAR, [0, 0]) && inside(&STAR, [0, 8]) && !inside(&STAR, [8, 8]));
        assert_eq!(gear().len(), 144);
    }

    /// Whole-number positions of a unit normal: the plane is z = 0.
    #[test]
    fn the_gear_is_one_polygon() {
        let gear = polygon(&gear(), 1.0).unwrap();
        assert!(gear.normal().cross(glam::DVec3::Z).length() == 0.0);
    }
}
