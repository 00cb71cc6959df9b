"""Pictures of enrichment for the book: docs/src/images/enrichment-*.svg.

    python3 docs/plots/enrichment.py [--out docs/src/images] [--png]

Needs matplotlib and the Python package of riss (`pip install ./crates/riss-py`). The near-tip square of section 5.6.1 of
Belytschko (1997) on 17 x 17 nodes in mode I: stress ahead of the tip (Fig. 37) and around it (Fig. 38), opening of
the crack (Fig. 26c). `--png` writes pictures to look at beside the others.
"""

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
import numpy as np
import riss

BLUE, ORANGE, GRAY = "#0060a8", "#d4760a", "#808080"
YOUNG, POISSON = 30e6, 0.3
KINDS = [("none", "linear basis", ORANGE, "--"), ("extrinsic-mls", "extrinsic-mls", BLUE, "-")]


def solve(kind):
    """The square with half edge 1 and K_I = 1."""
    return riss.Case(
        material={"young": YOUNG, "poisson": POISSON, "plane": "strain"},
        geometry={"rectangle": {"lower": [-1, -1], "upper": [1, 1]}},
        crack=[{"path": [[-1, 0], [0, 0]]}],
        support=[{"on": ["left", "right", "bottom", "top"], "exact": True}],
        exact={"crack-tip": {"tip": [0, 0], "angle_deg": 0, "K_I": 1.0, "K_II": 0.0, "T": 0.0}},
        nodes={"layout": {"structured": {"nx": 17, "ny": 17}}},
        approximation={"enrichment": {"kind": kind}},
    ).run().last


def polar(r, theta):
    """Points of shape (n, 2)."""
    return np.column_stack([r * np.cos(theta), r * np.sin(theta)])


def exact_stress(r, theta):
    """xx, yy and xy of mode I with K_I = 1."""
    s, c = np.sin(theta / 2), np.cos(theta / 2)
    s3, c3 = np.sin(1.5 * theta), np.cos(1.5 * theta)
    return np.array([c * (1 - s * s3), c * (1 + s * s3), s * c * c3]) / np.sqrt(2 * np.pi * r)


def ahead(steps):
    """Stress across the line ahead of the tip, Fig. 37."""
    figure, axis = plt.subplots(figsize=(5.2, 3.4))
    r = np.geomspace(0.003, 0.9, 400)
    axis.plot(r, exact_stress(r, 0 * r)[1], color=GRAY, linewidth=4, alpha=0.5, label="exact")
    for kind, name, color, style in KINDS:
        axis.plot(r, steps[kind].stress_at(polar(r, 0 * r))[:, 1, 1], style, color=color, linewidth=1.2, label=name)
    axis.set(xlabel="distance ahead of the tip $r/a$", ylabel=r"$\sigma_{yy}\sqrt{a}/K_I$", xlim=(0, 0.5), ylim=(0, 5))
    axis.legend(frameon=False)
    return figure


def around(steps):
    """Stress around the tip at r = 0.1 a, Fig. 38."""
    figure, axes = plt.subplots(1, 3, figsize=(8.4, 3.0), sharex=True)
    theta = np.linspace(-np.pi, np.pi, 361)[1:-1]
    exact = exact_stress(0.1, theta)
    names = [r"\sigma_{xx}", r"\sigma_{yy}", r"\sigma_{xy}"]
    for axis, name, values, (i, j) in zip(axes, names, exact, [(0, 0), (1, 1), (0, 1)]):
        axis.plot(np.degrees(theta), values, color=GRAY, linewidth=4, alpha=0.5, label="exact")
        for kind, label, color, style in KINDS:
            found = steps[kind].stress_at(polar(0.1, theta))[:, i, j]
            axis.plot(np.degrees(theta), found, style, color=color, linewidth=1.2, label=label)
        axis.set(xlabel=r"$\theta$ [°]", title=rf"${name}\sqrt{{a}}/K_I$ at $r = 0.1\,a$", xticks=[-180, -90, 0, 90, 180])
    axes[0].legend(frameon=False, fontsize=8)
    return figure


def opening(steps):
    """Opening of the crack, Fig. 26c."""
    figure, axis = plt.subplots(figsize=(5.2, 3.4))
    r = np.geomspace(1e-4, 0.95, 300)
    scale = YOUNG / (1 - POISSON**2)
    axis.plot(-r, 8 * np.sqrt(r / (2 * np.pi)), color=GRAY, linewidth=4, alpha=0.5, label="exact")
    faces = np.column_stack([-r, 0 * r])
    for kind, name, color, style in KINDS:
        sides = [steps[kind].displacement_at(faces, faces + [0, side * 1e-7]) for side in (1, -1)]
        axis.plot(-r, (sides[0] - sides[1])[:, 1] * scale, style, color=color, linewidth=1.2, label=name)
    axis.set(xlabel="$x/a$, the tip is at 0", ylabel=r"opening $\delta E'/(K_I\sqrt{a})$", xlim=(-0.5, 0.02), ylim=(0, None))
    axis.legend(frameon=False)
    return figure


def main():
    """Draws all pictures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("docs/src/images"))
    parser.add_argument("--png", action="store_true")
    options = parser.parse_args()
    plt.rcParams.update({"font.size": 9, "svg.hashsalt": "riss", "axes.spines.top": False, "axes.spines.right": False})
    steps = {kind: solve(kind) for kind, *_ in KINDS}
    for name, draw in [("ahead", ahead), ("around", around), ("opening", opening)]:
        figure = draw(steps)
        figure.tight_layout()
        figure.savefig(options.out / f"enrichment-{name}.svg", metadata={"Date": None})
        if options.png:
            figure.savefig(options.out / f"enrichment-{name}.png", dpi=110)
        plt.close(figure)


main()
