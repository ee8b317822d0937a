//! One strategy against another over many scenes, as one number: several ways to average, for they disagree.

use std::collections::BTreeMap;

use statrs::distribution::{ContinuousCDF, StudentsT};

/// Level of the interval of a geometric mean.
const LEVEL: f64 = 0.99;

/// Kinds of scenes below which it would be so wide that it tells nothing.
const FEWEST: f64 = 3.0;

/// Averages of ratios over scenes.
#[derive(Clone, Debug, PartialEq)]
pub struct Averages<'r> {
    /// How many scenes.
    pub scenes: usize,
    /// Arithmetic mean, which Havran gives: a single scene may rule it.
    pub mean: f64,
    /// Geometric mean: twice as slow on one scene and twice as fast on another make 1.
    pub geometric: f64,
    /// Its 99 % interval: Student's t of the mean logarithm. The sizes of one scene are like each other, so together they are
    /// one observation. None for less than three of these.
    pub interval: Option<[f64; 2]>,
    /// Median.
    pub median: f64,
    /// The least, and its scene.
    pub best: (&'r str, f64),
    /// The largest, and its scene.
    pub worst: (&'r str, f64),
}

impl<'r> Averages<'r> {
    /// The averages of positive ratios; None if there are none.
    pub fn of(ratios: &[(&'r str, f64)]) -> Option<Self> {
        let mut sorted = ratios.to_vec();
        sorted.sort_by(|a, b| a.1.total_cmp(&b.1));
        let (&best, &worst) = sorted.first().zip(sorted.last())?;
        let scenes = sorted.len();
        let n = scenes as f64;
        let middle = |i: usize| sorted[i].1;
        let logs: Vec<f64> = sorted.iter().map(|&(_, ratio)| libm::log(ratio)).collect();
        let mean_log = logs.iter().sum::<f64>() / n;
        Some(Averages {
            scenes,
            mean: sorted.iter().map(|&(_, ratio)| ratio).sum::<f64>() / n,
            geometric: libm::exp(mean_log),
            interval: half_width(&sorted, &logs, mean_log)
                .map(|half| [mean_log - half, mean_log + half].map(libm::exp)),
            median: 0.5 * (middle((scenes - 1) / 2) + middle(scenes / 2)),
            best,
            worst,
        })
    }
}

/// What all sizes of a scene have in common: `spd:balls` of `spd:balls:4`.
pub fn family(scene: &str) -> &str {
    match scene.rsplit_once(':') {
        Some((family, _)) if family.contains(':') => family,
        _ => scene,
    }
}

/// Half of Student's interval of the mean of the logarithms, whose deviations within a family add up (the sandwich
/// estimator of clustered observations).
fn half_width(ratios: &[(&str, f64)], logs: &[f64], mean: f64) -> Option<f64> {
    let mut families: BTreeMap<&str, f64> = BTreeMap::new();
    for ((scene, _), log) in ratios.iter().zip(logs) {
        *families.entry(family(scene)).or_default() += log - mean;
    }
    let (n, c) = (logs.len() as f64, families.len() as f64);
    if c < FEWEST {
        return None;
    }
    let law = StudentsT::new(0.0, 1.0, c - 1.0).ok()?;
    let squares: f64 = families.values().map(|sum| sum * sum).sum();
    let se = (c / (c - 1.0) * squares).sqrt() / n;
    Some(law.inverse_cdf(0.5 + 0.5 * LEVEL) * se)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn averages_by_hand() {
        let averages = Averages::of(&[("a", 4.0), ("b", 1.0), ("c", 0.25), ("d", 8.0)]).unwrap();
        assert_eq!((averages.scenes, averages.mean), (4, 3.3125));
        assert!((averages.geometric - 8f64.powf(0.25)).abs() < 1e-12);
        assert_eq!(averages.median, 2.5);
        assert_eq!(averages.best, ("c", 0.25));
        assert_eq!(averages.worst, ("d", 8.0));
        // Logarithms to base 2: 2, 0, -2, 3; mean 3/4, variance 59/12, t of 3 degrees at 99 % 5.8409.
        let half = 5.840_909 * (59.0 / 48.0_f64).sqrt();
        let [lo, hi] = averages.interval.unwrap().map(f64::log2);
        assert!((lo - (0.75 - half)).abs() < 1e-5, "{lo}");
        assert!((hi - (0.75 + half)).abs() < 1e-5, "{hi}");
    }

    #[test]
    fn sizes_of_a_scene_are_one_observation() {
        let ratios = [
            ("spd:a:1", 2.0),
            ("spd:a:2", 2.0),
            ("spd:b:1", 8.0),
            ("spd:b:2", 8.0),
            ("spd:c:1", 4.0),
            ("spd:c:2", 4.0),
        ];
        let [lo, hi] = Averages::of(&ratios).unwrap().interval.unwrap();
        // As three observations, 1, 3 and 2 to base 2: mean 2, standard error the root of 1/3, t of two degrees at 99 % 9.9248.
        let half = 9.924_843 * (1.0_f64 / 3.0).sqrt();
        assert!((lo.log2() - (2.0 - half)).abs() < 1e-5, "{lo}");
        assert!((hi.log2() - (2.0 + half)).abs() < 1e-5, "{hi}");
        assert_eq!(Averages::of(&ratios[..4]).unwrap().interval, None);
        let one = [("spd:a:1", 2.0), ("spd:a:2", 4.0)];
        assert_eq!(Averages::of(&one).unwrap().interval, None);
        assert_eq!(family("models/a.obj"), "models/a.obj");
        assert_eq!(family("spd:a:1"), "spd:a");
    }

    #[test]
    fn few_scenes_have_no_interval() {
        assert_eq!(Averages::of(&[]), None);
        let one = Averages::of(&[("a", 2.0)]).unwrap();
        assert_eq!((one.median, one.interval), (2.0, None));
        let equal = Averages::of(&[("a", 1.0), ("b", 1.0), ("c", 1.0)]).unwrap();
        assert_eq!(equal.interval, Some([1.0, 1.0]));
    }
}
