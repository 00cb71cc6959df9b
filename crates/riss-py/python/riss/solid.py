"""What a run of a solid finds: fronts, cracks, fields."""

from __future__ import annotations

import json
from functools import cached_property
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from . import _riss

if TYPE_CHECKING:
    import pandas
    import pyvista


class SolidRun:
    """A solved solid: its record, and its fields at nodes as arrays."""

    def __init__(self, solid: _riss.Solid, warnings: list[str]) -> None:
        self._solid = solid
        #: What deserves a second look.
        self.warnings = warnings

    @cached_property
    def record(self) -> dict[str, Any]:
        """The content of ``results.json``."""
        return json.loads(self._solid.record_json())

    @property
    def fronts(self) -> list[dict[str, Any]]:
        """Every front with the keys of ``results.json``: its ``crack``, ``closed``, ``length`` and ``points``."""
        return self.record["fronts"]

    def front(self, index: int = 0) -> dict[str, np.ndarray]:
        """Columns along a front: ``s``, ``position`` (n, 3), ``K_I`` and so on; what is not known is NaN."""
        points = self.fronts[index]["points"]
        return {name: np.array([p[name] for p in points], dtype=float) for name in points[0]}

    def to_pandas(self) -> pandas.DataFrame:
        """Points of all fronts as a table, with the name of the ``crack`` and the index of the ``front``."""
        import pandas

        rows = []
        for index, front in enumerate(self.fronts):
            for point in front["points"]:
                x, y, z = point["position"]
                numbers = {k: v for k, v in point.items() if k not in ("position", "ahead", "normal")}
                rows.append({"crack": front["crack"], "front": index, "x": x, "y": y, "z": z, **numbers})
        return pandas.DataFrame(rows)

    @cached_property
    def nodes(self) -> np.ndarray:
        """Their positions, shape (n, 3) [length]; nodes on a crack come once for each face."""
        return self._solid.vectors("nodes")

    @cached_property
    def displacement(self) -> np.ndarray:
        """At the nodes, shape (n, 3) [length]."""
        return self._solid.vectors("displacement")

    @cached_property
    def stress(self) -> np.ndarray:
        """At the nodes, shape (n, 3, 3) [stress]."""
        return self._solid.stress()

    def opening(self, crack: Union[int, str] = 0) -> tuple[np.ndarray, np.ndarray]:
        """Points of a crack, and the displacement of its positive face less that of the other.

        Both of shape (n, 3) [length]; points of fronts, where the opening is zero, come last.
        """
        points, openings = self._solid.crack(self._index(crack))
        return points, openings

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

    def crack_to_pyvista(self, crack: Union[int, str] = 0) -> pyvista.PolyData:
        """A crack as triangles, with its opening."""
        import pyvista

        points, openings = self.opening(crack)
        triangles = self._solid.crack_triangles(self._index(crack))
        surface = pyvista.PolyData(points, np.insert(triangles, 0, 3, axis=1).astype(np.int64).ravel())
        surface.point_data["opening"] = openings
        return surface

    def __repr__(self) -> str:
        return f"<riss.SolidRun: {len(self.fronts)} fronts, {self.record['nodes']} nodes>"
