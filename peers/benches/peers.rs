//! sahlab beside other ray tracing libraries, on one thread of one machine.
//!
//! ```sh
//! cargo bench -p peers --bench peers                       # about five minutes
//! RUSTFLAGS="-C target-cpu=native" cargo bench -p peers --bench peers --target-dir target/native
//! ```
//!
//! Prints tables and writes `data/published/peers-ratios.csv` and `data/bench/peers.md`; `validate publish bench` puts the latter into
//! `docs/results/speed.md`.
//!
//! Compared: building, nearest hits and any hits against Embree (if it is there, see `peers/src/embree/`), obvhs, parry3d,
//! bvh and kdtree-ray; counting and making lines, which no library has, against our own slower ways. Left out: what needs
//! a C++ compiler.
//!
//! Fair play:
//! - All get the same coordinates and rays in single precision, and what a library makes of them (boxes, triangles with
//!   edges, reciprocals) is in its time. Rays are asked one by one, 65,536 of the set in 16 chunks, as what one takes does not
//!   depend on how many there are; ray streams (`streams` in their name) get the million of them at once, and put them in order
//!   within their time. The least time of a pass as long as theirs drops fewer disturbances than those of short chunks, to our
//!   disadvantage. Embree, too, can take many rays at once, which is made for rays side by side; it is asked one by one.
//! - Single precision halves memory and doubles the width of vectors; where our way is one of double precision (`f64` in
//!   its name) that is to our disadvantage. Our triangle test is watertight (Woop, Benthin & Wald 2013); the tests of the
//!   others are not, and cheaper; Embree is in its default mode, not its robust one.
//! - Embree and our own kernels ask the processor for AVX2 and AVX-512 while they run. The crates are compiled for what
//!   the target has (x86-64: SSE2), as they are for a user who sets nothing. `target-cpu=native` as above
//!   may speed some of them up.
//! - `bvh` and `kdtree-ray` bring no usable triangle test; the one of Möller & Trumbore stands in.
//!
//! Jobs run in eight rounds (six for a million triangles), those of one work in random order. A rate is of the sum of the
//! least times of chunks of 4096 rays; the range of a ratio is that over all halves of the rounds (`peers/src/ratio.rs`).

use std::path::Path;

use peers::report::{csv, locked, markdown};
use peers::trial::{build_all, builds, compare, run, traces};
use peers::{Mesh, OwnWays, Waiting, camera, contestants, isotropic};
use rayon::ThreadPoolBuilder;
use sahlab::files::write_atomic;
use sahlab::scene::Scene;
use sahlab::study::machine::processor;

const ROUNDS: usize = 8;

/// Rounds of builds that take seconds.
const FEW_ROUNDS: usize = 6;

/// Rays of each set: a camera of 1024 x 1024.
const SIDE: u32 = 1024;

/// Crates, for their versions.
const CRATES: [&str; 4] = ["obvhs", "parry3d", "bvh", "kdtree-ray"];

fn main() {
    // Some peers build in rayon's pool.
    let pool = ThreadPoolBuilder::new().num_threads(1).build();
    pool.expect("a pool of one thread").install(measure);
}

fn measure() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut notes = vec![format!(
        "One thread of {}; crates: {}, compiled {} AVX2",
        processor().as_deref().unwrap_or("an unnamed processor"),
        CRATES.map(locked).join(", "),
        if cfg!(target_feature = "avx2") {
            "with"
        } else {
            "without"
        },
    )];
    let begun = Waiting::now();
    let peers = contestants(&mut notes);
    let (mut contests, mut disagreements) = (Vec::new(), Vec::new());
    let dragon = root.join("models/dragon_res3.ply");
    let dragon = dragon.to_string_lossy();
    for (name, spec) in [
        ("soup1e4", "simple:soup:10000"),
        ("soup1e5", "simple:soup:100000"),
        ("dragon48k", &dragon),
    ] {
        let scene = match Scene::load(spec) {
            Ok(scene) => scene,
            Err(error) => {
                notes.push(format!(
                    "{name} is left out ({error}): run experiments/fetch-meshes.sh"
                ));
                continue;
            }
        };
        let mesh = Mesh::new(&scene);
        let built = build_all(&peers, &mesh);
        let sets = [
            (
                name.to_owned(),
                isotropic(mesh.world, u64::from(SIDE * SIDE)),
            ),
            (format!("{name}:camera"), camera(mesh.world, SIDE)),
        ];
        let own = OwnWays::new(&scene);
        let mut plans = vec![builds(&peers, name, &mesh)];
        for (name, rays) in &sets {
            disagreements.extend(compare(&built, name, rays, &mesh));
            plans.extend(traces(&built, name, rays));
        }
        plans.extend(own.plans(name));
        contests.extend(run(plans, ROUNDS));
        eprintln!("{name} is done");
    }
    let million = Scene::load("simple:soup:1000000").expect("a procedural scene");
    let mesh = Mesh::new(&million);
    contests.extend(run(vec![builds(&peers, "soup1e6", &mesh)], FEW_ROUNDS));

    let waited = 100.0 * Waiting::now().share_since(begun);
    notes.push(format!("It waited for a core {waited:.0} % of its time, the less the better: others spoil caches too"));
    contests.sort_by_key(|contest| contest.work);
    let libraries: Vec<String> = peers.iter().map(|peer| peer.name().to_owned()).collect();
    let table = markdown(&contests, &libraries, &disagreements, &notes);
    print!("{table}");
    for (file, text) in [
        ("data/published/peers-ratios.csv", csv(&contests)),
        ("data/bench/peers.md", table),
    ] {
        write_atomic(&root.join(file), text.as_bytes()).expect("data can be written");
    }
}
