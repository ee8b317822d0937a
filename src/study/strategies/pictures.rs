//! The pictures a run keeps as data: what the rays showed, and what each pixel cost. In formats that other programs read.

use serde::{Deserialize, Serialize};

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

/// The pictures that go with a tree, each by the digest of its file.
#[derive(Clone, Serialize, Deserialize)]
pub struct Pictures {
    render_sha256: String,
    /// Only of the tree that is shown.
    costs_sha256: Option<String>,
}

impl Pictures {
    /// Write that of the scene, `pictures/SCENE.ppm` (binary portable pixmap): the scene as the rays see it.
    pub fn of_scene(store: &Store, scene: &Scene, picture: &Picture) -> Result<Self, StoreError> {
        Ok(Self {
            render_sha256: write_render(store, scene, picture)?,
            costs_sha256: None,
        })
    }

    /// Write that of a tree besides, `pictures/SCENE-STOP.pfm` (portable float map, one channel, little-endian, rows from the
    /// bottom): the cost c_K n_K + c_B n_B + c_t n_t of all rays that each pixel corner led to.
    pub fn with_costs(
        self,
        store: &Store,
        scene: &Scene,
        rules: &Rules,
        corners: &[Work],
    ) -> Result<Self, StoreError> {
        let costs_sha256 = Some(write_costs(store, scene, rules, corners)?);
        Ok(Self {
            costs_sha256,
            ..self
        })
    }

    /// Whether all that belong to this tree are there as they were written.
    pub fn are_there(
        &self,
        store: &Store,
        asked: &Strategies,
        scene: &Scene,
        rules: &Rules,
    ) -> bool {
        let costs = match &self.costs_sha256 {
            Some(sha256) => store.has(&costs(scene, rules), sha256),
            None => !is_shown(asked, rules),
        };
        costs && store.has(&render(scene), &self.render_sha256)
    }
}

fn write_render(store: &Store, scene: &Scene, picture: &Picture) -> Result<String, StoreError> {
    let mut bytes = format!("P6\n{} {}\n255\n", picture.width, picture.height).into_bytes();
    bytes.extend(&picture.rgb);
    store.write_digested(&render(scene), &bytes)
}

fn write_costs(
    store: &Store,
    scene: &Scene,
    rules: &Rules,
    corners: &[Work],
) -> Result<String, StoreError> {
    let side = corners.len().isqrt();
    let mut bytes = format!("Pf\n{side} {side}\n-1.0\n").into_bytes();
    for row in corners.chunks(side).rev() {
        for work in row {
            let [n_k, n_b, n_t] = [work.inner, work.leaves, work.tests].map(|n| n as f64);
            let c = rules.cost.cost(n_k, n_b, n_t);
            bytes.extend((c as f32).to_le_bytes());
        }
    }
    store.write_digested(&costs(scene, rules), &bytes)
}

fn render(scene: &Scene) -> String {
    format!("{PICTURES}/{}.ppm", file_stem(&scene.name))
}

fn costs(scene: &Scene, rules: &Rules) -> String {
    let [scene, stop] = [&scene.name, &rules.stop.to_string()].map(|name| file_stem(name));
    format!("{PICTURES}/{scene}-{stop}.pfm")
}
