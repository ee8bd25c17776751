#!/usr/bin/env bash
# Fuzzes one reader: fuzz/run.sh TARGET [EXECUTIONS]. Needs no more than the stable compiler.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
target=$1
runs=${2:-10000000}
case $target in
mesh | lines) length=4096 ;;
scene) length=2048 ;;
deck) length=4096 ;;
layup) length=256 ;;
expression) length=512 ;;
units) length=64 ;;
*) echo "targets: mesh lines scene deck layup expression units" >&2 && exit 2 ;;
esac

# What cargo-fuzz sets where it has no sanitizer. With --target, build scripts go without.
sancov=(-sanitizer-coverage-{level=4,inline-8bit-counters,pc-table,trace-compares})
export RUSTFLAGS="--cfg fuzzing -Ccodegen-units=1 -Cpasses=sancov-module ${sancov[*]/#/-Cllvm-args=}"
export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-target}
cargo build --release --target x86_64-unknown-linux-gnu --bin "$target"
program=$CARGO_TARGET_DIR/x86_64-unknown-linux-gnu/release/$target

found=$CARGO_TARGET_DIR/found/$target
mkdir -p "$found" "corpus/$target"
options=(-rss_limit_mb=2048 -timeout=1 "-max_len=$length" "-artifact_prefix=$found-")
[[ -e dict/$target ]] && options+=("-dict=dict/$target")
nice -n 10 "$program" "${options[@]}" -print_final_stats=1 "-runs=$runs" "$found" "corpus/$target" </dev/null

# What is worth keeping.
rm -rf "$found-merged" && mkdir "$found-merged"
nice -n 10 "$program" "${options[@]}" -merge=1 "$found-merged" "corpus/$target" "$found" </dev/null
