"""Crack propagation in solids with meshfree methods.

>>> import riss
>>> case = riss.Case(
...     material={"young": 210e3, "poisson": 0.3, "plane": "strain"},
...     geometry={"rectangle": {"lower": [0, -100], "upper": [100, 100]}},
...     crack=[{"path": [[0, 0], [30, 0]]}],
...     remote_stress={"yy": 80},
...     rigid_motion="mean-is-zero",
... )
>>> run = case.run()
>>> run.tip()["K_I"]  # doctest: +SKIP
1275.3...

The sections of a case, their keys and the keys of a tip are those of the case file and of ``results.json``.
"""

from __future__ import annotations

from . import plot
from ._riss import AnalysisError, CaseError, __version__
from .case import Case, SolidCase, read, schema
from .results import Run, State, Step
from .solid import SolidRun, SolidStep

__all__ = [
    "AnalysisError",
    "Case",
    "CaseError",
    "Run",
    "SolidCase",
    "SolidRun",
    "SolidStep",
    "State",
    "Step",
    "__version__",
    "plot",
    "read",
    "schema",
]
