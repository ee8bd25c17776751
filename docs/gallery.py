#!/usr/bin/env python3
"""Makes the book's gallery of the examples from their results.

    for scene in examples/*/scene.toml; do fem run "$scene"; done
    docs/gallery.py results           writes docs/book/src/gallery.md and its pictures
    docs/gallery.py results --check   fails where page or pictures are not those of the results

An example that is a crate of its own is left out: its scene names what only that crate knows.
"""

import argparse
import json
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/book/src/gallery.md"
PICTURES = ROOT / "docs/book/src/images/gallery"
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")
# Of a picture, in its units, which are pixels: machines differ in the last bits of a sum.
NEAR = 1.0


def quantity(value, scales):
    """With three digits, in the first unit that it fills."""
    unit, factor = next((scale for scale in scales if abs(value) >= scale[1]), scales[-1])
    digits = f"{value / factor:#.3g}".rstrip(".")
    return f"{digits} {unit}"


def energy(value):
    return quantity(value, [("J", 1.0), ("mJ", 1e-3)])


def force(value):
    return quantity(value, [("kN", 1e3), ("N", 1.0)])


def length(value):
    return quantity(value, [("mm", 1e-3), ("um", 1e-6)])


def time(value):
    return quantity(value, [("ms", 1e-3), ("us", 1e-6)])


def impact(summary):
    """A row for each impactor, and what failed first."""
    impacts = summary["impact"] if isinstance(summary["impact"], list) else [summary["impact"]]
    yield "| | energy | largest force | largest deflection |"
    yield "| --- | --- | --- | --- |"
    for one in impacts:
        name = one.get("name", "impactor")
        row = [energy(one["energy_J"]), force(one["peak_force_N"]), length(one["peak_plate_displacement_m"])]
        yield f"| {name} | {' | '.join(row)} |"
    yield ""
    first = min(summary["first_damage"], key=lambda event: event["time_s"], default=None)
    if first is None:
        yield "Nothing fails."
    else:
        where = f"interface {first['ply']}" if "|" in first["ply"] else f"ply {first['ply']}, counted from the bottom"
        yield f"First to fail: {first['mode']} in {where}, at {time(first['time_s'])} under {force(first['contact_force_N'])}."


def at_rest(summary):
    yield f"Largest deflection: {length(abs(summary['largest_deflection']['w_m']))}."


def cautions(summary):
    count = len(summary.get("cautions", []) + summary["warnings"])
    if count:
        yield f"The run says {'one caution or warning' if count == 1 else f'{count} cautions and warnings'}."


def section(name, results):
    """Text of an example, and the file of its picture."""
    summary = json.loads((results / "summary.json").read_text(encoding="utf-8"))
    struck = "impact" in summary
    picture = results / ("contact_force.svg" if struck else "profile-edge-x-transverse.svg")
    shows = "Contact force over time" if struck else "Transverse stresses through the thickness"
    lines = [
        f"## {summary['title']}",
        "",
        f"![{shows}](images/gallery/{name}.svg)",
        "",
        *(impact(summary) if struck else at_rest(summary)),
        *cautions(summary),
        "",
        "```sh",
        f"fem run examples/{name}/scene.toml",
        "```",
        "",
        "<details><summary>The scene</summary>",
        "",
        "```toml",
        f"{{{{#include ../../../examples/{name}/scene.toml}}}}",
        "```",
        "",
        "</details>",
        "",
    ]
    return "\n".join(lines), picture


def alike(one, other):
    """Whether two pictures differ in nothing but numbers, and in these by little."""
    if NUMBER.split(one) != NUMBER.split(other):
        return False
    return all(abs(float(a) - float(b)) <= NEAR for a, b in zip(NUMBER.findall(one), NUMBER.findall(other)))


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("results", type=Path, help="folder of the results, one folder for each example")
    options.add_argument("--check", action="store_true", help="writes nothing; fails where something differs")
    given = options.parse_args()

    page = ["# Gallery", "", "The examples of the project, what each finds, and its scene. `docs/gallery.py` makes this page from their results.", ""]
    wrong = []
    for scene in sorted((ROOT / "examples").glob("*/scene.toml")):
        name, results = scene.parent.name, given.results / scene.parent.name
        if (scene.parent / "Cargo.toml").exists():
            continue
        if not (results / "summary.json").exists():
            raise SystemExit(f"{results} holds no results: fem run examples/{name}/scene.toml")
        text, picture = section(name, results)
        page.append(text)
        drawn, kept = picture.read_text(encoding="utf-8"), PICTURES / f"{name}.svg"
        if not given.check:
            PICTURES.mkdir(parents=True, exist_ok=True)
            kept.write_text(drawn, encoding="utf-8")
        elif not kept.exists() or not alike(kept.read_text(encoding="utf-8"), drawn):
            wrong.append(str(kept.relative_to(ROOT)))
    page = "\n".join(page)
    if not given.check:
        PAGE.write_text(page, encoding="utf-8")
    elif PAGE.read_text(encoding="utf-8") != page:
        wrong.append(str(PAGE.relative_to(ROOT)))
    if wrong:
        raise SystemExit(f"not of these results: {', '.join(wrong)}; docs/gallery.py {given.results} makes them anew")


main()
