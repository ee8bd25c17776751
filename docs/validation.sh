#!/usr/bin/env bash
# Makes the pictures of the book's chapters on validation and fields anew: those that `fem` draws, those of the tests that hold
# a force history against another one, and that of `view.py`, for which FEM_PYTHON names a Python with PyVista.
#
#     docs/validation.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
cargo build --release
fem=${CARGO_TARGET_DIR:-target}/release/fem
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
images=docs/book/src/images/validation

# run NAME SCENE EDIT: a scene, edited by sed in its folder, where its mesh is.
run() {
    local scene=$out/$1.toml
    sed -e "s|file = \"|file = \"$PWD/$(dirname "$2")/|" -e "$3" "$2" >"$scene"
    "$fem" run "$scene" --out "$out/$1"
}

run pagano examples/pagano-0-90-0/scene.toml ""
for profile in centre-in-plane edge-x-transverse; do
    cp "$out/pagano/profile-$profile.svg" "$images/pagano-$profile.svg"
done

case1=examples/as4-3502-16ply-50mm/scene.toml
run case-1-report "$case1" '1i fidelity = "report"
/^symmetry/d
s/^end = .*/end = "1.1 ms"/'
run case-1-default "$case1" ""
thin=examples/as4-3502-8ply-75mm/scene.toml
run case-5-linear "$thin" ""
run case-5-membrane "$thin" '$a [effects]
$a membrane = "on"'
for name in case-1-report case-1-default case-5-linear case-5-membrane; do
    cp "$out/$name/contact_force.svg" "$images/$name.svg"
done

"$fem" new "$out/plate" --template drop-weight
"$fem" run "$out/plate/scene.toml" --set output.fields=true --out "$out/fields"
"${FEM_PYTHON:-python3}" "$out/fields/fields/view.py" --save docs/book/src/images/fields.png

UPDATE_BOOK=1 cargo test --release --test all -- validation::impact report::case_3
