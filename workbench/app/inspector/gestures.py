"""What the mouse does in the plane plot: choose points with a rectangle or a lasso, click, zoom, pan."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Qt, Signal

from workbench.core.arrays import Booleans, Floats

LASSO_STEP = 4.0
"""Pixels between two corners of a lasso."""


class ChoosingBox(pg.ViewBox):  # type: ignore[misc]
    """Left drag draws an outline, the right and middle button pan, the wheel zooms; a double click asks for all.

    `outlined` carries corners (k, 2) in coordinates of the plot and whether the hand has let go.
    """

    outlined = Signal(object, bool)
    clicked = Signal(float, float)
    double_clicked = Signal()

    def __init__(self) -> None:
        super().__init__(enableMenu=False)
        self.is_lasso = False
        self._corners: list[tuple[float, float]] = []
        self._last: Any = None

    def mouseDragEvent(self, event: Any, axis: int | None = None) -> None:
        if event.button() != Qt.MouseButton.LeftButton:
            self._pan(event)
            return
        event.accept()
        if event.isStart():
            self._corners = [self._place(event.buttonDownPos())]
            self._last = event.buttonDownPos()
        here = self._place(event.pos())
        if not self.is_lasso:
            (x0, y0), (x1, y1) = self._corners[0], here
            outline = np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
        else:
            if (event.pos() - self._last).manhattanLength() >= LASSO_STEP:
                self._corners.append(here)
                self._last = event.pos()
            outline = np.array([*self._corners, here])
        self.outlined.emit(outline, bool(event.isFinish()))

    def mouseClickEvent(self, event: Any) -> None:
        if event.button() != Qt.MouseButton.LeftButton:
            return
        event.accept()
        if event.double():
            self.double_clicked.emit()
        else:
            self.clicked.emit(*self._place(event.pos()))

    def _pan(self, event: Any) -> None:
        event.accept()
        here, before = self.mapToView(event.pos()), self.mapToView(event.lastPos())
        self.translateBy(x=before.x() - here.x(), y=before.y() - here.y())
        self.sigRangeChangedManually.emit(self.state["mouseEnabled"])

    def _place(self, pixel: Any) -> tuple[float, float]:
        point = self.mapToView(pixel)
        return float(point.x()), float(point.y())


def inside(points: Floats, outline: Floats) -> Booleans:
    """Which of the points (m, 2) lie within a closed outline (k, 2), by the even-odd rule. Cost: O(m k)."""
    low, high = outline.min(axis=0), outline.max(axis=0)
    found = ((points >= low) & (points <= high)).all(axis=1)
    near = np.flatnonzero(found)
    x, y = points[near].T
    odd = np.zeros(len(near), dtype=bool)
    for (x0, y0), (x1, y1) in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        if y0 == y1:
            continue
        crosses = (y0 > y) != (y1 > y)
        odd ^= crosses & (x < x0 + (y - y0) * ((x1 - x0) / (y1 - y0)))
    found[near] = odd
    return found
