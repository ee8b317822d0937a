//! How far the metric errs, node by node: one tree and one set of rays.

use std::collections::BTreeMap;

use crate::geom::Aabb;
use crate::kd::{Prediction, Tree};
use crate::stats::spearman_rho;
use crate::study::records::{GroupRecord, VisitRecord};

use super::visits::Visits;

/// A node is judged by itself where at least so many rays are predicted to hit it: the logarithm of a smaller count is far
/// from normal.
pub const LEAST_EXPECTED: f64 = 25.0;

/// Nodes kept of a tree that is drawn: so many of the largest, and at most so many of the others.
const LARGEST: usize = 500;
const OTHERS: usize = 1500;

/// Where each node is.
pub struct Places {
    /// Depth (root = 0).
    pub depth: Vec<u32>,
    /// Predicted hit probability.
    pub p: Vec<f64>,
    /// Distance of its centre from the root's over half of the root's diagonal.
    pub distance: Vec<f64>,
}

impl Places {
    /// The nodes of a tree.
    pub fn of(tree: &Tree, prediction: &Prediction) -> Self {
        let centre = tree.world.centre();
        let radius = 0.5 * tree.world.extent().length();
        let distance = |b: &Aabb| (b.centre() - centre).length() / radius;
        Self {
            depth: tree.depths(),
            p: prediction.p.clone(),
            distance: tree.boxes.iter().map(distance).collect(),
        }
    }

    /// Groups of nodes that have an area, by a property: its name, and the nodes from one bound to another.
    fn groups(&self) -> Vec<(&'static str, [f64; 2], Vec<usize>)> {
        let mut groups: BTreeMap<(usize, i64), Vec<usize>> = BTreeMap::new();
        for i in (0..self.p.len()).filter(|&i| self.p[i] > 0.0) {
            let tenth = ((10.0 * self.distance[i]) as i64).min(9);
            // Half decades, each with its upper end: the root is in the one below 1.
            let half_decade = (2.0 * libm::log10(self.p[i])).ceil() as i64;
            for (by, key) in [i64::from(self.depth[i]), half_decade, tenth]
                .into_iter()
                .enumerate()
            {
                groups.entry((by, key)).or_default().push(i);
            }
        }
        let bounds = |(by, key): (usize, i64), nodes| {
            let key = key as f64;
            match by {
                0 => ("depth", [key, key], nodes),
                1 => ("area", [(key - 1.0) / 2.0, key / 2.0], nodes),
                _ => ("distance", [key / 10.0, (key + 1.0) / 10.0], nodes),
            }
        };
        groups.into_iter().map(|(k, n)| bounds(k, n)).collect()
    }
}

/// One set of rays in the nodes of one tree.
pub struct Errors<'a> {
    /// The nodes.
    pub places: &'a Places,
    /// What the rays did.
    pub visits: &'a Visits,
    /// Whether these are all rays there are, so that there is no noise to take out.
    pub complete: bool,
}

