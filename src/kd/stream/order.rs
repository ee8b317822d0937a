//! The order in which lines go down together: those near each other in space and direction one after the other.
//!
//! Lists deep in a tree then hold lines whose numbers lie close together, and what is read of them lies in the cache. Only
//! speed depends on it: counts and hits are the same in any order.

use crate::geom::{Aabb, Line, Real, Span, Vector};

/// Bits of each coordinate's cell.
const BITS: u32 = 5;

/// Bits of a line's number below its place: what 64 leave.
const NUMBER: u32 = 31;

/// Cells as places: their bits, six apart.
const SPREAD: [u32; 1 << BITS] = {
    let mut spread = [0; 1 << BITS];
    let mut i = 0;
    while i < BITS << BITS {
        let (cell, bit) = (i / BITS, i % BITS);
        spread[cell as usize] |= (cell >> bit & 1) << (6 * bit);
        i += 1;
    }
    spread
};

/// Lines that are sent down together, in order.
pub struct Order<V: Vector> {
    /// The octant, the place and the number of each line, in one number to be sorted by.
    keys: Vec<u64>,
    /// The lower corner of the world, and cells per length.
    lo: [V::Real; 3],
    scale: [f64; 3],
}

impl<V: Vector> Order<V> {
    /// Of lines through a world, none yet.
    pub fn new(world: &Aabb<V>) -> Self {
        let cells = |k| {
            let size = world.hi[k].to_f64() - world.lo[k].to_f64();
            f64::from(1 << BITS) / size
        };
        Self {
            keys: Vec::new(),
            lo: [0, 1, 2].map(|k| world.lo[k]),
            scale: [0, 1, 2].map(cells),
        }
    }

    /// Add line `number`, which is inside the world for this span.
    ///
    /// # Panics
    /// If the number has more than 31 bits.
    #[inline]
    pub fn add(&mut self, number: usize, line: &Line<V>, span: Span<V::Real>) {
        assert!(number < 1 << NUMBER, "at most 2^{NUMBER} lines at a time");
        // The cells of the points where the line enters and leaves, a bit of each coordinate at a time.
        let mut place = 0;
        for k in 0..3 {
            for (i, t) in [span.t0, span.t1].into_iter().enumerate() {
                let beyond = line.origin[k] + t * line.direction[k] - self.lo[k];
                let cell = (beyond.to_f64() * self.scale[k]) as u32;
                place |= SPREAD[cell.min((1 << BITS) - 1) as usize] << (3 * i + k);
            }
        }
        let octant = (line.octant() as u64) << (6 * BITS);
        self.keys
            .push((octant | u64::from(place)) << NUMBER | number as u64);
    }

    /// Put them in order; gives the numbers of the lines of each octant, the first octant first.
    pub fn octants(
        &mut self,
    ) -> impl Iterator<Item = (usize, impl Iterator<Item = usize> + Clone)> {
        self.keys.sort_unstable();
        let octant = |key: u64| (key >> (NUMBER + 6 * BITS)) as usize;
        let number = |key: &u64| (key & ((1 << NUMBER) - 1)) as usize;
        self.keys
            .chunk_by(move |&a, &b| octant(a) == octant(b))
            .map(move |keys| (octant(keys[0]), keys.iter().map(number)))
    }
}
