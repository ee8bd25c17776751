#!/usr/bin/env bash
# Makes the maps of docs/book/src/map.md anew: the five cases of table 1 of the report, and its table 6.
#
#     docs/maps.sh [THREADS]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
cargo build --release
fem=${CARGO_TARGET_DIR:-target}/release/fem
images=docs/book/src/images
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

# map PICTURE EXAMPLE OPTIONS...
map() {
    local picture=$1 example=$2
    shift 2
    "$fem" map "examples/$example/scene.toml" --out "$out/$picture" --threads "$threads" "$@"
    cp "$out/$picture/border_map.${picture##*.}" "$images/$picture"
}

threads=${1:-2}
map map-case-1.svg as4-3502-16ply-50mm
map map-case-2.png as4-3502-16ply-75mm
map map-case-3.png as4-3502-8ply-25mm
map map-case-4.png as4-3502-8ply-50mm
map map-case-5.png as4-3502-8ply-75mm
map map-table-6.png im6-934-32ply-large-mass --set impactor.mass=0.01..4 --set impactor.velocity=1..40 --tolerance 5%
