"""What a run of a solid finds: fronts, cracks, fields."""

from __future__ import annotations

import json
from functools import cached_property
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from . import _riss
from .loading import Loaded
from .results import State

if TYPE_CHECKING:
    import meshio
    import pandas
    import pyvista


class SolidStep:
    """A solved solid: the only one of a static run, a step of growth, or a state of cohesive cracks under load.

    Fields are given at :attr:`nodes`.
    """

    def __init__(self, step: _riss.SolidStep) -> None:
        self._step = step

    @cached_property
    def record(self) -> dict[str, Any]:
        """The step as in ``steps`` of ``results.json``."""
        return json.loads(self._step.record_json())

    @property
    def number(self) -> int:
        """From 0; under load the number of its point on the load curve."""
        return self.record["step"]

    @property
    def fronts(self) -> list[dict[str, Any]]:
        """Every front with the keys of ``results.json``: its ``crack``, ``closed``, ``length`` and ``points``."""
        return self.record["fronts"]

    def front(self, index: int = 0) -> dict[str, np.ndarray]:
        """Columns along a front: ``s``, ``position`` (n, 3), ``K_I`` and so on; what is not known is NaN."""
        if not 0 <= index < len(self.fronts):
            raise IndexError(f"there is no front {index}: there are {len(self.fronts)}")
        points = self.fronts[index]["points"]
        return {name: np.array([p[name] for p in points], dtype=float) for name in points[0]}

    @property
    def areas(self) -> dict[str, float]:
        """Area of each crack in the body by its name [area]."""
        return {crack["name"]: crack["area"] for crack in self.record["cracks"]}

    @property
    def point(self) -> Optional[dict[str, float]]:
        """Its point of the load curve: ``load_factor``, ``load``, ``displacement``, energies; none without loading."""
        text = self._step.point_json
        return None if text is None else json.loads(text)

    @property
    def load_factor(self) -> Optional[float]:
        """Factor on the loads: of this state under load, or at which the strength is reached ahead of a front."""
        point = self.point
        return self.record["load_factor"] if point is None else point["load_factor"]

    @property
    def end(self) -> Optional[dict[str, Any]]:
        """Why growth ends with this step: ``kind`` and ``reason``."""
        text = self._step.end_json
        return None if text is None else json.loads(text)

    @property
    def warnings(self) -> list[str]:
        """What deserves a second look."""
        return self.record["warnings"]

    @property
    def state(self) -> Optional[State]:
        """From where the step can be repeated; none without growth."""
        state = self._step.state
        return None if state is None else State(state)

    def to_pandas(self) -> pandas.DataFrame:
        """Points of all fronts as a table, with the name of the ``crack`` and the index of the ``front``."""
        import pandas

        rows = []
        for index, front in enumerate(self.fronts):
            for point in front["points"]:
                x, y, z = point["position"]
                numbers = {k: v for k, v in point.items() if k not in ("position", "ahead", "normal")}
                place = {"step": self.number, "crack": front["crack"], "front": index, "x": x, "y": y, "z": z}
                rows.append({**place, **numbers})
        return pandas.DataFrame(rows)

    @cached_property
    def nodes(self) -> np.ndarray:
        """Their positions, shape (n, 3) [length]; nodes on a crack come once for each face."""
        return self._step.vectors("nodes")

    @cached_property
    def displacement(self) -> np.ndarray:
        """At the nodes, shape (n, 3) [length]."""
        return self._step.vectors("displacement")

    @cached_property
    def stress(self) -> np.ndarray:
        """At the nodes, shape (n, 3, 3) [stress]."""
        return self._step.stress()

    def opening(self, crack: Union[int, str] = 0) -> tuple[np.ndarray, np.ndarray]:
        """Points of a crack, and the displacement of its positive face less that of the other.

        Both of shape (n, 3) [length]; points of fronts, where the opening is zero, come last.
        """
        points, openings = self._step.crack(self._index(crack))
        return points, openings

    def traction(self, crack: Union[int, str] = 0) -> np.ndarray:
        """What pulls the faces of a cohesive crack together at the points of :meth:`opening`, shape (n,) [stress]."""
        return self._step.traction(self._index(crack))

    def surface(self, crack: Union[int, str] = 0) -> tuple[np.ndarray, np.ndarray]:
        """Vertices of a crack as it stands in this step, shape (n, 3) [length], and its triangles, shape (m, 3)."""
        return self._step.surface(self._index(crack))

    def _index(self, crack: Union[int, str]) -> int:
        names = [c["name"] for c in self.record["cracks"]]
        if isinstance(crack, int) and 0 <= crack < len(names):
            return crack
        if crack in names:
            return names.index(crack)
        raise KeyError(f"there is no crack {crack!r}; cracks are {', '.join(names)}")

    def to_pyvista(self) -> pyvista.PolyData:
        """The nodes as points, with displacement and stress (xx, yy, zz, xy, yz, xz)."""
        import pyvista

        cloud = pyvista.PolyData(self.nodes)
        cloud.point_data["displacement"] = self.displacement
        s = self.stress
        columns = [s[:, 0, 0], s[:, 1, 1], s[:, 2, 2], s[:, 0, 1], s[:, 1, 2], s[:, 0, 2]]
        cloud.point_data["stress"] = np.column_stack(columns)
        return cloud

    def to_meshio(self) -> meshio.Mesh:
        """The nodes as vertices, with displacement and stress (xx, yy, zz, xy, yz, xz)."""
        import meshio

        cells = [("vertex", np.arange(len(self.nodes))[:, None])]
        s = self.stress
        columns = [s[:, 0, 0], s[:, 1, 1], s[:, 2, 2], s[:, 0, 1], s[:, 1, 2], s[:, 0, 2]]
        return meshio.Mesh(
            self.nodes, cells, point_data={"displacement": self.displacement, "stress": np.column_stack(columns)}
        )

    def crack_to_pyvista(self, crack: Union[int, str] = 0) -> pyvista.PolyData:
        """A crack as triangles between its nodes, with its opening; with its traction where it is cohesive."""
        points, openings = self.opening(crack)
        surface = _poly_data(points, self._step.crack_triangles(self._index(crack)))
        surface.point_data["opening"] = openings
        traction = self.traction(crack)
        if len(traction):
            surface.point_data["cohesive traction"] = traction
        return surface

    def surface_to_pyvista(self, crack: Union[int, str] = 0) -> pyvista.PolyData:
        """The triangles of :meth:`surface`."""
        return _poly_data(*self.surface(crack))

    def __repr__(self) -> str:
        return f"<riss.SolidStep {self.number}: {len(self.fronts)} fronts, {self.record['nodes']} nodes>"


