"""One line that tells how far a run is, in a terminal and in a notebook."""

from __future__ import annotations

import sys
import time
from types import TracebackType

from workbench.core.run import HistoryRow
from workbench.io.tables import number

INTERVAL = 0.2
"""Seconds between two states of the line."""


class ProgressLine:
    """Writes over itself on standard output; silent where that is a file, and where it is told so."""

    def __init__(self, is_wanted: bool = True) -> None:
        self._is_shown = is_wanted and (sys.stdout.isatty() or "ipykernel" in sys.modules)
        self._told = time.perf_counter()
        self._length = 0

    def __call__(self, row: HistoryRow) -> None:
        """A row of the history is there."""
        now = time.perf_counter()
        if self._is_shown and now - self._told >= INTERVAL:
            self._told = now
            words = f"iteration {row.iteration}  energy {number(row.energy, 9)}  inverted {row.inverted}"
            self._write(f"{words}  {row.seconds:.1f} s")

    def __enter__(self) -> ProgressLine:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if self._length:
            self._write("")
            print("\r", end="", flush=True)

    def _write(self, words: str) -> None:
        print("\r" + words.ljust(self._length), end="", flush=True)
        self._length = len(words)
