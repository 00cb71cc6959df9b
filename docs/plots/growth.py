"""Pictures of crack growth for the book: docs/src/images/growth-*.svg.

    python3 docs/plots/growth.py RUNS [--cases cases] [--out docs/src/images] [--png]

Needs matplotlib. RUNS is a folder with the results of these runs, each in a folder of the name on the left:

    three-hole-beam-a, -b, -c      riss run cases/three-hole-beam-a/case.toml
    two-holes-two-cracks-15        riss run cases/two-holes-two-cracks-15/case.toml
    cantilever-straight-I          riss run cases/double-cantilever/case.toml --set growth.increment=I
                                   --set growth.steps=200, for I = 5, 2.5, 1.25, 0.625
    cantilever-curved-I            the same with --set 'growth.form="curved"', for I = 5, 2.5, 1.25
    life, life-fine                docs/src/tutorials/crack-growth.md

`riss run ... --out RUNS/NAME` writes there; `--set output.fields=false` saves time. References are the files
`*path*.csv` and `*sif*.csv` beside the case files: finite elements with a new mesh in each step. `--png` writes pictures
to look at beside the others.
"""

import argparse
import csv
import json
from pathlib import Path

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
from matplotlib.patches import Circle, Rectangle

BLUE, ORANGE, GREEN, RED, GRAY = "#0060a8", "#d4760a", "#2a8a4a", "#b02a30", "#808080"
BODY = {"facecolor": "#f2f2ee", "edgecolor": "black", "linewidth": 0.8}
HOLE = {"facecolor": "white", "edgecolor": "black", "linewidth": 0.8}


def results(runs, name):
    """The results of a run."""
    return json.loads((runs / name / "results.json").read_text())


def columns(path):
    """The columns of a CSV file with comments, by name."""
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    rows = list(csv.DictReader(lines))
    return {key: [float(row[key]) for row in rows] for key in rows[0]}


def references(cases, name, kind):
    """The reference files of a kind beside a case, in order of their names."""
    return [columns(p) for p in sorted((cases / name).glob(f"*{kind}*.csv"))]


def last_paths(result):
    """Paths of all cracks in the last step, as lists of x and y."""
    return [list(zip(*crack["path"])) for crack in result["steps"][-1]["cracks"]]


def three_hole_beam(runs, cases):
    """Paths of a crack that starts at three places below three holes."""
    figure, axes = plt.subplots(1, 3, figsize=(6.6, 4.2), sharey=True)
    for axis, letter, start in zip(axes, "abc", ["x = 5, a = 1.5", "x = 4, a = 1", "x = 4, a = 2.5"]):
        name = f"three-hole-beam-{letter}"
        axis.add_patch(Rectangle((0, 0), 20, 8, **BODY))
        for y in [2.75, 4.75, 6.75]:
            axis.add_patch(Circle((6, y), 0.25, **HOLE))
        for reference in references(cases, name, "path"):
            axis.plot(reference["x"], reference["y"], color=ORANGE, lw=3.2, alpha=0.55, label="finite elements")
        for x, y in last_paths(results(runs, name)):
            axis.plot(x, y, color=BLUE, lw=1.1, label="riss")
        axis.set(xlim=(3.2, 7.8), ylim=(-0.2, 8.2), aspect="equal", title=start, xlabel="x")
    axes[0].set_ylabel("y")
    axes[2].legend(loc="lower right", fontsize=7)
    return figure


def double_cantilever(runs, _cases):
    """Paths in the double cantilever beam for several increments, straight and curved."""
    figure, axes = plt.subplots(1, 2, figsize=(6.6, 3.3), sharey=True)
    colors = {"5": RED, "2.5": ORANGE, "1.25": GREEN, "0.625": BLUE}
    for axis, form, increments in [(axes[0], "straight", list(colors)), (axes[1], "curved", list(colors)[:3])]:
        for increment in increments:
            (x, y), = last_paths(results(runs, f"cantilever-{form}-{increment}"))
            axis.plot(x, y, color=colors[increment], lw=1.1, label=f"{increment} mm: {x[-1]:.1f}")
        axis.axhline(0, color="black", lw=0.8)
        axis.set(xlim=(138, 190), ylim=(-3, 54), aspect="equal", title=f"{form} increments", xlabel="x [mm]")
        axis.legend(loc="center left", bbox_to_anchor=(0.03, 0.4), fontsize=7, title="increment: end", title_fontsize=7)
    axes[0].set_ylabel("y [mm]")
    return figure


