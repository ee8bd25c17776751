#!/usr/bin/env python3
"""What the presets of an impact leave and take: force histories with other numbers of vectors, steps and layers, held against finer ones.

    cargo build --release && docs/presets.py

Prints the tables of "Presets" in docs/accuracy.md; takes two minutes. Pictures, damage and membrane stiffening are off.
"""

import csv
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parent.parent
COMMAND = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "target/release/fem"
EXAMPLES = [
    "as4-3502-16ply-50mm",
    "as4-3502-16ply-75mm",
    "as4-3502-8ply-25mm",
    "as4-3502-8ply-50mm",
    "im6-934-32ply-drop-weight",
    "im6-934-32ply-large-mass",
    "im6-934-32ply-small-mass",
]
SCENES = {name: ROOT / "examples" / name / "scene.toml" for name in EXAMPLES}
SCENES["case 1, small mass"] = ROOT / "docs/accuracy/small-mass.toml"
OFF = ["output.plots=false", "effects.damage=off", "effects.membrane=off"]


def run(scene, folder, setting=None):
    """Force by time in tenths of a nanosecond, seconds of processor in all phases, and the step, s."""
    settings = [word for key in OFF + [setting] * (setting is not None) for word in ("--set", key)]
    command = [COMMAND, "run", scene, "--out", folder, "--threads", "1", *settings]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(done.stderr)
    with open(folder / "history.csv", newline="") as file:
        force = {round(float(row["time_s"]) * 1e10): float(row["contact_force_N"]) for row in csv.DictReader(file)}
    phases = json.loads((folder / "cost.json").read_text())["phases"]
    summary = json.loads((folder / "summary.json").read_text())
    return force, sum(phase["cpu_s"] for phase in phases), summary["accuracy"]["step_s"]


def error(force, reference):
    """Relative difference in L2 at the times of both."""
    both = [(force[time], reference[time]) for time in force.keys() & reference.keys()]
    return math.sqrt(sum((a - b) ** 2 for a, b in both) / sum(b * b for _, b in both))


def table(title, folder, settings, reference):
    """`settings` and `reference`: the settings of a scene whose step is given."""
    print(f"| {title} | " + " | ".join(name for name, _ in settings(1.0)) + " |")
    print("| --- |" + " --- |" * len(settings(1.0)))
    for name, scene in SCENES.items():
        step = run(scene, folder)[2]
        exact = run(scene, folder, reference(step))[0]
        cells = []
        for _, setting in settings(step):
            force, seconds, _ = run(scene, folder, setting)
            cells.append(f"{error(force, exact):.1e}, {seconds:.2f} s")
        print(f"| {name} | " + " | ".join(cells) + " |", flush=True)
    print()


def main():
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        vectors = [16, 30, 60, 120]
        table("vectors, against 240", folder, lambda _: [(str(n), f"reduction.vectors={n}") for n in vectors],
              lambda _: "reduction.vectors=240")
        steps = [8, 4, 2, 1, 0.5]
        table("step over the preset, against 1/8", folder,
              lambda step: [(f"{n:g}", f"march.step={n * step * 1e9} ns") for n in steps],
              lambda step: f"march.step={step / 8 * 1e9} ns")
        table("layers of cells, against 8", folder, lambda _: [(str(n), f"laminate.layers={n}") for n in (2, 4)],
              lambda _: "laminate.layers=8")


if __name__ == "__main__":
    main()
