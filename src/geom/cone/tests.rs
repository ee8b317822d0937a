use super::*;
use crate::geom::{Line, Span};

fn first(cone: &Cone, o: [f64; 3], d: [f64; 3]) -> Option<f64> {
    cone.intersect(&Ray::new(Line::new(o.into(), d.into()), Span::FULL))
}

#[test]
fn a_cylinder_and_a_cone_by_hand() {
    let cylinder = Cone {
        base: DVec3::ZERO,
        base_radius: 1.0,
        apex: DVec3::new(0.0, 0.0, 4.0),
        apex_radius: 1.0,
    };
    assert_eq!(
        first(&cylinder, [-3.0, 0.0, 1.0], [1.0, 0.0, 0.0]),
        Some(2.0)
    );
    assert_eq!(first(&cylinder, [-3.0, 0.0, 5.0], [1.0, 0.0, 0.0]), None);
    // Along the axis: through the open ends.
    assert_eq!(first(&cylinder, [0.5, 0.0, -1.0], [0.0, 0.0, 1.0]), None);
    // Through the open base to the far side from within.
    assert_eq!(
        first(&cylinder, [0.0, 0.0, -1.0], [0.5, 0.0, 1.0]),
        Some(2.0)
    );
    assert_eq!(cylinder.bounds().lo, DVec3::new(-1.0, -1.0, 0.0));
    assert_eq!(cylinder.bounds().hi, DVec3::new(1.0, 1.0, 4.0));
    let cone = Cone {
        apex_radius: 0.0,
        ..cylinder
    };
    assert_eq!(first(&cone, [-3.0, 0.0, 2.0], [1.0, 0.0, 0.0]), Some(2.5));
    assert_eq!(first(&cone, [-3.0, 0.9, 2.0], [1.0, 0.0, 0.0]), None);
    let normal = cone.normal(DVec3::new(-0.5, 0.0, 2.0));
    assert!(normal.dot(DVec3::new(1.0, 0.0, 4.0)).abs() < 1e-15 && normal.x < 0.0);
}
/// Distance from the axis less the radius at a point given from the base: negative inside. And the height.
fn depth(cone: &Cone, from_base: DVec3) -> (f64, f64) {
    let axis = cone.apex - cone.base;
    let length = axis.length();
    let height = from_base.dot(axis) / length;
    let distance = from_base.cross(axis).length() / length;
    let share = height / length;
    (
        distance - cone.base_radius - share * (cone.apex_radius - cone.base_radius),
        height,
    )
}

/// What the first hit of a whole line must be.
#[derive(Debug, PartialEq)]
enum Expected {
    Miss,
    /// Before or after the point of the line that lies deepest.
    Hit {
        before: bool,
        deepest: f64,
    },
    /// Too near to a miss.
    Open,
}

/// By another way than roots: between the ends the depth is a convex function of t, so its signs at both ends and at
/// its least value decide. t counts from `near`, a point of the line given from the base; `d` has length 1.
fn expected(cone: &Cone, near: DVec3, d: DVec3, tolerance: f64) -> Expected {
    let axis = cone.apex - cone.base;
    let (height, climb) = (near.dot(axis), d.dot(axis));
    let far = 2.0 * (near.length() + axis.length() + cone.base_radius + cone.apex_radius);
    let mut ends = [-far, far];
    if climb != 0.0 {
        let cut = [-height / climb, (axis.length_squared() - height) / climb];
        ends = [
            ends[0].max(cut[0].min(cut[1])),
            ends[1].min(cut[0].max(cut[1])),
        ];
    } else if height < 0.0 || height > axis.length_squared() {
        return Expected::Miss;
    }
    if ends[0] > ends[1] {
        return Expected::Miss;
    }
    let at = |t: f64| depth(cone, near + t * d).0;
    let [mut lo, mut hi] = ends;
    for _ in 0..200 {
        let (p, q) = (lo + (hi - lo) / 3.0, hi - (hi - lo) / 3.0);
        if at(p) < at(q) { hi = q } else { lo = p }
    }
    let deepest = 0.5 * (lo + hi);
    let sign = |x: f64| {
        if x.abs() <= tolerance {
            0
        } else {
            x.signum() as i32
        }
    };
    match (sign(at(ends[0])), sign(at(deepest)), sign(at(ends[1]))) {
        (_, 1, _) | (-1, -1, -1) => Expected::Miss,
        (1, -1, _) => Expected::Hit {
            before: true,
            deepest,
        },
        (-1, -1, 1) => Expected::Hit {
            before: false,
            deepest,
        },
        _ => Expected::Open,
    }
}

