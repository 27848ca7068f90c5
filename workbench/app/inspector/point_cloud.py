"""Many points in a plot, drawn at once."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyqtgraph as pg
from pyqtgraph.functions import arrayToQPolygonF
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from workbench.core.arrays import Floats


class PointCloud(pg.GraphicsObject):  # type: ignore[misc]
    """Round points of one size in pixels, with a rim or without, in coordinates of the plot."""

    def __init__(self, size: float, z: float) -> None:
        super().__init__()
        self.places: Floats = np.empty((0, 2))
        self._polygon: Any = None
        self._size = size
        self._colour = QColor("#000000")
        self._rim: QColor | None = None
        self.setZValue(z)

    def set_colours(self, colour: QColor, rim: QColor | None) -> None:
        self._colour, self._rim = colour, rim
        self.update()

    def set_places(self, places: Floats) -> None:
        """Points (k, 2)."""
        self.prepareGeometryChange()
        self.places = np.ascontiguousarray(places, dtype=np.float64)
        self._polygon = arrayToQPolygonF(self.places[:, 0], self.places[:, 1]) if len(places) else None
        self.update()

    def boundingRect(self) -> QRectF:
        if not len(self.places):
            return QRectF()
        (left, bottom), (right, top) = self.places.min(axis=0), self.places.max(axis=0)
        return QRectF(left, bottom, right - left, top - bottom)

    def paint(self, painter: QPainter, *_: Any) -> None:
        if self._polygon is None:
            return
        cap = Qt.PenCapStyle.RoundCap if len(self.places) < 3000 else Qt.PenCapStyle.SquareCap
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, len(self.places) < 3000)
        for colour, width in ((self._rim, self._size + 2.0), (self._colour, self._size)):
            if colour is None:
                continue
            pen = QPen(colour, width)
            pen.setCosmetic(True)
            pen.setCapStyle(cap)
            painter.setPen(pen)
            painter.drawPoints(self._polygon)
