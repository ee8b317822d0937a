//! The triangles that a kernel hits on a line, against those that the line meets.

use crate::geom::{Line, Ray, Span};
use crate::kd::{NodeKind, Planes};

use super::{Exact, Judged, Pair, Subject};

/// A triangle in a leaf.
struct Held {
    object: u32,
    leaf: Judged,
}

/// Judge once each triangle of the leaves that the kernel visits or the line meets: the kernel hits it if it stands in a leaf that is
/// visited and its test says so. `nodes` as of [`nodes`](super::nodes()).
pub fn triangles<T: Planes<Vector: Exact>>(
    subject: &Subject<'_, T>,
    line: &Line<T::Vector>,
    nodes: &[Pair],
) -> Vec<Pair> {
    let mut held = Vec::new();
    for &Pair { target, judged } in nodes {
        if let NodeKind::Leaf { first, count } = subject.tree.node(target)
            && (judged.said || judged.exact)
        {
            let objects = subject.tree.objects(first, count).iter();
            let triangles = objects.filter(|&&object| (object as usize) < subject.triangles.len());
            held.extend(triangles.map(|&object| Held {
                object,
                leaf: judged,
            }));
        }
    }
    held.sort_unstable_by_key(|held| held.object);
    let ray = Ray::new(*line, Span::FULL);
    let judge = |in_leaves: &[Held]| {
        let target = in_leaves[0].object;
        let mut judged = Judged::of_triangle(&ray, &subject.triangles[target as usize]);
        if !in_leaves.iter().any(|held| held.leaf.said) {
            // What its test would have hit was lost with its leaves; the one farthest from a tie was the surest to be met.
            if judged.said && judged.exact {
                let surest = in_leaves.iter().map(|held| held.leaf.ulps);
                judged.ulps = judged.ulps.min(surest.fold(0.0, f64::max));
            }
            judged.said = false;
        }
        Pair { target, judged }
    };
    held.chunk_by(|a, b| a.object == b.object)
        .map(judge)
        .collect()
}
