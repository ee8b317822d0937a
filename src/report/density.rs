//! How many points fall on each small square of a figure, coloured by the logarithm of the count.

use std::collections::BTreeMap;

use super::figure::Pen;
use super::palette::viridis;

/// Side of a square, in points.
const SIDE: f64 = 1.5;

/// Squares reach a little over their right and lower neighbours, so that no seam shows between them.
const OVERLAP: f64 = 0.25;

/// Counts by square.
pub struct Density(BTreeMap<(i32, i32), u64>);

impl Density {
    /// Counts points of the figure.
    pub fn new(places: impl Iterator<Item = (f64, f64)>) -> Self {
        let mut counts = BTreeMap::new();
        for (x, y) in places {
            *counts
                .entry(((x / SIDE).floor() as i32, (y / SIDE).floor() as i32))
                .or_default() += 1;
        }
        Density(counts)
    }

    /// Draws the squares that hold a point; the colours end at the count `most`.
    pub fn draw(&self, pen: &Pen, most: u64) {
        let top = (most.max(2) as f64).ln();
        // By count, so that equal colours follow each other and share a group in the SVG.
        let mut squares: Vec<_> = self
            .0
            .iter()
            .map(|(place, &count)| (count, place))
            .collect();
        squares.sort_unstable();
        for (count, &(i, j)) in squares {
            let (x, y) = (f64::from(i) * SIDE, f64::from(j) * SIDE);
            let corner = (x + SIDE + OVERLAP, y + SIDE + OVERLAP);
            pen.rectangle((x, y), corner, viridis((count as f64).ln() / top));
        }
    }
}
