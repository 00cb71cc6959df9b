"""Cases: what is to be analyzed."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, Callable, Mapping, Optional, Union

from . import _riss
from ._riss import CaseError
from .progress import Progress
from .results import Run, State, Step
from .solid import SolidRun, SolidStep

StepCallback = Callable[[Step], Union[None, bool, "Case"]]
SolidStepCallback = Callable[[SolidStep], Union[None, bool, "SolidCase"]]


def schema(method: str = "element-free-galerkin") -> dict[str, Any]:
    """The JSON Schema of the case file of a method; bodies in the plane share one, ``"collocation"`` has its own."""
    return json.loads(_riss.solid_schema() if method == "collocation" else _riss.schema())


class _Written:
    """What cases of all methods share: their text, and what is worth knowing of it."""

    _case: Union[_riss.Case, _riss.SolidCase]

    @property
    def title(self) -> str:
        """Its title, or its name."""
        return self._case.title

    @property
    def text(self) -> str:
        """The text of the case file."""
        return self._case.text

    @property
    def notes(self) -> list[str]:
        """What is worth knowing, although the case is valid."""
        return self._case.notes

    def __repr__(self) -> str:
        return f"<riss.{type(self).__name__} {self.title!r}>"


class Case(_Written):
    """A valid case of a body in the plane.

    ``Case(**sections)`` takes the sections of a case file as keywords: dicts for tables, lists of dicts for ``crack``,
    ``load``, ``support`` and the like. NumPy arrays and numbers are welcome. Files that it names are sought in
    ``folder``.

    Raises :class:`CaseError` with all problems at once.
    """

    _case: _riss.Case

    def __init__(self, *, folder: Union[str, os.PathLike[str]] = ".", **sections: Any) -> None:
        self._case = _riss.Case.from_json(_json(sections), Path(folder) / "case.toml")

    @classmethod
    def read(cls, path: Union[str, os.PathLike[str]], set: Optional[Mapping[str, Any]] = None) -> Case:
        """The case in a file; ``set`` overrides keys, such as ``{"material.young": 70e9}``."""
        return cls._of(_riss.Case.read(Path(path), _overrides(set)))

    @classmethod
    def parse(
        cls, text: str, path: Union[str, os.PathLike[str]] = "case.toml", set: Optional[Mapping[str, Any]] = None
    ) -> Case:
        """The case in a text; files that it names are sought beside ``path``."""
        return cls._of(_riss.Case.parse(text, Path(path), _overrides(set)))

    @classmethod
    def _of(cls, case: _riss.Case) -> Case:
        self = cls.__new__(cls)
        self._case = case
        return self

    def override(self, set: Mapping[str, Any]) -> Case:
        """The same case with other values of some keys, such as ``{"growth.increment": 0.5}``."""
        overrides = self._case.overrides + _overrides(set)
        return self._of(_riss.Case.parse(self._case.text, self._case.path, overrides))

    def run(
        self,
        *,
        out: Union[None, str, os.PathLike[str]] = None,
        on_step: Optional[StepCallback] = None,
        progress: Optional[bool] = None,
        start: Optional[State] = None,
        threads: Optional[int] = None,
    ) -> Run:
        """Runs the case to its end.

        ``out``: a folder for the files that ``riss run`` writes; none are written by default.

        ``on_step``: called with each :class:`Step` when it is done. ``False`` ends the run there. A :class:`Case` takes
        over from the next step on: its loads, materials and settings, with the cracks as they have grown. Anything else
        goes on. With cohesive cracks the curve is followed first; ``False`` then wants no more of its states with
        fields.

        ``progress``: a progress bar; by default where a terminal or a notebook shows it.

        ``start``: a state to go on from, such as ``step.state``, with that step solved again.

        ``threads``: their number, by default all cores. Results do not depend on it.

        Ctrl-C ends the run after the step at hand; what was written is complete. A second one does not wait.

        Raises :class:`AnalysisError` if the first step cannot be solved. A later one that cannot ends the growth, and
        ``Run.end`` says why.
        """
        run = Run()
        case: Optional[Case] = self
        while case is not None:
            relay = _Relay(run.steps, on_step, Case)
            with Progress(case, progress) as shown:

                def done(step: _riss.Step) -> bool:
                    goes_on = relay.step(Step(step))
                    shown.step()
                    return goes_on

                state = None if start is None else start._state
                folder = None if out is None else Path(out)
                text = _riss.run(case._case, state, folder, threads, shown.stage, run.warnings.append, done)
                run.record = {} if text is None else json.loads(text)
            case, start = relay.successor, relay.state
        return run


class SolidCase(_Written):
    """A valid case of a solid in space (``method="collocation"``).

    ``SolidCase(**sections)`` takes the sections of a case file as keywords, as :class:`Case` does; the method is added.

    Raises :class:`CaseError` with all problems at once.
    """

    _case: _riss.SolidCase

    def __init__(self, *, folder: Union[str, os.PathLike[str]] = ".", **sections: Any) -> None:
        text = _json({"method": "collocation", **sections})
        self._case = self._known(_riss.SolidCase.from_json(text, Path(folder) / "case.toml"))

    @classmethod
    def read(cls, path: Union[str, os.PathLike[str]], set: Optional[Mapping[str, Any]] = None) -> SolidCase:
        """The case in a file; ``set`` overrides keys, such as ``{"nodes.spacing": 0.5}``."""
        return cls._of(_riss.SolidCase.read(Path(path), _overrides(set)))

    @classmethod
    def parse(
        cls, text: str, path: Union[str, os.PathLike[str]] = "case.toml", set: Optional[Mapping[str, Any]] = None
    ) -> SolidCase:
        """The case in a text; files that it names are sought beside ``path``."""
        return cls._of(_riss.SolidCase.parse(text, Path(path), _overrides(set)))

    @staticmethod
    def _known(case: Optional[_riss.SolidCase]) -> _riss.SolidCase:
        if case is None:
            raise CaseError("this is a case of a body in the plane; riss.Case reads it")
        return case

    @classmethod
    def _of(cls, case: Optional[_riss.SolidCase]) -> SolidCase:
        self = cls.__new__(cls)
        self._case = cls._known(case)
        return self

    def override(self, set: Mapping[str, Any]) -> SolidCase:
        """The same case with other values of some keys, such as ``{"nodes.spacing": 0.5}``."""
        overrides = self._case.overrides + _overrides(set)
        return self._of(_riss.SolidCase.parse(self._case.text, self._case.path, overrides))

    def run(
        self,
        *,
        out: Union[None, str, os.PathLike[str]] = None,
        on_step: Optional[SolidStepCallback] = None,
        progress: Optional[bool] = None,
        start: Optional[State] = None,
        threads: Optional[int] = None,
    ) -> SolidRun:
        """Runs the case to its end; the keywords are those of :meth:`Case.run`.

        ``on_step`` gets each :class:`SolidStep`. Where cracks grow, ``False`` ends the run there, and a
        :class:`SolidCase` with as many cracks takes over from the next step on, with the cracks as they have grown.
        Under load, the curve is followed first; ``False`` then wants no more of its states with fields.

        Ctrl-C ends growth after the step at hand; what was written is complete. Other runs end without a result. A
        second one does not wait.

        Raises :class:`AnalysisError` if the first step cannot be solved. A later one that cannot ends the growth, and
        ``SolidRun.end`` says why.
        """
        run = SolidRun()
        case: Optional[SolidCase] = self
        while case is not None:
            relay = _Relay(run.steps, on_step, SolidCase)
            with Progress(case, progress) as shown:

                def done(step: _riss.SolidStep) -> bool:
                    goes_on = relay.step(SolidStep(step))
                    shown.step()
                    return goes_on

                state = None if start is None else start._state
                folder = None if out is None else Path(out)
                warn = run.warnings.append
                text = _riss.run_solid(case._case, state, folder, threads, shown.stage, warn, done)
                run.record = json.loads(text)
                if folder is None and run.record["steps"]:
                    # Those of cases that others took over from are known here alone.
                    run.record["steps"] = [step.record for step in run.steps]
            case, start = relay.successor, relay.state
        return run


def read(path: Union[str, os.PathLike[str]], set: Optional[Mapping[str, Any]] = None) -> Union[Case, SolidCase]:
    """The case in a file: a :class:`SolidCase` if its method is ``"collocation"``, else a :class:`Case`."""
    solid = _riss.SolidCase.read(Path(path), _overrides(set))
    return Case.read(path, set) if solid is None else SolidCase._of(solid)


class _Relay:
    """Keeps steps, and what the callback wants."""

    def __init__(self, steps: list[Any], on_step: Optional[Callable[[Any], Any]], kind: type) -> None:
        self.steps = steps
        self.on_step = on_step
        self.kind = kind
        self.wanted: Any = None
        self.successor: Any = None
        self.state: Optional[State] = None

    def step(self, step: Any) -> bool:
        if self.wanted is not None:
            # The step after the change: its cracks stand, all else is for the other case to find.
            self.successor, self.state = self.wanted, step.state
            return False
        self.steps.append(step)
        answer = self.on_step(step) if self.on_step is not None else None
        if isinstance(answer, self.kind):
            if step.state is None:
                raise ValueError("no other case can take over: the cracks of this one do not grow")
            self.wanted = answer
        return answer is not False


def _overrides(set: Optional[Mapping[str, Any]]) -> list[str]:
    return [f"{key}={_inline(value)}" for key, value in (set or {}).items()]


def _json(sections: Mapping[str, Any]) -> str:
    return json.dumps(sections, default=_plain)


def _inline(value: Any) -> str:
    """A value as TOML writes it on one line; strings and numbers are as in JSON."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(key)} = {_inline(item)}" for key, item in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(_inline, value)) + "]"
    if isinstance(value, (str, bool, int, float)):
        return json.dumps(value, ensure_ascii=False)
    return _inline(_plain(value))


def _plain(value: Any) -> Any:
    """What NumPy holds, as plain lists and numbers."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"a case cannot hold a {type(value).__name__}: {value!r}")