/// Numbers in [0,1) without visible order.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn vector(&mut self, size: f64) -> DVec3 {
        size * (2.0 * DVec3::new(self.next(), self.next(), self.next()) - DVec3::ONE)
    }
}

/// A cone in a world of 100: from tiny to large, with and without an apex, thin, flat, along axes.
fn some_cone(numbers: &mut Numbers, i: u32) -> Cone {
    let base = numbers.vector(50.0);
    let size = [2e-3, 0.1, 20.0][(numbers.next() * 3.0) as usize];
    let mut axis = numbers.vector(size);
    if i.is_multiple_of(4) {
        let k = (i / 4 % 3) as usize;
        axis = axis[k] * DVec3::AXES[k];
    }
    let thickness = [0.01, 0.125, 2.0][(numbers.next() * 3.0) as usize] * axis.length();
    let base_radius = thickness * numbers.next();
    let apex_radius = match i % 3 {
        0 => base_radius,
        1 => 0.0,
        _ => thickness * numbers.next(),
    };
    Cone {
        base,
        base_radius,
        apex: base + axis,
        apex_radius,
    }
}

/// A line at the cone, of many kinds.
fn some_line(numbers: &mut Numbers, cone: &Cone, i: u32) -> Line {
    let axis = cone.apex - cone.base;
    let across = axis.cross(numbers.vector(1.0)).normalize();
    let height = numbers.next();
    let radius = cone.base_radius + height * (cone.apex_radius - cone.base_radius);
    let on_axis = cone.base + height * axis;
    let surface = on_axis + radius * across;
    let tangent = axis.cross(across).normalize();
    let side = axis + (cone.apex_radius - cone.base_radius) * across;
    let (point, direction) = match i % 8 {
        0 => (on_axis + numbers.vector(2.0 * radius), numbers.vector(1.0)),
        1 => (surface, numbers.vector(1e3)),
        // Grazing, a little inside or outside.
        2 => {
            let slip = [0.0, 1e-6, -1e-6][(numbers.next() * 3.0) as usize];
            (
                surface + slip * radius * across,
                tangent + numbers.next() * side / side.length(),
            )
        }
        // Along the side, and along the axis, from within or without.
        3 => (on_axis + 2.0 * numbers.next() * radius * across, side),
        4 => (on_axis + 2.0 * numbers.next() * radius * across, 3.0 * axis),
        5 => (on_axis, across),
        6 => (surface, -DVec3::AXES[(i / 8 % 3) as usize]),
        // Across an end.
        _ => (
            [cone.base, cone.apex][(i / 8 % 2) as usize],
            numbers.vector(1.0),
        ),
    };
    let away = [0.0, 1.0, 100.0, 1e5][(numbers.next() * 4.0) as usize];
    Line::new(point - away * direction.normalize(), direction)
}

#[test]
fn hits_are_on_the_surface_between_the_ends_and_the_first() {
    let mut numbers = Numbers(1);
    let (mut hits, mut misses, mut open) = (0, 0, 0);
    for i in 0..100_000 {
        let cone = some_cone(&mut numbers, i);
        let line = some_line(&mut numbers, &cone, i / 12);
        let from_base = line.origin - cone.base;
        let d = line.direction.normalize();
        let tolerance = 16.0 * f64::EPSILON * (from_base.length() + 50.0);
        let middle = 0.5 * (cone.apex - cone.base);
        let near = from_base + (middle - from_base).dot(d) * d;
        let found = cone.intersect(&Ray::new(line, Span::FULL));
        if let Some(t) = found {
            let (depth, height) = depth(&cone, from_base + t * line.direction);
            // What is solved for is a difference of squares: next to a tip its error weighs more.
            let size = cone.length() + cone.base_radius + cone.apex_radius;
            let share = height / cone.length();
            let radius = cone.base_radius + share * (cone.apex_radius - cone.base_radius);
            let here = tolerance + 4.0 * f64::EPSILON * size * size / (2.0 * radius + depth).abs();
            assert!(depth.abs() <= here, "{i}: off the surface by {depth:e}");
            assert!(
                height >= -tolerance && height <= cone.length() + tolerance,
                "{i}: {height:e}"
            );
            let b = cone.bounds();
            let outside = (b.lo - line.at(t)).max(line.at(t) - b.hi).max_element();
            assert!(outside <= here, "{i}: outside the box by {outside:e}");
        }
        match expected(&cone, near, d, tolerance) {
            Expected::Miss => {
                // Through the very end circle: a hit if its depth is right, as checked above.
                let slack = |t: f64| {
                    let height = depth(&cone, from_base + t * line.direction).1;
                    height.abs().min((height - cone.length()).abs()) <= tolerance
                };
                assert!(found.is_none_or(slack), "{i}: {found:?}");
                misses += 1;
            }
            Expected::Hit { before, deepest } => {
                let t = found.unwrap_or_else(|| panic!("{i}: missed {cone:?} {line:?}"));
                let from_near = (from_base + t * line.direction - near).dot(d);
                assert_eq!(from_near < deepest, before, "{i}: {from_near} {deepest}");
                hits += 1;
            }
            Expected::Open => open += 1,
        }
    }
    assert!(
        hits > 40_000 && misses > 15_000 && open < 25_000,
        "{hits} {misses} {open}"
    );
}

