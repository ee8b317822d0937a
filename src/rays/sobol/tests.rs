//! What makes a scrambled net: elementary intervals, digits of pairs, no bias, and the variance that theory gives.

use super::*;

fn points(replicate: u64, log2: u32) -> Vec<[f64; 4]> {
    let mut sequence = ScrambledSobol::starting_at(20_261, replicate, 0);
    (0..1 << log2).map(|_| sequence.next4()).collect()
}

/// Joe and Kuo's file starts with these points (unscrambled, in the order of the Gray code).
#[test]
fn the_sequence_is_the_published_one() {
    let mut sequence = ScrambledSobol::starting_at(0, 0, 0);
    let published = [
        [0.0, 0.0, 0.0, 0.0],
        [0.5, 0.5, 0.5, 0.5],
        [0.75, 0.25, 0.25, 0.25],
        [0.25, 0.75, 0.75, 0.75],
        [0.375, 0.375, 0.625, 0.875],
        [0.875, 0.875, 0.125, 0.375],
        [0.625, 0.125, 0.875, 0.625],
        [0.125, 0.625, 0.375, 0.125],
    ];
    for expected in published {
        let found = sequence
            .digits
            .map(|d| f64::from(d.reverse_bits()) / 2_f64.powi(32));
        assert_eq!(found, expected);
        sequence.next4();
    }
}

/// Whether every elementary interval of these digits per dimension holds the same number of points.
fn is_even(points: &[[f64; 4]], digits: [u32; 4]) -> bool {
    let mut counts = vec![0; 1 << digits.iter().sum::<u32>()];
    for u in points {
        let cell = u.iter().zip(digits).fold(0, |cell, (u, digits)| {
            let sides = 1 << digits;
            cell * sides + (u * sides as f64) as usize
        });
        counts[cell] += 1;
    }
    counts
        .iter()
        .all(|&count| count == points.len() / counts.len())
}

/// Every way to give `log2` digits in all to the first `dimensions`.
fn shares(dimensions: usize, log2: u32) -> Vec<[u32; 4]> {
    let all =
        (0..=log2).flat_map(|a| (0..=log2).flat_map(move |b| (0..=log2).map(move |c| (a, b, c))));
    let with_rest = all.filter_map(|(a, b, c)| Some([a, b, c, log2.checked_sub(a + b + c)?]));
    with_rest
        .filter(|d| d[dimensions..].iter().all(|&d| d == 0))
        .collect()
}

/// The quality parameter t of the first s Sobol' dimensions is the sum of the polynomials' degrees less one each: 0, 0, 1
/// and 3. Scrambling keeps every elementary interval's count.
#[test]
fn every_scrambled_set_is_a_net() {
    for replicate in 0..8 {
        for log2 in [0, 1, 4, 9, 12] {
            let points = points(replicate, log2);
            for (dimensions, t) in [(1, 0), (2, 0), (3, 1), (4, 3)] {
                for digits in shares(dimensions, log2.saturating_sub(t)) {
                    assert!(is_even(&points, digits), "2^{log2} points, {digits:?}");
                }
            }
        }
        // The test can fail: no four-dimensional set of 2^4 points has t = 0.
        assert!(
            shares(4, 4)
                .iter()
                .any(|&digits| !is_even(&points(replicate, 4), digits))
        );
    }
}

/// Chi-square of counts against equal ones, as a number of standard deviations.
fn unevenness(counts: &[u32]) -> f64 {
    let total: u32 = counts.iter().sum();
    let expected = f64::from(total) / counts.len() as f64;
    let chi: f64 = counts
        .iter()
        .map(|&c| (f64::from(c) - expected).powi(2) / expected)
        .sum();
    let degrees = (counts.len() - 1) as f64;
    (chi - degrees) / (2.0 * degrees).sqrt()
}

