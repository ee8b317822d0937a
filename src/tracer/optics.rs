//! Mirror directions and refracted directions.

use glam::DVec3;

/// A unit direction mirrored at a surface of unit normal `normal`; a unit vector up to rounding.
pub fn reflected(direction: DVec3, normal: DVec3) -> DVec3 {
    (direction - 2.0 * direction.dot(normal) * normal).normalize()
}

/// A unit direction refracted by Snell's law, sin(out) = `ratio` sin(in), or `None` where reflection is total.
///
/// `normal` has unit length and points to the side the direction comes from; `ratio` is the index of refraction on that
/// side over the one beyond.
pub fn refracted(direction: DVec3, normal: DVec3, ratio: f64) -> Option<DVec3> {
    let cosine = -direction.dot(normal);
    let rest = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    (rest >= 0.0).then(|| (ratio * direction + (ratio * cosine - rest.sqrt()) * normal).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A direction that comes down on the plane z = 0 with this sine to the normal.
    fn down(sine: f64) -> DVec3 {
        DVec3::new(sine, 0.0, -(1.0 - sine * sine).sqrt())
    }

    #[test]
    fn mirrors_at_equal_angles() {
        let found = reflected(DVec3::new(0.6, 0.0, -0.8), DVec3::Z);
        assert!(found.distance(DVec3::new(0.6, 0.0, 0.8)) < 1e-15);
        assert_eq!(reflected(DVec3::NEG_Z, DVec3::Z), DVec3::Z);
    }

    #[test]
    fn obeys_snells_law() {
        for (sine, ratio) in [
            (0.6, 1.0 / 1.5),
            (0.6, 1.2),
            (0.0, 1.5),
            (0.99, 1.0),
            (0.3, 3.0),
        ] {
            let found = refracted(down(sine), DVec3::Z, ratio).expect("passes");
            assert!(
                found.distance(down(ratio * sine)) < 1e-15,
                "{sine} {ratio}: {found}"
            );
        }
    }

    #[test]
    fn reflects_totally_beyond_the_critical_angle() {
        let ratio = 1.5;
        for (sine, passes) in [(0.666, true), (0.667, false), (1.0, false)] {
            let found = refracted(down(sine), DVec3::Z, ratio);
            assert_eq!(found.is_some(), passes, "{sine}");
        }
    }
}
