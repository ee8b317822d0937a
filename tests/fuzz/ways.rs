//! Every way through a tree against the stack, in either precision.

use sahlab::geom::{Ray, Span};
use sahlab::kd::narrow::narrow_line;
use sahlab::kd::{Ask, Counting, Hit, NarrowTree, NoProbe, Restart, Stack, Tracing, Tree, Walk};
use sahlab::scene::Scene;

use super::watch::Ways;

/// What a ray hits, whatever it asks.
fn hits<W: Walk<Vector = glam::DVec3>>(walk: &W, scene: &Scene, ray: &Ray) -> [Option<Hit>; 3] {
    let mut stack = Stack::default();
    Ask::ALL.map(|ask| ask.trace(walk, &scene.objects, ray, &mut stack, NoProbe))
}

/// Along every way rays meet the stack's leaves and hit what it hits.
pub fn ways(tree: &Tree, scene: &Scene, rays: &[Ray]) {
    let wide = Ways::new(tree);
    let narrow = NarrowTree::however_coarse(tree).ok();
    let narrow = narrow.as_ref().map(Ways::new);
    for ray in rays {
        let expected = hits(tree, scene, ray);
        let each = [
            hits(&wide.links.walk(tree), scene, ray),
            hits(&wide.faces.walk(tree), scene, ray),
            hits(&Restart(tree), scene, ray),
        ];
        assert!(each.iter().all(|found| *found == expected), "{ray:?}");

        let limits = expected[1].map(|hit| hit.t);
        let Span { t0, t1 } = ray.span;
        wide.check_up_to::<Counting>(&ray.line, Span::FULL, &[]);
        wide.check_up_to::<Tracing>(&ray.line, ray.span, limits.as_slice());
        if let (Some(narrow), Ok(line)) = (&narrow, narrow_line(&ray.line)) {
            let [t0, t1] = [t0, t1].map(|t| t as f32);
            let limits = limits.map(|t| t as f32);
            narrow.check_up_to::<Counting>(&line, Span::FULL, &[]);
            narrow.check_up_to::<Tracing>(&line, Span { t0, t1 }, limits.as_slice());
        }
    }
}