/// Of two points that share their first s digits, the next digits (which differ) and three more of either are jointly
/// uniform over scrambles: seven bits, 128 cells, 2^16 scrambles. False alarm: 6 standard deviations of a chi-square of 127
/// degrees, below 1e-6 each, for 4 x 12 pairs.
#[test]
fn the_digits_of_pairs_are_independent() {
    let pairs = [
        (0, 1),
        (0, 2),
        (1, 3),
        (2, 7),
        (5, 6),
        (9, 300),
        (0, 512),
        (77, 1101),
        (3, 65_539),
        (8, 9),
        (40, 41),
        (1000, 1001),
    ];
    let mut counts = vec![[[0_u32; 128]; 12]; 4];
    for replicate in 0..1 << 16 {
        let sequence = ScrambledSobol::starting_at(9, replicate, 0);
        for (k, counts) in counts.iter_mut().enumerate() {
            for (&(i, j), counts) in pairs.iter().zip(counts) {
                let [x, y] = [i, j].map(|i| sequence.scramblings[k].of(i));
                let shared = u64::trailing_zeros(i ^ j);
                assert_eq!((x ^ y).trailing_zeros(), shared);
                let tail = |x: u64| (x >> (shared + 1)) & 7;
                let cell = (x >> shared) & 1 | tail(x) << 1 | tail(y) << 4;
                counts[cell as usize] += 1;
            }
        }
    }
    for counts in counts.iter().flatten() {
        assert!(unevenness(counts) < 6.0, "{}", unevenness(counts));
    }
}

/// Integrands of mean 0: smooth, of one and of all dimensions, and an indicator.
const INTEGRANDS: [fn([f64; 4]) -> f64; 4] = [
    |u| u[0] - 0.5,
    |u| u[3] * u[3] - 1.0 / 3.0,
    |u| u.iter().map(|u| u - 0.5).product(),
    |u| f64::from(u8::from(u[0] + u[1] < 1.0)) - 0.5,
];

/// Mean, variance and kurtosis of the error of each integrand over replicates.
fn errors(log2: u32, replicates: u64) -> [[f64; 3]; 4] {
    let mut sums = [[0.0; 3]; 4];
    for replicate in 0..replicates {
        let mut means = [0.0; 4];
        for u in points(replicate, log2) {
            for (mean, integrand) in means.iter_mut().zip(INTEGRANDS) {
                *mean += integrand(u) / f64::from(1 << log2);
            }
        }
        for (sums, e) in sums.iter_mut().zip(means) {
            let square = e * e;
            [e, square, square * square]
                .iter()
                .zip(sums)
                .for_each(|(e, sum)| *sum += e);
        }
    }
    sums.map(|sums| {
        let [mean, square, fourth] = sums.map(|sum| sum / replicates as f64);
        [mean, square, fourth / (square * square)]
    })
}

/// Each point is uniform, so every mean is unbiased: within 5 standard errors of 0 (false alarm below 1e-5 in all).
#[test]
fn means_are_unbiased() {
    for log2 in [0, 3, 7] {
        let replicates = 1 << 13;
        for [mean, variance, _] in errors(log2, replicates) {
            let z = mean / (variance / replicates as f64).sqrt();
            assert!(z.abs() < 5.0, "2^{log2} points: {z}");
        }
    }
}

/// The mean of u over N scrambled points of one dimension is a mean over N cells with one uniform point each: its variance is
/// N^-3 / 12 exactly (Owen 1997), so that of u^2 is close to N^-3 / 9. Over 2^13 replicates the ratio to it scatters by
/// sqrt((kurtosis - 1) / 2^13) = 1.6 %; within 8 %.
#[test]
fn smooth_variances_fall_as_the_cube() {
    for log2 in [0, 3, 7, 10] {
        let cube = 8_f64.powi(log2);
        let replicates = if log2 < 10 { 1 << 13 } else { 1 << 12 };
        let [linear, square, product, _] = errors(log2 as u32, replicates);
        let ratio = 12.0 * cube * linear[1];
        assert!((ratio - 1.0).abs() < 0.08, "2^{log2} points: {ratio}");
        if log2 >= 3 {
            let ratio = 9.0 * cube * square[1];
            assert!((ratio - 1.0).abs() < 0.08, "2^{log2} points: {ratio}");
            // Errors are nearly normal: a kurtosis of 3, which affine steps alone miss by far.
            assert!((linear[2] - 3.0).abs() < 0.7, "kurtosis {}", linear[2]);
        }
        // All four dimensions together gain as well once the net is finer than t: 12^-4 / N at random.
        let random = 12_f64.powi(-4) / f64::from(1 << log2);
        let gain = random / product[1];
        assert!(
            gain > if log2 == 10 { 10.0 } else { 0.9 },
            "2^{log2} points: {gain}"
        );
    }
}
