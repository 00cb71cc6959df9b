"""How cohesive cracks were loaded."""

from __future__ import annotations

from functools import cached_property
from typing import Any, Optional

import numpy as np


class Loaded:
    """What runs with cohesive cracks have, in the plane and in space."""

    #: Of cohesive cracks ``loading`` and ``load_curve`` of ``results.json``; of solids all of it.
    record: dict[str, Any]

    @cached_property
    def load_curve(self) -> dict[str, np.ndarray]:
        """Columns of ``load_curve.csv``, from rest: ``step``, ``load_factor``, ``displacement``, ``load``, energies.

        Empty without cohesive cracks.
        """
        points = self.record.get("load_curve") or []
        return {} if not points else {name: np.array([p[name] for p in points], dtype=float) for name in points[0]}

    @property
    def peak(self) -> Optional[dict[str, float]]:
        """The point of the load curve with the greatest load; none without cohesive cracks."""
        loading = self.record.get("loading")
        return None if loading is None else loading["peak"]

    @property
    def dissipated_energy(self) -> Optional[float]:
        """By cohesive cracks until the end [stress·length³]; none without."""
        loading = self.record.get("loading")
        return None if loading is None else loading["dissipated_energy"]
