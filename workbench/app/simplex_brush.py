"""The simplices that are pointed at, in whatever view: one set for the whole window."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from PySide6.QtCore import QObject, Signal

from workbench.core.arrays import Integers


class SimplexBrush(QObject):
    """A set of simplices and who chose it; every view that shows simplices marks them."""

    changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._simplices: Integers = np.empty(0, np.int64)
        self._origin = ""

    @property
    def simplices(self) -> Integers:
        """(k,) int64, ascending, without repeats; empty when nothing is brushed."""
        return self._simplices

    @property
    def origin(self) -> str:
        """Name of the view that chose them, empty when nothing is brushed."""
        return self._origin

    def brush(self, simplices: ArrayLike, origin: str) -> None:
        """Choose these simplices, in place of those before."""
        chosen = np.unique(np.asarray(simplices, dtype=np.int64).ravel())
        origin = origin if len(chosen) else ""
        if origin == self._origin and np.array_equal(chosen, self._simplices):
            return
        chosen.flags.writeable = False
        self._simplices, self._origin = chosen, origin
        self.changed.emit()

    def clear(self) -> None:
        self.brush((), "")
