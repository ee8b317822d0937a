//! The traced picture of a scene, and what each of its rays cost: drawn from the scene, not from files, so that `validate plots`
//! does not draw it again.

use std::path::Path;

use anyhow::Result;
use sahlab::kd::Rules;
use sahlab::report::render::{Render, figure};
use sahlab::report::{Bitmap, RENDER, write_figure};
use sahlab::scene::{Look, Scene};
use sahlab::study::hits::cell::build_tree;
use sahlab::tracer::{PIXELS, RayKind, count, trace};

/// Pixels across and up of the quick form.
const QUICK_PIXELS: u32 = 128;

/// Trace a scene through the tree of these rules and draw the figure `render` into `plots`.
pub fn render(scene: &Scene, look: &Look, rules: &Rules, quick: bool, plots: &Path) -> Result<()> {
    let tree = build_tree(scene, rules);
    let pixels = if quick { QUICK_PIXELS } else { PIXELS };
    let traced = trace(scene, look, &tree, pixels);
    let counts = count(&traced.rays, &tree, &scene.objects);
    let cost = rules.cost;
    let costs = counts.corners.iter().map(|work| {
        let [n_k, n_b, n_t] = [work.inner, work.leaves, work.tests].map(|n| n as f64);
        cost.cost(n_k, n_b, n_t)
    });
    let rays = RayKind::ALL.map(|kind| {
        let tally = counts.of(kind);
        (kind.name(), tally.rays, tally.hits)
    });
    let render = Render {
        scene: scene.name.clone(),
        costs: costs.collect(),
        picture: Bitmap {
            width: traced.picture.width as usize,
            height: traced.picture.height as usize,
            rgb: traced.picture.rgb,
        },
        constants: [cost.c_k, cost.c_b, cost.c_t],
        rays: rays.into(),
        tree: format!("tree of strategy {}, stop {}", rules.strategy, rules.stop),
        quick,
    };
    write_figure(plots, RENDER, &figure(&render))?;
    Ok(())
}