impl Errors<'_> {
    /// The nodes below the root that are judged by themselves.
    pub fn judged(&self) -> Vec<usize> {
        (1..self.places.p.len())
            .filter(|&i| self.is_judged(i))
            .collect()
    }

    fn is_judged(&self, node: usize) -> bool {
        let expected = self.visits.entered() as f64 * self.places.p[node];
        node > 0 && expected >= LEAST_EXPECTED
    }

    /// Standard deviation of l = ln(counted / predicted) over those of these nodes that are judged, weighted by p.
    ///
    /// Counted is hits + 1/2, as hits may be 0. Of the variance sum w (l - mean)^2 with weights w that sum to 1, the noise
    /// sum w (1 - w) v is taken out: v = (1 - q)/(N q), with q = (hits + 1/2)/N, is the variance of l by the binomial law.
    /// `None` for fewer than two nodes.
    pub fn spread(&self, nodes: &[usize]) -> Option<f64> {
        let n = self.visits.entered() as f64;
        let judged: Vec<(f64, f64, f64)> = nodes
            .iter()
            .filter(|&&i| self.is_judged(i))
            .map(|&i| {
                let (p, hits) = (self.places.p[i], self.visits.hits[i] as f64 + 0.5);
                let noise = if self.complete {
                    0.0
                } else {
                    (1.0 / hits - 1.0 / n).max(0.0)
                };
                (p, libm::log(hits / (n * p)), noise)
            })
            .collect();
        if judged.len() < 2 {
            return None;
        }
        let total: f64 = judged.iter().map(|(p, ..)| p).sum();
        let mean: f64 = judged.iter().map(|(p, l, _)| p * l).sum::<f64>() / total;
        let variance: f64 = judged
            .iter()
            .map(|(p, l, noise)| {
                let w = p / total;
                w * ((l - mean) * (l - mean) - (1.0 - w) * noise)
            })
            .sum();
        Some(variance.max(0.0).sqrt())
    }

    /// Spearman's correlation of p and hits over these nodes.
    pub fn rank_correlation(&self, nodes: &[usize]) -> Option<f64> {
        let p: Vec<f64> = nodes.iter().map(|&i| self.places.p[i]).collect();
        let hits: Vec<f64> = nodes.iter().map(|&i| self.visits.hits[i] as f64).collect();
        spearman_rho(&p, &hits)
    }

    /// The rows of `nodes-by.csv`.
    pub fn groups(&self, scene: &str, strategy: &str, rays: &str) -> Vec<GroupRecord> {
        let entered = self.visits.entered();
        let row = |(by, [lo, hi], nodes): (&str, [f64; 2], Vec<usize>)| {
            let p_sum: f64 = nodes.iter().map(|&i| self.places.p[i]).sum();
            let hits = nodes.iter().map(|&i| self.visits.hits[i]).sum();
            GroupRecord {
                scene: scene.into(),
                strategy: strategy.into(),
                rays: rays.into(),
                by: by.into(),
                lo,
                hi,
                nodes: nodes.len() as u64,
                p_sum,
                hits,
                entered,
                ratio: (entered > 0).then(|| hits as f64 / (entered as f64 * p_sum)),
                spread: self.spread(&nodes),
            }
        };
        self.places.groups().into_iter().map(row).collect()
    }

    /// The rows of `visits.csv`: of the nodes that are judged, the largest, and of the others every so many, in order of size.
    pub fn visits(&self, rays: &str) -> Vec<VisitRecord> {
        let row = |i: usize| VisitRecord {
            rays: rays.into(),
            node: i as u64,
            depth: u64::from(self.places.depth[i]),
            p: self.places.p[i],
            distance: self.places.distance[i],
            hits: self.visits.hits[i],
            entered: self.visits.entered(),
        };
        let mut nodes = self.judged();
        let p = &self.places.p;
        nodes.sort_by(|&i, &j| p[j].total_cmp(&p[i]).then(i.cmp(&j)));
        let others = nodes.split_off(nodes.len().min(LARGEST));
        let step = others.len().div_ceil(OTHERS).max(1);
        nodes.extend(others.into_iter().step_by(step));
        nodes.into_iter().map(row).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::work::Counted;

    fn spread(p: &[f64], hits: &[u64], complete: bool) -> Option<f64> {
        let places = Places {
            depth: vec![0; p.len()],
            p: p.into(),
            distance: vec![0.0; p.len()],
        };
        let visits = Visits {
            counted: Counted::default(),
            hits: hits.into(),
            costs: Vec::new(),
        };
        let errors = Errors {
            places: &places,
            visits: &visits,
            complete,
        };
        errors.spread(&(0..p.len()).collect::<Vec<_>>())
    }

    #[test]
    fn the_spread_of_known_ratios() {
        // Ratios 1/2 and 2 with equal weights: ln 2 on either side of 0.
        let n = 1 << 40;
        let found = spread(&[1.0, 0.25, 0.25], &[n, n / 8, n / 2], true).expect("two nodes");
        assert!((found - 2f64.ln()).abs() < 1e-9, "{found}");
        // Weights 3 : 1 make it sqrt(3)/2 times as large.
        let found = spread(&[1.0, 0.3, 0.1], &[n, (n / 10) * 6, n / 20], true).expect("two nodes");
        assert!((found - 0.75f64.sqrt() * 2f64.ln()).abs() < 1e-9, "{found}");
        // Neither the root nor a node that 24 rays are expected to hit is judged.
        assert_eq!(spread(&[1.0, 0.5, 0.024], &[1000, 400, 10], true), None);
    }

    #[test]
    fn noise_is_taken_out() {
        // Counts one standard deviation off: the spread is nothing but noise, up to the third digit.
        let (n, p) = (1_000_000.0f64, 0.01);
        let sd = (n * p * (1.0 - p)).sqrt();
        let hits: Vec<u64> = (0..40)
            .map(|i| (n * p + if i % 2 == 0 { sd } else { -sd }) as u64)
            .collect();
        let all = |first| [vec![first], hits.clone()].concat();
        let p = [vec![1.0], vec![p; 40]].concat();
        let found = spread(&p, &all(1_000_000), true).expect("nodes");
        assert!((found - sd / 10_000.0).abs() < 1e-4, "{found}");
        let found = spread(&p, &all(1_000_000), false).expect("nodes");
        assert!(found < 0.25 * sd / 10_000.0, "{found}");
    }
}