class SolidRun(Loaded):
    """All that a run of a solid found.

    Fronts, fields and cracks are those of :attr:`shown`: the last step of growth, the state of the greatest load of
    cohesive cracks.
    """

    def __init__(self) -> None:
        #: Every :class:`SolidStep`: one of a static run; of loading those that have fields, about ten.
        self.steps: list[SolidStep] = []
        #: What deserves a second look.
        self.warnings: list[str] = []
        #: The content of ``results.json``.
        self.record: dict[str, Any] = {}

    @property
    def last(self) -> SolidStep:
        """The last step."""
        return self.steps[-1]

    @property
    def shown(self) -> SolidStep:
        """The step whose fields the run shows."""
        loading = self.record.get("loading")
        if loading is not None:
            for step in self.steps:
                if step.number == loading["peak"]["step"]:
                    return step
        return self.last

    @property
    def end(self) -> Optional[dict[str, Any]]:
        """Why growth or loading ended: ``kind`` and ``reason``; none in a static run or one that was stopped."""
        loading = self.record.get("loading")
        return self.record.get("growth_end") if loading is None else loading["end"]

    def history(self) -> dict[str, np.ndarray]:
        """Columns over the steps of growth.

        ``step``, ``crack_area``, ``load_factor``, the least and the largest ``K_I`` of all fronts, the numbers of
        ``front_vertices`` and ``moving_vertices``; what is not known is NaN.
        """
        rows = [_in_short(step) for step in self.steps]
        names = ["step", "crack_area", "load_factor", "K_I_min", "K_I_max", "front_vertices", "moving_vertices"]
        return {name: np.array([row[name] for row in rows], dtype=float) for name in names}

    def to_pandas(self) -> pandas.DataFrame:
        """Cohesive cracks: the load curve. Else points of all fronts in all steps, see :meth:`SolidStep.to_pandas`."""
        import pandas

        if self.load_curve:
            return pandas.DataFrame(self.load_curve).astype({"step": int})
        return pandas.concat([step.to_pandas() for step in self.steps], ignore_index=True)

    @property
    def fronts(self) -> list[dict[str, Any]]:
        """See :attr:`SolidStep.fronts`."""
        return self.shown.fronts

    def front(self, index: int = 0) -> dict[str, np.ndarray]:
        """See :meth:`SolidStep.front`."""
        return self.shown.front(index)

    @property
    def nodes(self) -> np.ndarray:
        """See :attr:`SolidStep.nodes`."""
        return self.shown.nodes

    @property
    def displacement(self) -> np.ndarray:
        """See :attr:`SolidStep.displacement`."""
        return self.shown.displacement

    @property
    def stress(self) -> np.ndarray:
        """See :attr:`SolidStep.stress`."""
        return self.shown.stress

    def opening(self, crack: Union[int, str] = 0) -> tuple[np.ndarray, np.ndarray]:
        """See :meth:`SolidStep.opening`."""
        return self.shown.opening(crack)

    def surface(self, crack: Union[int, str] = 0) -> tuple[np.ndarray, np.ndarray]:
        """See :meth:`SolidStep.surface`."""
        return self.shown.surface(crack)

    def to_pyvista(self) -> pyvista.PolyData:
        """See :meth:`SolidStep.to_pyvista`."""
        return self.shown.to_pyvista()

    def to_meshio(self) -> meshio.Mesh:
        """See :meth:`SolidStep.to_meshio`."""
        return self.shown.to_meshio()

    def crack_to_pyvista(self, crack: Union[int, str] = 0) -> pyvista.PolyData:
        """See :meth:`SolidStep.crack_to_pyvista`."""
        return self.shown.crack_to_pyvista(crack)

    def surface_to_pyvista(self, crack: Union[int, str] = 0) -> pyvista.PolyData:
        """See :meth:`SolidStep.surface_to_pyvista`."""
        return self.shown.surface_to_pyvista(crack)

    def __repr__(self) -> str:
        steps = "" if len(self.steps) == 1 else f"{len(self.steps)} steps, "
        return f"<riss.SolidRun: {steps}{len(self.fronts)} fronts, {self.record['nodes']} nodes>"


def _in_short(step: SolidStep) -> dict[str, float]:
    known = [p["K_I"] for front in step.fronts for p in front["points"] if p["K_I"] is not None]
    factor = step.load_factor
    return {
        "step": step.number,
        "crack_area": sum(step.areas.values()),
        "load_factor": np.nan if factor is None else factor,
        "K_I_min": min(known, default=np.nan),
        "K_I_max": max(known, default=np.nan),
        "front_vertices": step.record["front_vertices"],
        "moving_vertices": step.record["moving_vertices"],
    }


def _poly_data(points: np.ndarray, triangles: np.ndarray) -> pyvista.PolyData:
    import pyvista

    return pyvista.PolyData(points, np.insert(triangles, 0, 3, axis=1).astype(np.int64).ravel())
