//! Dividing lists: the same entries in the same order with all instructions, to the bit; run with debug assertions too, which
//! watch what the vector code reads.

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

/// Divide lists of every length up to some, with t beyond the range of numbers among them.
fn divides_alike<V: Lane>(real: impl Fn(f64) -> V::Real) {
    let mut uniforms = Uniforms(1);
    for n in 1..70 {
        for padding in [V::Real::ZERO, V::Real::PADDING] {
            let pairs: Vec<[V::Real; 2]> = (0..n)
                .map(|i| {
                    // Some planes tie, some overflow.
                    let origin = [0.5, uniforms.next(), 1e30 * uniforms.next()][i % 3];
                    let inverse = [2.0, -uniforms.next(), 1e30][i / 3 % 3];
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
}

#[test]
fn lists_are_divided_alike_in_f64() {
    divides_alike::<DVec3>(|x| x);
}

#[test]
fn lists_are_divided_alike_in_f32() {
    divides_alike::<Vec3>(|x| x as f32);
}

/// All that a triangle's test lets hit passes the sieve; and a sieve that is none lets nothing else pass but what the edges do.
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
    let (mut hits, mut passed_in_all) = (0, 0);
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
                    let hit = triangle.intersect(&rays[*number as usize]).is_some();
                    assert!(passed[at(i, place)] || !hit, "{} lost a hit", lanes.name());
                    hits += u32::from(hit);
                }
            }
            if lanes == Lanes::widest() {
                passed_in_all += passed.iter().filter(|&&p| p).count();
            }
        }
    }
    assert!(hits > 1000);
    // Most pairs miss: the sieve must have held most of them back, if there is one.
    let pairs = (1..30).sum::<usize>() * triangles.len();
    assert!(Lanes::widest().name() != "AVX-512" || 3 * passed_in_all < pairs);
}

#[test]
fn triangles_sift_alike_in_f64() {
    sifts_alike::<DVec3>(DVec3::from);
}

#[test]
fn triangles_sift_alike_in_f32() {
    sifts_alike::<Vec3>(|p| DVec3::from(p).as_vec3());
}
