"""What a run finds: steps, tips, fields."""

from __future__ import annotations

import csv
import io
import json
import os
from functools import cached_property
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from . import _riss
from .loading import Loaded

if TYPE_CHECKING:
    import meshio
    import pandas
    import pyvista


class State:
    """All that a step of growth needs to know of those before it."""

    def __init__(self, state: _riss.State) -> None:
        self._state = state

    @classmethod
    def read(cls, folder: Union[str, os.PathLike[str]], step: int) -> State:
        """The state in a folder of results from which a step can be repeated."""
        return cls(_riss.restart_state(os.fspath(folder), step))

    @property
    def step(self) -> int:
        """Number of the step."""
        return self._state.step

    def __reduce__(self) -> Any:
        return _state_of, (self._state.to_json(),)

    def __repr__(self) -> str:
        return f"<riss.State before step {self.step}>"


def _state_of(text: str) -> State:
    return State(_riss.State.from_json(text))


class Step:
    """One step: its record, and its fields as arrays.

    Fields are given at :attr:`points`, corners of :attr:`triangles` that cover the body; points on a crack come once
    for each face. Fields are empty if the case asks for none (``output.fields = false``).
    """

    def __init__(self, step: _riss.Step) -> None:
        self._step = step

    @cached_property
    def record(self) -> dict[str, Any]:
        """The step as in ``results.json``."""
        return json.loads(self._step.record_json())

    @property
    def number(self) -> int:
        """From 0."""
        return self.record["step"]

    @property
    def tips(self) -> list[dict[str, Any]]:
        """All tips, each with the keys of ``results.json`` and the name of its ``crack``."""
        return [{"crack": crack["name"], **tip} for crack in self.record["cracks"] for tip in crack["tips"]]

    def tip(self, crack: Union[None, int, str] = None, end: Optional[str] = None) -> dict[str, Any]:
        """The tip of a crack, given by name or index, at its ``"start"`` or ``"end"``; the first that fits."""
        names = [c["name"] for c in self.record["cracks"]]
        name = names[crack] if isinstance(crack, int) else crack
        for tip in self.tips:
            if name in (None, tip["crack"]) and end in (None, tip["end"]):
                return tip
        raise KeyError(f"there is no tip of crack {crack!r} with end {end!r}; cracks are {', '.join(names)}")

    def path(self, crack: Union[int, str] = 0) -> np.ndarray:
        """Vertices of a crack, shape (n, 2) [length]."""
        cracks = self.record["cracks"]
        found = [c for k, c in enumerate(cracks) if crack in (k, c["name"])]
        if not found:
            raise KeyError(f"there is no crack {crack!r}; cracks are {', '.join(c['name'] for c in cracks)}")
        return np.array(found[0]["path"])

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
    def energy_error(self) -> Optional[float]:
        """Error in the energy norm over the norm of the solution, where the case names an exact field."""
        return self._step.energy_error

    @property
    def state(self) -> Optional[State]:
        """From where the step can be repeated; none without growth."""
        return None if self._step.state is None else State(self._step.state)

    @cached_property
    def points(self) -> np.ndarray:
        """Where fields are given, shape (n, 2) [length]."""
        return self._step.vectors("points")

    @cached_property
    def triangles(self) -> np.ndarray:
        """Points of each triangle, counterclockwise, shape (m, 3)."""
        return self._step.triangles()

    @cached_property
    def displacement(self) -> np.ndarray:
        """Shape (n, 2) [length]."""
        return self._step.vectors("displacement")

    @cached_property
    def stress(self) -> np.ndarray:
        """In the plane, shape (n, 2, 2) [stress]."""
        return self._step.tensors("stress")

    @cached_property
    def strain(self) -> np.ndarray:
        """In the plane, shape (n, 2, 2)."""
        return self._step.tensors("strain")

    @cached_property
    def out_of_plane_stress(self) -> np.ndarray:
        """Normal stress out of the plane, shape (n,) [stress]."""
        return self._step.scalars("out_of_plane_stress")

    @cached_property
    def out_of_plane_strain(self) -> np.ndarray:
        """Normal strain out of the plane, shape (n,)."""
        return self._step.scalars("out_of_plane_strain")

    @cached_property
    def von_mises(self) -> np.ndarray:
        """Shape (n,) [stress]."""
        return self._step.scalars("von_mises")

    @cached_property
    def error_indicator(self) -> np.ndarray:
        """Difference between stress and smoothed stress in the energy norm, shape (n,)."""
        return self._step.scalars("error_indicator")

    @cached_property
    def nodes(self) -> np.ndarray:
        """Positions of the nodes, shape (n_nodes, 2) [length]."""
        return self._step.vectors("nodes")

    @cached_property
    def support_radii(self) -> np.ndarray:
        """Of the nodes, shape (n_nodes,) [length]."""
        return self._step.scalars("support_radii")

    @cached_property
    def nodal_parameters(self) -> np.ndarray:
        """Of the displacement, shape (n_nodes, 2) [length]; not its values at the nodes."""
        return self._step.vectors("nodal_parameters")

    def opening(self, crack: Union[int, str] = 0) -> tuple[np.ndarray, np.ndarray]:
        """Points along a crack, and the displacement of its left face less that of its right one.

        Both of shape (n, 2) [length].
        """
        names = [c["name"] for c in self.record["cracks"]]
        points, left, right = self._step.crack_faces(crack if isinstance(crack, int) else names.index(crack))
        return points, left - right

    @cached_property
    def _approximation(self) -> _riss.Approximation:
        return self._step.approximation()

    def displacement_at(self, points: Any, sights: Any = None) -> np.ndarray:
        """Displacement at any points, shape (n, 2) [length]; not a number outside the body.

        ``sights``: from where the points see, slightly beside them; says which face of a crack is meant for points on
        one.
        """
        return self._at(points, sights)[0]

    def displacement_gradient_at(self, points: Any, sights: Any = None) -> np.ndarray:
        """``du_i/dx_j`` at any points, shape (n, 2, 2)."""
        return self._at(points, sights)[1]

    def stress_at(self, points: Any, sights: Any = None) -> np.ndarray:
        """Stress in the plane at any points, shape (n, 2, 2) [stress]."""
        return self._at(points, sights)[2]

    def _at(self, points: Any, sights: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return self._approximation.evaluate(_rows(points), None if sights is None else _rows(sights))

    def shape_functions(self, x: float, y: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Nodes that act on a point, the values of their shape functions (n,) and the gradients (n, 2) [1/length]."""
        return self._approximation.shape_functions(float(x), float(y))

    def to_pyvista(self) -> pyvista.UnstructuredGrid:
        """The body with all fields."""
        import pyvista

        cells = np.insert(self.triangles, 0, 3, axis=1).astype(np.int64)
        kinds = np.full(len(cells), pyvista.CellType.TRIANGLE, dtype=np.uint8)
        grid = pyvista.UnstructuredGrid(cells.ravel(), kinds, _in_space(self.points))
        for name, values in self._point_data().items():
            grid.point_data[name] = values
        return grid

    def to_meshio(self) -> meshio.Mesh:
        """The body with all fields."""
        import meshio

        cells = [("triangle", self.triangles.astype(np.int64))]
        return meshio.Mesh(_in_space(self.points), cells, point_data=self._point_data())

    def _point_data(self) -> dict[str, np.ndarray]:
        """Names as in the files for ParaView."""
        return {
            "displacement": _in_space(self.displacement),
            "stress": _tensor_in_space(self.stress, self.out_of_plane_stress),
            "strain": _tensor_in_space(self.strain, self.out_of_plane_strain),
            "von_mises": self.von_mises,
            "error_indicator": self.error_indicator,
        }

    def __repr__(self) -> str:
        return f"<riss.Step {self.number}: {len(self.tips)} tips, {self.record['nodes']} nodes>"


class Run(Loaded):
    """All steps of a run.

    Of cohesive cracks about ten states of loading, with the numbers of their points on the load curve.
    """

    def __init__(self) -> None:
        self.record: dict[str, Any] = {}
        self.steps: list[Step] = []
        #: What deserved a second look, over all steps.
        self.warnings: list[str] = []

    @property
    def last(self) -> Step:
        """The last step."""
        return self.steps[-1]

    @property
    def end(self) -> Optional[dict[str, Any]]:
        """Why growth or loading ended: ``kind`` and ``reason``."""
        loading = self.record.get("loading")
        if loading is not None:
            return loading["end"]
        return self.last.end if self.steps else None

    def tip(self, crack: Union[None, int, str] = None, end: Optional[str] = None) -> dict[str, Any]:
        """A tip in the last step, see :meth:`Step.tip`."""
        return self.last.tip(crack, end)

    def path(self, crack: Union[int, str] = 0) -> np.ndarray:
        """Vertices of a crack in the last step, shape (n, 2) [length]."""
        return self.last.path(crack)

    def history(self, crack: Optional[str] = None, end: Optional[str] = None) -> dict[str, np.ndarray]:
        """The columns of ``history.csv``, one row for each step and tip, or only those of one crack or end.

        Unknown numbers are NaN. ``a`` is the length of the path.
        """
        text = _riss.history_csv([s._step for s in self.steps])
        rows = list(csv.DictReader(io.StringIO(text)))
        rows = [r for r in rows if crack in (None, r["crack"]) and end in (None, r["end"])]
        header = next(csv.reader(io.StringIO(text)))
        return {name: _column([row[name] for row in rows], name) for name in header}

    def to_pandas(self) -> pandas.DataFrame:
        """Cohesive cracks: the load curve. Else :meth:`history` as a table."""
        import pandas

        if self.load_curve:
            return pandas.DataFrame(self.load_curve).astype({"step": int})
        return pandas.DataFrame(self.history())

    def __repr__(self) -> str:
        return f"<riss.Run of {len(self.steps)} steps>"


def _column(values: list[str], name: str) -> np.ndarray:
    if name in ("crack", "end", "status"):
        return np.array(values, dtype=object)
    if name == "step":
        return np.array(values, dtype=np.int64)
    return np.array([float(v) if v else np.nan for v in values])


def _rows(points: Any) -> np.ndarray:
    return np.ascontiguousarray(np.atleast_2d(np.asarray(points, dtype=np.float64)))


def _in_space(vectors: np.ndarray) -> np.ndarray:
    return np.column_stack([vectors, np.zeros(len(vectors))])


def _tensor_in_space(tensors: np.ndarray, out_of_plane: np.ndarray) -> np.ndarray:
    """As xx, yy, zz, xy, yz, xz."""
    zero = np.zeros(len(tensors))
    return np.column_stack([tensors[:, 0, 0], tensors[:, 1, 1], out_of_plane, tensors[:, 0, 1], zero, zero])
