//! What counts without events finds the planes that the sweep finds, bit for bit; so does what counts naively, and so do
//! many threads.

use glam::DVec3;

use super::*;
use crate::geom::Triangle;
use crate::kd::NodeKind;

mod naive;
mod threads;

/// Numbers that need not be random, only many and various (SplitMix64).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From -1 to 1; on a grid, whole eighths, so that bounds and planes coincide, -0 among them.
    fn coordinate(&mut self, gridded: bool) -> f64 {
        let u = (self.next() >> 11) as f64 / (1_u64 << 53) as f64;
        let x = 2.0 * u - 1.0;
        if gridded {
            libm::round(8.0 * x) / 8.0
        } else {
            x
        }
    }

    fn point(&mut self, gridded: bool) -> DVec3 {
        DVec3::from_array([0; 3].map(|_| self.coordinate(gridded)))
    }

    /// Triangles, every fourth in a plane across an axis.
    fn triangles(&mut self, n: usize, gridded: bool) -> Objects {
        let triangle = |i: usize| {
            let middle = self.point(gridded);
            let mut corners = [0; 3].map(|_| middle + 0.375 * self.point(gridded));
            if i.is_multiple_of(4) {
                corners.iter_mut().for_each(|c| c[i % 3] = middle[i % 3]);
            }
            Triangle(corners)
        };
        Objects {
            triangles: (0..n).map(triangle).collect(),
            ..Objects::default()
        }
    }
}

/// The smallest box around all.
fn world(bounds: &[Aabb]) -> Aabb {
    bounds.iter().fold(Aabb::EMPTY, |w, b| w.union(*b))
}

#[test]
fn counting_at_planes_gives_the_trees_of_the_sweep() {
    let stops = ["objects:1:16", "automatic", "cost-gain", "depth:7"];
    let samples = [1, 64, 1000].map(Strategy::SahSamples);
    let bins = [2, 8, 255].map(Strategy::SahBins);
    let numbered = samples.into_iter().chain(bins);
    let strategies: Vec<Strategy> = Strategy::ALL.into_iter().chain(numbered).collect();
    let mut inner = 0;
    for (seed, stop) in (0..).zip(stops.into_iter().cycle().take(16)) {
        let gridded = seed % 3 != 0;
        let objects = Numbers(seed).triangles(150, gridded);
        let bounds = objects.bounds();
        let world = world(&bounds);
        for &strategy in strategies.iter().filter(|s| !s.sweeps()) {
            for clipped in [false, true] {
                let rules = Rules {
                    strategy,
                    stop: stop.parse().expect("a stop rule"),
                    cost: CostModel::WALD_HAVRAN,
                    clipped,
                };
                let tree = |sweeps| {
                    let clipping = clipped.then(|| Clipping::new(&objects, &world));
                    build_over(&bounds, world, &rules, clipping, sweeps, usize::MAX)
                };
                let (counted, swept) = (tree(false), tree(true));
                // As text too, which tells -0 from +0.
                assert_eq!(counted, swept, "{strategy} {stop} {seed} {clipped}");
                assert_eq!(format!("{counted:?}"), format!("{swept:?}"));
                inner += counted.nodes.len() / 2;
            }
        }
    }
    assert!(inner > 10_000, "{inner} planes compared");
}

/// One object at the lower end of a long box, two at the upper: the plane nearest to the two is the cheapest.
#[test]
fn bins_are_equal_parts_of_the_node() {
    let cube = |x: f64| Aabb::new(DVec3::new(x, 0.0, 0.0), DVec3::new(x + 1.0, 1.0, 1.0));
    let bounds = [cube(0.0), cube(9.0), cube(9.0)];
    let world = bounds[0].union(bounds[1]);
    let plane = |count: u16| {
        let rules = Rules {
            strategy: Strategy::SahBins(count),
            stop: "objects:2:1".parse().expect("a stop rule"),
            cost: CostModel::WALD_HAVRAN,
            clipped: false,
        };
        build(&bounds, world, &rules).nodes[0].kind()
    };
    // At 16 bins 9.375 cuts the two.
    for (count, at) in [(2, 5.0), (4, 7.5), (8, 8.75), (16, 8.75)] {
        let NodeKind::Inner { axis, split, .. } = plane(count) else {
            panic!("{count} bins cut the node");
        };
        assert_eq!((axis, split), (0, at), "{count} bins");
    }
}
