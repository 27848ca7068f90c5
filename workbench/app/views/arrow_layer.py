"""Arrows over a view: a direction at vertices that are spread evenly over the picture."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QEvent, QObject, QPointF, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QWidget

from workbench.app.views.mesh_view import MeshView
from workbench.core.arrays import Floats, Integers

SPACING = 20.0
"""Pixels between two arrows at least."""
LONGEST = 64.0
"""Pixels of the longest arrow."""
HEAD = 6.0


class ArrowLayer(QWidget):
    """Transparent widget above the layer of anchors; the mouse does not see it."""

    def __init__(self, view: MeshView) -> None:
        super().__init__(view)
        self._view = view
        self._points: Floats = np.empty((0, 3))
        self._vectors: Floats = np.empty((0, 3))
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setAttribute(Qt.WidgetAttribute.WA_NoSystemBackground)
        view.installEventFilter(self)
        view.camera_changed.connect(self.update)

    def show_arrows(self, points: Floats, vectors: Floats) -> None:
        """One arrow a point: both (n, 3), in units of the display."""
        self._points, self._vectors = points, vectors
        self.update()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Resize:
            self.setGeometry(self._view.rect())
            self.raise_()
        return False

    def paintEvent(self, event: QPaintEvent) -> None:
        if not len(self._points):
            return
        begins = self._view.project(self._points)
        ways = self._view.project(self._points + self._vectors) - begins
        lengths = np.hypot(*ways.T)
        most = float(lengths.max(initial=0.0))
        if not (most > 0 and np.isfinite(most)):
            return
        ways = ways * (LONGEST / most)
        rows = spread(begins, lengths, SPACING)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        colour = QColor(self._view.theme.accent)
        for row in rows.tolist():
            _paint(painter, QPointF(*begins[row]), ways[row], colour, QColor(self._view.theme.view))
        painter.end()


def spread(pixels: Floats, lengths: Floats, spacing: float) -> Integers:
    """Rows (k,) of pixels (n, 2): of each cell of a grid the one with the longest arrow."""
    cells = np.floor(pixels / spacing).astype(np.int64)
    order = np.argsort(-lengths, kind="stable")
    _, first = np.unique(cells[order], axis=0, return_index=True)
    return np.sort(order[first])


def _paint(painter: QPainter, begin: QPointF, way: Floats, colour: QColor, casing: QColor) -> None:
    length = float(np.hypot(*way))
    if length < 1.5:
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colour)
        painter.drawEllipse(begin, 1.2, 1.2)
        return
    unit = way / length
    end = begin + QPointF(*way)
    head = min(HEAD, 0.5 * length)
    neck = end - QPointF(*(head * unit))
    side = QPointF(-unit[1] * 0.5 * head, unit[0] * 0.5 * head)
    for pen in (QPen(casing, 3.6), QPen(colour, 1.5)):  # seen on every colour
        painter.setPen(pen)
        painter.drawLine(begin, neck)
    painter.setPen(QPen(casing, 0.8))
    painter.setBrush(colour)
    painter.drawPolygon(QPolygonF([end, neck + side, neck - side]))
