use glam::DVec2;

use super::*;
use crate::geom::{Line, Span, Triangle};

fn square() -> Vec<DVec3> {
    [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]
        .map(|[x, y]| DVec3::new(x, y, 0.5))
        .into()
}

/// The points at these angles (in steps of 1/n round) and radii.
fn round(n: u32, points: impl IntoIterator<Item = (f64, f64)>) -> Vec<DVec2> {
    let on_circle = |(step, radius): (f64, f64)| {
        let angle = TAU * step / f64::from(n);
        radius * DVec2::new(libm::cos(angle), libm::sin(angle))
    };
    points.into_iter().map(on_circle).collect()
}

/// Outlines in the plane, with half the sum of their cross products.
fn outlines() -> Vec<(&'static str, Vec<DVec2>, f64)> {
    let points = |flat: &[f64]| flat.chunks(2).map(DVec2::from_slice).collect::<Vec<_>>();
    let teeth = (0..36).flat_map(|m| {
        let g = f64::from(m);
        [
            (g - 0.19, 0.995),
            (g + 0.19, 0.995),
            (g + 0.3, 0.9),
            (g + 0.7, 0.9),
        ]
    });
    let tau: fn(f64) -> f64 = |share| libm::sin(TAU * share);
    let tooth = 0.995 * 0.995 * tau(0.38 / 36.0)
        + 2.0 * 0.995 * 0.9 * tau(0.11 / 36.0)
        + 0.81 * tau(0.4 / 36.0);
    vec![
        ("triangle", points(&[0.0, 0.0, 1.0, 0.2, 0.1, 0.9]), 0.44),
        (
            "hexagon",
            round(6, (0..6).map(|i| (f64::from(i), 1.0))),
            6.75_f64.sqrt(),
        ),
        (
            "corner within an edge",
            points(&[0.0, 0.0, 0.3, 0.3, 0.9, 0.9, 0.0, 1.0]),
            0.45,
        ),
        (
            "dart",
            points(&[-0.5, -0.5, -1.0, 1.0, -1.0, -1.0, 1.0, -1.0]),
            1.0,
        ),
        ("gear", round(36, teeth), 18.0 * tooth),
        (
            "pentagram",
            round(5, (0..5).map(|i| (f64::from(2 * i), 1.0))),
            2.5 * tau(0.4),
        ),
        (
            "bow-tie",
            points(&[0.0, 0.0, 1.0, 0.0, 0.2, 0.8, 0.8, 0.8]),
            0.5 * 0.8 * 0.4,
        ),
        // The hole is joined to the outline by an edge that is run through twice.
        (
            "frame",
            points(&[
                -1.0, -1.0, 1.0, -1.0, 1.0, 1.0, -1.0, 1.0, -1.0, -1.0, -0.5, -0.4, -0.5, 0.6, 0.5,
                0.5, 0.5, -0.5, -0.5, -0.4,
            ]),
            3.0,
        ),
        (
            "spike",
            points(&[0.0, 0.0, 2.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0]),
            1.0,
        ),
    ]
}

/// A plane that is parallel to no axis: places its points, exactly linear in x and y.
fn slanted(p: DVec2) -> DVec3 {
    DVec3::new(3.0, -1.0, 2.0)
        + p.x * DVec3::new(0.75, 0.25, -0.5)
        + p.y * DVec3::new(0.25, 0.75, 0.625)
}

/// Odd winding number of the outline round a point, by the angles under which the edges are seen.
fn winds_oddly(outline: &[DVec2], point: DVec2) -> bool {
    let n = outline.len();
    let angles = (0..n).map(|i| {
        let (a, b) = (outline[i] - point, outline[(i + 1) % n] - point);
        libm::atan2(a.perp_dot(b), a.dot(b))
    });
    let rounds = (angles.sum::<f64>() / TAU).round();
    rounds.rem_euclid(2.0) == 1.0
}

