//! Seconds of jobs over rounds, and the ratio of two jobs with its range.

/// Seconds of one job: a list of chunks for every round.
#[derive(Clone, Debug, Default)]
pub struct Times(Vec<Vec<f64>>);

impl Times {
    /// Add a round; every round has as many chunks.
    pub fn add_round(&mut self, chunks: Vec<f64>) {
        self.0.push(chunks);
    }

    /// The sum over chunks of each one's least time, over all rounds: a shared machine can only add time.
    pub fn least(&self) -> f64 {
        self.least_of(|_| true)
    }

    /// The same over the rounds that are `taken`.
    fn least_of(&self, taken: impl Fn(usize) -> bool) -> f64 {
        let rounds = self.0.iter().enumerate().filter(|(i, _)| taken(*i));
        let least = rounds.fold(Vec::new(), |least, (_, round)| {
            if least.is_empty() {
                return round.clone();
            }
            least
                .iter()
                .zip(round)
                .map(|(&a, &b)| f64::min(a, b))
                .collect()
        });
        least.iter().sum()
    }
}

/// How many times as fast one job is as another, and how far that depends on which rounds there were.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratio {
    /// Of the least times over all rounds.
    pub value: f64,
    /// The least of this and of the same over every half of the rounds.
    pub low: f64,
    /// The largest.
    pub high: f64,
}

impl Ratio {
    /// Seconds of `peer` over those of `ours`; both ran in the same rounds, of which there are at least 2 and at most 16.
    ///
    /// Its range is none of confidence: least times of fewer rounds are never smaller, so that halves may lie on one side. It tells
    /// whether the rounds agree: eight have 70 halves, and each is taken.
    pub fn new(ours: &Times, peer: &Times) -> Self {
        let rounds = ours.0.len();
        assert!(rounds == peer.0.len() && (2..=16).contains(&rounds));
        let halves = (0..1_u32 << rounds).filter(|set| set.count_ones() as usize == rounds / 2);
        let value = peer.least() / ours.least();
        let of_half = |set: u32| {
            let taken = |round: usize| set >> round & 1 == 1;
            peer.least_of(taken) / ours.least_of(taken)
        };
        let whole = Self {
            value,
            low: value,
            high: value,
        };
        halves.map(of_half).fold(whole, |range, half| Self {
            low: range.low.min(half),
            high: range.high.max(half),
            ..range
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(rounds: &[[f64; 2]]) -> Times {
        let mut times = Times::default();
        rounds.iter().for_each(|r| times.add_round(r.to_vec()));
        times
    }

    #[test]
    fn the_least_of_each_chunk_counts() {
        assert_eq!(times(&[[1.0, 5.0], [2.0, 3.0]]).least(), 4.0);
    }

    #[test]
    fn a_disturbed_round_widens_the_range_but_moves_no_ratio() {
        let ours = times(&[[1.0, 1.0]; 8]);
        let mut rounds = [[2.0, 2.0]; 8];
        let calm = Ratio::new(&ours, &times(&rounds));
        let certain = Ratio {
            value: 2.0,
            low: 2.0,
            high: 2.0,
        };
        assert_eq!(calm, certain);
        rounds[3] = [9.0, 9.0];
        assert_eq!(Ratio::new(&ours, &times(&rounds)), certain);
        // All but one round are disturbed: only the halves that have that one see it.
        let mut rounds = [[3.0, 3.0]; 8];
        rounds[0] = [2.0, 2.0];
        let wide = Ratio::new(&ours, &times(&rounds));
        assert_eq!(
            wide,
            Ratio {
                value: 2.0,
                low: 2.0,
                high: 3.0
            }
        );
    }

    #[test]
    fn the_range_holds_the_ratio() {
        // Each chunk of ours is fast in a round of its own: no half sees all of them.
        let peer = times(&[[2.0, 2.0]; 2]);
        let ours = times(&[[1.0, 2.0], [2.0, 1.0]]);
        let Ratio { value, low, high } = Ratio::new(&ours, &peer);
        assert_eq!((value, low, high), (2.0, 4.0 / 3.0, 2.0));
    }
}
