"""Live histogram of the average singular value (78)."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QDockWidget, QWidget

from workbench.app.docks.plots import calm, paint_axes
from workbench.app.quantities import CONFORMAL_FACTOR
from workbench.app.theme import Theme
from workbench.core.quality import average_histogram
from workbench.engine.messages import Snapshot


class HistogramDock(QDockWidget):
    """Bars of `Snapshot.histogram`; one standing item is given new heights."""

    def __init__(self, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__("Average singular value (78)", parent)
        self.setObjectName("histogram")
        self.setToolTip("How many simplices have which mean of their singular values; 1 keeps lengths.")
        self.plot = pg.PlotWidget(self)
        calm(self.plot.getPlotItem(), self)
        self.plot.setMinimumSize(200, 120)
        # stepMode draws one bar between each two edges
        self._bars = pg.PlotDataItem([0.0, 1.0], [0.0], stepMode="center", fillLevel=0)
        self._unit = pg.InfiniteLine(1.0, angle=90)
        self.plot.addItem(self._bars)
        self.plot.addItem(self._unit)
        self.plot.setLabel("bottom", "mean of σ")
        self.plot.setLabel("left", "simplices")
        self.setWidget(self.plot)
        self.counts = np.zeros(0, np.int64)
        self.clear()
        self.set_theme(theme)

    def set_theme(self, theme: Theme) -> None:
        self.plot.setBackground(theme.view)
        paint_axes(self.plot.getPlotItem(), theme)
        colour = QColor(theme.accent)
        self._bars.setPen(pg.mkPen(colour, width=1))
        colour.setAlpha(120)
        self._bars.setFillBrush(colour)
        self._unit.setPen(pg.mkPen(theme.faint, width=1, style=pg.QtCore.Qt.PenStyle.DashLine))

    def clear(self) -> None:
        self.counts = np.zeros(0, np.int64)
        self._bars.setData([0.0, 1.0], [0.0])
        self.plot.setYRange(0.0, 1.0)

    def show_snapshot(self, snapshot: Snapshot) -> None:
        values = snapshot.fields.get(CONFORMAL_FACTOR.id)
        if values is None:
            return
        edges, counts = average_histogram(values)
        self.counts = np.asarray(counts)
        self._bars.setData(np.asarray(edges, dtype=np.float64), np.asarray(counts, dtype=np.float64))
        low, high = float(edges[0]), float(edges[-1])
        if np.isfinite(low) and np.isfinite(high) and high > low:
            self.plot.setXRange(low, high, padding=0.02)
        self.plot.setYRange(0.0, max(float(self.counts.max()), 1.0), padding=0.04)
