#!/usr/bin/env bash
# Makes the tables and pictures of docs/accuracy.md anew, and the tables of reductions and integrators in
# docs/performance.md: all of them, or those that are named.
#
#     docs/accuracy.sh [large-mass] [small-mass] [karas] [pagano] [coupon] [reductions] [asked]
#
# `asked` prints what an accuracy of 1 % takes where the ring of case 1 holds the plate over its height, and writes nothing.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
cargo build --release
fem=${CARGO_TARGET_DIR:-target}/release/fem
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

large=examples/as4-3502-16ply-50mm/scene.toml
small=docs/accuracy/small-mass.toml

# put NAME PAGE: what is read goes between the marks of NAME.
put() {
    cat >"$out/part"
    grep -qxF "<!-- begin $1 -->" "$2"
    awk -v name="$1" -v part="$out/part" '
        $0 == "<!-- end " name " -->" { inside = 0 }
        !inside { print }
        $0 == "<!-- begin " name " -->" { inside = 1; while ((getline line < part) > 0) print line }
    ' "$2" >"$out/page"
    cat "$out/page" >"$2"
}

# page NAME SCENE PICTURES OPTIONS...: a section of docs/accuracy.md.
page() {
    local name=$1 scene=$2 pictures=$3 picture
    shift 3
    "$fem" study "$scene" --out "$out/$name" "$@"
    # The heading is in the page, and the tables of all runs are too long for it.
    sed -e '1,2d' -e '/^Ladders$/,$d' "$out/$name/study.md" | put "$name" docs/accuracy.md
    for picture in $pictures; do
        cp "$out/$name/$picture.svg" "docs/book/src/images/accuracy/$name-$picture.svg"
    done
}

# columns FOLDER AXIS: setting, errors of force, peak and first damage, seconds to set up and to march, of its runs.
columns() {
    # Texts with commas stand in quotes; none of them is needed.
    awk -F, -v axis="$2" '
        { gsub(/"([^"]|"")*"/, "") }
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $1 == axis && $at["force-history of its axis"] != "" {
            damage = $at["first-damage of its axis"]
            printf "%s | %.1e | %.1e | %s | %.2f + %.3f |\n", $2, $at["force-history of its axis"],
                $at["peak-force of its axis"], damage == "" ? "none" : sprintf("%.1e", damage),
                $at["assemble_cpu_s"] + $at["solve_cpu_s"] + $at["stresses_cpu_s"], $at["march_cpu_s"] + $at["scan_cpu_s"]
        }' "$1/study.csv"
}

reductions() {
    "$fem" study "$large" --axis reductions,integrators --out "$out/of-large"
    "$fem" study "$small" --axis reductions --out "$out/of-small"
    {
        echo "| reduction | large mass: force, L2 | peak | first damage | time, s | small mass: force, L2 | peak | first damage | time, s |"
        echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"
        # One line for both masses.
        columns "$out/of-small" reductions >"$out/small"
        columns "$out/of-large" reductions | while read -r line; do
            beside=$(awk -v name="${line%% | *}" 'index($0, name " | ") == 1 { print substr($0, length(name) + 3) }' "$out/small")
            echo "| $line${beside:- | | | |}"
        done
    } | put reductions docs/performance.md
    {
        echo "| integrator, step | force, L2 | peak | first damage | time, s |"
        echo "| --- | --- | --- | --- | --- |"
        columns "$out/of-large" integrators | sed 's/^/| /'
    } | put integrators docs/performance.md
}

# asked SCENE: with the ring over the height instead of along a line.
asked() {
    sed -e 's/^at = "mid-plane"/at = "all"/' -e 's/^fix = \["U30"\]/kind = "roller"/' \
        -e "s|file = \"[^\"]*plate.msh\"|file = \"$PWD/examples/as4-3502-16ply-50mm/plate.msh\"|" "$1" >"$out/held.toml"
    "$fem" run "$out/held.toml" --out "$out/held" --accuracy 1%
}

for name in "${@:-large-mass small-mass karas pagano coupon reductions}"; do
    for one in $name; do
        case $one in
        large-mass) page large-mass "$large" "work-precision-force-history ladders" --axis mesh,layers,reduction,step,geometry ;;
        small-mass) page small-mass "$small" "work-precision-force-history ladders" --axis mesh,layers,reduction,step ;;
        karas) page karas docs/accuracy/karas.toml "work-precision-peak-force ladders" ;;
        pagano) page pagano docs/accuracy/pagano.toml "work-precision ladders" ;;
        coupon) page coupon docs/accuracy/coupon.toml "work-precision-force-history ladders" --axis mesh,layers,reduction,step --budget 400s ;;
        reductions) reductions ;;
        asked) asked "$large" && asked "$small" ;;
        *) echo "there is no part $one" >&2 && exit 2 ;;
        esac
    done
done
