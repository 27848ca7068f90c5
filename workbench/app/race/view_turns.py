"""Drawing many views in turns: each picture in a pass of its own, with a rest for the mouse in between."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, QTimer

LEAST_REST = 2
"""Milliseconds between two pictures at least."""
REST_FACTOR = 0.1
"""Rest after a picture, as a part of the time that it took."""


class ViewTurns(QObject):
    """Draws the views that are behind, one after the other; newer maps of one that waits cost nothing more.

    `draw(index)` draws a view and returns the seconds that took.
    """

    def __init__(self, draw: Callable[[int], float], parent: QObject) -> None:
        super().__init__(parent)
        self._draw = draw
        self._stale: list[int] = []
        self.counts: dict[int, int] = {}
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.timeout.connect(self._turn)

    def make_stale(self, index: int) -> None:
        """This view is behind."""
        if index not in self._stale:
            self._stale.append(index)
        if not self._timer.isActive():
            self._timer.start(LEAST_REST)

    def stop(self) -> None:
        self._timer.stop()
        self._stale.clear()

    def _turn(self) -> None:
        index = self._stale.pop(0)
        seconds = self._draw(index)
        self.counts[index] = self.counts.get(index, 0) + 1
        if self._stale:
            self._timer.start(max(LEAST_REST, round(1e3 * REST_FACTOR * seconds)))
