//! Seconds of jobs over rounds, and the ratio of two jobs with an interval.

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

/// How many times as fast one job is as another, with its interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratio {
    /// Of the least times over all rounds.
    pub value: f64,
    /// The 2.5 % quantile of the same over every half of the rounds.
    pub low: f64,
    /// Their 97.5 % quantile.
    pub high: f64,
}

impl Ratio {
    /// Seconds of `peer` over those of `ours`; both ran in the same rounds, of which there are at least 2 and at most 16.
    ///
    /// Half of the rounds, drawn without replacement, scatter about the whole as the whole does about what many more rounds
    /// would give: eight rounds have 70 halves, and each is taken.
    pub fn new(ours: &Times, peer: &Times) -> Self {
        let rounds = ours.0.len();
        assert!(rounds == peer.0.len() && (2..=16).contains(&rounds));
        let halves = (0..1_u32 << rounds).filter(|set| set.count_ones() as usize == rounds / 2);
        let mut ratios: Vec<f64> = halves
            .map(|set| {
                let taken = |round: usize| set >> round & 1 == 1;
                peer.least_of(taken) / ours.least_of(taken)
            })
            .collect();
        ratios.sort_by(f64::total_cmp);
        let last = ratios.len() - 1;
        // Rounded outwards.
        let cut = (0.025 * last as f64) as usize;
        Self {
            value: peer.least() / ours.least(),
            low: ratios[cut],
            high: ratios[last - cut],
        }
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
    fn a_disturbed_round_widens_the_interval_but_moves_no_ratio() {
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
}
