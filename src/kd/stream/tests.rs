//! Dividing lists: equal entries in the same order with all instructions. Sifting triangles: what their edges let pass.

use glam::{DVec3, Vec3};

use super::lanes::{Lane, Lanes};
use super::lists::{Cut, Lists, room};
use crate::geom::{Line, Ray, Real, Span, Triangle};

/// Numbers from a fixed sequence in [0, 1).
struct Uniforms(u64);

impl Uniforms {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn ends<V: Lane>(lists: &Lists<V>, start: usize, n: usize) -> Vec<(V::Real, V::Real, u32)> {
    (start..start + n).map(|i| lists.get(i)).collect()
}

/// Divide lists of every length up to some, with t beyond the range of numbers among them: `large` squared.
fn divides_alike<V: Lane>(large: f64, real: impl Fn(f64) -> V::Real) {
    let mut uniforms = Uniforms(1);
    let mut endless = 0;
    for n in 1..70 {
        for padding in [V::Real::ZERO, V::Real::PADDING] {
            let pairs: Vec<[V::Real; 2]> = (0..n)
                .map(|i| {
                    // Some planes tie, some overflow.
                    let origin = [0.5, uniforms.next(), large * (0.5 + uniforms.next())][i % 3];
                    let inverse = [2.0, -uniforms.next(), large][i / 3 % 3];
                    [real(origin), real(inverse)]
                })
                .collect();
            let spans: Vec<(V::Real, V::Real)> = (0..n)
                .map(|i| match i % 5 {
                    0 => (V::Real::NEG_INFINITY, V::Real::INFINITY),
                    1 => (V::Real::ZERO, V::Real::ZERO),
                    _ => {
                        let t0 = uniforms.next() - 0.5;
                        (real(t0), real(t0 + uniforms.next()))
                    }
                })
                .collect();
            let cut = Cut {
                position: real(0.5),
                padding,
                lines: &pairs,
            };
            let t = |[origin, inverse]: [V::Real; 2]| (cut.position - origin) * inverse;
            endless += pairs.iter().filter(|&&pair| !t(pair).is_finite()).count();
            let with = |lanes: Lanes| {
                let mut lists = Lists::<V>::new(lanes);
                for (line, (t0, t1)) in spans.iter().enumerate() {
                    lists.push(*t0, *t1, line as u32);
                }
                let (near, far) = lists.divide(&cut, 0, n);
                (ends(&lists, room(n), near), ends(&lists, 0, far))
            };
            let plain = with(Lanes::PORTABLE);
            assert!(n < 10 || (!plain.0.is_empty() && !plain.1.is_empty()));
            for lanes in Lanes::available() {
                assert_eq!(with(lanes), plain, "{} entries, {}", n, lanes.name());
            }
        }
    }
    assert!(endless > 100, "{endless}");
}

#[test]
fn lists_are_divided_alike_in_f64() {
    divides_alike::<DVec3>(1e200, |x| x);
}

#[test]
fn lists_are_divided_alike_in_f32() {
    divides_alike::<Vec3>(1e30, |x| x as f32);
}

/// A number no line has is not read, whatever the instructions: it is taken for the last line's, or refused.
#[test]
fn what_is_no_line_is_not_read() {
    for lanes in Lanes::available() {
        let lines = [[0.25, 1.0]; 3];
        let cut = Cut {
            position: 0.5,
            padding: 0.0,
            lines: &lines,
        };
        let divided = std::panic::catch_unwind(|| {
            let mut lists = Lists::<DVec3>::new(lanes);
            (0..5).for_each(|i| lists.push(0.0, 1.0, i << 29));
            lists.divide(&cut, 0, 5)
        });
        match divided {
            Ok(parts) => assert_eq!(parts, (5, 5), "{}", lanes.name()),
            Err(_) => assert_eq!(lanes, Lanes::PORTABLE),
        }
        let triangles = [Triangle([DVec3::X, DVec3::Y, DVec3::Z])];
        let passed = std::panic::catch_unwind(|| {
            let mut passed = 0;
            let pass = |_, _| passed += 1;
            DVec3::sieve(lanes, &[], &[7], triangles.iter().enumerate(), pass);
            passed
        });
        assert_eq!(passed.is_err(), lanes.name() == "AVX-512");
    }
}

/// Whether no two of a triangle's edge functions have different signs, as [`Triangle::intersect`] takes them.
fn edges_pass<V: Lane>(Triangle(corners): &Triangle<V>, ray: &Ray<V>) -> bool {
    let frame = &ray.frame;
    let [kx, ky, kz] = [0, 1, 2].map(|i| frame.axes[i] as usize);
    let [ox, oy, oz] = frame.origin;
    let [a, b, c] = corners.map(|corner| {
        let z = corner[kz] - oz;
        [
            corner[kx] - ox - frame.shear[0] * z,
            corner[ky] - oy - frame.shear[1] * z,
        ]
    });
    let edges = [(c, b), (a, c), (b, a)].map(|(p, q)| p[0] * q[1] - p[1] * q[0]);
    let zero = V::Real::ZERO;
    !(edges.iter().any(|&edge| edge < zero) && edges.iter().any(|&edge| edge > zero))
}

/// Where there is a sieve, it lets just what the edges do pass; else all passes. No hit is lost.
fn sifts_alike<V: Lane>(point: impl Fn([f64; 3]) -> V) {
    let mut uniforms = Uniforms(2);
    // On a coarse grid, so that edges are met.
    let mut grid = || point([0; 3].map(|_| (uniforms.next() * 7.0).floor()));
    let triangles: Vec<Triangle<V>> = (0..40)
        .map(|_| Triangle([grid(), grid(), grid()]))
        .collect();
    let mut rays = Vec::new();
    while rays.len() < 100 {
        let (origin, target) = (grid(), grid());
        if origin != target {
            rays.push(Ray::new(Line::new(origin, target - origin), Span::FULL));
        }
    }
    let (mut hits, mut held_back) = (0, 0);
    for n in 1..30 {
        let numbers: Vec<u32> = (0..n).map(|i| (i * 37 + n) % 100).collect();
        for lanes in Lanes::available() {
            let mut passed = vec![false; numbers.len() * triangles.len()];
            let at = |i: usize, place: usize| i * triangles.len() + place;
            V::sieve(
                lanes,
                &rays,
                &numbers,
                triangles.iter().enumerate(),
                |i, place| {
                    assert!(!passed[at(i, place)], "told twice");
                    passed[at(i, place)] = true;
                },
            );
            for (i, number) in numbers.iter().enumerate() {
                for (place, triangle) in triangles.iter().enumerate() {
                    let ray = &rays[*number as usize];
                    let by_edges = edges_pass(triangle, ray);
                    let sifted = lanes.name() != "AVX-512" || by_edges;
                    assert_eq!(passed[at(i, place)], sifted, "{}", lanes.name());
                    let hit = triangle.intersect(ray).is_some();
                    assert!(by_edges || !hit, "a hit is lost");
                    hits += u32::from(hit);
                    held_back += u32::from(!by_edges);
                }
            }
        }
    }
    assert!(hits > 1000 && held_back > 1000);
}

#[test]
fn triangles_sift_alike_in_f64() {
    sifts_alike::<DVec3>(DVec3::from);
}

#[test]
fn triangles_sift_alike_in_f32() {
    sifts_alike::<Vec3>(|p| DVec3::from(p).as_vec3());
}
