//! Planes that a strategy names by where they are between two positions: one median, samples between two, bins of a node.

/// Where planes are on the way from one position to another: the same in every node.
pub(super) struct Fractions {
    /// Ascending, from 0 to 1.
    at: Vec<f64>,
    /// Planes for a way of 1 and planes at its start, to guess how many lie below a position.
    density: f64,
    shift: f64,
}

impl Fractions {
    fn new(at: Vec<f64>) -> Self {
        let (density, shift) = match at[..] {
            [first, .., last] => {
                let density = (at.len() - 1) as f64 / (last - first);
                (density, 1.0 - first * density)
            }
            _ => (0.0, 0.0),
        };
        Self { at, density, shift }
    }

    /// No plane.
    pub fn none() -> Self {
        Self::new(vec![])
    }

    /// One plane, for two positions that are one.
    pub fn one() -> Self {
        Self::new(vec![0.0])
    }

    /// Both ends and `count` samples between them, equally spaced.
    pub fn samples(count: u16) -> Self {
        let steps = f64::from(count) + 1.0;
        let at = (0..=count).map(|i| f64::from(i) / steps);
        Self::new(at.chain([1.0]).collect())
    }

    /// The planes between `count` bins of equal length.
    pub fn bins(count: u16) -> Self {
        let plane = |i: u16| f64::from(i) / f64::from(count);
        Self::new((1..count).map(plane).collect())
    }

    /// Number of planes.
    pub fn len(&self) -> usize {
        self.at.len()
    }
}

/// Planes across one axis of one node.
#[derive(Clone, Copy)]
pub(super) struct Planes<'a> {
    from: f64,
    to: f64,
    fractions: &'a Fractions,
    /// Planes per length.
    density: f64,
}

impl<'a> Planes<'a> {
    pub fn new(from: f64, to: f64, fractions: &'a Fractions) -> Self {
        Self {
            from,
            to,
            fractions,
            density: fractions.density / (to - from),
        }
    }

    pub fn len(&self) -> usize {
        self.fractions.len()
    }

    /// Where plane i is. -0 is +0, as it is in events.
    #[inline]
    pub fn at(&self, i: usize) -> f64 {
        match self.fractions.at[i] {
            1.0 => self.to + 0.0,
            fraction => self.from + (self.to - self.from) * fraction + 0.0,
        }
    }

    /// All of them, ascending; some may be equal.
    pub fn iter(&self) -> impl Iterator<Item = f64> {
        (0..self.len()).map(|i| self.at(i))
    }

    /// How many planes are `below` the position x: guessed as if they were spaced equally to the last bit, and put right.
    #[inline]
    pub fn count_below(&self, x: f64, below: impl Fn(f64) -> bool) -> usize {
        let n = self.len();
        if n == 1 {
            return usize::from(below(self.at(0)));
        }
        // The cast takes what is negative or not a number to 0.
        let guess = ((x - self.from) * self.density + self.fractions.shift) as u32;
        let mut count = (guess as usize).min(n);
        while count < n && below(self.at(count)) {
            count += 1;
        }
        while count > 0 && !below(self.at(count - 1)) {
            count -= 1;
        }
        count
    }
}
