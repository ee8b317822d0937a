//! Rays from the objects' surfaces that stop at their nearest hit.
//!
//! Where a line crosses a surface it goes on as a ray from there: crossings are uniform on the surfaces, and the angle to
//! the normal has the cosine law. A line is cut by its X crossings into X + 1 pieces, the first of them a ray from
//! outside. All pieces together visit what the line visits, and once more, for every crossing, the leaf that it is in
//! and all nodes above. So, in the mean over lines, X W(surface) + W(outside) = W(line) + X W(leaves of crossings): of the
//! four only W(outside) is not exact. X = 2 A/SA for surfaces of area A.

use crate::kd::Tree;

use super::ways::{Inner, from_leaves};
use super::{Expected, Metric, Parts};

/// The surfaces of a node.
#[derive(Clone, Copy, Default)]
struct Surfaces {
    area: f64,
    /// Sum over the area of the work done at each point of it: its leaf, and the nodes above.
    work: Expected,
}

/// What a ray from a surface is expected to do until its nearest hit; nothing if no object has an area.
pub(super) fn expected(tree: &Tree, parts: &Parts) -> Expected {
    let leaf = |leaf, _, objects| {
        let area = parts.of(leaf).area;
        let work = Expected::leaf(objects) * area;
        Surfaces { area, work }
    };
    let inner = |_: Inner, l: Surfaces, r: Surfaces| {
        let area = l.area + r.area;
        let work = l.work + r.work + Expected::INNER * area;
        Surfaces { area, work }
    };
    let Surfaces { area, work } = from_leaves(tree, leaf, inner);
    if area == 0.0 {
        return Expected::default();
    }
    let crossings = 2.0 * area / tree.boxes[0].surface_area();
    let [line, outside] = [Metric::Area, Metric::Occlusion].map(|m| m.expected(tree, parts));
    work * (1.0 / area) + (line + outside * -1.0) * (1.0 / crossings)
}