def two_holes(runs, cases):
    """Stress intensity factors of two cracks that grow towards each other."""
    name = "two-holes-two-cracks-15"
    figure, axes = plt.subplots(1, 2, figsize=(6.6, 3.0), gridspec_kw={"width_ratios": [1.15, 1]})
    run = results(runs, name)
    reference, = references(cases, name, "sif")
    for crack, (color, label) in enumerate([(BLUE, "left"), (RED, "right")]):
        tips = [(s["step"], t) for s in run["steps"] for t in s["cracks"][crack]["tips"]]
        steps = [step for step, _ in tips]
        known = [k for k, c in enumerate(reference["crack"]) if c == crack]
        for key, column, style in [("K_I", "KI", "-"), ("K_II", "KII", "--")]:
            axes[0].plot(steps, [t[key] for _, t in tips], style, color=color, lw=1.1, label=f"${key[0]}_{{{key[2:]}}}$, {label}")
            axes[0].plot([reference["step"][k] for k in known], [reference[column][k] for k in known], ".",
                         color=color, ms=4, mfc="white", mew=0.8)
        x, y = last_paths(run)[crack]
        axes[1].plot(x, y, color=color, lw=1.1)
    axes[0].plot([], [], ".", color=GRAY, ms=4, mfc="white", mew=0.8, label="finite elements")
    axes[0].set(xlabel="step", ylabel="K [psi√in]")
    axes[0].axhline(0, color="black", lw=0.5)
    axes[0].legend(fontsize=7)
    for center in [2, 3]:
        axes[1].add_patch(Circle((center, 0), 0.078125, **HOLE))
    axes[1].set(xlim=(1.85, 3.15), ylim=(-0.3, 0.3), aspect="equal", xlabel="x [in]", ylabel="y [in]")
    return figure


def life(runs, _cases):
    """Path and life of the tutorial."""
    figure, axes = plt.subplots(1, 2, figsize=(6.6, 3.0), gridspec_kw={"width_ratios": [1, 1.25]})
    axes[0].add_patch(Rectangle((0, 0), 7, 16, **BODY))
    for name, color, increment in [("life", BLUE, "0.25 in"), ("life-fine", RED, "0.05 in from step 8 on")]:
        run = results(runs, name)
        (x, y), = last_paths(run)
        axes[0].plot(x, y, color=color, lw=1.1)
        lengths = [sum(((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2) ** 0.5 for a, b in zip(p, p[1:]))
                   for p in (s["cracks"][0]["path"] for s in run["steps"])]
        axes[1].plot([s["cycles"] / 1e3 for s in run["steps"]], lengths, ".-", color=color, lw=1.1, ms=4,
                     label=f"increment {increment}")
    axes[0].set(xlim=(-0.3, 7.3), ylim=(5.4, 10.0), aspect="equal", xlabel="x [in]", ylabel="y [in]")
    axes[1].set(xlabel="load cycles [thousands]", ylabel="crack length [in]")
    axes[1].legend(fontsize=7)
    return figure


PICTURES = {
    "growth-three-hole-beam": three_hole_beam,
    "growth-double-cantilever": double_cantilever,
    "growth-two-holes": two_holes,
    "growth-life": life,
}


def main():
    root = Path(__file__).resolve().parents[2]
    parser = argparse.ArgumentParser(description="Pictures of crack growth for the book.")
    parser.add_argument("runs", type=Path, help="folder with the results of the runs")
    parser.add_argument("--cases", type=Path, default=root / "cases")
    parser.add_argument("--out", type=Path, default=root / "docs/src/images")
    parser.add_argument("--png", action="store_true", help="also as PNG")
    arguments = parser.parse_args()
    plt.rcParams.update({"font.size": 8, "axes.titlesize": 8, "svg.hashsalt": "riss", "axes.linewidth": 0.6})
    for name, draw in PICTURES.items():
        figure = draw(arguments.runs, arguments.cases)
        figure.tight_layout()
        # Without a date: the same results give the same file.
        figure.savefig(arguments.out / f"{name}.svg", metadata={"Date": None})
        if arguments.png:
            figure.savefig(arguments.out / f"{name}.png", dpi=130)
        plt.close(figure)


if __name__ == "__main__":
    main()
