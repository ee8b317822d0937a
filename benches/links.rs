//! Ways through a tree on one core: a stack, restarts from the root, neighbour links and face trees; and what links take to
//! make.
//!
//! `cargo bench --bench links` takes less than a minute. `experiments/traversal.toml` asks the same of thirty scenes.

mod common;

use common::{Jobs, Table, rules};
use glam::Vec3;
use rayon::ThreadPoolBuilder;
use sahlab::geom::{Ray, Span, Targets};
use sahlab::kd::links::{FaceTrees, Links};
use sahlab::kd::narrow::{narrow_line, narrow_triangles};
use sahlab::kd::restart::Restart;
use sahlab::kd::traverse::Walk;
use sahlab::kd::{NarrowTree, Planes, Stack, Strategy, build_objects, nearest};
use sahlab::rays::SurfaceLines;
use sahlab::scene::Scene;

const ROUNDS: usize = 9;

const RAYS: u64 = 1 << 14;

fn main() {
    // The tree is built on one thread, as links are.
    let pool = ThreadPoolBuilder::new().num_threads(1).build();
    pool.expect("a pool of one thread").install(measure);
}

fn measure() {
    let mut table = Table::new(
        "links",
        &["per second", "over a stack", "bytes beside the tree"],
    );
    let scene = Scene::load("simple:soup:100000").expect("a procedural scene");
    let sampler = SurfaceLines {
        world: scene.world,
        seed: 1,
    };
    // Not clipped, as in the experiment.
    let rules = rules(Strategy::Sah, "cost-gain", false);
    let build = || build_objects(&scene.objects, &scene.bounds, scene.world, &rules);
    let tree = build();
    let (narrow, _) = NarrowTree::of(&tree).expect("a scene near the origin");
    let wide: Vec<Ray> = sampler
        .range(0..RAYS)
        .map(|line| Ray::new(line, Span::from(0.0)))
        .collect();
    let small: Vec<Ray<Vec3>> = sampler
        .range(0..RAYS)
        .map(|line| {
            Ray::new(
                narrow_line(&line).expect("a line in range"),
                Span::from(0.0),
            )
        })
        .collect();
    let triangles = narrow_triangles(&scene.objects).expect("triangles alone");

    rows("f64", &tree, &scene.objects, &wide, &mut table);
    rows("f32", &narrow, &triangles[..], &small, &mut table);

    let links = Links::of(&tree);
    let mut jobs = Jobs::default();
    jobs.add(build);
    jobs.add(|| Links::of(&tree));
    jobs.add(|| FaceTrees::of(&tree, &links));
    let seconds = jobs.least(ROUNDS, &mut table);
    table.row(&["**made, f64**", "", "", ""].map(str::to_owned));
    for (what, made) in ["the tree", "links", "face trees of links"]
        .iter()
        .zip(&seconds)
    {
        table.row(&[
            (*what).to_owned(),
            format!("{:.1} times", 1.0 / made),
            format!("{:.2} of the tree's seconds", made / seconds[0]),
            String::new(),
        ]);
    }
    table.finish();
}

/// Nearest hits by every way, in one precision.
fn rows<T: Planes>(
    numbers: &str,
    tree: &T,
    objects: &(impl Targets<Vector = T::Vector> + ?Sized),
    rays: &[Ray<T::Vector>],
    table: &mut Table,
) {
    let links = Links::of(tree);
    let faces = FaceTrees::of(tree, &links);
    let (restart, linked, through_faces) = (Restart(tree), links.walk(tree), faces.walk(tree));
    let hits = hits(tree, objects, rays);
    assert_eq!(hits, self::hits(&restart, objects, rays));
    assert_eq!(hits, self::hits(&linked, objects, rays));
    assert_eq!(hits, self::hits(&through_faces, objects, rays));
    let mut jobs = Jobs::default();
    add(&mut jobs, tree, objects, rays);
    add(&mut jobs, &restart, objects, rays);
    add(&mut jobs, &linked, objects, rays);
    add(&mut jobs, &through_faces, objects, rays);
    let seconds = jobs.least(ROUNDS, table);
    let heading = format!("**nearest hits in a soup of 100,000 triangles, {numbers}**");
    table.row(&[heading, String::new(), String::new(), String::new()]);
    let ways = [
        ("stack", 0),
        ("restart", 0),
        ("links", links.bytes()),
        ("face trees", faces.bytes()),
    ];
    for ((way, bytes), passed) in ways.into_iter().zip(&seconds) {
        table.row(&[
            way.to_owned(),
            format!("{:.3} M rays", 1e-6 * RAYS as f64 / passed),
            format!("{:.2}", seconds[0] / passed),
            bytes.to_string(),
        ]);
    }
}

/// One way.
fn add<'a, W: Walk>(
    jobs: &mut Jobs<'a>,
    walk: &'a W,
    objects: &'a (impl Targets<Vector = W::Vector> + ?Sized),
    rays: &'a [Ray<W::Vector>],
) {
    jobs.add(move || hits(walk, objects, rays));
}

/// Rays that hit something, and the sum of the objects' numbers.
fn hits<W: Walk>(
    walk: &W,
    objects: &(impl Targets<Vector = W::Vector> + ?Sized),
    rays: &[Ray<W::Vector>],
) -> (usize, u64) {
    let mut stack = Stack::default();
    let found = rays
        .iter()
        .filter_map(|ray| nearest(walk, objects, ray, &mut stack));
    found.fold((0, 0), |(n, sum), hit| (n + 1, sum + u64::from(hit.object)))
}
