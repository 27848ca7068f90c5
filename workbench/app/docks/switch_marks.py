"""Marks of switches across plots with one abscissa: a line where each was, and a tip that says what it was."""

from __future__ import annotations

from collections.abc import Iterable

import pyqtgraph as pg
from PySide6.QtCore import QEvent, QObject, QPointF, Qt
from PySide6.QtGui import QHelpEvent
from PySide6.QtWidgets import QToolTip

from workbench.app.appearance.theme import Theme
from workbench.app.document.switches import Switch

MOST = 40
"""Lines in a plot; of more switches the newest are shown."""
REACH = 6.0
"""Pixels from a line within which the pointer means it."""


class SwitchMarks(QObject):
    """Dashed lines in every plot of a view; they stand for good and are moved and hidden."""

    def __init__(self, view: pg.GraphicsView, plots: Iterable[pg.PlotItem]) -> None:
        super().__init__(view)
        self._view = view
        self._lines: list[tuple[pg.PlotItem, list[pg.InfiniteLine]]] = [(plot, []) for plot in plots]
        self._pen = pg.mkPen(None)
        self._shown: list[tuple[float, str]] = []
        view.viewport().installEventFilter(self)

    def set_theme(self, theme: Theme) -> None:
        self._pen = pg.mkPen(theme.faint, width=1, style=Qt.PenStyle.DashLine)
        for _, lines in self._lines:
            for line in lines:
                line.setPen(self._pen)

    def show(self, switches: Iterable[Switch], abscissa: str) -> None:
        """Mark these; `abscissa` is iteration or seconds."""
        self._shown = [(float(getattr(switch, abscissa)), switch.sentence) for switch in switches][-MOST:]
        for plot, lines in self._lines:
            while len(lines) < len(self._shown):
                line = pg.InfiniteLine(0.0, angle=90, pen=self._pen)
                plot.addItem(line, ignoreBounds=True)
                lines.append(line)
            for index, line in enumerate(lines):
                line.setVisible(index < len(self._shown))
                if index < len(self._shown):
                    line.setValue(self._shown[index][0])

    def sentence_at(self, where: QPointF) -> str:
        """What was switched near a place of the view, in pixels; empty where nothing was."""
        scene = self._view.mapToScene(where.toPoint())
        for plot, _ in self._lines:
            box = plot.getViewBox()
            if not box.sceneBoundingRect().contains(scene):
                continue
            near = []
            for place, sentence in self._shown:
                distance = abs(box.mapViewToScene(QPointF(place, 0.0)).x() - scene.x())
                if distance <= REACH:
                    near.append((distance, sentence))
            return min(near)[1] if near else ""
        return ""

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() != QEvent.Type.ToolTip or not isinstance(event, QHelpEvent):
            return False
        sentence = self.sentence_at(QPointF(event.pos()))
        if not sentence:
            QToolTip.hideText()
            return False
        QToolTip.showText(event.globalPos(), sentence, self._view.viewport())
        return True
