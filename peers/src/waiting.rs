//! How much of its time this thread waited for a core: what others on the machine take away.

use std::fs;

/// Seconds that the thread has run and waited, as the kernel tells it; where it tells nothing, zeros.
#[derive(Clone, Copy)]
pub struct Waiting([f64; 2]);

impl Waiting {
    /// So far.
    pub fn now() -> Self {
        let text = fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
        let mut numbers = text.split_whitespace().map_while(|n| n.parse::<f64>().ok());
        Self([(); 2].map(|()| 1e-9 * numbers.next().unwrap_or(0.0)))
    }

    /// The share since then, of the time run and waited; 0 where nothing is known.
    pub fn share_since(self, then: Self) -> f64 {
        let [ran, waited] = [0, 1].map(|i| self.0[i] - then.0[i]);
        waited / (ran + waited).max(f64::MIN_POSITIVE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_share_is_that_of_the_time_waited() {
        let then = Waiting([1.0, 1.0]);
        assert_eq!(Waiting([4.0, 2.0]).share_since(then), 0.25);
        assert_eq!(then.share_since(then), 0.0);
    }
}
