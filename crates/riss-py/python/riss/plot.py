"""Pictures with matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from mpl_toolkits.mplot3d.axes3d import Axes3D

    from .results import Run, Step
    from .solid import SolidRun, SolidStep

#: Components of vectors and tensors by name.
_COMPONENTS = {
    "u_x": ("displacement", (0,)),
    "u_y": ("displacement", (1,)),
    "stress_xx": ("stress", (0, 0)),
    "stress_yy": ("stress", (1, 1)),
    "stress_xy": ("stress", (0, 1)),
    "strain_xx": ("strain", (0, 0)),
    "strain_yy": ("strain", (1, 1)),
    "strain_xy": ("strain", (0, 1)),
}
_SCALARS = ("von_mises", "error_indicator", "out_of_plane_stress", "out_of_plane_strain")


def field(
    step: Step,
    name: str = "von_mises",
    ax: Optional[Axes] = None,
    scale: Union[None, float] = None,
    levels: int = 32,
    limits: Optional[tuple[float, float]] = None,
) -> Axes:
    """A field on the deformed body.

    ``name``: ``von_mises``, ``error_indicator``, ``out_of_plane_stress``, ``out_of_plane_strain``, ``u_x``,
    ``stress_yy`` and so on.

    ``scale``: factor on the displacement; by default such that the largest is a twentieth of the body.

    ``limits``: of the colors; by default the 1st and 99th percentile, as stresses at a tip have no bound.
    """
    from matplotlib.tri import Triangulation

    ax = _axes(ax)
    values = _values(step, name)
    if not len(values):
        raise ValueError("the step has no fields: the case asks for none, or the step was not solved")
    size = np.ptp(step.points, axis=0).max()
    largest = np.abs(step.displacement).max()
    factor = scale if scale is not None else (0.05 * size / largest if largest > 0.0 else 0.0)
    x, y = (step.points + factor * step.displacement).T
    triangulation = Triangulation(x, y, step.triangles)
    low, high = limits if limits is not None else np.percentile(values, [1.0, 99.0])
    if not high > low:
        low, high = low - 0.5, high + 0.5
    shown = ax.tricontourf(
        triangulation, np.clip(values, low, high), levels=np.linspace(low, high, levels), extend="both"
    )
    ax.figure.colorbar(shown, ax=ax, label=name)
    ax.set_aspect("equal")
    return ax


def paths(run: Union[Run, Step], ax: Optional[Axes] = None, **style: Any) -> Axes:
    """All cracks of a run as they are in the last step, or in a step."""
    ax = _axes(ax)
    step = run.last if hasattr(run, "last") else run
    for crack in step.record["cracks"]:
        x, y = np.array(crack["path"]).T
        ax.plot(x, y, **{"label": crack["name"], "marker": ".", **style})
    ax.set_aspect("equal")
    return ax


def history(run: Run, y: Any = ("K_I", "K_II"), x: str = "a", ax: Optional[Axes] = None, **style: Any) -> Axes:
    """Columns of ``history.csv`` over another, one line for each tip; K with its uncertainty as a band."""
    ax = _axes(ax)
    names = [y] if isinstance(y, str) else list(y)
    table = run.history()
    tips = list(dict.fromkeys(zip(table["crack"], table["end"])))
    for crack, end in tips:
        rows = run.history(crack, end)
        for name in names:
            label = name if len(tips) == 1 else f"{name}, {crack} {end}"
            (line,) = ax.plot(rows[x], rows[name], **{"label": label, "marker": ".", **style})
            if name in ("K_I", "K_II"):
                bar = rows["K_uncertainty"]
                ax.fill_between(rows[x], rows[name] - bar, rows[name] + bar, color=line.get_color(), alpha=0.3, lw=0)
    ax.set_xlabel(x)
    ax.legend()
    return ax


def front(
    of: Union[SolidRun, SolidStep],
    index: int = 0,
    y: Any = ("K_I", "K_II", "K_III"),
    ax: Optional[Axes] = None,
    **style: Any,
) -> Axes:
    """Columns of :meth:`SolidStep.front` over the length along a front; factors with their uncertainty as a band."""
    ax = _axes(ax)
    columns = of.front(index)
    bars = {"T": "T_uncertainty", "J": "J_uncertainty", **dict.fromkeys(["K_I", "K_II", "K_III"], "K_uncertainty")}
    for name in [y] if isinstance(y, str) else y:
        (line,) = ax.plot(columns["s"], columns[name], **{"label": name, "marker": ".", **style})
        if name in bars:
            low, high = columns[name] - columns[bars[name]], columns[name] + columns[bars[name]]
            ax.fill_between(columns["s"], low, high, color=line.get_color(), alpha=0.3, lw=0)
    ax.set_xlabel("s")
    ax.legend()
    return ax


def load_curve(run: Union[Run, SolidRun], ax: Optional[Axes] = None, **style: Any) -> Axes:
    """Load over displacement of cohesive cracks, with the states that have fields as dots."""
    ax = _axes(ax)
    curve = run.load_curve
    if not curve:
        raise ValueError("the run has no load curve: no crack is cohesive")
    (line,) = ax.plot(curve["displacement"], curve["load"], **style)
    shown = [step.number for step in run.steps]
    ax.plot(curve["displacement"][shown], curve["load"][shown], "o", ms=4, color=line.get_color())
    ax.set_xlabel("displacement")
    ax.set_ylabel("load")
    return ax


def surface(
    of: Union[SolidRun, SolidStep], crack: Union[int, str] = 0, ax: Optional[Axes3D] = None, **style: Any
) -> Axes3D:
    """A crack of a solid as a surface in space, with its fronts."""
    import matplotlib.pyplot as plt

    if ax is None:
        ax = plt.figure().add_subplot(projection="3d")
    vertices, triangles = of.surface(crack)
    x, y, z = vertices.T
    ax.plot_trisurf(x, y, z, triangles=triangles, **{"alpha": 0.7, "linewidth": 0.2, "edgecolor": "gray", **style})
    for line in of.fronts:
        points = np.array([p["position"] for p in line["points"]])
        if line["closed"]:
            points = np.vstack([points, points[:1]])
        ax.plot(*points.T, color="tab:red")
    ax.set_aspect("equal")
    return ax


def _values(step: Step, name: str) -> np.ndarray:
    if name in _SCALARS:
        return getattr(step, name)
    if name in _COMPONENTS:
        field_name, index = _COMPONENTS[name]
        values = getattr(step, field_name)
        return values[(slice(None), *index)]
    raise ValueError(f"there is no field {name!r}; there are {', '.join([*_SCALARS, *_COMPONENTS])}")


def _axes(ax: Optional[Axes]) -> Axes:
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    return plt.subplots()[1]
