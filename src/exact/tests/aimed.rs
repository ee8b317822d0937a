//! Lines beside edges and corners of triangles, small and far away: the filter where it is about to give up, against the integers.

use super::*;

/// A line aimed at an edge or a corner of a triangle, up to 10^`decades` times its size away, beside it by some `epsilon` of that
/// distance; and the triangle.
pub(super) fn pair(rng: &mut ChaCha8Rng, decades: f64, epsilon: f64) -> (DVec3, DVec3, [DVec3; 3]) {
    let power = |rng: &mut ChaCha8Rng, from: f64, to: f64| libm::exp10(rng.random_range(from..to));
    let size = power(rng, -decades, 0.0);
    let centre = match rng.random_range(0..3) {
        0 => DVec3::ZERO,
        1 => vector(rng, uniform),
        // Far from the origin of coordinates too: differences of inputs are exact, and coarse.
        _ => 100.0 * vector(rng, uniform),
    };
    let mut corners = [0; 3].map(|_| centre + size * vector(rng, uniform));
    if rng.random_range(0..4) == 0 {
        // A needle.
        corners[2] = corners[0].lerp(corners[1], rng.random())
            + size * power(rng, -8.0, 0.0) * vector(rng, uniform);
    }
    let [p, q] = [corners[0], corners[1]];
    let target = match rng.random_range(0..3) {
        0 => p,
        _ => p.lerp(q, rng.random()),
    };
    let mut origin = centre + vector(rng, uniform);
    match rng.random_range(0..6) {
        // In a plane of coordinates with the target.
        0 => {
            let axis = rng.random_range(0..3);
            origin[axis] = target[axis];
        }
        // In the triangle's plane, or along its edge.
        1 => origin = target + (p - corners[2]) * (rng.random_range(-1.0..1.0) / size),
        2 => origin = target + (p - q) * (rng.random_range(-1.0..1.0) / size),
        _ => {}
    }
    let reach = (target - origin).abs().max_element();
    let aside = reach * epsilon * power(rng, -1.0, 2.0) * vector(rng, uniform);
    (origin, target + aside - origin, corners)
}

#[test]
fn the_filter_agrees_with_the_integers_where_it_gives_up() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    // Some 2^10 to 2^14 units from a tie: on both sides of where the filter is certain.
    let epsilon = libm::ldexp(1.0, -40);
    let cases = (0..50_000).map(|_| pair(&mut rng, 8.0, epsilon));
    let [_, triangles] = decided(cases);
    assert!((15_000..45_000).contains(&triangles), "{triangles}");
}
