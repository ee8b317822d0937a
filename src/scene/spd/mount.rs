//! `mount`: a fractal mountain by midpoint displacement (Fournier, Fussell & Carpenter 1982), and four touching glass
//! spheres beside its top. Its random numbers are a function of the grid point, from integers: the same everywhere.

use glam::DVec3;

use super::stage::{opaque, shine, stage};
use super::turn::turn;
use crate::scene::draft::Draft;
use crate::scene::look::Material;

/// Spheres, then triangles quarter by quarter: lower left, lower right, upper right, upper left.
pub(super) fn draft(size: usize) -> Draft {
    let view = [[-1.6, 1.6, 1.7], [0.0; 3], [0.0, 0.0, 1.0]];
    let mut draft = Draft::new(stage(view, 45.0, 0.01, &[[-100.0, -100.0, 100.0]]));
    draft.material(Material {
        colour: DVec3::ONE,
        diffuse: 0.1,
        specular: 0.1,
        shine: shine(6.7),
        transmittance: 0.9,
        index: 1.5,
    });
    spheres(&mut draft);
    draft.material(opaque([0.5, 0.45, 0.35], [1.0, 0.0], 0.0, 0.0));
    let mountain = Mountain::new(size as u32);
    mountain.square(mountain.cells, [0, 0], [0.0; 4], &mut draft);
    draft
}

/// Four spheres that touch each other, at the corners of a tetrahedron with one above.
fn spheres(draft: &mut Draft) {
    let radius = 0.17;
    let middle = DVec3::new(-0.8, 0.8, 1.0);
    let up = radius * 1.5_f64.sqrt() * DVec3::Z;
    let tilt = turn(
        DVec3::new(0.5_f64.sqrt(), 0.5_f64.sqrt(), 0.0),
        8_f64.sqrt() / 3.0,
        -1.0 / 3.0,
    );
    let third = turn(DVec3::Z, 0.75_f64.sqrt(), -0.5);
    draft.sphere(middle + up, radius);
    let mut down = tilt * up;
    for _ in 0..3 {
        draft.sphere(middle + down, radius);
        down = third * down;
    }
}

/// A height field on a grid of 2^size x 2^size cells over the square [-1,1]^2.
struct Mountain {
    size: u32,
    cells: u32,
    /// Height of a displacement by one standard deviation, over half the side of the square that is divided.
    roughness: f64,
}

impl Mountain {
    fn new(size: u32) -> Self {
        let dimension = 2.2;
        let ratio = 2.0 / libm::pow(2.0, 1.0 / (dimension - 1.0));
        Self {
            size,
            cells: 1 << size,
            roughness: (ratio * ratio - 1.0).sqrt(),
        }
    }

    /// Emits the square from (x, y) to (x + w, y + w) with these heights at its corners, counter-clockwise.
    fn square(&self, w: u32, [x, y]: [u32; 2], [a, b, c, d]: [f64; 4], draft: &mut Draft) {
        if w == 1 {
            let corners = [
                self.point(x, y, a),
                self.point(x + 1, y, b),
                self.point(x + 1, y + 1, c),
                self.point(x, y + 1, d),
            ];
            for triangle in [[0, 1, 2], [2, 3, 0]] {
                draft.triangle(triangle.map(|i| corners[i]));
            }
            return;
        }
        let h = w / 2;
        let amount = f64::from(w) / f64::from(self.cells) * self.roughness;
        let middle_of = |a: f64, b: f64, x, y| (a + b) / 2.0 + amount * self.displacement(x, y);
        let lower = middle_of(a, b, x + h, y);
        let right = middle_of(b, c, x + w, y + h);
        let upper = middle_of(c, d, x + h, y + w);
        let left = middle_of(d, a, x, y + h);
        let middle = (a + b + c + d) / 4.0 + DIAGONAL * amount * self.displacement(x + h, y + h);
        self.square(h, [x, y], [a, lower, middle, left], draft);
        self.square(h, [x + h, y], [lower, b, right, middle], draft);
        self.square(h, [x + h, y + h], [middle, right, c, upper], draft);
        self.square(h, [x, y + h], [left, middle, upper, d], draft);
    }

    fn point(&self, x: u32, y: u32, z: f64) -> DVec3 {
        let place = |k: u32| -1.0 + f64::from(2 * k) / f64::from(self.cells);
        DVec3::new(place(x), place(y), z)
    }

    fn displacement(&self, x: u32, y: u32) -> f64 {
        gaussian(21 + self.hash(x, y))
    }

    /// 16 bits from a grid point: the package's old hash, which it keeps because results with it are published. The last
    /// shift is negative for sizes over 7; the bits kept are then zero on the machines of the time. So only the parity of
    /// x counts at size 8, and larger mountains are streaky.
    fn hash(&self, x: u32, y: u32) -> u32 {
        let (x, y) = (u64::from(x), u64::from(y));
        let fine = 7_u32.checked_sub(self.size).map_or(0, |shift| x << shift);
        let sum = (x << (23 - self.size)) + (y << (15 - self.size)) + fine;
        (sum % 65536) as u32
    }
}

/// Square root of 2 as the package writes it.
#[expect(
    clippy::approx_constant,
    reason = "the package's heights are made with this value"
)]
const DIAGONAL: f64 = 1.4142136;

/// A normally distributed number from a seed below 2^17 (Marsaglia's polar method on a linear congruence). It starts
/// anew at each call and throws the second number away.
fn gaussian(seed: u32) -> f64 {
    const MODULUS: u32 = 134_456;
    let next = |u: u32| (28_411 + 8_121 * u) % MODULUS;
    let signed = |u: u32| 2.0 * f64::from(u) / f64::from(MODULUS) - 1.0;
    let mut state = seed;
    loop {
        let first = next(state);
        state = next(first);
        let (v, w) = (signed(first), signed(state));
        let r = v * v + w * w;
        if r < 1.0 {
            return v * (-2.0 * libm::log(r) / r).sqrt();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_numbers_of_the_package() {
        for (seed, value) in [
            (21, -0.19090945614389554),
            (22, 0.1891181861351264),
            (100, -0.5829447665407372),
            (1000, 0.0784798188461828),
            (33000, -1.8670009262856753),
            (65556, 0.530489756883522),
        ] {
            assert!((gaussian(seed) - value).abs() < 1e-15, "{seed}");
        }
    }

    #[test]
    fn hashes_of_the_package() {
        for (size, [x, y], hash) in [
            (6, [32, 0], 64),
            (6, [64, 32], 16512),
            (6, [32, 32], 16448),
            (6, [1, 0], 2),
            (6, [0, 1], 512),
            (6, [63, 64], 32894),
            (4, [8, 0], 64),
            (8, [128, 0], 0),
            (8, [128, 128], 16384),
            (8, [1, 0], 32768),
            (8, [3, 5], 33408),
        ] {
            assert_eq!(Mountain::new(size).hash(x, y), hash, "{size} {x} {y}");
        }
    }
}