#[test]
fn the_two_ends_are_alike() {
    let mut numbers = Numbers(2);
    let mut hits = 0;
    for i in 0..20_000 {
        let cone = some_cone(&mut numbers, i);
        let turned = Cone {
            base: cone.apex,
            base_radius: cone.apex_radius,
            apex: cone.base,
            apex_radius: cone.base_radius,
        };
        let target =
            cone.base.lerp(cone.apex, numbers.next()) + numbers.vector(0.5 * cone.base_radius);
        let line = Line::new(target - 10.0 * DVec3::ONE, numbers.vector(0.1) + DVec3::ONE);
        let [one, other] = [cone, turned].map(|c| c.intersect(&Ray::new(line, Span::FULL)));
        if let (Some(one), Some(other)) = (one, other) {
            let apart = depth(&cone, line.at(one) - cone.base).0
                - depth(&cone, line.at(other) - cone.base).0;
            assert!(apart.abs() < 1e-13, "{i}: {apart:e}");
            hits += 1;
        }
        assert_eq!(one.is_some(), other.is_some(), "{i}");
    }
    assert!(hits > 2_000, "{hits}");
}

#[test]
fn both_sides_are_hit_in_order() {
    let cone = Cone {
        base: DVec3::ZERO,
        base_radius: 2.0,
        apex: DVec3::new(0.0, 0.0, 2.0),
        apex_radius: 0.0,
    };
    let line = Line::new(DVec3::new(-4.0, 0.0, 1.0), DVec3::X);
    for (from, hit) in [
        (0.0, Some(3.0)),
        (3.5, Some(5.0)),
        (5.0, Some(5.0)),
        (5.5, None),
    ] {
        assert_eq!(cone.intersect(&Ray::new(line, Span::from(from))), hit);
    }
    // In the plane of the base, through the tip, along a side, along the axis through the tip.
    assert_eq!(first(&cone, [-4.0, 0.0, 0.0], [1.0, 0.0, 0.0]), Some(2.0));
    assert_eq!(first(&cone, [-4.0, 0.0, 2.0], [1.0, 0.0, 0.0]), Some(4.0));
    assert_eq!(first(&cone, [-2.0, 0.0, 1.0], [1.0, 0.0, 1.0]), None);
    assert_eq!(first(&cone, [-1.0, 0.0, 0.0], [1.0, 0.0, 1.0]), Some(1.5));
    assert_eq!(first(&cone, [0.0, 0.0, 5.0], [0.0, 0.0, -1.0]), Some(3.0));
}

#[test]
fn is_hit_at_any_scale() {
    for scale in [1.0, 1e-80, 1e80, 1e-140, 1e139] {
        let cone = Cone {
            base: DVec3::new(0.0, 0.0, -scale),
            base_radius: scale,
            apex: DVec3::new(0.0, 0.0, scale),
            apex_radius: 0.5 * scale,
        };
        for speed in [1.0, scale] {
            let line = Line::new(DVec3::new(-3.0 * scale, 0.0, 0.0), DVec3::X * speed);
            let t = cone.intersect(&Ray::new(line, Span::FULL)).expect("a hit");
            assert!(
                (t * speed / scale / 2.25 - 1.0).abs() < 1e-14,
                "{t} at {scale}"
            );
        }
    }
}
