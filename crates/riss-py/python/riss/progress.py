"""A progress bar, where one can be seen."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any, Optional, Union

if TYPE_CHECKING:
    from .case import Case, SolidCase


class Progress:
    """Shows steps and stages with tqdm, if that is there."""

    def __init__(self, case: Union[Case, SolidCase], shows: Optional[bool]) -> None:
        self._bar: Any = None
        if shows is False or (shows is None and not _is_seen()):
            return
        try:
            from tqdm.auto import tqdm
        except ImportError:
            if shows:
                raise ImportError("a progress bar needs tqdm: pip install 'riss[progress]'") from None
            return
        growth_steps = case._case.growth_steps
        total: Optional[int] = 1 if growth_steps is None else growth_steps + 1
        if getattr(case._case, "is_loaded", False):
            total = None
        self._bar = tqdm(total=total, desc=case.title, unit="step")

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *_: Any) -> None:
        if self._bar is not None:
            self._bar.close()

    def stage(self, name: str) -> None:
        """A stage begins."""
        if self._bar is not None:
            self._bar.set_postfix_str(name)

    def step(self) -> None:
        """A step is done."""
        if self._bar is not None:
            self._bar.update()


def _is_seen() -> bool:
    return sys.stderr.isatty() or "ipykernel" in sys.modules
