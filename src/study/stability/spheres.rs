//! Hard cases of spheres: tangents, far origins, extreme scales, contacts.

use glam::DVec3;

use crate::geom::{Line, Object, Objects, Ray, Span, Sphere, Targets};

use super::case::{Case, Finding, Group};
use super::first_hit::{First, line, once, ray, whole};

/// A sphere of radius 5 (3, 4, 5 make exact hits) at (0, 0, `z`), all times `scale`.
fn check(z: f64, scale: f64, first: First) -> Finding {
    let sphere = Sphere {
        centre: scale * DVec3::new(0.0, 0.0, z),
        radius: scale * 5.0,
    };
    first.check(Object::Sphere(&sphere))
}

/// 2^k.
fn power(k: i32) -> f64 {
    libm::ldexp(1.0, k)
}

/// A line in z past the centre at a distance of 3, all times 2^k.
fn scaled(k: i32) -> Finding {
    let s = power(k);
    check(
        0.0,
        s,
        line([0.0, 3.0 * s, -10.0 * s], [0.0, 0.0, 1.0], Some(6.0 * s)),
    )
}

/// The cases of this group.
pub fn cases() -> Vec<Case> {
    let case = |name, stresses, check| once(Group::Spheres, name, stresses, check);
    vec![
        case("sphere-through-centre", "the shortest way through", || {
            check(
                0.0,
                1.0,
                line([0.0, 0.0, -10.0], [0.0, 0.0, 1.0], Some(5.0)),
            )
        }),
        case("sphere-tangent", "a double root", || {
            check(
                0.0,
                1.0,
                line([5.0, 0.0, -10.0], [0.0, 0.0, 1.0], Some(10.0)),
            )
        }),
        case("sphere-beyond-tangent", "one step outside", || {
            let x = 5_f64.next_up();
            check(0.0, 1.0, line([x, 0.0, -10.0], [0.0, 0.0, 1.0], None))
        }),
        case("sphere-from-inside", "the first root is behind", || {
            check(0.0, 1.0, ray([0.0, 0.0, 0.0], [0.0, 0.0, 1.0], Some(5.0)))
        }),
        case("sphere-behind", "both roots are behind", || {
            check(0.0, 1.0, ray([0.0, 3.0, 10.0], [0.0, 0.0, 1.0], None))
        }),
        case(
            "sphere-from-its-surface",
            "starts on the surface, outwards",
            || check(0.0, 1.0, ray([0.0, 0.0, 5.0], [0.0, 0.0, 1.0], Some(0.0))),
        ),
        case(
            "sphere-direction-long",
            "t counts in units of the direction",
            || {
                check(
                    0.0,
                    1.0,
                    line([0.0, 3.0, -10.0], [0.0, 0.0, 4.0], Some(1.5)),
                )
            },
        ),
        case(
            "sphere-direction-short",
            "a direction of 2^-200: its square is 2^-400",
            || {
                check(
                    0.0,
                    1.0,
                    line(
                        [0.0, 3.0, -10.0],
                        [0.0, 0.0, power(-200)],
                        Some(6.0 * power(200)),
                    ),
                )
            },
        ),
        case(
            "sphere-far-origin",
            "the origin 2^30 away: b^2 - 4ac would cancel",
            || {
                let z = -power(30);
                check(
                    0.0,
                    1.0,
                    line([0.0, 3.0, z], [0.0, 0.0, 1.0], Some(power(30) - 4.0)),
                )
            },
        ),
        case("sphere-far-away", "the sphere 2^30 away", || {
            check(
                power(30),
                1.0,
                line([3.0, 0.0, 0.0], [0.0, 0.0, 1.0], Some(power(30) - 4.0)),
            )
        }),
        case("sphere-scale-2^100", "coordinates of 10^30", || scaled(100)),
        case("sphere-scale-2^-100", "coordinates of 10^-30", || {
            scaled(-100)
        }),
        case(
            "sphere-scale-2^460",
            "squares near the largest number",
            || scaled(460),
        ),
        case(
            "sphere-scale-2^-460",
            "squares near the least normal number",
            || scaled(-460),
        ),
        case(
            "sphere-whole-numbers",
            "lines by whole numbers against the exact discriminant",
            whole_numbers,
        ),
        case(
            "spheres-contact",
            "a line through the point where two spheres touch: the same t, the first of them",
            contact,
        ),
        case(
            "spheres-concentric",
            "a hundred shells: the outermost is hit first",
            shells,
        ),
    ]
}

/// Lines through points of a small grid: the sign of r^2 d^2 - |c x d|^2 is exact in whole numbers. Tangents count apart.
fn whole_numbers() -> Finding {
    let sphere = Sphere {
        centre: DVec3::ZERO,
        radius: 5.0,
    };
    let (mut wrong, mut lines, mut tangents) = (0, 0, 0);
    for cell in 0..13_i64.pow(3) {
        let origin = [cell % 13 - 6, cell / 13 % 13 - 6, cell / 169 - 20];
        for direction in [[1, 2, 5], [0, 1, 7], [-3, 0, 4], [-1, -1, 9], [2, -3, 6]] {
            let [x, y, z] = origin;
            let [u, v, w] = direction;
            let across = [y * w - z * v, z * u - x * w, x * v - y * u];
            let square = |a: [i64; 3]| a.iter().map(|k| k * k).sum::<i64>();
            let remainder = 25 * square(direction) - square(across);
            let line = Line::new(whole(origin), whole(direction));
            let found = sphere.intersect(&Ray::new(line, Span::FULL)).is_some();
            lines += 1;
            tangents += u32::from(remainder == 0);
            wrong += u32::from(remainder != 0 && found != (remainder > 0));
        }
    }
    let told = |wrong| format!("{wrong} of {lines} lines wrong but for {tangents} tangents");
    Finding::of(told(0), told(wrong))
}

fn contact() -> Finding {
    let spheres = [-5.0, 5.0].map(|x| Sphere {
        centre: DVec3::new(x, 0.0, 0.0),
        radius: 5.0,
    });
    let objects = Objects {
        spheres: spheres.into(),
        ..Objects::default()
    };
    let ray = line([0.0, 0.0, -10.0], [0.0, 0.0, 1.0], None).as_ray();
    let found = [0, 1].map(|number| objects.intersect(number, &ray));
    Finding::of(format!("{:?}", [Some(10.0); 2]), format!("{found:?}"))
}

fn shells() -> Finding {
    let ray = line([0.0, 0.5, -200.0], [0.0, 0.0, 1.0], None).as_ray();
    let hit = |k: i32| {
        Sphere {
            centre: DVec3::ZERO,
            radius: f64::from(k),
        }
        .intersect(&ray)
    };
    let t: Vec<f64> = (1..=100).filter_map(hit).collect();
    let falling = t.windows(2).filter(|pair| pair[1] < pair[0]).count();
    Finding::of(
        "100 hits, each before the next smaller's",
        format!(
            "{} hits, {}",
            t.len(),
            if falling == 99 {
                "each before the next smaller's"
            } else {
                "not in order"
            }
        ),
    )
}
