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

import os
from typing import Any, Mapping, Optional, Union

from . import plot
from ._riss import AnalysisError, CaseError, __version__
from .case import Case, schema
from .results import Run, State, Step

__all__ = ["AnalysisError", "Case", "CaseError", "Run", "State", "Step", "__version__", "plot", "read", "schema"]


def read(path: Union[str, os.PathLike[str]], set: Optional[Mapping[str, Any]] = None) -> Case:
    """The case in a file; the same as :meth:`Case.read`."""
    return Case.read(path, set=set)
