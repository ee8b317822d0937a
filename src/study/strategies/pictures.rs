//! The pictures a run keeps as data: what the rays showed, and what each pixel cost. In formats that other programs read.

use crate::kd::{Rules, Strategy, Work};
use crate::scene::Scene;
use crate::study::records::file_stem;
use crate::study::store::{PICTURES, Store, StoreError};
use crate::tracer::Picture;

use super::asked::Strategies;

/// Whether this tree's cost per pixel is kept: the reference strategy's, under the first stop rule.
pub fn is_shown(asked: &Strategies, rules: &Rules) -> bool {
    rules.strategy == Strategy::Sah && Some(&rules.stop) == asked.stops.first()
}

/// Whether the pictures that go with a tree are there, if any do: of its scene and of its cost per pixel.
pub fn are_there(store: &Store, asked: &Strategies, scene: &Scene, rules: &Rules) -> bool {
    !is_shown(asked, rules) || (store.has(&render(scene)) && store.has(&costs(scene, rules)))
}

/// `pictures/SCENE.ppm` (binary portable pixmap): the scene as the rays see it.
pub fn write_render(store: &Store, scene: &Scene, picture: &Picture) -> Result<(), StoreError> {
    let mut bytes = format!("P6\n{} {}\n255\n", picture.width, picture.height).into_bytes();
    bytes.extend(&picture.rgb);
    store.write(&render(scene), &bytes)
}

/// `pictures/SCENE-STOP.pfm` (portable float map, one channel, little-endian, rows from the bottom): the cost
/// c_K n_K + c_B n_B + c_t n_t of all rays that each pixel corner led to.
pub fn write_cost(
    store: &Store,
    scene: &Scene,
    rules: &Rules,
    corners: &[Work],
) -> Result<(), StoreError> {
    let side = corners.len().isqrt();
    let mut bytes = format!("Pf\n{side} {side}\n-1.0\n").into_bytes();
    for row in corners.chunks(side).rev() {
        for work in row {
            let [n_k, n_b, n_t] = [work.inner, work.leaves, work.tests].map(|n| n as f64);
            let c = rules.cost.cost(n_k, n_b, n_t);
            bytes.extend((c as f32).to_le_bytes());
        }
    }
    store.write(&costs(scene, rules), &bytes)
}

fn render(scene: &Scene) -> String {
    format!("{PICTURES}/{}.ppm", file_stem(&scene.name))
}

fn costs(scene: &Scene, rules: &Rules) -> String {
    let [scene, stop] = [&scene.name, &rules.stop.to_string()].map(|name| file_stem(name));
    format!("{PICTURES}/{scene}-{stop}.pfm")
}
