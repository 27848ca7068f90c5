"""Dragging across a plot: a range of its abscissa, shown as a band while the hand moves."""

from __future__ import annotations

import pyqtgraph as pg
from PySide6.QtCore import QEvent, QObject, QPointF, Qt, Signal
from PySide6.QtGui import QColor, QMouseEvent

from workbench.app.appearance.theme import Theme

SLACK = 3.0
"""Pixels that the hand may move in a click."""


class BinBrush(QObject):
    """Left drag over a `PlotWidget`: `dragged` carries the two ends, ascending, at each move; `clicked` a mere click."""

    dragged = Signal(float, float)
    clicked = Signal()

    def __init__(self, plot: pg.PlotWidget) -> None:
        super().__init__(plot)
        self._plot = plot
        self._begin: QPointF | None = None
        self._has_moved = False
        self._band = pg.LinearRegionItem(movable=False)
        self._band.setZValue(-10)
        self._band.hide()
        plot.addItem(self._band)
        plot.viewport().installEventFilter(self)
        plot.viewport().setCursor(Qt.CursorShape.CrossCursor)

    def set_theme(self, theme: Theme) -> None:
        colour = QColor(theme.accent)
        colour.setAlpha(55)
        self._band.setBrush(colour)
        for line in self._band.lines:
            line.setPen(pg.mkPen(theme.accent))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if not isinstance(event, QMouseEvent):
            return False
        kind, is_left = event.type(), event.button() == Qt.MouseButton.LeftButton
        if kind == QEvent.Type.MouseButtonPress and is_left:
            self._begin, self._has_moved = event.position(), False
        elif kind == QEvent.Type.MouseMove and self._begin is not None:
            self._move(event.position())
        elif kind == QEvent.Type.MouseButtonRelease and is_left and self._begin is not None:
            self._begin = None
            self._band.hide()
            if not self._has_moved:
                self.clicked.emit()
        else:
            return False
        return True

    def _move(self, where: QPointF) -> None:
        assert self._begin is not None
        if not self._has_moved and abs(where.x() - self._begin.x()) < SLACK:
            return
        self._has_moved = True
        low, high = sorted((self._abscissa(self._begin), self._abscissa(where)))
        self._band.setRegion((low, high))
        self._band.show()
        self.dragged.emit(low, high)

    def _abscissa(self, where: QPointF) -> float:
        scene = self._plot.mapToScene(where.toPoint())
        return float(self._plot.getPlotItem().getViewBox().mapSceneToView(scene).x())