fn distance_to_outline(outline: &[DVec2], point: DVec2) -> f64 {
    let n = outline.len();
    let distances = (0..n).map(|i| {
        let (a, b) = (outline[i], outline[(i + 1) % n]);
        let along = ((point - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        point.distance(a.lerp(b, along))
    });
    distances.fold(f64::INFINITY, f64::min)
}

#[test]
fn what_is_no_polygon_is_refused() {
    let mut bent = square();
    bent[0].z = 0.6;
    let o = DVec3::ZERO;
    let (x, y) = (DVec3::X, DVec3::Y);
    let mut unknown = square();
    unknown[2].y = f64::NAN;
    let slope = DVec3::new(0.1, 0.3, 0.7);
    let cases: [(&str, Vec<DVec3>, &str); 8] = [
        ("two corners", square()[..2].to_vec(), "at least three"),
        ("bent quad", bent, "not in one plane"),
        (
            "bow-tie of two equal parts",
            vec![o, x, y, x + y],
            "no area",
        ),
        ("to and fro", vec![o, x, x + y, x], "no area"),
        ("neighbours", vec![o, x, x, y], "coincide"),
        ("last and first", vec![o, x, y, o], "coincide"),
        ("line", vec![o, slope, 3.0 * slope, 2.0 * slope], "no area"),
        ("NaN", unknown, "not finite"),
    ];
    for scale in [1.0, 1e-80, 1e80, 1e-140, 1e140] {
        for (name, corners, wanted) in &cases {
            let scaled = corners.iter().map(|&c| c * scale).collect();
            let error = Polygon::new(scaled).expect_err(name);
            assert!(error.contains(wanted), "{name} at {scale}: {error}");
        }
    }
    for huge in [f64::INFINITY, 1e200, 1e308] {
        assert!(Polygon::new(square().iter().map(|&c| c * huge).collect()).is_err());
    }
}

#[test]
fn outlines_have_their_areas_and_the_convex_are_known() {
    let stretch = slanted(DVec2::X) - slanted(DVec2::ZERO);
    let stretch = stretch
        .cross(slanted(DVec2::Y) - slanted(DVec2::ZERO))
        .length();
    for (name, outline, area) in outlines() {
        for scale in [1.0, 1e-80, 1e80, 1e-140, 1e140] {
            let corners = outline.iter().map(|&p| slanted(p) * scale).collect();
            let polygon = Polygon::new(corners).expect(name);
            let found = polygon.area() / (stretch * scale * scale);
            assert!(
                (found / area - 1.0).abs() < 1e-12,
                "{name}: {found}, not {area}"
            );
            let convex = matches!(name, "triangle" | "hexagon");
            assert_eq!(polygon.convex, convex, "{name} at {scale}");
        }
    }
    let six_digits = |mut corners: Vec<DVec3>| {
        corners[2].z += 1e-6;
        Polygon::new(corners).expect("nearly planar")
    };
    assert!(!six_digits(square()).convex);
}

/// Against winding numbers in the plane, from many sides, and by the convex test where that is taken.
#[test]
fn inside_is_where_the_winding_number_is_odd() {
    for (name, outline, _) in outlines() {
        let polygon = Polygon::new(outline.iter().copied().map(slanted).collect()).expect(name);
        let turned = Polygon {
            convex: false,
            ..polygon.clone()
        };
        let (mut inside, mut all) = (0, 0);
        for i in 0..40_000_u32 {
            // A lattice of no regular period: multiples of the golden ratio and its powers.
            let part = |alpha: f64| (f64::from(i) * alpha).fract();
            let point = DVec2::new(part(0.618_033_988_75), part(0.754_877_666_25));
            let point = 3.0 * point - 1.5 * DVec2::ONE;
            if distance_to_outline(&outline, point) < 1e-12 {
                continue;
            }
            let eye = DVec3::new(
                part(0.569_840_291),
                part(0.819_172_513),
                part(0.671_043_607),
            );
            let eye = 20.0 * (eye - 0.5 * DVec3::ONE);
            let target = slanted(point);
            let ray = Ray::new(Line::new(eye, target - eye), Span::FULL);
            let expected = winds_oddly(&outline, point);
            let t = polygon.intersect(&ray);
            assert_eq!(t.is_some(), expected, "{name} at {point}");
            assert_eq!(turned.intersect(&ray), t, "{name} at {point}");
            // Rays that all but lie in the plane lose digits of t.
            let facing = polygon
                .normal
                .normalize()
                .dot((target - eye).normalize())
                .abs();
            assert!(
                t.is_none_or(|t| (t - 1.0).abs() < 1e-14 / facing),
                "{name}: {t:?}"
            );
            inside += u32::from(expected);
            all += 1;
        }
        assert!(
            all > 39_000 && 50 * inside > all,
            "{name}: {inside} of {all}"
        );
    }
}

#[test]
fn edges_and_corners_belong_to_it() {
    for (name, outline, _) in outlines() {
        let corners: Vec<DVec3> = outline.iter().map(|p| p.extend(0.5)).collect();
        let n = corners.len();
        let polygon = Polygon::new(corners.clone()).expect(name);
        for (i, corner) in corners.iter().enumerate() {
            let down = Ray::new(Line::new(*corner + DVec3::Z, DVec3::NEG_Z), Span::FULL);
            assert_eq!(polygon.intersect(&down), Some(1.0), "{name}, corner {i}");
            let (a, b) = (*corner, corners[(i + 1) % n]);
            // Only where the middle is a point of the edge exactly.
            if a.x == b.x || a.y == b.y {
                let down = Ray::new(
                    Line::new(0.5 * (a + b) + DVec3::Z, DVec3::NEG_Z),
                    Span::FULL,
                );
                assert_eq!(polygon.intersect(&down), Some(1.0), "{name}, edge {i}");
            }
        }
    }
}

/// A dart, the triangle that fills its notch and a polygon beside it: no ray slips through the shared edges.
#[test]
fn shared_edges_do_not_leak() {
    let [a, b, c, d, e] = [
        DVec2::new(-1.0, -1.0),
        DVec2::new(1.1, -0.9),
        DVec2::new(-0.3, -0.2),
        DVec2::new(-0.9, 1.2),
        DVec2::new(1.3, 1.1),
    ];
    let polygon = |outline: &[DVec2]| {
        Polygon::new(outline.iter().copied().map(slanted).collect()).expect("a polygon")
    };
    let dart = polygon(&[a, b, c, d]);
    let notch = Triangle([b, d, c].map(slanted));
    let beside = polygon(&[b, e, DVec2::new(0.5, 0.6), d]);
    assert!(!dart.convex && !beside.convex);
    let eye = DVec3::new(0.3, 4.0, -1.0);
    for (from, to) in [(b, c), (c, d), (b, d)] {
        for step in 1..2000 {
            let target = slanted(from.lerp(to, f64::from(step) / 2000.0));
            let ray = Ray::new(Line::new(eye, target - eye), Span::from(0.0));
            let hit = dart.intersect(&ray).or(notch.intersect(&ray));
            assert!(hit.or(beside.intersect(&ray)).is_some(), "leak at {target}");
        }
    }
}

#[test]
fn is_hit_at_any_scale() {
    for scale in [1.0, 1e-80, 1e80, 1e-140, 1e140] {
        let corners = square().iter().map(|&c| c * scale).collect();
        let quad = Polygon::new(corners).expect("a square");
        let line = |x| Line::new(DVec3::new(x, 0.2, 2.0) * scale, DVec3::NEG_Z);
        let t = quad.intersect(&Ray::new(line(0.3), Span::FULL));
        let t = t.expect("a hit") / scale;
        assert!((t - 1.5).abs() < 1e-14, "{t} at {scale}");
        assert_eq!(quad.intersect(&Ray::new(line(1.3), Span::FULL)), None);
    }
}

#[test]
fn equals_its_two_triangles() {
    let quad = Polygon::new(square()).expect("a square");
    assert_eq!(quad.area(), 4.0);
    let [a, b, c, d] = <[DVec3; 4]>::try_from(square()).expect("four");
    let halves = [Triangle([a, b, c]), Triangle([a, c, d])];
    for i in -12..=12 {
        for j in -12..=12 {
            let target = DVec3::new(f64::from(i) / 10.0, f64::from(j) / 10.0, 0.5);
            let origin = DVec3::new(0.3, -0.2, 4.0);
            let ray = Ray::new(Line::new(origin, target - origin), Span::FULL);
            let by_halves = halves.iter().find_map(|h| h.intersect(&ray));
            let t = quad.intersect(&ray);
            assert_eq!(t.is_some(), by_halves.is_some(), "towards {target}");
            assert!(t.is_none_or(|t| (t - 1.0).abs() < 1e-15));
        }
    }
    let in_plane = Line::new(DVec3::new(-3.0, 0.0, 0.5), DVec3::X);
    assert_eq!(quad.intersect(&Ray::new(in_plane, Span::FULL)), None);
}
