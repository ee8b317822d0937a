//! What a run of kind `traversal` leaves behind besides `timings.csv`.

use serde::{Deserialize, Serialize};

/// One set of rays along one way through one tree. A row of `traversal.csv`. Counts are of all rays of the set together.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TraversalRecord {
    /// Identity of the tree's cell.
    pub cell: String,
    /// Scene of the tree.
    pub scene: String,
    /// Strategy of the tree.
    pub strategy: String,
    /// Stop rule of the tree.
    pub stop: String,
    /// The set of rays: `lines` (nothing stops them, nothing is tested) or one that asks for the nearest hit.
    pub rays: String,
    /// Whether the rays are drawn at random, and not those of a picture.
    pub random: bool,
    /// `f64` or `f32`.
    pub precision: String,
    /// `stack`, `restart`, `links` or `face-trees`.
    pub way: String,
    /// Rays cast.
    pub cast: u64,
    /// Rays that meet the root's box.
    pub entered: u64,
    /// Rays that hit something; empty where nothing is tested.
    pub hits: Option<u64>,
    /// Inner nodes visited.
    pub inner_visits: u64,
    /// Leaves visited, empty ones too.
    pub leaf_visits: u64,
    /// Objects tested; empty where nothing is tested.
    pub object_tests: Option<u64>,
    /// Links followed from leaf to leaf; of `restart`: times that the ray began again at the root.
    pub links: u64,
    /// Rays whose next leaf was not certain, as planes tie: finished with a stack.
    pub fall_backs: u64,
    /// Of these, rays that meet one of the tree's `thin_leaves`.
    pub thin_fall_backs: u64,
    /// Rays whose nearest hit is not that by the stack, to the last bit; empty where nothing is tested.
    pub differing_hits: Option<u64>,
    /// Rays, but for fall-backs, whose leaves or their order are not those by the stack.
    pub differing_leaves: u64,
    /// Rays, but for fall-backs, that break an identity of the way.
    pub broken: u64,
}

/// What a tree and its links take of memory, in one precision. A row of `link-memory.csv`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinkRecord {
    /// Identity of the tree's cell.
    pub cell: String,
    /// Scene of the tree.
    pub scene: String,
    /// Strategy of the tree.
    pub strategy: String,
    /// Stop rule of the tree.
    pub stop: String,
    /// `f64` or `f32`.
    pub precision: String,
    /// Objects in the scene.
    pub objects: u64,
    /// Depth of the deepest leaf.
    pub depth: u64,
    /// Inner nodes.
    pub inner_nodes: u64,
    /// Leaves, empty ones too.
    pub leaves: u64,
    /// Leaves thinner than planes can be told apart where rays are traced: 12 ulp of the root's longest side.
    pub thin_leaves: u64,
    /// Bytes of the tree: nodes and references.
    pub tree_bytes: u64,
    /// Links straight to the leaf behind a face.
    pub links_to_leaves: u64,
    /// Links to the smallest node that covers a face behind which are several leaves.
    pub links_to_inner: u64,
    /// Faces of leaves that lie in the root's box: nothing is behind them.
    pub links_outside: u64,
    /// Bytes that links take beside the tree: leaves with their boxes, links and references.
    pub link_bytes: u64,
    /// Bytes that links through face trees take beside the tree, instead of those: leaves likewise, and the face trees.
    pub face_tree_bytes: u64,
}
