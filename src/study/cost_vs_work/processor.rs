//! What a processor does with a traversal, as far as it can be counted: branches that a textbook predictor gets wrong, and
//! cache lines that are not where they were. Integers that depend on tree, rays and their order alone, not on the machine.

/// The predictor gshare (McFarling 1993): two-bit counters, found by the last outcomes and the place of the branch.
pub struct Gshare {
    /// 0 and 1 predict "not taken", 2 and 3 "taken".
    counters: Vec<u8>,
    history: u16,
    /// Branches predicted wrongly.
    pub wrong: u64,
}

/// Counters are 2^16, as many as there are histories.
const BITS: u32 = 16;

impl Gshare {
    /// Nothing learnt yet.
    pub fn new() -> Self {
        Self {
            counters: vec![1; 1 << BITS],
            history: 0,
            wrong: 0,
        }
    }

    /// A branch, named by its place in the program, is taken or not.
    #[inline]
    pub fn branch(&mut self, place: u16, taken: bool) {
        // Fibonacci hashing spreads the few places over all counters.
        let index = self.history ^ place.wrapping_mul(0x9E37);
        let counter = &mut self.counters[usize::from(index)];
        self.wrong += u64::from((*counter >= 2) != taken);
        *counter = if taken {
            (*counter + 1).min(3)
        } else {
            counter.saturating_sub(1)
        };
        self.history = self.history << 1 | u16::from(taken);
    }
}

/// Bytes of a cache line.
const LINE: u64 = 64;

/// A set-associative cache that forgets what was used least recently.
pub struct Cache {
    ways: usize,
    /// Lines of every set, the latest first.
    lines: Vec<u64>,
    /// Lines that were not there.
    pub misses: u64,
}

/// No line.
const EMPTY: u64 = u64::MAX;

impl Cache {
    /// Of so many bytes in sets of so many lines, a power of two of sets.
    pub fn new(bytes: usize, ways: usize) -> Self {
        let lines = bytes / LINE as usize;
        assert!(
            (lines / ways).is_power_of_two(),
            "{lines} lines, {ways} ways"
        );
        Self {
            ways,
            lines: vec![EMPTY; lines],
            misses: 0,
        }
    }

    /// Use a line; says whether it was there.
    #[inline]
    fn touch(&mut self, line: u64) -> bool {
        let sets = (self.lines.len() / self.ways) as u64;
        let first = (line % sets) as usize * self.ways;
        let set = &mut self.lines[first..first + self.ways];
        let place = set.iter().position(|&own| own == line);
        set[..=place.unwrap_or(self.ways - 1)].rotate_right(1);
        set[0] = line;
        self.misses += u64::from(place.is_none());
        place.is_some()
    }
}

/// A small cache before a larger one, of the sizes that cores of 2024 have.
pub struct Caches {
    /// 32 KiB, 8 ways.
    pub first: Cache,
    /// 1 MiB, 16 ways.
    pub second: Cache,
}

impl Caches {
    /// Empty.
    pub fn new() -> Self {
        Self {
            first: Cache::new(32 << 10, 8),
            second: Cache::new(1 << 20, 16),
        }
    }

    /// Read bytes at an address.
    #[inline]
    pub fn read(&mut self, address: u64, bytes: u64) {
        for line in address / LINE..(address + bytes).div_ceil(LINE) {
            if !self.first.touch(line) {
                self.second.touch(line);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_repeats_is_learnt_and_what_does_not_is_not() {
        let mut regular = Gshare::new();
        for i in 0..30_000 {
            regular.branch(3, i % 5 < 2);
        }
        assert!(regular.wrong < 100, "{}", regular.wrong);
        // Bits of a linear congruential generator: half of them are guessed wrongly.
        let mut random = Gshare::new();
        let mut state = 1_u64;
        for _ in 0..30_000 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            random.branch(3, state >> 63 == 1);
        }
        assert!((13_000..17_000).contains(&random.wrong), "{}", random.wrong);
    }

    #[test]
    fn the_least_recent_line_is_forgotten() {
        // Two sets of two ways.
        let mut cache = Cache::new(256, 2);
        for (line, there) in [
            (0, false),
            (2, false),
            (0, true),
            (4, false), // takes the place of 2
            (0, true),
            (2, false),
            (1, false), // the other set
            (4, false),
        ] {
            assert_eq!(cache.touch(line), there, "line {line}");
        }
        assert_eq!(cache.misses, 6);
    }

    #[test]
    fn reads_touch_every_line_once() {
        let mut caches = Caches::new();
        caches.read(60, 8);
        caches.read(64, 64);
        assert_eq!((caches.first.misses, caches.second.misses), (2, 2));
        // A megabyte does not fit into the first, nearly into the second.
        for _ in 0..2 {
            for line in 0..8192 {
                caches.read((1 << 30) | (line * 64), 4);
            }
        }
        assert_eq!(caches.first.misses, 2 + 2 * 8192);
        assert_eq!(caches.second.misses, 2 + 8192);
    }
}
