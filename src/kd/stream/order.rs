//! The order in which lines go down together: those near each other in space and direction one after the other.
//!
//! Lists deep in a tree then hold lines whose numbers lie close together, and what is read of them lies in the cache. Only
//! speed depends on it: counts and hits are the same in any order.

use crate::geom::{Aabb, Line, Real, Span, Vector};

/// Bits of each coordinate's cell.
const BITS: u32 = 5;

/// Bits of a line's number below its place.
const NUMBER: u32 = 31;

/// Lines that are sent down together, in order.
#[derive(Default)]
pub struct Order(Vec<u64>);

impl Order {
    /// Forget all lines.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Add line `number`, which is inside `world` for this span.
    ///
    /// # Panics
    /// If the number has more than 31 bits.
    #[inline]
    pub fn add<V: Vector>(
        &mut self,
        number: usize,
        line: &Line<V>,
        world: &Aabb<V>,
        span: Span<V::Real>,
    ) {
        assert!(number < 1 << NUMBER, "at most 2^{NUMBER} lines at a time");
        // The octant, then the cells of the points where the line enters and leaves, a bit of each coordinate at a time.
        let mut place = 0;
        for k in 0..3 {
            let (lo, size) = (world.lo[k], world.hi[k] - world.lo[k]);
            for (i, t) in [span.t0, span.t1].into_iter().enumerate() {
                let share = (line.origin[k] + t * line.direction[k] - lo) / size;
                let cells = f64::from(1 << BITS);
                let cell = (share.to_f64() * cells) as u64;
                place |= spread(cell.min((1 << BITS) - 1)) << (3 * i + k);
            }
        }
        let octant = (line.octant() as u64) << (6 * BITS);
        self.0.push((octant | place) << NUMBER | number as u64);
    }

    /// Put them in order; gives the numbers of the lines of each octant, the first octant first.
    pub fn octants(&mut self) -> impl Iterator<Item = (usize, impl Iterator<Item = usize>)> {
        self.0.sort_unstable();
        let octant = |key: u64| (key >> (NUMBER + 6 * BITS)) as usize;
        let number = |key: &u64| (key & ((1 << NUMBER) - 1)) as usize;
        self.0
            .chunk_by(move |&a, &b| octant(a) == octant(b))
            .map(move |keys| (octant(keys[0]), keys.iter().map(number)))
    }
}

/// The bits of a cell, six apart.
fn spread(cell: u64) -> u64 {
    (0..BITS).fold(0, |spread, bit| spread | (cell >> bit & 1) << (6 * bit))
}
